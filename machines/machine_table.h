// What the files of milling machines and of gear shapers share: their syntax, the words of their refusals, and the keys that
// both have.
#pragma once

#include "geometry/base/vec.h"
#include "machines/toml/table_reader.h"

namespace toothpath {

/// Largest machine file that is opened.
inline constexpr std::size_t kMaxMachineFileBytes = 1u << 20;

/// The bytes of a machine file. Errors (kind file_access): missing, not a regular file, larger than kMaxMachineFileBytes, unreadable.
[[nodiscard]] Result<std::string> read_machine_bytes(const std::string& path);

/// Errors: the first syntax error with its place; NUL bytes and nesting deeper than 16 levels are refused.
[[nodiscard]] Result<TomlValue> parse_machine_toml(std::string_view text, const std::string& file);

/// Keys with the dotted name of their table: "axes.A.sign".
[[nodiscard]] const TableWords& machine_words();

/// 1 or -1; 1 after an error.
[[nodiscard]] int read_sense(TableReader& table, std::string_view key);

/// Three numbers, each at most `largest_mm` either way.
[[nodiscard]] std::optional<Vec3> read_vector(TableReader& table, std::string_view key, double largest_mm);

/// `kind`, whatever it is.
[[nodiscard]] std::optional<std::string> read_kind(TableReader& root);

/// The `assumed` key of a machine file: true (every value but `schema`, `name`, `kind` and itself), false (none) or a list of
/// dotted names, each of a value or a table of this file. Returns the names; records an error for a name that the file does not have.
[[nodiscard]] std::vector<std::string> read_assumed(TableReader& root, const TomlValue& tree);

}  // namespace toothpath
