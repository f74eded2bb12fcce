#include "machines/machine_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>

#include "machines/body_file.h"
#include "machines/machine_table.h"

namespace toothpath::machines {
namespace {

// Plausible ranges; a value outside them is a typing error or another unit.
constexpr double kLargestAcceleration = 1e7;  // mm/s^2, deg/s^2
constexpr double kLargestJerk = 1e10;         // mm/s^3, deg/s^3
constexpr double kLongestToolChange = 3600;   // s
constexpr double kLongestClamp = 60;          // s
constexpr double kLeastTravel = 10.0;         // mm; less means metres
constexpr double kLeastDirection = 1e-3;      // length of a direction as written
constexpr double kLeastOffset = 1.0;          // mm; the largest offset of all rotaries: less may mean metres ...
constexpr double kMeasuredOffset = 0.1;       // mm; ... but for this little, which is measured on axes that should meet
constexpr double kElsewhere = 100.0;          // mm along an axis, to another point of it
constexpr std::size_t kMostRotaries = 2;
constexpr std::size_t kMostBlocks = 1000;                      // of one key
constexpr double kLeastClearance = 0.1, kMostClearance = 500;  // mm above the tool setter

std::string letter_name(char letter) { return std::string(1, letter); }

/// Letters of one list of [chain], each with the place where it is named.
struct NamedAxis {
  char letter;
  SourcePosition position;
};

std::vector<NamedAxis> read_letters(toml::TableReader& chain, std::string_view key) {
  toml::ValueShape shape = toml::ValueShape::of_words(toml::ValueKind::texts, {"A", "B", "C"});
  shape.count = {0, kMostRotaries};
  const toml::TomlValue* list = chain.required(key, {shape});
  std::vector<NamedAxis> letters;
  if (!list) return letters;
  const toml::TomlArray* array = list->array();
  if (!array) {
    chain.refuse_at(list->position, "{} must be a list of axis letters", chain.name(key));
    return letters;
  }
  for (const toml::TomlValue& item : array->values) {
    const std::string* text = item.text();
    if (text && (*text == "A" || *text == "B" || *text == "C")) letters.push_back({text->front(), item.position});
    else chain.refuse_at(item.position, "{} lists rotary axes: \"A\", \"B\" or \"C\"", chain.name(key));
  }
  return letters;
}

/// `min` and `max` of an axis in the units of the file, reversed limits refused.
std::optional<std::pair<double, double>> read_range(toml::TableReader& axis, double largest, const char* unit) {
  const auto lo = axis.number("min", {-largest, largest, unit});
  const auto hi = axis.number("max", {-largest, largest, unit});
  if (!lo || !hi) return std::nullopt;
  if (!(*hi > *lo)) {
    axis.refuse("max", "{} = {} must exceed {} = {}", axis.name("max"), *hi, axis.name("min"), *lo);
    return std::nullopt;
  }
  return std::pair(*lo, *hi);
}

/// An axis that rolls over is counted from 0 to 360 deg for ever: it has neither `min` nor `max`.
void refuse_ends(toml::TableReader& axis) {
  for (const char* end : {"min", "max"})
    if (axis.misplaced(end))
      axis.refuse(end, "{} of an axis with rollover = true, which turns without end: leave {} out, or rollover",
                  axis.name(end), end);
}

/// Below 1 in a minute no control's text has a word for F.
double read_speed(toml::TableReader& axis, const char* unit) {
  return axis.number("max_speed", {1, kLargestSpeed, unit}).value_or(0.0);
}

/// `max_acceleration`, per second squared in the file, per minute squared here; 0 where it is left out.
double read_acceleration(toml::TableReader& axis, const char* unit) {
  return 3600.0 *
         axis.optional_number("max_acceleration", toml::Range::positive(kLargestAcceleration, unit)).value_or(0.0);
}

/// `max_jerk`, per second cubed in the file, per minute cubed here; 0 where it is left out.
double read_jerk(toml::TableReader& axis, const char* unit) {
  return 216000.0 * axis.optional_number("max_jerk", toml::Range::positive(kLargestJerk, unit)).value_or(0.0);
}

LinearAxis read_linear(toml::TableReader axis, const LimitMargin& margin) {
  LinearAxis out;
  if (const auto range = read_range(axis, kLargestLength, " mm")) {
    out.min_mm = range->first;
    out.max_mm = range->second;
    const double least = std::max(kLeastTravel, 2 * margin.linear_mm);
    if (out.max_mm - out.min_mm < least)
      axis.refuse("max", "{} - {} = {:.6g} mm of travel is below {} mm; lengths are in mm, not metres",
                  axis.name("max"), axis.name("min"), out.max_mm - out.min_mm, least);
  }
  out.max_speed = read_speed(axis, " mm/min");
  out.max_acceleration = read_acceleration(axis, " mm/s^2");
  out.max_jerk = read_jerk(axis, " mm/s^3");
  axis.finish();
  return out;
}

Vec3 read_direction(toml::TableReader& axis) {
  const auto direction = read_vector(axis, "direction", kLargestLength, "");
  if (!direction) return Vec3::UnitZ();
  const double length = direction->norm();
  if (length < kLeastDirection) {
    axis.refuse("direction", "{} = [{}, {}, {}] has length {}, must be at least {}", axis.name("direction"),
                direction->x(), direction->y(), direction->z(), length, kLeastDirection);
    return Vec3::UnitZ();
  }
  return *direction / length;
}

/// Where a head axis lies, seen from the gauge point: lateral offset in `point`, height in `pivot_length`.
Vec3 read_head_point(toml::TableReader& axis, const Vec3& direction) {
  Vec3 point = Vec3::Zero();
  if (const auto lateral = axis.optional_numbers("point", 3, {-kLargestLength, kLargestLength, " mm"})) {
    point = Vec3((*lateral)[0], (*lateral)[1], (*lateral)[2]);
    if (point.z() != 0.0)
      axis.refuse("point", "{}[2] = {} must be 0: the height of a head axis is its pivot_length", axis.name("point"),
                  point.z());
  }
  const bool along_spindle = direction.head<2>().norm() == 0.0;  // then its height has no effect
  constexpr toml::Range kPivot{0.0, kLargestLength, " mm"};
  if (const auto pivot =
          along_spindle ? axis.optional_number("pivot_length", kPivot) : axis.number("pivot_length", kPivot)) {
    if (*pivot > 0.0 && *pivot < 1.0)
      axis.refuse("pivot_length", "{} = {} mm is below 1 mm; lengths are in mm, not metres", axis.name("pivot_length"),
                  *pivot);
    point.z() = *pivot;
  }
  return point;
}

/// The words that clamp an axis and release it, and how many seconds they take.
std::optional<RotaryClamp> read_clamp(toml::TableReader& axis) {
  axis.relate(toml::KeyRelation::Kind::needs, "clamp_time", "clamp");
  if (!axis.has("clamp") && axis.misplaced("clamp_time"))
    axis.refuse("clamp_time", "{} needs {}", axis.name("clamp_time"), axis.name("clamp"));
  const auto words = axis.optional_ascii_list("clamp", {2, 2});
  const auto times =
      axis.has("clamp") ? axis.optional_numbers("clamp_time", 2, {0.0, kLongestClamp, " s"}) : std::nullopt;
  if (!words) return std::nullopt;
  if (words->size() != 2) {
    axis.refuse("clamp", "{} has {} words, must have 2: one that clamps and one that releases", axis.name("clamp"),
                words->size());
    return std::nullopt;
  }
  if (words->front() == words->back()) {
    axis.refuse("clamp", "{}: {} cannot both clamp and release", axis.name("clamp"), words->front());
    return std::nullopt;
  }
  RotaryClamp clamp{words->front(), words->back()};
  if (times) {
    clamp.on_min = (*times)[0] / 60;
    clamp.off_min = (*times)[1] / 60;
  }
  return clamp;
}

RotaryAxis read_rotary(toml::TableReader axis, char letter, bool in_table, const LimitMargin& margin) {
  RotaryAxis out;
  out.letter = letter;
  out.direction = read_direction(axis);
  out.point_mm = in_table ? read_vector(axis, "point", kLargestLength, " mm").value_or(Vec3::Zero())
                          : read_head_point(axis, out.direction);
  if (in_table && axis.misplaced("pivot_length"))
    axis.refuse("pivot_length", "{} belongs to head axes; {} is in the table", axis.name("pivot_length"), letter);
  out.sign = read_sense(axis, "sign");
  out.zero_rad = radians(axis.number_or("zero", {-360.0, 360.0, " deg"}, 0.0));
  out.rollover = axis.boolean_or("rollover", false);
  if (out.rollover) {
    refuse_ends(axis);
    out.max_rad = std::numeric_limits<double>::infinity();
    out.min_rad = -out.max_rad;
  } else if (const auto range = read_range(axis, kLargestAngle, " deg")) {
    out.min_rad = radians(range->first);
    out.max_rad = radians(range->second);
    const double least = 2 * degrees(margin.rotary_rad);
    if (range->second - range->first <= least)
      axis.refuse("max", "{} - {} = {:.6g} deg leaves nothing between the margins of {:.6g} deg", axis.name("max"),
                  axis.name("min"), range->second - range->first, degrees(margin.rotary_rad));
  }
  out.max_speed = radians(read_speed(axis, " deg/min"));
  out.max_acceleration = radians(read_acceleration(axis, " deg/s^2"));
  out.max_jerk = radians(read_jerk(axis, " deg/s^3"));
  out.clamp = read_clamp(axis);
  axis.finish();
  return out;
}

/// Could this offset of a table's axis be one in metres? Then the axis would stand within the travels of X and Y.
bool may_be_metres(const Vec3& point_mm, const std::array<LinearAxis, 3>& linear) {
  for (int i = 0; i < 2; ++i) {
    const LinearAxis& travel = linear[std::size_t(i)];
    if (const double at = 1000 * point_mm[i]; at != 0 && (at < travel.min_mm || at > travel.max_mm)) return false;
  }
  return true;
}

/// Where every offset of the rotary axes is below a millimetre although one of the table's is more than what is left of
/// axes that should meet, the file may be in metres. Whoever means it can give the point elsewhere on its axis.
void refuse_offsets_in_metres(toml::TableReader& axes, const Machine& machine) {
  double largest = 0;
  const RotaryAxis* at = nullptr;
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) {
    const RotaryAxis& axis = machine.chain.rotary(k);
    if (machine.chain.in_table(k) && !may_be_metres(axis.point_mm, machine.chain.linear)) return;
    const double reach = axis.point_mm.cwiseAbs().maxCoeff();
    if (reach >= kLeastOffset) return;
    if (!machine.chain.in_table(k) || reach <= largest) continue;
    largest = reach;
    at = &axis;
  }
  if (largest < kMeasuredOffset) return;
  const Vec3 same = at->point_mm + kElsewhere * at->direction;
  if (auto axis = axes.required_table(letter_name(at->letter)))
    axis->refuse("point",
                 "{} = [{}, {}, {}]: the largest offset of the rotary axes, {} mm, is below {} mm; lengths are in mm, "
                 "not metres. If it is in mm, name another point of that axis: [{:g}, {:g}, {:g}]",
                 axis->name("point"), at->point_mm.x(), at->point_mm.y(), at->point_mm.z(), largest, kLeastOffset,
                 same.x(), same.y(), same.z());
}

/// One axis of the chain: its table is missing, or read.
void read_chain(toml::TableReader& root, Machine& machine) {
  auto chain = root.required_table("chain");
  auto axes = root.required_table("axes");
  if (!chain || !axes) return;
  const std::vector<NamedAxis> table = read_letters(*chain, "table");
  const std::vector<NamedAxis> head = read_letters(*chain, "head");

  for (std::size_t i = 0; i < 3; ++i)
    if (auto axis = axes->required_table(letter_name("XYZ"[i])))
      machine.chain.linear[i] = read_linear(*axis, machine.limit_margin);

  std::vector<NamedAxis> all = table;
  all.insert(all.end(), head.begin(), head.end());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto same = [&all, k](const NamedAxis& a) { return a.letter == all[k].letter; };
    if (std::any_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(k), same)) {
      root.refuse_at(all[k].position, "axis {} is in the chain twice", all[k].letter);
      continue;
    }
    if (k >= kMostRotaries) {
      root.refuse_at(all[k].position, "axis {} is rotary axis number {}, a chain has at most {}", all[k].letter, k + 1,
                     kMostRotaries);
      continue;
    }
    const std::string key = letter_name(all[k].letter);
    const bool in_table = k < table.size();
    if (auto axis = axes->required_table(key))
      (in_table ? machine.chain.table : machine.chain.head)
          .push_back(read_rotary(*axis, all[k].letter, in_table, machine.limit_margin));
  }
  read_chain_order(*chain, machine.chain);
  chain->finish();
  refuse_offsets_in_metres(*axes, machine);
  for (const char* letter : {"A", "B", "C"})
    (void)axes->value(letter, {{toml::ValueKind::table}});  // in the chain or not
  for (const toml::TomlEntry& entry : axes->entries())
    if (entry.key == "A" || entry.key == "B" || entry.key == "C") {
      if (std::none_of(all.begin(), all.end(), [&entry](const NamedAxis& a) { return a.letter == entry.key[0]; }))
        root.refuse_at(entry.key_position, "axes.{} is named in neither chain.table nor chain.head", entry.key);
    } else if (entry.key != "X" && entry.key != "Y" && entry.key != "Z") {
      root.refuse_at(entry.key_position, "unknown key axes.{}", entry.key);
    }
}

