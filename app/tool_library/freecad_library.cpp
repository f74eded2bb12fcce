// Tool bits of FreeCAD (.fctb: a shape and its parameters, each with its unit) and its libraries (.fctl: numbers and
// the bits that have them). A bit knows no gauge line and no holder.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/tool_library/formats.h"
#include "geometry/base/printable.h"
#include "machines/toml/input_text.h"

namespace toothpath::tool_library {
namespace {

using Json = nlohmann::json;

/// "6.000 mm": a length with its unit, in mm.
Result<double> length_of(const Json& value, const std::string& name, const SourcePosition& at, LibraryUnit said,
                         LibraryTool& tool) {
  if (!value.is_string() && !value.is_number()) return fail_at(at, "{} is no length with its unit", name);
  const std::string text = value.is_string() ? value.get<std::string>() : fmt::format("{}", value.get<double>());
  if (const auto mm = read_quantity(text, std::nullopt)) return *mm;
  const auto number = read_quantity(text, 1.0);
  if (!number) return fail_at(at, "{} = \"{}\": no length in mm, um, cm, m or inch", name, printable(text));
  const auto unit = unit_of_length(std::nullopt, said, tool);
  if (!unit) return fail_at(at, "{} = \"{}\" states no unit: {}", name, printable(text), kUnitKey);
  return *number * *unit;
}

struct Shape {
  const char* name;
  const char* type;
};
/// By the names and aliases that FreeCAD has for its shapes, in small letters.
constexpr Shape kShapes[] = {{"ballend", "ball_end_mill"},
                             {"endmill", "flat_end_mill"},
                             {"bullnose", "bull_nose_end_mill"},
                             {"torus", "bull_nose_end_mill"},
                             {"taperedballnose", "tapered_ball_end_mill"},
                             {"taperballnose", "tapered_ball_end_mill"},
                             {"conicalballnose", "tapered_ball_end_mill"}};

std::string small(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

std::string text_of(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The kind of a bit: its "shape-type"; where that is missing or "Custom", the file of its shape by its name.
std::string kind_words(const Json& json) {
  std::string name = small(text_of(json, "shape-type"));
  if (name.empty() || name == "custom") name = small(std::filesystem::path(text_of(json, "shape")).stem().string());
  return name;
}

std::optional<std::string> type_of(const Json& json) {
  const std::string name = kind_words(json);
  for (const Shape& shape : kShapes)
    if (name == shape.name) return shape.type;
  return std::nullopt;
}

struct Parameter {
  const char* name;
  const char* key;
};
constexpr Parameter kLengths[] = {{"Diameter", "diameter"},
                                  {"CuttingEdgeHeight", "flute_length"},
                                  {"ShankDiameter", "shank_diameter"},
                                  {"TorusRadius", "corner_radius"},
                                  {"CornerRadius", "corner_radius"}};  // the last one holds

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

/// "TaperAngle" is the included angle of a tapered mill (FreeCAD, shape TaperedBallNose).
void take_taper(const Json& parameters, const SourcePosition& at, LibraryTool& tool) {
  const auto found = parameters.find("TaperAngle");
  if (found == parameters.end()) return;
  const auto angle = found->is_string() ? read_angle_deg(found->get<std::string>()) : std::nullopt;
  if (angle) return add_key(tool, "half_angle", *angle / 2, at);
  tool.notes.push_back("TaperAngle has no unit deg or rad and is not taken: it is the included angle, say half_angle");
}

/// Nothing: a kind that no job has.
Result<std::optional<LibraryTool>> read_bit(const Json& json, const std::string& path, LibraryUnit unit) {
  const SourcePosition at{path, 0, 0};
  const auto parameters = json.find("parameter");
  if ((text_of(json, "shape").empty() && text_of(json, "shape-type").empty()) || parameters == json.end() ||
      !parameters->is_object())
    return fail_at(at, "a tool bit of FreeCAD has \"shape\" and \"parameter\"");
  const auto type = type_of(json);
  if (!type) return std::optional<LibraryTool>();
  LibraryTool tool;
  tool.name = text_of(json, "name");
  add_key(tool, "type", *type, at);
  const bool bull = *type == "bull_nose_end_mill";
  for (const Parameter& p : kLengths) {
    const auto value = parameters->find(p.name);
    if (value == parameters->end() || (std::string_view(p.key) == "corner_radius" && !bull)) continue;
    const auto length = length_of(*value, p.name, at, unit, tool);
    if (!length) return length.error();
    add_key(tool, p.key, *length, at);
  }
  for (const char* group : {"parameter", "attribute"})
    if (const auto table = json.find(group); table != json.end() && table->is_object())
      if (const auto flutes = table->find("Flutes"); flutes != table->end())
        if (const auto count = count_of(*flutes)) add_key(tool, "teeth", *count, at);
  if (*type == "tapered_ball_end_mill") take_taper(*parameters, at, tool);
  if (bull && parameters->contains("FlatRadius") && !tool.keys.find("corner_radius"))
    tool.notes.push_back("FlatRadius is not taken: it is used for the flat and for the corner");
  return std::optional(std::move(tool));
}

}  // namespace

Result<std::vector<LibraryTool>> read_freecad_bit(const std::string& text, const std::string& path, LibraryUnit unit) {
  const auto json = parse_object(text, path);
  if (!json) return json.error();
  auto tool = read_bit(*json, path, unit);
  if (!tool) return tool.error();
  if (!*tool)
    return fail_at({path, 0, 0}, "the tool bit is no end mill: its shape is \"{}\"{}",
                   printable(text_of(*json, "shape")),
                   text_of(*json, "shape-type").empty()
                       ? std::string()
                       : fmt::format(", its type \"{}\"", printable(text_of(*json, "shape-type"))));
  return std::vector<LibraryTool>{std::move(**tool)};
}

Result<std::vector<LibraryTool>> read_freecad_library(const std::string& text, const std::string& path,
                                                      LibraryUnit unit, std::vector<OtherTool>* others) {
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
    const auto content = toml::read_input_text(file, kMostToolBytes);
    if (!content) return content.error();
    const auto parsed = parse_object(*content, file);
    if (!parsed) return parsed.error();
    auto tool = read_bit(*parsed, file, unit);
    if (!tool) return tool.error();
    const int listed = int(std::clamp<std::int64_t>(*count_of(*number), 0, 1'000'000));
    if (!*tool && others) others->push_back({listed, text_of(*parsed, "name"), kind_words(*parsed)});
    if (!*tool) continue;
    (*tool)->number = listed;
    tools.push_back(std::move(**tool));
  }
  if (tools.empty()) return fail_at({path, 0, 0}, "the library has no end mill: {} entries", list->size());
  return tools;
}

}  // namespace toothpath::tool_library
