// The way of one tooth followed beside that of another: where they go alike, and how far they are apart.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cam/path/tool_motion.h"
#include "cam/proof/like_motion.h"

namespace toothpath::proof {

/// Follows a way beside another one, motion by motion. Wherever either is cut, the nearest place of the other is taken;
/// from one such place to the next both go straight.
class Beside {
 public:
  /// @param motions, path  the other way: cutting motions by their number, in order. Both must outlive this.
  /// @param turn  about the gear axis, from the way that is followed to the other one, rad
  Beside(std::span<const path::ToolMotion> motions, const std::vector<std::uint32_t>& path, double turn);

  /// The next motion of the way that is followed, number k of its list; nothing where the other one does not go within
  /// 0.1 mm of it, up to a metre from the tip.
  std::optional<LikeMotion> next(const path::ToolMotion& m, std::uint32_t k);
  /// Is this motion on the other way, wherever and in whatever order? All of that is looked through up to `looks`
  /// times; how often it was is taken off. Nothing is farther than 0.1 mm from it then; the least distances that were
  /// found are those of below.
  bool anywhere(const path::ToolMotion& m, std::size_t& looks);

  /// How far the two ways are apart along the motion asked last, at most: tips mm, axes rad.
  [[nodiscard]] double tip_mm() const { return tip_; }
  [[nodiscard]] double axis_rad() const;
  /// The motion of the other way, by its number in `motions`, where the last like motion ended; the first one before
  /// there was any.
  [[nodiscard]] std::uint32_t stands_at() const { return path_[stood_]; }

 private:
  struct Pose {
    Vec3 tip, axis;
  };
  static Pose between(const Pose& a, const Pose& b, double t);
  static double apart_squared(const Pose& a, const Pose& b);
  /// Share of the line between two poses that is nearest to another.
  static double share(const Pose& a, const Pose& b, const Pose& x);
  [[nodiscard]] Pose on(std::size_t n, const Pose& x) const;
  static bool turns_wide(const path::ToolMotion& m);
  void note(const Pose& a, const Pose& b);
  /// Notes how far m, from a to b, is from the motions [from, to] of the path; is it like them?
  bool follow(const path::ToolMotion& m, const Pose& a, const Pose& b, std::size_t from, std::size_t to);
  bool cover(const Pose& a, const Pose& b, int halvings, std::size_t& looks);
  /// Off the motion n of the other way, squared.
  [[nodiscard]] double off_squared(const Pose& x, std::size_t n) const;
  /// The motion of the path that comes nearest, of `count` from `first` on, where it is near; past it no other is
  /// looked for.
  [[nodiscard]] std::size_t nearest(const Pose& x, std::size_t first, std::size_t count) const;
  [[nodiscard]] Vec3 back(const Vec3& v) const { return {c_ * v.x() - s_ * v.y(), s_ * v.x() + c_ * v.y(), v.z()}; }

  std::span<const path::ToolMotion> motions_;
  const std::vector<std::uint32_t>& path_;
  double c_, s_;
  std::size_t at_ = 0, stood_ = 0;  ///< of the path: where the next one is looked for, where the last like one ended
  int searches_;                    ///< that are left
  int wait_ = 0, next_wait_ = 0;    ///< motions until the next of them, and from there to the one after
  std::uint32_t number_ = 0;        ///< of the last motion
  double tip_ = 0, axis_ = 0;       ///< how far the places taken are apart, at most
};

}  // namespace toothpath::proof
