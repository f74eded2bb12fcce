// Seconds of every stage that ran, and a line of progress on a terminal while it runs.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace toothpath {

/// One line on stderr that is rewritten; silent when stderr is no terminal, TERM is "dumb" or `quiet` is set.
class Progress {
 public:
  explicit Progress(bool quiet);
  void show(const std::string& text);
  void clear();

 private:
  bool active_ = false, shown_ = false;
};

class StageClock {
 public:
  explicit StageClock(Progress& progress) : progress_(progress) {}

  /// Runs `work`, adds its wall time to stage `name` and returns what it returns.
  template <typename Work>
  decltype(auto) run(const std::string& name, Work&& work) {
    progress_.show(name);
    const Stopwatch stopwatch{*this, name, std::chrono::steady_clock::now()};
    return std::forward<Work>(work)();
  }

  /// Stages in the order in which they first ran.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  struct Stopwatch {
    StageClock& clock;
    const std::string& name;
    std::chrono::steady_clock::time_point start;
    ~Stopwatch() { clock.add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()); }
  };
  void add(const std::string& name, double seconds);

  Progress& progress_;
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace toothpath
