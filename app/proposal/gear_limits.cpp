#include "app/proposal/gear_limits.h"

#include <algorithm>
#include <cmath>

#include "cam/analytic/gear_distance.h"
#include "cam/cut/unreached.h"
#include "cam/plan/first_ball.h"
#include "geometry/base/angle.h"

namespace toothpath::proposal {
namespace {

constexpr double kBevelClearance = 0.05;                                 // mm
constexpr double kBevelRoundings[] = {0.3, 0.25, 0.2, 0.15, 0.1, 0.05};  // modules

double rounded(double x) { return std::round(1e4 * x) / 1e4; }

constexpr double kGrooveModules = 1.6;      // between the rings of a double helical gear
constexpr double kRoughingAllowance = 0.1;  // modules

bool complete(const Wishes& wishes) {
  return std::all_of(questions().begin(), questions().end(), [&](const Question& q) {
    return q.what == Quantity::inner || q.what == Quantity::outer || !wishes.gear || !belongs(q, *wishes.gear) ||
           wishes[q.what];
  });
}

}  // namespace

face_gear::FaceGearParameters face_parameters(const Wishes& wishes) {
  face_gear::FaceGearParameters p;
  p.teeth = static_cast<int>(wishes.at(Quantity::teeth));
  p.shaper_teeth = static_cast<int>(wishes.at(Quantity::shaper_teeth));
  p.module_mm = wishes.at(Quantity::module);
  p.module_plane = face_gear::ModulePlane::transverse;
  p.pressure_angle_rad = radians(wishes.at(Quantity::pressure_angle));
  p.offset_mm = wishes.at(Quantity::offset);
  p.shaper_tip_radius_mm = wishes.at(Quantity::tip_radius);
  return p;
}

face_gear::FaceGearParameters whole_face_parameters(const Wishes& wishes) {
  face_gear::FaceGearParameters p = face_parameters(wishes);
  const double inner = wishes.at(Quantity::inner), outer = wishes.at(Quantity::outer),
               helix = radians(wishes.at(Quantity::helix));
  if (wishes.gear != Gear::double_helical) {
    p.zones.push_back({helix, inner, outer});
    return p;
  }
  const double middle = 0.5 * (inner + outer), half_groove = 0.5 * kGrooveModules * p.module_mm;
  p.reference_radius_mm = middle;
  p.zones.push_back({-helix, inner, middle - half_groove});
  p.zones.push_back({helix, middle + half_groove, outer});
  return p;
}

bevel_gear::BevelGearParameters bevel_parameters(const Wishes& wishes) {
  bevel_gear::BevelGearParameters p;
  const double m = wishes.at(Quantity::module);
  p.teeth = static_cast<int>(wishes.at(Quantity::teeth));
  p.mate_teeth = static_cast<int>(wishes.at(Quantity::mate_teeth));
  p.pitch_angle_rad = std::atan2(p.teeth, p.mate_teeth);
  p.outer_transverse_module_mm = m;
  p.pressure_angle_rad = radians(wishes.at(Quantity::pressure_angle));
  p.outer_spiral_angle_rad = radians(wishes.at(Quantity::spiral));
  p.face_width_mm = wishes.at(Quantity::face_width);
  const double outer = 0.5 * m * p.teeth / std::sin(p.pitch_angle_rad);
  p.apex_cone_distance_mm = std::round(10 * (outer - 0.54 * p.face_width_mm)) / 10;
  p.relief_half_width_mm = std::round(100 * 0.55 * m) / 100;
  p.addendum_mm = std::round(100 * 0.65 * m) / 100;
  p.dedendum_mm = std::round(100 * 0.82 * m) / 100;
  p.hand = wishes.hand < 0 ? -1 : 1;
  return p;
}

cylindrical::CylindricalParameters cylindrical_parameters(const Wishes& wishes) {
  if (wishes.cylinder) return *wishes.cylinder;
  cylindrical::CylindricalParameters p;
  p.teeth = static_cast<int>(wishes.at(Quantity::teeth));
  p.module_mm = wishes.at(Quantity::module);
  p.pressure_angle_rad = radians(wishes.at(Quantity::pressure_angle));
  p.profile_shift = wishes.at(Quantity::profile_shift);
  const double half = 0.5 * wishes.at(Quantity::face_width), helix = radians(wishes.at(Quantity::helix)),
               groove = 0.5 * kGrooveModules * p.module_mm;
  if (wishes.gear == Gear::cylindrical_double_helical) p.zones = {{-helix, -half, -groove}, {helix, groove, half}};
  else p.zones = {{helix, -half, half}};
  p.bore_diameter_mm = wishes.at(Quantity::bore);
  return p;
}

straight_bevel::StraightBevelParameters straight_bevel_parameters(const Wishes& wishes) {
  // Gleason's system of straight bevel gears: whole depth 2.188 m + 0.05 mm, addendum of the wheel 0.54 m + 0.46 m
  // (z_1/z_2)^2, face cone parallel to the root cone of the mate. Thickness by the rack of the same shift.
  const double m = wishes.at(Quantity::module), z = wishes.at(Quantity::teeth), mate = wishes.at(Quantity::mate_teeth),
               ratio = std::min(z, mate) / std::max(z, mate), of_wheel = m * (0.54 + 0.46 * ratio * ratio),
               clearance = 0.188 * m + kBevelClearance;
  straight_bevel::StraightBevelParameters p;
  p.teeth = static_cast<int>(z);
  p.pitch_angle_rad = std::atan2(z, mate);
  p.outer_transverse_module_mm = m;
  p.pressure_angle_rad = radians(wishes.at(Quantity::pressure_angle));
  p.bore_diameter_mm = wishes.at(Quantity::bore);
  p.face_width_mm = wishes.at(Quantity::face_width);
  p.addendum_mm = rounded(z <= mate ? 2 * m - of_wheel : of_wheel);
  p.dedendum_mm = rounded(2 * m + clearance - p.addendum_mm);
  const double R_e = 0.5 * m * z / std::sin(p.pitch_angle_rad);
  p.tip_angle_rad = radians(rounded(degrees(p.pitch_angle_rad + std::atan((p.addendum_mm + clearance) / R_e))));
  p.thickness_shift = rounded((p.addendum_mm / m - 1) * std::tan(p.pressure_angle_rad));
  for (const double share : kBevelRoundings) {
    p.fillet_radius_mm = rounded(share * m);
    const auto made = straight_bevel::StraightBevelGear::make(p);
    const auto* refusals = made.refused();
    if (!refusals ||
        std::none_of(refusals->begin(), refusals->end(), [](const Refusal& r) { return r.key == "fillet_radius"; }))
      break;
  }
  return p;
}

spiral_bevel::Drawing drawing_of(const Wishes& wishes) {
  spiral_bevel::Drawing drawing;
  drawing.teeth = static_cast<int>(wishes.at(Quantity::teeth));
  drawing.mate_teeth = static_cast<int>(wishes.at(Quantity::mate_teeth));
  drawing.hand = wishes.hand;
  drawing.shaft_angle_rad = radians(wishes[Quantity::shaft_angle].value_or(90));
  drawing.outer_transverse_module_mm = wishes.at(Quantity::module);
  drawing.spiral_angle_rad = radians(wishes.at(Quantity::spiral));
  drawing.pressure_angle_rad = radians(wishes.at(Quantity::pressure_angle));
  drawing.face_width_mm = wishes.at(Quantity::face_width);
  drawing.cutter_radius_mm = wishes.at(Quantity::cutter_radius);
  return drawing;
}

namespace {

/// With the largest rounding of the blades that makes a gear.
Expected<spiral_bevel::SpiralBevelGear, std::vector<Refusal>> gear_of_drawing(const spiral_bevel::Drawing& drawing) {
  std::vector<Refusal> refused;
  for (const double share : kBevelRoundings) {
    auto settings = spiral_bevel::basic_settings(drawing, rounded(share * drawing.outer_transverse_module_mm));
    if (auto* refusal = settings.refused()) {
      refused = {std::move(*refusal)};
      continue;
    }
    auto made = spiral_bevel::SpiralBevelGear::make(settings.value());
    if (auto* refusals = made.refused()) refused = std::move(*refusals);
    else return made;
  }
  return refused;
}

/// The least spiral angle above that of the drawing with which its other numbers make a gear, in steps; deg.
std::optional<double> least_spiral(spiral_bevel::Drawing drawing) {
  constexpr double kStep = 1, kMost = 45;  // deg
  for (double angle = std::floor(degrees(drawing.spiral_angle_rad) / kStep) * kStep + kStep; angle <= kMost;
       angle += kStep) {
    drawing.spiral_angle_rad = radians(angle);
    if (!gear_of_drawing(drawing).refused()) return angle;
  }
  return {};
}

}  // namespace

Expected<spiral_bevel::SpiralBevelGear, std::vector<Refusal>> spiral_bevel_gear(const Wishes& wishes) {
  if (wishes.spiral) return spiral_bevel::SpiralBevelGear::make(*wishes.spiral);
  const spiral_bevel::Drawing drawing = drawing_of(wishes);
  auto made = gear_of_drawing(drawing);
  auto* refusals = made.refused();
  if (!refusals || refusals->front().key == "shaft_angle") return made;
  if (const auto least = least_spiral(drawing))
    return std::vector{Refusal{
        "spiral_angle",
        fail("spiral_angle = {:g} deg is below {:g} deg, from where on these numbers make a gear by one cut on a "
             "machine without tilt; another cutter radius than {:g} mm may allow less; settings of a generator's sheet "
             "are taken with --rexs. What stops this one: {}",
             degrees(drawing.spiral_angle_rad), *least, drawing.cutter_radius_mm,
             refusals->front().diagnostic.message)}};
  return made;
}

std::optional<FaceRange> face_range(const Wishes& wishes) {
  if (!wishes.gear || *wishes.gear > Gear::offset || !complete(wishes)) return std::nullopt;
  const face_gear::FaceGearParameters p = face_parameters(wishes);
  FaceRange range{0, 1e9, 1e9, ""};
  for (const int hand : {-1, 1}) {
    const auto surface = face_gear::make_surface<double>(p, hand * radians(wishes.at(Quantity::helix)));
    const auto limits = face_gear::zone_limits(surface, p.module_mm);
    if (limits.inner_limit > range.inner) {
      range.inner = limits.inner_limit;
      range.inner_name = limits.inner_limit_name;
    }
    if (limits.pointing_radius) range.pointing = std::min(range.pointing, *limits.pointing_radius);
    if (limits.land_radius) range.outer = std::min(range.outer, *limits.land_radius);
  }
  range.outer = std::min(range.outer, range.pointing);
  if (range.pointing > 1e8) range.pointing = 0;
  return std::isfinite(range.inner) && range.outer > range.inner ? std::optional(range) : std::nullopt;
}

FaceFacts facts_of(std::shared_ptr<const tooth_space::ToothedPart> gear, double depth_mm) {
  FaceFacts facts{depth_mm, 0, 0};
  const double m = gear->module_mm(), reach = 3 * m;
  const analytic::GearDistance part(std::move(gear), reach);
  if (part.refusal()) return facts;
  facts.largest_ball = 2 * cut::largest_reaching_ball(part, 1.5 * m).radius_mm;
  facts.first_ball = plan::first_ball_mm(part, kRoughingAllowance * m, reach);
  return facts;
}

}  // namespace toothpath::proposal
