#include "app/process/face/body.h"

#include <algorithm>

namespace toothpath::face {

milled::GearBody body_of(const face_gear::FaceGear& gear) {
  double lowest = gear.lowest_root();
  if (gear.rings().size() > 1) lowest = std::min(lowest, gear.groove_floor());
  milled::GearBody body;
  body.teeth = gear.parameters().teeth;
  body.outer_radius_mm = gear.outer_radius();
  body.blank_top_mm = gear.blank_top();
  body.links = {gear.outer_radius(), lowest - 2.5 * gear.parameters().module_mm, gear.blank_top()};
  body.rapids = {gear.outer_radius(), gear.inner_radius(), gear.blank_top()};
  body.in_blank = [&gear](const Vec3& p) { return gear.in_blank(p); };
  return body;
}

}  // namespace toothpath::face
