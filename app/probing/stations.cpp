#include "app/probing/stations.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::probing {
namespace {

constexpr double kAboveTops = 5;      // mm, of the clear height
constexpr double kUpright = 1e-9;     // of the spindle, rad
constexpr double kLastDigit = 1e-4;   // deg, of a rotary's word
constexpr double kOverhead = -0.999;  // cosine: the part looks away

using Angles = std::array<double, 2>;

Angles zeros(const machines::KinematicChain& chain) {
  Angles out{};
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) out[k] = chain.rotary(k).zero_rad;
  return out;
}

bool upright(const machines::KinematicChain& chain, const Angles& at) {
  return (chain.tool_axis_in_machine(at) - Vec3::UnitZ()).norm() < kUpright;
}

/// The angles of one pair that give the tool this axis, within the travels and near their zeros.
std::optional<Angles> angles_of(const machines::Machine& machine, const Vec3& axis, int pair) {
  const auto found = machine.chain.rotary_solutions(axis);
  if (!found) return {};
  for (const machines::JointSolution& solution : *found) {
    if (solution.pair != pair) continue;
    Angles out{};
    bool inside = true;
    for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) {
      const auto& rotary = machine.chain.rotary(k);
      const auto turns = machines::windings(rotary, solution.joints.rotary_rad[k], machine.limit_margin.rotary_rad);
      const auto nearest = std::min_element(turns.begin(), turns.end(), [&](double a, double b) {
        return std::abs(a - rotary.zero_rad) < std::abs(b - rotary.zero_rad);
      });
      inside = inside && nearest != turns.end();
      if (inside) out[k] = radians(std::round(degrees(*nearest) / kLastDigit) * kLastDigit);
    }
    if (inside) return out;
  }
  return {};
}

}  // namespace

Result<Stations> Stations::make(const inspection::TouchPlan& plan, const joints::Setup& setup,
                                const machines::Machine& machine) {
  Stations out(setup, machine);
  const machines::KinematicChain& chain = machine.chain;
  const Angles zero = zeros(chain);
  const Vec3 spindle = chain.forward({Vec3::Zero(), zero}, 1.0).axis;
  const auto axis_of = [&](const inspection::Touch& touch) -> Vec3 { return setup.rotation() * touch.up; };
  const auto stands = [&](const inspection::Touch& t) { return (axis_of(t) - spindle).norm() < kUpright; };
  if (std::all_of(plan.touches.begin(), plan.touches.end(), stands)) {
    if (!upright(chain, zero))
      return fail("with all rotaries at zero the spindle does not stand along Z: no way to probe");
    out.rotary_rad_.assign(plan.touches.size(), zero);
    return out;
  }
  if (axis_of(plan.touches.front()).dot(spindle) < kOverhead)
    return fail("the teeth look away from the spindle (axis = \"down\"): a probe does not reach them");
  for (const int pair : {1, 2}) {
    out.rotary_rad_.clear();
    for (const inspection::Touch& touch : plan.touches)
      if (const auto angles = angles_of(machine, axis_of(touch), pair)) out.rotary_rad_.push_back(*angles);
    if (out.rotary_rad_.size() < plan.touches.size()) continue;
    if (std::all_of(out.rotary_rad_.begin(), out.rotary_rad_.end(), [&](const Angles& a) { return upright(chain, a); }))
      return out;
    return fail("the spindle would stand aslant: a probe is led along Z, and a head that swings turns it away");
  }
  const inspection::Touch& first = plan.touches.front();
  return fail(
      "no rotary angles within the travels set the stem of the probe upright for touch {}: its direction is "
      "({:.4f}, {:.4f}, {:.4f}) on the table",
      first.number, axis_of(first).x(), axis_of(first).y(), axis_of(first).z());
}

Vec3 Stations::in_work_offset(int number, const Vec3& p) const {
  return machine_.chain.table_to_machine(setup_.origin_mm + setup_.rotation() * p,
                                         rotary_rad_[std::size_t(number - 1)]) -
         setup_.work_offset_at_mm;
}

Vec3 Stations::in_gear(int number, const Vec3& w) const {
  constexpr double kLength = 1;  // the spindle is upright: it falls out
  const Vec3 gauge = w + setup_.work_offset_at_mm + Vec3(0, 0, kLength);
  const Vec3 tip = machine_.chain.forward({gauge, rotary_rad_[std::size_t(number - 1)]}, kLength).tip_mm;
  return setup_.rotation().transpose() * (tip - setup_.origin_mm);
}

Status Stations::holds(const Vec3& in_work, const ProbeTouch& touch, double length) const {
  const Vec3 gauge = in_work + setup_.work_offset_at_mm + Vec3(0, 0, length);
  const auto beyond =
      machine_.chain.violations({gauge, rotary_rad_[std::size_t(touch.number - 1)]}, machine_.limit_margin);
  if (beyond.empty()) return Ok{};
  return fail("touch {}: the gauge point would stand beyond the travels, {}", touch.number, beyond.front().text());
}

/// The part lies in a cylinder about its axis, which leans as the table does.
double Stations::clear(const inspection::TouchPlan& plan, double ball_mm) const {
  double highest = -INFINITY;
  for (const auto& touch : plan.touches) {
    const Vec3 origin = in_work_offset(touch.number, Vec3::Zero());
    const Vec3 axis = in_work_offset(touch.number, Vec3::UnitZ()) - origin;
    const auto& reach = plan.reach;
    highest = std::max(highest, origin.z() + std::max(reach.low_mm * axis.z(), reach.high_mm * axis.z()) +
                                    reach.radius_mm * std::hypot(axis.x(), axis.y()));
  }
  return highest + kAboveTops + 0.5 * ball_mm;
}

Status Stations::place(const inspection::TouchPlan& plan, ProbeProgram& program) const {
  program.top_mm = machine_.chain.linear[2].max_mm - machine_.limit_margin.linear_mm;
  program.clear_mm = clear(plan, program.ball_diameter_mm);
  for (const auto& t : plan.touches) {
    ProbeTouch touch;
    touch.number = t.number;
    touch.remark = t.remark;
    touch.start = in_work_offset(t.number, t.start());
    touch.meets = in_work_offset(t.number, t.centre);
    touch.past = in_work_offset(t.number, t.centre - kBeyondTouch * t.normal);
    for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k)
      touch.rotaries.emplace_back(machine_.chain.rotary(k).letter, degrees(rotary_rad_[std::size_t(t.number - 1)][k]));
    // A cycle looks as far behind the place as the way to it is long.
    const Vec3 behind = 2 * touch.meets - touch.start;
    for (const Vec3& at : {touch.start, touch.past, behind, Vec3(touch.start.x(), touch.start.y(), program.clear_mm)})
      if (const auto inside = holds(at, touch, program.probe_length_mm); !inside) return inside.error();
    program.touches.push_back(std::move(touch));
  }
  return Ok{};
}

}  // namespace toothpath::probing
