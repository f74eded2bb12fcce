// All controls. Lists of them (messages, file extensions, tests of the tables in docs) are made from here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "postproc/controls/control.h"

namespace toothpath::controls {

/// In the order of registry.inl.
[[nodiscard]] const std::vector<const Control*>& all();
/// By the name of a machine file, or one of its aliases; nullptr: there is none.
[[nodiscard]] const Control* find(std::string_view name);
/// Names of machine files, without aliases.
[[nodiscard]] std::vector<std::string> names();
/// `names()` as a message has them: "linuxcnc, fanuc".
[[nodiscard]] std::string list_of_names();
/// File extensions of programs, each once: ".ngc", ".nc" .. Whoever removes or refuses programs asks here.
[[nodiscard]] std::vector<std::string> program_extensions();
/// A probing program as text of a control. Refused: a control without such words.
[[nodiscard]] Result<std::string> probing_text(const probing::ProbeProgram& program, std::string_view dialect);

}  // namespace toothpath::controls
