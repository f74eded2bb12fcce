#include "app/report/motion_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Positions at the ends of the blocks and mean speeds in them, one series an axis.
struct AxisCurves {
  std::vector<double> times;        ///< ends of the blocks, min
  std::vector<double> step_times;   ///< both ends of every block: speeds are steps
  std::array<std::vector<double>, 5> positions, speeds;
};

AxisCurves curves_of(const ReadBack& read) {
  AxisCurves curves;
  double now = 0;
  for (const OperationTrace& trace : read.operations) {
    const ExecutedMove* before = nullptr;
    for (const ExecutedMove& move : trace.moves) {
      if (!move.known) continue;
      if (before != nullptr && move.minutes > 0) {
        curves.step_times.push_back(now);
        curves.step_times.push_back(now + move.minutes);
        for (std::size_t a = 0; a < 5; ++a) {
          const double speed = std::abs(move.joints[a] - before->joints[a]) / move.minutes;
          curves.speeds[a].insert(curves.speeds[a].end(), 2, speed);
        }
      }
      now += before != nullptr ? move.minutes : 0;
      curves.times.push_back(now);
      for (std::size_t a = 0; a < 5; ++a) curves.positions[a].push_back(move.joints[a]);
      before = &move;
    }
  }
  return curves;
}

/// Two charts of the axes [from, to) of the machine's joints: positions and speeds.
void add_axes(std::vector<LineChart>& charts, const AxisCurves& curves, const Machine& machine, std::size_t from, std::size_t to, bool rotary) {
  LineChart position{rotary ? "Rotary axes" : "Linear axes", "time [min]", rotary ? "position [deg]" : "position [mm]", {}, {}, false, false, false,
                     "First tooth of every operation, machine coordinates."};
  LineChart speed{rotary ? "Speed of the rotary axes" : "Speed of the linear axes", "time [min]", rotary ? "speed [deg/min]" : "speed [mm/min]", {}, {}, false, true, false,
                  "Mean of each block; standing axes are left out of the logarithmic scale."};
  double fastest = 0;
  for (std::size_t a = from; a < to; ++a) {
    const std::string name(1, rotary ? machine.chain.rotary(a - 3).letter : "XYZ"[a]);
    position.series.push_back({name, curves.times, curves.positions[a]});
    speed.series.push_back({name, curves.step_times, curves.speeds[a]});
    for (const double v : curves.speeds[a]) fastest = std::max(fastest, v);
    const double limit = rotary ? degrees(machine.chain.rotary(a - 3).max_speed) : machine.chain.linear[a].max_speed;
    const bool stated = std::any_of(speed.limits.begin(), speed.limits.end(), [&](const ChartLimit& l) { return l.y == limit; });
    if (!stated) speed.limits.push_back({"limit of " + name, limit});
  }
  charts.push_back(std::move(position));
  if (fastest > 0) charts.push_back(std::move(speed));
}

LineChart feed_chart(const std::vector<ToolMotion>& motions, const Machine& machine) {
  LineChart chart{"Feed of the tool tip", "time [min]", "feed [mm/min]", {{"tip over the work", {}, {}}}, {}, false, false, false,
                  "Feed moves of the first tooth of every operation; rapids are left out."};
  double now = 0;
  auto& [name, x, y] = chart.series.front();
  int operation = -1, tooth = -1;
  for (const ToolMotion& m : motions) {
    if (m.operation != operation) {
      operation = m.operation;
      tooth = m.tooth;
    }
    if (m.tooth != tooth || !(m.minutes > 0)) continue;
    if (!m.rapid) {
      const double speed = (m.tip_to - m.tip_from).norm() / m.minutes;
      x.insert(x.end(), {now, now + m.minutes});
      y.insert(y.end(), {speed, speed});
    } else if (!y.empty() && !std::isnan(y.back())) {
      x.push_back(now);
      y.push_back(kNothing);
    }
    now += m.minutes;
  }
  chart.limits.push_back({"cutting feed of the machine", machine.max_cutting_feed});
  double greatest = 0;
  for (const double v : y) greatest = std::max(greatest, std::isnan(v) ? 0.0 : v);
  if (greatest < 0.2 * machine.max_cutting_feed) chart.limits.clear();  // far away: it would press the curve flat
  return chart;
}

}  // namespace

std::vector<int> lines_of_records(const ClPath& path, const std::vector<ToolMotion>& motions, double tolerance_mm) {
  constexpr std::size_t kAhead = 256;  // moves of a link, and pieces of one turning move
  std::vector<const ToolMotion*> own;
  for (const ToolMotion& m : motions)
    if (m.operation == path.operation && (own.empty() || m.tooth == own.front()->tooth)) own.push_back(&m);
  const auto distance = [](const Vec3& p, const ToolMotion& m) {
    const Vec3 d = m.tip_to - m.tip_from;
    const double square = d.squaredNorm();
    const double t = square > 0 ? std::clamp((p - m.tip_from).dot(d) / square, 0.0, 1.0) : 0.0;
    return (p - m.tip_from - t * d).norm();
  };
  std::vector<int> lines;
  std::size_t next = 0;
  for (const ClRecord& record : path.records) {
    int line = 0;
    for (std::size_t j = next; j < std::min(own.size(), next + kAhead); ++j) {
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

std::vector<LineChart> motion_charts(const ReadBack& read, const std::vector<ToolMotion>& motions, const Machine& machine) {
  std::vector<LineChart> charts;
  const AxisCurves curves = curves_of(read);
  if (curves.times.size() < 2) return charts;
  add_axes(charts, curves, machine, 0, 3, false);
  if (const std::size_t rotaries = machine.chain.rotary_count(); rotaries > 0) add_axes(charts, curves, machine, 3, 3 + rotaries, true);
  charts.push_back(feed_chart(motions, machine));
  return charts;
}

}  // namespace toothpath
