// The controls of gear shapers. One is an object: its name, what its machine files say, its words and its reader. The
// list of them is controls/registry.inl, a line each; whoever must know all of them asks here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "machines/shaper_machine.h"
#include "postproc/shaper/gearbox_reader.h"
#include "postproc/shaper/setup.h"

namespace toothpath::shaper {

struct ShaperControl {
  machines::ShaperDialect dialect;  ///< its name in machine files, and what these say of the gears
  std::string extension;            ///< of programs: ".ngc"
  std::string coupling_words;       ///< as the sheet names them; empty: change gears
  /// Text of the program, ASCII, LF. Same set-up, same bytes.
  std::string (*program)(const ShaperSetup& setup) = nullptr;
  /// Can it hold N_s/N_2 exactly? Refused with value and limit. Null: any ratio of whole numbers.
  Status (*accepts)(const machines::ShaperMachine& machine, int cutter_teeth, int work_teeth) = nullptr;
  /// What a program makes the machine do; any text gives a reading. Null: every stroke is written out, nothing is
  /// coupled.
  GearboxReading (*read)(std::string_view text, const GearboxWords& words) = nullptr;
};

/// In the order of registry.inl.
[[nodiscard]] const std::vector<ShaperControl>& shaper_controls();
/// The control of a machine that was read here. Precondition: its dialect is one of the list.
[[nodiscard]] const ShaperControl& shaper_control(const machines::ShaperMachine& machine);

/// A shaper from its file or text, with a control of the list. Errors: those of machines/shaper_machine.h.
[[nodiscard]] machines::ShaperMachineReading read_shaper_machine(const std::string& path);
[[nodiscard]] machines::ShaperMachineReading read_shaper_machine_of_text(std::string_view text,
                                                                         const std::string& file);

/// The program of a set-up in the words of its machine's control.
[[nodiscard]] std::string shaper_program(const ShaperSetup& setup);

}  // namespace toothpath::shaper
