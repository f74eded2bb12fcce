// What a face gear adds to the proof of a program (program_proof.h): gouge, shank and holder, rapids about the blank, the cut surface.
#pragma once

#include "app/commands/program_proof.h"
#include "cam/cut_surface.h"
#include "cam/gouge_check.h"

namespace toothpath {

struct FaceGearProof : ProgramProof {
  GougeResult gouge;
  CutSurface surface;  ///< what the program leaves on the finished surface
};

/// Everything that it is made of must outlive it.
class FaceGearCheck final : public GearCheck {
 public:
  /// @param grid  on which the cut surface is measured
  FaceGearCheck(const Job& job, const Machine& machine, const GearDistance& part, const GougeCheck& check, const CutSurfaceOptions& grid = {});

  [[nodiscard]] int teeth() const override;
  [[nodiscard]] double motion_tolerance() const override;
  [[nodiscard]] Status rapids_clear(const OperationTrace& trace, const NcControl& control) const override;
  void meet(const ProgramProof& whole) override;
  void judge(ProgramProof& program, StageClock& clock) override;

  GougeResult gouge;   ///< of the program judged last
  CutSurface surface;  ///< the same

 private:
  const Job& job_;
  const Machine& machine_;
  const GearDistance& part_;
  const GougeCheck& check_;
  CutSurfaceOptions grid_;
};

/// prove_program with what this check found. Errors: the same.
[[nodiscard]] Result<FaceGearProof> prove_face_gear(const ProgramText& program, const AskedPaths& asked, FaceGearCheck& check, StageClock& clock);

/// The blank as a cylinder about the gear axis: from the underside of the mesh to the top of the stock.
[[nodiscard]] ClearanceBody clearance_body(const FaceGear& gear);

}  // namespace toothpath
