// Tooth forces of the equal-base-circle bevel gear, for one hand and for the herringbone.
//
// F_a is positive away from the apex, F_r towards the axis. sigma is the loaded wall (+1 L: the mesh turns the member
// towards -azimuth). Only the spiral part, with tan(beta), changes its sign with the hand and can cancel between the
// halves; the part of the pressure angle never does. How the torque is shared between the halves is statically
// indeterminate, so every result belongs to one LoadSplit. mm, rad, N, N mm. Derivation: docs/bevel_gear.md,
// section 11.
#pragma once

#include <optional>
#include <vector>

namespace toothpath::bevel_gear {

/// What the forces of one member depend on besides the face.
struct BevelForceMember {
  double alpha_n_rad = 0;
  double delta_rad = 0;  ///< pitch angle of this member
  double R_0 = 0;        ///< end of the trace, common to both members
};

/// Force on a member; axial and radial apart by origin.
struct BevelForce {
  double tangential = 0;                        ///< size, >= 0
  double axial_pressure = 0, axial_spiral = 0;  ///< tan(alpha) sin(delta)/cos(beta) and sigma h tan(beta) cos(delta)
  double radial_pressure = 0, radial_spiral = 0;
  [[nodiscard]] double axial() const { return axial_pressure + axial_spiral; }
  [[nodiscard]] double radial() const { return radial_pressure + radial_spiral; }
  BevelForce& operator+=(const BevelForce& other);
};

/// Part of the face that carries load, with its hand.
struct LoadedFace {
  double from = 0, to = 0;  ///< cone distances
  int h = 1;
};

enum class LoadSplit {
  line_load,          ///< dF_t/dR constant over all loaded faces, integrated
  line_load_middles,  ///< the same shares, but every half taken at the middle of its face
  equal_torque,       ///< every half carries the same torque, taken at the middle of its face
};

/// Force of a torque [N mm, >= 0] that is transmitted at one cone distance R, 0 < R <= R_0, on wall sigma of hand h.
[[nodiscard]] BevelForce bevel_point_force(const BevelForceMember& member, double R, int sigma_h, double torque);

/// Force on every loaded face, in their order. For one face `equal_torque` and `line_load_middles` are the force at its
/// middle.
[[nodiscard]] std::vector<BevelForce> bevel_face_forces(const BevelForceMember& member,
                                                        const std::vector<LoadedFace>& faces, int sigma, double torque,
                                                        LoadSplit split);

/// Their sum.
[[nodiscard]] BevelForce bevel_total_force(const BevelForceMember& member, const std::vector<LoadedFace>& faces,
                                           int sigma, double torque, LoadSplit split);

/// Inner and outer half of a herringbone without the strip R_J -+ relief; a half that is empty is left out.
/// @param hand of the inner half
[[nodiscard]] std::vector<LoadedFace> herringbone_faces(double R_i, double R_J, double R_e, double relief, int hand);

/// Apex cone distance at which the spiral parts of both halves cancel under a uniform line load, so that axial and
/// radial force are the same in both senses: G(beta) = beta - sin(beta) cos(beta) is halved. With `relief` the strip
/// R_J -+ relief carries nothing. Empty where no R_J leaves both halves a face. Equal torque has no such place:
/// tan(beta)/R falls with R, so the inner half always prevails.
[[nodiscard]] std::optional<double> balanced_apex_distance(double R_i, double R_e, double R_0, double relief = 0);

}  // namespace toothpath::bevel_gear
