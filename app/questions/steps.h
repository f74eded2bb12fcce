// The steps of `choose`.
#pragma once

#include <string>
#include <vector>

#include "app/questions/choose.h"

namespace toothpath::questions {

using DoneOrErrors = Expected<Ok, std::vector<Diagnostic>>;

[[nodiscard]] inline std::vector<Diagnostic> usage(std::string message) {
  return {Diagnostic{DiagnosticKind::usage, {}, std::move(message)}};
}

/// Gears of whose pair one is left-hand and the other right-hand.
[[nodiscard]] inline bool has_hand(proposal::Gear gear) {
  return gear == proposal::Gear::spiral_bevel || gear == proposal::Gear::bevel_herringbone;
}

/// Kind of gear, all of one that stands in a file, how it is cut and on which machine.
[[nodiscard]] Expected<proposal::Wishes, std::vector<Diagnostic>> kinds_wished(const Given& request,
                                                                               app::Dialog& dialog,
                                                                               proposal::Told& notes);
/// What machine and shop add: assumed values, quality, coolant, where the blank stands.
[[nodiscard]] DoneOrErrors wish_conditions(proposal::Wishes& wishes, const Given& request, app::Dialog& dialog,
                                           const proposal::ChosenMachine& machine);
/// All numbers of the gear, each with the limits that are known before it.
[[nodiscard]] DoneOrErrors wish_numbers(proposal::Wishes& wishes, const Given& request, app::Dialog& dialog,
                                        const proposal::ChosenMachine& machine);
/// The tools of --tools: of a job, or of a file of another program.
[[nodiscard]] DoneOrErrors choose_tools(const Given& request, app::Dialog& dialog, Choice& choice);

}  // namespace toothpath::questions
