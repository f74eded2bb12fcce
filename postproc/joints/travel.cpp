#include "postproc/joints/travel.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::joints {
namespace {
constexpr std::size_t kListed = 3;
constexpr double kStill = 1e-9;  // a joint that a shift of the set-up moves by less per mm is not moved
}  // namespace

void TravelRecord::note(const machines::Joints& joints, bool moves_with_part, int operation, int record, int tooth,
                        const machines::KinematicChain& chain, const machines::LimitMargin& margin) {
  for (std::size_t i = 0; i < 5; ++i) {
    const double v = i < 3 ? joints.linear_mm[static_cast<int>(i)] : joints.rotary_rad[i - 3];
    least_[i] = std::min(least_[i], v);
    greatest_[i] = std::max(greatest_[i], v);
  }
  for (const auto& violation : chain.violations(joints, margin)) {
    rotary_outside_ = rotary_outside_ || violation.rotary;
    ++count_;
    if (first_.size() == kListed) continue;
    std::string text = fmt::format("operation {} record {} (tooth {}): {}", operation, record, tooth, violation.text());
    if (first_.empty() || first_.back() != text) first_.push_back(std::move(text));  // a record may take two blocks
  }
  if (!moves_with_part) return;
  if (poses_ != nullptr) poses_->note(joints);
  const Vec3 zero = chain.table_to_machine(Vec3::Zero(), joints.rotary_rad);
  for (int m = 0; m < 3; ++m) {
    const Vec3 moved = chain.table_to_machine(Vec3::Unit(m), joints.rotary_rad) - zero;
    const auto s = static_cast<std::size_t>(m);
    for (int i = 0; i < 3; ++i) {
      const machines::LinearAxis& axis = chain.linear[static_cast<std::size_t>(i)];
      double low = axis.min_mm + margin.linear_mm - joints.linear_mm[i];
      double high = axis.max_mm - margin.linear_mm - joints.linear_mm[i];
      if (std::abs(moved[i]) < kStill) {
        if (low > 1e-9 || high < -1e-9) shift_low_[s] = kFar;
        continue;
      }
      low /= moved[i];
      high /= moved[i];
      if (low > high) std::swap(low, high);
      shift_low_[s] = std::max(shift_low_[s], low);
      shift_high_[s] = std::min(shift_high_[s], high);
    }
  }
}

std::optional<double> TravelRecord::shift_that_fits(int m) const {
  const auto s = static_cast<std::size_t>(m);
  if (rotary_outside_ || shift_low_[s] > shift_high_[s]) return std::nullopt;
  if (shift_low_[s] <= 0 && shift_high_[s] >= 0) return 0.0;
  return shift_low_[s] > 0 ? shift_low_[s] : shift_high_[s];
}

std::optional<Diagnostic> check_travel(AxisProgram& program, const machines::Machine& machine,
                                       const TravelRecord& record) {
  const machines::KinematicChain& chain = machine.chain;
  program.ranges.clear();
  for (std::size_t i = 0; i < 3 + chain.rotary_count(); ++i) {
    AxisRange r;
    r.letter = program.letters[i];
    r.rotary = i >= 3;
    r.min = record.least()[i];
    r.max = record.greatest()[i];
    r.lower_limit = i < 3 ? chain.linear[i].min_mm : chain.rotary(i - 3).min_rad;
    r.upper_limit = i < 3 ? chain.linear[i].max_mm : chain.rotary(i - 3).max_rad;
    if (i == 2) r.max = std::max(r.max, program.retract_z_mm);
    if (program.loop && static_cast<int>(i) == program.index_axis)
      (program.index_sign > 0 ? r.max : r.min) += program.index_sign * 2 * kPi * (program.teeth - 1) / program.teeth;
    program.ranges.push_back(r);
  }
  if (record.violation_count() == 0) return std::nullopt;
  std::string text;
  for (const auto& v : record.first_violations()) text += (text.empty() ? "" : "; ") + v;
  if (record.violation_count() > record.first_violations().size())
    text += fmt::format("; and {} more", record.violation_count() - record.first_violations().size());
  std::string shifts;
  for (const int m : {2, 0, 1}) {
    if (program.loop && m != 2) continue;  // the gear would leave the axis that turns it
    if (const auto s = record.shift_that_fits(m)) {
      const double rounded = (*s > 0 ? std::ceil(*s * 1e4) : std::floor(*s * 1e4)) / 1e4;
      shifts += fmt::format("{}{} {:+.4f}", shifts.empty() ? "" : " or ", "XYZ"[m], rounded);
    }
  }
  text += shifts.empty() ? " (no shift of the set-up alone fits)" : fmt::format(" (set-up origin {} fits)", shifts);
  return fail_as(DiagnosticKind::verification, "{}", text);
}

}  // namespace toothpath::joints
