// The flanks that a job's operations leave: by its milling operations (the stages of `run`) or by the strokes of its gear shaper.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/process/gear_of_job.h"
#include "app/base/output_dir.h"
#include "app/report/run_report.h"
#include "cam/proof/verification.h"

namespace toothpath::process {

/// Flanks of one tooth with the deviation along the normal, and what it took to cut them.
struct CutFlanks {
  struct Flank {
    int zone = 0, side = 1;
    int rows = 0, columns = 0;           ///< rows along the profile
    std::vector<Vec3> nominal, normals;  ///< gear frame, out of the material
    std::vector<double> deviation_mm;    ///< > 0 material left
  };
  std::vector<Flank> flanks;
  std::string route;                ///< "milled" or "shaped"
  double cutting_minutes = 0, total_minutes = 0;
  bool verified = true;             ///< milled: the program was proven; its reasons stand in `warnings` otherwise
  std::vector<std::string> warnings, assumed;
  std::vector<std::pair<std::string, double>> stages;  ///< milled: seconds of the run
};

/// Flank patches of a cut surface after the last operation.
[[nodiscard]] std::vector<CutFlanks::Flank> flanks_of(const std::vector<proof::SurfaceGrid>& surface);

/// Runs the job's own route. Milled: plan, post, read back, cut surface on `rows` x `columns`. Refused: what `run` and `shaper` refuse; a job
/// with neither operations nor [shaping]; a run that does not get as far as a surface.
[[nodiscard]] ValueOrErrors<CutFlanks> cut_flanks(const job::Job& job, const face_gear::FaceGear& gear, int rows, int columns, app::OutputDir& scratch, bool quiet);

/// The strokes of a job's gear shaper at given places: one turn of the work at full depth.
[[nodiscard]] ValueOrErrors<CutFlanks> shaped_flanks(const job::Job& job, const face_gear::FaceGear& gear, std::vector<CutFlanks::Flank> places);

}  // namespace toothpath::process
