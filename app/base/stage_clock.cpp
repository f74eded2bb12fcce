#include "app/base/stage_clock.h"

namespace toothpath::app {

void StageClock::add(const std::string& name, double seconds) {
  for (auto& [known, sum] : seconds_) {
    if (known != name) continue;
    sum += seconds;
    return;
  }
  seconds_.emplace_back(name, seconds);
}

}  // namespace toothpath::app
