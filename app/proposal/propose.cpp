#include "app/proposal/propose.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/proposal/points_gear.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "geometry/face_gear/part.h"
#include "geometry/tooth_space/bevel_body.h"
#include "machines/machine_file.h"
#include "machines/shaper_machine.h"
#include "postproc/controls/of_machine.h"
#include "postproc/shaper/control.h"
#include "postproc/text/dialect.h"

namespace toothpath::proposal {
namespace {

constexpr double kLeastDoubleModules = 3;  // two rings of 0.7 modules and their groove

/// The option that a refused key of [gear] belongs to.
std::string option_of(const std::string& key) {
  constexpr std::pair<const char*, const char*> kOptions[] = {{"inner_radius", "--inner"},
                                                              {"outer_radius", "--outer"},
                                                              {"shaper_teeth", "--shaper-teeth"},
                                                              {"mate_teeth", "--mate-teeth"},
                                                              {"teeth", "--teeth"},
                                                              {"shaper_tip_radius", "--tip-radius"},
                                                              {"module", "--module"},
                                                              {"blade_point_radius", "--cutter-radius"},
                                                              {"radial_distance", "--cutter-radius"},
                                                              {"sliding_base", "--spiral"},
                                                              {"tip_angle", "--spiral"},
                                                              {"pressure_angle", "--pressure-angle"},
                                                              {"offset", "--offset"},
                                                              {"helix_angle", "--helix"},
                                                              {"spiral_angle", "--spiral"},
                                                              {"shaft_angle", "--shaft-angle"},
                                                              {"face_width", "--face-width"},
                                                              {"profile_shift", "--profile-shift"},
                                                              {"fillet_radius", "--fillet-radius"},
                                                              {"bore_diameter", "--bore"},
                                                              {"points", "--points"},
                                                              {"root", "--root"},
                                                              {"tip", "--tip"}};
  for (const auto& [part, option] : kOptions)
    if (key.ends_with(part)) return option;
  return "--gear";
}

/// A gear whose numbers stand in a file: keys are those of the job.
std::vector<Diagnostic> of_file(std::vector<Refusal> refusals, const char* option) {
  std::vector<Diagnostic> errors;
  for (Refusal& refusal : refusals) {
    if (refusal.diagnostic.position.file.empty())
      refusal.diagnostic.message = fmt::format("{}: {}", option, refusal.diagnostic.message);
    errors.push_back(std::move(refusal.diagnostic));
  }
  return errors;
}

template <typename Refusals>
std::vector<Diagnostic> located(Refusals refusals) {
  std::vector<Diagnostic> errors;
  for (auto& refusal : refusals) {
    refusal.diagnostic.message = fmt::format("{}: {}", option_of(refusal.key), refusal.diagnostic.message);
    errors.push_back(std::move(refusal.diagnostic));
  }
  return errors;
}

Expected<ChosenGear, std::vector<Diagnostic>> choose_face(const Wishes& wishes) {
  const double width = wishes.at(Quantity::outer) - wishes.at(Quantity::inner),
               least = kLeastDoubleModules * wishes.at(Quantity::module);
  if (wishes.gear == Gear::double_helical && width < least)
    return std::vector{
        fail("--outer: {:.4g} mm of teeth have no room for two rings and the groove between them, which take {:.4g} "
             "mm: more teeth, fewer teeth of the shaper or less helix angle make room",
             width, least)};
  auto made = face_gear::FaceGear::make(whole_face_parameters(wishes));
  if (auto* refusals = made.refused()) return located(std::move(*refusals));
  ChosenGear chosen;
  chosen.face = std::move(made.value());
  const face_gear::FaceGear& gear = *chosen.face;
  chosen.diameter_mm = 2 * gear.outer_radius();
  if (wishes.route == Route::shaped) return chosen;
  double depth = 0;
  for (const auto& ring : gear.rings())
    for (const double r : {ring.zone.inner_radius_mm, ring.zone.outer_radius_mm})
      if (const auto root = face_gear::root_height(ring.surface, r))
        depth = std::max(depth, ring.surface.z_tip(r) - *root);
  chosen.facts = facts_of(face_gear::part_of(gear), depth);
  const double m = wishes.at(Quantity::module);
  chosen.part = {gear.outer_radius(),
                 gear.lowest_root() - 2.5 * m,
                 gear.blank_top(),
                 true,
                 face_places(gear.inner_radius(), gear.outer_radius(), gear.lowest_root(), gear.blank_top()),
                 gear.parameters().teeth};
  return chosen;
}

double tip_diameter_mm(const cylindrical::CylindricalParameters& p) {
  return 2 * cylindrical::InvoluteKernel<double>(p, p.zones.front()).r_a;
}

Expected<ChosenGear, std::vector<Diagnostic>> choose_cylindrical(const Wishes& wishes) {
  const double m = wishes.at(Quantity::module), width = wishes.at(Quantity::face_width);
  if (wishes.gear == Gear::cylindrical_double_helical && !(width >= kLeastDoubleModules * m))
    return std::vector{
        fail("--face-width: {:.4g} mm have no room for two rings and the groove between them, which take "
             "{:.4g} mm",
             width, kLeastDoubleModules * m)};
  auto made = cylindrical::CylindricalGear::make(cylindrical_parameters(wishes));
  if (auto* refusals = made.refused())
    return wishes.cylinder ? of_file(std::move(*refusals), "--rexs") : located(std::move(*refusals));
  const cylindrical::CylindricalGear& gear = made.value();
  const double from = gear.parameters().zones.front().from_mm, to = gear.parameters().zones.back().to_mm;
  ChosenGear chosen;
  chosen.diameter_mm = gear.tip_diameter();
  if (wishes.cylinder) chosen.module_mm = gear.parameters().module_mm;
  chosen.facts = facts_of(cylindrical::part_of(gear), 0.5 * (gear.tip_diameter() - gear.root_diameter()));
  chosen.part = {0.5 * gear.tip_diameter(),
                 from,
                 to,
                 true,
                 cylinder_places(from, to, 0.5 * gear.root_diameter(), 0.5 * gear.tip_diameter()),
                 gear.parameters().teeth};
  return chosen;
}

/// Over the tips at the large end.
template <typename BevelParameters>
double bevel_diameter_mm(const BevelParameters& p) {
  return p.outer_transverse_module_mm * p.teeth + 2 * p.addendum_mm * std::cos(p.pitch_angle_rad);
}

Expected<ChosenGear, std::vector<Diagnostic>> choose_straight_bevel(const Wishes& wishes) {
  auto made = straight_bevel::StraightBevelGear::make(straight_bevel_parameters(wishes));
  if (auto* refusals = made.refused()) return located(std::move(*refusals));
  const straight_bevel::StraightBevelGear& gear = made.value();
  const auto& p = gear.parameters();
  const auto& w = gear.space().kernel();
  ChosenGear chosen;
  chosen.diameter_mm = bevel_diameter_mm(p);
  chosen.facts = facts_of(part_of(gear), p.addendum_mm + p.dedendum_mm);
  const auto [front, back] = tooth_space::body_ends(gear.space(), gear.body());
  chosen.part = {0.5 * chosen.diameter_mm,
                 std::min(front, back),
                 std::max(front, back),
                 false,
                 finger_places(w.R_i, w.R_e, p.pitch_angle_rad, p.dedendum_mm),
                 p.teeth};
  return chosen;
}

Expected<ChosenGear, std::vector<Diagnostic>> choose_spiral_bevel(const Wishes& wishes) {
  auto made = spiral_bevel_gear(wishes);
  if (auto* refusals = made.refused())
    return wishes.spiral ? of_file(std::move(*refusals), "--rexs") : located(std::move(*refusals));
  const spiral_bevel::SpiralBevelGear& gear = made.value();
  const auto& p = gear.parameters();
  const auto& ring = gear.space().outline();
  ChosenGear chosen;
  chosen.spiral = std::make_shared<const spiral_bevel::SpiralBevelParameters>(p);
  chosen.diameter_mm = 2 * ring.chart.r(ring.s_from, gear.space().tip(ring.s_from));
  chosen.module_mm = gear.body().module_mm;
  chosen.facts = facts_of(part_of(gear), std::max(gear.space().tip(ring.s_from) - gear.body().root_back,
                                                  gear.space().tip(ring.s_to) - gear.body().root_front));
  const auto [front, back] = tooth_space::body_ends(gear.space(), gear.body());
  chosen.part = {0.5 * chosen.diameter_mm,
                 std::min(front, back),
                 std::max(front, back),
                 false,
                 finger_places(p.outer_cone_distance_mm - p.face_width_mm, p.outer_cone_distance_mm, p.pitch_angle_rad,
                               chosen.facts.depth),
                 p.teeth};
  return chosen;
}

constexpr double kLaysDown =
    0.05;  // sine of a lean: below it the axis of a gear by points is laid down as a cylinder's

Expected<ChosenGear, std::vector<Diagnostic>> choose_flank_grid(const Wishes& wishes) {
  auto made = flank_grid::FlankGridGear::make(*wishes.grid);
  if (auto* refusals = made.refused()) return located(std::move(*refusals));
  const flank_grid::FlankGridGear& gear = made.value();
  const auto& p = gear.parameters();
  const auto& ring = gear.space().outline();
  const auto& chart = ring.chart;
  const auto depth = [&](double s) { return gear.space().tip(s) - gear.root(s); };
  ChosenGear chosen;
  chosen.module_mm = gear.module_mm();
  chosen.facts = facts_of(part_of(gear), std::max({0.0, depth(ring.s_from), depth(ring.s_to)}));
  double radius_mm = 0, low = INFINITY, high = -INFINITY;
  for (const auto& line : {p.root, p.tip, gear.body()})
    for (const Vec2& corner : line) {
      radius_mm = std::max(radius_mm, corner.x());
      low = std::min(low, corner.y());
      high = std::max(high, corner.y());
    }
  chosen.diameter_mm = 2 * radius_mm;
  chosen.part = {radius_mm,
                 low,
                 high,
                 chart.cosine > -kLaysDown,
                 meridian_places(0.5 * (p.root.front() + p.tip.front()), 0.5 * (p.root.back() + p.tip.back()),
                                 {chart.sine, chart.cosine}, 0.5 * chosen.facts.depth),
                 p.teeth};
  return chosen;
}

Expected<ChosenGear, std::vector<Diagnostic>> choose_bevel(const Wishes& wishes) {
  const bevel_gear::BevelGearParameters p = bevel_parameters(wishes);
  auto made = bevel_gear::design_finger_cutter(p);
  if (!made.value_if()) return located(std::move(made.error()));
  ChosenGear chosen;
  chosen.bevel = std::move(*made.value_if());
  const bevel_gear::BevelGear& gear = chosen.bevel->gear;
  const double c = gear.cos_delta(), R = gear.R_e();
  chosen.diameter_mm = bevel_diameter_mm(p);
  chosen.part = {0.5 * chosen.diameter_mm,
                 gear.R_i() * c - p.dedendum_mm,
                 R * c + 3 * p.dedendum_mm,
                 false,
                 finger_places(gear.R_i(), R, p.pitch_angle_rad, p.dedendum_mm),
                 p.teeth,
                 false};
  return chosen;
}

Result<Draft> with_place(Draft draft, const ChosenMachine& machine, const ChosenGear& gear) {
  const double length = std::max(draft.second.length_mm, draft.has_first ? draft.first.length_mm : 0.0);
  PartInSpace part = gear.part;
  part.top_above_table_mm = draft.wishes.blank_top_mm;
  const auto place = place_of(*machine.mill, part, length);
  if (!place)
    return fail_as(DiagnosticKind::refused_input, "--machine: {} reaches no place of the tool on this gear",
                   machine.name);
  draft.place = *place;
  draft.work_zero_mm = place->origin_mm;
  draft.zero_on_top = part.has_top;
  if (part.has_top) draft.work_zero_mm.z() += part.top_mm();
  std::string lacking;
  for (std::size_t i = 0; i < 3; ++i)
    if (place->room_mm[i] < 0)
      lacking += fmt::format("{} {} lacks {:.0f} mm ({:.0f} needed of {:.0f})", lacking.empty() ? "" : ",", "XYZ"[i],
                             -place->room_mm[i], place->needs_mm[i], place->has_mm[i]);
  if (!lacking.empty())
    return fail_as(DiagnosticKind::refused_input,
                   "--machine: {} has not the travel for this gear at its best place with a tool of {:g} mm:{}: a "
                   "smaller gear, a shorter tool, or a machine that travels farther",
                   machine.name, length, lacking);
  return draft;
}

Result<Draft> finger_draft(Draft draft, const ChosenMachine& machine, const ChosenGear& gear, int attempt) {
  const bevel_gear::FingerCutterData& data = gear.bevel->data;
  tool::ToolAssembly& mill = draft.second;
  mill.type = tool::CutterType::finger_mill;
  mill.number = 1;
  mill.module_mm = data.module_mm;
  mill.tip_radius_mm = data.tip_radius_mm;
  mill.rack_depth_mm = data.rack_depth_mm;
  mill.profile_height_mm = data.profile_height_mm;
  const double m = draft.wishes.at(Quantity::module), width = 2 * gear.bevel->gear.cutter().rho_D;
  mill.shank_diameter_mm = std::max(6.0, std::ceil(width / 2) * 2);
  draft.depth_mm = gear.bevel->gear.parameters().addendum_mm + gear.bevel->gear.parameters().dedendum_mm;
  mill.stick_out_mm = std::ceil(17 + 4 * m + 15 * attempt);
  mill.holder = {{mill.shank_diameter_mm + 14, mill.shank_diameter_mm + 14, 40}};
  mill.length_mm = std::ceil((mill.stick_out_mm + 50) / 5) * 5;
  return with_place(std::move(draft), machine, gear);
}

/// Tools that somebody has keep their numbers, which are those of the magazine.
void number_tools(Draft& draft) {
  const bool own = draft.second.number > 0 &&
                   (!draft.has_first || (draft.first.number > 0 && draft.first.number != draft.second.number));
  if (own) return;
  draft.first.number = 1;
  draft.second.number = draft.has_first ? 2 : 1;
}

Result<Draft> face_draft(Draft draft, const ChosenMachine& machine, const ChosenGear& gear, const Shelf& given,
                         int attempt) {
  const double depth = gear.facts.depth;
  draft.coarse = attempt >= 2;
  Shelf shelf = given.empty() ? standard_shelf(depth) : given;
  for (tool::ToolAssembly& tool : shelf) tool = completed(tool, depth);
  if (attempt == 3)  // longer tools lean less far over the part
    for (tool::ToolAssembly& tool : shelf)
      if (given.empty()) {
        tool.stick_out_mm += 10;
        tool.length_mm += 10;
      }
  const auto type =
      draft.wishes.route == Route::line ? tool::CutterType::tapered_ball_end_mill : tool::CutterType::ball_end_mill;
  const tool::ToolAssembly* mill = largest(shelf, type, gear.facts.most_finishing_mm(), depth, attempt % 2);
  if (!mill) {
    const BallLimit limit = ball_limit(gear);
    return fail_as(DiagnosticKind::refused_input,
                   "{}: the largest ball that reaches all of the fillets and the root has {:.3f} mm, and no {} is so "
                   "small and reaches down {:.2f} mm; {} takes a larger ball",
                   limit.option, gear.facts.largest_ball,
                   draft.wishes.route == Route::line ? "tapered mill" : "ball mill", depth, limit.larger);
  }
  draft.second = *mill;
  draft.depth_mm = depth;
  const tool::ToolAssembly* first =
      largest(shelf, tool::CutterType::ball_end_mill, gear.facts.most_roughing_mm(), depth);
  draft.has_first = first && first->diameter_mm > 1.4 * mill->diameter_mm;
  if (draft.has_first) draft.first = *first;
  number_tools(draft);
  return with_place(std::move(draft), machine, gear);
}

std::string mm(double x) { return fmt::format("{:.3f} mm", x); }

}  // namespace

Expected<ChosenMachine, std::vector<Diagnostic>> choose_machine(const Wishes& wishes, const std::string& directory) {
  const auto path = machines::find_machine_file(wishes.machine, directory);
  if (!path) return std::vector{path.error()};
  const auto file = machines::open_machine_file(*path);
  if (!file) return std::vector{file.error()};
  const bool shaper = file->kind == machines::MachineKind::gear_shaper;
  if (shaper != (wishes.route == Route::shaped))
    return std::vector{fail_as(DiagnosticKind::usage, "--machine: {} is a {}, and {} needs a {}", wishes.machine,
                               shaper ? "gear shaper" : "milling machine", word_of(*wishes.route),
                               shaper ? "milling machine" : "gear shaper")};
  ChosenMachine chosen;
  chosen.file = *path;
  if (shaper) {
    auto reading = shaper::read_shaper_machine_of_text(file->text, *path);
    if (!reading.machine) return std::move(reading.errors);
    chosen.name = reading.machine->name;
    chosen.assumed = reading.machine->assumed;
    chosen.assumed_keys = reading.machine->assumed_keys;
    return chosen;
  }
  auto reading = controls::read_machine_of_text(file->text, *path);
  if (!reading.machine) return std::move(reading.errors);
  chosen.mill = std::move(reading.machine);
  chosen.name = chosen.mill->name;
  chosen.assumed = chosen.mill->assumed;
  chosen.assumed_keys = chosen.mill->assumed_keys;
  chosen.table_top_mm = table_top_mm(*chosen.mill);
  if (const auto dialect = controls::dialect_of(*chosen.mill))
    for (const machines::Coolant coolant : machines::kCoolants)
      if (text::coolant_words(*dialect, coolant)) chosen.coolants.push_back(coolant);
  for (const char* name : {"G54", "1"})
    if (chosen.work_offset.empty() && !controls::other_work_offsets(*chosen.mill, name)) chosen.work_offset = name;
  return chosen;
}

Expected<ChosenGear, std::vector<Diagnostic>> choose_gear(const Wishes& wishes) {
  if (is_cylindrical(wishes.gear)) return choose_cylindrical(wishes);
  if (wishes.gear == Gear::straight_bevel) return choose_straight_bevel(wishes);
  if (wishes.gear == Gear::spiral_bevel) return choose_spiral_bevel(wishes);
  if (wishes.gear == Gear::flank_grid) return choose_flank_grid(wishes);
  return wishes.gear == Gear::bevel_herringbone ? choose_bevel(wishes) : choose_face(wishes);
}

BallLimit ball_limit(const ChosenGear& gear) {
  if (gear.face) return {"--tip-radius", "a larger rounding of the shaper's tip"};
  return gear.module_mm > 0 ? BallLimit{"--tools", "a larger fillet"} : BallLimit{"--module", "a larger module"};
}

Result<Draft> draft_of(const std::string& name, const Wishes& wishes, const ChosenMachine& machine,
                       const ChosenGear& gear, const Shelf& shelf, int attempt) {
  Draft draft;
  draft.name = name;
  draft.wishes = wishes;
  if (gear.module_mm > 0) draft.wishes[Quantity::module] = gear.module_mm;
  if (gear.spiral) draft.wishes.spiral = gear.spiral;
  draft.up = gear.part.up;
  draft.assumed = machine.assumed;
  draft.assumed_words = assumed_words(machine);
  draft.work_offset = machine.work_offset;
  if (wishes.route == Route::shaped) return draft;
  if (const Status fits = check_swing(machine, gear.diameter_mm); !fits) return fits.error();
  draft.spindle_rpm = machine.mill->max_spindle_speed;
  draft.most_feed_mm_min = machine.mill->max_cutting_feed;
  return wishes.route == Route::finger ? finger_draft(std::move(draft), machine, gear, attempt)
                                       : face_draft(std::move(draft), machine, gear, shelf, attempt);
}

std::optional<double> least_swing_mm(const Wishes& wishes) {
  if (!wishes.gear || *wishes.gear == Gear::spiral_bevel || *wishes.gear == Gear::flank_grid) return std::nullopt;
  if (is_cylindrical(wishes.gear)) {
    for (const Quantity known : {Quantity::teeth, Quantity::module, Quantity::helix, Quantity::profile_shift})
      if (!wishes[known]) return std::nullopt;
    return tip_diameter_mm(cylindrical_parameters(wishes));
  }
  const bool straight = *wishes.gear == Gear::straight_bevel;
  if (!straight && *wishes.gear != Gear::bevel_herringbone) {
    const auto end = wishes[Quantity::outer] ? wishes[Quantity::outer] : wishes[Quantity::inner];
    if (end) return 2 * *end;
    const auto range = face_range(wishes);
    return range ? std::optional(2 * range->inner) : std::nullopt;
  }
  for (const Quantity known : {Quantity::teeth, Quantity::mate_teeth, Quantity::module})
    if (!wishes[known]) return std::nullopt;
  return straight ? bevel_diameter_mm(straight_bevel_parameters(wishes)) : bevel_diameter_mm(bevel_parameters(wishes));
}

Status check_swing(const ChosenMachine& machine, double diameter_mm) {
  if (!machine.mill) return Ok{};
  const Status fits = machines::check_part_fits(*machine.mill, diameter_mm);
  if (fits) return Ok{};
  std::vector<std::string> others;
  for (const std::string& file : machines::installed_machines()) {
    const auto path = machines::find_machine_file(file, ".");
    const auto text = path ? machines::open_machine_file(*path) : Result<machines::MachineFileText>(path.error());
    if (!text || text->kind == machines::MachineKind::gear_shaper) continue;
    const auto reading = controls::read_machine_of_text(text->text, *path);
    if (reading.machine && machines::check_part_fits(*reading.machine, diameter_mm))
      others.push_back(std::filesystem::path(file).stem().string());
  }
  return fail_as(DiagnosticKind::refused_input, "--machine: {}: fewer teeth or a smaller module would fit{}",
                 fits.error().message,
                 others.empty() ? std::string(", no installed machine turns so much")
                                : fmt::format(", or a machine that turns so much: {}", fmt::join(others, ", ")));
}

Told swing_of(const ChosenMachine& machine, double diameter_mm) {
  if (!machine.mill) return {};
  return {{"swing", fmt::format("{:.1f} mm of {:g} mm", diameter_mm, machine.mill->largest_part_mm())}};
}

Told limits_of(const Wishes& wishes) {
  if (wishes.grid)
    return {{"points",
             fmt::format("{} rows x {} columns on each flank", wishes.grid->plus.rows, wishes.grid->plus.columns)},
            {"tip, [r, z] at both ends", meridian_text(wishes.grid->tip)},
            {"root", meridian_text(wishes.grid->root)}};
  const auto range = face_range(wishes);
  if (!range) return {};
  Told told = {{fmt::format("inner end ({})", range->inner_name), "from " + mm(range->inner)},
               {"outer end (land of a fifth of a module)", "up to " + mm(range->outer)}};
  if (range->pointing > 0) told.emplace_back("the teeth are pointed at", mm(range->pointing));
  return told;
}

std::string assumed_words(const ChosenMachine& machine) {
  constexpr std::size_t kShown = 6;
  const std::size_t count = machine.assumed_keys.size(), shown = std::min(count, kShown);
  return fmt::format(
      "{}{}", fmt::join(machine.assumed_keys.begin(), machine.assumed_keys.begin() + std::ptrdiff_t(shown), ", "),
      count > shown ? fmt::format(" and {} more", count - shown) : std::string());
}

Told limits_of(const ChosenMachine& machine) {
  if (!machine.mill) return {};
  const auto& linear = machine.mill->chain.linear;
  return {{"largest part that turns", fmt::format("{:g} mm", machine.mill->largest_part_mm())},
          {"travels", fmt::format("X {:g}  Y {:g}  Z {:g} mm", linear[0].max_mm - linear[0].min_mm,
                                  linear[1].max_mm - linear[1].min_mm, linear[2].max_mm - linear[2].min_mm)}};
}

Told limits_of(const ChosenGear& gear) {
  if (gear.bevel) {
    const auto& data = gear.bevel->data;
    return {
        {"finger mill", fmt::format("module {:g}, tip radius {:g}, rack depth {:g}, profile height {:g} mm",
                                    data.module_mm, data.tip_radius_mm, data.rack_depth_mm, data.profile_height_mm)}};
  }
  if (gear.facts.depth <= 0) return {};
  return {{"tooth spaces are deep", mm(gear.facts.depth)},
          {"largest ball that reaches the root",
           gear.facts.largest_ball > 0 ? mm(gear.facts.largest_ball) : "none: the fillet is sharp"},
          {"largest first roughing ball", mm(gear.facts.first_ball)},
          {"least flute", mm(gear.facts.depth) + "; less, where what is above it is no thicker than its ball"},
          {"least stick-out that is proposed", mm(least_stick_out_mm(gear.facts.depth))}};
}

Told limits_of(const Draft& draft, const ChosenMachine& machine, const ChosenGear& gear) {
  if (!machine.mill) return {};
  const Place& place = draft.place;
  const auto needs = [&](std::size_t i) { return fmt::format("{:.0f} of {:.0f}", place.needs_mm[i], place.has_mm[i]); };
  Told told = swing_of(machine, gear.diameter_mm);
  told.emplace_back("travels needed", fmt::format("X {}  Y {}  Z {} mm", needs(0), needs(1), needs(2)));
  told.emplace_back("room in travels", fmt::format("X {:.0f}  Y {:.0f}  Z {:.0f} mm", place.room_mm[0],
                                                   place.room_mm[1], place.room_mm[2]));
  return told;
}

}  // namespace toothpath::proposal
