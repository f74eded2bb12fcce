#include "geometry/inspection/tooth_index.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/face_gear/part.h"
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

double middle_radius(const face_gear::FaceGearRing& ring) {
  return 0.5 * (ring.zone.inner_radius_mm + ring.zone.outer_radius_mm);
}

std::optional<PitchDeviation> pitch_of(const face_gear::FaceGearRing& ring, int zone, int side, const ByTooth& off) {
  PitchDeviation out;
  out.zone = zone;
  out.side = side;
  out.radius_mm = middle_radius(ring);
  // A flank turned by an angle stands M2 times that angle off along its normals, everywhere.
  const double arc = side * out.radius_mm / ring.surface.M2;
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

/// Height of a ball between flank +1 of tooth 0 and flank -1 of tooth 1 for a millimetre of material on either.
Result<Vec2> rise_of_ball(const face_gear::FaceGear& gear, std::size_t zone) {
  const auto grid = inspection_grid(drawn_solid(gear));
  if (!grid) return grid.error();
  int rows = 0, columns = 0;
  for (const auto& p : *grid) {
    rows = std::max(rows, p.row + 1);
    columns = std::max(columns, p.column + 1);
  }
  const InspectionPoint *plus = nullptr, *minus = nullptr;
  for (const auto& p : *grid)
    if (p.zone == int(zone) && p.row == rows / 2 && p.column == columns / 2) (p.side > 0 ? plus : minus) = &p;
  const double pitch = gear.pitch();
  const Vec3 n_plus = plus->n, n_minus = turned(minus->n, pitch),
             middle = 0.5 * (plus->p + turned(minus->p, pitch)).cwiseProduct(Vec3(1, 1, 0));
  const Vec3 outward = middle.normalized(), along = Vec3::UnitZ().cross(outward);
  const auto& f = gear.rings()[zone].surface;
  const double r = middle_radius(gear.rings()[zone]), step = 1e-3 * r;
  const double slope = (f.z_tip(r + step) - f.z_tip(r - step)) / (2 * step);
  const Vec3 up = (Vec3::UnitZ() - slope * outward).normalized();
  Eigen::Matrix2d touches;
  touches << n_plus.dot(along), n_plus.dot(up), n_minus.dot(along), n_minus.dot(up);
  return Vec2(touches.inverse().row(1).transpose());
}

}  // namespace

Result<IndexOfTeeth> index_of_teeth(const face_gear::FaceGear& gear, const std::vector<ToothPlace>& places) {
  IndexOfTeeth out;
  const int teeth = gear.parameters().teeth;
  for (std::size_t zone = 0; zone < gear.rings().size(); ++zone) {
    const auto& ring = gear.rings()[zone];
    const ByTooth plus = by_tooth(places, int(zone), 1, teeth), minus = by_tooth(places, int(zone), -1, teeth);
    for (const int side : {1, -1})
      if (auto pitch = pitch_of(ring, int(zone), side, side > 0 ? plus : minus)) out.pitch.push_back(*pitch);
    const auto rise = rise_of_ball(gear, zone);
    if (!rise) return rise.error();
    RunOut run_out{int(zone), middle_radius(ring), 0, 0, false};
    double low = INFINITY, high = -INFINITY;
    for (std::size_t k = 0; k < plus.size(); ++k) {
      const auto& other = minus[(k + 1) % plus.size()];
      if (!plus[k] || !other) continue;
      ++run_out.spaces;
      const double height = rise->dot(Vec2(*plus[k], *other));
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
