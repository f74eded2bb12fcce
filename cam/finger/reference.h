// Where the centre of a finger mill may be: the crown plane, bounded by the nominal wall paths of one tooth space.
//
// The finished walls are the envelopes of the nominal passes, so a pose cuts a wall only as far as its centre lies
// beyond the wall's path. That turns "does this pose gouge" into a signed distance from a plane curve, which is what
// the bounds between samples rest on. Proof: docs/bevel_gear.md, section 9.
#pragma once

#include <optional>
#include <vector>

#include "cam/path/tool_motion.h"
#include "geometry/bevel_gear/convex_corner.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::finger {

/// A pose of the cutter relative to the family of poses with the axis normal to the pitch cone.
struct ConePose {
  double R_c = 0, theta = 0;  ///< where the axis meets the pitch cone, crown plane
  double lift = 0;            ///< of the tip above the root cone, along the axis; negative: below
  double tilt = 0;            ///< angle between the axis and the normal of the pitch cone, rad
};
/// @param index azimuth of the tooth space
[[nodiscard]] ConePose cone_pose(const bevel_gear::BevelGear& gear, const Vec3& tip, const Vec3& axis, double index);

/// Greatest displacement of a point of the cutter among the teeth per unit of shift of its centre in the crown plane,
/// for every centre from which the mill of this gear reaches the face; at least 1.
[[nodiscard]] double centre_leverage(const bevel_gear::BevelGear& gear);

/// Path of one wall over the whole gear: passes of the halves, the corner between them, the run-out.
class WallReference {
 public:
  WallReference(const bevel_gear::BevelGear& gear, int sigma);
  /// Room of a centre before the cutter touches the wall, negative: how far the centre lies beyond [mm]; exact to
  /// second order in the distance. Beyond the ends of the face only the edge of the wall counts. Large where the cutter
  /// reaches no tooth.
  [[nodiscard]] double side(double R_c, double theta) const;
  /// Distance of a centre from the path alone, which goes on beyond the face as the trace does; positive towards the
  /// space.
  [[nodiscard]] double offset(double R_c, double theta) const;
  /// Polar angle of the path at R_c inside the passes.
  [[nodiscard]] double theta_at(double R_c) const;
  /// The whole path at R_c: curves of both halves, arc of a convex corner, straight run-out; below the small end as the
  /// trace goes on.
  [[nodiscard]] bevel_gear::CutterCentre<double> place_at(double R_c) const;
  /// Cone distances at which the bend of the path jumps, ascending [mm].
  [[nodiscard]] std::vector<double> joints() const;
  [[nodiscard]] int sigma() const { return sigma_; }
  /// Largest curvature of the path [1/mm].
  [[nodiscard]] double largest_curvature() const { return curvature_; }
  /// R_c range of the pass of a half.
  [[nodiscard]] double R_c_from(std::size_t half) const { return halves_[half].R_c.front(); }
  [[nodiscard]] double R_c_to(std::size_t half) const { return halves_[half].R_c.back(); }
  /// R_c below which the pass runs out of the small end: the cutter touches nothing of the face any more, at most its
  /// edge.
  [[nodiscard]] double engaged_from() const { return engaged_from_; }
  /// centre_leverage of the gear.
  [[nodiscard]] double leverage() const { return leverage_; }

 private:
  struct Curve {
    bevel_gear::BevelTrace<double> trace;
    std::vector<double> R_c, beta;  // nodes, R_c ascending
  };
  [[nodiscard]] bevel_gear::CutterCentre<double> on_curve(const Curve& curve, double R_c) const;
  /// Largest where the bend of a modified path jumps.
  [[nodiscard]] double curvature_at_joints(const Curve& curve) const;
  [[nodiscard]] std::size_t half_of(double R_c) const;
  [[nodiscard]] static double first_engaged(const bevel_gear::BevelGear& gear, int sigma, const Curve& first);

  int sigma_;
  double reach_ = 0, near_ = 0, far_ = 0, curvature_ = 0, leverage_ = 1, engaged_from_ = 0;
  std::vector<Curve> halves_;
  // Edges of the wall at the ends of the face: beyond the pass only they can be touched.
  struct Edge {
    std::vector<Vec3> points;
    std::vector<double> gap;  // of every point to the farther one of its neighbours, mm
    double spacing = 1e-9;    // largest of them
  };
  [[nodiscard]] static Edge edge_points(const bevel_gear::BevelGear& gear, const bevel_gear::BevelWall<double>& wall,
                                        double ell);
  [[nodiscard]] double edge_clearance(const Edge& edge, double R_c, double theta) const;
  Edge inner_edge_, outer_edge_;
  bevel_gear::FingerSolid solid_;
  double sin_delta_ = 0, cos_delta_ = 1;
  bevel_gear::CutterCentre<double> end_;  // start of the straight run-out
  // Convex corner of a herringbone: arc of radius r_0 about the trace's corner.
  bool convex_ = false;
  std::optional<bevel_gear::ConvexCorner> corner_;
  double corner_R_ = 0, corner_theta_ = 0, r_0_ = 0, arc_from_ = 0, arc_to_ = 0;
  double split_ = 0;  // R_c of the crossing on the concave side
};

}  // namespace toothpath::finger
