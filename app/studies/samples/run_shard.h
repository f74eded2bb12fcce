// The samples of one shard, computed where they do not stand yet.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/studies/samples/sample_file.h"
#include "app/studies/samples/shard.h"

namespace toothpath::samples {

/// Of all that decides the samples besides the program itself: `parts`, and the contents of all inputs that were read.
[[nodiscard]] std::string key_of(const std::vector<std::string>& parts);

struct RanShard {
  std::string path;
  std::size_t samples = 0, fresh = 0;         ///< that stand in the file now; that were computed
  [[nodiscard]] std::string summary() const;  ///< one line for the screen
};
/// @param line  of sample k, a JSON object with "sample"
/// Errors: those of SampleFile, and the first of `line`; what was computed before it stays.
[[nodiscard]] Result<RanShard> run_shard(const std::string& directory, const Shard& shard, const Head& head,
                                         const std::function<Result<std::string>(int)>& line);

}  // namespace toothpath::samples
