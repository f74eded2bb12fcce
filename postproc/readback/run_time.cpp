#include "postproc/readback/run_time.h"

namespace toothpath::readback {

RunTimer::RunTimer(const machines::Machine& machine, timing::Corners corners, std::function<void(bool, double)> sink)
    : accelerates_(machine.has_acceleration()),
      plans_words_(timing::control_of(machine, corners).plans_words),
      follows_(corners != timing::Corners::jump),
      sink_(std::move(sink)),
      timer_(timing::limits_of(machine), timing::control_of(machine, corners), [this](double minutes) {
        sink_(open_.front().rapid, minutes + open_.front().dwell_min);
        open_.pop_front();
      }) {}

void RunTimer::add(const ExecutedMove& move) {
  if (!accelerates_) {
    sink_(move.rapid, move.minutes + double(move.dwell_min));
    return;
  }
  timing::Block block{{}, move.minutes, move.rapid};
  if (move.known) {
    for (std::size_t a = 0; a < 5; ++a) block.step[a] = move.joints[a] - before_.joints[a];
    if (plans_words_ && move.tcp && before_.tcp)
      for (int a = 0; a < 3; ++a) block.step[static_cast<std::size_t>(a)] = move.tip[a] - before_.tip[a];
  }
  const bool bounded = timing::is_bounded(move.corners);
  if (!move.rapid && (follows_ || bounded)) timer_.set_corners(move.corners, static_cast<double>(move.tolerance_mm));
  else if (!move.rapid) timer_.set_corners(timing::Corners::jump, 0);
  if (move.dwell_min > 0) timer_.finish();
  open_.push_back({move.rapid, double(move.dwell_min)});
  timer_.add(block);
  before_ = move;
}

void RunTimer::finish() { timer_.finish(); }

std::vector<double> run_times(std::span<const ExecutedMove> moves, const machines::Machine& machine,
                              timing::Corners corners) {
  std::vector<double> times;
  times.reserve(moves.size());
  RunTimer timer(machine, corners, [&times](bool, double minutes) { times.push_back(minutes); });
  for (const ExecutedMove& m : moves) timer.add(m);
  timer.finish();
  return times;
}

}  // namespace toothpath::readback
