// [machine], [setup], [[operation]], [coolant], [verify], [program], [shaping] and [contact].
#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "app/job/measured_setup.h"
#include "app/job/tables.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "machines/machine_file.h"

namespace toothpath::job {
namespace {

constexpr toml::Range kSpeed{1, 500000, " 1/min"};
constexpr toml::Range kFeed{0.1, 100000, " mm/min"};  // less is slower than any control counts
constexpr toml::Range kStep{0.001, 100, " mm"};
constexpr toml::Range kAllowance{0, 50, " mm"};
constexpr double kLeastAllowance = 1e-4;  // mm: the path follows a share of it, and is rounded like all numbers of NC
constexpr toml::Range kScallop{1e-5, 1, " mm"};
constexpr toml::Range kChordTolerance{1e-5, 0.1, " mm"};
constexpr toml::Range kGougeTolerance{1e-4, 0.1, " mm"};  // less is nothing that words and proofs can hold
constexpr toml::Range kPosition{-100000, 100000, " mm"};
constexpr double kMostAxisLean = 60;  // deg
constexpr double kAxisKeyGap = 0.01;  // mm between two keys of a tool axis
constexpr std::size_t kMostAxisKeys = 1000;

/// Three finite numbers of an array; nothing where it is something else.
std::optional<std::array<double, 3>> three_numbers(const toml::TomlValue& value) {
  const toml::TomlArray* array = value.array();
  if (!array || array->values.size() != 3) return std::nullopt;
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& data = array->values[i].data;
    if (const auto* real = std::get_if<double>(&data)) out[i] = *real;
    else if (const auto* whole = std::get_if<std::int64_t>(&data)) out[i] = static_cast<double>(*whole);
    else return std::nullopt;
    if (!std::isfinite(out[i])) return std::nullopt;
  }
  return out;
}

/// A list of [radius, lean outwards, lean aside], radii ascending; empty and recorded where it is something else.
std::vector<path::ToolAxisKey> read_axis_keys(toml::TableReader& table, std::string_view key) {
  std::vector<path::ToolAxisKey> keys;
  toml::ValueShape rows{toml::ValueKind::rows};
  rows.columns = {"radius", "lean outwards", "lean aside"};
  const toml::Range lean{-kMostAxisLean, kMostAxisLean, " deg"};
  rows.ranges = {{0, kPosition.high, " mm", true}, lean, lean};
  rows.count = {1, kMostAxisKeys};
  const toml::TomlValue* value = table.value(key, {rows});
  if (!value) return keys;
  const toml::TomlArray* list = value->array();
  if (!list || list->values.empty() || list->values.size() > kMostAxisKeys) {
    table.refuse(key, "{} must be an array of 1 to {} keys [radius in mm, lean outwards in deg, lean aside in deg]",
                 key, kMostAxisKeys);
    return {};
  }
  for (std::size_t k = 0; k < list->values.size(); ++k) {
    const auto numbers = three_numbers(list->values[k]);
    if (!numbers) {
      table.refuse(key, "{}[{}] must be [radius in mm, lean outwards in deg, lean aside in deg]", key, k);
      return {};
    }
    const auto [radius, outwards, aside] = *numbers;
    if (!(radius > 0)) table.refuse(key, "{}[{}]: radius = {} mm is not above 0 mm", key, k, radius);
    else if (!keys.empty() && radius < keys.back().radius_mm + kAxisKeyGap)
      table.refuse(key, "{}[{}]: radius = {} mm is not {} mm beyond {} mm, the radius of the key before it", key, k,
                   radius, kAxisKeyGap, keys.back().radius_mm);
    else if (std::abs(outwards) > kMostAxisLean)
      table.refuse(key, "{}[{}]: lean outwards = {} deg is outside -{} to {} deg", key, k, outwards, kMostAxisLean,
                   kMostAxisLean);
    else if (std::abs(aside) > kMostAxisLean)
      table.refuse(key, "{}[{}]: lean aside = {} deg is outside -{} to {} deg", key, k, aside, kMostAxisLean,
                   kMostAxisLean);
    else {
      keys.push_back({radius, radians(outwards), radians(aside)});
      continue;
    }
    return {};
  }
  return keys;
}

/// Prescribed tool axes: one list for all passes, or one for each flank.
void read_tool_axis(toml::TableReader& table, path::MillingOperation& operation) {
  const bool both = table.has("tool_axis"), plus = table.has("tool_axis_plus"), minus = table.has("tool_axis_minus");
  const auto all = read_axis_keys(table, "tool_axis");
  operation.axis_plus = both ? all : read_axis_keys(table, "tool_axis_plus");
  operation.axis_minus = both ? all : read_axis_keys(table, "tool_axis_minus");
  table.relate(toml::KeyRelation::Kind::excludes, "tool_axis", "tool_axis_plus");
  table.relate(toml::KeyRelation::Kind::together, "tool_axis_plus", "tool_axis_minus");
  if (both)
    for (const char* key : {"tool_axis_plus", "tool_axis_minus"}) {
      if (table.misplaced(key)) table.refuse(key, "{} contradicts tool_axis, which holds for both flanks", key);
    }
  else if (plus != minus)
    table.refuse(plus ? "tool_axis_plus" : "tool_axis_minus",
                 "tool_axis_plus and tool_axis_minus stand together: the other is missing");
}

/// The regions that an operation cuts; all where it does not say.
path::ByRegion<bool> read_regions(toml::TableReader& table) {
  path::ByRegion<bool> regions{{true, true, true}};
  std::vector<std::string> words;
  for (const path::Region region : path::kRegions) words.emplace_back(to_string(region));
  const auto names = table.optional_ascii_list("regions", {1, words.size()}, words);
  if (!names) return regions;
  regions = {};
  for (const std::string& name : *names) {
    const auto* region = std::find_if(path::kRegions.begin(), path::kRegions.end(),
                                      [&](path::Region r) { return name == to_string(r); });
    if (region == path::kRegions.end())
      table.refuse("regions", "regions: \"{}\" is none of \"flank\", \"fillet\", \"root\"", name);
    else if (regions[*region]) table.refuse("regions", "regions: \"{}\" stands twice", name);
    else regions[*region] = true;
  }
  if (names->empty()) table.refuse("regions", "regions = [] cuts nothing: leave the key out for all of them");
  return regions;
}

/// One cusp height for all regions, or one for each of them.
void read_scallop(toml::TableReader& table, path::MillingOperation& operation) {
  const toml::TomlValue* value =
      table.value("scallop", {toml::ValueShape::of_range(toml::ValueKind::number, kScallop), {toml::ValueKind::table}},
                  toml::Presence::required);
  if (!value || value->type() != toml::TomlType::table) {
    operation.scallop_mm = table.number("scallop", kScallop).value_or(0);
    return;
  }
  auto heights = table.table("scallop", toml::Presence::required);
  if (!heights) return;
  operation.scallops_mm.emplace();
  for (const path::Region region : path::kRegions) {
    const char* name = to_string(region);
    if (!operation.regions[region]) {
      if (heights->misplaced(name))
        heights->refuse(name, "scallop.{} is asked, but regions leaves the {} out", name, name);
      continue;
    }
    const double height = heights->number(name, kScallop).value_or(0);
    (*operation.scallops_mm)[region] = height;
    operation.scallop_mm = std::max(operation.scallop_mm, height);
  }
  heights->finish();
}

/// Stock that stays: none, or as much as a path can keep.
void check_allowance(toml::TableReader& table, double allowance_mm) {
  if (allowance_mm > 0 && allowance_mm < kLeastAllowance)
    table.refuse("allowance", "allowance = {} mm is below {} mm, the least stock that a path can leave: 0 leaves none",
                 allowance_mm, kLeastAllowance);
}

path::MillingOperation read_ball_operation(toml::TableReader& table, path::OperationType type,
                                           const OperationContext& context) {
  path::MillingOperation operation;
  if (type == path::OperationType::roughing) {
    operation.step_down_mm = table.number("step_down", kStep).value_or(0);
    operation.step_over_mm = table.number("step_over", kStep).value_or(0);
  } else {
    operation.regions = read_regions(table);
    read_scallop(table, operation);
    read_tool_axis(table, operation);
    for (const char* key : {"tool_axis", "tool_axis_plus", "tool_axis_minus"})
      if (!context.teeth_along_radii && table.has(key))
        table.refuse(key, "{} counts the radii of a face gear: leave it out, the axis is chosen", key);
  }
  if (type != path::OperationType::finishing)
    operation.allowance_mm = table.number("allowance", kAllowance).value_or(0);
  check_allowance(table, operation.allowance_mm);
  return operation;
}

path::MillingOperation read_line_operation(toml::TableReader& table) {
  path::MillingOperation operation;
  operation.regions = {{true, false, false}};
  operation.allowance_mm = table.number_or("allowance", kAllowance, operation.allowance_mm);
  check_allowance(table, operation.allowance_mm);
  operation.strips = table.optional_integer("strips", {1, path::kMostStrips});
  operation.left_mm = table.optional_number("left", kScallop);
  if (const auto word = table.optional_word("rotaries", {"both", "one"}))
    operation.rotaries = *word == "both" ? path::MovingRotaries::both : path::MovingRotaries::one;
  operation.best_way = table.word_or("strategy", {"side", "best"}, "side") == "best";
  if (operation.best_way && operation.allowance_mm > 0)
    table.refuse("strategy",
                 "strategy = \"best\" chooses how flanks are finished, but allowance = {:g} mm leaves stock: leave one "
                 "of them out",
                 operation.allowance_mm);
  return operation;
}

struct OperationWord {
  const char* word;
  path::OperationType type;
  tool::CutterUse needs;
  bool finger;  ///< of equal-base-circle bevel gears alone
};
constexpr OperationWord kOperationWords[] = {
    {"roughing", path::OperationType::roughing, tool::CutterUse::layers, false},
    {"semi_finishing", path::OperationType::semi_finishing, tool::CutterUse::ball_end, false},
    {"finishing", path::OperationType::finishing, tool::CutterUse::ball_end, false},
    {"line_milling", path::OperationType::line_milling, tool::CutterUse::side, false},
    {"finger_roughing", path::OperationType::finger_roughing, tool::CutterUse::tooth_form, true},
    {"finger_finishing", path::OperationType::finger_finishing, tool::CutterUse::tooth_form, true}};

/// Nothing where the type is none of those that mill such a gear.
const OperationWord* read_type(toml::TableReader& table, bool finger) {
  std::vector<std::string_view> words;
  for (const auto& entry : kOperationWords)
    if (finger || !entry.finger) words.emplace_back(entry.word);
  const auto word = table.variant("type", words);
  if (!word) return nullptr;
  return std::find_if(std::begin(kOperationWords), std::end(kOperationWords),
                      [&](const OperationWord& entry) { return *word == entry.word; });
}

/// "ball_end_mill or tapered_ball_end_mill".
std::string words_that_serve(tool::CutterUse use) {
  std::string text;
  for (const auto& kind : tool::cutter_kinds())
    if (kind.serves(use)) text += (text.empty() ? "" : " or ") + std::string(kind.word);
  return text;
}

/// Cutting steps and cusps larger than the tool itself cannot be meant.
void compare_with_tool(toml::TableReader& table, const path::MillingOperation& operation,
                       const tool::ToolAssembly& tool) {
  const double diameter = tool.diameter_mm;
  if (diameter <= 0) return;
  if (operation.step_over_mm > diameter)
    table.refuse("step_over", "step_over = {} mm exceeds {} mm, the diameter of tool {}", operation.step_over_mm,
                 diameter, tool.number);
  if (operation.scallop_mm >= diameter / 2) {
    std::string key = "scallop";
    for (const path::Region region : path::kRegions)
      if (operation.scallops_mm && (*operation.scallops_mm)[region] == operation.scallop_mm)
        key = fmt::format("scallop.{}", to_string(region));
    table.refuse("scallop", "{} = {} mm is not below {} mm, the radius of tool {}", key, operation.scallop_mm,
                 diameter / 2, tool.number);
  }
  if (operation.best_way && operation.most_misfit_mm() >= diameter / 2)
    table.refuse(table.has("left") ? "left" : "strategy",
                 "left = {} mm is not below {} mm, the radius of tool {}, whose ball end strategy = \"best\" may take",
                 operation.most_misfit_mm(), diameter / 2, tool.number);
  if (tool.flute_length_mm > 0 && operation.step_down_mm > tool.flute_length_mm)
    table.refuse("step_down", "step_down = {} mm exceeds {} mm, the flute_length of tool {}", operation.step_down_mm,
                 tool.flute_length_mm, tool.number);
}

}  // namespace

