// Who carries in one position: forces of rings and teeth.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

class Carriers {
 public:
  /// @param rings  numbers of the rings that can carry
  Carriers(std::vector<int> rings, LoadedPosition& out) : rings_(std::move(rings)), out_(out) {
    out_.ring_force.assign(rings_.size(), 0.0);
    out_.pressure_radius_mm = 1e300;
  }
  /// A place, or all of one tooth, with a force above 0.
  void add(int ring, int tooth, double force, double curvature) {
    for (std::size_t r = 0; r < rings_.size(); ++r)
      if (rings_[r] == ring) out_.ring_force[r] += force;
    out_.pressure_radius_mm = std::min(out_.pressure_radius_mm, 1 / curvature);
    teeth_[tooth] += force;
  }
  /// Pairs are teeth that carry more than a thousandth of the load.
  void finish(double load_n) {
    out_.pairs = static_cast<int>(
        std::count_if(teeth_.begin(), teeth_.end(), [&](const auto& t) { return t.second > 1e-3 * load_n; }));
  }

 private:
  std::vector<int> rings_;
  LoadedPosition& out_;
  std::map<int, double> teeth_;
};

}  // namespace toothpath::loaded
