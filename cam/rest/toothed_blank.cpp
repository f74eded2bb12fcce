#include "cam/rest/toothed_blank.h"

namespace toothpath::rest {

Blank blank_of(const tooth_space::ToothedSolid& gear, double above_mm) {
  Blank out;
  out.teeth = gear.teeth;
  for (const auto& ring : gear.rings)
    out.rings.push_back({ring.space->outline().s_from, ring.space->outline().s_to,
                         [space = ring.space, above_mm](double s) { return space->tip(s) + above_mm; },
                         [](double) { return 0.0; }, gear.lowest_root});
  out.corners = gear.corners;
  out.place = [chart = gear.chart()](double s, double h, double azimuth) {
    const double r = chart.r(s, h);
    return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), chart.z(s, h));
  };
  return out;
}

}  // namespace toothpath::rest
