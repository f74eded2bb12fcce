// What control and words of a machine take of a job's tolerances before anything is planned: what is left for chords,
// and the least numbers that a program can keep. Shares: docs/proof.md, "What the gouge tolerance pays for".
#pragma once

#include <span>
#include <vector>

#include "app/job/job.h"
#include "cam/proof/limits.h"
#include "cam/proof/verification.h"
#include "machines/machine.h"

namespace toothpath::process {

/// Of the gouge tolerance that is planned for, what planners give to chords.
inline constexpr double kBallChords = 0.4, kFingerChords = 0.5;

/// All in mm.
struct Taken {
  double granted = 0;   ///< share of the gouge tolerance that the text grants the control, tip and axis
  double path_mm = 0;   ///< so far the control leaves the path by itself
  double words_mm = 0;  ///< the words X Y Z together: half a step of each
  double turns_mm = 0;  ///< the words of the rotaries, where they turn in a cut
  double step_mm = 0;   ///< of the words X Y Z
  double proof_mm = 0;  ///< what the proof counts beside its share of the tolerance: places between those it looks at
  double chords = kBallChords;

  [[nodiscard]] double of_gouge(double gouge_mm) const { return granted * gouge_mm + path_mm + words_mm + proof_mm; }
};

/// Of ball mills and sides. @param radius_mm  about the gear axis, for the rotaries
[[nodiscard]] Taken taken_by(const machines::Machine& machine, double radius_mm);

/// The gouge tolerance that plans are made for: that of the job, or less where control, words and proof need more of
/// it; at least a quarter.
[[nodiscard]] double planned_gouge(double gouge_mm, const Taken& taken);

/// The operations with chord tolerances that leave the words room in allowances of a few of their steps.
[[nodiscard]] std::vector<path::MillingOperation> with_room_for_words(std::vector<path::MillingOperation> operations,
                                                                      const Taken& taken);

/// Least gouge tolerance and allowance, to two digits, of which control, words, chords and proof together take no more
/// than there is.
[[nodiscard]] double least_gouge_tolerance(const Taken& taken);
[[nodiscard]] double least_allowance(const Taken& taken);

/// Refusals of numbers of which a program that was written falls short by no more than these parts, each at its key
/// with the least that works. Empty where any falls short by more, or none does.
/// @param gouge, excess  of its proof
[[nodiscard]] std::vector<Diagnostic> finer_than_the_program(const job::Job& job, const Taken& taken,
                                                             const proof::GougeResult& gouge,
                                                             std::span<const proof::ExcessResult> excess);

}  // namespace toothpath::process