path::MillingOperation read_operation(toml::TableReader& table, const OperationContext& context) {
  const std::vector<tool::ToolAssembly>& tools = context.tools;
  const OperationWord* word = read_type(table, context.finger);
  path::MillingOperation operation;
  const tool::ToolAssembly* tool = nullptr;
  if (const auto number = table.integer("tool", kToolNumber)) {
    const auto found = std::find_if(tools.begin(), tools.end(), [&](const auto& t) { return t.number == *number; });
    if (found == tools.end()) table.refuse("tool", "tool = {} is not the number of any [[tool]]", *number);
    else tool = &*found;
  }
  const double speed = table.number("speed", kSpeed).value_or(0);
  const double feed = table.number("feed", kFeed).value_or(0);
  const double chord = table.number_or("chord_tolerance", kChordTolerance, operation.chord_tolerance_mm);
  if (!word) {
    table.name_misspelt("type");
    return operation;
  }
  if (word->type == path::OperationType::finger_roughing)
    operation.ridge_mm = table.number("ridge", {0.001, 10, " mm"}).value_or(0);
  else if (word->type == path::OperationType::line_milling) operation = read_line_operation(table);
  else if (!word->finger) operation = read_ball_operation(table, word->type, context);
  if (!word->finger) operation.climb = table.boolean_or("climb", operation.climb);
  operation.type = word->type;
  operation.speed_rpm = speed;
  operation.feed_mm_min = feed;
  operation.chord_tolerance_mm = chord;
  read_chip_limits(table, operation);
  if (tool) {
    operation.tool = static_cast<int>(tool - tools.data());
    if (!tool::serves(*tool, word->needs))
      table.refuse("tool", "tool = {} is a {}, but {} needs a {}", tool->number, tool::kind_of(*tool).word, word->word,
                   words_that_serve(word->needs));
    else compare_with_tool(table, operation, *tool);
  }
  table.finish();
  return operation;
}

