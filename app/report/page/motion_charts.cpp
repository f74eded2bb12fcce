#include "app/report/page/motion_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "app/report/svg/turned_text.h"
#include "geometry/base/angle.h"
#include "postproc/readback/run_time.h"

namespace toothpath::page {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

constexpr double kRoom = 0.3;       ///< of the range while cutting: rapids that leave it by more are not drawn
constexpr double kStanding = 1e-6;  ///< mm or deg
constexpr double kAxisPlotHeight = 110;

/// Positions of one axis at the ends of the blocks, and its mean speed in the blocks that feed.
struct AxisCurve {
  svg::ChartSeries position{"position", {}, {}}, speed{"speed", {}, {}};
  double least = std::numeric_limits<double>::infinity(), greatest = -least;  ///< position while feeding
  double fastest = 0;
};

/// Positions far from where the axis cuts (tool change, retract) become gaps: they would press the rest flat.
void drop_far(AxisCurve& curve) {
  const double room = kRoom * (curve.greatest - curve.least);
  for (double& v : curve.position.y)
    if (v < curve.least - room || v > curve.greatest + room) v = kNothing;
}

std::array<AxisCurve, 5> curves_of(const readback::ReadBack& read, const machines::Machine& machine) {
  std::array<AxisCurve, 5> curves;
  double now = 0;
  for (const readback::OperationTrace& trace : read.operations) {
    const readback::ExecutedMove* before = nullptr;
    const std::vector<double> times = readback::run_times(trace.moves, machine, read.corners);
    for (std::size_t k = 0; k < trace.moves.size(); ++k) {
      const readback::ExecutedMove& move = trace.moves[k];
      if (!move.known) continue;
      const double start = now, minutes = times[k];
      if (before != nullptr) now += minutes;
      for (std::size_t a = 0; a < 5; ++a) {
        AxisCurve& curve = curves[a];
        curve.position.x.push_back(now);
        curve.position.y.push_back(move.joints[a]);
        if (before == nullptr || !(minutes > 0)) continue;
        // Speeds are steps: both ends of the block.
        const double speed = move.rapid ? kNothing : std::abs(move.joints[a] - before->joints[a]) / minutes;
        curve.speed.x.insert(curve.speed.x.end(), {start, now});
        curve.speed.y.insert(curve.speed.y.end(), 2, speed);
        if (move.rapid) continue;
        curve.fastest = std::max(curve.fastest, speed);
        for (const double at : {before->joints[a], move.joints[a]})
          curve.least = std::min(curve.least, at), curve.greatest = std::max(curve.greatest, at);
      }
      before = &move;
    }
  }
  for (AxisCurve& curve : curves) drop_far(curve);
  return curves;
}

/// Position and speed of one axis side by side; nothing for an axis that stands still while cutting: `standing` says
/// where.
void add_axis(std::vector<svg::LineChart>& charts, AxisCurve& curve, char letter, bool rotary, double limit,
              std::string& standing) {
  const char* unit = rotary ? "deg" : "mm";
  if (!(curve.least <= curve.greatest)) return;
  if (curve.greatest - curve.least < kStanding) {
    standing += fmt::format("{}{} at {:.3f} {}", standing.empty() ? "Standing while cutting: " : ", ", letter,
                            curve.least, unit);
    return;
  }
  const bool in_turns = rotary && curve.greatest - curve.least > svg::kTurnsFrom;
  if (in_turns)
    for (double& v : curve.position.y) v /= 360;
  svg::LineChart position, speed;
  position.title = fmt::format("{}, position", letter);
  speed.title = fmt::format("{}, speed while feeding", letter);
  position.x_label = speed.x_label = "time [min]";
  position.y_label = fmt::format("{} [{}]", letter, in_turns ? "turns" : unit);
  speed.y_label = fmt::format("{} [{}/min]", letter, unit);
  position.plot_height = speed.plot_height = kAxisPlotHeight;
  position.series.push_back(std::move(curve.position));
  speed.series.push_back(std::move(curve.speed));
  if (curve.fastest > 0.2 * limit)
    speed.limits.push_back({"limit of the axis", limit});  // far away it would press the curve flat
  charts.push_back(std::move(position));
  charts.push_back(std::move(speed));
}

/// The first tooth of every operation. Its retract from the tool change still stands at the last tooth of the operation
/// before.
std::map<int, int> first_teeth(const std::vector<path::ToolMotion>& motions) {
  std::map<int, int> first;
  for (const path::ToolMotion& m : motions) {
    const auto at = first.try_emplace(m.operation, m.tooth).first;
    at->second = std::min(at->second, m.tooth);
  }
  return first;
}

/// How much longer than asked the blocks of the kept teeth take, by their line.
std::map<int, double> slowed_lines(const readback::ReadBack& read, const machines::Machine& machine) {
  std::map<int, double> slowed;
  for (const readback::OperationTrace& trace : read.operations) {
    const std::vector<double> times = readback::run_times(trace.moves, machine, read.corners);
    for (std::size_t k = 0; k < trace.moves.size(); ++k)
      if (trace.moves[k].minutes > 0) slowed.try_emplace(trace.moves[k].line, times[k] / trace.moves[k].minutes);
  }
  return slowed;
}

svg::LineChart feed_chart(const readback::ReadBack& read, const std::vector<path::ToolMotion>& motions,
                          const machines::Machine& machine) {
  svg::LineChart chart{"Feed of the tool tip",
                       "time [min]",
                       "feed [mm/min]",
                       {{"tip over the work", {}, {}}},
                       {},
                       false,
                       false,
                       false,
                       "Feed moves of the first tooth of every operation; rapids are left out."};
  double now = 0;
  auto& [name, x, y] = chart.series.front();
  const std::map<int, int> first = first_teeth(motions);
  const std::map<int, double> slowed = slowed_lines(read, machine);
  for (const path::ToolMotion& m : motions) {
    if (m.tooth != first.at(m.operation) || !(m.minutes > 0)) continue;
    const auto line = slowed.find(m.line);
    const double minutes = m.minutes * (line == slowed.end() ? 1 : line->second);
    if (!m.rapid) {
      const double speed = (m.tip_to - m.tip_from).norm() / minutes;
      x.insert(x.end(), {now, now + minutes});
      y.insert(y.end(), {speed, speed});
    } else if (!y.empty() && !std::isnan(y.back())) {
      x.push_back(now);
      y.push_back(kNothing);
    }
    now += minutes;
  }
  chart.limits.push_back({"cutting feed of the machine", machine.max_cutting_feed});
  double greatest = 0;
  for (const double v : y) greatest = std::max(greatest, std::isnan(v) ? 0.0 : v);
  if (greatest < 0.2 * machine.max_cutting_feed) chart.limits.clear();  // far away: it would press the curve flat
  return chart;
}

}  // namespace

