#include "cam/ball/prescribed_axes.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::ball {
namespace {

constexpr double kPrescribedResolution = 0.01;  // mm, of gaps
constexpr double kPlaces = 0.3;                 // mm between the places that are looked at
constexpr double kPrescribedDeepest = 3.0;      // mm: how far a body that cuts in is followed

/// Lean towards a side, deg, to the digits that are told: no -0.000.
double lean_deg(const Vec3& axis, const Vec3& side, const Vec3& up) {
  return std::round(degrees(std::atan2(axis.dot(side), axis.dot(up))) * 1000) / 1000 + 0.0;
}

/// Slope at a key from the slopes of the stretches beside it (h mm wide): the weighted mean, limited so that the cubic
/// does not overshoot; 0 at a turning point.
double limited_slope(double left, double h_left, double right, double h_right) {
  if (left * right <= 0) return 0;
  const double mean = (left * h_right + right * h_left) / (h_left + h_right),
               most = 3 * std::min(std::abs(left), std::abs(right));
  return std::copysign(std::min(std::abs(mean), most), mean);
}

/// What is wrong with an axis at one place: how much is missing, and the words for it.
struct Shortfall {
  double by = 0;  ///< mm; 0: nothing
  BallPass::Point point;
  Vec3 axis = Vec3::UnitZ();
  std::string words;
};

class Prover {
 public:
  Prover(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone, const tool::ToolAssembly& tool,
         const OrientationOptions& o)
      : part_(part), tree_(tree), tool_(tool), o_(o), check_(part, tree, zone, tool, o) {}

  [[nodiscard]] const OrientationCheck& check() const { return check_; }

  /// The worst place of the records and of places between them.
  [[nodiscard]] Shortfall worst(const AxisRecords& records) const {
    const auto& [points, axes] = records;
    std::vector<Shortfall> places{{0, points.front(), axes.front(), {}}};
    for (std::size_t k = 1; k < points.size(); ++k) {
      const int pieces = std::max(1, int(std::ceil((points[k].centre - points[k - 1].centre).norm() / kPlaces)));
      for (int j = 1; j <= pieces; ++j) {
        const double t = double(j) / pieces;
        places.push_back(
            {0, blend_points(points[k - 1], points[k], t), ((1 - t) * axes[k - 1] + t * axes[k]).normalized(), {}});
      }
    }
    tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t k) { look(places[k]); });
    const auto most = std::max_element(places.begin(), places.end(),
                                       [](const Shortfall& a, const Shortfall& b) { return a.by < b.by; });
    return *most;
  }

 private:
  void look(Shortfall& s) const {
    if (check_.clear(s.point, s.axis, o_.clearance_mm)) return;
    bodies(s);
    if (!check_.cutting(s.point, s.axis)) cutting(s);
  }

  void bodies(Shortfall& s) const {
    const Vec3 tip = s.point.centre - tool_.radius_mm() * s.axis;
    for (const auto& body : check_.bodies()) {
      const double gap = tree_.gap(body, tip, s.axis, o_.clearance_mm, kPrescribedResolution);
      if (gap >= o_.clearance_mm) continue;
      const double depth =
          gap > 0 ? 0 : tree_.depth(body, {&tip, 1}, s.axis, kPrescribedDeepest, kPrescribedResolution);
      const double by = gap > 0 ? o_.clearance_mm - gap : o_.clearance_mm + depth;
      if (by <= s.by) continue;
      s.by = by;
      s.words = gap > 0
                    ? fmt::format("its {} keeps {:.3f} mm, the clearance is {:.3f} mm", body.body, gap, o_.clearance_mm)
                    : fmt::format("its {} cuts in by {}{:.3f} mm, the clearance is {:.3f} mm", body.body,
                                  depth >= kPrescribedDeepest ? "more than " : "", depth, o_.clearance_mm);
    }
  }

  /// Draft or flute, where more is missing than for any body.
  void cutting(Shortfall& s) const {
    const double R = tool_.radius_mm();
    const Vec3 normal = s.point.centre - s.point.contact;
    const double draft = normal.norm() > 0 ? normal.normalized().dot(s.axis) : 1;
    if (s.point.touching && normal.norm() > 0.1 * R && draft < o_.least_draft) {
      const double by = R * (o_.least_draft - draft);
      if (by <= s.by) return;
      s.by = by;
      s.words = fmt::format(
          "its flute cuts instead of its ball: the cosine between axis and normal is {:.4f}, the least is {:.4f}",
          draft, o_.least_draft);
      return;
    }
    double deepest = 0, at = 0;
    for (double h = 0.4 * R; h <= tool_.flute_length_mm - R; h += 0.25 * R) {
      const double cut = check_.flute_cut(s.point, s.axis, h);
      if (cut > deepest) deepest = cut, at = h;
    }
    if (deepest <= s.by && s.by > 0) return;
    s.by = std::max(deepest, 1e-6);
    s.words = fmt::format("its flute cuts in by {:.4f} mm at {:.3f} mm above the tip, the limit is 0", deepest, at + R);
  }

  const analytic::GearDistance& part_;
  const analytic::BodyTree& tree_;
  const tool::ToolAssembly& tool_;
  const OrientationOptions& o_;
  OrientationCheck check_;
};

}  // namespace

