// The bytes of a file that a user names: directories, pipes and devices are refused without reading them.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "geometry/base/inputs_read.h"
#include "geometry/base/result.h"

namespace toothpath::toml {

/// The bytes of a regular file of at most `max_bytes`.
/// A file that cannot be opened or read is `DiagnosticKind::file_access`, every other refusal `refused_input`.
[[nodiscard]] Result<std::string> read_regular_file(const std::string& path, std::size_t max_bytes);

/// The same a block at a time, in order, with a fixed amount of memory. Errors: those of `take`, too.
[[nodiscard]] Status for_each_block(const std::string& path, const std::function<Status(std::string_view)>& take);

/// Both of an open file, from where it stands; `path` is for the messages.
[[nodiscard]] Result<std::string> read_regular_file(int descriptor, const std::string& path, std::size_t max_bytes);
[[nodiscard]] Status for_each_block(int descriptor, const std::string& path,
                                    const std::function<Status(std::string_view)>& take);

/// The bytes of an input of the command; its name is kept (note_input()), so that no output takes the place of the
/// file.
[[nodiscard]] Result<std::string> read_input_file(const std::string& path, std::size_t max_bytes);

}  // namespace toothpath::toml
