#include "app/process/least_values.h"

#include <algorithm>
#include <cmath>

#include "app/process/gear_of_job.h"
#include "cam/path/asked_stock.h"
#include "geometry/base/angle.h"
#include "geometry/base/refusals.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::process {
namespace {

// Of the gouge tolerance.
constexpr double kGranted = 0.2;     // to the control, where the text says a tolerance: 0.15, and the axis
constexpr double kProof = 0.1;       // for the proof
constexpr double kUncounted = 0.05;  // for what nobody counted
constexpr double kLeastPlanned = 0.25;

// Of an allowance.
constexpr double kStockChords = 0.15, kLeastStockChords = 0.02;
constexpr double kFewSteps = 0.1;  // words that take more of it leave less to the chords
constexpr double kPlacing = 0.6;   // of a chord tolerance: what points are placed by

constexpr double kStepUp = 1.02;  // from one number that is tried to the next

/// Sag of chords in an allowance.
double stock_chords(double allowance_mm, const Taken& taken) {
  if (taken.words_mm <= kFewSteps * allowance_mm) return kStockChords * allowance_mm;
  return std::clamp((1 - path::kAskedStock) * allowance_mm - taken.words_mm - taken.turns_mm,
                    kLeastStockChords * allowance_mm, kStockChords * allowance_mm);
}

}  // namespace

Taken taken_by(const machines::Machine& machine, double radius_mm) {
  Taken taken;
  const auto dialect = controls::dialect_of(machine);
  if (!dialect) return taken;
  if (dialect->blend) taken.granted = kGranted;
  else taken.path_mm = std::max({dialect->exact_path_mm, dialect->corner_mm, dialect->smoothing_mm});
  taken.step_mm = std::pow(10.0, -dialect->format.linear_decimals);
  taken.words_mm = 0.5 * std::sqrt(3.0) * taken.step_mm;
  taken.turns_mm = radians(std::pow(10.0, -dialect->format.rotary_decimals)) * radius_mm;  // half a step of two
  return taken;
}

double planned_gouge(double gouge_mm, const Taken& taken) {
  const double room = (1 - kProof - kUncounted) * gouge_mm - taken.of_gouge(gouge_mm);
  return std::clamp(room / taken.chords, kLeastPlanned * gouge_mm, gouge_mm);
}

std::vector<path::MillingOperation> with_room_for_words(std::vector<path::MillingOperation> operations,
                                                        const Taken& taken) {
  for (path::MillingOperation& o : operations)
    if (o.allowance_mm > 0 && taken.words_mm > kFewSteps * o.allowance_mm)
      o.chord_tolerance_mm = std::min(o.chord_tolerance_mm, stock_chords(o.allowance_mm, taken) / kPlacing);
  return operations;
}

double least_gouge_tolerance(const Taken& taken) {
  return told_that_does(taken.path_mm + taken.words_mm, kStepUp, INFINITY, [&](double mm) {
    return taken.of_gouge(mm) + taken.turns_mm + taken.chords * planned_gouge(mm, taken) <= (1 - kProof) * mm;
  });
}

double least_allowance(const Taken& taken) {
  return told_that_does(taken.words_mm, kStepUp, INFINITY, [&](double mm) {
    return taken.words_mm + taken.turns_mm + stock_chords(mm, taken) <= (1 - path::kAskedStock) * mm;
  });
}

std::vector<Diagnostic> finer_than_the_program(const job::Job& job, const Taken& taken, const proof::GougeResult& gouge,
                                               std::span<const proof::ExcessResult> excess) {
  std::vector<Diagnostic> out;
  const double asked = job.verify.gouge_tolerance_mm;
  if (gouge.bound_mm > asked) {
    const double least = least_gouge_tolerance(taken);
    if (!(gouge.bound_mm <= least && asked < least)) return {};
    out.push_back(located(
        job, "verify.gouge_tolerance",
        fail("gouge_tolerance = {:g} mm: a program of this machine is proven to keep {:.2g} mm, for its control leaves "
             "the path by up to {:.2g} mm and words are up to {:.2g} mm off; {:g} mm or more does, or {}",
             asked, gouge.bound_mm, taken.path_mm + taken.granted * asked, taken.words_mm + taken.turns_mm, least,
             taken.path_mm > taken.words_mm
                 ? "a smaller post.corner_tolerance (or post.smoothing_tolerance) of the machine file, where its "
                   "control keeps it"
                 : "finer increments (post.linear_decimals), where the control takes them")));
  }
  const double least = least_allowance(taken);
  for (const proof::ExcessResult& after : excess) {
    const auto n = std::size_t(after.operation);
    const double allowance = job.operations[n].allowance_mm, must_stay = path::kAskedStock * allowance;
    if (allowance == 0 || after.points == 0 || after.min_mm >= must_stay) continue;
    if (allowance >= least) return {};
    out.push_back(located(
        job, fmt::format("operation[{}].allowance", n),
        fail("allowance = {:g} mm: a program of this machine leaves {:.2g} mm at some places, below {:.2g} mm ({:g} of "
             "it), for words and chords take up to {:.2g} mm; {:g} mm or more does, or 0, or finer increments "
             "(post.linear_decimals), where the control takes them",
             allowance, after.min_mm, must_stay, path::kAskedStock,
             taken.words_mm + taken.turns_mm + stock_chords(allowance, taken), least)));
  }
  return out;
}

}  // namespace toothpath::process
