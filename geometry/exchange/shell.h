// The skin of a whole gear as its exact surfaces give it, before any of it is approximated: rings of teeth, and the
// surfaces of revolution between them. Made by tooth_shell.h.
//
// Around the gear the skin is a torus with two parameters: u runs along a meridian (over the first ring from its inner
// to its outer end, over a groove and the next ring, down the outside, back along the underside, up the inside), v
// grows with the azimuth. A pitch of a ring is a row of strips that follow each other in v:
//
//     flank +1 of tooth k, fillet +1, root, fillet -1, flank -1 of tooth k + 1, top land of tooth k + 1
//
// as the tooth space k has them. mm and rad, gear frame.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::exchange {

/// What is narrower is no face of a solid.
inline constexpr double kLeastFace_mm = 1e-3;

/// A strip of one pitch.
struct Strip {
  std::string name;  ///< "flank +1", "fillet L"
  int tooth = 0;     ///< whose it is, from that of the pitch: 0 or 1
};

/// Exact places of pitch 0 at one u, a list a strip for the v in [0, 1] that are asked of it. The place at v = 1 of a
/// strip is that at v = 0 of the next one; of the last one, that of the first turned by a pitch.
using ExactRow =
    std::function<Result<std::vector<std::vector<Vec3>>>(double u, const std::vector<std::vector<double>>& v)>;

/// One ring of teeth.
struct ToothRing {
  std::vector<Strip> strips;
  std::size_t foot = 0;  ///< strip before which the ends of the ring are deepest: the root, or the fillet behind it
  ExactRow row;
  /// At u = 0 and u = 1: the end of strip `foot` lies on the circle where the ring's end meets the next surface of
  /// revolution (a groove to root depth), so that every tooth has an end face of its own.
  std::array<bool, 2> foot_on_circle{false, false};
  std::string place;                             ///< "zone 0", for messages
  std::function<std::string(double u)> station;  ///< "radius 61.2 mm", for messages
};

/// Corner of the meridian between two rings.
struct Corner {
  double radius = 0, z = 0;
};

struct GearShell {
  int teeth = 0;
  /// +1: dP/du x dP/dv points out of the material; -1: into it.
  int outward = 1;
  std::vector<ToothRing> rings;
  /// Behind each ring, in the order of u: where its end surface stops, the corners of what follows, and where the end
  /// surface of the next ring begins; at least two. Between two corners a plane, cylinder or cone.
  std::vector<std::vector<Corner>> corners;
};

}  // namespace toothpath::exchange
