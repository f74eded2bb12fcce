// A part of the samples of a study, for one process among several.
#pragma once

#include <string>

#include "geometry/base/result.h"

namespace toothpath::samples {

/// Shard `number` of `count`, from 1: the samples k with k mod count = number - 1.
struct Shard {
  int number = 1, count = 1;
  [[nodiscard]] bool has(int sample) const { return sample % count == number - 1; }
  [[nodiscard]] std::string text() const;       ///< "3/8"
  [[nodiscard]] std::string file_name() const;  ///< "samples.3of8.jsonl"
};

inline constexpr int kMostShards = 10000;
inline constexpr const char* kShardHelp = "part i of n of the samples; in a Slurm array its task is the default";

/// This process is a task of a Slurm array.
[[nodiscard]] bool in_slurm_array();

/// Of an option "i/n"; where that is empty of the array that Slurm runs this process in (SLURM_ARRAY_TASK_ID, _MIN,
/// _COUNT, _STEP); else all samples. Refused (kind usage): what is no shard; an array with gaps.
[[nodiscard]] Result<Shard> shard_of(const std::string& option);

}  // namespace toothpath::samples
