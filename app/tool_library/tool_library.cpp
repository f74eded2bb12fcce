#include "app/tool_library/tool_library.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "app/tool_library/formats.h"
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

Result<std::vector<LibraryTool>> read_tool_library_text(const std::string& text, const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (ending == ".tbl") return read_linuxcnc_table(text, path);
  if (ending == ".json") return read_fusion_library(text, path);
  if (ending == ".fctb") return read_freecad_bit(text, path);
  if (ending == ".fctl") return read_freecad_library(text, path);
  return fail_at({path, 0, 0}, "tools are read from {}; this ends with \"{}\"", kFormats, ending);
}

Result<std::vector<LibraryTool>> read_tool_library(const std::string& path) {
  const auto text = toml::read_input_file(path, kMostToolBytes);
  if (!text) return text.error();
  return read_tool_library_text(*text, path);
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
