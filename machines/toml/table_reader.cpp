#include "machines/toml/table_reader.h"

#include <algorithm>
#include <cmath>

#include "machines/toml/near_name.h"

namespace toothpath::toml {
namespace {

constexpr std::size_t kMostTables = 1000;  // of one list: more are no file that somebody wrote
constexpr std::size_t kMostOfAKind = 20;   // refusals of entries of one list, of unknown keys of one table

/// "gear.zone[0]" is a "gear.zone".
std::string without_indices(std::string_view path) {
  std::string name;
  bool inside = false;
  for (const char c : path) {
    if (c == '[') inside = true;
    if (!inside) name += c;
    if (c == ']') inside = false;
  }
  return name;
}

ValueShape text_shape(const TextRules& rules) {
  ValueShape shape{ValueKind::text};
  shape.pattern = rules.pattern;
  shape.ascii = rules.ascii;
  return shape;
}

ValueShape list_shape(ValueKind kind, const Range& range, const Count& count) {
  ValueShape shape = ValueShape::of_range(kind, range);
  shape.count = count;
  return shape;
}

}  // namespace

TableReader::TableReader(const TomlValue& table, std::string path, ReaderFindings& findings)
    : table_(*table.table()), position_(table.position), path_(std::move(path)), findings_(&findings) {
  findings.positions[path_] = position_;
  for (const auto& entry : table_.entries) {
    findings.positions[join(entry.key)] = entry.value.position;
    const TomlArray* const array = entry.value.array();
    for (std::size_t k = 0; array != nullptr && k < array->values.size() && array->values[k].text(); ++k)
      findings.positions[fmt::format("{}[{}]", join(entry.key), k)] = array->values[k].position;
  }
}

std::string TableReader::join(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

const TomlEntry* TableReader::entry(std::string_view key) const {
  const TomlEntry* own = table_.find(key);
  return own || !others_ ? own : others_->find(key);
}

void TableReader::record(SourcePosition position, std::string message) {
  findings_->errors.push_back({DiagnosticKind::refused_input, std::move(position), std::move(message)});
}

SourcePosition TableReader::where(std::string_view key) const {
  const TomlEntry* entry = this->entry(key);
  return entry ? entry->value.position : position_;
}

SourcePosition TableReader::where(std::string_view key, std::size_t entry) const {
  const TomlEntry* list = this->entry(key);
  const TomlArray* array = list ? list->value.array() : nullptr;
  return array && entry < array->values.size() ? array->values[entry].position : where(key);
}

void TableReader::ask(std::string_view key, const ValueShape& shape, Presence presence, std::string absent) {
  known_.emplace(key);
  if (findings_->notes)
    findings_->notes->keys.push_back(
        {without_indices(path_), std::string(key), {shape}, presence, std::move(absent), false});
}

const TomlValue* TableReader::look(std::string_view key, bool must) {
  const TomlEntry* entry = this->entry(key);
  if (!entry && must) record(position_, words().missing(path_, key));
  return entry ? &entry->value : nullptr;
}

const TomlValue* TableReader::value(std::string_view key, std::vector<ValueShape> shapes, Presence noted) {
  known_.emplace(key);
  if (findings_->notes) {
    const bool decides = shapes.size() > 1;
    findings_->notes->keys.push_back({without_indices(path_), std::string(key), std::move(shapes), noted, {}, decides});
  }
  return look(key, false);
}

const TomlValue* TableReader::required(std::string_view key, std::vector<ValueShape> shapes) {
  (void)value(key, std::move(shapes), Presence::required);
  return look(key, true);
}

bool TableReader::misplaced(std::string_view key) {
  ask(key, {}, Presence::misplaced);
  return has(key);
}

void TableReader::relate(KeyRelation::Kind kind, std::string_view first, std::string_view second) {
  if (findings_->notes)
    findings_->notes->relations.push_back({without_indices(path_), kind, std::string(first), std::string(second)});
}

const std::vector<TomlEntry>& TableReader::entries() {
  for (const auto& entry : table_.entries) known_.insert(entry.key);
  return table_.entries;
}

std::optional<double> TableReader::to_number(const TomlValue& value, const std::string& name, const Range& range) {
  const auto number = value.number();
  if (!number) {
    record(value.position, words().wrong_type(name, TomlType::real, value.type()));
    return std::nullopt;
  }
  if (!std::isfinite(*number)) {
    record(value.position, words().not_finite(name, *number));
    return std::nullopt;
  }
  const bool low = range.open_low ? *number <= range.low : *number < range.low;
  const bool high = range.open_high ? *number >= range.high : *number > range.high;
  if (low || high) {
    record(value.position, words().outside(name, *number, range));
    return std::nullopt;
  }
  return *number == 0 ? 0.0 : *number;  // no negative zero further on
}

std::optional<int> TableReader::to_integer(const TomlValue& value, const std::string& name, const Range& range) {
  const auto* whole = std::get_if<std::int64_t>(&value.data);
  if (!whole) {
    record(value.position, words().wrong_type(name, TomlType::integer, value.type()));
    return std::nullopt;
  }
  const auto number = static_cast<double>(*whole);
  if (number < range.low || number > range.high) {
    record(value.position, words().integer_outside(name, *whole, range));
    return std::nullopt;
  }
  return static_cast<int>(*whole);
}

std::optional<std::string> TableReader::to_text(const TomlValue& value, const std::string& name, bool ascii) {
  const std::string* text = value.text();
  if (!text) {
    record(value.position, words().wrong_type(name, TomlType::text, value.type()));
    return std::nullopt;
  }
  if (auto fault = words().text_fault(name, *text, ascii)) {
    record(value.position, std::move(*fault));
    return std::nullopt;
  }
  return *text;
}

std::optional<double> TableReader::number(std::string_view key, const Range& range) {
  ask(key, ValueShape::of_range(ValueKind::number, range), Presence::required);
  const TomlValue* found = look(key, true);
  return found ? to_number(*found, name(key), range) : std::nullopt;
}

std::optional<double> TableReader::optional_number(std::string_view key, const Range& range) {
  ask(key, ValueShape::of_range(ValueKind::number, range), Presence::optional);
  const TomlValue* found = look(key, false);
  return found ? to_number(*found, name(key), range) : std::nullopt;
}

double TableReader::number_or(std::string_view key, const Range& range, double absent) {
  ask(key, ValueShape::of_range(ValueKind::number, range), Presence::optional, fmt::format("{:.6g}", absent));
  const TomlValue* found = look(key, false);
  return found ? to_number(*found, name(key), range).value_or(absent) : absent;
}

std::optional<int> TableReader::integer(std::string_view key, const Range& range) {
  ask(key, ValueShape::of_range(ValueKind::integer, range), Presence::required);
  const TomlValue* found = look(key, true);
  return found ? to_integer(*found, name(key), range) : std::nullopt;
}

std::optional<int> TableReader::optional_integer(std::string_view key, const Range& range) {
  ask(key, ValueShape::of_range(ValueKind::integer, range), Presence::optional);
  const TomlValue* found = look(key, false);
  return found ? to_integer(*found, name(key), range) : std::nullopt;
}

int TableReader::integer_or(std::string_view key, const Range& range, int absent) {
  ask(key, ValueShape::of_range(ValueKind::integer, range), Presence::optional, fmt::format("{}", absent));
  const TomlValue* found = look(key, false);
  return found ? to_integer(*found, name(key), range).value_or(absent) : absent;
}

std::optional<std::string> TableReader::text(std::string_view key, const TextRules& rules) {
  ask(key, text_shape(rules), Presence::required);
  const TomlValue* found = look(key, true);
  return found ? to_text(*found, name(key), rules.ascii) : std::nullopt;
}

std::optional<std::string> TableReader::optional_text(std::string_view key, const TextRules& rules) {
  ask(key, text_shape(rules), Presence::optional);
  const TomlValue* found = look(key, false);
  return found ? to_text(*found, name(key), rules.ascii) : std::nullopt;
}

std::optional<std::string> TableReader::one_word(std::string_view key, Words allowed, bool must) {
  const TomlValue* value = look(key, must);
  if (!value) return std::nullopt;
  auto found = to_text(*value, name(key), false);
  if (!found || std::find(allowed.begin(), allowed.end(), *found) != allowed.end()) return found;
  record(where(key), words().not_one_of(name(key), *found, allowed));
  return std::nullopt;
}

std::optional<std::string> TableReader::word(std::string_view key, Words allowed) {
  ask(key, ValueShape::of_words(ValueKind::text, {allowed.begin(), allowed.end()}), Presence::required);
  return one_word(key, allowed, true);
}

std::optional<std::string> TableReader::variant(std::string_view key, Words allowed) {
  auto found = word(key, allowed);
  if (findings_->notes) findings_->notes->keys.back().decides = true;
  return found;
}

std::optional<std::string> TableReader::optional_word(std::string_view key, WordList allowed) {
  ask(key, ValueShape::of_words(ValueKind::text, {allowed.begin(), allowed.end()}), Presence::optional);
  return one_word(key, {allowed.begin(), allowed.size()}, false);
}

std::string TableReader::word_or(std::string_view key, WordList allowed, std::string_view absent) {
  ask(key, ValueShape::of_words(ValueKind::text, {allowed.begin(), allowed.end()}), Presence::optional,
      fmt::format("\"{}\"", absent));
  return one_word(key, {allowed.begin(), allowed.size()}, false).value_or(std::string(absent));
}

std::optional<bool> TableReader::to_boolean(std::string_view key, const TomlValue& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag;
  record(value.position, words().wrong_type(name(key), TomlType::boolean, value.type()));
  return std::nullopt;
}

std::optional<bool> TableReader::optional_boolean(std::string_view key) {
  ask(key, {ValueKind::boolean}, Presence::optional);
  const TomlValue* found = look(key, false);
  return found ? to_boolean(key, *found) : std::nullopt;
}

bool TableReader::boolean_or(std::string_view key, bool absent) {
  ask(key, {ValueKind::boolean}, Presence::optional, absent ? "true" : "false");
  const TomlValue* found = look(key, false);
  return found ? to_boolean(key, *found).value_or(absent) : absent;
}

template <typename T, typename Read>
std::optional<std::vector<T>> TableReader::list(std::string_view key, const TomlValue& found, Read read) {
  const TomlArray* array = found.array();
  if (!array) {
    record(found.position, words().wrong_type(name(key), TomlType::array, found.type()));
    return std::nullopt;
  }
  std::vector<T> result;
  const std::size_t before = errors();
  for (std::size_t i = 0; i < array->values.size() && errors() < before + kMostOfAKind; ++i)
    if (auto element = read(array->values[i], fmt::format("{}[{}]", name(key), i)))
      result.push_back(std::move(*element));
  return result.size() == array->values.size() ? std::optional(std::move(result)) : std::nullopt;
}

std::optional<std::vector<double>> TableReader::number_list(std::string_view key, const Range& range,
                                                            const Count& count) {
  return numbers_listed(key, range, count, Presence::required);
}
std::optional<std::vector<double>> TableReader::optional_number_list(std::string_view key, const Range& range,
                                                                     const Count& count) {
  return numbers_listed(key, range, count, Presence::optional);
}

std::optional<std::vector<double>> TableReader::numbers_listed(std::string_view key, const Range& range,
                                                               const Count& count, Presence presence) {
  ask(key, list_shape(ValueKind::numbers, range, count), presence);
  const TomlValue* found = look(key, presence == Presence::required);
  if (!found) return std::nullopt;
  return list<double>(key, *found,
                      [&](const TomlValue& value, const std::string& name) { return to_number(value, name, range); });
}

std::optional<std::vector<int>> TableReader::integer_list(std::string_view key, const Range& range,
                                                          const Count& count) {
  return integers_listed(key, range, count, Presence::required);
}
std::optional<std::vector<int>> TableReader::optional_integer_list(std::string_view key, const Range& range,
                                                                   const Count& count) {
  return integers_listed(key, range, count, Presence::optional);
}

std::optional<std::vector<int>> TableReader::integers_listed(std::string_view key, const Range& range,
                                                             const Count& count, Presence presence) {
  ask(key, list_shape(ValueKind::integers, range, count), presence);
  const TomlValue* found = look(key, presence == Presence::required);
  if (!found) return std::nullopt;
  return list<int>(key, *found,
                   [&](const TomlValue& value, const std::string& name) { return to_integer(value, name, range); });
}

std::optional<std::vector<std::string>> TableReader::optional_ascii_list(std::string_view key, const Count& count,
                                                                         std::vector<std::string> words) {
  ValueShape shape = ValueShape::of_words(ValueKind::texts, std::move(words));
  shape.count = count;
  shape.ascii = true;
  ask(key, shape, Presence::optional);
  const TomlValue* found = look(key, false);
  if (!found) return std::nullopt;
  return list<std::string>(key, *found,
                           [&](const TomlValue& value, const std::string& name) { return to_text(value, name, true); });
}

std::optional<std::vector<double>> TableReader::counted(std::string_view key, const TomlValue& value, std::size_t count,
                                                        const Range& range) {
  const TomlArray* array = value.array();
  if (array && array->values.size() == count)
    return list<double>(key, value,
                        [&](const TomlValue& v, const std::string& name) { return to_number(v, name, range); });
  record(value.position, words().not_numbers(name(key), count, value));
  return std::nullopt;
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, std::size_t count, const Range& range) {
  ask(key, list_shape(ValueKind::numbers, range, {count, count}), Presence::required);
  const TomlValue* found = look(key, true);
  return found ? counted(key, *found, count, range) : std::nullopt;
}

std::optional<std::vector<double>> TableReader::optional_numbers(std::string_view key, std::size_t count,
                                                                 const Range& range) {
  ask(key, list_shape(ValueKind::numbers, range, {count, count}), Presence::optional);
  const TomlValue* found = look(key, false);
  return found ? counted(key, *found, count, range) : std::nullopt;
}

std::optional<std::vector<double>> TableReader::numbers_of(const TomlValue& value, const std::string& name,
                                                           std::initializer_list<Range> ranges) {
  const TomlArray* array = value.array();
  if (!array || array->values.size() != ranges.size()) {
    record(value.position, words().not_numbers(name, ranges.size(), value));
    return std::nullopt;
  }
  std::vector<double> result;
  for (const Range& range : ranges) {
    const std::size_t i = result.size();
    const auto number = to_number(array->values[i], fmt::format("{}[{}]", name, i), range);
    if (!number) return std::nullopt;
    result.push_back(*number);
  }
  return result;
}

std::optional<TableReader> TableReader::table(std::string_view key, Presence noted) {
  ask(key, {ValueKind::table}, noted);
  const TomlValue* found = look(key, false);
  if (!found) return std::nullopt;
  if (found->table()) return TableReader(*found, join(key), *findings_);
  record(found->position, words().no_table(path_, key, false, found->type()));
  return std::nullopt;
}

std::optional<TableReader> TableReader::required_table(std::string_view key) {
  auto found = table(key, Presence::required);
  (void)look(key, true);
  return found;
}

std::vector<TableReader> TableReader::tables(std::string_view key, const Count& count, Presence noted) {
  std::vector<TableReader> result;
  const std::size_t before = errors();
  ValueShape shape{ValueKind::tables};
  shape.count = count;
  ask(key, shape, noted);
  const TomlValue* found = look(key, false);
  if (!found) return result;
  const TomlArray* array = found->array();
  if (!array) {
    record(found->position, words().no_table(path_, key, true, found->type()));
    return result;
  }
  if (array->values.size() > kMostTables) {
    record(found->position, fmt::format("{} = {} tables exceeds {}, the most of one list", join(key),
                                        array->values.size(), kMostTables));
    return result;
  }
  for (std::size_t i = 0; i < array->values.size() && errors() < before + kMostOfAKind; ++i) {
    const TomlValue& element = array->values[i];
    const std::string path = fmt::format("{}[{}]", join(key), i);
    if (element.table()) result.emplace_back(element, path, *findings_);
    else record(element.position, words().wrong_type(path, TomlType::table, element.type()));
  }
  return result;
}

void TableReader::finish() {
  TableWords::KnownKeys absent;  // only these can a misspelt key have been meant to be
  for (const std::string& key : known_)
    if (!has(key)) absent.insert(key);
  const std::size_t before = errors();
  for (const auto& entry : table_.entries) {
    if (known_.contains(entry.key)) continue;
    if (errors() < before + kMostOfAKind) record(entry.key_position, words().unknown(path_, entry.key, absent));
    else return record(entry.key_position, "from here on more unknown keys");
  }
}

void TableReader::name_misspelt(std::string_view key) {
  if (has(key)) return;
  std::vector<std::string_view> keys;
  for (const auto& entry : table_.entries) keys.push_back(entry.key);
  const std::string_view near = near_name(key, keys);
  if (near.empty()) return;
  const TomlEntry& entry = *table_.find(near);
  record(entry.key_position, words().unknown(path_, entry.key, {std::string(key)}));
}

void sort_by_position(std::vector<Diagnostic>& errors) {
  std::stable_sort(errors.begin(), errors.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.position.line, a.position.column) < std::pair(b.position.line, b.position.column);
  });
}

}  // namespace toothpath::toml
