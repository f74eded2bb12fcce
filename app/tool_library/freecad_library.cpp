// Tool bits of FreeCAD (.fctb: a shape and its parameters, each with its unit) and its libraries (.fctl: numbers and
// the bits that have them). A bit knows no gauge line and no holder.
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/tool_library/formats.h"
#include "geometry/base/printable.h"
#include "machines/toml/regular_file.h"

namespace toothpath::tool_library {
namespace {

using Json = nlohmann::json;

std::optional<double> scale_of(std::string_view unit) {
  if (unit == "mm") return 1.0;
  if (unit == "in" || unit == "\"") return 25.4;
  if (unit == "cm") return 10.0;
  if (unit == "um" || unit == "\xC2\xB5m") return 1e-3;
  return {};
}

/// "6.000 mm": a length with its unit, in mm.
Result<double> length_of(const Json& value, const std::string& name, const SourcePosition& at) {
  if (!value.is_string()) return fail_at(at, "{} is no length with its unit", name);
  const auto text = value.get<std::string>();
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string_view unit(end, std::size_t(text.data() + text.size() - end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  while (unit.ends_with(' ')) unit.remove_suffix(1);
  const auto scale = scale_of(unit);
  if (error != std::errc{} || !std::isfinite(number) || !scale)
    return fail_at(at, "{} = \"{}\": no length in mm, um, cm or in", name, printable(text));
  return number * *scale;
}

struct Shape {
  const char* file;
  const char* type;
};
constexpr Shape kShapes[] = {{"ballend", "ball_end_mill"},
                             {"endmill", "flat_end_mill"},
                             {"bullnose", "bull_nose_end_mill"},
                             {"taperedballnose", "tapered_ball_end_mill"}};

struct Parameter {
  const char* name;
  const char* key;
};
constexpr Parameter kLengths[] = {{"Diameter", "diameter"},
                                  {"CuttingEdgeHeight", "flute_length"},
                                  {"ShankDiameter", "shank_diameter"},
                                  {"CornerRadius", "corner_radius"}};

/// "2", 2
std::optional<std::int64_t> count_of(const Json& value) {
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!value.is_string()) return {};
  const auto text = value.get<std::string>();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return number;
}

/// Nothing: a kind that no job has.
Result<std::optional<LibraryTool>> read_bit(const Json& json, const std::string& path) {
  const SourcePosition at{path, 0, 0};
  const auto found = json.find("shape"), parameters = json.find("parameter");
  if (found == json.end() || !found->is_string() || parameters == json.end() || !parameters->is_object())
    return fail_at(at, "a tool bit of FreeCAD has \"shape\" and \"parameter\"");
  const std::string shape = std::filesystem::path(found->get<std::string>()).stem().string();
  const auto* kind =
      std::find_if(std::begin(kShapes), std::end(kShapes), [&](const Shape& s) { return s.file == shape; });
  if (kind == std::end(kShapes)) return std::optional<LibraryTool>();
  LibraryTool tool;
  if (const auto name = json.find("name"); name != json.end() && name->is_string())
    tool.name = name->get<std::string>();
  add_key(tool, "type", std::string(kind->type), at);
  const bool bull = std::string_view(kind->type) == "bull_nose_end_mill";
  for (const Parameter& p : kLengths) {
    const auto value = parameters->find(p.name);
    if (value == parameters->end() || (std::string_view(p.key) == "corner_radius" && !bull)) continue;
    const auto length = length_of(*value, p.name, at);
    if (!length) return length.error();
    add_key(tool, p.key, *length, at);
  }
  for (const char* group : {"parameter", "attribute"})
    if (const auto table = json.find(group); table != json.end() && table->is_object())
      if (const auto flutes = table->find("Flutes"); flutes != table->end())
        if (const auto count = count_of(*flutes)) add_key(tool, "teeth", *count, at);
  if (parameters->contains("TaperAngle"))
    tool.notes.push_back(
        "TaperAngle is not taken: half_angle is between the axis and the side, half of the included one");
  if (bull && parameters->contains("FlatRadius") && !parameters->contains("CornerRadius"))
    tool.notes.push_back("FlatRadius is not taken: it is used for the flat and for the corner");
  return std::optional(std::move(tool));
}

}  // namespace

Result<std::vector<LibraryTool>> read_freecad_bit(const std::string& text, const std::string& path) {
  const auto json = parse_object(text, path);
  if (!json) return json.error();
  auto tool = read_bit(*json, path);
  if (!tool) return tool.error();
  if (!*tool)
    return fail_at({path, 0, 0}, "the tool bit is no end mill: its shape is \"{}\"",
                   printable((*json)["shape"].get<std::string>()));
  return std::vector<LibraryTool>{std::move(**tool)};
}

Result<std::vector<LibraryTool>> read_freecad_library(const std::string& text, const std::string& path) {
  const auto json = parse_object(text, path);
  if (!json) return json.error();
  const auto list = json->find("tools");
  if (list == json->end() || !list->is_array())
    return fail_at({path, 0, 0}, "a tool library of FreeCAD has an array \"tools\"");
  const auto folder = std::filesystem::path(path).parent_path();
  std::vector<LibraryTool> tools;
  for (const Json& one : *list) {
    const auto number = one.is_object() ? one.find("nr") : one.end();
    const auto bit = one.is_object() ? one.find("path") : one.end();
    if (!one.is_object() || number == one.end() || bit == one.end() || !bit->is_string() || !count_of(*number))
      return fail_at({path, 0, 0}, "a tool of the library lacks \"nr\" or \"path\"");
    const auto name = std::filesystem::path(bit->get<std::string>()).filename();
    std::string file = (folder / name).string();
    if (std::error_code error; !std::filesystem::exists(file, error))
      file = (folder / ".." / "Bit" / name).lexically_normal().string();
    const auto content = toml::read_input_file(file, kMostToolBytes);
    if (!content) return content.error();
    const auto parsed = parse_object(*content, file);
    if (!parsed) return parsed.error();
    auto tool = read_bit(*parsed, file);
    if (!tool) return tool.error();
    if (!*tool) continue;
    (*tool)->number = int(std::clamp<std::int64_t>(*count_of(*number), 0, 1'000'000));
    tools.push_back(std::move(**tool));
  }
  if (tools.empty()) return fail_at({path, 0, 0}, "the library has no end mill: {} entries", list->size());
  return tools;
}

}  // namespace toothpath::tool_library
