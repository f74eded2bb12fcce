// Comments that LinuxCNC executes, or that do something else than tell people.
#pragma once

#include "postproc/readback/acting_comment.h"

namespace toothpath::controls {

/// Looks at every place of the line where a comment may begin, also inside another one and in small letters: more than
/// the interpreter executes, never less. (ABORT, ..) is no such comment: the reader knows what it does.
[[nodiscard]] std::optional<readback::ActingComment> linuxcnc_acting_comment(std::string_view line);

}  // namespace toothpath::controls
