#include "app/proposal/library_shelf.h"

#include <fmt/ranges.h>

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

std::string title_of(int number, const std::string& name) {
  return name.empty() ? fmt::format("tool {}", number) : fmt::format("tool {} ({})", number, name);
}

toml::TomlTable with(toml::TomlTable table, const toml::TomlTable& more) {
  for (const toml::TomlEntry& entry : more.entries) {
    std::erase_if(table.entries, [&](const toml::TomlEntry& old) { return old.key == entry.key; });
    table.entries.push_back(entry);
  }
  return table;
}

}  // namespace

std::string LibraryShelf::Tool::title() const { return title_of(number(), known.name); }

Result<LibraryShelf> LibraryShelf::open(const std::string& file, const std::string& unit) {
  LibraryShelf shelf;
  auto read = tool_library::read_tool_library(file, tool_library::library_unit_of(unit), &shelf.others_);
  if (!read) return read.error();
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

std::string LibraryShelf::why_not(const Tool& tool, Route route, const FaceFacts& facts) {
  if (!tool.reading.wrong.empty()) return tool.reading.wrong.front().message;
  const std::vector<std::string> kinds = words_of(route);
  const toml::TomlValue* type = value_of(tool, "type");
  if (type && (!type->text() || std::find(kinds.begin(), kinds.end(), *type->text()) == kinds.end()))
    return fmt::format("{}: this way to cut takes {}", type->text() ? *type->text() : "no kind",
                       fmt::join(kinds, " and "));
  const auto diameter = number_of(tool, "diameter"), flute = number_of(tool, "flute_length"),
             shank = number_of(tool, "shank_diameter");
  const double roughs = facts.most_roughing_mm(), finishes = facts.most_finishing_mm();
  if (diameter && *diameter > std::max(roughs, finishes))
    return fmt::format("{:g} mm wide: at most {:.3f} mm {}", *diameter, std::max(roughs, finishes),
                       roughs > finishes ? "enter the tooth spaces to rough them" : "reach the root");
  // A neck no thicker than the ball follows it; where the ball is not known yet, or the shank, that may be so.
  const bool neck_may_follow =
      (!type || *type->text() == kinds.front()) && (!diameter || !shank || *shank <= *diameter);
  if (flute && *flute < facts.depth && !neck_may_follow)
    return fmt::format(
        "flutes of {:g} mm end above the root, {:.2f} mm below the tips, and its shank of {:g} mm is "
        "thicker than its ball",
        *flute, facts.depth, *shank);
  return {};
}

std::vector<const LibraryShelf::Tool*> LibraryShelf::candidates(Route route, const FaceFacts& facts) const {
  std::vector<const Tool*> found;
  bool finishes = false;
  const std::string finisher = words_of(route).back();
  for (const Tool& tool : tools_) {
    if (!why_not(tool, route, facts).empty()) continue;
    found.push_back(&tool);
    const toml::TomlValue* type = value_of(tool, "type");
    finishes = finishes || ((!type || *type->text() == finisher) &&
                            number_of(tool, "diameter").value_or(0) <= facts.most_finishing_mm());
  }
  return finishes ? found : std::vector<const Tool*>();
}

std::vector<std::pair<std::string, std::string>> LibraryShelf::left_out(Route route, const FaceFacts& facts) const {
  std::vector<std::pair<std::string, std::string>> all;
  const std::vector<const Tool*> taken = candidates(route, facts);
  for (const Tool& tool : tools_) {
    if (std::find(taken.begin(), taken.end(), &tool) != taken.end()) continue;
    const std::string why = why_not(tool, route, facts);
    all.emplace_back(tool.title(),
                     !why.empty() ? why
                                  : fmt::format("it may rough, but no {} of this library reaches the root: that takes "
                                                "{:.3f} mm or less",
                                                words_of(route).back(), facts.most_finishing_mm()));
  }
  for (const tool_library::OtherTool& other : others_)
    all.emplace_back(title_of(other.number, other.name), fmt::format("{}: a kind that no job has", other.kind));
  return all;
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
