// The finished face gear once more, the plain way: every surface sampled densely, the nearest sample improved by a
// pattern search that only evaluates points. Shares the kernels of geometry/face_gear/surface.h with the program, and
// nothing of cam.
#pragma once

#include <string>
#include <vector>

#include "geometry/face_gear/gear.h"

namespace toothpath::test {

/// A point of the solid's boundary near some other point.
struct BruteNearest {
  double distance = INFINITY;  ///< unsigned, mm; that of a point of the boundary, so never below the true one
  std::string patch;
  Vec3 foot = Vec3::Zero();  ///< gear frame, beside the asked point (not turned to space 0)
};

class BruteForceGearSolid {
 public:
  /// `rows` x `columns` samples a patch.
  explicit BruteForceGearSolid(const face_gear::FaceGear& gear, int rows = 40, int columns = 60);

  [[nodiscard]] BruteNearest nearest(const Vec3& c) const;
  /// Is c inside the material? Decided on the profile at its radius; not to be trusted within 1e-4 mm of the surface.
  [[nodiscard]] bool inside(const Vec3& c) const;

  /// A boundary point of zone, patch index and box coordinates (x along the profile, y from the inner to the outer
  /// end). Patches: 0 flank +1, 1 fillet +1, 2 root, 3 fillet -1, 4 flank -1, 5 tip, 6 inner end, 7 outer end, 8
  /// groove.
  [[nodiscard]] Vec3 point(int zone, int patch, double x, double y) const;
  /// Unit normal by differences of `point`, out of the material.
  [[nodiscard]] Vec3 normal(int zone, int patch, double x, double y) const;
  static const char* name(int patch);

 private:
  static constexpr int kTable = 2049;
  struct Ring {
    face_gear::FaceGearRing ring;
    double r_in = 0, r_out = 0;
    std::vector<double> theta_tip[2];        // over r: roll parameter at the tip surface, +1 of tooth 0 and -1
    std::vector<double> az_tip[2];           // over r: azimuths of the tip edges of space 0
    std::vector<double> B_mid[2];            // start values over r
    std::vector<double> Z_root;              // section over r
    std::vector<Vec2> profile[2];            // (azimuth, z) at both ends, tip edge to tip edge
    std::vector<std::vector<Vec3>> samples;  // a patch each, rows x columns
  };
  [[nodiscard]] Vec3 at(const Ring& ring, int patch, double x, double y) const;
  [[nodiscard]] std::vector<Vec2> profile_at(const Ring& ring, double r, int count) const;

  const face_gear::FaceGear& gear_;
  int rows_, columns_;
  double pitch_;
  std::vector<Ring> rings_;
};

}  // namespace toothpath::test
