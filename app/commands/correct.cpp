// `toothpath correct JOB --measured FILE --out DIR`: `run` again, with flanks compensated for measured deviations.
#include "app/commands/run.h"
#include "app/commands/surface.h"
#include "app/job/measured_points.h"

namespace toothpath::commands {

void add_correct(Commands& commands) {
  commands.push_back(command_of<RunRequest>(
      "correct", "like run, but compensated for measured deviations",
      [](OptionSet& set, RunRequest& request) {
        job_options(set, request);
        set.examples({"correct gear.toml --measured measured.csv",
                      "correct gear.toml --measured first.csv --measured second.csv"});
        set.required_files("--measured", request.measured.files,
                           "what was measured: inspection.csv with a column deviation_um, results as DMIS, or lines "
                           "x y z [i j k]; several: one after each cut");
        set.number("--ball-diameter", request.measured.ball_diameter_mm,
                   "the measured points are centres of a ball of this diameter, not places of the surface",
                   job::kBallDiameter);
        cad_options(set, request.cad);
      },
      run_job));
}

}  // namespace toothpath::commands