void read_limits(toml::TableReader limits, Machine& machine) {
  machine.max_cutting_feed =
      limits.number("cutting_feed", toml::Range::positive(kLargestSpeed, " mm/min")).value_or(0.0);
  machine.table_diameter_mm =
      limits.number("table_diameter", toml::Range::positive(kLargestLength, " mm")).value_or(0.0);
  machine.table_face_mm = limits.optional_number("table_face", {-kLargestLength, kLargestLength, " mm"});
  machine.min_block_ms = limits.number("min_block_ms", {0.0, 1e4, " ms"}).value_or(0.0);
  machine.part_diameter_mm = limits.optional_number("part_diameter", toml::Range::positive(kLargestLength, " mm"));
  machine.max_part_mass_kg = limits.optional_number("part_mass", toml::Range::positive(1e6, " kg"));
  machine.feed_factor = limits.number_or("feed_factor", {1.0, 100.0, ""}, machine.feed_factor);
  machine.speed_factor = limits.number_or("speed_factor", {1.0, 100.0, ""}, machine.speed_factor);
  machine.limit_margin.linear_mm =
      limits.number_or("limit_margin", {0.0, 100.0, " mm"}, machine.limit_margin.linear_mm);
  machine.limit_margin.rotary_rad =
      radians(limits.number_or("limit_margin_angle", {0.0, 10.0, " deg"}, degrees(machine.limit_margin.rotary_rad)));
  limits.finish();
}

