#include "app/job/library_tool.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "app/job/tables.h"
#include "app/job/words.h"

namespace toothpath::job {
namespace {

constexpr const char* kSaid = "said";  // the file of what stands in no file

/// "(above 0 to 2000 mm)".
std::string range_text(const toml::Range& range) {
  return fmt::format("{}{:g} to {}{:g}{}", range.open_low ? "above " : "", range.low, range.open_high ? "below " : "",
                     range.high, range.unit);
}

/// The key that a refusal is about: its value has a line of its own.
std::string key_at(const SourcePosition& at, const toml::TomlTable& said) {
  const auto line = static_cast<std::size_t>(std::max(at.line, 0));
  return at.file == kSaid && line >= 1 && line <= said.entries.size() ? said.entries[line - 1].key : std::string();
}

}  // namespace

LibraryToolReading read_library_tool(const tool_library::LibraryTool& known, const toml::TomlTable& said) {
  toml::TomlTable table = said;
  int line = 0;
  for (toml::TomlEntry& entry : table.entries) entry.key_position = entry.value.position = {kSaid, ++line, 1};
  const SourcePosition nowhere{kSaid, 0, 0};
  table.entries.push_back({"number", nowhere, {nowhere, {std::int64_t{std::max(known.number, 1)}}}});
  const toml::TomlValue whole{nowhere, {std::move(table)}};
  toml::KeyNotes notes;
  toml::ReaderFindings findings(job_words());
  findings.notes = &notes;
  toml::TableReader reader(whole, "tool", findings);
  reader.supply(known.keys);
  std::vector<std::string> warnings;
  LibraryToolReading reading;
  reading.tool = read_tool(reader, {}, warnings);
  for (const toml::KeyNote& note : notes.keys) {
    const auto same = [&](const MissingKey& other) { return other.key == note.key; };
    if (note.presence == toml::Presence::required && !note.shapes.empty() && !reader.has(note.key) &&
        std::none_of(reading.missing.begin(), reading.missing.end(), same))
      reading.missing.push_back({note.key, note.shapes.front()});
  }
  for (const Diagnostic& error : findings.errors) {
    const std::string key = key_at(error.position, said);
    const bool of_a_value = !key.empty() || error.position.file != kSaid || error.position.line > 0;
    if (of_a_value || reading.missing.empty()) reading.wrong.push_back({key, error.message});
  }
  return reading;
}

Result<toml::TomlTable> parse_tool_keys(std::string_view text) {
  const auto document = toml::parse_toml(fmt::format("tool = {{{}}}", text), kSaid, kJobSyntax);
  const toml::TomlEntry* tool = document ? document->table()->find("tool") : nullptr;
  if (!tool || !tool->value.table() || document->table()->entries.size() != 1)
    return fail_as(DiagnosticKind::usage,
                   "\"{}\" are no keys with values as a [[tool]] has them: key = value, key = value", text);
  return *tool->value.table();
}

Result<toml::TomlValue> parse_tool_value(const toml::ValueShape& shape, std::string_view text) {
  if (shape.kind == toml::ValueKind::text && !text.starts_with('"') && !text.starts_with('\'')) {
    toml::TomlValue said{{kSaid, 0, 0}, {}};
    said.data.emplace<std::string>(text);
    return said;
  }
  const auto table = parse_tool_keys(fmt::format("value = {}", text));
  if (!table || table->entries.size() != 1)
    return fail_as(DiagnosticKind::usage, "\"{}\" is no value: {}", text, shape_text(shape));
  return table->entries.front().value;
}

std::string shape_text(const toml::ValueShape& shape) {
  if (!shape.words.empty()) return fmt::format("one of {}", fmt::join(shape.words, ", "));
  if (shape.kind == toml::ValueKind::rows && !shape.ranges.empty())
    return fmt::format("[[{}], ..], each {}", fmt::join(shape.columns, ", "), range_text(shape.ranges.front()));
  return shape.ranges.empty() ? "text" : range_text(shape.ranges.front());
}

}  // namespace toothpath::job
