#include "geometry/inspection/tooth_index.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/inspection/grid.h"

namespace toothpath::inspection {
namespace {

/// Places of the flanks of one side by tooth; empty: not measured.
using ByTooth = std::vector<std::optional<double>>;

ByTooth by_tooth(const std::vector<ToothPlace>& places, int zone, int side, int teeth) {
  ByTooth out(std::size_t(teeth), std::nullopt);
  for (const ToothPlace& p : places)
    if (p.zone == zone && p.side == side) out[std::size_t(p.tooth)] = p.off_mm;
  return out;
}

/// The middle of the flanks of one zone, both of space 0.
struct Middle {
  tooth_space::PatchPoint plus, minus;
  const tooth_space::ToothSpace* space = nullptr;
  [[nodiscard]] double radius_mm() const {
    const auto& outline = space->outline();
    return outline.chart.r(0.5 * (outline.s_from + outline.s_to), outline.chart.up(plus.p));
  }
  /// A flank turned by an angle stands this times the angle off along its normal there.
  [[nodiscard]] double lever(int side) const {
    const auto& at = side > 0 ? plus : minus;
    return at.p.x() * at.n.y() - at.p.y() * at.n.x();
  }
};

Middle middle_of(const std::vector<InspectionPoint>& grid, const tooth_space::ToothedSolid::Ring& ring) {
  const InspectionOptions options;
  Middle out;
  out.space = ring.space;
  for (const auto& p : grid)
    if (p.zone == ring.zone && p.row == options.rows / 2 && p.column == options.columns / 2)
      if (const auto q = ring.space->point(tooth_space::flank_of(p.side), p.theta, p.B))
        (p.side > 0 ? out.plus : out.minus) = *q;
  return out;
}

std::optional<PitchDeviation> pitch_of(const Middle& middle, int zone, int side, const ByTooth& off) {
  PitchDeviation out;
  out.zone = zone;
  out.side = side;
  out.radius_mm = middle.radius_mm();
  const double arc = out.radius_mm / middle.lever(side);
  double low = INFINITY, high = -INFINITY;
  for (std::size_t k = 0; k < off.size(); ++k) {
    if (!off[k]) continue;
    ++out.teeth;
    low = std::min(low, arc * *off[k]);
    high = std::max(high, arc * *off[k]);
    const std::size_t next = (k + 1) % off.size();
    if (!off[next]) continue;
    ++out.pairs;
    if (const double wrong = std::abs(arc * (*off[next] - *off[k])); wrong > out.single_mm) {
      out.single_mm = wrong;
      out.single_tooth = int(k);
    }
  }
  if (out.teeth < 2) return {};
  out.total_mm = high - low;
  out.complete = out.teeth == int(off.size());
  return out;
}

/// Height of a ball between both flanks of a space for a millimetre of material on either.
Vec2 rise_of_ball(const Middle& middle) {
  const tooth_space::Chart& chart = middle.space->outline().chart;
  const double about = azimuth(Vec3(0.5 * (middle.plus.p + middle.minus.p))), s = chart.along(middle.plus.p),
               step = 1e-3 * middle.radius_mm();
  const double slope = (middle.space->tip(s + step) - middle.space->tip(s - step)) / (2 * step);
  const Vec3 along(-std::sin(about), std::cos(about), 0),
      up = (chart.up_at(about) - slope * chart.along_at(about)).normalized();
  Eigen::Matrix2d touches;
  touches << middle.plus.n.dot(along), middle.plus.n.dot(up), middle.minus.n.dot(along), middle.minus.n.dot(up);
  return touches.inverse().row(1).transpose();
}

}  // namespace

Result<IndexOfTeeth> index_of_teeth(const tooth_space::ToothedSolid& gear, const std::vector<ToothPlace>& places) {
  IndexOfTeeth out;
  const int teeth = gear.teeth;
  std::vector<tooth_space::ToothedSolid::Ring> rings = gear.rings;
  std::sort(rings.begin(), rings.end(), [](const auto& a, const auto& b) { return a.zone < b.zone; });
  const auto grid = inspection_grid(gear);
  if (!grid) return grid.error();
  for (const auto& ring : rings) {
    const Middle middle = middle_of(*grid, ring);
    const int zone = ring.zone;
    const ByTooth plus = by_tooth(places, zone, 1, teeth), minus = by_tooth(places, zone, -1, teeth);
    for (const int side : {1, -1})
      if (auto pitch = pitch_of(middle, zone, side, side > 0 ? plus : minus)) out.pitch.push_back(*pitch);
    const Vec2 rise = rise_of_ball(middle);
    RunOut run_out{zone, middle.radius_mm(), 0, 0, false};
    double low = INFINITY, high = -INFINITY;
    for (std::size_t k = 0; k < plus.size(); ++k) {
      const auto& other = minus[(k + 1) % plus.size()];
      if (!plus[k] || !other) continue;
      ++run_out.spaces;
      const double height = rise.dot(Vec2(*plus[k], *other));
      low = std::min(low, height);
      high = std::max(high, height);
    }
    if (run_out.spaces < 2) continue;
    run_out.run_out_mm = high - low;
    run_out.complete = run_out.spaces == teeth;
    out.run_out.push_back(run_out);
  }
  return out;
}

}  // namespace toothpath::inspection
