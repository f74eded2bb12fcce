// From ball passes to CL records: run-in, hops between passes, retract to the clearance height, feeds.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "cam/ball/finishing.h"
#include "cam/path/cl_path.h"
#include "cam/proof/roof.h"
#include "cam/tool/body.h"

namespace toothpath::ball {

struct LinkingOptions {
  double centre_mm = 0;           ///< height above the tip of the centre that the passes give
  Vec3 axis = Vec3::UnitZ();      ///< fixed tool axis of the zone, tip to holder
  proof::Roof clearance;          ///< where rapids run: above everything
  double most_dip_mm = INFINITY;  ///< by which a straight rapid may lie below it between its ends
  double hop_mm = 0;              ///< lift along the axis between neighbouring passes in the air beside the ring
  double longest_hop_mm = 0;      ///< passes that end and begin farther apart are linked over the clearance height
  double feed_mm_min = 0;         ///< of the contact point
  double link_feed_mm_min = 0;    ///< of moves that cannot cut, not below `feed_mm_min`
  double slow_mm = INFINITY;      ///< way along the axis before a pass on which stock may be met
  int zone = 0;
  /// Simultaneous: the axis at every point of every pass; empty: `axis` everywhere.
  std::vector<std::vector<Vec3>> axes;
  std::vector<tool::Frustum> bodies;  ///< shank and holder: on rapids they stay above the clearance height too
};

/// Greatest turn of the axis between two neighbouring records of a hop, and over a whole hop; beyond it the link goes
/// over the clearance height. rad.
inline constexpr double kMostTurnOfHopRecord = 0.0175, kMostTurnOfHop = 0.35;

/// What a straight move of the ball centre meets: the finished part, or stock that stands on it, or nothing.
enum class Meets { part, stock, air };
/// A pose on a hop: ball centre and axis.
struct HopEnd {
  Vec3 centre, axis;
};
/// Asked for hops only.
using HopMeets = std::function<Meets(const HopEnd& from, const HopEnd& to)>;

/// Do shank and holder keep their clearance with the ball at a centre and this axis? Asked for hops in which the axis
/// turns.
using BodiesAreClear = std::function<bool(const Vec3& centre, const Vec3& axis)>;

/// Appends the passes to `records`. Starts and ends with rapids at the clearance height. The tip's feed is the contact
/// point's feed times the ratio of their ways, at most 20 % faster. A hop that may meet stock is no faster than the
/// cut; where it cannot be, or takes longer, the link goes back along the pass before and on from there, or over the
/// clearance height.
void link_passes(const std::vector<BallPass>& passes, const LinkingOptions& options, const HopMeets& hop_meets,
                 std::vector<path::ClRecord>& records, const BodiesAreClear& bodies_are_clear = {});

}  // namespace toothpath::ball
