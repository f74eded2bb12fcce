// From what somebody wants to a job that can be tried: gear, limits, tools, place, text.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/proposal/gear_limits.h"
#include "app/proposal/job_text.h"
#include "geometry/bevel_gear/finger_cutter_design.h"
#include "machines/coolant.h"

namespace toothpath::proposal {

/// The machine of the wishes, of the kind that their route needs.
struct ChosenMachine {
  std::string name, file;
  std::optional<machines::Machine> mill;  ///< nothing: a gear shaper
  bool assumed = false;
  std::vector<std::string> assumed_keys;    ///< of its file, dotted names
  std::vector<machines::Coolant> coolants;  ///< that it can switch on
  std::optional<double> table_top_mm;       ///< Z of the face of the table, where its file says it
  std::string work_offset;                  ///< one that its control has
};
/// @param directory  of the job. Refused: what the file refuses, the other kind of machine.
[[nodiscard]] Expected<ChosenMachine, std::vector<Diagnostic>> choose_machine(const Wishes& wishes,
                                                                              const std::string& directory);

/// A gear that can be made, with what limits its tools.
struct ChosenGear {
  std::optional<face_gear::FaceGear> face;
  std::optional<bevel_gear::FingerCutterDesign> bevel;
  FaceFacts facts;                                                    ///< of a gear that ball mills make
  PartInSpace part;                                                   ///< with its places of the tool
  std::shared_ptr<const spiral_bevel::SpiralBevelParameters> spiral;  ///< where it is one
  double diameter_mm = 0;
  double module_mm = 0;  ///< of a gear whose numbers stand in a file
};
/// Refused: all that the gear refuses, each with the option that it belongs to.
[[nodiscard]] Expected<ChosenGear, std::vector<Diagnostic>> choose_gear(const Wishes& wishes);

/// Of the number that decides how large a ball reaches the root, and what a larger ball takes.
struct BallLimit {
  const char *option, *larger;
};
[[nodiscard]] BallLimit ball_limit(const ChosenGear& gear);

/// Ways to make the same gear that are worth a try, best first: `attempt` counts them.
inline constexpr int kAttempts = 4;
/// Refused: no tool of the shelf reaches the root or fits a space; a machine that is too small.
/// @param shelf  empty: standard sizes
[[nodiscard]] Result<Draft> draft_of(const std::string& name, const Wishes& wishes, const ChosenMachine& machine,
                                     const ChosenGear& gear, const Shelf& shelf, int attempt);

/// The least diameter [mm] with which the gear turns, as far as it is known; nothing: not known yet.
[[nodiscard]] std::optional<double> least_swing_mm(const Wishes& wishes);
/// Refused: a part that the machine does not turn, with the installed machines that do.
[[nodiscard]] Status check_swing(const ChosenMachine& machine, double diameter_mm);

/// "axes.A.point, axes.C.point, .. and 12 more".
[[nodiscard]] std::string assumed_words(const ChosenMachine& machine);

/// A limit that somebody choosing wants to see, and its value.
using Told = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] Told limits_of(const Wishes& wishes);
[[nodiscard]] Told swing_of(const ChosenMachine& machine, double diameter_mm);
[[nodiscard]] Told limits_of(const ChosenMachine& machine);
[[nodiscard]] Told limits_of(const ChosenGear& gear);
[[nodiscard]] Told limits_of(const Draft& draft, const ChosenMachine& machine, const ChosenGear& gear);

}  // namespace toothpath::proposal
