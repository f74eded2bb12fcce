// Where the part has the most room in the travels of X, Y and Z.
//
// With the rotaries where they are, a shift d of the part (table frame) moves the joints by R(theta) d, R the rotation
// of the table: every joint of every pose is affine in d. The least room of a joint over all poses is then a concave
// function of d, and the greatest least room of all three a linear program in (d, room). What is still free after that
// goes to the joint with the next least room, and so on. Only the extreme joints of each pair of rotary angles count,
// and only those are kept.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "machines/machine.h"

namespace toothpath::choice {

/// Where the part would stand with the most room in the travels of X Y Z.
struct TravelOffer {
  Vec3 shift_mm = Vec3::Zero();  ///< of set-up origin and work offset, machine axes
  std::array<double, 3> room_now_mm{},
      room_then_mm{};          ///< X Y Z: distance to the nearer limit, limit_margin taken off; < 0: beyond
  bool on_index_axis = false;  ///< the gear stays on the axis that turns it: only shifts along it were looked at
  bool posted = false;         ///< a program was built there and fits; tried only where this one exceeds a travel
};

class TravelPoses {
 public:
  /// @param keep_on where the gear turns about the axis of the first rotary: its direction; only shifts along it are
  /// looked for
  TravelPoses(const machines::KinematicChain& chain, const machines::LimitMargin& margin,
              const std::optional<Vec3>& keep_on);

  /// A pose that moves with the part.
  void note(const machines::Joints& joints);

  /// Room of X Y Z with the part shifted by `shift_mm` [mm]; below 0: beyond a limit.
  [[nodiscard]] std::array<double, 3> room(const Vec3& shift_mm) const;
  /// The best shift that does not lower the part (what it stands on is not known), or where none of these fits the best
  /// of all; rounded to 1 um, with its rooms. Empty: there is no pose, or more than 2^21 pairs of angles.
  [[nodiscard]] std::optional<TravelOffer> best() const;

 private:
  class RoomProgram;
  [[nodiscard]] std::optional<TravelOffer> best(bool only_up) const;
  struct Extremes {
    Mat3 turn;  ///< machine from table
    Vec3 least, greatest;
  };
  struct KeyHash {
    std::size_t operator()(const std::array<std::uint64_t, 2>& k) const {
      return k[0] * 0x9E3779B97F4A7C15ULL ^ (k[1] + 0x7F4A7C15ULL) * 0xC2B2AE3D27D4EB4FULL;
    }
  };

  const machines::KinematicChain& chain_;
  std::array<double, 3> low_{}, high_{};
  std::optional<Vec3> keep_on_;
  bool too_many_ = false;
  std::vector<Extremes> list_;
  std::unordered_map<std::array<std::uint64_t, 2>, std::size_t, KeyHash> index_;
};

}  // namespace toothpath::choice
