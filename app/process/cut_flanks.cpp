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

std::vector<std::string> notes_of(const CutFlanks& cut) {
  std::vector<std::string> notes;
  if (!cut.verified) notes.emplace_back("the program of the cut surface is not verified");
  for (const auto& assumed : cut.assumed) notes.push_back("assumed: " + assumed);
  return notes;
}

}  // namespace toothpath::process
