#include "cam/finger/deepest.h"

#include <algorithm>
#include <cmath>

namespace toothpath::finger {
namespace {

constexpr double kFar = 2.0;    // mm: walls that the motion does not come near
constexpr double kPiece = 1.0;  // mm: longer motions are looked at in pieces, on which the distance is a bowl
constexpr int kDeepestAlong = 12, kUp = 8;  // intervals of the first look
constexpr double kDeepestFinest = 1e-4;     // share of a first interval at which the search ends

/// A wall of a half over the rectangle ell_from .. ell_to, 0 .. 1 from the end of the fillet at the root to the tip of
/// the tooth.
class WallSearch {
 public:
  WallSearch(const bevel_gear::BevelHalf& half, int wall, double h_a, const FingerTool& tool, const path::ToolMotion& m)
      : half_(half), wall_(half.walls[wall]), h_a_(h_a), tool_(tool) {
    const int n = std::max(1, int(std::ceil((m.tip_to - m.tip_from).norm() / kPiece)));
    for (int k = 0; k < n; ++k) {
      path::ToolMotion piece = m;
      piece.tip_from = path::tip_at(m, double(k) / n), piece.tip_to = path::tip_at(m, double(k + 1) / n);
      piece.axis_from = path::axis_at(m, double(k) / n), piece.axis_to = path::axis_at(m, double(k + 1) / n);
      pieces_.push_back(piece);
    }
  }

  struct Place {
    double gap = kFar, ell = 0, up = 0;
    Vec3 point = Vec3::Zero();
  };

  /// Downhill from the best place of a coarse look between two cone distances.
  [[nodiscard]] Place lowest(double from, double to) const {
    Place best;
    for (int c = 0; c <= kDeepestAlong; ++c)
      for (int r = 0; r <= kUp; ++r) take(best, from + (to - from) * c / kDeepestAlong, double(r) / kUp);
    if (!(best.gap < kFar)) return best;
    double along = (to - from) / kDeepestAlong, up = 1.0 / kUp;
    for (double share = 1; share > kDeepestFinest;) {
      const Place before = best;
      for (const auto& [a, b] : {std::pair{1.0, 0.0},
                                 {-1.0, 0.0},
                                 {0.0, 1.0},
                                 {0.0, -1.0},
                                 {0.7, 0.7},
                                 {-0.7, 0.7},
                                 {0.7, -0.7},
                                 {-0.7, -0.7}})
        take(best, before.ell + a * along, before.up + b * up);
      if (best.gap < before.gap - 1e-9) {  // once more the same way
        take(best, 2 * best.ell - before.ell, 2 * best.up - before.up);
        continue;
      }
      share *= 0.5, along *= 0.5, up *= 0.5;
    }
    return best;
  }

 private:
  void take(Place& best, double ell, double up) const {
    ell = std::clamp(ell, half_.ell_from, half_.ell_to);
    up = std::clamp(up, 0.0, 1.0);
    const auto top = bevel_gear::bevel_inverse(wall_, ell, h_a_);
    const double low = wall_.cutter.p_A, p = low + up * ((top ? top->p : wall_.cutter.p_D) - low);
    const auto beta = up == 1 && top ? std::optional(top->beta) : bevel_gear::bevel_beta_at(wall_, ell, p);
    if (!beta) return;
    const Vec3 point = wall_.point(*beta, p).p;
    double gap = best.gap;
    for (const auto& m : pieces_) gap = least_distance(point, m, tool_, gap);
    if (gap < best.gap) best = {gap, ell, up, point};
  }

  const bevel_gear::BevelHalf& half_;
  const bevel_gear::BevelWall<double>& wall_;
  double h_a_;
  const FingerTool& tool_;
  std::vector<path::ToolMotion> pieces_;
};

}  // namespace

DeepestCut deepest_cut(const bevel_gear::BevelGear& gear, const FingerTool& tool, const path::ToolMotion& m) {
  const double rho = tool.solid.largest_radius();
  const double a = cone_pose(gear, m.tip_from, m.axis_from, 0).R_c, b = cone_pose(gear, m.tip_to, m.axis_to, 0).R_c;
  DeepestCut out;
  out.depth_mm = -kFar;
  for (std::size_t i = 0; i < gear.halves().size(); ++i) {
    const bevel_gear::BevelHalf& half = gear.halves()[i];
    const double from = std::max(half.ell_from, std::min(a, b) - rho), to = std::min(half.ell_to, std::max(a, b) + rho);
    if (from > to) continue;
    for (int k = 0; k < 2; ++k) {
      const auto place = WallSearch(half, k, gear.parameters().addendum_mm, tool, m).lowest(from, to);
      if (-place.gap > out.depth_mm) out = {-place.gap, place.point, int(i), k};
    }
  }
  return out;
}

}  // namespace toothpath::finger
