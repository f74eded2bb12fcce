// How far a mill stands in the stock along its path: points all over its cutting part, asked whether what they enter is
// still there.
#pragma once

#include <functional>
#include <vector>

#include "cam/cut/swept_tool.h"
#include "cam/tool/profile.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::cut {

/// Of one motion, at the worst of its places. Nothing in the material: zeros.
struct Engaged {
  double angle_rad =
      0;  ///< about the axis, of a tooth in the material: greatest of the heights with half the largest chip
  double steepest = 0;  ///< greatest share of the feed along the normal: the largest chip, a feed per tooth; in [0, 1]
  /// As `angle_rad`, but of the heights where the largest chip is half the feed per tooth or more: where a mill leaves
  /// the stock its tip is in it all around, and cuts little. What `max_engagement` is kept by.
  double loaded_rad = 0;
};

struct EngagementQuery {
  const tool::Profile& mill;
  const std::vector<tool::RoundedFrustum>& cutting;  ///< the same as bodies
  const std::vector<const Removed*>& before;         ///< what earlier operations removed
  std::function<bool(const Vec3&)> in_blank;         ///< does the uncut blank hold this place?
  double top_mm = 0;                                 ///< z above which it never does
  std::size_t one_of = 1;                            ///< so many motions is measured; the others have zeros
  tooth_space::Chart chart = {};                     ///< of the part
};

/// Stock thinner than this is none, mm.
inline constexpr double kThinnestStock = 1e-3;
/// Steps of the points about the axis and along round ends, rad: angles are found to one step; of arcs that are
/// shorter, and so of chips thinner than its sine, nothing may be seen.
inline constexpr double kEngagementStep = 0.1745;

/// What an operation is asked to take off: feed and the stock that it meets (infinite: not known), depth of its layers
/// (0: it has none).
struct AskedLoad {
  double feed_mm_min = 0, step_down_mm = 0, stock_mm = 0;
};
/// So many times what is asked is a load that nobody planned: feed per tooth, depth of a layer, stock.
inline constexpr double kLoadFactor = 1.5;

/// Where motions take off more than `kLoadFactor` times what is asked; 0: they do not. Lines of the motions.
struct Overload {
  double chip_share = 0;  ///< largest chip, in feeds per tooth as asked
  double depth_mm = 0;    ///< greatest height above the lowest place of the mill of a chip right ahead
  double stock_mm = 0;    ///< a chip lies so far below all that was free before
  int chip_line = 0, depth_line = 0, stock_line = 0;
};
/// Motions as of `engagement_along`, with their time. Chips below `kLeastStock` under what stands are none. Places half
/// a radius apart are looked at, and points of the cutting part a third of it apart. On all threads.
[[nodiscard]] Overload overload_along(const std::vector<path::ToolMotion>& motions, const EngagementQuery& query,
                                      const AskedLoad& asked);
inline constexpr double kLeastStock = 0.05;  // mm

/// One entry a motion; rapids and motions that stand have zeros. Motions are those of one operation in one space, in
/// the order of the cut: each meets what the ones before it and the earlier operations left. On all threads.
[[nodiscard]] std::vector<Engaged> engagement_along(const std::vector<path::ToolMotion>& motions,
                                                    const EngagementQuery& query);

}  // namespace toothpath::cut