namespace {

/// Where there is finishing, every region needs an operation that finishes it.
void check_regions(toml::TableReader& root, const std::vector<path::MillingOperation>& operations) {
  const bool finished = std::any_of(operations.begin(), operations.end(), [](const auto& o) { return o.finishes(); });
  if (!finished) return;
  std::string missing;
  for (const path::Region region : path::kRegions)
    if (!path::finisher_of(operations, region))
      missing += (missing.empty() ? "" : ", ") + std::string(to_string(region));
  if (!missing.empty())
    root.refuse(
        "operation",
        "the finishing operations leave out: {}; every region (flank, fillet, root) needs one that finishes it: "
        "a finishing with that region, for the flank also a line_milling without allowance",
        missing);
}

}  // namespace

void check_mills(toml::TableReader& root, const Job& job) {
  const auto finger = [](const path::MillingOperation& o) {
    return o.type == path::OperationType::finger_roughing || o.type == path::OperationType::finger_finishing;
  };
  const auto fingers = std::count_if(job.operations.begin(), job.operations.end(), finger);
  if (fingers == 0) {
    check_regions(root, job.operations);
  } else if (fingers != std::ssize(job.operations)) {
    root.refuse("operation",
                "finger mills and ball mills do not cut one gear in one job: a job each, the second with the stock of "
                "the first");
  } else if (job.verify.unreached_mm) {
    root.table("verify")->refuse(
        "unreached", "unreached is asked of the ball that finishes a gear: what a finger mill leaves is its ridge");
  }
}

