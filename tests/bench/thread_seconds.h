// Processor time of this thread alone: other work on the machine does not count.
#pragma once

#include <ctime>

#include <cmath>
#include <functional>

namespace toothpath::bench {

/// Least processor time of `repeats` runs of `work`, s.
inline double thread_seconds(const std::function<void()>& work, int repeats) {
  double best = INFINITY;
  for (int k = 0; k < repeats; ++k) {
    timespec a{}, b{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &a);
    work();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &b);
    best = std::fmin(best, double(b.tv_sec - a.tv_sec) + 1e-9 * double(b.tv_nsec - a.tv_nsec));
  }
  return best;
}

/// Uses a value, so that its computation cannot be left out.
inline void keep(double value) {
  [[maybe_unused]] static volatile double kept = 0;
  kept = value;
}

}  // namespace toothpath::bench