std::vector<int> lines_of_records(const path::ClPath& path, const std::vector<path::ToolMotion>& motions,
                                  double tolerance_mm) {
  constexpr std::size_t kAhead =
      256;  // feed moves; rapids do not count: the index from the last tooth comes in thousands of pieces
  const std::map<int, int> first = first_teeth(motions);
  std::vector<const path::ToolMotion*> own;
  for (const path::ToolMotion& m : motions)
    if (m.operation == path.operation && m.tooth == first.at(m.operation)) own.push_back(&m);
  const auto distance = [](const Vec3& p, const path::ToolMotion& m) {
    const Vec3 d = m.tip_to - m.tip_from;
    const double square = d.squaredNorm();
    const double t = square > 0 ? std::clamp((p - m.tip_from).dot(d) / square, 0.0, 1.0) : 0.0;
    return (p - m.tip_from - t * d).norm();
  };
  std::vector<int> lines;
  std::size_t next = 0;
  for (const path::ClRecord& record : path.records) {
    int line = 0;
    std::size_t feeds = 0;
    for (std::size_t j = next; j < own.size() && feeds < kAhead; ++j) {
      feeds += own[j]->rapid ? 0 : 1;
      if (distance(record.tip, *own[j]) > tolerance_mm) continue;
      // Where the record ends this move, the next one touches it too: the first one has reached it.
      line = own[j]->line;
      next = j;
      break;
    }
    lines.push_back(line);
  }
  return lines;
}

std::vector<svg::LineChart> motion_charts(const readback::ReadBack& read, const std::vector<path::ToolMotion>& motions,
                                          const machines::Machine& machine) {
  std::vector<svg::LineChart> charts;
  std::array<AxisCurve, 5> curves = curves_of(read, machine);
  if (curves[0].position.x.size() < 2) return charts;
  std::string standing;
  for (std::size_t a = 0; a < 3 + machine.chain.rotary_count(); ++a) {
    const bool rotary = a >= 3;
    const char letter = rotary ? machine.chain.rotary(a - 3).letter : "XYZ"[a];
    add_axis(charts, curves[a], letter, rotary,
             rotary ? degrees(machine.chain.rotary(a - 3).max_speed) : machine.chain.linear[a].max_speed, standing);
  }
  charts.push_back(feed_chart(read, motions, machine));
  if (!standing.empty()) charts.back().note += " " + standing + ".";
  return charts;
}

}  // namespace toothpath::page
