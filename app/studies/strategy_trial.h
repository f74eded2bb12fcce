// One strategy through the whole way of `run`: plan, gouge check, NC text, read back, proof; and what it came to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/base/output_dir.h"
#include "app/report/run_report.h"
#include "app/studies/strategy_jobs.h"

namespace toothpath::studies {

/// What is left on the flanks in the end, over the points that the last ball reaches: along the normal, mm.
struct LeftOnFlanks {
  double max_mm = 0, min_mm = 0, rms_mm = 0;
  std::size_t points = 0;
};

struct StrategyTrial {
  std::string name;           ///< "line", "2 strips", "ball", "tilted ball"
  std::string tool_axis;      ///< how the tool stands while the flank is finished
  bool proven = false;        ///< a program was made and looked at: proven safe, or not
  std::string reason;         ///< why it is not verified; empty: it is
  std::string remark;         ///< what was chosen or tried for it; may be empty
  report::RunReport report;   ///< as `run` has it
  std::size_t finisher = 0;   ///< the operation that finishes the flanks
  int passes = 0;             ///< of it, in one tooth space
  double flank_minutes = 0;   ///< of all operations in which strategies differ, all teeth
  double finish_minutes = 0;  ///< of the finisher
  LeftOnFlanks left;
  double seconds = 0;                                        ///< of this study
  [[nodiscard]] const report::CuttingLoad* cutting() const;  ///< of the finisher; null: not known
};

/// The job as it is. The program goes through a temporary file of `scratch` and is dropped.
/// Refused: gear and machine, for they are those of all strategies, and files that cannot be written; what stops plan
/// or program stands in `reason`.
[[nodiscard]] Expected<StrategyTrial, std::vector<Diagnostic>> try_strategy(const std::string& name,
                                                                            const job::Job& job,
                                                                            const LineMilledFlanks& flanks,
                                                                            app::OutputDir& scratch, bool quiet);

/// A strategy for which there is no job.
[[nodiscard]] StrategyTrial refused_strategy(const std::string& name, const Diagnostic& why);

}  // namespace toothpath::studies
