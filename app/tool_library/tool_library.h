// Tools out of a file that another program keeps: the tool table of LinuxCNC (.tbl), the tool library of Fusion
// (.json, .tools), tool bits and libraries of FreeCAD (.fctb, .fctl). What such a file says becomes keys of a [[tool]];
// what it does not say is not invented.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "machines/toml/toml_tree.h"

namespace toothpath::tool_library {

/// One tool as a file says it.
struct LibraryTool {
  int number = 0;        ///< T word; 0: the file gives none
  std::string name;      ///< for people
  toml::TomlTable keys;  ///< as a [[tool]] has them: mm, deg; each with its place in the file, where it is known
  std::vector<std::string> notes;  ///< what stands there and was not taken, and why
  bool takes_unit = false;         ///< lengths without a unit were read in that of `LibraryUnit`
  bool other_unit = false;         ///< lengths with a unit that is another than that of `LibraryUnit`
  bool unit_is_open = false;       ///< nobody says the unit of its lengths: read as mm
};

/// A tool of a kind that no job has: a drill, a probe.
struct OtherTool {
  int number = 0;    ///< T word; 0: the file gives none
  std::string name;  ///< for people
  std::string kind;  ///< in the words of the file
};

/// The unit that somebody says for lengths of which the file states none.
enum class LibraryUnit : std::uint8_t { none, mm, inch };
/// Of its words "mm" and "inch".
[[nodiscard]] LibraryUnit library_unit_of(std::string_view word);
/// What settles it, for refusals: the key of a [[tool]], and the option of `new`.
inline constexpr const char* kUnitKey = "say library_unit = \"mm\" or \"inch\" in the [[tool]] (new: --library-unit)";

/// The formats by their endings, for messages.
inline constexpr const char* kFormats = ".tbl (LinuxCNC), .json or .tools (Fusion), .fctb or .fctl (FreeCAD)";

/// All milling tools of a file in its order. Errors: an ending that is none of `kFormats`; a file that cannot be read
/// or is not of its format, with the line where it is known; a unit that is not said. A tool table has none: the
/// configurations beside it (.ini, LINEAR_UNITS) are asked, and what they or its numbers say of inches is refused until
/// somebody says the unit. Tools of kinds that no job has (drills, probes) are left out, unless they are all.
/// @param others  takes those that are left out; nullptr: nobody asks for them
[[nodiscard]] Result<std::vector<LibraryTool>> read_tool_library(const std::string& path,
                                                                 LibraryUnit unit = LibraryUnit::none,
                                                                 std::vector<OtherTool>* others = nullptr);
/// The same of text; tool bits that a .fctl names are read beside `path` and in ../Bit. Of a .tools, bytes.
[[nodiscard]] Result<std::vector<LibraryTool>> read_tool_library_text(const std::string& text, const std::string& path,
                                                                      LibraryUnit unit = LibraryUnit::none,
                                                                      std::vector<OtherTool>* others = nullptr);

/// The one with a number; of a file with a single tool without a number that one. Errors: none has it (the numbers that
/// are there), two have it.
[[nodiscard]] Result<LibraryTool> tool_of_library(const std::vector<LibraryTool>& tools, int number);

}  // namespace toothpath::tool_library
