// The errors of a machine by name, each with its size, and what one sample draws of them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/studies/samples/counter.h"
#include "machines/machine.h"
#include "machines/real_machine.h"

namespace toothpath::errors {

enum class Kind {
  pivot,
  tilt,
  zero,
  scale,
  wave,
  square_xy,
  square_xz,
  square_yz,
  spindle_tilt,
  tool_length,
  tool_radius
};

/// One error. `size` is the standard deviation of a normal distribution: of every component where the error is a vector
/// across an axis (pivot, tilt: two), of the amplitude of a wave (its phase is uniform), of every tool by itself.
struct Error {
  Kind kind = Kind::pivot;
  std::size_t rotary = 0;  ///< of the chain, where the kind is one of a rotary axis
  std::string name;        ///< "C.pivot", "square.XY", "tool.length"
  std::string unit;        ///< "um", "urad", "urad/rad"
  double size = 0;
  std::string source;   ///< who says so: "assumed", "setup.pivot_error", "--error", ...
  std::string meaning;  ///< a few words
};

/// All errors that this machine and these tools can have. Left out: the zero and the scale of the rotary that indexes
/// the teeth (the blank has none yet, and a full turn closes); the radius where no tool is a ball end mill.
[[nodiscard]] std::vector<Error> errors_of(const machines::Machine& machine, const job::Job& job);

/// Replaces sizes by "NAME=SIZE"; 0 takes an error out. @param only  leaves out all that are not named
/// Refused (kind usage): an unknown name, with those that there are; a size that is no number of 0 to 10000; nothing
/// left.
[[nodiscard]] Status set_sizes(std::vector<Error>& errors, const std::vector<std::string>& given, bool only);

/// Errors as one machine has them, mm and rad.
struct Drawn {
  machines::MachineErrors machine;
  std::map<int, double> longer_mm, radius_mm;  ///< of tools, by T number: added to length and radius
  double magnitude =
      0;  ///< size of what was drawn in the unit of the error: of a vector its length, of tools the largest
};

/// What a sample draws: of `which` among the errors alone, or of all. Draws of an error do not depend on the others.
[[nodiscard]] Drawn draw(const std::vector<Error>& errors, std::optional<std::size_t> which,
                         const machines::KinematicChain& chain, const job::Job& job, const samples::Numbers& numbers);

/// The rotary of the table that turns the work about the gear axis; none: teeth are not turned copies on this machine.
[[nodiscard]] std::optional<std::size_t> index_rotary(const machines::KinematicChain& chain,
                                                      const joints::Setup& setup);

}  // namespace toothpath::errors
