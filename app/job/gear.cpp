// [gear], [[gear.zone]] and [stock]. What the geometry itself limits (undercut, pointing) is refused by geometry; here
// stand the bounds of what a number of this kind can mean at all.
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <variant>

#include "app/job/flank_points.h"
#include "app/job/tables.h"
#include "geometry/base/angle.h"
#include "machines/toml/input_text.h"

namespace toothpath::job {
namespace {

constexpr toml::Range kTeeth{2, 5000};
constexpr toml::Range kMateTeeth{1, 5000};
constexpr toml::Range kModule{0.01, 100, " mm"};
constexpr toml::Range kPressureAngle{5, 40, " deg"};  // below 5: most likely radians
constexpr toml::Range kHelixAngle{-60, 60, " deg"};
constexpr toml::Range kShaftAngle{20, 160, " deg"};
constexpr toml::Range kRadius{0, 10000, " mm", true};
constexpr toml::Range kSignedLength{-10000, 10000, " mm"};
constexpr toml::Range kLength{0, 10000, " mm", true};
constexpr toml::Range kLengthOrZero{0, 10000, " mm"};
constexpr std::size_t kMostZones = 2;
constexpr double kLeastFace = 0.01;                                     // mm; a face of the smallest module is wider
constexpr std::size_t kMostPointBytes = 64u << 20, kMostCorners = 100;  // of a meridian

/// NAME_diameter and NAME_length: both or none.
void optional_cylinder(toml::TableReader& gear, const std::string& name, double& diameter, double& length) {
  const std::string wide = name + "_diameter", tall = name + "_length";
  const bool has_diameter = gear.has(wide), has_length = gear.has(tall);
  diameter = gear.optional_number(wide, kLength).value_or(0);
  length = gear.optional_number(tall, kLength).value_or(0);
  gear.relate(toml::KeyRelation::Kind::together, wide, tall);
  if (has_diameter && !has_length) gear.refuse(wide, "{} = {} mm needs {} as well", wide, diameter, tall);
  if (has_length && !has_diameter) gear.refuse(tall, "{} = {} mm needs {} as well", tall, length, wide);
}

void read_module_plane(toml::TableReader& gear, ModulePlane& plane) {
  if (const auto word = gear.word("module_plane", {"normal", "transverse"}))
    plane = *word == "normal" ? ModulePlane::normal : ModulePlane::transverse;
}

double read_helix_angle(toml::TableReader& zone, std::vector<std::string>& warnings) {
  const auto angle = zone.number("helix_angle", kHelixAngle);
  if (!angle) return 0;
  if (std::abs(*angle) > 1e-3 && std::abs(*angle) < 1.1) {
    const auto at = zone.where("helix_angle");
    warnings.push_back(fmt::format("{}:{}:{}: warning: helix_angle = {} deg; were {:.3f} deg meant (radians)?", at.file,
                                   at.line, at.column, *angle, degrees(*angle)));
  }
  return radians(*angle);
}

/// The [[gear.zone]] tables, one or two.
std::vector<toml::TableReader> zone_tables(toml::TableReader& gear) {
  auto zones = gear.tables("zone", {1, kMostZones}, toml::Presence::required);
  if (!gear.has("zone")) gear.refuse("zone", "[gear] lacks its teeth: at least one [[gear.zone]]");
  if (zones.size() > kMostZones) gear.refuse("zone", "{} zones exceed the limit {}", zones.size(), kMostZones);
  return zones;
}

void read_zones(toml::TableReader& gear, face_gear::FaceGearParameters& result, std::vector<std::string>& warnings) {
  for (auto& table : zone_tables(gear)) {
    face_gear::FaceGearZone zone;
    zone.helix_angle_rad = read_helix_angle(table, warnings);
    const auto inner = table.number("inner_radius", kRadius);
    const auto outer = table.number("outer_radius", kRadius);
    zone.inner_radius_mm = inner.value_or(0);
    zone.outer_radius_mm = outer.value_or(0);
    if (inner && outer && *outer <= *inner)
      table.refuse("outer_radius", "outer_radius = {} mm is not above inner_radius = {} mm", *outer, *inner);
    else if (inner && outer && *outer - *inner < kLeastFace)
      table.refuse("outer_radius", "outer_radius - inner_radius = {:.6g} mm of face is below {} mm", *outer - *inner,
                   kLeastFace);
    else if (inner && !result.zones.empty() && *inner <= result.zones.back().outer_radius_mm)
      table.refuse("inner_radius", "inner_radius = {} mm is not above {} mm, the outer_radius of the zone before",
                   *inner, result.zones.back().outer_radius_mm);
    table.finish();
    result.zones.push_back(zone);
  }
}

/// The body below the teeth.
face_gear::Body read_face_body(toml::TableReader& stock) {
  face_gear::Body body;
  body.thickness_mm = stock.optional_number("thickness", kLength).value_or(0);
  body.bore_mm = stock.optional_number("bore_diameter", kLengthOrZero);
  optional_cylinder(stock, "hub", body.hub_mm, body.hub_length_mm);
  return body;
}

/// With its [[gear.zone]] tables, and [stock] where there is one.
face_gear::FaceGearParameters read_face_gear(toml::TableReader& gear, toml::TableReader* stock, face_gear::Body& body,
                                             const std::string& directory, std::vector<std::string>& warnings) {
  face_gear::FaceGearParameters p;
  p.teeth = gear.integer("teeth", kTeeth).value_or(0);
  p.shaper_teeth = gear.integer("shaper_teeth", {3, 1000}).value_or(0);
  p.mate_teeth = gear.optional_integer("mate_teeth", {3, 1000}).value_or(0);
  const auto module = gear.number("module", kModule);
  p.module_mm = module.value_or(0);
  read_module_plane(gear, p.module_plane);
  p.pressure_angle_rad = radians(gear.number("pressure_angle", kPressureAngle).value_or(0));
  p.addendum_coefficient = gear.number_or("addendum_coefficient", {0.1, 2}, p.addendum_coefficient);
  p.clearance_coefficient = gear.number_or("clearance_coefficient", {0, 1}, p.clearance_coefficient);
  p.shaft_angle_rad = radians(gear.number_or("shaft_angle", kShaftAngle, degrees(p.shaft_angle_rad)));
  p.offset_mm = gear.number_or("offset", kSignedLength, p.offset_mm);
  p.reference_radius_mm = gear.optional_number("reference_radius", kRadius);
  p.shaper_tip_radius_mm = gear.number_or("shaper_tip_radius", kLengthOrZero, p.shaper_tip_radius_mm);
  p.backlash_mm = gear.number_or("backlash", kLengthOrZero, p.backlash_mm);
  if (module && p.backlash_mm >= *module)
    gear.refuse("backlash", "backlash = {} mm is not below module = {} mm", p.backlash_mm, *module);
  if (module && p.shaper_tip_radius_mm >= *module)
    gear.refuse("shaper_tip_radius", "shaper_tip_radius = {} mm is not below module = {} mm", p.shaper_tip_radius_mm,
                *module);
  const double land = gear.optional_number("least_land", kLengthOrZero).value_or(0);
  if (land > 0) p.least_land_mm = land;
  if (module && land >= *module)
    gear.refuse("least_land", "least_land = {} mm is not below module = {} mm", land, *module);
  read_zones(gear, p, warnings);
  p.modifications = read_modifications(gear, directory);
  if (!p.zones.empty() && p.zones.front().inner_radius_mm > 0 &&
      std::abs(p.offset_mm) >= p.zones.front().inner_radius_mm)
    gear.refuse("offset", "offset = {} mm reaches the inner radius {} mm", p.offset_mm,
                p.zones.front().inner_radius_mm);
  gear.finish();
  if (stock) {
    p.allowance_top_mm = stock->number_or("allowance_top", {0, 1000, " mm"}, p.allowance_top_mm);
    p.groove_depth_mm = stock->optional_number("groove_depth", kLength).value_or(p.groove_depth_mm);
    body = read_face_body(*stock);
    stock->finish();
  }
  return p;
}

/// The pitch angle itself, or from the teeth of the mate.
void read_pitch_angle(toml::TableReader& gear, int teeth, double shaft_angle_rad, int& mate_teeth,
                      double& pitch_angle_rad) {
  const bool mate = gear.has("mate_teeth"), angle = gear.has("pitch_angle");
  mate_teeth = gear.optional_integer("mate_teeth", kMateTeeth).value_or(0);
  pitch_angle_rad = radians(gear.optional_number("pitch_angle", {0.01, 90, " deg"}).value_or(0));
  gear.relate(toml::KeyRelation::Kind::one_of, "mate_teeth", "pitch_angle");
  if (mate && angle) gear.refuse("pitch_angle", "pitch_angle contradicts mate_teeth: give one of the two");
  if (!mate && !angle) gear.refuse("mate_teeth", "[gear] lacks the key \"mate_teeth\" (or \"pitch_angle\")");
  if (mate && mate_teeth > 0 && teeth > 0)
    pitch_angle_rad = straight_bevel::pitch_angle(teeth, mate_teeth, shaft_angle_rad);
}

bevel_gear::BevelGearParameters read_bevel_gear(toml::TableReader& gear, const std::string& directory) {
  bevel_gear::BevelGearParameters p;
  p.teeth = gear.integer("teeth", kTeeth).value_or(0);
  p.shaft_angle_rad = radians(gear.number_or("shaft_angle", kShaftAngle, degrees(p.shaft_angle_rad)));
  read_pitch_angle(gear, p.teeth, p.shaft_angle_rad, p.mate_teeth, p.pitch_angle_rad);
  const auto module = gear.number("outer_transverse_module", kModule);
  p.outer_transverse_module_mm = module.value_or(0);
  p.pressure_angle_rad = radians(gear.number("pressure_angle", kPressureAngle).value_or(0));
  p.outer_spiral_angle_rad = radians(gear.number("outer_spiral_angle", {0, 60, " deg"}).value_or(0));
  p.face_width_mm = gear.number("face_width", {kLeastFace, kLength.high, " mm"}).value_or(0);
  const auto form = gear.variant("form", {"herringbone", "single"});
  if (form) p.form = *form == "single" ? bevel_gear::BevelForm::single : bevel_gear::BevelForm::herringbone;
  if (const auto hand = gear.word("hand", {"right", "left"})) p.hand = *hand == "right" ? 1 : -1;
  const bool herringbone = p.form == bevel_gear::BevelForm::herringbone;
  p.apex_cone_distance_mm =
      (herringbone ? gear.number("apex_cone_distance", kRadius) : gear.optional_number("apex_cone_distance", kRadius))
          .value_or(0);
  if (herringbone) p.relief_half_width_mm = gear.number("relief_half_width", kLength).value_or(0);
  else if (gear.misplaced("relief_half_width"))
    gear.refuse("relief_half_width", "relief_half_width contradicts form = \"single\": one hand has no relief groove");
  p.addendum_mm = gear.number("addendum", kLength).value_or(0);
  p.dedendum_mm = gear.number("dedendum", kLength).value_or(0);
  p.backlash_mm = gear.number_or("backlash", kLengthOrZero, p.backlash_mm);
  if (module && p.backlash_mm >= *module)
    gear.refuse("backlash", "backlash = {} mm is not below outer_transverse_module = {} mm", p.backlash_mm, *module);
  if (auto mill = gear.table("mill")) {
    p.mill.emplace();
    p.mill->module_mm = mill->number("module", kModule).value_or(0);
    p.mill->tip_radius_mm = mill->number("tip_radius", kLength).value_or(0);
    p.mill->rack_depth_mm = mill->number("rack_depth", kLengthOrZero).value_or(0);
    p.mill->profile_height_mm = mill->number("profile_height", kLength).value_or(0);
    mill->finish();
  }
  p.modifications = read_modifications(gear, directory);
  optional_cylinder(gear, "hub", p.hub_diameter_mm, p.hub_length_mm);
  optional_cylinder(gear, "shaft", p.shaft_diameter_mm, p.shaft_length_mm);
  if (p.face_width_mm > 0 && p.pitch_angle_rad > 0 && module && p.teeth > 0) {
    const double outer = *module * p.teeth / (2 * std::sin(p.pitch_angle_rad));
    if (p.face_width_mm >= outer)
      gear.refuse("face_width", "face_width = {} mm is not below the outer cone distance {:.4f} mm", p.face_width_mm,
                  outer);
    const double inner = outer - p.face_width_mm, apex = p.apex_cone_distance_mm;
    if (apex > 0 && (apex <= inner || apex > outer || (herringbone && apex >= outer)))
      gear.refuse("apex_cone_distance", "apex_cone_distance = {} mm lies outside the face, {:.4f} to {:.4f} mm", apex,
                  inner, outer);
  }
  gear.finish();
  return p;
}

cylindrical::CylindricalParameters read_cylindrical_gear(toml::TableReader& gear, std::vector<std::string>& warnings) {
  cylindrical::CylindricalParameters p;
  p.teeth = gear.integer("teeth", kTeeth).value_or(0);
  const auto module = gear.number("module", kModule);
  p.module_mm = module.value_or(0);
  read_module_plane(gear, p.module_plane);
  p.pressure_angle_rad = radians(gear.number("pressure_angle", kPressureAngle).value_or(0));
  p.profile_shift = gear.number_or("profile_shift", {-5, 5}, p.profile_shift);
  p.addendum_coefficient = gear.number_or("addendum_coefficient", {0.1, 3}, p.addendum_coefficient);
  p.dedendum_coefficient = gear.number_or("dedendum_coefficient", {0.1, 3}, p.dedendum_coefficient);
  p.root_radius_coefficient = gear.number_or("root_radius_coefficient", {0, 1}, p.root_radius_coefficient);
  p.tip_diameter_mm = gear.optional_number("tip_diameter", kLength);
  p.thickness_allowance_mm = gear.number_or("thickness_allowance", {-100, 0, " mm"}, p.thickness_allowance_mm);
  p.bore_diameter_mm = gear.number_or("bore_diameter", kLengthOrZero, p.bore_diameter_mm);
  p.groove_diameter_mm = gear.optional_number("groove_diameter", kLength);
  const auto land = gear.optional_number("least_land", kLengthOrZero);
  if (module && land && *land >= *module)
    gear.refuse("least_land", "least_land = {} mm is not below module = {} mm", *land, *module);
  else if (module && land && *land > 0) p.least_land = *land / *module;
  for (auto& table : zone_tables(gear)) {
    cylindrical::CylindricalZone zone;
    zone.helix_angle_rad = read_helix_angle(table, warnings);
    const auto from = table.number("from", kSignedLength), to = table.number("to", kSignedLength);
    zone.from_mm = from.value_or(0);
    zone.to_mm = to.value_or(0);
    if (from && to && *to <= *from) table.refuse("to", "to = {} mm is not above from = {} mm", *to, *from);
    else if (from && to && *to - *from < kLeastFace)
      table.refuse("to", "to - from = {:.6g} mm of face is below {} mm", *to - *from, kLeastFace);
    else if (from && !p.zones.empty() && *from <= p.zones.back().to_mm)
      table.refuse("from", "from = {} mm is not above {} mm, the end of the zone before: zones rise in z", *from,
                   p.zones.back().to_mm);
    table.finish();
    p.zones.push_back(zone);
  }
  gear.finish();
  return p;
}

straight_bevel::StraightBevelParameters read_straight_bevel_gear(toml::TableReader& gear) {
  straight_bevel::StraightBevelParameters p;
  p.teeth = gear.integer("teeth", kTeeth).value_or(0);
  const bool shaft = gear.has("shaft_angle");
  const double shaft_angle = radians(gear.number_or("shaft_angle", kShaftAngle, 90));
  int mate_teeth = 0;
  read_pitch_angle(gear, p.teeth, shaft_angle, mate_teeth, p.pitch_angle_rad);
  if (shaft && gear.has("pitch_angle") && !gear.has("mate_teeth"))
    gear.refuse("shaft_angle", "shaft_angle contradicts pitch_angle: it goes with mate_teeth");
  p.outer_transverse_module_mm = gear.number("outer_transverse_module", kModule).value_or(0);
  p.pressure_angle_rad = radians(gear.number("pressure_angle", kPressureAngle).value_or(0));
  if (const auto form = gear.word("form", {"octoid", "spherical_involute"}))
    p.form = *form == "octoid" ? straight_bevel::Form::octoid : straight_bevel::Form::spherical_involute;
  p.face_width_mm = gear.number("face_width", {kLeastFace, kLength.high, " mm"}).value_or(0);
  p.addendum_mm = gear.number("addendum", kLength).value_or(0);
  p.dedendum_mm = gear.number("dedendum", kLength).value_or(0);
  if (const auto tip = gear.optional_number("tip_angle", {0.01, 170, " deg"})) p.tip_angle_rad = radians(*tip);
  p.thickness_shift = gear.number_or("thickness_shift", {-0.5, 0.5}, p.thickness_shift);
  p.fillet_radius_mm = gear.number("fillet_radius", kLength).value_or(0);
  p.backlash_mm = gear.number_or("backlash", kLengthOrZero, p.backlash_mm);
  p.bore_diameter_mm = gear.number_or("bore_diameter", kLengthOrZero, p.bore_diameter_mm);
  optional_cylinder(gear, "hub", p.hub_diameter_mm, p.hub_length_mm);
  const auto land = gear.optional_number("least_land", kLengthOrZero);
  const double module = p.outer_transverse_module_mm;
  if (land && module > 0 && *land >= module)
    gear.refuse("least_land", "least_land = {} mm is not below outer_transverse_module = {} mm", *land, module);
  else if (land && module > 0 && *land > 0) p.least_land = *land / module;
  gear.finish();
  return p;
}

/// A key with a number for the one blade, or with [outside, inside] for both.
std::array<double, 2> read_blades(toml::TableReader& cut, const char* key, bool both, const toml::Range& range) {
  if (!both) {
    const double one = cut.number(key, range).value_or(0);
    return {one, one};
  }
  const auto two = cut.numbers(key, 2, range);
  return two ? std::array{(*two)[0], (*two)[1]} : std::array{0.0, 0.0};
}

/// Rounding of the blades: both may have one.
std::array<double, 2> read_edges(toml::TableReader& cut, bool both) {
  const auto number = toml::ValueShape::of_range(toml::ValueKind::number, kLength);
  auto pair = toml::ValueShape::of_range(toml::ValueKind::numbers, kLength);
  pair.count = {2, 2};
  const toml::TomlValue* value =
      cut.value("tool_edge_radius", both ? std::vector{number, pair} : std::vector{number}, toml::Presence::required);
  return read_blades(cut, "tool_edge_radius", both && value && value->array(), kLength);
}

spiral_bevel::Cut read_cut(toml::TableReader& table, const spiral_bevel::SpiralBevelParameters& gear,
                           std::vector<std::string>& warnings) {
  using spiral_bevel::Cuts;
  spiral_bevel::Cut cut;
  if (const auto word = table.variant("flank", {"concave", "convex", "both"}))
    cut.flank = *word == "both" ? Cuts::both : *word == "concave" ? Cuts::concave : Cuts::convex;
  const bool both = cut.flank == Cuts::both;
  cut.generated = table.boolean_or("generated", true);
  const auto radii = read_blades(table, "blade_point_radius", both, kLength),
             angles = read_blades(table, "blade_pressure_angle", both, {1, 45, " deg"}),
             edges = read_edges(table, both);
  for (std::size_t k = 0; k < 2; ++k) cut.blades[k] = {radii[k], radians(angles[k]), edges[k]};
  cut.radial_distance_mm = table.number("radial_distance", kLengthOrZero).value_or(0);
  cut.cradle_angle_rad = radians(table.number("center_roll_position", {-180, 180, " deg"}).value_or(0));
  if (const auto angle = table.optional_number("machine_root_angle", {0.5, 90, " deg"}))
    cut.root_angle_rad = radians(*angle);
  else if (gear.root_angle_rad) cut.root_angle_rad = *gear.root_angle_rad;
  else if (!table.has("machine_root_angle"))
    table.refuse("machine_root_angle",
                 "[[gear.cut]] lacks the key \"machine_root_angle\", and [gear] has no root_angle");
  cut.work_offset_mm = table.number_or("work_offset", kSignedLength, cut.work_offset_mm);
  cut.sliding_base_mm = table.number_or("sliding_base", kSignedLength, cut.sliding_base_mm);
  cut.machine_center_mm = table.number_or("machine_center_to_crossing_point", kSignedLength, cut.machine_center_mm);
  const auto ratio = table.optional_number("ratio_of_roll", {0, 1000, "", true});
  cut.ratio_of_roll = ratio.value_or(0);
  cut.modified = table.optional_number_list("modified_roll_coefficients", {-1000, 1000}, {0, 7}).value_or(cut.modified);
  if (cut.generated && !table.has("ratio_of_roll"))
    table.refuse("ratio_of_roll",
                 "[[gear.cut]] lacks the key \"ratio_of_roll\": work per cradle; without a roll say generated = false");
  for (const char* key : {"ratio_of_roll", "modified_roll_coefficients"})
    if (!cut.generated && table.has(key)) table.refuse(key, "{} contradicts generated = false: nothing rolls", key);
  const double slip = cut.ratio_of_roll * std::sin(gear.pitch_angle_rad);
  if (ratio && gear.pitch_angle_rad > 0 && (slip < 0.93 || slip > 1.07)) {
    const auto at = table.where("ratio_of_roll");
    warnings.push_back(fmt::format(
        "{}:{}:{}: warning: ratio_of_roll = {} is {:.3f} times 1 / sin(pitch_angle); work per cradle is meant, its "
        "reciprocal is {:.6g}",
        at.file, at.line, at.column, *ratio, slip, 1 / *ratio));
  }
  cut.tilt_rad = radians(table.number_or("cutter_tilt", {-45, 45, " deg"}, 0));
  cut.swivel_rad = radians(table.number_or("cutter_swivel", {-360, 360, " deg"}, 0));
  table.finish();
  return cut;
}

spiral_bevel::SpiralBevelParameters read_spiral_bevel_gear(toml::TableReader& gear,
                                                           std::vector<std::string>& warnings) {
  spiral_bevel::SpiralBevelParameters p;
  p.teeth = gear.integer("teeth", kTeeth).value_or(0);
  if (const auto hand = gear.word("hand", {"right", "left"})) p.hand = *hand == "right" ? 1 : -1;
  p.shaft_angle_rad = radians(gear.number_or("shaft_angle", kShaftAngle, degrees(p.shaft_angle_rad)));
  p.pitch_angle_rad = radians(gear.number("pitch_angle", {1, 90, " deg"}).value_or(0));
  p.outer_cone_distance_mm = gear.number("outer_cone_distance", kLength).value_or(0);
  p.face_width_mm = gear.number("face_width", {kLeastFace, kLength.high, " mm"}).value_or(0);
  p.tip_angle_rad = radians(gear.number("tip_angle", {0.01, 170, " deg"}).value_or(0));
  p.tip_apex_mm = gear.number_or("tip_apex", kSignedLength, p.tip_apex_mm);
  if (const auto angle = gear.optional_number("root_angle", {0.5, 90, " deg"})) p.root_angle_rad = radians(*angle);
  p.root_apex_mm = gear.optional_number("root_apex", kSignedLength);
  p.mean_space_width_mm = gear.optional_number("mean_space_width", kLength);
  p.backlash_mm = gear.optional_number("backlash", kLengthOrZero);
  p.bore_diameter_mm = gear.number_or("bore_diameter", kLengthOrZero, p.bore_diameter_mm);
  optional_cylinder(gear, "hub", p.hub_diameter_mm, p.hub_length_mm);
  auto cuts = gear.tables("cut", {1, 2}, toml::Presence::required);
  if (!gear.has("cut"))
    gear.refuse("cut", "[gear] lacks its cuts: one [[gear.cut]] with flank = \"both\", or one for each flank");
  if (cuts.size() > 2) gear.refuse("cut", "{} cuts exceed the limit 2", cuts.size());
  for (auto& table : cuts) p.cuts.push_back(read_cut(table, p, warnings));
  gear.finish();
  return p;
}

/// A list of [r, z].
std::vector<Vec2> read_meridian(toml::TableReader& gear, const char* key) {
  toml::ValueShape rows{toml::ValueKind::rows};
  rows.columns = {"r", "z"};
  rows.ranges = {kRadius, kSignedLength};
  rows.count = {2, kMostCorners};
  std::vector<Vec2> out;
  const toml::TomlValue* value = gear.value(key, {rows}, toml::Presence::required);
  if (!value) {
    gear.refuse(key, "[gear] lacks the key \"{}\": the meridian [[r, z], ..]", key);
    return out;
  }
  const toml::TomlArray* list = value->array();
  if (!list || list->values.size() < 2 || list->values.size() > kMostCorners) {
    gear.refuse(key, "{} must be a list of 2 to {} pairs [r, z] in mm", key, kMostCorners);
    return out;
  }
  for (std::size_t k = 0; k < list->values.size(); ++k)
    if (const auto pair = gear.numbers_of(list->values[k], fmt::format("{}[{}]", key, k), {kRadius, kSignedLength}))
      out.emplace_back((*pair)[0], (*pair)[1]);
  return out;
}

flank_grid::FlankGridParameters read_flank_grid(toml::TableReader& gear, const std::string& directory) {
  flank_grid::FlankGridParameters p;
  p.teeth = gear.integer("teeth", kTeeth).value_or(0);
  if (const auto name = gear.text("points")) {
    p.file = (std::filesystem::path(directory) / *name).string();
    if (const auto text = toml::read_input_text(p.file, kMostPointBytes); !text) {
      gear.refuse("points", "points = \"{}\": {}", *name, text.error().message);
    } else if (auto points = parse_flank_points(*text, p.file); !points) {
      gear.refuse_at(points.error().position, "{}", points.error().message);
    } else {
      p.plus = std::move(points->plus);
      p.minus = std::move(points->minus);
    }
  }
  p.fillet_radius_mm = gear.number("fillet_radius", kLength).value_or(0);
  p.root = read_meridian(gear, "root");
  p.tip = read_meridian(gear, "tip");
  p.bore_diameter_mm = gear.number_or("bore_diameter", kLengthOrZero, p.bore_diameter_mm);
  optional_cylinder(gear, "hub", p.hub_diameter_mm, p.hub_length_mm);
  gear.finish();
  return p;
}

/// [stock] is a table of face gears.
void refuse_stock(toml::TableReader& root, const Job& job) {
  if (root.misplaced("stock")) root.refuse("stock", "[stock] belongs to face gears; this gear is {}", job.gear_type());
}

/// A type of gear in job files.
struct GearType {
  const char* word;
  /// Reads [gear] and, where it belongs to the gear, [stock].
  void (*read)(toml::TableReader& gear, toml::TableReader& root, Job& job);
};

// A line a type, in the order of the variant `Job::gear`; a type without its line does not compile.
constexpr GearType kGearTypes[] = {
    {"face_gear",
     [](toml::TableReader& gear, toml::TableReader& root, Job& job) {
       auto stock = root.table("stock");
       job.gear = read_face_gear(gear, stock ? &*stock : nullptr, job.face_body, job.directory(), job.warnings);
     }},
    {"equal_base_circle_bevel_gear",
     [](toml::TableReader& gear, toml::TableReader& root, Job& job) {
       job.gear = read_bevel_gear(gear, job.directory());
       refuse_stock(root, job);
     }},
    {"cylindrical_gear",
     [](toml::TableReader& gear, toml::TableReader& root, Job& job) {
       job.modifications = read_modifications(gear, job.directory());
       job.gear = read_cylindrical_gear(gear, job.warnings);
       refuse_stock(root, job);
     }},
    {"straight_bevel_gear",
     [](toml::TableReader& gear, toml::TableReader& root, Job& job) {
       job.modifications = read_modifications(gear, job.directory());
       job.gear = read_straight_bevel_gear(gear);
       refuse_stock(root, job);
     }},
    {"spiral_bevel_gear",
     [](toml::TableReader& gear, toml::TableReader& root, Job& job) {
       job.modifications = read_modifications(gear, job.directory());
       job.gear = read_spiral_bevel_gear(gear, job.warnings);
       refuse_stock(root, job);
     }},
    {"flank_grid",
     [](toml::TableReader& gear, toml::TableReader& root, Job& job) {
       job.modifications = read_modifications(gear, job.directory());
       job.gear = read_flank_grid(gear, job.directory());
       refuse_stock(root, job);
     }},
};
static_assert(std::size(kGearTypes) == std::variant_size_v<decltype(Job::gear)>);

}  // namespace

std::string Job::directory() const { return std::filesystem::path(file).parent_path().string(); }

const char* Job::gear_type() const { return kGearTypes[gear.index()].word; }

void read_gear(toml::TableReader& root, Job& job) {
  auto gear = root.table("gear", toml::Presence::required);
  (void)root.misplaced("stock");  // where no type of gear reads it, it is not judged
  if (!gear) {
    if (!root.has("gear")) root.refuse("gear", "the job lacks the table [gear]");
    return;
  }
  std::vector<std::string_view> words;
  for (const GearType& type : kGearTypes) words.emplace_back(type.word);
  const auto named = gear->variant("type", words);
  if (!named) return gear->name_misspelt("type");  // which keys belong here is unknown
  for (const GearType& type : kGearTypes)
    if (*named == type.word) type.read(*gear, root, job);
}

}  // namespace toothpath::job
