// Forward kinematics of an A/C trunnion as LinuxCNC's xyzac-trt publishes it, written out term by term; shares nothing
// with the machine model under test.
#pragma once

#include <cmath>

#include "geometry/base/vec.h"

namespace toothpath::test {

/// Geometry in the pins of xyzac-trt: C axis at (px, py), tilt axis at y = py + dy and z = pz + z_offset.
struct TrunnionGeometry {
  double px = 0, py = 0, pz = 0, dy = 0, z_offset = 0;
};

struct TrunnionPose {
  Vec3 tip, axis;  // table frame
};

/// Joints in mm and degrees, reversed rotaries, gauge-line Z; tool length L from the gauge line to the tip.
inline TrunnionPose trunnion_forward(const TrunnionGeometry& g, double X, double Y, double Z, double A, double C,
                                     double L) {
  const double deg = std::acos(-1.0) / 180, sA = std::sin(A * deg), cA = std::cos(A * deg), sC = std::sin(C * deg),
               cC = std::cos(C * deg), dz = g.z_offset + L;
  const double x = X - g.px, y = Y - g.dy - g.py, z = Z - dz - g.pz;
  TrunnionPose pose;
  pose.tip = Vec3(cC * x + sC * cA * y + sC * sA * z + sC * g.dy + g.px,
                  -sC * x + cC * cA * y + cC * sA * z + cC * g.dy + g.py, -sA * y + cA * z + dz + g.pz - L);
  pose.axis = Vec3(sC * sA, cC * sA, cA);
  return pose;
}

}  // namespace toothpath::test
