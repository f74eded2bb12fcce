// How high the tool tip must stand so that rapids pass above the part: the clearance body turned by the table.
#pragma once

#include <array>
#include <optional>

#include "geometry/base/vec.h"
#include "machines/kinematic_chain.h"
#include "postproc/joints/program.h"

namespace toothpath::joints {

/// Where the gear stands on the table: p_table = rotation * p_W + origin.
struct GearPlacement {
  Mat3 rotation = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
};

/// Highest machine Z of the body with the rotaries at these commands [mm].
[[nodiscard]] double body_top(const machines::KinematicChain& chain, const GearPlacement& gear,
                              const ClearanceBody& body, const std::array<double, 2>& rotaries);

/// Upper bound of the same while the rotaries go from one pair of commands to another, each at its own pace: samples on
/// the rectangle of both angles plus what a point of the body can rise between two samples.
/// @param index_is_gear_axis the first rotary turns the body about its own axis
[[nodiscard]] double swept_top(const machines::KinematicChain& chain, const GearPlacement& gear,
                               const ClearanceBody& body, const std::array<double, 2>& from,
                               const std::array<double, 2>& to, bool index_is_gear_axis);

/// By how much the tip of a tool rises over the body and the room that links ask for, before the rotaries have left the
/// places in which a program begins [mm]; below 0: no program with this tool first can be made. Empty: a head swings
/// over a table that leans, and the links decide.
[[nodiscard]] std::optional<double> room_at_start(const machines::Machine& machine, const GearPlacement& gear,
                                                  const ClearanceBody& body, const AxisOptions& options,
                                                  double tool_length_mm);

}  // namespace toothpath::joints
