// The control of a machine: what its file says, judged; its words with the machine's own digits and codes; its reader
// with the job's tools.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "machines/machine_file.h"
#include "postproc/controls/control.h"
#include "postproc/joints/setup.h"

namespace toothpath::controls {

/// What the control of a machine has against its file: a control that is not known, keys that it does not take, TCP,
/// vectors or rotaries that roll over without words for them. Every complaint, each with the place of its key.
[[nodiscard]] std::vector<Diagnostic> judge(const machines::Machine& machine);

/// A machine from its file or text, judged. Errors: those of machines/machine_file.h and of judge(), in the order of
/// the file.
[[nodiscard]] machines::MachineReading read_machine(const std::string& path);
[[nodiscard]] machines::MachineReading read_machine_of_text(std::string_view text, const std::string& file);

/// The words of the control that a machine file names, with the machine's own digits, TCP codes, smoothing and
/// coolants. Errors: the first of judge(); smoothing that is not stated whole.
[[nodiscard]] Result<text::NcDialect> dialect_of(const machines::Machine& machine);

/// Rotaries that do not count from 0 while the control calculates with them: which of its data must say so, a line
/// each, "axes.A.zero = 90 deg, ..". @param planes in tilted planes; else with the machine's TCP
[[nodiscard]] std::vector<std::string> trusted_zeros(const machines::Machine& machine, bool planes);

/// X Y Z and the rotaries in the machine's order; 0: no such axis.
[[nodiscard]] std::array<char, 5> axis_letters(const machines::Machine& machine);

/// Options of the axis program that follow from the words and the machine; the tolerances keep their defaults.
[[nodiscard]] joints::AxisOptions axis_options(const text::NcDialect& words, const machines::Machine& machine);

/// Reader of a machine with the job's tools and its one work offset. Errors: no such control, a tool number that occurs
/// twice.
[[nodiscard]] Result<readback::NcControl> control_of(const machines::Machine& machine, const joints::Setup& setup,
                                                     std::span<const tool::ToolAssembly> tools);

/// Nothing: the machine's control has this work offset. Else the ones that it has, as text: "G54 to G57 and G505 to
/// G599".
[[nodiscard]] std::optional<std::string> other_work_offsets(const machines::Machine& machine, std::string_view name);

}  // namespace toothpath::controls
