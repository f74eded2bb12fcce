// Finishing and semi-finishing of one tooth space with a ball: passes along the tooth, iso-scallop across it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "cam/path/operation.h"
#include "geometry/base/result.h"
#include "geometry/tooth_space/offset_sheet.h"

namespace toothpath::ball {

/// One pass: ball centres on the sheet from the inner to the outer end of the ring, contact points beside them.
struct BallPass {
  struct Point {
    Vec3 centre = Vec3::Zero();
    Vec3 contact = Vec3::Zero();
    bool touching = true;  ///< false in the run-out beyond the ends of the ring
  };
  std::vector<Point> points;  ///< in feed direction
  bool outward = true;        ///< feed from the inner to the outer end
  bool opens_layer = false;   ///< roughing: nothing of its layer is cut before it, so it is a slot
};

struct FinishingOptions {
  double ball_radius_mm = 0;
  double allowance_mm = 0;
  path::ByRegion<double> scallop_mm;                 ///< cusp height asked in each region
  path::ByRegion<bool> regions{{true, true, true}};  ///< what is covered
  double chord_mm = 0;
  double run_out_mm = 0;  ///< how far the ball centre goes on beyond the last contact
  bool climb = true;

  /// Asked at a place across the sheet, and between two of them: the lower one.
  [[nodiscard]] double scallop(double sigma) const { return scallop_mm[region_at(sigma)]; }
  [[nodiscard]] double scallop(double a, double b) const { return std::min(scallop(a), scallop(b)); }
  /// Sigma runs over flank +1, its fillet, the root, the other fillet and flank, one unit each.
  [[nodiscard]] static path::Region region_at(double sigma) {
    return sigma < 1 || sigma > 4   ? path::Region::flank
           : sigma < 2 || sigma > 3 ? path::Region::fillet
                                    : path::Region::root;
  }
};

struct FinishingPasses {
  std::vector<BallPass> passes;  ///< in cutting order
  double scallop_max_mm = 0;     ///< highest cusp found between two passes, flanks, fillets and root
  double crest_lean = 0;         ///< greatest lean of a crest (cam/ball/pass_count.h)
  double worst_chord_mm = 0;     ///< largest sag found while placing points
  bool corner_passes = false;    ///< the ball is too large for the fillet: extra passes run along the corners
};

/// Passes over the whole sheet. Step-over: the cusp between two neighbours is w^2 / (8 R (1 + k R)) for centres w apart
/// across the pass, k the normal curvature of the machined surface across the pass, convex positive.
/// Fails if the sheet does not cover the ring (undercut: the surfaces end inside it).
[[nodiscard]] Result<FinishingPasses> plan_finishing(const tooth_space::OffsetSheet& sheet,
                                                     const FinishingOptions& options);

/// Points of a curve r -> place, as sparse as the chord tolerance allows. Shared by finishing and roughing.
struct SampledCurve {
  std::vector<BallPass::Point> points;
  double worst_chord_mm = 0;
};
/// Bisects until the exact curve is nowhere farther than the chord tolerance from the chord.
template <typename Curve>
std::optional<SampledCurve> sample_curve(const Curve& curve, double r_begin, double r_end, double chord_mm,
                                         double longest_mm) {
  struct Node {
    double r;
    BallPass::Point at;
  };
  SampledCurve out;
  const auto node = [&](double r) -> std::optional<Node> {
    const auto p = curve(r);
    if (!p) return {};
    return Node{r, *p};
  };
  const auto sag = [](const Vec3& a, const Vec3& b, const Vec3& p) {
    const Vec3 ab = b - a;
    const double t = ab.squaredNorm() > 0 ? std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) : 0.0;
    return (p - a - t * ab).norm();
  };
  auto previous = node(r_begin);
  if (!previous) return {};
  out.points.push_back(previous->at);
  std::vector<Node> ahead;
  auto last = node(r_end);
  if (!last) return {};
  ahead.push_back(*last);
  while (!ahead.empty()) {
    const Node next = ahead.back();
    const double gap = next.r - previous->r;
    const auto middle = node(previous->r + 0.5 * gap), quarter = node(previous->r + 0.25 * gap),
               three = node(previous->r + 0.75 * gap);
    if (!middle || !quarter || !three) return {};
    const Vec3 &a = previous->at.centre, &b = next.at.centre;
    const double worst =
        std::max({sag(a, b, middle->at.centre), sag(a, b, quarter->at.centre), sag(a, b, three->at.centre)});
    const bool fine = worst <= chord_mm && (b - a).norm() <= longest_mm;
    if (fine || std::abs(gap) < 1e-7) {
      out.worst_chord_mm = std::max(out.worst_chord_mm, worst);
      out.points.push_back(next.at);
      previous = next;
      ahead.pop_back();
    } else {
      ahead.push_back(*middle);
    }
  }
  return out;
}

}  // namespace toothpath::ball
