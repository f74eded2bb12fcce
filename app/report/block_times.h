// How long the cutting blocks of a program take: a control that is given more blocks a second than it can prepare
// starves, and the tool marks the flank.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "app/report/svg/chart.h"
#include "postproc/joints/program.h"

namespace toothpath::report {

/// Times of the feed blocks of one tooth of every operation, as the program is made and as it reads back.
struct BlockTimes {
  double least_ms = 0, median_ms = 0;
  double from_log_ms = 0, step_log_ms = 0.1;  ///< histogram over the decimal logarithm of the time in ms
  std::vector<std::size_t> counts;            ///< one a bin; their sum is the number of blocks
  std::vector<std::pair<std::string, std::size_t>>
      ruled;  ///< which limit decided how many blocks: feed, axes, the control
};

/// Empty counts where nothing is cut.
[[nodiscard]] BlockTimes block_times_of(const joints::AxisProgram& program);

/// For the report page.
[[nodiscard]] svg::HistogramChart block_time_chart(const BlockTimes& times);

}  // namespace toothpath::report
