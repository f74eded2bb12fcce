// `toothpath correct JOB --measured FILE --out DIR`: `run` again, with flanks that answer a measurement.
#include "app/commands/run.h"
#include "app/commands/surface.h"

namespace toothpath::commands {

void add_correct(Commands& commands) {
  commands.push_back(command_of<RunRequest>(
      "correct", "the whole way again, with flanks that answer a measurement",
      [](OptionSet& set, RunRequest& request) {
        job_options(set, request);
        set.required_files("--measured", request.measured_files,
                           "measured grid: inspection.csv with a column deviation_um; several: one after each cut");
        cad_options(set, request.cad);
      },
      run_job));
}

}  // namespace toothpath::commands
