// Mills whose compliance can be said in closed form, and tapered mills of the table of the line milling page.
#pragma once

#include <stdexcept>

#include "cam/tool/profile.h"
#include "geometry/base/angle.h"

namespace toothpath::test {

inline tool::Meridian line(const std::vector<Vec2>& corners) {
  std::vector<tool::MeridianPiece> pieces;
  for (std::size_t k = 1; k < corners.size(); ++k) pieces.push_back({corners[k - 1], corners[k], 0});
  return tool::Meridian(std::move(pieces));
}

inline tool::Profile made(const tool::CutterData& data) {
  auto p = tool::Profile::make(data);
  if (auto* refused = std::get_if<std::vector<Refusal>>(&p))
    throw std::runtime_error(refused->front().diagnostic.message);
  return std::get<tool::Profile>(std::move(p));
}

inline tool::CutterData ball_data(double r_0, double flute, double shank_diameter, double stick_out) {
  tool::CutterData d;
  d.diameter_mm = 2 * r_0;
  d.flute_length_mm = flute;
  d.shank_diameter_mm = shank_diameter;
  d.stick_out_mm = stick_out;
  d.length_mm = stick_out + 70;
  d.holder = {{10, 10, 30}};
  return d;
}

inline tool::CutterData tapered_data(double r_0, double half_angle_deg, double flute, double shank_diameter,
                                     double stick_out) {
  tool::CutterData d = ball_data(r_0, flute, shank_diameter, stick_out);
  d.shape = tool::CutterShape::tapered_ball;
  d.half_angle_rad = radians(half_angle_deg);
  return d;
}

}  // namespace toothpath::test
