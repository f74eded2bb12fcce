#include "app/tool_library/tool_library.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "app/tool_library/formats.h"
#include "geometry/base/length_unit.h"
#include "machines/toml/input_text.h"
#include "machines/toml/regular_file.h"

namespace toothpath::tool_library {

Result<nlohmann::json> parse_object(const std::string& text, const std::string& path) {
  try {
    auto json = nlohmann::json::parse(text);
    if (!json.is_object()) return fail_at({path, 1, 1}, "the outermost value is no object");
    return json;
  } catch (const nlohmann::json::parse_error& error) {
    const std::string_view before(text.data(), std::min(error.byte > 0 ? error.byte - 1 : 0, text.size()));
    const auto line = std::count(before.begin(), before.end(), '\n');
    const auto start = before.rfind('\n');
    const auto column = start == std::string_view::npos ? before.size() : before.size() - start - 1;
    return fail_at({path, int(line) + 1, int(column) + 1}, "this is no JSON");
  } catch (const nlohmann::json::exception&) { return fail_at({path, 0, 0}, "a number is too large"); }
}

LibraryUnit library_unit_of(std::string_view word) {
  return word == "inch" ? LibraryUnit::inch : word == "mm" ? LibraryUnit::mm : LibraryUnit::none;
}

std::optional<double> mm_of(LibraryUnit unit) {
  if (unit == LibraryUnit::none) return std::nullopt;
  return unit == LibraryUnit::inch ? kInchMm : 1.0;
}

std::optional<double> unit_of_length(std::optional<double> stated_mm, LibraryUnit said, LibraryTool& tool) {
  const auto other = mm_of(said);
  if (!stated_mm) tool.takes_unit = tool.takes_unit || other;
  else tool.other_unit = tool.other_unit || (other && *other != *stated_mm);
  return stated_mm ? stated_mm : other;
}

namespace {

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

}  // namespace

Result<std::vector<LibraryTool>> read_tool_library_text(const std::string& text, const std::string& path,
                                                        LibraryUnit unit, std::vector<OtherTool>* others) {
  const std::string ending = ending_of(path);
  if (ending == ".tbl") return read_linuxcnc_table(text, path, unit);
  if (ending == ".json") return read_fusion_library(text, path, unit, others);
  if (ending == ".fctb") return read_freecad_bit(text, path, unit);
  if (ending == ".fctl") return read_freecad_library(text, path, unit, others);
  if (ending == ".tools") {
    const auto json = unzipped(text, ".json", path);
    if (!json) return json.error();
    return read_fusion_library(*json, path, unit, others);
  }
  return fail_at({path, 0, 0}, "tools are read from {}; this ends with \"{}\"", kFormats, ending);
}

Result<std::vector<LibraryTool>> read_tool_library(const std::string& path, LibraryUnit unit,
                                                   std::vector<OtherTool>* others) {
  const auto text = ending_of(path) == ".tools" ? toml::read_input_file(path, kMostToolBytes)
                                                : toml::read_input_text(path, kMostToolBytes);
  if (!text) return text.error();
  return read_tool_library_text(*text, path, unit, others);
}

Result<LibraryTool> tool_of_library(const std::vector<LibraryTool>& tools, int number) {
  if (tools.size() == 1 && tools.front().number == 0) return tools.front();
  const auto has = [&](const LibraryTool& tool) { return tool.number == number; };
  const auto found = std::find_if(tools.begin(), tools.end(), has);
  if (found == tools.end()) {
    std::set<int> numbers;
    for (const LibraryTool& tool : tools) numbers.insert(tool.number);
    numbers.erase(0);
    if (numbers.empty()) return fail("{} tools, none with a number", tools.size());
    return fail("there is no tool {}, but {}", number, fmt::join(numbers, ", "));
  }
  if (std::any_of(found + 1, tools.end(), has)) return fail("two tools have the number {}", number);
  return *found;
}

}  // namespace toothpath::tool_library
