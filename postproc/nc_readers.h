// One reader a family of dialects. None of them shares code with a writer; each refuses what is not in its subset, with line and
// column.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "postproc/nc_reader.h"

namespace toothpath {

using MoveSink = std::function<void(const ExecutedMove&)>;

/// Joints inside a block whose tip goes straight, every half degree of the rotaries.
void follow_tip(const ExecutedMove& from, const ExecutedMove& to, const NcControl& control, const KinematicChain& chain,
                const std::function<void(const std::array<double, 5>&)>& sink);

/// LinuxCNC (o-words, bracket expressions), Fanuc and Mitsubishi (M98, a point in every number).
[[nodiscard]] Status execute_iso(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink);

[[nodiscard]] Status execute_siemens(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink);
[[nodiscard]] Status execute_heidenhain(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink);
[[nodiscard]] Status execute_apt(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink);

}  // namespace toothpath
