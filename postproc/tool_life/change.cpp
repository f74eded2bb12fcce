#include "postproc/tool_life/change.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "postproc/joints/tooth_order.h"

namespace toothpath::tool_life {
namespace {

constexpr double kRoundOff = 1 + 1e-9;  // of sums of minutes

/// One tool of the job while the program is gone through.
class Chain {
 public:
  explicit Chain(const LastingTool& tool) : tool_(tool) { begin(); }

  /// The tool that cuts goes on with a tooth of so many minutes.
  [[nodiscard]] bool fits(double minutes) const { return used_ == 0 || used_ + minutes <= tool_.life_min * kRoundOff; }
  /// The tool that cuts it.
  int take(double minutes) {
    if (!fits(minutes)) {
      ++now_;
      begin();
    }
    used_ += minutes;
    all_ += minutes;
    if (now_ > tool_.sisters.size()) missing_ += minutes;
    longest_ = std::max(longest_, minutes);
    return number();
  }
  void note(int operation, int first, int end, double minutes) {
    if (now_ <= tool_.sisters.size()) uses_.back().stretches.push_back({operation, first, end, minutes});
  }
  [[nodiscard]] int number() const {
    if (now_ == 0) return tool_.number;
    return now_ <= tool_.sisters.size() ? tool_.sisters[now_ - 1] : -static_cast<int>(now_);
  }
  [[nodiscard]] bool is_sister() const { return now_ > 0; }
  [[nodiscard]] std::optional<Shortage> shortage() const {
    if (longest_ > tool_.life_min * kRoundOff)
      return Shortage{
          tool_.number, true,
          fmt::format("one tooth takes {:.4g} min of cutting with tool {}, its life is {:g} min: it is never "
                      "changed within a tooth; a longer life, or less to cut in one operation",
                      longest_, tool_.number, tool_.life_min)};
    if (missing_ == 0) return std::nullopt;
    const std::size_t tools = 1 + tool_.sisters.size(), more = now_ - tool_.sisters.size();
    return Shortage{
        tool_.number, false,
        fmt::format(
            "tool {}{} last{} {:g} min, the program cuts for {:.4g} min with {}: {:.4g} min are missing; {} more "
            "sister{}, or a life of {:.4g} min",
            tool_.number, tools == 1 ? "" : fmt::format(" and {} sister{}", tools - 1, tools == 2 ? "" : "s"),
            tools == 1 ? "s" : "", static_cast<double>(tools) * tool_.life_min, all_, tools == 1 ? "it" : "them",
            missing_, more, more == 1 ? "" : "s", life_that_does())};
  }
  void see(double minutes) { order_.push_back(minutes); }
  [[nodiscard]] const std::vector<joints::ToolUse>& uses() const { return uses_; }

 private:
  void begin() {
    used_ = 0;
    if (now_ <= tool_.sisters.size()) uses_.push_back({number(), now_ == 0 ? 0 : tool_.number, tool_.life_min, {}});
  }
  /// Tools that a life needs.
  [[nodiscard]] std::size_t tools_with(double life) const {
    std::size_t tools = 1;
    double used = 0;
    for (const double m : order_) {
      if (used > 0 && used + m > life * kRoundOff) {
        ++tools;
        used = 0;
      }
      used += m;
    }
    return tools;
  }
  /// The least life with which the tools that there are do, to a thousandth.
  [[nodiscard]] double life_that_does() const {
    double low = tool_.life_min, high = std::max(all_, longest_);
    while (high - low > 1e-3 * high) {
      const double middle = 0.5 * (low + high);
      (tools_with(middle) <= 1 + tool_.sisters.size() ? high : low) = middle;
    }
    return high;
  }

  const LastingTool& tool_;
  std::size_t now_ = 0;  // 0: the tool itself, then its sisters, then such as there are not
  double used_ = 0, all_ = 0, missing_ = 0, longest_ = 0;
  std::vector<double> order_;  // of all teeth
  std::vector<joints::ToolUse> uses_;
};

/// The teeth of one operation, shared out among the tools of a chain.
void divide(const joints::AxisOperation& op, const joints::AxisProgram& program, Chain& chain,
            std::vector<joints::AxisOperation>& out) {
  const std::vector<double> minutes = minutes_of_places(op, program);
  const int begin = op.first_place, end = op.end_of(program.teeth);
  int first = begin, tool = 0;
  bool sister = false;
  double sum = 0;
  const auto close = [&](int at) {
    joints::AxisOperation piece = operation_between(op, first, at, program);
    if (first != begin || at != end) piece.end_place = at;  // the order does not end here for this tool
    piece.sister_of = sister ? op.tool_number : 0;
    piece.tool_number = tool;
    out.push_back(std::move(piece));
  };
  for (int place = begin; place < end; ++place) {
    const double m = minutes[static_cast<std::size_t>(place - begin)];
    chain.see(m);
    // The stretch so far is noted with the tool that has cut it.
    const bool goes_on = place > begin && chain.fits(m);
    if (place > begin && !goes_on) {
      chain.note(op.operation, first, place, sum);
      close(place);
      first = place;
      sum = 0;
    }
    tool = chain.take(m);
    sister = chain.is_sister();
    sum += m;
  }
  chain.note(op.operation, first, end, sum);
  close(end);
}

}  // namespace

std::vector<double> minutes_of_places(const joints::AxisOperation& op, const joints::AxisProgram& program) {
  std::vector<double> minutes;
  const bool timed = program.has_acceleration && op.tooth_minutes.size() == op.teeth.size();
  std::vector<joints::AxisBlock> room;
  for (std::size_t n = 0; n < op.teeth.size(); ++n) {
    double sum = timed ? op.tooth_minutes[n] : 0;
    if (!timed)
      for (const joints::AxisBlock& b : op.teeth[n].all(room))
        if (b.kind == joints::BlockKind::feed || b.kind == joints::BlockKind::turn) sum += b.minutes;
    minutes.push_back(sum);
  }
  if (program.loop && !minutes.empty())
    minutes.resize(static_cast<std::size_t>(op.places(program.teeth)), minutes.front());
  return minutes;
}

std::vector<Shortage> change_tools(joints::AxisProgram& program, std::span<const LastingTool> tools) {
  std::map<int, Chain> chains;
  for (const LastingTool& tool : tools) chains.emplace(tool.number, tool);
  std::vector<joints::AxisOperation> divided;
  for (joints::AxisOperation& op : program.operations) {
    const auto chain = chains.find(op.tool_number);
    if (chain == chains.end()) divided.push_back(std::move(op));
    else divide(op, program, chain->second, divided);
  }
  program.operations = std::move(divided);
  sum_times(program);
  std::vector<Shortage> short_of;
  for (const LastingTool& tool : tools) {
    const Chain& chain = chains.at(tool.number);
    if (auto shortage = chain.shortage()) short_of.push_back(std::move(*shortage));
    for (const joints::ToolUse& use : chain.uses())
      if (!use.stretches.empty()) program.tool_uses.push_back(use);
  }
  return short_of;
}

}  // namespace toothpath::tool_life
