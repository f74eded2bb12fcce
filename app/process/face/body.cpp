#include "app/process/face/body.h"

#include "geometry/face_gear/part.h"

namespace toothpath::face {

milled::GearBody body_of(const face_gear::FaceGear& gear, const face_gear::Body& drawn) {
  milled::GearBody body;
  body.links = {gear.outer_radius(), face_gear::underside_z(gear, drawn), gear.blank_top()};
  body.rapids = {gear.outer_radius(), gear.inner_radius(), gear.blank_top()};
  body.web_z = face_gear::web_z(gear, drawn);
  return body;
}

}  // namespace toothpath::face