joints::Setup read_setup(toml::TableReader& table, Job& job) {
  joints::Setup setup;
  if (const auto origin = table.numbers("origin", 3, kPosition))
    setup.origin_mm = Vec3((*origin)[0], (*origin)[1], (*origin)[2]);
  if (const auto axis = table.word("axis", {"up", "down"})) setup.axis_up = *axis == "up";
  setup.pivot_error_mm = table.optional_number("pivot_error", {0, 1, " mm"});
  constexpr const char* kOffsetPattern = "[A-Z]?[0-9]{1,4}(\\.[0-9])?( ?P[0-9]{1,3})?";
  if (const auto name = table.text("work_offset", {.pattern = kOffsetPattern})) {
    static const std::regex kOffset(kOffsetPattern);
    if (std::regex_match(*name, kOffset)) setup.work_offset = *name;
    else
      table.refuse("work_offset",
                   "work_offset = \"{}\" is not the name of a work offset such as G54, G59.1 or G54.1 P3", *name);
  }
  if (const auto at = table.numbers("work_offset_at", 3, kPosition))
    setup.work_offset_at_mm = Vec3((*at)[0], (*at)[1], (*at)[2]);
  if (const auto name = table.optional_text("measured")) take_measured(table, *name, job, setup);
  table.finish();
  return setup;
}

