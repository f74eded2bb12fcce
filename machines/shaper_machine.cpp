#include "machines/shaper_machine.h"

#include <algorithm>

#include "geometry/base/angle.h"
#include "machines/machine_table.h"

namespace toothpath::machines {
namespace {

constexpr int kMostTeeth = 1000;  // of a change gear
constexpr int kLargestConstant = 1000000;

Ratio read_ratio(toml::TableReader table) {
  Ratio ratio;
  if (const auto pair = table.integer_list("constant", {1, kLargestConstant}, {2, 2})) {
    if (pair->size() == 2) ratio = {(*pair)[0], (*pair)[1]};
    else table.refuse("constant", "{} has {} numbers, must have 2", table.name("constant"), pair->size());
  }
  table.finish();
  return ratio;
}

void read_stroke(toml::TableReader stroke, ShaperMachine& machine) {
  if (const auto steps = stroke.number_list("steps", toml::Range::positive(1e5, " 1/min"), {1, SIZE_MAX})) {
    machine.stroke_steps = *steps;
    if (steps->empty()) stroke.refuse("steps", "{} is empty, must have at least 1 step", stroke.name("steps"));
    for (std::size_t i = 1; i < steps->size(); ++i)
      if (!((*steps)[i] > (*steps)[i - 1]))
        stroke.refuse("steps", "{}[{}] = {} must exceed the step before it, {}", stroke.name("steps"), i, (*steps)[i],
                      (*steps)[i - 1]);
  }
  machine.max_stroke_mm = stroke.number("max_length", toml::Range::positive(kLargestLength, " mm")).value_or(0.0);
  machine.relief_mm = stroke.number("relief", toml::Range::positive(100.0, " mm")).value_or(0.0);
  stroke.finish();
}

void read_gears(toml::TableReader gears, ShaperMachine& machine) {
  if (const auto teeth = gears.integer_list("teeth", {5, kMostTeeth}, {2, SIZE_MAX})) {
    machine.gears = *teeth;
    if (teeth->size() < 2)
      gears.refuse("teeth", "{} lists {} gears, must list at least 2", gears.name("teeth"), teeth->size());
    for (std::size_t i = 0; i < teeth->size(); ++i) {
      const auto first = std::find(teeth->begin(), teeth->end(), (*teeth)[i]) - teeth->begin();
      if (first != static_cast<std::ptrdiff_t>(i))
        gears.refuse_at(gears.where("teeth", i), "{} lists {} twice; each wheel is there once", gears.name("teeth"),
                        (*teeth)[i]);
    }
  }
  machine.mesh_margin = gears.integer("mesh_margin", {0, kMostTeeth}).value_or(0);
  gears.finish();
}

/// An M code: M and one to four digits.
std::string read_m_code(toml::TableReader& table, const char* key) {
  const auto code = table.text(key, {.ascii = true, .pattern = "M[0-9]{1,4}"});
  if (!code) return "";
  const bool right = code->size() >= 2 && code->size() <= 5 && code->front() == 'M' &&
                     std::all_of(code->begin() + 1, code->end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!right) table.refuse(key, "{} = \"{}\" is no M code, as \"M61\"", table.name(key), *code);
  return *code;
}

/// An axis name: one capital letter and at most two digits.
std::string read_axis_name(toml::TableReader& table, const char* key) {
  const auto name = table.text(key, {.ascii = true, .pattern = "[A-Z][0-9]{0,2}"});
  if (!name) return "";
  const bool right = !name->empty() && name->size() <= 3 && name->front() >= 'A' && name->front() <= 'Z' &&
                     std::all_of(name->begin() + 1, name->end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!right) table.refuse(key, "{} = \"{}\" is no axis name, as \"C2\"", table.name(key), *name);
  return *name;
}

void read_gearbox(toml::TableReader table, ShaperGears gears, ShaperMachine& machine) {
  ElectronicGearbox box;
  box.relief_on = read_m_code(table, "relief_on");
  box.relief_off = read_m_code(table, "relief_off");
  if (gears == ShaperGears::named_axes) {
    box.cutter_axis = read_axis_name(table, "cutter_axis");
    box.work_axis = read_axis_name(table, "work_axis");
    if (box.cutter_axis == box.work_axis)
      table.refuse("work_axis", "{} = \"{}\" must differ from {}", table.name("work_axis"), box.work_axis,
                   table.name("cutter_axis"));
  } else {
    box.pulses_per_turn = table.integer("pulses_per_turn", {1, 999999999}).value_or(0);
  }
  table.finish();
  machine.gearbox = std::move(box);
}

ShaperAxis read_axis(toml::TableReader axis, bool rotary) {
  const double scale = rotary ? radians(1.0) : 1.0;
  const double largest = rotary ? kLargestAngle : kLargestLength;
  const char* unit = rotary ? " deg" : " mm";
  ShaperAxis out;
  const auto lo = axis.number("min", {-largest, largest, unit});
  const auto hi = axis.number("max", {-largest, largest, unit});
  if (lo && hi && !(*hi > *lo))
    axis.refuse("max", "{} = {} must exceed {} = {}", axis.name("max"), *hi, axis.name("min"), *lo);
  out.min = lo.value_or(0.0) * scale;
  out.max = hi.value_or(0.0) * scale;
  out.max_speed =
      axis.number("max_speed", toml::Range::positive(kLargestSpeed, rotary ? " deg/min" : " mm/min")).value_or(0.0) *
      scale;
  if (rotary) out.sign = read_sense(axis, "sign", toml::Presence::optional);
  axis.finish();
  return out;
}

ShaperMachine read_shaper_tree(const toml::TomlValue& tree, const std::string& file,
                               const std::vector<ShaperDialect>& dialects, toml::ReaderFindings& findings) {
  toml::TableReader root(tree, "", findings);
  ShaperMachine machine;
  machine.file = file;
  (void)root.integer("schema", {1, 1});
  machine.name = root.text("name").value_or("");
  if (const auto kind = read_kind(root); kind && *kind != "gear_shaper") {
    root.refuse("kind", "kind = \"{}\" is no gear shaper; \"gear_shaper\" is needed here", *kind);
    return machine;
  }
  std::vector<std::string_view> names;
  for (const auto& dialect : dialects) names.push_back(dialect.name);
  machine.dialect = root.variant("dialect", names).value_or("");
  ShaperGears coupled_by = ShaperGears::change_gears;
  for (const auto& dialect : dialects)
    if (dialect.name == machine.dialect) coupled_by = dialect.gears;
  machine.assumed_keys = read_assumed(root, tree);
  machine.assumed = !machine.assumed_keys.empty();
  if (const auto stroke = root.required_table("stroke")) read_stroke(*stroke, machine);
  if (coupled_by != ShaperGears::change_gears) {
    if (const auto box = root.required_table("gearbox")) read_gearbox(*box, coupled_by, machine);
  } else {
    if (const auto index = root.required_table("index")) machine.index_constant = read_ratio(*index);
    if (const auto feed = root.required_table("feed")) machine.feed_constant = read_ratio(*feed);
    if (const auto gears = root.required_table("gears")) read_gears(*gears, machine);
  }
  if (auto axes = root.required_table("axes")) {
    for (const char letter : {'X', 'Y', 'Z', 'A', 'C'})
      if (const auto axis = axes->required_table(std::string(1, letter)))
        machine.axes[letter] = read_axis(*axis, letter == 'A' || letter == 'C');
    axes->finish();
  }
  root.finish();
  return machine;
}

}  // namespace

ShaperMachineReading read_shaper_machine_text(std::string_view text, const std::string& file,
                                              const std::vector<ShaperDialect>& dialects) {
  return read_machine_as<ShaperMachineReading>(
      text, file, [&](const toml::TomlValue& tree, const std::string& name, toml::ReaderFindings& findings) {
        return read_shaper_tree(tree, name, dialects, findings);
      });
}

std::vector<Diagnostic> note_shaper_keys(const toml::TomlValue& document, const std::vector<ShaperDialect>& dialects,
                                         toml::KeyNotes& notes) {
  toml::ReaderFindings findings(machine_words());
  findings.notes = &notes;
  (void)read_shaper_tree(document, "", dialects, findings);
  return std::move(findings.errors);
}

ShaperMachineReading read_shaper_machine_file(const std::string& path, const std::vector<ShaperDialect>& dialects) {
  return read_machine_file_as<ShaperMachineReading>(path, [&](std::string_view text, const std::string& file) {
    return read_shaper_machine_text(text, file, dialects);
  });
}

}  // namespace toothpath::machines
