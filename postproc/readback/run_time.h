// Run time of what was read back: the executed moves through timing::PathTimer, with the path mode that the text says.
#pragma once

#include <deque>
#include <functional>

#include "postproc/readback/reader.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::readback {

/// Takes executed moves in order, tells the time of each in order. Without accelerations in the machine file the times
/// are those that the text asks for.
class RunTimer {
 public:
  /// @param sink gets whether the move is a rapid, and its time [min]
  RunTimer(const machines::Machine& machine, timing::Corners corners,
           std::function<void(bool rapid, double minutes)> sink);

  void add(const ExecutedMove& move);
  void finish();

 private:
  bool accelerates_ = false, plans_words_ = false, follows_ = false;
  struct Open {
    bool rapid = false;
    double dwell_min = 0;
  };
  std::deque<Open> open_;  ///< moves whose time is not known yet
  std::function<void(bool, double)> sink_;
  timing::PathTimer timer_;
  ExecutedMove before_;
};

/// Times of moves that follow one another [min], one for each.
[[nodiscard]] std::vector<double> run_times(std::span<const ExecutedMove> moves, const machines::Machine& machine,
                                            timing::Corners corners);

}  // namespace toothpath::readback
