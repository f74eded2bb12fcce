// A machine as it truly stands: the chain of its file, and by how much its parts are beside where the file says. The
// control knows the file only, so that joints come from the chain and the tool stands where this says.
//
// What is touched off: with all rotaries commanded to their zeros, the tip of every tool truly stands at one point of
// the part where the control believes it there. Offsets of any part of the machine are so taken out at that point, and
// nowhere else. The part is fixed to the true table, straight along its axes.
#pragma once

#include <array>

#include "machines/kinematic_chain.h"

namespace toothpath::machines {

/// Of one rotary axis. Angles are those of the motion, in the sense of `RotaryAxis::rotation`.
struct RotaryErrors {
  Vec3 point_mm = Vec3::Zero();  ///< the axis runs so far beside its point
  Vec3 tilt_rad = Vec3::Zero();  ///< small turn of its direction; across the direction
  double zero_rad = 0;           ///< it stands further by this,
  double scale = 0;              ///< by this share of its way from its zero,
  double wave_rad = 0;           ///< and by wave (sin(angle + phase) - sin(phase)): once a turn
  double wave_phase_rad = 0;
  [[nodiscard]] double added_rad(double angle_rad) const;
};

/// Errors of a machine. All zero: the chain itself.
struct MachineErrors {
  std::array<RotaryErrors, 2> rotary{};  ///< by `KinematicChain::rotary(k)`
  double square_xy_rad = 0;              ///< a way dy along Y moves X by this times dy, too
  double square_xz_rad = 0;              ///< a way dz along Z moves X
  double square_yz_rad = 0;              ///< a way dz along Z moves Y
  Vec3 spindle_tilt_rad = Vec3::Zero();  ///< small turn of the spindle about the gauge point; z is not used
};

class RealMachine {
 public:
  /// @param touched_mm  where tools are touched off: machine coordinates, all rotaries at zero
  RealMachine(const KinematicChain& chain, const MachineErrors& errors, const Vec3& touched_mm);

  /// A tool as the machine has it, touched off.
  struct Tool {
    double length_mm = 0;          ///< true: gauge point to tip
    Vec3 at_mm = Vec3::Zero();     ///< X Y Z where the control stood at the touched point
    Vec3 shift_mm = Vec3::Zero();  ///< what touching off took out, in X Y Z
  };
  /// @param length_mm  that the control knows, > 0;  @param error_mm  the tool is longer by this than when touched off
  [[nodiscard]] Tool touched_off(double length_mm, double error_mm) const;

  /// Tip and axis over the part, in the table frame. Without errors the bits of `KinematicChain::forward`.
  /// @param joints  as commanded
  [[nodiscard]] TablePose forward(const Joints& joints, const Tool& tool) const;

 private:
  [[nodiscard]] Mat3 turned(std::size_t k, double command_rad) const;

  KinematicChain chain_;  ///< points and directions as they truly are
  const KinematicChain& stated_;
  MachineErrors errors_;
  Vec3 touched_mm_, spindle_;
};

}  // namespace toothpath::machines