PrescribedLean::PrescribedLean(const std::vector<path::ToolAxisKey>& keys) {
  for (const auto& k : keys) {
    radius_.push_back(k.radius_mm);
    lean_.emplace_back(std::tan(k.outwards_rad), std::tan(k.aside_rad));
  }
  slope_.assign(keys.size(), Vec2::Zero());
  for (std::size_t k = 1; k + 1 < keys.size(); ++k) {
    const double h0 = radius_[k] - radius_[k - 1], h1 = radius_[k + 1] - radius_[k];
    for (int i = 0; i < 2; ++i)
      slope_[k][i] = limited_slope((lean_[k][i] - lean_[k - 1][i]) / h0, h0, (lean_[k + 1][i] - lean_[k][i]) / h1, h1);
  }
}

Vec2 PrescribedLean::at(double r) const {
  if (r <= radius_.front()) return lean_.front();
  if (r >= radius_.back()) return lean_.back();
  const auto k = std::size_t(std::upper_bound(radius_.begin(), radius_.end(), r) - radius_.begin());
  const double h = radius_[k] - radius_[k - 1], t = (r - radius_[k - 1]) / h;
  const Vec2 &a = lean_[k - 1], rise = lean_[k] - a, m0 = h * slope_[k - 1], m1 = h * slope_[k];
  return a + t * (m0 + t * (3 * rise - 2 * m0 - m1 + t * (m0 + m1 - 2 * rise)));
}

Expected<Orientation, OrientationRefusal> prescribe_axes(const analytic::GearDistance& part,
                                                         const analytic::BodyTree& tree, int zone,
                                                         const tool::ToolAssembly& tool,
                                                         const path::MillingOperation& operation,
                                                         OrientationOptions options, std::vector<BallPass>& passes) {
  options.least_tilt_rad = 0;
  const Prover prover(part, tree, zone, tool, options);
  const PrescribedLean plus(operation.axis_plus), minus(operation.axis_minus);
  const PitchFrame& frame = prover.check().frame();
  const tooth_space::Outline& ring = part.space(zone).outline();
  passes.erase(std::remove_if(passes.begin(), passes.end(), [](const BallPass& p) { return p.points.empty(); }),
               passes.end());
  std::vector<AxisRecords> made;
  Shortfall worst;
  for (const auto& pass : passes) {
    const PassTrack track(pass);
    const PrescribedLean& lean = pass.outward == operation.climb ? plus : minus;
    const auto axis = [&](double s) {
      const Vec2 q = lean.at(ring.sign * ring.chart.along(track.point(s).centre));
      return frame.axis(q.x(), q.y());
    };
    made.push_back(records_with_axes(track, axis, options.chord_mm, tool.radius_mm()));
    if (const Shortfall here = prover.worst(made.back()); here.by > worst.by) worst = here;
  }
  if (worst.by > 0)
    return OrientationRefusal{
        fmt::format("with the ball at radius {:.3f}, height {:.3f} the prescribed axis leans {:.3f} deg outwards and "
                    "{:.3f} deg aside, and {}",
                    radius(worst.point.centre), worst.point.centre.z(), lean_deg(worst.axis, frame.outwards, frame.up),
                    lean_deg(worst.axis, frame.side, frame.up), worst.words)};
  return take_axes(std::move(made), prover.check(), tree, tool, passes);
}

}  // namespace toothpath::ball
