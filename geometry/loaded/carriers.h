// Who carries in one position: forces of rings and teeth, and what they push along the pinion's axis.
#pragma once

#include <algorithm>
#include <map>

#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

class Carriers {
 public:
  Carriers(const LoadedPair& pair, LoadedPosition& out) : pair_(pair), out_(out) {
    out_.ring_force.assign(pair.rings.size(), 0.0);
    out_.pressure_radius_mm = 1e300;
  }
  /// A place, or all of one tooth, with a force above 0. @param axial_share by how much it nears when the pinion moves
  /// by 1 along its axis
  void add(int ring, int tooth, double force, double axial_share, double curvature) {
    for (std::size_t r = 0; r < pair_.rings.size(); ++r)
      if (pair_.rings[r].ring == ring) out_.ring_force[r] += force;
    out_.axial_n -= force * axial_share;
    out_.pressure_radius_mm = std::min(out_.pressure_radius_mm, 1 / curvature);
    teeth_[tooth] += force;
  }
  /// Pairs are teeth that carry more than a thousandth of the load.
  void finish(double load_n) {
    out_.pairs = static_cast<int>(
        std::count_if(teeth_.begin(), teeth_.end(), [&](const auto& t) { return t.second > 1e-3 * load_n; }));
  }

 private:
  const LoadedPair& pair_;
  LoadedPosition& out_;
  std::map<int, double> teeth_;
};

}  // namespace toothpath::loaded
