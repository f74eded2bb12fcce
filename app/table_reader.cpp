#include "app/table_reader.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toothpath {
namespace {

/// Number of insertions, deletions and replacements that turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

/// A key as it may be printed: cut to 60 characters, control characters replaced.
std::string shown(std::string_view key) {
  std::string text(key.substr(0, 60));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

}  // namespace

TableReader::TableReader(const DocumentTable& table, SourcePosition position, std::string path, ReaderFindings& findings)
    : table_(table), position_(std::move(position)), path_(std::move(path)), findings_(&findings) {
  findings.positions[path_] = position_;
  for (const auto& member : table.members) findings.positions[join(member.key)] = member.value.position;
}

std::string TableReader::join(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

std::string TableReader::title() const { return path_.empty() ? "the job" : "[" + path_ + "]"; }

SourcePosition TableReader::where(std::string_view key) const {
  const DocumentMember* member = table_.find(key);
  return member ? member->value.position : position_;
}

const DocumentMember* TableReader::require(std::string_view key) {
  known_.emplace(key);
  const DocumentMember* member = table_.find(key);
  if (!member) findings_->add(fail_at(position_, "{} lacks the key \"{}\"", title(), key));
  return member;
}

std::optional<double> TableReader::to_number(const DocumentValue& value, const std::string& name, const Range& range) {
  double number = 0;
  if (const auto* real = std::get_if<double>(&value.data)) number = *real;
  else if (const auto* whole = std::get_if<std::int64_t>(&value.data)) number = static_cast<double>(*whole);
  else {
    findings_->add(fail_at(value.position, "{} must be a number, not {}", name, value.type_name()));
    return std::nullopt;
  }
  if (!std::isfinite(number)) {
    findings_->add(fail_at(value.position, "{} = {} is not a finite number", name, number));
    return std::nullopt;
  }
  const bool low = range.open_low ? number <= range.low : number < range.low;
  const bool high = range.open_high ? number >= range.high : number > range.high;
  if (low || high) {
    const double limit = low ? range.low : range.high;
    const bool open = low ? range.open_low : range.open_high;
    const char* relation = low ? (open ? "is not above" : "is below") : (open ? "is not below" : "exceeds");
    findings_->add(fail_at(value.position, "{} = {}{} {} {}{}", name, number, range.unit, relation, limit, range.unit));
    return std::nullopt;
  }
  return number == 0 ? 0.0 : number;  // no negative zero further on
}

std::optional<double> TableReader::number(std::string_view key, const Range& range) {
  const DocumentMember* member = require(key);
  return member ? to_number(member->value, member->key, range) : std::nullopt;
}

std::optional<int> TableReader::integer(std::string_view key, const Range& range) {
  const DocumentMember* member = require(key);
  if (!member) return std::nullopt;
  if (!std::holds_alternative<std::int64_t>(member->value.data)) {
    refuse(key, "{} must be a whole number, not {}", key, member->value.type_name());
    return std::nullopt;
  }
  const auto number = to_number(member->value, member->key, range);
  return number ? std::optional<int>(static_cast<int>(*number)) : std::nullopt;
}

std::optional<std::string> TableReader::text(std::string_view key) {
  const DocumentMember* member = require(key);
  if (!member) return std::nullopt;
  const auto* text = std::get_if<std::string>(&member->value.data);
  if (!text) {
    refuse(key, "{} must be a string, not {}", key, member->value.type_name());
    return std::nullopt;
  }
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (text->empty()) refuse(key, "{} is empty", key);
  else if (text->size() > 255) refuse(key, "{} has {} bytes, which exceeds 255", key, text->size());
  else if (std::any_of(text->begin(), text->end(), is_control)) refuse(key, "{} contains a control character", key);
  else return *text;
  return std::nullopt;
}

std::optional<std::string> TableReader::word(std::string_view key, std::initializer_list<std::string_view> words) {
  auto text = this->text(key);
  if (!text || std::find(words.begin(), words.end(), *text) != words.end()) return text;
  std::string list;
  for (const auto word : words) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", word);
  refuse(key, "{} = \"{}\" is not one of {}", key, shown(*text), list);
  return std::nullopt;
}

std::optional<bool> TableReader::boolean(std::string_view key) {
  const DocumentMember* member = require(key);
  if (!member) return std::nullopt;
  if (const auto* value = std::get_if<bool>(&member->value.data)) return *value;
  refuse(key, "{} must be true or false, not {}", key, member->value.type_name());
  return std::nullopt;
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, std::size_t count, const Range& range) {
  const DocumentMember* member = require(key);
  if (!member) return std::nullopt;
  const DocumentArray* array = member->value.array();
  if (!array || array->values.size() != count) {
    refuse(key, "{} must be an array of {} numbers", key, count);
    return std::nullopt;
  }
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i)
    if (const auto number = to_number(array->values[i], fmt::format("{}[{}]", key, i), range)) result.push_back(*number);
  return result.size() == count ? std::optional(result) : std::nullopt;
}

const DocumentValue* TableReader::value(std::string_view key) {
  known_.emplace(key);
  const DocumentMember* member = table_.find(key);
  return member ? &member->value : nullptr;
}

std::optional<TableReader> TableReader::table(std::string_view key) {
  const DocumentValue* found = value(key);
  if (!found) return std::nullopt;
  if (const DocumentTable* table = found->table()) return TableReader(*table, found->position, join(key), *findings_);
  refuse(key, "{} must be one table [{}], not {}", key, join(key), found->type_name());
  return std::nullopt;
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
  std::vector<TableReader> result;
  const DocumentValue* found = value(key);
  if (!found) return result;
  const DocumentArray* array = found->array();
  if (!array) {
    refuse(key, "{} must be a list of tables [[{}]], not {}", key, join(key), found->type_name());
    return result;
  }
  for (std::size_t i = 0; i < array->values.size(); ++i) {
    const DocumentValue& element = array->values[i];
    const std::string path = fmt::format("{}[{}]", join(key), i);
    if (const DocumentTable* table = element.table()) result.emplace_back(*table, element.position, path, *findings_);
    else findings_->add(fail_at(element.position, "{} must be a table, not {}", path, element.type_name()));
  }
  return result;
}

void TableReader::finish() {
  for (const auto& member : table_.members) {
    if (known_.contains(member.key)) continue;
    std::string hint;
    std::size_t nearest = 3;
    for (const auto& candidate : known_) {
      if (member.key.size() > 60) break;
      const std::size_t distance = edit_distance(member.key, candidate);
      if (distance < nearest && distance < candidate.size()) {
        nearest = distance;
        hint = fmt::format("; did you mean \"{}\"?", candidate);
      }
    }
    findings_->add(fail_at(member.key_position, "unknown key \"{}\" in {}{}", shown(member.key), title(), hint));
  }
}

}  // namespace toothpath
