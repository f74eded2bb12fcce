// The colour that files for other programs give a gear.
#pragma once

#include <array>
#include <cstdint>

namespace toothpath::exchange {

inline constexpr std::array<std::uint8_t, 3> kSteel{176, 184, 191};  ///< sRGB

}  // namespace toothpath::exchange
