#include "app/proposal/library_shelf.h"

#include <algorithm>

#include "cam/tool/cutters.h"

namespace toothpath::proposal {
namespace {

constexpr double kRoughsFirst = 1.4;  // times as wide as the mill that finishes

const toml::TomlValue* value_of(const LibraryShelf::Tool& tool, const char* key) {
  const toml::TomlEntry* entry = tool.said.find(key);
  if (!entry) entry = tool.known.keys.find(key);
  return entry ? &entry->value : nullptr;
}

std::optional<double> number_of(const LibraryShelf::Tool& tool, const char* key) {
  const toml::TomlValue* value = value_of(tool, key);
  return value ? value->number() : std::nullopt;
}

/// Kinds of mills, as a job says them.
std::vector<std::string> words_of(Route route) {
  std::vector<std::string> words = {tool::kind_of(tool::CutterType::ball_end_mill).word};
  if (route == Route::line) words.emplace_back(tool::kind_of(tool::CutterType::tapered_ball_end_mill).word);
  return words;
}

bool is_there(const std::vector<job::MissingKey>& keys, const std::string& key) {
  return std::any_of(keys.begin(), keys.end(), [&](const job::MissingKey& other) { return other.key == key; });
}

toml::TomlTable with(toml::TomlTable table, const toml::TomlTable& more) {
  for (const toml::TomlEntry& entry : more.entries) {
    std::erase_if(table.entries, [&](const toml::TomlEntry& old) { return old.key == entry.key; });
    table.entries.push_back(entry);
  }
  return table;
}

}  // namespace

std::string LibraryShelf::Tool::title() const {
  return known.name.empty() ? fmt::format("tool {}", number()) : fmt::format("tool {} ({})", number(), known.name);
}

Result<LibraryShelf> LibraryShelf::open(const std::string& file, const std::string& unit) {
  auto read = tool_library::read_tool_library(file, tool_library::library_unit_of(unit));
  if (!read) return read.error();
  LibraryShelf shelf;
  shelf.file_ = file;
  shelf.unit_ = unit;
  for (tool_library::LibraryTool& known : *read) {
    Tool tool{std::move(known), {}, {}};
    tool.reading = job::read_library_tool(tool.known, tool.said);
    shelf.tools_.push_back(std::move(tool));
  }
  return shelf;
}

Status LibraryShelf::say(int number, const toml::TomlTable& keys) {
  const auto refuse = [&](const std::string& why) -> Status {
    return fail_as(DiagnosticKind::usage, "--tool {}: {}", number, why);
  };
  for (const char* key : {"number", "library", "library_number", "library_unit"})
    if (keys.find(key)) return refuse(fmt::format("{} is not said here: it follows from --tools", key));
  std::vector<tool_library::LibraryTool> all;
  for (const Tool& tool : tools_) all.push_back(tool.known);
  const auto found = tool_library::tool_of_library(all, number);
  if (!found) return refuse(fmt::format("{}: {}", file_, found.error().message));
  for (Tool& tool : tools_) {
    if (tool.known.number != found->number) continue;
    toml::TomlTable said = with(tool.said, keys);
    job::LibraryToolReading reading = job::read_library_tool(tool.known, said);
    if (!reading.wrong.empty()) return refuse(reading.wrong.front().message);
    tool.said = std::move(said);
    tool.reading = std::move(reading);
  }
  return Ok{};
}

std::vector<const LibraryShelf::Tool*> LibraryShelf::candidates(Route route, const FaceFacts& facts) const {
  const std::vector<std::string> kinds = words_of(route);
  const double most = std::max(facts.most_finishing_mm(), facts.most_roughing_mm());
  std::vector<const Tool*> found;
  for (const Tool& tool : tools_) {
    const toml::TomlValue* type = value_of(tool, "type");
    const bool fits =
        (!type || (type->text() && std::find(kinds.begin(), kinds.end(), *type->text()) != kinds.end())) &&
        number_of(tool, "diameter").value_or(0) <= most &&
        number_of(tool, "flute_length").value_or(facts.depth) >= facts.depth;
    if (fits && tool.reading.wrong.empty()) found.push_back(&tool);
  }
  return found;
}

std::vector<const LibraryShelf::Tool*> LibraryShelf::proposed(const std::vector<const Tool*>& candidates,
                                                              const FaceFacts& facts) {
  const auto widest = [&](double most, double least) {
    const Tool* best = nullptr;
    for (const Tool* tool : candidates) {
      const double d = number_of(*tool, "diameter").value_or(0);
      if (d > least && d <= most && (!best || d > *number_of(*best, "diameter"))) best = tool;
    }
    return best;
  };
  const Tool* finishing = widest(facts.most_finishing_mm(), 0);
  if (!finishing) return {};
  std::vector<const Tool*> both = {finishing};
  if (const Tool* first = widest(facts.most_roughing_mm(), kRoughsFirst * *number_of(*finishing, "diameter")))
    both.push_back(first);
  return both;
}

std::vector<job::MissingKey> LibraryShelf::missing(const Tool& tool, Route route) {
  std::vector<job::MissingKey> all = tool.reading.missing;
  const auto type = std::find_if(all.begin(), all.end(), [](const job::MissingKey& key) { return key.key == "type"; });
  if (type == all.end()) return all;
  type->shape.words = words_of(route);
  for (const std::string& word : words_of(route)) {
    toml::TomlTable kind;
    toml::TomlEntry& entry = kind.entries.emplace_back();
    entry.key = "type";
    entry.value.data = word;
    for (const job::MissingKey& key : job::read_library_tool(tool.known, with(tool.said, kind)).missing)
      if (!is_there(all, key.key)) all.push_back(key);
  }
  return all;
}

const LibraryShelf::Tool* LibraryShelf::find(int number) const {
  const auto found = std::find_if(tools_.begin(), tools_.end(), [&](const Tool& t) { return t.number() == number; });
  return found == tools_.end() ? nullptr : &*found;
}

Shelf LibraryShelf::whole() const {
  Shelf shelf;
  for (const Tool& tool : tools_)
    if (tool.whole()) shelf.push_back(tool.reading.tool);
  return shelf;
}

LibraryWords LibraryShelf::words(const std::string& file) const {
  LibraryWords words{file, unit_, {}};
  for (const Tool& tool : tools_) words.said[tool.number()] = tool.said;
  return words;
}

}  // namespace toothpath::proposal
