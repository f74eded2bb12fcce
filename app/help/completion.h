// Scripts that complete commands, options and values in the shells.
#pragma once

#include <string>

#include "app/help/command_tree.h"

namespace toothpath::help {

/// bash 4 or later: to be sourced, or to lie in share/bash-completion/completions.
[[nodiscard]] std::string bash_completion(const Program& program);

/// zsh 5: to be sourced, or to lie in a folder of $fpath as `_toothpath`.
[[nodiscard]] std::string zsh_completion(const Program& program);

/// fish 3: to be sourced, or to lie in share/fish/vendor_completions.d.
[[nodiscard]] std::string fish_completion(const Program& program);

/// Text in single quotes, as bash and zsh read it.
[[nodiscard]] std::string shell_quoted(const std::string& text);

}  // namespace toothpath::help
