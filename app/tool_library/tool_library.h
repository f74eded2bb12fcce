// Tools out of a file that another program keeps: the tool table of LinuxCNC (.tbl), the tool library of Fusion
// (.json), tool bits and libraries of FreeCAD (.fctb, .fctl). What such a file says becomes keys of a [[tool]]; what it
// does not say is not invented.
#pragma once

#include <string>
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
};

/// The formats by their endings, for messages.
inline constexpr const char* kFormats = ".tbl (LinuxCNC), .json (Fusion), .fctb or .fctl (FreeCAD)";

/// All milling tools of a file in its order. Errors: an ending that is none of `kFormats`; a file that cannot be read
/// or is not of its format, with the line where it is known. Tools of kinds that no job has (drills, probes) are left
/// out, unless they are all.
[[nodiscard]] Result<std::vector<LibraryTool>> read_tool_library(const std::string& path);
/// The same of text; tool bits that a .fctl names are read beside `path` and in ../Bit.
[[nodiscard]] Result<std::vector<LibraryTool>> read_tool_library_text(const std::string& text, const std::string& path);

/// The one with a number; of a file with a single tool without a number that one. Errors: none has it (the numbers that
/// are there), two have it.
[[nodiscard]] Result<LibraryTool> tool_of_library(const std::vector<LibraryTool>& tools, int number);

}  // namespace toothpath::tool_library
