// A TOML text as a plain tree in which every key and value keeps its place. The only wrapper of the TOML library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath {

struct TomlValue;

struct TomlMember;

/// Members in the order of the file.
struct TomlTable {
  std::vector<TomlMember> members;
  [[nodiscard]] const TomlMember* find(std::string_view key) const;
};

struct TomlArray {
  std::vector<TomlValue> values;
};

/// Dates and times: legal TOML, used by nothing here.
struct TomlDate {};

struct TomlValue {
  SourcePosition position;
  std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlTable> data;

  [[nodiscard]] const TomlTable* table() const { return std::get_if<TomlTable>(&data); }
  [[nodiscard]] const TomlArray* array() const { return std::get_if<TomlArray>(&data); }
  /// "a string", "a number", ...: for messages.
  [[nodiscard]] const char* type_name() const;
};

struct TomlMember {
  std::string key;
  SourcePosition key_position;
  TomlValue value;
};

/// Parses `text`. Refused with line and column: what is not TOML 1.0, multi-line strings, brackets or dotted keys nested
/// deeper than `max_nesting` (so that no file can exhaust the stack).
[[nodiscard]] Result<TomlValue> parse_toml(std::string_view text, const std::string& file, int max_nesting);

/// The bytes of a regular file of at most `max_bytes`. Directories, pipes and devices are refused without reading them.
/// A file that cannot be opened or read is `DiagnosticKind::file_access`, every other refusal `refused_input`.
[[nodiscard]] Result<std::string> read_text_file(const std::string& path, std::size_t max_bytes);

}  // namespace toothpath
