#include "app/report/block_times.h"

#include <algorithm>
#include <cmath>

namespace toothpath::report {

BlockTimes block_times_of(const joints::AxisProgram& program) {
  BlockTimes out;
  std::vector<double> ms;
  for (const auto& operation : program.operations) {
    if (operation.teeth.empty()) continue;
    for (const auto& block : operation.teeth.front().blocks)
      if (block.kind == joints::BlockKind::feed)
        ms.push_back((program.has_acceleration ? block.run_minutes : block.minutes) * 60000);
  }
  for (std::size_t i = 0; i < program.time_rulers.size() && i < program.time_ruled.size(); ++i)
    if (program.time_ruled[i] > 0) out.ruled.emplace_back(program.time_rulers[i], program.time_ruled[i]);
  if (ms.empty()) return out;
  std::sort(ms.begin(), ms.end());
  out.least_ms = ms.front();
  out.median_ms = ms[ms.size() / 2];
  // Bins begin at whole tenths of a decade, so that two runs can be laid over each other.
  const auto bin_of = [&](double t) { return static_cast<long>(std::floor(std::log10(t) / out.step_log_ms + 1e-9)); };
  const long first = bin_of(ms.front()), last = bin_of(ms.back());
  out.from_log_ms = static_cast<double>(first) * out.step_log_ms;
  out.counts.assign(static_cast<std::size_t>(last - first + 1), 0);
  for (const double t : ms) ++out.counts[static_cast<std::size_t>(bin_of(t) - first)];
  return out;
}

svg::HistogramChart block_time_chart(const BlockTimes& times) {
  return {
      fmt::format("Cutting blocks of one tooth: least {:.3g} ms, median {:.3g} ms", times.least_ms, times.median_ms),
      "time of a block [ms]",
      times.from_log_ms,
      times.step_log_ms,
      times.counts,
      {},
      "blocks",
      true};
}

}  // namespace toothpath::report
