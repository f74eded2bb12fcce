// Poles of five-axis kinematics, and the path of a tool between two blocks whose joints run linearly.
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/studies/stability_exact.h"
#include "app/studies/stability_rows.h"
#include "geometry/base/angle.h"

namespace toothpath::studies {
namespace {

constexpr double kStudiedToolLength = 120;  // mm
constexpr double kAxisAsLength = 100;       // mm: an error of the axis counts with this arm

machines::RotaryAxis rotary(char letter, const Vec3& direction, const Vec3& point) {
  machines::RotaryAxis axis;
  axis.letter = letter;
  axis.direction = direction;
  axis.point_mm = point;
  axis.min_rad = -100 * kPi, axis.max_rad = 100 * kPi, axis.max_speed = 100;
  return axis;
}

struct NamedChain {
  const char* name;
  machines::KinematicChain chain;
};

std::vector<NamedChain> chains() {
  const Vec3 on_c(1.5, -2.5, -40), on_tilt(3.25, 3.25, -47.5), pivot(0, 0, 180);
  std::vector<NamedChain> list(5);
  list[0].name = "C on A table";
  list[0].chain.table = {rotary('C', Vec3::UnitZ(), on_c), rotary('A', Vec3::UnitX(), on_tilt)};
  list[1].name = "C on B table";
  list[1].chain.table = {rotary('C', Vec3::UnitZ(), on_c), rotary('B', Vec3::UnitY(), on_tilt)};
  list[2].name = "C table, B head";
  list[2].chain.table = {rotary('C', Vec3::UnitZ(), on_c)};
  list[2].chain.head = {rotary('B', Vec3::UnitY(), pivot)};
  list[3].name = "C A head";
  list[3].chain.head = {rotary('C', Vec3::UnitZ(), pivot), rotary('A', Vec3::UnitX(), pivot)};
  list[4].name = "C on 45 deg table";
  list[4].chain.table = {rotary('C', Vec3::UnitZ(), on_c), rotary('B', Vec3(0, 1, 1).normalized(), on_tilt)};
  for (auto& named : list)
    for (auto& axis : named.chain.linear) axis = {-1e5, 1e5, 10000};
  return list;
}

/// Inverse at a tool axis `gap` away from the first rotary axis, then the joints carried out in 50 digits.
StabilityRow pole_row(const NamedChain& named, double gap) {
  StabilityRow row{"pole", fmt::format("{}, {:g} rad from the pole", named.name, gap)};
  row.condition = gap > 0 ? 1 / gap : 0;
  const Vec3 pole = named.chain.rotary(0).direction, across = pole.unitOrthogonal();
  const Vec3 aside = std::cos(0.7) * across + std::sin(0.7) * pole.cross(across);
  const machines::TablePose pose{Vec3(83, -41, 27), (std::cos(gap) * pole + std::sin(gap) * aside).normalized()};
  row.limit_mm = 1e-10;  // coordinates of some hundred mm, a turn by an angle of several rad
  const auto solutions = named.chain.inverse(pose, kStudiedToolLength);
  if (!solutions) {
    judge_refusal(row, Expected::accept, solutions.error().message);
    return row;
  }
  for (const auto& solution : *solutions) {
    const auto compared = exact_pose(named.chain, solution.joints, kStudiedToolLength, pose);
    const double worst = std::max(compared.position_mm, kAxisAsLength * compared.normal);
    row.error_mm = worst <= row.error_mm ? row.error_mm : worst;
    ++row.points;
    if (solution.free_rotary >= 0)
      row.reason =
          fmt::format("{} is free and reported so", named.chain.rotary(std::size_t(solution.free_rotary)).letter);
  }
  judge(row, 0);
  return row;
}

/// A tool axis that no angle reaches.
StabilityRow unreachable_row(const NamedChain& named) {
  StabilityRow row{"pole", fmt::format("{}, axis out of reach", named.name)};
  const auto solutions =
      named.chain.inverse({Vec3(10, 0, 0), Vec3(std::sin(2.0), 0, std::cos(2.0))}, kStudiedToolLength);
  judge_refusal(row, Expected::refuse, solutions ? "" : solutions.error().message);
  return row;
}

/// The tip between two blocks without tool centre control: how far it leaves the chord, in double, in 50 digits, and
/// the bound (w^2 R + 2 w dX)/8 that the axis program uses.
StabilityRow nonlinear_row(const char* name, const machines::KinematicChain& chain, const machines::Joints& from,
                           const machines::Joints& to) {
  constexpr int kSamples = 64;
  StabilityRow row{"non-linear error", name};
  const machines::TablePose a = chain.forward(from, kStudiedToolLength), b = chain.forward(to, kStudiedToolLength);
  const double w = std::abs(to.rotary_rad[0] - from.rotary_rad[0]) + std::abs(to.rotary_rad[1] - from.rotary_rad[1]);
  const double dx = (to.linear_mm - from.linear_mm).norm();
  double reach = 0, deviation = 0;
  for (int k = 0; k <= kSamples; ++k) {
    const double t = double(k) / kSamples;
    machines::Joints j;
    j.linear_mm = from.linear_mm + t * (to.linear_mm - from.linear_mm);
    for (std::size_t n = 0; n < 2; ++n)
      j.rotary_rad[n] = from.rotary_rad[n] + t * (to.rotary_rad[n] - from.rotary_rad[n]);
    const machines::TablePose at = chain.forward(j, kStudiedToolLength);
    for (std::size_t n = 0; n < chain.table.size(); ++n) {
      const Vec3 p = n == 0 ? at.tip_mm : chain.table_to_machine(at.tip_mm, j.rotary_rad);
      reach = std::max(reach, (p - chain.table[n].point_mm).cross(chain.table[n].direction).norm());
    }
    // Against the point of the chord at the same time: what the control leaves when nothing corrects it.
    deviation = std::max(deviation, (at.tip_mm - (a.tip_mm + t * (b.tip_mm - a.tip_mm))).norm());
    const auto compared = exact_pose(chain, j, kStudiedToolLength, at);
    row.error_mm = std::max(row.error_mm, compared.position_mm);
    ++row.points;
  }
  const double bound = (w * w * (reach + 0.5 * (dx + w * reach)) + 2 * w * dx) / 8;
  row.limit_mm = 1e-10;
  judge(row, 0);
  const auto text = fmt::format("leaves the chord by {:.4f} um, bound {:.4f} um", deviation * 1000, bound * 1000);
  if (!(deviation <= bound * (1 + 64 * kEps))) row.fine = false, row.verdict = "FAIL";
  row.reason = text;
  return row;
}

}  // namespace

std::vector<StabilityRow> kinematics_rows() {
  std::vector<StabilityRow> rows;
  const auto list = chains();
  for (const auto& named : list)
    for (const double gap : {0.0, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.5}) rows.push_back(pole_row(named, gap));
  rows.push_back(unreachable_row(list.back()));

  const machines::KinematicChain& chain = list.front().chain;
  struct Turn {
    double radius, degrees;
  };
  for (const auto& [radius, angle] : {Turn{100, 1}, {100, 2}, {100, 5}, {450, 1}}) {
    machines::Joints from, to;  // the tip stands still in the machine, the table turns below it
    from.linear_mm = to.linear_mm = Vec3(chain.table[0].point_mm.x() + radius, chain.table[0].point_mm.y(), 50);
    to.rotary_rad[0] = radians(angle);
    rows.push_back(
        nonlinear_row(fmt::format("pure turn of {:g} deg, R = {:g} mm", angle, radius).c_str(), chain, from, to));
  }
  machines::Joints from, to;
  from.linear_mm = Vec3(80, 10, 60), from.rotary_rad = {0.3, radians(40)};
  to.linear_mm = Vec3(84, 12, 59), to.rotary_rad = {0.3 + radians(3), radians(41)};
  rows.push_back(nonlinear_row("both axes and 4.6 mm of travel", chain, from, to));
  const machines::KinematicChain& nutating = list.back().chain;
  rows.push_back(nonlinear_row("the same on the 45 deg table", nutating, from, to));
  return rows;
}

}  // namespace toothpath::studies
