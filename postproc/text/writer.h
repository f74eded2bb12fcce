// NC text of an axis program. What differs from control to control stands in `NcDialect`; the order of things (safe
// start, operations, teeth, end) is the same for all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "postproc/joints/program.h"
#include "postproc/text/dialect.h"
#include "postproc/text/stops.h"

namespace toothpath::text {

/// What stands in the comments at the top.
struct NcHeader {
  std::string job_name;  ///< made ASCII upper case; parentheses become brackets
  std::string job_hash;  ///< of the job file, given by the caller; may be empty
  std::string machine_name;
  std::vector<std::string> assumed;  ///< non-empty: a warning, keys of one table in one line
  int program_number = 1001;         ///< O word; the sub-programs have the numbers behind it
  std::string name_end;              ///< of a part's name, behind that of the job: "_2"
  double blend_mm =
      0.0003;  ///< how far the control may leave a corner: counts as deviation of the machine in every proof
  double blend_axis_deg =
      0.002;  ///< how far the control may turn a rotary off its way with TCP: counts as deviation of the tool axis
  bool contour_granted = false;  ///< `blend_mm` is a share of what the proof leaves: the control's own cycle for it
  machines::Coolant coolant = machines::Coolant::off;  ///< with every operation
  TextWishes wishes;
  std::optional<joints::GraphicsBlank> blank;  ///< for the graphics of the control, where it has words for it
  std::string no_blank;                        ///< why there is none; stands in the text in its place
};

struct NcText {
  std::string text;        ///< ASCII, LF, last line ended
  std::size_t blocks = 0;  ///< lines that are not comments, empty or %
  int numbers = 1;         ///< of programs that stand in the text: itself and its sub-programs
  std::uint64_t body_hash =
      0;  ///< FNV-1a over everything between the header comments and the last comment, without block numbers
};

/// By how much the text lets the control leave corners in this program, mm; what the reader of the dialect counts.
[[nodiscard]] double granted_blend_mm(const joints::AxisProgram& program, const NcDialect& dialect,
                                      const NcHeader& header);
/// The same of the tool axis where the text names a tolerance of the rotaries, rad. What a way at the corners (G641)
/// lets the axis do follows from the blocks and is counted by the reader alone.
[[nodiscard]] double granted_blend_rad(const joints::AxisProgram& program, const NcDialect& dialect,
                                       const NcHeader& header);

/// How the control joins the blocks of this text, for the times: into `corners` and `corner_tolerance_mm`.
void note_corners(joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header);

/// Prints the program. Errors: an F that the control cannot take, a line that is too long, a number out of its format,
/// joint blocks that turn on a control without inverse time, teeth as a loop on a control that has none, sub-programs
/// whose numbers are the builder's (from O8000 on).
[[nodiscard]] Result<NcText> write_nc(const joints::AxisProgram& program, const NcDialect& dialect,
                                      const NcHeader& header);

/// What a program is called on the control: its number, or the job's name as that of a file. Two jobs whose files are
/// stored under the name of the output would replace each other.
[[nodiscard]] std::string name_on_control(const NcDialect& dialect, const NcHeader& header);

/// Text as the name of a program: letters, digits and _, at most 24, beginning with a letter; `end` of it counts and
/// stays.
[[nodiscard]] std::string program_id(std::string_view text, std::string_view end = {});

}  // namespace toothpath::text
