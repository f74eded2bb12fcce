// A tool of a library before it stands in a job: what the library and somebody say of it together, and what a [[tool]]
// still lacks. Ranges and refusals are those of the job's own reader.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/tool_library/tool_library.h"
#include "cam/tool/assembly.h"
#include "machines/toml/key_notes.h"

namespace toothpath::job {

/// A key that is required and not there.
struct MissingKey {
  std::string key;
  toml::ValueShape shape;
};

struct WrongKey {
  std::string key;  ///< empty: no single one
  std::string message;
};

struct LibraryToolReading {
  tool::ToolAssembly tool;          ///< whole where nothing is missing and nothing wrong
  std::vector<MissingKey> missing;  ///< in the order of the reader; where `type` is among them, more may follow from it
  std::vector<WrongKey> wrong;
};

/// @param said  keys of a [[tool]] that hold instead of the library's, or beside them
[[nodiscard]] LibraryToolReading read_library_tool(const tool_library::LibraryTool& known, const toml::TomlTable& said);

/// `key = value, key = value` as an inline table has them: keys of a [[tool]]. Refused (kind usage): what is no TOML.
[[nodiscard]] Result<toml::TomlTable> parse_tool_keys(std::string_view text);
/// What stands behind `key =` in a job; of a text the quotes may be left out.
[[nodiscard]] Result<toml::TomlValue> parse_tool_value(const toml::ValueShape& shape, std::string_view text);

/// "above 0 to 2000 mm", "one of a, b": what a value may be, for people.
[[nodiscard]] std::string shape_text(const toml::ValueShape& shape);

}  // namespace toothpath::job
