// A TOML file as a plain tree in which every value keeps its place, and a reader that collects every complaint.
// Hides the TOML library from the readers of machine files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath {

struct TomlEntry;

struct TomlValue {
  enum class Type { boolean, integer, real, text, array, table, date };
  Type type = Type::table;
  SourcePosition position;
  bool boolean = false;
  std::int64_t integer = 0;
  double real = 0.0;              ///< also set for integers
  std::string text;
  std::vector<TomlValue> items;   ///< of an array
  std::vector<TomlEntry> entries; ///< of a table, in the order of the file

  [[nodiscard]] const TomlEntry* find(std::string_view key) const;
};

struct TomlEntry {
  std::string key;
  SourcePosition key_position;
  TomlValue value;
};

/// Largest machine file that is opened.
inline constexpr std::size_t kMaxMachineFileBytes = 1u << 20;

/// The bytes of a file. Errors (kind file_access): missing, not a regular file, larger than kMaxMachineFileBytes, unreadable.
[[nodiscard]] Result<std::string> read_text_file(const std::string& path);

/// Parses TOML 1.0. Errors: the first syntax error with its place; NUL bytes and nesting deeper than 16 levels are refused.
[[nodiscard]] Result<TomlValue> parse_toml(std::string_view text, const std::string& file);

/// Reads the keys of one table. Every getter records a diagnostic when a key is missing, of the wrong type, not finite
/// or outside its range and then returns nothing; `refuse_unknown_keys` completes the reading of a table.
class TomlTableReader {
 public:
  /// @param path dotted name of the table, "" for the root; prefixes the keys in messages
  TomlTableReader(const TomlValue& table, std::string path, std::vector<Diagnostic>& errors)
      : table_(table), path_(std::move(path)), errors_(errors) {}

  struct Range {
    double low, high;          ///< both ends allowed
    const char* unit = "";     ///< printed after the limit
    bool above_low = false;    ///< the low end itself is refused
  };

  /// Above 0, up to `high`.
  [[nodiscard]] static Range positive(double high, const char* unit) { return {0.0, high, unit, true}; }

  [[nodiscard]] bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  /// Dotted name of a key of this table.
  [[nodiscard]] std::string name(std::string_view key) const;
  /// Where the value of a key stands; of the table when it is missing.
  [[nodiscard]] SourcePosition at(std::string_view key) const;

  std::optional<double> number(std::string_view key, const Range& range);
  std::optional<int> whole_number(std::string_view key, int low, int high);
  /// 1 or -1; 1 after an error.
  int sense(std::string_view key);
  std::optional<bool> boolean(std::string_view key);
  /// 1 to 120 printable ASCII characters when `ascii`, else any text without control characters.
  std::optional<std::string> text(std::string_view key, bool ascii = false);
  /// One of the given words.
  std::optional<std::string> word(std::string_view key, const std::vector<std::string>& allowed);
  std::optional<Vec3> vector(std::string_view key, double largest_mm);
  std::optional<std::vector<double>> numbers(std::string_view key, const Range& range);
  std::optional<std::vector<int>> whole_numbers(std::string_view key, int low, int high);
  std::optional<std::vector<std::string>> texts(std::string_view key);
  /// A table; its reader shares the list of errors.
  std::optional<TomlTableReader> table(std::string_view key);
  /// The raw value, marked as known; records an error when it is missing.
  const TomlValue* value(std::string_view key);
  /// Every entry of this table; marks all as known.
  const std::vector<TomlEntry>& entries();

  void refuse_unknown_keys();
  template <typename... Args>
  void refuse(SourcePosition position, fmt::format_string<Args...> format, Args&&... args) {
    errors_.push_back(fail_at(std::move(position), format, std::forward<Args>(args)...));
  }

 private:
  std::optional<double> number_in(const TomlValue& value, const std::string& name, const Range& range);
  std::optional<int> whole_in(const TomlValue& value, const std::string& name, int low, int high);
  std::optional<std::string> text_in(const TomlValue& value, const std::string& name, bool ascii);
  const TomlValue* array(std::string_view key);

  const TomlValue& table_;
  std::string path_;
  std::vector<Diagnostic>& errors_;
  std::vector<std::string> known_;
};

/// Into the order of the file.
void sort_by_position(std::vector<Diagnostic>& errors);

/// Dotted names of all values below a table, `schema`, `name`, `kind` and `assumed` of the root left out.
[[nodiscard]] std::vector<std::string> value_names(const TomlValue& root);

/// The `assumed` key of a machine file: true (every value), false (none) or a list of dotted names, each of a value or a
/// table of this file. Returns the names; records an error for a name that the file does not have.
[[nodiscard]] std::vector<std::string> read_assumed(TomlTableReader& root, const TomlValue& tree);

}  // namespace toothpath
