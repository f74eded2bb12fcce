#include "cam/cut/left_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cam/cut/swept_tool.h"

namespace toothpath::cut {

LeftOnTooth::LeftOnTooth(std::span<const LeftPlace> places)
    : places_(places), left_(places.size(), std::numeric_limits<float>::infinity()) {}

void LeftOnTooth::add(std::vector<path::ToolMotion> cuts, const tool::ProofTool& tool, double top_mm) {
  const Removed removed(std::move(cuts), tool, top_mm);
  constexpr std::size_t kTogether = 64;
  const std::size_t stretches = (places_.size() + kTogether - 1) / kTogether;
  tbb::parallel_for(std::size_t(0), stretches, [&](std::size_t n) {
    for (std::size_t k = n * kTogether; k < std::min(places_.size(), (n + 1) * kTogether); ++k) {
      // More than twice what may stand need not be told apart.
      const double cap = std::min(double(left_[k]), 2 * places_[k].limit_mm);
      const double left = removed.excess(places_[k].p, cap);
      left_[k] = std::nextafter(float(left), std::numeric_limits<float>::infinity());
    }
  });
}

bool LeftOnTooth::within() const {
  for (std::size_t k = 0; k < places_.size(); ++k)
    if (!(double(left_[k]) <= places_[k].limit_mm)) return false;
  return true;
}

}  // namespace toothpath::cut