/// Smoothing is stated whole: its blocks, and how far the tip leaves the path while it is on.
void read_smoothing(toml::TableReader& post, PostSettings& settings) {
  for (const char* key : {"smoothing_off", "smoothing_tolerance", "smoothing_axis_tolerance"}) {
    post.relate(toml::KeyRelation::Kind::needs, key, "smoothing_on");
    if (!post.has("smoothing_on") && post.misplaced(key))
      post.refuse(key, "{} needs {}", post.name(key), post.name("smoothing_on"));
  }
  const auto blocks = [&post](const char* key) {
    auto list = post.optional_ascii_list(key, {1, kMostBlocks});
    if (list && list->empty()) post.refuse(key, "{} is empty, must have at least one block", post.name(key));
    return std::move(list).value_or(std::vector<std::string>{});
  };
  settings.smoothing_on = blocks("smoothing_on");
  if (!post.has("smoothing_on")) return;
  for (const char* key : {"smoothing_off", "smoothing_tolerance"}) {
    post.relate(toml::KeyRelation::Kind::needs, "smoothing_on", key);
    post.demand(key);
  }
  settings.smoothing_off = blocks("smoothing_off");
  settings.smoothing_tolerance_mm = post.optional_number("smoothing_tolerance", toml::Range::positive(1.0, " mm"));
  if (const auto angle = post.optional_number("smoothing_axis_tolerance", toml::Range::positive(1.0, " deg")))
    settings.smoothing_axis_tolerance_rad = radians(*angle);
}

