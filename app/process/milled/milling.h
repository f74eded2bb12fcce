// A gear that is milled with ball mills, bull noses and the sides of mills: from its operations to checked paths, and
// from the motions of a program to a verdict, whatever the gear.
#pragma once

#include <vector>

#include "app/process/gear_process.h"
#include "app/process/milled/proof.h"
#include "cam/analytic/gear_distance.h"
#include "cam/analytic/gouge_check.h"
#include "cam/plan/milling.h"

namespace toothpath::milled {

class Milling : public process::GearMilling {
 public:
  /// Job and machine must outlive it. @param part  answers up to ball::reach_of the tools
  /// @param modified  of the flanks: a ball that does not fit their hollows is refused
  Milling(const job::Job& job, const machines::Machine& machine, analytic::GearDistance part, GearBody body,
          const proof::ProofLimits& limits, const process::FlankGrid& grid,
          const std::optional<report::ModifiedFlanks>& modified);
  Milling(const Milling&) = delete;
  Milling& operator=(const Milling&) = delete;

  [[nodiscard]] Status plan(app::StageClock& clock, app::Progress& progress) override;
  [[nodiscard]] std::vector<const path::ClPath*> paths() const override;
  [[nodiscard]] std::vector<proof::DirectionChoice> directions() const override { return plan_.directions; }
  [[nodiscard]] std::vector<report::PassReport> passes() const override;
  [[nodiscard]] std::vector<report::FlankWaysReport> flank_ways() const override;
  [[nodiscard]] std::vector<report::EngagementReport> engagement() const override;
  [[nodiscard]] std::vector<std::string> advice() const override;
  [[nodiscard]] Result<proof::CheckedClPath> approve(const path::ClPath& path) const override {
    return gouge_.check_path(path);
  }
  [[nodiscard]] path::OperationType roughing() const override { return path::OperationType::roughing; }
  [[nodiscard]] rest::Excess roughed() const override;
  [[nodiscard]] process::GearCheck& check() override { return check_; }
  [[nodiscard]] std::vector<proof::LedgerEntry> ledger(const joints::AxisProgram& program,
                                                       const process::ProgramProof& proof,
                                                       double blend_mm) const override;
  [[nodiscard]] sheet::OtherSurface beside_the_grid() const override { return {}; }

 private:
  [[nodiscard]] std::optional<Diagnostic> ball_in_hollow() const;

  const job::Job& job_;
  std::vector<report::ModifiedFlanks::Zone> modified_;
  proof::ProofLimits limits_;
  plan::Options options_;
  std::vector<path::MillingOperation> planned_operations_;  ///< the job's, with room for the words
  analytic::GearDistance part_;
  GearBody body_;
  analytic::GougeCheck gouge_;
  MilledCheck check_;
  plan::MillingPlan plan_;
};

}  // namespace toothpath::milled
