// What the files of milling machines and of gear shapers share: their syntax, the words of their refusals, and the keys
// that both have.
#pragma once

#include "geometry/base/vec.h"
#include "machines/toml/table_reader.h"

namespace toothpath::machines {

/// Largest machine file that is opened.
inline constexpr std::size_t kMaxMachineFileBytes = 1u << 20;
/// Largest numbers in one.
inline constexpr double kLargestLength = 1e5;  ///< mm
inline constexpr double kLargestSpeed = 1e6;   ///< mm/min, deg/min, 1/min
inline constexpr double kLargestAngle = 1e7;   ///< deg: 27000 turns

/// The bytes of a machine file. Errors: missing, not a regular file, unreadable (kind file_access), larger than
/// kMaxMachineFileBytes (kind refused_input).
[[nodiscard]] Result<std::string> read_machine_bytes(const std::string& path);

/// Errors: the first syntax error with its place; NUL bytes and nesting deeper than 16 levels are refused.
[[nodiscard]] Result<toml::TomlValue> parse_machine_toml(std::string_view text, const std::string& file);

/// Keys with the dotted name of their table: "axes.A.sign".
[[nodiscard]] const toml::TableWords& machine_words();

/// 1 or -1; 1 where it is absent and after an error.
[[nodiscard]] int read_sense(toml::TableReader& table, std::string_view key,
                             toml::Presence presence = toml::Presence::required);

/// Three numbers, each at most `largest_mm` either way; `unit` as in toml::Range.
[[nodiscard]] std::optional<Vec3> read_vector(toml::TableReader& table, std::string_view key, double largest_mm,
                                              const char* unit);

/// `kind`, whatever it is.
[[nodiscard]] std::optional<std::string> read_kind(toml::TableReader& root);

/// The `assumed` key of a machine file: true (every value but `schema`, `name`, `kind` and itself), false (none) or a
/// list of dotted names, each of a value or a table of this file. Returns the names; records an error for a name that
/// the file does not have.
[[nodiscard]] std::vector<std::string> read_assumed(toml::TableReader& root, const toml::TomlValue& tree);

/// A machine, or everything that is wrong with its file in the order of the file.
/// @param Reading    has `machine`, an optional, and `errors`
/// @param read_tree  the machine in a tree, its complaints to the findings
template <typename Reading, typename ReadTree>
[[nodiscard]] Reading read_machine_as(std::string_view text, const std::string& file, ReadTree read_tree) {
  Reading reading;
  const auto tree = parse_machine_toml(text, file);
  if (!tree) {
    reading.errors.push_back(tree.error());
    return reading;
  }
  toml::ReaderFindings findings(machine_words());
  auto machine = read_tree(*tree, file, findings);
  reading.errors = std::move(findings.errors);
  toml::sort_by_position(reading.errors);
  if (reading.errors.empty()) reading.machine = std::move(machine);
  return reading;
}

/// The same from a file; `read_text` reads its bytes.
template <typename Reading, typename ReadText>
[[nodiscard]] Reading read_machine_file_as(const std::string& path, ReadText read_text) {
  const auto text = read_machine_bytes(path);
  if (text) return read_text(*text, path);
  Reading reading;
  reading.errors.push_back(text.error());
  return reading;
}

}  // namespace toothpath::machines