/// What the builder switches a coolant with: the word that does it, and the one that ends it.
void read_coolant_words(toml::TableReader& post, PostSettings& settings) {
  for (const Coolant coolant : kCoolants) {
    const std::string key = fmt::format("coolant_{}", to_string(coolant));
    const auto words = post.optional_ascii_list(key, {2, 2});
    if (!words) continue;
    if (words->size() != 2) post.refuse(key, "{} has {} words, must have 2: on and off", post.name(key), words->size());
    else if (words->front() == words->back())
      post.refuse(key, "{}: {} cannot mean both on and off", post.name(key), words->front());
    else settings.coolant[coolant] = {words->front(), words->back()};
  }
}

/// Lines of the shop, and where its reference positions are.
void read_own_lines(toml::TableReader& post, PostSettings& settings) {
  const auto lines = [&post](const char* key) { return post.optional_ascii_list(key, {1, kMostBlocks}); };
  settings.own_lines.start = lines("start").value_or(std::vector<std::string>{});
  settings.own_lines.tool_change = lines("tool_change");
  if (settings.own_lines.tool_change && settings.own_lines.tool_change->empty())
    post.refuse("tool_change", "{} is empty, must have the lines that fetch a tool", post.name("tool_change"));
  settings.own_lines.between_teeth = lines("between_teeth").value_or(std::vector<std::string>{});
  settings.own_lines.end = lines("end").value_or(std::vector<std::string>{});
  const char* const keys[] = {"reference_position", "second_reference_position"};
  for (std::size_t i = 0; i < 2; ++i)
    if (const auto place = post.optional_number_list(keys[i], {-kLargestLength, kLargestLength, " mm or deg"}, {3, 5}))
      settings.reference_positions[i] = *place;
  settings.retracts_to_reference = post.word_or("retract", {"machine", "reference"}, "machine") == "reference";
}

