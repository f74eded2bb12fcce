// A TOML text as a plain tree in which every key and value keeps its place. The only wrapper of the TOML library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath {

struct DocumentValue;

struct DocumentMember;

/// Members in the order of the file.
struct DocumentTable {
  std::vector<DocumentMember> members;
  [[nodiscard]] const DocumentMember* find(std::string_view key) const;
};

struct DocumentArray {
  std::vector<DocumentValue> values;
};

/// Dates and times: legal TOML, used by nothing here.
struct DocumentDate {};

struct DocumentValue {
  SourcePosition position;
  std::variant<bool, std::int64_t, double, std::string, DocumentDate, DocumentArray, DocumentTable> data;

  [[nodiscard]] const DocumentTable* table() const { return std::get_if<DocumentTable>(&data); }
  [[nodiscard]] const DocumentArray* array() const { return std::get_if<DocumentArray>(&data); }
  /// "a string", "a number", ...: for messages.
  [[nodiscard]] const char* type_name() const;
};

struct DocumentMember {
  std::string key;
  SourcePosition key_position;
  DocumentValue value;
};

/// Parses `text`. Refused with line and column: what is not TOML 1.0, multi-line strings, brackets or dotted keys nested
/// deeper than `max_nesting` (so that no file can exhaust the stack).
[[nodiscard]] Result<DocumentValue> parse_document(std::string_view text, const std::string& file, int max_nesting);

/// The bytes of a regular file of at most `max_bytes`. Directories, pipes and devices are refused without reading them.
/// A file that cannot be opened or read is `DiagnosticKind::file_access`, every other refusal `refused_input`.
[[nodiscard]] Result<std::string> read_regular_file(const std::string& path, std::size_t max_bytes);

}  // namespace toothpath
