// The bytes of a file that a user names: directories, pipes and devices are refused without reading them.
#pragma once

#include <string>

#include "geometry/base/result.h"

namespace toothpath::toml {

/// The bytes of a regular file of at most `max_bytes`.
/// A file that cannot be opened or read is `DiagnosticKind::file_access`, every other refusal `refused_input`.
[[nodiscard]] Result<std::string> read_regular_file(const std::string& path, std::size_t max_bytes);

}  // namespace toothpath::toml