void read_post(toml::TableReader post, PostSettings& settings) {
  settings.linear_decimals = post.optional_integer("linear_decimals", {0, 9});
  settings.rotary_decimals = post.optional_integer("rotary_decimals", {0, 9});
  settings.index_loop = post.optional_boolean("index_loop");
  settings.index_offset = post.optional_text("index_offset", {.ascii = true}).value_or("");
  settings.transformation_takes_rotary_offset =
      post.optional_boolean("transformation_takes_rotary_offset").value_or(false);
  settings.tcp_on = post.optional_ascii_list("tcp_on").value_or(std::vector<std::string>{});
  settings.tcp_off = post.optional_ascii_list("tcp_off").value_or(std::vector<std::string>{});
  settings.corner_tolerance_mm = post.optional_number("corner_tolerance", toml::Range::positive(0.1, " mm"));
  read_smoothing(post, settings);
  read_coolant_words(post, settings);
  read_own_lines(post, settings);
  settings.length_reference = post.word_or("length_reference", {"tip", "centre"}, "tip") == "tip"
                                  ? LengthReference::tip
                                  : LengthReference::centre;
  const std::initializer_list<std::string_view> poles = {"error", "tilt", "hold", "through", "slow", "retract"};
  const std::string pole = post.word_or("pole", poles, "error");
  settings.pole = static_cast<PoleOption>(std::find(poles.begin(), poles.end(), pole) - poles.begin());
  if (const auto angle = post.optional_number("pole_angle", toml::Range::positive(kLargestPoleAngle, " deg")))
    settings.pole_angle_rad = radians(*angle);
  post.finish();
}

