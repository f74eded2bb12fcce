// Tool axes that come parallel to the first rotary axis (a pole): there a small turn of the tool needs a large one of
// that rotary.
//
// Found on the great circles between the records, not at the records alone. A passage is a block in which the azimuth
// about the pole turns by more than 30 deg and more than four times as far as the tool itself, or a way through the
// cone of half-angle c / 2 about the pole in which it turns by more than 30 deg in all. What is done about it
// (PoleOption):
//
//   error    refused, with the ways out
//   tilt     the plan kept its distance; refused where it did not
//   slow     the azimuth turns evenly inside the cone and exactly outside it; the block times make room for it; c =
//   axis_rad hold     the same with c = pole_angle, ball tools: the second rotary alone follows the axis, the first
//   goes evenly (it stands
//            still where the path leaves the cone as it came)
//   through  straight through the pole: the second rotary changes sides, the first keeps its angle but for the bend;
//   ball tools retract  up to the nearest point with the angle of the way in, out along the tool, turn, back, on with
//   the angle of the way out
//
// Inside the cone both the planned and the posted axis are within c / 2 of the pole: they differ by at most c. Balls
// turn about their centre, so that the surface stays; the tip moves by at most 2 r sin(c / 2). Records are added where
// the path crosses the cone and wherever the azimuth would turn by more than 20 deg in one block.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cam/path/cl_path.h"
#include "geometry/base/result.h"
#include "machines/machine.h"
#include "postproc/joints/program.h"

namespace toothpath::joints {

/// Least angle to the pole that `tilt` keeps where the machine file does not say.
inline constexpr double kLeastPoleTilt = radians(5);

struct PoleRules {
  machines::PoleOption option = machines::PoleOption::error;
  char letter = 'C';         ///< of the first rotary axis
  double change_rad = 1e-3;  ///< c above
  double keep_rad = 0;       ///< `tilt`: least angle between tool and pole where the axis turns in a pass
  bool ball = true;
  double ball_radius_mm = 0;  ///< about whose centre the tool turns; 0: the tip stays
  ClearanceBody body;         ///< `retract` leaves it
  double margin_mm = 5;       ///< by this much
};

/// The path that the machine follows.
struct PolePath {
  path::ClPath path;
  std::vector<std::int32_t> source;  ///< record of the given path that each record leads to
  std::vector<char> in_cone;         ///< the step to this record lies in the cone
  std::vector<char> switches;        ///< at this record, on the pole, the pair of angles changes
  std::size_t passages = 0;
};

/// Directions about which a chain of two rotaries has a pole: the first rotary axis, its opposite, both or none. Table
/// frame.
[[nodiscard]] std::vector<Vec3> poles_of(const machines::KinematicChain& chain);

/// @param poles unit vectors, frame of the path
/// Empty: the path comes to no pole. Errors: record, angle between path and pole, turn of the rotary, and the option's
/// limit.
[[nodiscard]] Result<std::optional<PolePath>> handle_poles(const path::ClPath& path, std::span<const Vec3> poles,
                                                           const PoleRules& rules);

}  // namespace toothpath::joints
