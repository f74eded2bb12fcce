#include "app/process/face/body.h"

#include <algorithm>

namespace toothpath::face {

milled::GearBody body_of(const face_gear::FaceGear& gear) {
  double lowest = gear.lowest_root();
  if (gear.rings().size() > 1) lowest = std::min(lowest, gear.groove_floor());
  milled::GearBody body;
  body.links = {gear.outer_radius(), lowest - 2.5 * gear.parameters().module_mm, gear.blank_top()};
  body.rapids = {gear.outer_radius(), gear.inner_radius(), gear.blank_top()};
  return body;
}

}  // namespace toothpath::face
