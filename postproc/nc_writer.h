// NC text of an axis program. What differs from control to control stands in `NcDialect`, one file a dialect under
// postproc/dialects; the order of things (safe start, operations, teeth, end) is the same for all.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "postproc/axis_program.h"

namespace toothpath {

/// What a control wants to read.
struct NcDialect {
  std::string name;                ///< as in a machine file
  std::string extension;           ///< ".ngc"
  WordFormat format;
  bool point_always = false;       ///< "10." and never "10"
  bool o_words = false;            ///< o-sub, while, bracket expressions; else M98 sub-programs after M30
  bool percent_frame = false;      ///< % and O-number
  double max_inverse_time = 0;     ///< greatest F in G93; 0: no limit
  double min_feed_product = 0;     ///< G93 blocks with F * path below it are printed in G94 (mm/min); 0: none
  std::size_t max_line = 252;      ///< characters
  std::vector<std::string> safe_start;  ///< modal groups reset before anything moves
  bool blend = false;              ///< G64 P Q0 at the start, G61 at the end
  bool compensation_with_z = false;  ///< G43 H stands in a block with Z
  std::string program_end;         ///< "M2", "M30"
};

/// "linuxcnc" or "fanuc"; anything else is refused with the list.
[[nodiscard]] Result<NcDialect> find_dialect(std::string_view name);
[[nodiscard]] NcDialect linuxcnc_dialect();
[[nodiscard]] NcDialect fanuc_dialect();

/// The dialect that a machine file names, with the machine's own digits.
[[nodiscard]] Result<NcDialect> dialect_of(const Machine& machine);
/// Options of the axis program that follow from the dialect and the machine; the tolerances keep their defaults.
[[nodiscard]] AxisOptions axis_options(const NcDialect& dialect, const Machine& machine);

/// What stands in the comments at the top.
struct NcHeader {
  std::string job_name;      ///< made ASCII upper case; parentheses become brackets
  std::string job_hash;      ///< of the job file, given by the caller; may be empty
  std::string machine_name;
  std::vector<std::string> assumed;  ///< non-empty: a warning with each of them
  int program_number = 1001; ///< O word
  double blend_mm = 0.0003;  ///< P of G64: counts as deviation of the machine in every proof
  bool coolant = false;      ///< M8 with every operation
};

struct NcText {
  std::string text;             ///< ASCII, LF, last line ended
  std::size_t blocks = 0;       ///< lines that are not comments, empty or %
  std::uint64_t body_hash = 0;  ///< FNV-1a over everything between the header comments and the last comment
};

/// Prints the program. Errors: an F that the control cannot take, a line that is too long, a number out of its format.
[[nodiscard]] Result<NcText> write_nc(const AxisProgram& program, const NcDialect& dialect, const NcHeader& header);

/// Text that may stand in a comment of any dialect: printable ASCII, upper case, ( ) -> [ ], the rest -> '?'.
[[nodiscard]] std::string comment_text(std::string_view text);

}  // namespace toothpath
