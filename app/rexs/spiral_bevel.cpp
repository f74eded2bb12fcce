// Spiral bevel gears by the settings of their generator.
#include <array>
#include <cmath>

#include "app/rexs/gears.h"
#include "geometry/base/angle.h"
#include "geometry/base/printable.h"

namespace toothpath::rexs {
namespace {

using spiral_bevel::Cut;
using spiral_bevel::Cuts;
using spiral_bevel::SpiralBevelParameters;

constexpr toml::Range kSigned{-10000, 10000, " mm"};
constexpr double kSlip[] = {0.93, 1.07};  // of ratio_of_roll sin(pitch angle)
constexpr double kSame = 1e-9;            // mm, rad: settings that are one

bool rolls(double slip) { return slip >= kSlip[0] && slip <= kSlip[1]; }

/// What moves during the roll besides cradle and work, and what a cutter may have besides a straight blade.
void refuse_unknown(const Quantities& settings, const Quantities& tool) {
  for (const char* id : {"angular_motion_coefficients", "helical_motion_coefficients", "horizontal_motion_coefficients",
                         "radial_motion_coefficients", "swivel_motion_coefficients", "tilt_motion_coefficients",
                         "vertical_motion_coefficients"})
    settings.must_be_zero(id, "only the roll may be modified");
  settings.must_be_zero("horizontal_distance", "the cutter is placed by radial_distance and center_roll_position");
  for (const char* id :
       {"blade_spheric_radius", "protuberance_height_bevel_gear_tool", "protuberance_angle_bevel_gear_tool",
        "tip_relief_height_bevel_gear_tool", "tip_relief_angle_bevel_gear_tool"})
    tool.must_be_zero(id, "blades are straight, with one rounding at their tip");
  for (const char* id : {"side_rake_angle", "rakeface_inclination_angle"})
    tool.must_be_zero(id, "the blade's profile is that in the axial plane of the cutter");
}

/// One flank's set-up.
struct Made {
  Cut cut;
  const Component* settings = nullptr;
  const Component* tool = nullptr;
};

std::optional<Made> made_of(const RexsFile& file, const Component& flank, const SpiralBevelParameters& gear,
                            Refused& refused) {
  const Step step = step_of(file, flank);
  if (!step.tool || !step.settings) {
    refused.add(flank.at,
                "{} has no {}: a relation of type \"manufacturing_step\" with the roles workpiece, tool and "
                "manufacturing_settings is needed",
                flank.title(), !step.tool ? "bevel_gear_tool" : "bevel_gear_manufacturing_settings");
    return {};
  }
  for (const auto& [part, type] :
       {std::pair(step.tool, "bevel_gear_tool"), {step.settings, "bevel_gear_manufacturing_settings"}})
    if (part->type != type) {
      refused.add(part->at, "{} makes {}: a {} is needed", part->title(), flank.title(), type);
      return {};
    }
  const Quantities settings(*step.settings, refused), tool(*step.tool, refused), own(flank, refused);
  refuse_unknown(settings, tool);
  Made made{{}, step.settings, step.tool};
  Cut& cut = made.cut;
  cut.radial_distance_mm = settings.number("radial_distance", Unit::mm, {0, 10000, " mm"});
  cut.cradle_angle_rad = radians(settings.number("center_roll_position", Unit::deg, {-180, 180, " deg"}));
  const toml::Range angle{0.5, 90, " deg"};
  if (step.settings->find("machine_root_angle") || !gear.root_angle_rad)
    cut.root_angle_rad = radians(settings.number("machine_root_angle", Unit::deg, angle));
  else cut.root_angle_rad = *gear.root_angle_rad;
  cut.work_offset_mm = settings.number("work_offset", Unit::mm, kSigned);
  cut.sliding_base_mm = settings.number("sliding_base", Unit::mm, kSigned);
  cut.machine_center_mm = settings.number("machine_center_to_crossing_point", Unit::mm, kSigned);
  cut.ratio_of_roll = settings.number("ratio_of_roll", Unit::none, {0, 1000});
  cut.generated = cut.ratio_of_roll > 0;
  cut.modified = settings.list("modified_roll_coefficients");
  if (cut.modified.size() > 7)
    refused.add(at_of(*step.settings, "modified_roll_coefficients"), "{} modified_roll_coefficients of {}, at most 7",
                cut.modified.size(), step.settings->title());
  for (const double coefficient : cut.modified)
    if (!(std::abs(coefficient) <= 1000))
      refused.add(at_of(*step.settings, "modified_roll_coefficients"),
                  "modified_roll_coefficients = {:.10g} of {} is outside -1000 to 1000", coefficient,
                  step.settings->title());
  while (!cut.modified.empty() && cut.modified.back() == 0) cut.modified.pop_back();
  cut.tilt_rad = radians(settings.optional("cutter_tilt", Unit::deg, {-45, 45, " deg"}).value_or(0));
  cut.swivel_rad = radians(settings.optional("cutter_swivel", Unit::deg, {-360, 360, " deg"}).value_or(0));
  spiral_bevel::Blade blade;
  blade.point_radius_mm = tool.number("blade_point_radius", Unit::mm, kLength);
  blade.pressure_angle_rad = radians(tool.number("blade_pressure_angle", Unit::deg, {1, 45, " deg"}));
  const auto edge = tool.optional("tool_edge_radius_bevel_gear_tool", Unit::mm, kLength),
             of_flank = own.optional("tool_edge_radius", Unit::mm, kLength);
  if (!edge && !of_flank)
    tool.missing("tool_edge_radius_bevel_gear_tool", "the rounding of the blade makes the fillet");
  blade.edge_radius_mm = edge ? *edge : of_flank.value_or(0);
  cut.blades = {blade, blade};
  return made;
}

bool one_set_up(const Cut& a, const Cut& b) {
  const auto same = [](double x, double y) { return std::abs(x - y) <= kSame; };
  return same(a.radial_distance_mm, b.radial_distance_mm) && same(a.cradle_angle_rad, b.cradle_angle_rad) &&
         same(a.root_angle_rad, b.root_angle_rad) && same(a.work_offset_mm, b.work_offset_mm) &&
         same(a.sliding_base_mm, b.sliding_base_mm) && same(a.machine_center_mm, b.machine_center_mm) &&
         same(a.ratio_of_roll, b.ratio_of_roll) && a.modified == b.modified && same(a.tilt_rad, b.tilt_rad) &&
         same(a.swivel_rad, b.swivel_rad);
}

/// Work per cradle, as R sin(delta) = 1 tells it or somebody says it.
void take_ratio(Made& made, const SpiralBevelParameters& gear, const Said& said, Obstacles& obstacles) {
  Cut& cut = made.cut;
  if (!cut.generated) return;
  const double R = cut.ratio_of_roll, sine = std::sin(gear.pitch_angle_rad);
  const bool work = rolls(R * sine), cradle = rolls(sine / R);
  if (!said.work_per_cradle && work == cradle) {
    const SourcePosition at = at_of(*made.settings, "ratio_of_roll");
    obstacles.questions.emplace_back(
        Open::ratio_of_roll,
        fmt::format("ratio_of_roll = {:.9g} of {}, line {}, times sin(pitch_angle) is {:.4f}, its reciprocal times it "
                    "{:.4f}: {} within {:g} to {:g}, so the file does not tell whether it is work per cradle",
                    R, made.settings->title(), at.line, R * sine, sine / R, work ? "both lie" : "neither lies",
                    kSlip[0], kSlip[1]));
    return;
  }
  if (!said.work_per_cradle.value_or(work)) cut.ratio_of_roll = 1 / R;
}

/// How wide the space is at the mean cone distance; two cuts do not fix it.
std::optional<double> space_width(const Quantities& q, const SpiralBevelParameters& gear) {
  auto tooth = q.optional("mean_transverse_circular_thickness", Unit::mm, kLength);
  if (!tooth)
    if (const auto normal = q.optional("mean_normal_circular_thickness", Unit::mm, kLength),
        spiral = q.optional("mean_spiral_angle", Unit::deg, {-80, 80, " deg"});
        normal && spiral)
      tooth = *normal / std::cos(radians(*spiral));
  if (!tooth) return {};
  return kTwoPi * gear.mean_cone_distance() * std::sin(gear.pitch_angle_rad) / gear.teeth - *tooth;
}

void take_shaft_angle(const RexsFile& file, const Component& gear, SpiralBevelParameters& p, Refused& refused) {
  for (const Relation& relation : file.relations) {
    const Reference *stage = relation.role("stage"), *one = relation.role("gear_1"), *two = relation.role("gear_2");
    const bool ours = (one && one->id == gear.id) || (two && two->id == gear.id);
    if (relation.type != "stage" || !stage || !ours) continue;
    const Quantities q(*file.find(stage->id), refused);
    if (const auto angle = q.optional("shaft_angle", Unit::deg, {20, 160, " deg"})) p.shaft_angle_rad = radians(*angle);
  }
}

SpiralBevelParameters blank_of(const Quantities& q, Refused& refused) {
  SpiralBevelParameters p;
  const Component& gear = q.component();
  p.teeth = q.whole("number_of_teeth", {3, 5000});
  const auto hand = q.word("spiral_angle_pitch_direction");
  if (!hand) q.missing("spiral_angle_pitch_direction");
  else if (*hand != "left" && *hand != "right")
    refused.add(at_of(gear, "spiral_angle_pitch_direction"),
                "spiral_angle_pitch_direction = \"{}\" of {} is neither left nor right", printable(*hand),
                gear.title());
  p.hand = hand && *hand == "left" ? -1 : 1;
  p.pitch_angle_rad = radians(q.number("pitch_angle", Unit::deg, {1, 90, " deg"}));
  p.face_width_mm = q.number("face_width", Unit::mm, kLength);
  const auto outer = q.optional("outer_cone_distance", Unit::mm, kLength),
             mean = q.optional("mean_cone_distance", Unit::mm, kLength);
  if (!outer && !mean) q.missing("outer_cone_distance");
  p.outer_cone_distance_mm = outer ? *outer : mean.value_or(1) + 0.5 * p.face_width_mm;
  p.tip_angle_rad = radians(q.number("face_angle", Unit::deg, {0.01, 170, " deg"}));
  p.tip_apex_mm = q.optional("face_apex_beyond_crossing_point", Unit::mm, kSigned).value_or(0);
  if (const auto root = q.optional("root_angle", Unit::deg, {0.5, 90, " deg"})) p.root_angle_rad = radians(*root);
  p.root_apex_mm = q.optional("root_apex_beyond_crossing_point", Unit::mm, kSigned);
  q.must_be_zero("pitch_apex_beyond_crossing_point", "gears with a hypoid offset are not there yet");
  return p;
}

}  // namespace

SpiralBevelParameters spiral_bevel_of(const RexsFile& file, const Component& gear, const Said& said, Refused& refused,
                                      Obstacles& obstacles) {
  const Quantities q(gear, refused);
  SpiralBevelParameters p = blank_of(q, refused);
  take_shaft_angle(file, gear, p, refused);
  const Flanks flanks = flanks_of(file, gear, refused);
  if (!flanks.left || !refused.errors.empty()) return p;
  auto left = made_of(file, *flanks.left, p, refused), right = made_of(file, *flanks.right, p, refused);
  if (!left || !right || !refused.errors.empty()) return p;
  take_ratio(*left, p, said, obstacles);
  if (obstacles.questions.empty()) take_ratio(*right, p, said, obstacles);
  if (one_set_up(left->cut, right->cut)) {
    // The outside blade is the one farther from the cutter's axis.
    const bool outside_left = left->cut.blades[0].point_radius_mm > right->cut.blades[0].point_radius_mm;
    Cut cut = left->cut;
    cut.flank = Cuts::both;
    cut.blades = outside_left ? std::array{left->cut.blades[0], right->cut.blades[0]}
                              : std::array{right->cut.blades[0], left->cut.blades[0]};
    if (cut.blades[0].point_radius_mm == cut.blades[1].point_radius_mm)
      refused.add(at_of(*right->tool, "blade_point_radius"),
                  "both blades have a point radius of {:.10g} mm in one set-up: the outside one must be larger",
                  cut.blades[0].point_radius_mm);
    p.cuts = {cut};
    return p;
  }
  if (!said.left_is_concave)
    obstacles.questions.emplace_back(
        Open::left_flank, fmt::format("the flanks of {} have a set-up each, and REXS does not say whether the left "
                                      "one is the concave or the convex flank",
                                      gear.title()));
  const bool left_is_concave = said.left_is_concave.value_or(true);
  left->cut.flank = left_is_concave ? Cuts::concave : Cuts::convex;
  right->cut.flank = left_is_concave ? Cuts::convex : Cuts::concave;
  p.cuts = left_is_concave ? std::vector{left->cut, right->cut} : std::vector{right->cut, left->cut};
  p.mean_space_width_mm = space_width(q, p);
  return p;
}

}  // namespace toothpath::rexs
