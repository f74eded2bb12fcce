// `toothpath study dhfg --file STUDY.toml`: the nine orthogonal trials of the literature on double helical face gears.
#pragma once

#include <string_view>

#include "app/commands/command.h"
#include "app/process/gear_of_job.h"
#include "app/studies/trials/dhfg_trial.h"

namespace toothpath::studies {

struct DhfgRequest : commands::CommonRequest {
  std::string study_file;  ///< empty: the literature's levels, no milling
  std::string out_dir;
  bool quick = false;  ///< the short form
  std::string shard;   ///< "i/n"; empty: of the array of Slurm, else the whole study at once
};

/// Reads a study file: tables [study], [[tool]] and [[operation]] (as in a job). Without text: the literature's levels,
/// m 5, no milling. Refused with line and column: unknown keys, types, ranges; three levels are needed for every
/// factor.
[[nodiscard]] process::ValueOrErrors<trials::DhfgStudy> parse_dhfg_study(std::string_view text,
                                                                         const std::string& file);

/// Writes dhfg.csv, dhfg.json and dhfg.html. With `quick` scallops are ten times, chords five times, steps twice as
/// coarse: the milling times are then those of that coarse surface, and say so. A shard writes its samples instead, for
/// `study merge`; all of them in one shard: merged at once. Refused: a directory with another study.
[[nodiscard]] commands::CommandOutcome study_dhfg(const DhfgRequest& request);

}  // namespace toothpath::studies
