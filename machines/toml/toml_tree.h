// A TOML text as a plain tree in which every key and value keeps its place. The only wrapper of the TOML library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::toml {

struct TomlValue;
struct TomlEntry;

/// Entries in the order of the file.
struct TomlTable {
  std::vector<TomlEntry> entries;
  [[nodiscard]] const TomlEntry* find(std::string_view key) const;
};

struct TomlArray {
  std::vector<TomlValue> values;
};

/// Dates and times: legal TOML, used by nothing here.
struct TomlDate {};

/// In the order of the alternatives of `TomlValue::data`.
enum class TomlType { boolean, integer, real, text, date, array, table };

struct TomlValue {
  SourcePosition position;
  std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlTable> data;

  [[nodiscard]] TomlType type() const { return static_cast<TomlType>(data.index()); }
  [[nodiscard]] const std::string* text() const { return std::get_if<std::string>(&data); }
  [[nodiscard]] const TomlTable* table() const { return std::get_if<TomlTable>(&data); }
  [[nodiscard]] const TomlArray* array() const { return std::get_if<TomlArray>(&data); }
  /// Of a real or a whole number.
  [[nodiscard]] std::optional<double> number() const;
};

struct TomlEntry {
  std::string key;
  SourcePosition key_position;
  TomlValue value;
};

/// What of TOML 1.0 a format takes.
struct TomlSyntax {
  int max_nesting = 16;  ///< brackets in brackets, parts of a key, and levels of tables and arrays, 1 or more; counted
                         ///< before anything is parsed, so that no file can exhaust the stack
  bool one_line_strings = false;  ///< strings that span lines are refused
};

/// Parses `text`; the root is a table. Errors, with line and column: the first place that is not TOML 1.0 or that
/// `syntax` does not take.
[[nodiscard]] Result<TomlValue> parse_toml(std::string_view text, const std::string& file, const TomlSyntax& syntax);

}  // namespace toothpath::toml
