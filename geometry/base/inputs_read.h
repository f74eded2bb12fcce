// Which files this process has read as inputs, through whatever key or option: no output takes the place of one.
#pragma once

#include <string>
#include <vector>

namespace toothpath {

/// To be called by whatever reads a file that a user names, before it reads.
void note_input(const std::string& path);

/// Names of the inputs that this process has read, each once, in order.
[[nodiscard]] std::vector<std::string> inputs_read();
/// Where a process runs one command after the other: what follows has read none yet.
void forget_inputs_read();

}  // namespace toothpath
