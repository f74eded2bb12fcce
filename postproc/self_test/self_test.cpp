#include "postproc/self_test/self_test.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "postproc/choice/solution.h"
#include "postproc/controls/registry.h"

namespace toothpath::self_test {
namespace {

using Rotaries = std::array<double, 2>;

bool turns_fully(const machines::RotaryAxis& axis, double margin) {
  return axis.max_rad - axis.min_rad - 2 * margin >= radians(360);
}

/// Commands of one axis on its own, zero left out: quarters of a turn, or both sides.
std::vector<double> commands_of(const machines::RotaryAxis& axis, double tilt, double margin) {
  std::vector<double> wanted =
      turns_fully(axis, margin) ? std::vector{radians(90), radians(180), radians(270)} : std::vector{tilt, -tilt};
  std::vector<double> possible;
  for (const double turn : wanted)
    for (const double w : {turn, turn - 2 * kPi}) {  // 270 or -90: the same place
      const double command = axis.zero_rad + w;
      if (command < axis.min_rad + margin || command > axis.max_rad - margin ||
          (!turns_fully(axis, margin) && w != turn))
        continue;
      possible.push_back(command);
      break;
    }
  return possible;
}

/// Zero, or where the axis may not stand there, the nearest whole degree at which it may.
double least_command(const machines::RotaryAxis& axis, double margin) {
  const double low = axis.min_rad + margin, high = axis.max_rad - margin;
  if (axis.zero_rad < low) return radians(std::ceil(degrees(low)));
  if (axis.zero_rad > high) return radians(std::floor(degrees(high)));
  return axis.zero_rad;
}

std::string command_text(const machines::KinematicChain& chain, const Rotaries& rotaries) {
  std::string text;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    double shown = degrees(rotaries[k]);
    if (std::abs(shown) < 5e-7) shown = 0;
    text += fmt::format("{}{}{:g}", k ? " " : "", chain.rotary(k).letter, shown);
  }
  return text;
}

/// All stations for one tilt.
std::vector<SelfTestStation> stations_for(const machines::Machine& machine, double tilt) {
  const machines::KinematicChain& chain = machine.chain;
  const double margin = machine.limit_margin.rotary_rad;
  Rotaries zero{};
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) zero[k] = least_command(chain.rotary(k), margin);
  std::vector<SelfTestStation> stations;
  const auto add = [&](const Rotaries& rotaries) {
    if (stations.empty() || stations.back().rotary_rad != rotaries)
      stations.push_back({rotaries, command_text(chain, rotaries)});
  };
  add(zero);
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    for (const double command : commands_of(chain.rotary(k), tilt, margin)) {
      Rotaries r = zero;
      r[k] = command;
      add(r);
    }
    add(zero);
  }
  // Quarters of the full axis with the other one tilted: both pivots and both signs at once.
  for (std::size_t k = 0; k < chain.rotary_count() && chain.rotary_count() == 2; ++k) {
    const std::size_t other = 1 - k;
    if (!turns_fully(chain.rotary(k), margin) || turns_fully(chain.rotary(other), margin)) continue;
    const auto tilts = commands_of(chain.rotary(other), tilt, margin);
    if (tilts.empty()) continue;
    Rotaries r = zero;
    r[other] = tilts.front();
    add(r);
    for (const double command : commands_of(chain.rotary(k), tilt, margin)) {
      r[k] = command;
      add(r);
    }
    r[k] = zero[k];
    add(r);
    add(zero);
  }
  // A rotary that rolls over goes on from where it stands.
  for (std::size_t s = 1; s < stations.size(); ++s)
    for (std::size_t k = 0; k < chain.rotary_count(); ++k)
      if (chain.rotary(k).rollover)
        stations[s].rotary_rad[k] = choice::nearest_turn(stations[s].rotary_rad[k], stations[s - 1].rotary_rad[k]);
  return stations;
}

/// By how much the zero of the first rotary of the table is moved to ask whether the transformation takes that: a
/// control that does not lets the tip go about the axis by so much.
double asking_zero_deg(const machines::KinematicChain& chain, const Vec3& point) {
  constexpr double kShown = 1, kMostTurn = radians(30), kStep = 1e-3;  // mm, rad, deg
  const machines::RotaryAxis& axis = chain.table.front();
  const double radius = (point - axis.point_mm).cross(axis.direction).norm();
  return std::round(degrees(std::min(kMostTurn, kShown / radius)) / kStep) * kStep;
}

/// Where the tip may stand: above the table near its rotary axis, else in the middle of the travels; nearer to the axis
/// as a second choice.
std::vector<Vec3> points_for(const machines::Machine& machine, double tool_length) {
  const machines::KinematicChain& chain = machine.chain;
  Vec3 low, high;
  for (int i = 0; i < 3; ++i) {
    low[i] = chain.linear[static_cast<std::size_t>(i)].min_mm;
    high[i] = chain.linear[static_cast<std::size_t>(i)].max_mm;
  }
  std::vector<Vec3> points;
  if (chain.table.empty()) {
    const Vec3 middle = (low + high) / 2;
    for (const double share : {0.5, 0.35, 0.65, 0.2, 0.8})
      points.push_back({middle.x(), middle.y(), low.z() + share * (high.z() - low.z()) - tool_length});
    return points;
  }
  const Vec3 centre = machine.table_middle_mm();
  const double radius = 0.5 * machine.table_diameter_mm;
  for (const double part : {0.3, 0.2, 0.1, 0.05})
    for (const double height : {60.0, 30.0, 100.0, 150.0, 10.0})
      points.push_back(centre + Vec3(part * radius, 0.5 * part * radius, height));
  return points;
}