/// The setter of the tools, and the lines that go there.
ToolCheck read_tool_check(toml::TableReader table) {
  ToolCheck check;
  if (auto lines = table.optional_ascii_list("lines", {1, kMostBlocks})) {
    if (lines->empty()) table.refuse("lines", "{} is empty, must have at least one line", table.name("lines"));
    check.lines = std::move(*lines);
  }
  if (const auto at = table.numbers("position", 3, {-kLargestLength, kLargestLength, " mm"}))
    check.position_mm = Vec3((*at)[0], (*at)[1], (*at)[2]);
  check.clearance_mm = table.number_or("clearance", {kLeastClearance, kMostClearance, " mm"}, check.clearance_mm);
  check.feed_mm_min = table.number_or("feed", toml::Range::positive(kLargestSpeed, " mm/min"), check.feed_mm_min);
  check.tolerance_mm = table.optional_number("tolerance", {kLeastCheckTolerance, kMostCheckTolerance, " mm"});
  check.uncertainty_mm = table.optional_number("uncertainty", {0, 1, " mm"});
  check.minutes = table.number_or("time", {0, kLongestToolChange, " s"}, 0) / 60;
  table.finish();
  return check;
}

/// Where the direction of the last rotary axis stands: that of a pair that cannot work together.
SourcePosition direction_position(const toml::TomlValue& tree, const KinematicChain& chain) {
  const auto inside = [](const toml::TomlEntry* entry, std::string_view key) {
    const toml::TomlTable* table = entry ? entry->value.table() : nullptr;
    return table ? table->find(key) : nullptr;
  };
  const char letter = chain.rotary(chain.rotary_count() - 1).letter;
  const toml::TomlEntry* direction = inside(inside(tree.table()->find("axes"), letter_name(letter)), "direction");
  return direction ? direction->value.position : tree.position;
}

/// A time with some axes that stop at once and some that do not would mean nothing; nor a jerk without acceleration.
void check_accelerations(toml::TableReader& root, const Machine& machine) {
  const auto every_or_none = [&](const char* key, double LinearAxis::*linear, double RotaryAxis::*rotary) {
    bool any = false;
    std::string lacking;
    const auto look = [&](char letter, double limit) {
      any = any || limit > 0;
      if (!(limit > 0)) lacking += fmt::format("{}axes.{}", lacking.empty() ? "" : ", ", letter);
    };
    for (std::size_t i = 0; i < 3; ++i) look("XYZ"[i], machine.chain.linear[i].*linear);
    for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
      look(machine.chain.rotary(k).letter, machine.chain.rotary(k).*rotary);
    if (any && !lacking.empty())
      root.refuse("axes", "{} stands at some axes and is missing at {}: every axis has one, or none", key, lacking);
  };
  every_or_none("max_acceleration", &LinearAxis::max_acceleration, &RotaryAxis::max_acceleration);
  every_or_none("max_jerk", &LinearAxis::max_jerk, &RotaryAxis::max_jerk);
  if (machine.has_jerk() && !machine.has_acceleration())
    root.refuse("axes", "max_jerk stands without max_acceleration: a jerk limits how fast an acceleration changes");
}

