#include "app/process/proof_limits.h"

#include <algorithm>

namespace toothpath::process {
namespace {

constexpr double kProofShare = 0.1;  // of the gouge tolerance

/// With a ball mill the last operation must be the finishing one; the walls of a finger mill are those of its last
/// finishing operation, whatever cuts the root afterwards.
std::optional<double> left_limit(const job::Job& job) {
  std::optional<double> left;
  for (const path::MillingOperation& o : job.operations) {
    if (o.type == path::OperationType::finger_finishing) left = o.chord_tolerance_mm + kFingerMargin;
    else if (o.type == path::OperationType::finishing) left = proof::most_left_mm(o);
    else if (o.type != path::OperationType::finger_roughing) left.reset();
  }
  return left;
}

}  // namespace

proof::ProofLimits proof_limits(const job::Job& job, double proof_mm) {
  proof::ProofLimits limits;
  limits.gouge_mm = job.verify.gouge_tolerance_mm;
  limits.proof_mm = std::min(proof_mm, kProofShare * limits.gouge_mm);
  if (job.verify.clearance_mm) limits.clearance_mm = *job.verify.clearance_mm;
  limits.left_mm = left_limit(job);
  return limits;
}

}  // namespace toothpath::process
