// What a bevel gear adds to the proof of a program (program_proof.h): walls, root and ridges, blank, hub and shaft.
#pragma once

#include <string>
#include <vector>

#include "app/process/program_proof.h"
#include "app/report/run_report.h"
#include "cam/finger/check.h"

namespace toothpath::process {

/// Axes that change in blocks along the path; moves along the tool axis (engage, retract) are left out.
struct MovingAxes {
  std::string letters;           ///< every axis that moves in any of them: "YC"
  std::size_t simultaneous = 0;  ///< most axes that one block moves
};

struct BevelProof : ProgramProof {
  finger::FingerCheckResult result;
  MovingAxes moving;
};

/// Everything that it is made of must outlive it.
class BevelGearCheck final : public GearCheck {
 public:
  BevelGearCheck(const job::Job& job, const machines::Machine& machine, const bevel_gear::BevelGear& gear, const finger::FingerGougeCheck& check);

  [[nodiscard]] int teeth() const override;
  [[nodiscard]] double motion_tolerance() const override;
  [[nodiscard]] Status rapids_clear(const readback::OperationTrace& trace, const readback::NcControl& control) const override;
  void meet(const ProgramProof& whole) override;
  void judge(ProgramProof& program, app::StageClock& clock) override;

  finger::FingerCheckResult result;  ///< of the program judged last
  MovingAxes moving;         ///< the same

 private:
  const job::Job& job_;
  const machines::Machine& machine_;
  const bevel_gear::BevelGear& gear_;
  const finger::FingerGougeCheck& check_;
};

/// prove_program with what this check found. Errors: the same.
[[nodiscard]] Result<BevelProof> prove_bevel_gear(const ProgramText& program, const AskedPaths& asked, BevelGearCheck& check, app::StageClock& clock);

/// Tolerances of the proof that a job asks for.
[[nodiscard]] Tolerances proof_tolerances(const job::Job& job);

/// One direction an operation and half: the angle of the axis, and which axes were seen to move.
[[nodiscard]] std::vector<proof::DirectionChoice> directions_of(const bevel_gear::BevelGear& gear, const job::Job& job, const BevelProof& proof);

}  // namespace toothpath::process
