// The commands as the option parser holds them, as plain data.
#pragma once

#include <string>

#include "app/help/command_tree.h"

namespace CLI {
class App;
}

namespace toothpath {

/// All commands and options that the help shows; hidden ones (of group "") are left out.
[[nodiscard]] help::Program describe_program(const CLI::App& app, const std::string& version);

}  // namespace toothpath
