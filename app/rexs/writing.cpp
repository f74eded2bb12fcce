// Gears of jobs as REXS files: the components that the readers of this room ask for, filled in.
#include <algorithm>
#include <array>
#include <cmath>

#include "app/rexs/gears.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/involute_kernel.h"
#include "geometry/spiral_bevel/set_up.h"

namespace toothpath::rexs {
namespace {

using cylindrical::CylindricalParameters;
using spiral_bevel::SpiralBevelParameters;

/// Fifteen digits: what turning radians into degrees leaves of a number.
std::string digits(double x) { return fmt::format("{:.15g}", x == 0 ? 0.0 : x); }

Attribute attribute(const char* id, const char* unit, std::string text) {
  Attribute out;
  out.id = id;
  out.unit = unit;
  out.states_unit = true;
  out.text = std::move(text);
  return out;
}
Attribute mm(const char* id, double value) { return attribute(id, "mm", digits(value)); }
Attribute deg(const char* id, double value_rad) { return attribute(id, "deg", digits(degrees(value_rad))); }
Attribute plain(const char* id, double value) { return attribute(id, "none", digits(value)); }

/// Adds components one behind the other.
class Making {
 public:
  int add(const char* type, const std::string& name, std::vector<Attribute> attributes) {
    const int id = int(out.components.size()) + 1;
    out.components.push_back({id, type, name, std::move(attributes), {}});
    return id;
  }
  void relate(const char* type, const std::vector<std::pair<int, const char*>>& refs, int order = 0) {
    Relation relation{type, order, {}, {}};
    for (const auto& [id, role] : refs) relation.refs.push_back({id, role, {}});
    out.relations.push_back(std::move(relation));
  }
  RexsFile out;
};

/// Which side of a space a flank bounds, so that its points find it.
Attribute side_of_space(int side) { return plain("custom_flank_side", side); }

std::vector<Attribute> settings_of(const spiral_bevel::Cut& cut) {
  std::vector<Attribute> out = {mm("radial_distance", cut.radial_distance_mm),
                                deg("center_roll_position", cut.cradle_angle_rad),
                                deg("machine_root_angle", cut.root_angle_rad),
                                mm("work_offset", cut.work_offset_mm),
                                mm("sliding_base", cut.sliding_base_mm),
                                mm("machine_center_to_crossing_point", cut.machine_center_mm),
                                plain("ratio_of_roll", cut.generated ? cut.ratio_of_roll : 0),
                                deg("cutter_tilt", cut.tilt_rad),
                                deg("cutter_swivel", cut.swivel_rad)};
  if (!cut.modified.empty()) {
    out.push_back(attribute("modified_roll_coefficients", "none", ""));
    for (const double c : cut.modified) out.back().cells.push_back(digits(c));
  }
  return out;
}

}  // namespace

Expected<Written, Refusal> rexs_of(const CylindricalParameters& p, const std::string& name) {
  if (p.zones.size() != 1)
    return Refusal{"zone", fail("{} zones: a cylindrical_gear of REXS has one ring of teeth", p.zones.size())};
  const auto& zone = p.zones.front();
  const double beta = zone.helix_angle_rad;
  // REXS counts in normal modules.
  const bool normal = p.module_plane == ModulePlane::normal;
  const double m_n = normal ? p.module_mm : p.module_mm * std::cos(beta), as_given = p.module_mm / m_n,
               alpha_n = normal ? p.pressure_angle_rad : std::atan(std::tan(p.pressure_angle_rad) * std::cos(beta)),
               x = p.profile_shift * as_given, less = -p.thickness_allowance_mm / (2 * m_n * std::tan(alpha_n));
  const cylindrical::InvoluteKernel<double> radii(p, zone);
  Written out;
  Making making;
  std::vector<Attribute> body = {
      plain("number_of_teeth", p.teeth),           mm("normal_module", m_n),
      deg("helix_angle_reference_diameter", beta), mm("face_width", zone.to_mm - zone.from_mm),
      mm("tip_diameter", 2 * radii.r_a),           mm("root_diameter", 2 * radii.r_f)};
  if (p.bore_diameter_mm > 0) body.push_back(mm("inner_diameter", p.bore_diameter_mm));
  const int gear = making.add("cylindrical_gear", name, std::move(body));
  std::array<int, 2> flanks{};
  for (const int side : {1, -1})
    flanks[side > 0 ? 0 : 1] = making.add(
        "cylindrical_gear_flank", fmt::format("{}, flank {:+}", name, side),
        {deg("normal_pressure_angle", alpha_n), plain("addendum_modification_coefficient", x), side_of_space(side)});
  const int tool =
      making.add("rack_shaped_tool", name + ", rack",
                 {mm("normal_module", m_n), deg("normal_pressure_angle", alpha_n),
                  plain("addendum_coefficient_reference_profile", p.dedendum_coefficient * as_given - less),
                  plain("tip_radius_factor", p.root_radius_coefficient * as_given)});
  making.relate("flank", {{gear, "gear"}, {flanks[0], "left"}, {flanks[1], "right"}});
  const int settings = less > 0 ? making.add("cylindrical_gear_manufacturing_settings", name + ", finished",
                                             {plain("generated_addendum_modification_coefficient", x - less)})
                                : 0;
  for (const int flank : flanks) {
    std::vector<std::pair<int, const char*>> refs = {{flank, "workpiece"}, {tool, "tool"}};
    if (settings != 0) refs.emplace_back(settings, "manufacturing_settings");
    making.relate("manufacturing_step", refs, 1);
  }
  if (std::abs(zone.from_mm + zone.to_mm) > 1e-9)
    out.notes.push_back(
        fmt::format("REXS has no z = 0 of a gear: the teeth, from {:.6g} to {:.6g} mm, are read back "
                    "about their middle",
                    zone.from_mm, zone.to_mm));
  out.file = std::move(making.out);
  return out;
}

Expected<Written, Refusal> rexs_of(const SpiralBevelParameters& p, const std::string& name) {
  Written out;
  Making making;
  std::vector<Attribute> blank = {plain("number_of_teeth", p.teeth),
                                  attribute("spiral_angle_pitch_direction", "none", p.hand > 0 ? "right" : "left"),
                                  deg("pitch_angle", p.pitch_angle_rad),
                                  mm("outer_cone_distance", p.outer_cone_distance_mm),
                                  mm("face_width", p.face_width_mm),
                                  deg("face_angle", p.tip_angle_rad),
                                  mm("face_apex_beyond_crossing_point", p.tip_apex_mm)};
  if (p.root_angle_rad) blank.push_back(deg("root_angle", *p.root_angle_rad));
  if (p.root_apex_mm) blank.push_back(mm("root_apex_beyond_crossing_point", *p.root_apex_mm));
  if (p.cuts.size() == 2)
    blank.push_back(mm(
        "mean_transverse_circular_thickness",
        kTwoPi * p.mean_cone_distance() * std::sin(p.pitch_angle_rad) / p.teeth - spiral_bevel::asked_space_width(p)));
  const int gear = making.add("bevel_gear", name, std::move(blank));
  const int stage = making.add("bevel_stage", name + ", pair", {deg("shaft_angle", p.shaft_angle_rad)});
  making.relate("stage", {{stage, "stage"}, {gear, "gear_1"}});
  std::vector<int> settings;
  for (std::size_t c = 0; c < p.cuts.size(); ++c)
    settings.push_back(making.add("bevel_gear_manufacturing_settings", fmt::format("{}, cut {}", name, c + 1),
                                  settings_of(p.cuts[c])));
  std::array<int, 2> flanks{};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t cut = spiral_bevel::cut_of(p, k);
    const spiral_bevel::Blade& blade = p.cuts[cut].blades[k];
    const char* word = k == 0 ? "concave" : "convex";
    flanks[k] =
        making.add("bevel_gear_flank", fmt::format("{}, {}", name, word), {side_of_space((k == 0 ? 1 : -1) * p.hand)});
    const int tool = making.add(
        "bevel_gear_tool", fmt::format("{}, {} blade", name, k == 0 ? "outside" : "inside"),
        {mm("blade_point_radius", blade.point_radius_mm), deg("blade_pressure_angle", blade.pressure_angle_rad),
         mm("tool_edge_radius_bevel_gear_tool", blade.edge_radius_mm)});
    making.relate("manufacturing_step",
                  {{flanks[k], "workpiece"}, {tool, "tool"}, {settings[cut], "manufacturing_settings"}}, 1);
  }
  making.relate("flank", {{gear, "gear"}, {flanks[0], "left"}, {flanks[1], "right"}});
  if (p.cuts.size() == 2)
    out.notes.emplace_back(
        "REXS does not say which flank is concave: here the left one is, new --rexs --left-flank "
        "concave");
  if (p.bore_diameter_mm > 0 || p.hub_diameter_mm > 0)
    out.notes.emplace_back("bore and hub have no attributes at a bevel_gear of REXS and are left out");
  out.file = std::move(making.out);
  return out;
}

void add_flank_grid(RexsFile& file, const std::vector<inspection::InspectionPoint>& points) {
  for (Component& component : file.components) {
    const Attribute* side = component.find("custom_flank_side");
    if (!side) continue;
    std::array<Attribute, 8> grid = {
        attribute("custom_grid_row", "none", ""), attribute("custom_grid_column", "none", ""),
        attribute("custom_grid_x", "mm", ""),     attribute("custom_grid_y", "mm", ""),
        attribute("custom_grid_z", "mm", ""),     attribute("custom_grid_i", "none", ""),
        attribute("custom_grid_j", "none", ""),   attribute("custom_grid_k", "none", "")};
    for (const inspection::InspectionPoint& at : points) {
      if (digits(at.side) != side->text) continue;
      const std::array<double, 8> numbers = {double(at.row), double(at.column), at.p.x(), at.p.y(),
                                             at.p.z(),       at.n.x(),          at.n.y(), at.n.z()};
      for (std::size_t k = 0; k < grid.size(); ++k) grid[k].cells.push_back(digits(numbers[k]));
    }
    component.attributes.insert(component.attributes.end(), grid.begin(), grid.end());
  }
}

}  // namespace toothpath::rexs
