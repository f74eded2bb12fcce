#include "machines/shaper_machine.h"

#include <algorithm>

#include "geometry/base/angle.h"
#include "machines/toml_tree.h"

namespace toothpath {
namespace {

constexpr double kLargestLength = 1e5;   // mm
constexpr double kLargestSpeed = 1e6;    // mm/min, deg/min
constexpr double kLargestAngle = 1e7;    // deg
constexpr int kMostTeeth = 1000;         // of a change gear
constexpr int kLargestConstant = 1000000;

Ratio read_ratio(TomlTableReader table) {
  Ratio ratio;
  if (const auto pair = table.whole_numbers("constant", 1, kLargestConstant)) {
    if (pair->size() == 2)
      ratio = {(*pair)[0], (*pair)[1]};
    else
      table.refuse(table.at("constant"), "{} has {} numbers, must have 2", table.name("constant"), pair->size());
  }
  table.refuse_unknown_keys();
  return ratio;
}

void read_stroke(TomlTableReader stroke, ShaperMachine& machine) {
  if (const auto steps = stroke.numbers("steps", TomlTableReader::positive(1e5, "1/min"))) {
    machine.stroke_steps = *steps;
    if (steps->empty()) stroke.refuse(stroke.at("steps"), "{} is empty, must have at least 1 step", stroke.name("steps"));
    for (std::size_t i = 1; i < steps->size(); ++i)
      if (!((*steps)[i] > (*steps)[i - 1]))
        stroke.refuse(stroke.at("steps"), "{}[{}] = {} must exceed the step before it, {}", stroke.name("steps"), i,
                      (*steps)[i], (*steps)[i - 1]);
  }
  machine.max_stroke_mm = stroke.number("max_length", TomlTableReader::positive(kLargestLength, "mm")).value_or(0.0);
  machine.relief_mm = stroke.number("relief", TomlTableReader::positive(100.0, "mm")).value_or(0.0);
  stroke.refuse_unknown_keys();
}

void read_gears(TomlTableReader gears, ShaperMachine& machine) {
  if (const auto teeth = gears.whole_numbers("teeth", 5, kMostTeeth)) {
    machine.gears = *teeth;
    if (teeth->size() < 2)
      gears.refuse(gears.at("teeth"), "{} lists {} gears, must list at least 2", gears.name("teeth"), teeth->size());
    for (std::size_t i = 0; i < teeth->size(); ++i) {
      const auto first = std::find(teeth->begin(), teeth->end(), (*teeth)[i]) - teeth->begin();
      if (first != static_cast<std::ptrdiff_t>(i))
        gears.refuse(gears.value("teeth")->items[i].position, "{} lists {} twice; each wheel is there once",
                     gears.name("teeth"), (*teeth)[i]);
    }
  }
  machine.mesh_margin = gears.whole_number("mesh_margin", 0, kMostTeeth).value_or(0);
  gears.refuse_unknown_keys();
}

/// An M code: M and one to four digits.
std::string read_m_code(TomlTableReader& table, const char* key) {
  const auto code = table.text(key, true);
  if (!code) return "";
  const bool right = code->size() >= 2 && code->size() <= 5 && code->front() == 'M' &&
                     std::all_of(code->begin() + 1, code->end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!right) table.refuse(table.at(key), "{} = \"{}\" is no M code, as \"M61\"", table.name(key), *code);
  return *code;
}

/// An axis name: one capital letter and at most two digits.
std::string read_axis_name(TomlTableReader& table, const char* key) {
  const auto name = table.text(key, true);
  if (!name) return "";
  const bool right = !name->empty() && name->size() <= 3 && name->front() >= 'A' && name->front() <= 'Z' &&
                     std::all_of(name->begin() + 1, name->end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!right) table.refuse(table.at(key), "{} = \"{}\" is no axis name, as \"C2\"", table.name(key), *name);
  return *name;
}

void read_gearbox(TomlTableReader table, ShaperMachine& machine) {
  ElectronicGearbox box;
  box.relief_on = read_m_code(table, "relief_on");
  box.relief_off = read_m_code(table, "relief_off");
  if (machine.dialect == "siemens") {
    box.cutter_axis = read_axis_name(table, "cutter_axis");
    box.work_axis = read_axis_name(table, "work_axis");
    if (box.cutter_axis == box.work_axis)
      table.refuse(table.at("work_axis"), "{} = \"{}\" must differ from {}", table.name("work_axis"), box.work_axis, table.name("cutter_axis"));
  } else {
    box.pulses_per_turn = table.whole_number("pulses_per_turn", 1, 999999999).value_or(0);
  }
  table.refuse_unknown_keys();
  machine.gearbox = std::move(box);
}

ShaperAxis read_axis(TomlTableReader axis, bool rotary) {
  const double scale = rotary ? radians(1.0) : 1.0;
  const double largest = rotary ? kLargestAngle : kLargestLength;
  const char* unit = rotary ? "deg" : "mm";
  ShaperAxis out;
  const auto lo = axis.number("min", {-largest, largest, unit});
  const auto hi = axis.number("max", {-largest, largest, unit});
  if (lo && hi && !(*hi > *lo))
    axis.refuse(axis.at("max"), "{} = {} must exceed {} = {}", axis.name("max"), *hi, axis.name("min"), *lo);
  out.min = lo.value_or(0.0) * scale;
  out.max = hi.value_or(0.0) * scale;
  out.max_speed =
      axis.number("max_speed", TomlTableReader::positive(kLargestSpeed, rotary ? "deg/min" : "mm/min")).value_or(0.0) * scale;
  if (rotary && axis.has("sign")) out.sign = axis.sense("sign");
  axis.refuse_unknown_keys();
  return out;
}

ShaperMachine read_tree(const TomlValue& tree, const std::string& file, std::vector<Diagnostic>& errors) {
  TomlTableReader root(tree, "", errors);
  ShaperMachine machine;
  machine.file = file;
  (void)root.whole_number("schema", 1, 1);
  machine.name = root.text("name").value_or("");
  if (const auto kind = root.word("kind", {"five_axis", "gear_shaper"}); kind && *kind != "gear_shaper") {
    root.refuse(root.at("kind"), "kind = \"{}\" is no gear shaper; \"gear_shaper\" is needed here", *kind);
    return machine;
  }
  machine.dialect = root.word("dialect", {"fanuc", "linuxcnc", "siemens"}).value_or("");
  machine.assumed_keys = read_assumed(root, tree);
  machine.assumed = !machine.assumed_keys.empty();
  if (const auto stroke = root.table("stroke")) read_stroke(*stroke, machine);
  if (machine.dialect == "siemens" || machine.dialect == "fanuc") {
    if (const auto box = root.table("gearbox")) read_gearbox(*box, machine);
  } else {
    if (const auto index = root.table("index")) machine.index_constant = read_ratio(*index);
    if (const auto feed = root.table("feed")) machine.feed_constant = read_ratio(*feed);
    if (const auto gears = root.table("gears")) read_gears(*gears, machine);
  }
  if (auto axes = root.table("axes")) {
    for (const char letter : {'X', 'Y', 'Z', 'A', 'C'})
      if (const auto axis = axes->table(std::string(1, letter)))
        machine.axes[letter] = read_axis(*axis, letter == 'A' || letter == 'C');
    axes->refuse_unknown_keys();
  }
  root.refuse_unknown_keys();
  return machine;
}

}  // namespace

ShaperMachineReading read_shaper_machine_text(std::string_view text, const std::string& file) {
  ShaperMachineReading reading;
  const auto tree = parse_toml(text, file);
  if (!tree) {
    reading.errors.push_back(tree.error());
    return reading;
  }
  ShaperMachine machine = read_tree(*tree, file, reading.errors);
  sort_by_position(reading.errors);
  if (reading.errors.empty()) reading.machine = std::move(machine);
  return reading;
}

ShaperMachineReading read_shaper_machine_file(const std::string& path) {
  const auto text = read_text_file(path);
  if (text) return read_shaper_machine_text(*text, path);
  ShaperMachineReading reading;
  reading.errors.push_back(text.error());
  return reading;
}

}  // namespace toothpath