shaper::Shaping read_shaping(toml::TableReader& table) {
  shaper::Shaping s;
  s.cutting_speed_m_min = table.number("cutting_speed", {0, 1000, " m/min", true}).value_or(0);
  if (const auto basis = table.word("speed_basis", {"mean", "peak"}))
    s.speed_basis = *basis == "mean" ? shaper::Shaping::SpeedBasis::mean : shaper::Shaping::SpeedBasis::peak;
  s.circular_feed_mm = table.number("circular_feed", {0, 100, " mm", true}).value_or(0);
  s.radial_feed_mm = table.number("radial_feed", {0, 100, " mm", true}).value_or(0);
  s.over_run_mm = table.number("over_run", {0, 1000, " mm"}).value_or(0);
  constexpr toml::Range kReference{0, 10000, " mm", true};
  const toml::TomlValue* reference =
      table.value("offset_reference",
                  {toml::ValueShape::of_words(toml::ValueKind::text, {"outer_radius", "mean_radius"}),
                   toml::ValueShape::of_range(toml::ValueKind::number, kReference)},
                  toml::Presence::required);
  if (reference && !std::holds_alternative<std::string>(reference->data)) {
    s.offset_reference = shaper::Shaping::OffsetReference::given;
    s.offset_reference_mm = table.number("offset_reference", kReference).value_or(0);
  } else if (const auto name = table.word("offset_reference", {"outer_radius", "mean_radius"})) {
    s.offset_reference = *name == "outer_radius" ? shaper::Shaping::OffsetReference::outer_radius
                                                 : shaper::Shaping::OffsetReference::mean_radius;
  }
  table.finish();
  return s;
}

