// The readers of the formats, and how a value becomes a key of a [[tool]].
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/tool_library/tool_library.h"

namespace toothpath::tool_library {

[[nodiscard]] Result<std::vector<LibraryTool>> read_linuxcnc_table(const std::string& text, const std::string& path,
                                                                   LibraryUnit unit);
[[nodiscard]] Result<std::vector<LibraryTool>> read_fusion_library(const std::string& text, const std::string& path,
                                                                   LibraryUnit unit, std::vector<OtherTool>* others);
[[nodiscard]] Result<std::vector<LibraryTool>> read_freecad_bit(const std::string& text, const std::string& path,
                                                                LibraryUnit unit);
[[nodiscard]] Result<std::vector<LibraryTool>> read_freecad_library(const std::string& text, const std::string& path,
                                                                    LibraryUnit unit, std::vector<OtherTool>* others);

/// Millimetres of a unit that somebody says; nothing where nobody does.
[[nodiscard]] std::optional<double> mm_of(LibraryUnit unit);

/// The unit of a length in a file: what the file states, else what somebody says. Notes in the tool which of them it
/// was. Nothing: neither is there.
[[nodiscard]] std::optional<double> unit_of_length(std::optional<double> stated_mm, LibraryUnit said,
                                                   LibraryTool& tool);

/// "6.000 mm", "0,8 mm", "1/4 in", "1' 2 1/2\"": a length in mm. @param bare  of a number without a unit
[[nodiscard]] std::optional<double> read_quantity(std::string_view text, std::optional<double> bare);
/// "10.00 deg", with the sign of degrees or in rad too: an angle in degrees; nothing without a unit.
[[nodiscard]] std::optional<double> read_angle_deg(std::string_view text);

/// The bytes of the first entry of a zip archive whose name ends with `ending`. Refused: no such archive or entry, an
/// entry that is packed in another way than by deflate, one that unpacks to more than `kMostToolBytes`.
[[nodiscard]] Result<std::string> unzipped(const std::string& bytes, std::string_view ending, const std::string& path);

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
