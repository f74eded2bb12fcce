// What a program leaves on a flank when the machine is not what its file says: the joints of the moves go through the
// true chain, and the gear's own proof judges the motions.
#pragma once

#include <memory>
#include <vector>

#include "app/process/flow/stages.h"
#include "app/studies/errors/error_list.h"

namespace toothpath::errors {

/// Of one tooth space, um. Left and deepest: over the points of the flanks that the finishing tool reaches.
struct Cost {
  double shift_um = 0;    ///< greatest change of a point of the flanks against the nominal machine
  double rms_um = 0;      ///< of that change over all points
  double deepest_um = 0;  ///< deepest cut into a flank, > 0; negative: the least that stands everywhere
  double left_um = 0;     ///< the most that stands on a flank
  double gouge_um = 0, gouge_bound_um = 0;  ///< as the proof says, found and proven
  bool within = false;                      ///< the proof has no reason against it: the limits of the job are kept
};

class RealFlanks {
 public:
  /// @param run  with the text of its program; must outlive this
  /// Errors: what the reader refuses in the text.
  [[nodiscard]] static Result<std::unique_ptr<RealFlanks>> make(flow::Run& run, const proof::ProofLimits& limits,
                                                                const process::FlankGrid& grid);

  /// Teeth that can be asked for.
  [[nodiscard]] int teeth() const { return run_.gear.process->part().teeth; }
  /// The flanks of tooth space `tooth`. Errors: a tool that the gear refuses; motions that cannot be followed.
  [[nodiscard]] Result<Cost> cost(const Drawn& drawn, int tooth);
  /// The cut surface of that space behind its cost, turned to tooth space 0. Errors: as cost().
  [[nodiscard]] Result<std::vector<proof::SurfaceGrid>> surface(const Drawn& drawn, int tooth);
  /// Without errors, tooth space 0.
  [[nodiscard]] const Cost& nominal() const { return nominal_; }

 private:
  RealFlanks(flow::Run& run, const proof::ProofLimits& limits, const process::FlankGrid& grid)
      : run_(run), limits_(limits), grid_(grid) {}
  struct Judge;
  struct Points {
    std::vector<float> excess_um;
    std::vector<bool> counts;  ///< a point of a flank that can be reached
  };
  [[nodiscard]] Result<Judge*> judge_for(const Drawn& drawn);
  [[nodiscard]] Result<std::vector<path::ToolMotion>> motions(const Drawn& drawn, int tooth) const;
  [[nodiscard]] Result<process::ProgramProof> proof(const Drawn& drawn, int tooth);
  [[nodiscard]] static Points points_of(const std::vector<proof::SurfaceGrid>& surface);

  flow::Run& run_;
  proof::ProofLimits limits_;
  process::FlankGrid grid_;
  readback::NcControl control_;
  readback::ReadBack read_;
  std::shared_ptr<Judge> judge_, other_;  ///< with the tools of the job; with other radii, of the last sample
  Points nominal_points_;
  Cost nominal_;
};

}  // namespace toothpath::errors