namespace {

ContactLoad read_contact_load(toml::TableReader& table, const Job& job) {
  ContactLoad load;
  load.torque_Nm = table.number("torque", kContactTorque).value_or(1);
  load.on_pinion = table.word_or("torque_on", {"gear", "pinion"}, "gear") == "pinion";
  if (const auto E = table.optional_numbers("youngs_modulus", 2, {1, 1200, " GPa"}))
    for (std::size_t k = 0; k < 2; ++k) load.youngs_modulus_N_mm2[k] = (*E)[k] * 1000;
  if (const auto nu = table.optional_numbers("poisson", 2, {0, 0.49}))
    for (std::size_t k = 0; k < 2; ++k) load.poisson[k] = (*nu)[k];
  if (const auto word = table.optional_word("pinion_axial", {"floating", "held"}))
    load.pinion_axial = *word == "held" ? PinionHold::held : PinionHold::floating;
  if (const auto spring = table.optional_number("axial_stiffness", {1e-3, 1e12, " N/mm"})) {
    if (load.pinion_axial == PinionHold::held)
      table.refuse("axial_stiffness", "axial_stiffness and pinion_axial = \"held\" contradict each other");
    load.pinion_axial = PinionHold::spring;
    load.axial_stiffness_N_mm = *spring;
  }
  load.positions = table.integer_or("positions", kContactPositions, load.positions);
  load.row_teeth = table.integer_or("row_teeth", {3, 11}, load.row_teeth);
  if (load.row_teeth % 2 == 0)
    table.refuse("row_teeth", "row_teeth = {} is even: the loaded tooth stands in the middle", load.row_teeth);
  load.segment_mm = table.optional_number("segment", {0.01, 100, " mm"});
  load.rim_mm = table.optional_number("rim", {0.01, 1000, " mm"});
  load.edge_radius_mm = table.optional_number("edge_radius", {1e-3, 10, " mm"}).value_or(load.edge_radius_mm);
  load.friction = table.optional_number("friction", {0, 1});
  load.root_stress = table.boolean_or("root_stress", load.root_stress);
  if (const auto* gear = job.face_gear(); gear != nullptr && load.root_stress && !(gear->shaper_tip_radius_mm > 0))
    table.refuse("root_stress",
                 "root_stress = true with shaper_tip_radius = {:g} mm: a fillet without a radius has no finite stress",
                 gear->shaper_tip_radius_mm);
  table.finish();
  return load;
}

MisalignmentBox read_misalignment(toml::TableReader& table) {
  MisalignmentBox box;
  constexpr toml::Range kEitherWay{0, 5, " mm"};
  box.most.offset_mm = table.number_or("offset", kEitherWay, 0);
  box.most.angle_rad = radians(table.number_or("angle", {0, 1, " deg"}, 0));
  box.most.axial_mm = table.number_or("pinion_axial", kEitherWay, 0);
  box.most.gear_axial_mm = table.number_or("gear_axial", kEitherWay, 0);
  box.margin = table.number_or("margin", {0, 0.4}, box.margin);
  table.finish();
  return box;
}

}  // namespace

ContactSettings read_contact(toml::TableReader& table, const Job& job) {
  ContactSettings c;
  if (job.face_gear()) c.pinion_teeth = table.optional_integer("pinion_teeth", kPinionTeeth).value_or(0);
  else if (table.misplaced("pinion_teeth"))
    table.refuse("pinion_teeth",
                 "pinion_teeth belongs to face gears; this gear is {}, whose mate has gear.mate_teeth, or the teeth of "
                 "the job that --mate names",
                 job.gear_type());
  c.moved.offset_mm = table.number_or("offset_error", kMoved, c.moved.offset_mm);
  c.moved.axial_mm = table.number_or("axial_error", kMoved, c.moved.axial_mm);
  c.moved.angle_rad = radians(table.number_or("angle_error", kAngleError, degrees(c.moved.angle_rad)));
  c.compound_mm = table.number_or("compound", kCompound, c.compound_mm);
  c.moved.gear_axial_mm = table.number_or("gear_axial_error", kMoved, c.moved.gear_axial_mm);
  if (job.face_gear()) c.modifications = read_modifications(table, job.directory());
  else if (table.misplaced("modification"))
    table.refuse("modification",
                 "modification belongs to the pinions of face gears; this gear is {}, whose mate has a job of its "
                 "own: [[gear.modification]] there, and --mate",
                 job.gear_type());
  if (auto box = table.table("misalignment")) c.box = read_misalignment(*box);
  if (!job.face_gear() && !job.bevel_gear()) {
    if (table.misplaced("load"))
      table.refuse("load", "load: there is no elastic model of a {}: leave it out", job.gear_type());
  } else if (auto load = table.table("load")) {
    c.load = read_contact_load(*load, job);
  }
  table.finish();
  return c;
}

VerifySettings read_verify(toml::TableReader& table) {
  VerifySettings verify;
  verify.gouge_tolerance_mm = table.number_or("gouge_tolerance", kGougeTolerance, verify.gouge_tolerance_mm);
  verify.all_teeth = table.word_or("teeth", {"one", "all"}, "one") == "all";
  verify.clearance_mm = table.optional_number("clearance", {0, 50, " mm"});
  verify.unreached_mm = table.optional_number("unreached", {0, 50, " mm"});
  verify.form_tolerance_mm = table.optional_number("form_tolerance", {0, 1, " mm", true});
  verify.iso_class = table.optional_integer("iso_class", {1, 11});
  table.relate(toml::KeyRelation::Kind::needs, "iso_class", "form_tolerance");
  if (verify.iso_class && !table.has("form_tolerance"))
    table.refuse("iso_class", "iso_class needs form_tolerance: what the class is for the module of the gear, mm");
  table.finish();
  return verify;
}

