// What cools a cut. Which words switch it is the business of the control, or of the machine's builder.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace toothpath::machines {

enum class Coolant : std::uint8_t { off, mist, flood, air, through_spindle };

/// All that can be switched on.
inline constexpr std::array<Coolant, 4> kCoolants = {Coolant::mist, Coolant::flood, Coolant::air,
                                                     Coolant::through_spindle};

/// As in job files, and behind `coolant_` in machine files.
[[nodiscard]] constexpr const char* to_string(Coolant coolant) {
  switch (coolant) {
    case Coolant::off: return "off";
    case Coolant::mist: return "mist";
    case Coolant::flood: return "flood";
    case Coolant::air: return "air";
    case Coolant::through_spindle: return "through_spindle";
  }
  return "";
}

/// One bit each, where several may be on.
[[nodiscard]] constexpr std::uint8_t bit_of(Coolant coolant) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(coolant));
}
[[nodiscard]] constexpr bool is_on(std::uint8_t coolants, Coolant coolant) { return (coolants & bit_of(coolant)) != 0; }

/// Lines of a program that switch a coolant on and off: M8 and M9.
struct CoolantWords {
  std::string on, off;
};

}  // namespace toothpath::machines
