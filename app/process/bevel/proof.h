// What a bevel gear adds to the proof of a program (program_proof.h): walls, root and ridges, blank, hub and shaft.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "app/process/load_judge.h"
#include "app/process/program_proof.h"
#include "cam/finger/check.h"
#include "cam/proof/limits.h"

namespace toothpath::bevel {

/// mm and rad: proven distance of a read-back motion from its straight line. Half of a face gear's: it counts in the
/// bound of the gouge and in that of the material left, which has 1.5 um above the chords; a face gear's left material
/// is measured and does not contain it.
inline constexpr double kFingerMotionTolerance = 5e-5;

/// Axes that change in blocks along the path; moves along the tool axis (engage, retract) are left out.
struct MovingAxes {
  std::array<char, 5> letter{};               ///< of every axis that moves in any of them, 0 of the others
  std::size_t simultaneous = 0;               ///< most axes that one block moves
  [[nodiscard]] std::string letters() const;  ///< "YC"
};

/// Azimuth of a tip, less that of the middle of tooth space 0 at its cone distance.
[[nodiscard]] double azimuth_from_space_0(const bevel_gear::BevelGear& gear, const Vec3& tip);

/// Everything that it is made of must outlive it.
class BevelGearCheck final : public process::GearCheck {
 public:
  BevelGearCheck(const job::Job& job, const machines::Machine& machine, const proof::ProofLimits& limits,
                 const bevel_gear::BevelGear& gear, const finger::FingerGougeCheck& check);

  [[nodiscard]] int teeth() const override;
  [[nodiscard]] double motion_tolerance() const override;
  [[nodiscard]] double pitches_from_space_0(const Vec3& tip) const override;
  [[nodiscard]] Status rapids_clear(const readback::OperationTrace& trace,
                                    const readback::NcControl& control) const override;
  [[nodiscard]] bool may_cut(const path::ToolMotion& motion) const override;
  [[nodiscard]] bool measures(int operation) const override;
  void meet(const readback::OperationTrace& trace, std::span<const path::ToolMotion> motions,
            const readback::NcControl& control) override;
  void judge(process::ProgramProof& program, app::StageClock& clock) override;
  /// What was met of a program that is not judged.
  void forget() { moving_ = {}; }

  process::PlanAnew plan_anew;       ///< what a text of others is held against
  finger::FingerCheckResult result;  ///< of the program judged last, for the ledger; its grids stand in the proof

 private:
  [[nodiscard]] process::LoadJudge load_judge() const;

  const job::Job& job_;
  const machines::Machine& machine_;
  proof::ProofLimits limits_;
  const bevel_gear::BevelGear& gear_;
  const finger::FingerGougeCheck& check_;
  MovingAxes moving_;  // of what was met since a program was judged
};

}  // namespace toothpath::bevel
