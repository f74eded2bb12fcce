#include "app/base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

#include "app/base/units.h"
#include "geometry/base/printable.h"
#include "geometry/base/work_share.h"

namespace toothpath::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongStage = 2.0;     // s: told where no line can be rewritten
constexpr double kLeastKnown = 0.01;   // of a stage: less tells nothing of the rest
constexpr double kSecondsKnown = 1.0;  // s, as well
constexpr auto kTick = std::chrono::milliseconds(200);

bool is_terminal() {
  const char* terminal = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && terminal && std::string_view(terminal) != "dumb";
}

}  // namespace

std::string share_and_rest(double done, double seconds) {
  if (done < kLeastKnown) return "";
  if (seconds < kSecondsKnown) return fmt::format("{:.0f} %", 100 * done);
  return fmt::format("{:.0f} %, about {} left", 100 * done, duration_text(seconds * (1 - done) / done, true));
}

struct Progress::Shown {
  struct Running {
    std::string name, at;
    Clock::time_point start = Clock::now();
    std::unique_ptr<WorkShare> share = std::make_unique<WorkShare>(1, 0);  // of a stage inside another: no part of it
    bool told = false;

    [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - start).count(); }
  };

  /// With `mutex` held.
  void draw() {
    if (stages.empty()) return;
    Running& stage = stages.back();
    const double seconds = stage.seconds();
    if (!terminal && (stage.told || seconds < kLongStage)) return;
    std::string text = (label.empty() ? "" : label + ": ") + (stage.at.empty() ? stage.name : stage.at);
    const std::string rest = share_and_rest(stage.share->done(), seconds);
    if (seconds >= kSecondsKnown)
      text += fmt::format(": {}{}{}", duration_text(seconds, true), rest.empty() ? "" : ", ", rest);
    else if (!rest.empty()) text += ": " + rest;
    for (Running& any : stages) any.told = true;  // those around it are told with it
    std::fprintf(stderr, terminal ? "\r\033[2K%s ..." : "%s\n", printable(text).c_str());
    std::fflush(stderr);
    line = terminal;
  }
  void clear() {
    if (line) std::fputs("\r\033[2K", stderr);
    std::fflush(stderr);
    line = false;
  }

  const bool terminal = is_terminal();
  std::mutex mutex;
  std::condition_variable_any changed;
  std::vector<Running> stages;
  std::string label;
  bool line = false;    ///< one stands on the terminal
  std::jthread ticker;  // the last: it ends before what it reads
};

Progress::Progress(bool quiet) {
  if (!quiet) shown_ = std::make_unique<Shown>();
}

Progress::~Progress() { clear(); }

void Progress::show(const std::string& text) {
  if (!shown_) return;
  const std::lock_guard lock(shown_->mutex);
  if (shown_->stages.empty()) return;
  shown_->stages.back().at = text;
  if (shown_->terminal) shown_->draw();
}

void Progress::clear() {
  if (!shown_) return;
  const std::lock_guard lock(shown_->mutex);
  shown_->clear();
}

void Progress::label(std::string text) {
  if (!shown_) return;
  const std::lock_guard lock(shown_->mutex);
  shown_->label = std::move(text);
}

Progress::Stage::Stage(Progress& progress, const std::string& name) : progress_(progress) {
  if (!progress_.shown_) return;
  Shown& shown = *progress_.shown_;
  const std::lock_guard lock(shown.mutex);
  shown.stages.push_back({name, {}});
  if (shown.terminal) shown.draw();
  if (shown.ticker.joinable()) return;
  shown.ticker = std::jthread([&shown](const std::stop_token& stop) {
    std::unique_lock held(shown.mutex);
    while (!stop.stop_requested()) {
      shown.changed.wait_for(held, stop, kTick, [] { return false; });
      shown.draw();
    }
  });
}

Progress::Stage::~Stage() {
  if (!progress_.shown_) return;
  const std::lock_guard lock(progress_.shown_->mutex);
  progress_.shown_->stages.pop_back();
  if (progress_.shown_->terminal) progress_.shown_->draw();
}

}  // namespace toothpath::app
