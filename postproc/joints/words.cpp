#include "postproc/joints/words.h"

#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::joints {

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

std::int64_t AxisWords::joint_word(double joint_mm, int axis) const {
  return numbers::to_fixed(joint_mm - offset_[axis] - (axis == 2 ? length_ : 0), format_.linear_decimals);
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
  for (int i = 0; i < 3; ++i) b.words[static_cast<std::size_t>(i)] = joint_word(linear_mm[i], i);
  set_rotaries(b, rotaries);
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
  for (int i = 0; i < 3; ++i)
    j.linear_mm[i] =
        static_cast<double>(b.words[static_cast<std::size_t>(i)]) / unit + offset_[i] + (i == 2 ? length_ : 0);
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

}  // namespace toothpath::joints
