// The readers of the formats, and how a value becomes a key of a [[tool]].
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/tool_library/tool_library.h"

namespace toothpath::tool_library {

[[nodiscard]] Result<std::vector<LibraryTool>> read_linuxcnc_table(const std::string& text, const std::string& path);
[[nodiscard]] Result<std::vector<LibraryTool>> read_fusion_library(const std::string& text, const std::string& path);
[[nodiscard]] Result<std::vector<LibraryTool>> read_freecad_bit(const std::string& text, const std::string& path);
[[nodiscard]] Result<std::vector<LibraryTool>> read_freecad_library(const std::string& text, const std::string& path);

/// A JSON text whose outermost value is an object; refused with line and column.
[[nodiscard]] Result<nlohmann::json> parse_object(const std::string& text, const std::string& path);

/// Adds a key; the last one of a name holds.
template <typename Value>
void add_key(LibraryTool& tool, const char* key, Value value, const SourcePosition& at) {
  tool.keys.entries.push_back({key, at, {at, {std::move(value)}}});
}

/// The largest tool file that is read.
inline constexpr std::size_t kMostToolBytes = std::size_t{32} << 20;

}  // namespace toothpath::tool_library
