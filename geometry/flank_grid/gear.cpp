#include "geometry/flank_grid/gear.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/tooth_space/ring_part.h"

namespace toothpath::flank_grid {
namespace {

constexpr double kBelowRoot = 0.5;  // modules
constexpr double kPlate = 2;        // modules: so thick is the body below teeth whose ends stop at one height

}  // namespace

double FlankGridGear::root(double s) const {
  const Meridian& m = space().kernel().root;
  const auto& chart = space().outline().chart;
  const Vec3 a(m.start.x(), 0, m.start.y()), along(m.along.x(), 0, m.along.y()), normal(m.normal.x(), 0, m.normal.y());
  const double s_0 = chart.along(a), h_0 = chart.up(a), s_x = chart.along(Vec3::UnitX(), along),
               h_x = chart.up(Vec3::UnitX(), along), s_y = chart.along(Vec3::UnitX(), normal),
               h_y = chart.up(Vec3::UnitX(), normal);
  constexpr int kSteps = 50;
  double x = (s - s_0) / s_x;
  for (int k = 0; k < kSteps && !m.bent.straight(); ++k) {
    const double step = (s_0 + x * s_x + m.bent.at(x) * s_y - s) / (s_x + m.bent.at(x, 1) * s_y);
    x -= step;
    if (std::abs(step) < 1e-14 * (1 + std::abs(x))) break;
  }
  return h_0 + x * h_x + m.bent.at(x) * h_y;
}

double FlankGridGear::lowest_root() const {
  constexpr int kStretches = 256;
  const auto& ring = space().outline();
  double lowest = std::min(root(ring.s_from), root(ring.s_to)), bend = 0;
  const Meridian& m = space().kernel().root;
  for (const auto& corner : m.bent.corners()) bend = std::max(bend, std::abs(corner.turn) / corner.half);
  if (bend == 0) return lowest;
  const double step = (ring.s_to - ring.s_from) / kStretches;
  for (int k = 1; k < kStretches; ++k) lowest = std::min(lowest, root(ring.s_from + k * step));
  return lowest - 0.25 * bend * step * step;  // twice what a place between may lie below: the chart leans, too
}

double FlankGridGear::least_root_radius() const {
  constexpr int kPlaces = 257;
  const auto& ring = space().outline();
  double least = INFINITY;
  for (int k = 0; k < kPlaces; ++k) {
    const double s = ring.s_from + (ring.s_to - ring.s_from) * k / (kPlaces - 1);
    least = std::min(least, ring.chart.r(s, root(s)));
  }
  return least;
}

Vec2 FlankGridGear::foot_of_end(bool to) const {
  constexpr int kSteps = 60;
  const auto& ring = space().outline();
  const tooth_space::EndLine end = ring.end(to);
  const double below = kBelowRoot * module_mm();
  double s = to ? ring.s_to : ring.s_from, h = root(s) - below;
  for (int k = 0; k < kSteps && ring.leaning; ++k) s = end.at(h), h = root(s) - below;
  return {ring.chart.r(s, h), ring.chart.z(s, h)};
}

double FlankGridGear::module_mm() const {
  const auto& ring = space().outline();
  const auto r = [&](double s) { return ring.chart.r(s, 0.5 * (root(s) + space().tip(s))); };
  return 2 * std::max(r(ring.s_from), r(ring.s_to)) / parameters_.teeth;
}

std::vector<Refusal> FlankGridGear::make_body() {
  const auto& ring = space().outline();
  const tooth_space::Chart& chart = ring.chart;
  const Vec2 to = foot_of_end(true), from = foot_of_end(false);
  const double bore = 0.5 * parameters_.bore_diameter_mm, hub = 0.5 * parameters_.hub_diameter_mm,
               length = parameters_.hub_length_mm, inner = std::min({to.x(), from.x(), least_root_radius()});
  const bool flat = std::abs(to.y() - from.y()) < kPlate * module_mm();
  const bool far_from = from.y() > to.y();  // the hub stands there
  const double hub_limit = flat ? std::max(to.x(), from.x()) : (far_from ? from : to).x();
  std::vector<Refusal> refusals;
  if (!(inner > 0 && bore < inner))
    refusals.push_back({"bore_diameter", fail("bore_diameter = {:.4f} mm is not below {:.4f} mm, the body under the "
                                              "teeth",
                                              2 * bore, 2 * inner)});
  if (length > 0 && !(hub > bore && hub < hub_limit))
    refusals.push_back(
        {"hub_diameter", fail("hub_diameter = {:.4f} mm is not between the bore, {:.4f} mm, and {:.4f} mm, the body",
                              2 * hub, 2 * bore, 2 * hub_limit)});
  if (!refusals.empty()) return refusals;
  // From the end at s_to inwards along the front, and back along the other side; one of them carries the hub.
  std::vector<Vec2> line{to};
  const auto add = [&](double r, double z) { line.emplace_back(r, z); };
  if (flat) {
    // A plate below teeth that stand upright, on the side of z where their body lies.
    const double sense = chart.cosine > 0 ? -1 : 1,
                 bottom = sense * std::max(sense * to.y(), sense * from.y()) + sense * kPlate * module_mm(),
                 back = bottom + sense * length;
    const bool outside = to.x() > from.x();
    add(std::max(to.x(), from.x()), bottom);
    if (length > 0) add(hub, bottom), add(hub, back);
    add(bore, back);
    add(bore, (outside ? from : to).y());
    if (!outside) std::reverse(line.begin() + 1, line.end());
  } else {
    const double front = far_from ? to.y() : to.y() + length, back = far_from ? from.y() + length : from.y();
    if (!far_from && length > 0) add(hub, to.y()), add(hub, front);
    add(bore, front);
    add(bore, back);
    if (far_from && length > 0) add(hub, back), add(hub, from.y());
  }
  add(from.x(), from.y());
  body_ = std::move(line);
  return {};
}

Expected<FlankGridGear, std::vector<Refusal>> FlankGridGear::make(const FlankGridParameters& parameters) {
  auto fitted = fit_grid(parameters);
  if (!fitted) return std::move(fitted.error());
  FlankGridGear gear;
  gear.parameters_ = parameters;
  gear.grid_ = std::move(*fitted);
  if (auto refusals = gear.make_body(); !refusals.empty()) return refusals;
  return gear;
}

tooth_space::ToothedSolid drawn_solid(const FlankGridGear& gear) {
  const auto& ring = gear.space().outline();
  tooth_space::ToothedSolid out;
  out.teeth = gear.parameters().teeth;
  out.module_mm = gear.module_mm();
  out.lowest_root = gear.lowest_root();
  out.ways_out = {"a lower tip leaves a wider land", "a smaller fillet_radius leaves a wider land", ""};
  out.rings.push_back({&gear.space(), 0});
  auto& corners = out.corners.emplace_back();
  for (const Vec2& rz : gear.body()) {
    const Vec3 p(rz.x(), 0, rz.y());
    corners.push_back({ring.chart.along(p), ring.chart.up(p)});
  }
  return out;
}

std::shared_ptr<const tooth_space::ToothedPart> part_of(const FlankGridGear& gear) {
  return tooth_space::ring_part(gear.shared_space(), {gear.parameters().teeth, gear.module_mm(), gear.lowest_root(),
                                                      gear.parameters().bore_diameter_mm});
}

}  // namespace toothpath::flank_grid
