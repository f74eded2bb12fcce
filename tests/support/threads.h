// Work on a certain number of threads, also on a machine with fewer processors.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace toothpath::test {

/// What `work` returns. A limit alone is not enough: the arena of a thread keeps the size that it had when it was first
/// used.
template <typename Work>
auto on_threads(int count, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(count));
  return tbb::task_arena(count).execute(work);
}

}  // namespace toothpath::test