/// Upper bound of the distance between the tip and any rotary axis: what a turn can swing.
double swing(const machines::KinematicChain& chain, const Vec3& point, double tool_length) {
  double reach = 0;
  for (const auto& axis : chain.table) {
    const Vec3 arm = point - axis.point_mm;
    reach += (arm - arm.dot(axis.direction) * axis.direction).norm();
  }
  // The first table axis moves the point against the second one by no more than the distance of the two.
  if (chain.table.size() == 2)
    reach += 2 * (chain.table[0].point_mm - chain.table[1].point_mm).norm() + (point - chain.table[0].point_mm).norm();
  for (const auto& axis : chain.head) reach += axis.point_mm.norm() + tool_length;
  return reach;
}

/// First joint outside its range, over all moves; nothing: all inside.
std::optional<std::string> first_violation(const machines::Machine& machine, const SelfTest& test) {
  for (const auto& move : test.moves) {
    const auto violations = machine.chain.violations(move.joints, machine.limit_margin);
    if (!violations.empty()) return violations.front().text();
  }
  for (const auto& move : test.moves) {
    if (move.station != 0 && !(test.lifts && move.station > 0)) continue;
    machines::Joints above = move.joints;
    above.linear_mm.z() += test.approach_mm;
    const auto violations = machine.chain.violations(above, machine.limit_margin);
    if (!violations.empty()) return violations.front().text();
  }
  return std::nullopt;
}

/// Nobody says how fast a block is that turns and moves.
bool lifts_between_stations(const machines::Machine& machine) {
  const controls::Control* control = controls::find(machine.dialect);
  return machine.tcp == machines::TcpMode::none && control != nullptr && !control->words.inverse_time;
}

SelfTest moved_through(const machines::Machine& machine, const Vec3& point, double tilt, double tool_length,
                       double tip_mm) {
  SelfTest test;
  test.point_mm = point;
  test.tool_length_mm = tool_length;
  test.approach_mm = 10;
  test.lifts = lifts_between_stations(machine);
  test.stations = stations_for(machine, tilt);
  test.tilt_rad = tilt;
  if (machine.post.transformation_takes_rotary_offset) {
    SelfTestStation station = test.stations.back();
    station.zero_deg = asking_zero_deg(machine.chain, point);
    station.remark +=
        fmt::format(", {} COUNTS FROM {:g}: NOTHING MOVES", machine.chain.rotary(0).letter, station.zero_deg);
    test.stations.push_back(std::move(station));
  }
  const double reach = swing(machine.chain, point, tool_length);
  // Joint-linear block that turns by w in all: the tip leaves its place by at most w^2 reach / 8, plus that of the
  // linear axes, which follow a curve of the same length and are replaced by its chord: the same again.
  const double widest = std::sqrt(4 * tip_mm / std::max(reach, 1e-3));
  Rotaries at = test.stations.front().rotary_rad;
  test.moves.push_back({machine.chain.linear_for(point, at, tool_length), 0});
  for (std::size_t s = 1; s < test.stations.size(); ++s) {
    const Rotaries& to = test.stations[s].rotary_rad;
    const double turn = std::abs(to[0] - at[0]) + std::abs(to[1] - at[1]);
    const int steps = std::max(1, static_cast<int>(std::ceil(turn / widest)));
    test.tip_bound_mm = std::max(test.tip_bound_mm, std::pow(turn / steps, 2) * reach / 4);
    for (int i = 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const Rotaries r = {at[0] + t * (to[0] - at[0]), at[1] + t * (to[1] - at[1])};
      test.moves.push_back(
          {machine.chain.linear_for(point, i == steps ? to : r, tool_length), i == steps ? static_cast<int>(s) : -1});
    }
    at = to;
  }
  return test;
}

}  // namespace

machines::Machine without_tcp(machines::Machine machine) {
  machine.tcp = machines::TcpMode::none;
  machine.post.transformation_takes_rotary_offset = false;  // of the transformation that is off
  return machine;
}

Result<SelfTest> plan_self_test(const machines::Machine& machine, const SelfTestOptions& options) {
  if (options.tool_length_mm && !(*options.tool_length_mm > 0))
    return fail("tool length {} mm of the test bar is not positive", *options.tool_length_mm);
  if (machine.chain.rotary_count() == 0)
    return fail("machine \"{}\" has no rotary axis: there is no pivot to test", machine.name);
  const std::vector<double> lengths =
      options.tool_length_mm ? std::vector{*options.tool_length_mm} : std::vector{100.0, 60.0, 30.0};
  std::string last;
  for (const double tilt_deg : {30.0, 20.0, 10.0, 5.0})
    for (const double length : lengths)
      for (const Vec3& point : points_for(machine, length)) {
        SelfTest test = moved_through(machine, point, std::min(radians(tilt_deg), options.largest_tilt_rad), length,
                                      options.tip_mm);
        const auto violation = first_violation(machine, test);
        if (!violation) return test;
        last = *violation;
      }
  std::string face;
  if (!machine.chain.table.empty())
    face = fmt::format("; the table's face is taken to be at Z = {:.4f}, {}", machine.table_middle_mm().z(),
                       machine.table_face_mm ? "limits.table_face"
                                             : fmt::format("axes.{}.point: if it is not, state limits.table_face",
                                                           machine.chain.table.front().letter));
  return fail_as(DiagnosticKind::verification,
                 "no point near the table can be kept with {:g} deg of tilt and a bar of {:g} mm: {}{}",
                 std::min(5.0, degrees(options.largest_tilt_rad)), lengths.back(), last, face);
}

}  // namespace toothpath::self_test
