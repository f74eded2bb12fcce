#pragma once

#include <string>
#include <string_view>

#include "postproc/readback/reader.h"

namespace toothpath::controls {

/// Executes Heidenhain plain text, the subset that we write; everything else is refused where it stands.
[[nodiscard]] Status execute_heidenhain(std::string_view text, const std::string& file,
                                        const readback::NcControl& control, const readback::MoveSink& sink);

}  // namespace toothpath::controls
