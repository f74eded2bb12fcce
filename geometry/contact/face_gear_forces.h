// Forces of a face gear mesh from statics alone: rigid bodies, no friction. Forces in N, torques in N mm, lengths in
// mm.
//
// Every normal of an involute flank has the same moment about the gear's axis (M2) and about the pinion's (r_b1 cos
// beta_b) and the same slope against the pinion's axis. Normal force, pinion torque and axial force of the pinion hence
// do not depend on where the flanks touch, nor on how the force is shared among the teeth of one ring. Derivation:
// docs/contact.md.
#pragma once

#include <cmath>

#include "geometry/contact/pinion.h"

namespace toothpath::contact {

/// Force of the gear's teeth on the pinion (that of the pinion on the gear is its opposite), all teeth of one ring
/// together.
struct MeshForce {
  double normal_n = 0;  ///< along the flank normals
  double pinion_torque_nmm = 0;
  double pinion_axial_n = 0;   ///< along a: away from the gear's axis when positive
  double pinion_radial_n = 0;  ///< along -d: pushes the pinion off the gear when positive; at the pitch point
  double gear_axial_n =
      0;  ///< of the pinion on the gear, along the gear's axis z; negative presses the gear on its seat
};

/// @param torque_nmm  of the gear about its axis, carried by this ring; > 0
/// @param s           side that carries
inline MeshForce mesh_force(const face_gear::FaceGearSurface<double>& gear, const Pinion<double>& pinion, int s,
                            double torque_nmm) {
  const double B = s * gear.shaper.alpha_t;
  const Vec3 n = s * (gear.t(B) * gear.shaper.cos_bb - gear.a() * gear.shaper.sin_bb);
  MeshForce f;
  f.normal_n = torque_nmm / gear.M2;
  f.pinion_torque_nmm = f.normal_n * pinion.r_b * pinion.cos_bb;
  f.pinion_axial_n = f.normal_n * n.dot(gear.a());
  f.pinion_radial_n = -f.normal_n * n.dot(gear.d());
  f.gear_axial_n = -f.normal_n * n.z();
  return f;
}

/// Two rings of opposite hand on one pinion; `outer_share` of the torque is carried by the outer one. A pinion that
/// floats along its axis takes the place where its axial forces cancel: outer_share = 1/2 for equal helices. A pinion
/// that is held carries the difference.
struct DoubleMeshForce {
  MeshForce inner, outer;
  double axial_n = 0;         ///< on the pinion, both rings
  double single_axial_n = 0;  ///< the same torque on the outer ring alone: the single helix
};
inline DoubleMeshForce double_mesh_force(const face_gear::FaceGearSurface<double>& inner,
                                         const face_gear::FaceGearSurface<double>& outer,
                                         const Pinion<double>& inner_pinion, const Pinion<double>& outer_pinion, int s,
                                         double torque_nmm, double outer_share) {
  DoubleMeshForce f;
  f.inner = mesh_force(inner, inner_pinion, s, torque_nmm * (1 - outer_share));
  f.outer = mesh_force(outer, outer_pinion, s, torque_nmm * outer_share);
  f.axial_n = f.inner.pinion_axial_n + f.outer.pinion_axial_n;
  f.single_axial_n = mesh_force(outer, outer_pinion, s, torque_nmm).pinion_axial_n;
  return f;
}

}  // namespace toothpath::contact