/// Where tools are checked; teeth between two checks are stated where teeth decide, and nowhere else.
void read_tool_check(toml::TableReader& table, text::TextWishes& wishes) {
  const std::initializer_list<std::string_view> words = {"none", "tool_changes", "operations", "teeth"};
  const std::string word = table.word_or("tool_check", words, "none");
  wishes.checks = static_cast<text::ToolChecks>(std::find(words.begin(), words.end(), word) - words.begin());
  const auto teeth = table.optional_integer("tool_check_teeth", kToolCheckTeeth);
  wishes.teeth_between_checks = teeth.value_or(0);
  if (teeth && wishes.checks != text::ToolChecks::teeth)
    table.refuse("tool_check_teeth", "tool_check_teeth = {} goes with tool_check = \"teeth\" alone, which is \"{}\"",
                 *teeth, word);
  else if (!table.has("tool_check_teeth") && wishes.checks == text::ToolChecks::teeth)
    table.refuse("tool_check", "tool_check = \"teeth\" needs tool_check_teeth: the teeth between two checks");
}

ProgramSettings read_program_settings(toml::TableReader& table) {
  ProgramSettings program;
  program.number = table.optional_integer("number", kProgramNumber);
  program.spread_teeth = table.word_or("tooth_order", {"sequence", "spread"}, "sequence") == "spread";
  const std::initializer_list<std::string_view> stops = {"none", "tool_changes", "operations", "teeth"};
  const std::string stop = table.word_or("stop", stops, "none");
  program.text.stops = static_cast<text::Stops>(std::find(stops.begin(), stops.end(), stop) - stops.begin());
  if (table.word_or("stop_word", {"optional_stop", "block_skip"}, "optional_stop") == "block_skip")
    program.text.stop_word = text::StopWord::block_skip;
  program.text.stop_at_first_cut = table.boolean_or("stop_at_first_cut", program.text.stop_at_first_cut);
  program.split_operations = table.word_or("split", {"none", "operations"}, "none") == "operations";
  program.teeth_per_program = table.optional_integer("teeth_per_program", kTeethPerProgram);
  if (program.teeth_per_program && table.has("split") && !program.split_operations)
    table.refuse("teeth_per_program",
                 "split = \"none\" and teeth_per_program = {} contradict each other: leave one of them out",
                 *program.teeth_per_program);
  read_tool_check(table, program.text);
  program.contour_tolerance_mm = table.optional_number("contour_tolerance", kContourTolerance);
  program.text.restart_numbers = table.boolean_or("restart_numbers", program.text.restart_numbers);
  program.tilted_planes = table.boolean_or("tilted_planes", program.tilted_planes);
  constexpr std::pair<std::string_view, machines::PoleOption> kPoles[] = {
      {"error", machines::PoleOption::error}, {"tilt", machines::PoleOption::tilt},
      {"hold", machines::PoleOption::hold},   {"through", machines::PoleOption::through},
      {"slow", machines::PoleOption::slow},   {"retract", machines::PoleOption::retract}};
  if (const auto word = table.optional_word("pole", {"error", "tilt", "hold", "through", "slow", "retract"}))
    for (const auto& [name, option] : kPoles)
      if (*word == name) program.pole = option;
  if (const auto angle = table.optional_number("pole_angle", {0, machines::kLargestPoleAngle, " deg", true}))
    program.pole_angle_rad = radians(*angle);
  table.finish();
  return program;
}

MachineChoice read_machine_choice(toml::TableReader& table) {
  MachineChoice machine;
  machine.file = table.text("file").value_or("");
  machine.accept_assumed = table.boolean_or("accept_assumed", machine.accept_assumed);
  table.finish();
  return machine;
}

machines::Coolant read_coolant(toml::TableReader& table) {
  const auto mode = table.word("mode", {"off", "mist", "flood", "air", "through_spindle"});
  table.finish();
  for (const machines::Coolant coolant : machines::kCoolants)
    if (mode && *mode == to_string(coolant)) return coolant;
  return machines::Coolant::off;
}

}  // namespace toothpath::job
