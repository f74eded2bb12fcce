// What a face gear adds to the proof of a program (program_proof.h): gouge, shank and holder, rapids about the blank, the cut surface.
#pragma once

#include "app/process/program_proof.h"
#include "cam/analytic/cut_surface.h"
#include "cam/analytic/gouge_check.h"

namespace toothpath::process {

struct FaceGearProof : ProgramProof {
  proof::GougeResult gouge;
  analytic::CutSurface surface;  ///< what the program leaves on the finished surface
};

/// Everything that it is made of must outlive it.
class FaceGearCheck final : public GearCheck {
 public:
  /// @param grid  on which the cut surface is measured
  FaceGearCheck(const job::Job& job, const machines::Machine& machine, const analytic::GearDistance& part, const analytic::GougeCheck& check, const analytic::CutSurfaceOptions& grid = {});

  [[nodiscard]] int teeth() const override;
  [[nodiscard]] double motion_tolerance() const override;
  [[nodiscard]] Status rapids_clear(const readback::OperationTrace& trace, const readback::NcControl& control) const override;
  void meet(const ProgramProof& whole) override;
  void judge(ProgramProof& program, app::StageClock& clock) override;

  proof::GougeResult gouge;   ///< of the program judged last
  analytic::CutSurface surface;  ///< the same

 private:
  const job::Job& job_;
  const machines::Machine& machine_;
  const analytic::GearDistance& part_;
  const analytic::GougeCheck& check_;
  analytic::CutSurfaceOptions grid_;
};

/// prove_program with what this check found. Errors: the same.
[[nodiscard]] Result<FaceGearProof> prove_face_gear(const ProgramText& program, const AskedPaths& asked, FaceGearCheck& check, app::StageClock& clock);

/// The blank as a cylinder about the gear axis: from the underside of the mesh to the top of the stock.
[[nodiscard]] joints::ClearanceBody clearance_body(const face_gear::FaceGear& gear);

}  // namespace toothpath::process
