// The words and the language of Fanuc, from which compatible controls are made.
#pragma once

#include "postproc/controls/control.h"
#include "postproc/readback/iso/interpreter.h"

namespace toothpath::controls {

[[nodiscard]] text::NcDialect fanuc_words();
[[nodiscard]] iso::IsoLanguage fanuc_language();

/// ; is the end of a block on these controls: what stands behind it in a line is the next block, and no comment. % is
/// the end of the text, in a comment too.
[[nodiscard]] std::optional<readback::ActingComment> fanuc_acting_comment(std::string_view line);

/// G54 to G59 and G54.1 P1 to P300.
[[nodiscard]] WorkOffsets fanuc_offsets();

}  // namespace toothpath::controls
