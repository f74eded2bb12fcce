#include "app/base/stage_clock.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "geometry/base/printable.h"

namespace toothpath::app {

Progress::Progress(bool quiet) {
  const char* terminal = std::getenv("TERM");
  active_ = !quiet && ::isatty(STDERR_FILENO) != 0 && terminal && std::string_view(terminal) != "dumb";
}

void Progress::show(const std::string& text) {
  if (!active_) return;
  std::fprintf(stderr, "\r\033[2K%s%s%s ...", printable(label_).c_str(), label_.empty() ? "" : ": ",
               printable(text).c_str());
  std::fflush(stderr);
  shown_ = true;
}

void Progress::clear() {
  if (!shown_) return;
  std::fputs("\r\033[2K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

void StageClock::add(const std::string& name, double seconds) {
  for (auto& [known, sum] : seconds_) {
    if (known != name) continue;
    sum += seconds;
    return;
  }
  seconds_.emplace_back(name, seconds);
}

}  // namespace toothpath::app
