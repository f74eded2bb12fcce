// Motion along a straight stretch: speed up, run, slow down. Acceleration is zero at both ends where a jerk is stated.
//
// Units are free as long as they are one set: length L, time T; speeds L/T, accelerations L/T^2, jerks L/T^3.
// Source: L. Biagiotti, C. Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008, 3.2 and 3.4.
#pragma once

#include <array>
#include <cstddef>

namespace toothpath::timing {

/// What a stretch allows. `jerk` = 0: none stated, the acceleration is there at once.
struct Limits {
  double speed = 0;         ///< > 0
  double acceleration = 0;  ///< > 0, infinity: speeds change at once
  double jerk = 0;          ///< >= 0
};

/// Time in which the speed changes by `change` >= 0.
[[nodiscard]] double ramp_time(double change, const Limits& limits);

/// Way on which the speed changes from one to the other.
[[nodiscard]] double ramp_length(double from, double to, const Limits& limits);

/// Greatest speed that can be had from `from` after `length`; limits.speed is not looked at.
[[nodiscard]] double reachable(double from, double length, const Limits& limits);

/// The quickest motion over `length` > 0 that enters with `from` and leaves with `to`, both at most limits.speed and
/// each reachable from the other.
class Profile {
 public:
  Profile(double length, double from, double to, const Limits& limits);

  [[nodiscard]] double time() const { return time_; }
  /// Greatest speed.
  [[nodiscard]] double peak() const { return peak_; }
  /// When the place at `way` from the beginning is passed, 0 <= way <= length.
  [[nodiscard]] double time_at(double way) const;

 private:
  /// Constant jerk.
  struct Phase {
    double time = 0, jerk = 0, acceleration = 0, speed = 0;  ///< the last three where it begins
    [[nodiscard]] double way(double t) const { return t * (speed + t * (0.5 * acceleration + t * jerk / 6)); }
  };
  void add_ramp(double from, double to, const Limits& limits);

  double time_ = 0, peak_ = 0;
  std::array<Phase, 7> phases_{};
  std::size_t count_ = 0;
};

}  // namespace toothpath::timing
