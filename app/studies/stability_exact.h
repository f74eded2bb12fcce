// The same kernels in 50 digits: what the double results of the stability study are measured against. The only place of
// the program that compiles multiprecision arithmetic.
#pragma once

#include <memory>
#include <optional>

#include "geometry/bevel_gear/gear.h"
#include "geometry/face_gear/inverse.h"
#include "machines/kinematic_chain.h"

namespace toothpath::studies {

/// Double against 50 digits at one point; lengths mm.
struct ExactComparison {
  double position_mm = 0;  ///< distance of the two points
  double normal = 0;       ///< distance of the two unit normals
  double condition =
      0;             ///< singular values of d(r, z)/d(r_b theta, r B): largest over smallest; 0 where it does not apply
  double J = 0;      ///< regularity in 50 digits
  double theta = 0;  ///< of the exact solution
};

/// A face gear ring in 50 digits, from the same double parameters.
class ExactFaceGear {
 public:
  ExactFaceGear(const face_gear::FaceGearParameters& gear, double helix_angle_rad);
  ~ExactFaceGear();
  ExactFaceGear(ExactFaceGear&&) noexcept;
  ExactFaceGear& operator=(ExactFaceGear&&) = delete;

  /// The closed form at the same (theta, B).
  [[nodiscard]] ExactComparison kernel(const face_gear::FaceGearSurface<double>& surface, int side, double theta,
                                       double B) const;
  /// The point of the flank at exactly (r, z), by Newton in 50 digits from `found`; nothing where it does not arrive.
  /// `position_mm` compares it with the double point at `found`, in space.
  [[nodiscard]] std::optional<ExactComparison> inverse(const face_gear::FaceGearSurface<double>& surface, int side,
                                                       double r, double z,
                                                       const face_gear::FlankCoordinates& found) const;
  /// How far the flank point at `found`, taken in 50 digits, lies from (r, z). At a fold (r, z) rounded to double may
  /// lie beyond the flank, where there is nothing to compare positions with: this is what can still be asked.
  [[nodiscard]] double residual_mm(int side, double r, double z, const face_gear::FlankCoordinates& found) const;
  /// The fillet point at normal angle A whose radius is exactly r; `Z` is the double solution.
  [[nodiscard]] std::optional<ExactComparison> fillet(const face_gear::FaceGearSurface<double>& surface, int side,
                                                      double A, double r, double Z) const;
  /// Radius of the cusp (J = 0 at theta_t) minus `radius` [mm], by secant from `B`.
  [[nodiscard]] std::optional<double> undercut_error(int side, double B, double radius) const;
  /// Arc thickness on the tip surface at r minus `land` [mm]; `plus` and `minus` start the search of both flanks.
  [[nodiscard]] std::optional<double> land_minus(double r, double land, const face_gear::FlankCoordinates& plus,
                                                 const face_gear::FlankCoordinates& minus) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A wall point of a bevel gear at the same (beta, p), trace and profile in 50 digits.
[[nodiscard]] ExactComparison exact_bevel_point(const bevel_gear::BevelGear& gear,
                                                const bevel_gear::BevelWall<double>& wall, double beta, double p);

/// Where these joints really put the tool, compared with the pose wanted: distance of the tips, distance of the unit
/// axes.
[[nodiscard]] ExactComparison exact_pose(const machines::KinematicChain& chain, const machines::Joints& joints,
                                         double tool_length_mm, const machines::TablePose& wanted);

}  // namespace toothpath::studies
