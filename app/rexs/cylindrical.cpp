// Cylindrical gears: reference profile by the rack-shaped tool that makes the flanks.
#include <cmath>

#include "app/rexs/gears.h"
#include "geometry/base/angle.h"

namespace toothpath::rexs {
namespace {

constexpr toml::Range kCoefficient{-5, 5};
constexpr double kSameLength = 0.005, kSameCoefficient = 1e-6;  // mm; modules

/// A coefficient, or a length in modules.
std::optional<double> in_modules(const Quantities& q, const char* coefficient, const char* length, double module_mm) {
  if (const auto value = q.optional(coefficient, Unit::none, kCoefficient)) return value;
  const auto mm = q.optional(length, Unit::mm, {-1000, 1000, " mm"});
  return mm ? std::optional(*mm / module_mm) : std::nullopt;
}

/// Numbers that both flanks have.
struct Profile {
  double pressure_angle = 0, shift = 0;  // deg, modules
};
Profile profile_of(const Quantities& flank, double module_mm) {
  Profile out;
  out.pressure_angle = flank.number("normal_pressure_angle", Unit::deg, {5, 40, " deg"});
  const auto shift = in_modules(flank, "addendum_modification_coefficient", "addendum_modification", module_mm);
  if (!shift) flank.missing("addendum_modification_coefficient");
  out.shift = shift.value_or(0);
  return out;
}

/// The tool's part of the profile, or what was said in its place.
void take_tool(const RexsFile& file, const Component& flank, const Said& said, cylindrical::CylindricalParameters& p,
               Refused& refused) {
  const Step step = step_of(file, flank);
  if (!step.tool) {
    if (!said.dedendum_coefficient || !said.root_radius_coefficient)
      refused.add(flank.at,
                  "{} has no manufacturing_step with a rack_shaped_tool: how deep the root lies and how it is rounded "
                  "say --dedendum-coefficient and --root-radius-coefficient instead",
                  flank.title());
    p.dedendum_coefficient = said.dedendum_coefficient.value_or(1.25);
    p.root_radius_coefficient = said.root_radius_coefficient.value_or(0.38);
    return;
  }
  if (said.dedendum_coefficient || said.root_radius_coefficient)
    return refused.add(step.tool->at,
                       "{} says the reference profile: --dedendum-coefficient and --root-radius-coefficient are for "
                       "gears without a tool",
                       step.tool->title());
  if (step.tool->type != "rack_shaped_tool")
    return refused.add(step.tool->at, "{} makes {}: only a rack_shaped_tool is read", step.tool->title(),
                       flank.title());
  const Quantities tool(*step.tool, refused);
  if (const auto module = tool.optional("normal_module", Unit::mm, kLength);
      module && std::abs(*module - p.module_mm) > kSameCoefficient * p.module_mm)
    refused.add(at_of(*step.tool, "normal_module"),
                "normal_module = {:.10g} mm of {} is not that of the gear, {:.10g} mm", *module, step.tool->title(),
                p.module_mm);
  if (const auto angle = tool.optional("normal_pressure_angle", Unit::deg, {5, 40, " deg"});
      angle && std::abs(radians(*angle) - p.pressure_angle_rad) > 1e-6)
    refused.add(at_of(*step.tool, "normal_pressure_angle"),
                "normal_pressure_angle = {:.10g} deg of {} is not that of the flank, {:.10g} deg", *angle,
                step.tool->title(), degrees(p.pressure_angle_rad));
  for (const char* id : {"protuberance_amount", "protuberance_amount_factor"})
    tool.must_be_zero(id, "a protuberance is not there yet");
  const auto depth =
                 in_modules(tool, "addendum_coefficient_reference_profile", "addendum_reference_profile", p.module_mm),
             radius = in_modules(tool, "tip_radius_factor", "tip_radius", p.module_mm);
  if (!depth) tool.missing("addendum_coefficient_reference_profile");
  if (!radius) tool.missing("tip_radius_factor");
  p.dedendum_coefficient = depth.value_or(1.25);
  p.root_radius_coefficient = radius.value_or(0.38);
  if (!step.settings) return;
  // Cut with x_E instead of x: thinner teeth, and a root that lies as much deeper.
  const Quantities settings(*step.settings, refused);
  const auto generated = settings.optional("generated_addendum_modification_coefficient", Unit::none, kCoefficient);
  if (!generated) return;
  const double less = p.profile_shift - *generated;
  if (less < -kSameCoefficient)
    refused.add(at_of(*step.settings, "generated_addendum_modification_coefficient"),
                "generated_addendum_modification_coefficient = {:.6f} of {} is above the nominal {:.6f}: stock for "
                "another process; the finishing step is needed",
                *generated, step.settings->title(), p.profile_shift);
  p.thickness_allowance_mm = std::min(0.0, -2 * less * p.module_mm * std::tan(p.pressure_angle_rad));
  p.dedendum_coefficient += less;
}

}  // namespace

cylindrical::CylindricalParameters cylindrical_of(const RexsFile& file, const Component& gear, const Said& said,
                                                  Refused& refused) {
  const Quantities q(gear, refused);
  cylindrical::CylindricalParameters p;
  p.teeth = q.whole("number_of_teeth", {3, 5000});
  const double helix = radians(q.number("helix_angle_reference_diameter", Unit::deg, {-60, 60, " deg"}));
  if (gear.find("normal_module") || !gear.find("transverse_module"))
    p.module_mm = q.number("normal_module", Unit::mm, {0.01, 100, " mm"});
  else p.module_mm = q.number("transverse_module", Unit::mm, {0.01, 100, " mm"}) * std::cos(helix);
  const double width = q.number("face_width", Unit::mm, kLength);
  p.zones = {{helix, -0.5 * width, 0.5 * width}};
  p.bore_diameter_mm = q.optional("inner_diameter", Unit::mm, {0, 10000, " mm"}).value_or(0);
  const Flanks flanks = flanks_of(file, gear, refused);
  if (!flanks.left || !refused.errors.empty()) return p;
  const Quantities left(*flanks.left, refused), right(*flanks.right, refused);
  const Profile profile = profile_of(left, p.module_mm), other = profile_of(right, p.module_mm);
  if (std::abs(profile.pressure_angle - other.pressure_angle) > 1e-6 ||
      std::abs(profile.shift - other.shift) > kSameCoefficient)
    refused.add(flanks.right->at,
                "{} has {:.6g} deg and a profile shift of {:.6g}, {} {:.6g} deg and {:.6g}: both flanks must be alike",
                flanks.right->title(), other.pressure_angle, other.shift, flanks.left->title(), profile.pressure_angle,
                profile.shift);
  p.pressure_angle_rad = radians(profile.pressure_angle);
  p.profile_shift = profile.shift;
  if (step_of(file, *flanks.left).tool != step_of(file, *flanks.right).tool)
    refused.add(flanks.right->at, "{} is not made by the tool of {}: one tool must make both flanks",
                flanks.right->title(), flanks.left->title());
  else take_tool(file, *flanks.left, said, p, refused);
  const double d = p.module_mm * p.teeth / std::cos(helix);
  p.tip_diameter_mm = q.optional("tip_diameter", Unit::mm, kLength);
  if (p.tip_diameter_mm && *p.tip_diameter_mm <= d + 2 * p.module_mm * (p.profile_shift - 0.9))
    refused.add(at_of(gear, "tip_diameter"),
                "tip_diameter = {:.6g} mm of {} is below its teeth: their reference "
                "diameter is {:.6g} mm",
                *p.tip_diameter_mm, gear.title(), d);
  const auto root = q.optional("root_diameter", Unit::mm, kLength);
  const double made = d + 2 * p.module_mm * (p.profile_shift - p.dedendum_coefficient);
  if (root && refused.errors.empty() && std::abs(*root - made) > kSameLength)
    refused.add(at_of(gear, "root_diameter"),
                "root_diameter = {:.6g} mm of {} is not what its tool makes, {:.6g} mm, within {:g} mm", *root,
                gear.title(), made, kSameLength);
  return p;
}

}  // namespace toothpath::rexs
