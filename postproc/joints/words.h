// Between the integers that are printed and the joints of the machine: rounding, work offset, tool length, and the two
// meanings of the linear words (joints, or with TCP the tip in the table frame).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "postproc/choice/solution.h"
#include "postproc/joints/program.h"

namespace toothpath::joints {

using choice::RotaryPair;

class AxisWords {
 public:
  AxisWords(const machines::KinematicChain& chain, const WordFormat& format, const Vec3& work_offset_mm)
      : chain_(chain), format_(format), offset_(work_offset_mm) {}

  void set_length(double mm) { length_ = mm; }
  /// Words of blocks that are tilted count in their plane from now on.
  void set_planes(const std::optional<PlaneForm>& planes) { planes_ = planes; }
  [[nodiscard]] double length() const { return length_; }

  [[nodiscard]] std::int64_t rotary_word(double angle_rad) const;
  [[nodiscard]] double word_angle(std::int64_t word) const;
  /// Angles as they are printed.
  [[nodiscard]] RotaryPair rounded(const RotaryPair& angles) const;
  /// Word of a joint (axis 0 to 2), machine coordinates of the gauge point, with the rotaries of this block.
  [[nodiscard]] std::int64_t joint_word(double joint_mm, int axis, const AxisBlock& at) const;
  /// Word of Z, at most this joint where the block stands in a plane, whose words are not those of the joints.
  [[nodiscard]] std::int64_t top_word(double joint_mm, const AxisBlock& at) const;
  /// The block with these words of the rotaries; the linear joints stay, Z not higher than it was.
  [[nodiscard]] AxisBlock turned(const AxisBlock& b, const std::array<std::int64_t, 2>& rotary_words) const;
  /// Word of a coordinate of the tip, table frame.
  [[nodiscard]] std::int64_t tip_word(double tip_mm, int axis) const;

  void set_joints(AxisBlock& b, const Vec3& linear_mm, const RotaryPair& rotaries) const;
  void set_tip(AxisBlock& b, const Vec3& tip_mm, const RotaryPair& rotaries) const;
  /// Joints at the end of a block, whatever its linear words mean.
  [[nodiscard]] machines::Joints joints(const AxisBlock& b) const;
  /// Tip at the end of a block, table frame.
  [[nodiscard]] Vec3 tip(const AxisBlock& b) const;

  /// Half a unit of the last linear digit in every coordinate [mm].
  [[nodiscard]] double linear_rounding() const;
  /// One unit of the last rotary digit [rad].
  [[nodiscard]] double rotary_step() const;

 private:
  /// Where the linear words of the tip are 0, machine coordinates.
  [[nodiscard]] Vec3 zero(const AxisBlock& at) const;
  void set_rotaries(AxisBlock& b, const RotaryPair& rotaries) const;
  [[nodiscard]] RotaryPair rotaries(const AxisBlock& b) const;

  const machines::KinematicChain& chain_;
  WordFormat format_;
  Vec3 offset_;
  double length_ = 0;
  std::optional<PlaneForm> planes_;
};

}  // namespace toothpath::joints
