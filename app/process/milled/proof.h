// What a gear that is milled with ball mills adds to the proof of a program (program_proof.h): gouge, shank and holder,
// rapids about the blank, the cut surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/process/load_judge.h"
#include "app/process/milled/body.h"
#include "app/process/program_proof.h"
#include "cam/analytic/gouge_check.h"
#include "cam/cut/cut_surface.h"
#include "cam/proof/limits.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::milled {

/// Everything that it is made of must outlive it.
class MilledCheck final : public process::GearCheck {
 public:
  /// @param grid  on which the cut surface is measured
  MilledCheck(const job::Job& job, const machines::Machine& machine, const proof::ProofLimits& limits,
              const analytic::GearDistance& part, const GearBody& body, const analytic::GougeCheck& check,
              const cut::CutSurfaceOptions& grid = {});

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

  /// Of the program judged last, for the ledger; its grids stand in the proof. Of the first tooth, or of one that was
  /// measured by itself and keeps more.
  cut::CutSurface surface;
  process::PlanAnew plan_anew;         ///< what a text of others is held against
  std::vector<std::string> shortened;  ///< passes that end before their flank does: told beside what they leave

 private:
  class OtherTeeth;
  [[nodiscard]] const tool::ProofTool& tool_of(int operation) const;
  void judge_unlike(process::ProgramProof& program, const OtherTeeth& others);
  [[nodiscard]] const cut::CutSurface& measured(const std::vector<path::ToolMotion>& firsts, double watch_mm);
  [[nodiscard]] process::LoadJudge load_judge() const;

  const job::Job& job_;
  const machines::Machine& machine_;
  proof::ProofLimits limits_;
  const analytic::GearDistance& part_;
  const GearBody& body_;
  const analytic::GougeCheck& check_;
  std::vector<tool::ProofTool> tools_;  // of the job
  std::string into_web_;                // what was met first that comes too low; empty: nothing does
  cut::SurfaceMeter meter_;
  /// Of the program measured last: one that goes the same ways leaves the same.
  struct Measured {
    std::vector<path::ToolMotion> motions;
    double watch_mm = 0;
    cut::CutSurface surface;
  };
  std::optional<Measured> last_;
};

}  // namespace toothpath::milled
