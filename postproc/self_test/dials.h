// What a machinist can see of an error of the machine file: three dials that stand on the table, along its X, Y and Z,
// touch the tip of the test bar, are set to zero at the first station and read at the others. The text must move the
// joints (no TCP): then the axes go where the file says, and what the file says wrong moves the tip off the point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "machines/kinematic_chain.h"
#include "postproc/self_test/self_test.h"

namespace toothpath::self_test {

inline constexpr double kDialStep_mm = 0.01;  ///< the least that is read off a dial

/// One value of the machine file, and what the dials show where it is wrong.
struct DialSight {
  enum class Kind : std::uint8_t {
    sense,  ///< the axis turns the other way
    axis,   ///< the axis stands beside its place: pivot or centre, across the axis
    zero,   ///< the axis stands at its zero at another command
    length  ///< the bar is longer or shorter than the tool table says
  };
  Kind kind = Kind::sense;
  std::size_t rotary = 0;  ///< in the order of KinematicChain::rotary; of a length none
  std::string what;        ///< "sense of A", "place of A", "zero of A", "length of the bar"
  /// A station each. Sense: what the dial that moves most shows, mm. Else the least error, mm or deg, that moves a dial
  /// by its step in whatever direction it lies; infinite: the station does not show it.
  std::vector<double> at;

  [[nodiscard]] const char* unit() const { return kind == Kind::zero ? "deg" : "mm"; }
  [[nodiscard]] double least() const;  ///< over the stations; of a sense the greatest reading
};

/// Of every rotary sense, place and zero; the length of the bar.
[[nodiscard]] std::vector<DialSight> dial_sights(const SelfTest& test, const machines::KinematicChain& chain);

}  // namespace toothpath::self_test
