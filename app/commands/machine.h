// `toothpath machine show` and `toothpath machine test`: what a machine file says, and programs that prove it in air.
#pragma once

#include <optional>
#include <string>

#include "app/commands/command.h"

namespace toothpath::commands {

struct MachineRequest : CommonRequest {
  std::string machine_file;  ///< or the name of an installed machine
  std::string out_dir;
  std::optional<double> tool_length_mm;  ///< of `machine test`: gauge line to the tip of the test bar
};

/// Prints the machine of `request.machine_file` (a path, or the name of an installed machine): limits, chain, what a
/// positive command turns, every assumed value. With an output directory also machine.html and machine.svg (milling
/// machines).
[[nodiscard]] CommandOutcome show_machine(const MachineRequest& request);

/// Writes machine_test.* (NC text in the machine's dialect that moves the joints, TCP off: it proves the machine file),
/// of a machine with TCP machine_test_tcp.* too (the same stations with TCP on: it proves the data of the control),
/// machine_test.html (what the machinist does and must see at every station) and nothing else. The texts are read back
/// and proven before they are kept. `request.tool_length_mm`: of the test bar. Refused: gear shapers; machines without
/// rotary axes; no place near the table that the travels allow; a dialect without axes.
[[nodiscard]] CommandOutcome test_machine(const MachineRequest& request);

}  // namespace toothpath::commands
