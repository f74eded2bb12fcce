// The arc that closes the gap of the convex corner of a herringbone, about the corner of the trace: from the end of the
// inner path to the begin of the outer one. Its radius is r_0; where modifications set the two ends at other distances
// it goes evenly from one to the other with the direction.
#pragma once

#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_gear {

class ConvexCorner {
 public:
  /// The gear is a herringbone.
  explicit ConvexCorner(const BevelGear& gear);
  /// t = 0 at the inner half, 1 at the outer one.
  [[nodiscard]] CutterCentre<double> at(double t) const;
  /// Share t at the cone distance R_c between both ends.
  [[nodiscard]] double share_at(double R_c) const;
  /// Distance of a centre beyond the arc as seen from the corner, positive towards the space; R_c between both ends.
  [[nodiscard]] double offset(double R_c, double theta) const;
  /// Are both ends r_0 from the corner?
  [[nodiscard]] bool plain() const { return inner_ == r_0_ && outer_ == r_0_; }
  [[nodiscard]] double least_radius() const { return std::min(inner_, outer_); }

 private:
  [[nodiscard]] double radius(double t) const { return inner_ + (outer_ - inner_) * t; }
  int sigma_;
  double R_J_, theta_, beta_J_, sin_delta_, r_0_, inner_, outer_;
};

}  // namespace toothpath::bevel_gear
