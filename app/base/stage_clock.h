// Seconds of every stage that ran; what is running is shown.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "app/base/progress.h"

namespace toothpath::app {

class StageClock {
 public:
  explicit StageClock(Progress& progress) : progress_(progress) {}

  /// Runs `work`, adds its wall time to stage `name` and returns what it returns. A stage inside another counts for
  /// itself only.
  template <typename Work>
  decltype(auto) run(const std::string& name, Work&& work) {
    const Progress::Stage shown(progress_, name);
    const Stopwatch stopwatch{*this, name, std::chrono::steady_clock::now(), std::exchange(inner_, 0.0)};
    return std::forward<Work>(work)();
  }

  /// Stages in the order in which they first ran.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  struct Stopwatch {
    StageClock& clock;
    const std::string& name;
    std::chrono::steady_clock::time_point start;
    double before;  ///< what stages inside the one around this have taken so far
    ~Stopwatch() {
      const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      clock.add(name, all - clock.inner_);
      clock.inner_ = before + all;
    }
  };
  void add(const std::string& name, double seconds);

  Progress& progress_;
  double inner_ = 0;  ///< seconds of the stages that ran inside the current one
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace toothpath::app
