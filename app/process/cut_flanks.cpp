#include "app/process/cut_flanks.h"

namespace toothpath::process {

std::vector<CutFlanks::Flank> flanks_of(const std::vector<proof::SurfaceGrid>& surface) {
  std::vector<CutFlanks::Flank> flanks;
  for (const proof::SurfaceGrid& g : surface) {
    const int side = flank_side(g.patch);
    if (side == 0 || g.excess_um.empty()) continue;
    CutFlanks::Flank flank{g.zone, side, g.rows, g.columns, g.points, g.normals, {}};
    for (const float um : g.excess_um.back()) flank.deviation_mm.push_back(double(um) / 1000);
    flank.reached = g.reachable;
    flanks.push_back(std::move(flank));
  }
  return flanks;
}

}  // namespace toothpath::process
