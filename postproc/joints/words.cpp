#include "postproc/joints/words.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::joints {
namespace {

constexpr double kAlongAxis = 1e-12;  // 1 - cosine
constexpr double kRoundOff = 1e-9;    // mm
constexpr double kWholeWord = 1e-9;   // deg

}  // namespace

std::int64_t AxisWords::rotary_word(double angle_rad) const {
  return numbers::to_fixed(degrees(angle_rad), format_.rotary_decimals);
}

double AxisWords::word_angle(std::int64_t word) const {
  return radians(static_cast<double>(word) / static_cast<double>(numbers::power_of_ten(format_.rotary_decimals)));
}

RotaryPair AxisWords::rounded(const RotaryPair& a) const {
  return {chain_.rotary_count() > 0 ? word_angle(rotary_word(a[0])) : 0,
          chain_.rotary_count() > 1 ? word_angle(rotary_word(a[1])) : 0};
}

/// In a plane its axes are those of the machine: its words differ from the joints by where its origin has been turned
/// to.
Vec3 AxisWords::zero(const AxisBlock& at) const {
  if (!planes_ || !planes_->tilted(at.words)) return offset_;
  return chain_.table_to_machine(offset_ + planes_->origin_mm, rotaries(at));
}

std::int64_t AxisWords::joint_word(double joint_mm, int axis, const AxisBlock& at) const {
  return numbers::to_fixed(joint_mm - zero(at)[axis] - (axis == 2 ? length_ : 0), format_.linear_decimals);
}

std::int64_t AxisWords::top_word(double joint_mm, const AxisBlock& at) const {
  const std::int64_t nearest = joint_word(joint_mm, 2, at);
  if (!planes_ || !planes_->tilted(at.words)) return nearest;
  const double unit = static_cast<double>(numbers::power_of_ten(format_.linear_decimals));
  return static_cast<double>(nearest) / unit > joint_mm - zero(at).z() - length_ + kRoundOff ? nearest - 1 : nearest;
}

AxisBlock AxisWords::turned(const AxisBlock& b, const std::array<std::int64_t, 2>& rotary_words) const {
  AxisBlock out = b;
  std::copy(rotary_words.begin(), rotary_words.end(), out.words.begin() + 3);
  if (!planes_) return out;
  const Vec3 linear = joints(b).linear_mm;
  for (int i = 0; i < 2; ++i) out.words[static_cast<std::size_t>(i)] = joint_word(linear[i], i, out);
  out.words[2] = top_word(linear.z(), out);
  return out;
}

std::int64_t AxisWords::tip_word(double tip_mm, int axis) const {
  return numbers::to_fixed(tip_mm - offset_[axis], format_.linear_decimals);
}

void AxisWords::set_rotaries(AxisBlock& b, const RotaryPair& rotaries) const {
  for (std::size_t k = 0; k < chain_.rotary_count(); ++k) b.words[3 + k] = rotary_word(rotaries[k]);
}

RotaryPair AxisWords::rotaries(const AxisBlock& b) const {
  RotaryPair out{};
  for (std::size_t k = 0; k < chain_.rotary_count(); ++k) out[k] = word_angle(b.words[3 + k]);
  return out;
}

void AxisWords::set_joints(AxisBlock& b, const Vec3& linear_mm, const RotaryPair& rotaries) const {
  set_rotaries(b, rotaries);
  for (int i = 0; i < 3; ++i) b.words[static_cast<std::size_t>(i)] = joint_word(linear_mm[i], i, b);
  b.tip = false;
}

void AxisWords::set_tip(AxisBlock& b, const Vec3& tip_mm, const RotaryPair& rotaries) const {
  for (int i = 0; i < 3; ++i) b.words[static_cast<std::size_t>(i)] = tip_word(tip_mm[i], i);
  set_rotaries(b, rotaries);
  b.tip = true;
}

machines::Joints AxisWords::joints(const AxisBlock& b) const {
  if (b.tip) return chain_.linear_for(tip(b), rotaries(b), length_);
  machines::Joints j;
  const double unit = static_cast<double>(numbers::power_of_ten(format_.linear_decimals));
  const Vec3 from = zero(b);
  for (int i = 0; i < 3; ++i)
    j.linear_mm[i] =
        static_cast<double>(b.words[static_cast<std::size_t>(i)]) / unit + from[i] + (i == 2 ? length_ : 0);
  j.rotary_rad = rotaries(b);
  return j;
}

Vec3 AxisWords::tip(const AxisBlock& b) const {
  if (!b.tip) return chain_.forward(joints(b), length_).tip_mm;
  const double unit = static_cast<double>(numbers::power_of_ten(format_.linear_decimals));
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = static_cast<double>(b.words[static_cast<std::size_t>(i)]) / unit + offset_[i];
  return p;
}

double AxisWords::linear_rounding() const { return 0.5 * std::sqrt(3.0) * std::pow(10.0, -format_.linear_decimals); }

double AxisWords::rotary_step() const { return radians(std::pow(10.0, -format_.rotary_decimals)); }

Result<PlaneForm> plane_form_of(const machines::KinematicChain& chain, const WordFormat& format) {
  const auto along = [](const Vec3& d, int axis) { return std::abs(std::abs(d[axis]) - 1) <= kAlongAxis; };
  const bool fits = chain.head.empty() && chain.table.size() == 2 && along(chain.table[0].direction, 2) &&
                    (along(chain.table[1].direction, 0) || along(chain.table[1].direction, 1));
  if (!fits) return fail("they need a table with two rotaries, one about Z that carries the work, one about X or Y");
  PlaneForm out;
  out.about_y = along(chain.table[1].direction, 1);
  const auto sense = [](const machines::RotaryAxis& axis, int i) {
    return axis.direction[i] > 0 ? axis.sign : -axis.sign;
  };
  out.turn_sign = sense(chain.table[0], 2);
  out.tilt_sign = sense(chain.table[1], out.about_y ? 1 : 0);
  for (std::size_t k = 0; k < 2; ++k) {
    const double zero = degrees(chain.table[k].zero_rad);
    out.zero[k] = numbers::to_fixed(zero, format.rotary_decimals);
    if (std::abs(zero - static_cast<double>(out.zero[k]) /
                            static_cast<double>(numbers::power_of_ten(format.rotary_decimals))) > kWholeWord)
      return fail("zero of {} is {} deg, which {} digits do not hold", chain.table[k].letter, zero,
                  format.rotary_decimals);
  }
  return out;
}

}  // namespace toothpath::joints
