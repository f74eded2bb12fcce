#include "machines/toml/table_reader.h"

#include <algorithm>
#include <cmath>

#include "machines/toml/near_name.h"

namespace toothpath::toml {

TableReader::TableReader(const TomlValue& table, std::string path, ReaderFindings& findings)
    : table_(*table.table()), position_(table.position), path_(std::move(path)), findings_(&findings) {
  findings.positions[path_] = position_;
  for (const auto& entry : table_.entries) findings.positions[join(entry.key)] = entry.value.position;
}

std::string TableReader::join(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void TableReader::record(SourcePosition position, std::string message) {
  findings_->errors.push_back({DiagnosticKind::refused_input, std::move(position), std::move(message)});
}

SourcePosition TableReader::where(std::string_view key) const {
  const TomlEntry* entry = table_.find(key);
  return entry ? entry->value.position : position_;
}

const TomlValue* TableReader::value(std::string_view key) {
  known_.emplace(key);
  const TomlEntry* entry = table_.find(key);
  return entry ? &entry->value : nullptr;
}

const TomlValue* TableReader::required(std::string_view key) {
  const TomlValue* found = value(key);
  if (!found) record(position_, words().missing(path_, key));
  return found;
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
  const TomlValue* found = required(key);
  return found ? to_number(*found, name(key), range) : std::nullopt;
}

std::optional<int> TableReader::integer(std::string_view key, const Range& range) {
  const TomlValue* found = required(key);
  return found ? to_integer(*found, name(key), range) : std::nullopt;
}

std::optional<std::string> TableReader::text(std::string_view key, bool ascii) {
  const TomlValue* found = required(key);
  return found ? to_text(*found, name(key), ascii) : std::nullopt;
}

std::optional<std::string> TableReader::word(std::string_view key, std::span<const std::string_view> allowed) {
  auto found = text(key);
  if (!found || std::find(allowed.begin(), allowed.end(), *found) != allowed.end()) return found;
  record(where(key), words().not_one_of(name(key), *found, allowed));
  return std::nullopt;
}

std::optional<bool> TableReader::boolean(std::string_view key) {
  const TomlValue* found = required(key);
  if (!found) return std::nullopt;
  if (const auto* flag = std::get_if<bool>(&found->data)) return *flag;
  record(found->position, words().wrong_type(name(key), TomlType::boolean, found->type()));
  return std::nullopt;
}

template <typename T, typename Read>
std::optional<std::vector<T>> TableReader::list(std::string_view key, Read read) {
  const TomlValue* found = required(key);
  if (!found) return std::nullopt;
  const TomlArray* array = found->array();
  if (!array) {
    record(found->position, words().wrong_type(name(key), TomlType::array, found->type()));
    return std::nullopt;
  }
  std::vector<T> result;
  for (std::size_t i = 0; i < array->values.size(); ++i)
    if (auto element = read(array->values[i], fmt::format("{}[{}]", name(key), i)))
      result.push_back(std::move(*element));
  return result.size() == array->values.size() ? std::optional(std::move(result)) : std::nullopt;
}

std::optional<std::vector<double>> TableReader::number_list(std::string_view key, const Range& range) {
  return list<double>(key,
                      [&](const TomlValue& value, const std::string& name) { return to_number(value, name, range); });
}

std::optional<std::vector<int>> TableReader::integer_list(std::string_view key, const Range& range) {
  return list<int>(key,
                   [&](const TomlValue& value, const std::string& name) { return to_integer(value, name, range); });
}

std::optional<std::vector<std::string>> TableReader::ascii_list(std::string_view key) {
  return list<std::string>(key,
                           [&](const TomlValue& value, const std::string& name) { return to_text(value, name, true); });
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, std::size_t count, const Range& range) {
  const TomlValue* found = required(key);
  if (!found) return std::nullopt;
  const TomlArray* array = found->array();
  if (array && array->values.size() == count) return number_list(key, range);
  record(found->position, words().not_numbers(name(key), count, *found));
  return std::nullopt;
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

std::optional<TableReader> TableReader::table(std::string_view key) {
  const TomlValue* found = value(key);
  if (!found) return std::nullopt;
  if (found->table()) return TableReader(*found, join(key), *findings_);
  record(found->position, words().no_table(path_, key, false, found->type()));
  return std::nullopt;
}

std::optional<TableReader> TableReader::required_table(std::string_view key) {
  return required(key) ? table(key) : std::nullopt;
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
  std::vector<TableReader> result;
  const TomlValue* found = value(key);
  if (!found) return result;
  const TomlArray* array = found->array();
  if (!array) {
    record(found->position, words().no_table(path_, key, true, found->type()));
    return result;
  }
  for (std::size_t i = 0; i < array->values.size(); ++i) {
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
  for (const auto& entry : table_.entries)
    if (!known_.contains(entry.key)) record(entry.key_position, words().unknown(path_, entry.key, absent));
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