Machine read_machine_tree(const toml::TomlValue& tree, const std::string& file, const MachineJudge& judge,
                          toml::ReaderFindings& findings) {
  toml::TableReader root(tree, "", findings);
  Machine machine;
  machine.file = file;
  (void)root.integer("schema", {1, 1});
  machine.name = root.text("name").value_or("");
  if (const auto kind = read_kind(root); kind && *kind != "five_axis") {
    root.refuse("kind", "kind = \"{}\" is no milling machine; \"five_axis\" is needed here", *kind);
    return machine;
  }
  machine.dialect = root.text("dialect", {.ascii = true}).value_or("");
  const std::initializer_list<std::string_view> modes = {"none", "angles", "vectors"};
  if (const auto tcp = root.word("tcp", modes))
    machine.tcp = static_cast<TcpMode>(std::find(modes.begin(), modes.end(), *tcp) - modes.begin());
  machine.assumed_keys = read_assumed(root, tree);
  machine.assumed = !machine.assumed_keys.empty();
  machine.max_simultaneous_axes = root.integer("max_simultaneous_axes", {3, 9}).value_or(0);
  if (auto spindle = root.required_table("spindle")) {
    machine.max_spindle_speed =
        spindle->number("max_speed", toml::Range::positive(kLargestSpeed, " 1/min")).value_or(0.0);
    if (const auto seconds = spindle->optional_number("tool_change", toml::Range::positive(kLongestToolChange, " s")))
      machine.tool_change_min = *seconds / 60;
    spindle->finish();
  }
  if (const auto limits = root.required_table("limits")) read_limits(*limits, machine);
  if (const auto post = root.table("post")) read_post(*post, machine.post);
  if (const auto check = root.table("tool_check")) machine.tool_check = read_tool_check(*check);
  read_chain(root, machine);
  read_bodies(root, machine);
  check_accelerations(root, machine);
  root.finish();
  machine.positions = findings.positions;
  if (judge && !machine.dialect.empty()) {
    auto complaints = judge(machine);
    findings.errors.insert(findings.errors.end(), std::make_move_iterator(complaints.begin()),
                           std::make_move_iterator(complaints.end()));
  }
  if (findings.errors.empty())
    if (const Status chain = check_chain(machine.chain); !chain)
      root.refuse_at(direction_position(tree, machine.chain), "{}", chain.error().message);
  return machine;
}

}  // namespace

MachineReading read_machine_text(std::string_view text, const std::string& file, const MachineJudge& judge) {
  return read_machine_as<MachineReading>(
      text, file, [&judge](const toml::TomlValue& tree, const std::string& name, toml::ReaderFindings& findings) {
        return read_machine_tree(tree, name, judge, findings);
      });
}

MachineReading read_machine_file(const std::string& path, const MachineJudge& judge) {
  return read_machine_file_as<MachineReading>(
      path, [&judge](std::string_view text, const std::string& file) { return read_machine_text(text, file, judge); });
}

std::vector<Diagnostic> note_machine_keys(const toml::TomlValue& document, toml::KeyNotes& notes) {
  toml::ReaderFindings findings(machine_words());
  findings.notes = &notes;
  (void)read_machine_tree(document, "", {}, findings);
  return std::move(findings.errors);
}

Result<MachineFileText> open_machine_file(const std::string& path) {
  auto text = read_machine_bytes(path);
  if (!text) return text.error();
  const auto tree = parse_machine_toml(*text, path);
  if (!tree) return tree.error();
  toml::ReaderFindings findings(machine_words());
  toml::TableReader root(*tree, "", findings);
  if (tree->table()->find("gear") && !tree->table()->find("kind"))
    root.refuse("gear", "[gear]: this is a job file, a machine file is needed here");
  const auto kind = read_kind(root);
  if (!kind) return findings.errors.front();
  return MachineFileText{path, std::move(text).value(),
                         *kind == "five_axis" ? MachineKind::five_axis : MachineKind::gear_shaper};
}

}  // namespace toothpath::machines
