#include "app/process/milled/tooth_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/tooth_space/limits.h"
#include "geometry/tooth_space/tooth_size.h"

namespace toothpath::milled {
namespace {

using sheet::data_length;
using tooth_space::ToothSpace;

/// Of the drawing: with its modifications, without a correction.
const ToothSpace& space_of(const tooth_space::ToothedSolid& solid, int zone) {
  const auto ring = std::find_if(solid.rings.begin(), solid.rings.end(), [&](const auto& r) { return r.zone == zone; });
  return *(ring == solid.rings.end() ? solid.rings.front() : *ring).space;
}

/// Two balls in opposite spaces of a gear whose teeth stand outwards; the nearest to opposite of an odd number.
double over_balls(const tooth_space::BallInSpace& ball, int teeth) {
  const double r = radius(ball.centre);
  return 2 * r * (teeth % 2 == 0 ? 1.0 : std::cos(0.5 * kPi / teeth)) + ball.diameter_mm;
}

void add_ball(sheet::DataGroup& group, const ToothSpace& space, int teeth, const ThicknessPlace& place) {
  const auto ball = tooth_space::measuring_ball(space, place.s, place.h);
  if (!ball) {
    group.rows.push_back(
        {"D_M", "measuring ball", "none of the usual diameters touches both flanks and stands above the tips"});
    return;
  }
  const auto& chart = space.outline().chart;
  group.rows.push_back(data_length("D_M", "diameter of the measuring ball", ball->diameter_mm));
  group.rows.push_back(data_length("r_M", "radius of its centre", radius(ball->centre)));
  group.rows.push_back(data_length("Z_M", "height of its centre along the gear axis", ball->centre.z()));
  if (chart.cosine == 0)
    group.rows.push_back(data_length(
        "M_dK", teeth % 2 == 0 ? "dimension over two balls" : "dimension over two balls, odd number of teeth",
        over_balls(*ball, teeth)));
  else
    group.rows.push_back(data_length("M_h",
                                     chart.sine == 0 ? "height of the ball's top along the gear axis"
                                                     : "height of the ball's top above the pitch cone",
                                     chart.up(ball->centre) + 0.5 * ball->diameter_mm));
}

}  // namespace

ThicknessPlace middle_of_zone(const tooth_space::ToothedSolid& solid, int zone) {
  const ToothSpace& space = space_of(solid, zone);
  const auto& ring = space.outline();
  const double s = 0.5 * (ring.s_from + ring.s_to);
  const auto middle = tooth_space::middle_of_flank(space, 1, s);
  return {zone, s, middle ? ring.chart.up(middle->p) : space.tip(s), "half way up the flank, middle of the face"};
}

std::vector<sheet::DataGroup> tooth_data(const tooth_space::ToothedSolid& solid,
                                         const std::vector<ThicknessPlace>& places) {
  std::vector<sheet::DataGroup> out;
  for (const ThicknessPlace& place : places) {
    const ToothSpace& space = space_of(solid, place.zone);
    const auto& chart = space.outline().chart;
    sheet::DataGroup group{solid.rings.size() > 1 ? fmt::format("Tooth of zone {}: {}", place.zone, place.where)
                                                  : fmt::format("Tooth: {}", place.where),
                           {}};
    group.rows.push_back(data_length("d_y", "diameter of the circle", 2 * chart.r(place.s, place.h)));
    group.rows.push_back(data_length("Z", "height of the circle along the gear axis", chart.z(place.s, place.h)));
    if (const auto t = tooth_space::tooth_thickness(space, place.s, place.h)) {
      group.rows.push_back(data_length("s_t", "tooth thickness on the arc, transverse", t->arc_mm));
      group.rows.push_back(data_length("s_nc", "chordal tooth thickness, normal", t->chord_mm));
      group.rows.push_back(data_length("h_c", "height above the chord", t->height_mm));
    } else {
      group.rows.push_back({"s_nc", "tooth thickness", "the circle does not cross both flanks here"});
    }
    group.rows.push_back(data_length("s_a", "top land on the arc", tooth_space::top_land_mm(space, place.s)));
    add_ball(group, space, solid.teeth, place);
    out.push_back(std::move(group));
  }
  return out;
}

}  // namespace toothpath::milled
