#include "app/process/under_load/settings.h"

#include "geometry/base/angle.h"

namespace toothpath::under_load {

job::ContactSettings contact_settings(const job::Job& job, const process::ContactAsked& asked) {
  job::ContactSettings s = job.contact.value_or(job::ContactSettings{});
  if (asked.pinion_teeth) s.pinion_teeth = *asked.pinion_teeth;
  if (asked.offset_error_mm) s.moved.offset_mm = *asked.offset_error_mm;
  if (asked.axial_error_mm) s.moved.axial_mm = *asked.axial_error_mm;
  if (asked.angle_error_deg) s.moved.angle_rad = radians(*asked.angle_error_deg);
  if (asked.wheel_axial_error_mm) s.moved.gear_axial_mm = *asked.wheel_axial_error_mm;
  if (asked.compound_um) s.compound_mm = *asked.compound_um / 1000;
  if (asked.torque_Nm) {
    if (!s.load) s.load.emplace();
    s.load->torque_Nm = *asked.torque_Nm;
    s.load->on_pinion = asked.torque_on_pinion;
  }
  if (s.load && asked.pinion_held) s.load->pinion_axial = job::PinionHold::held;
  if (s.load && asked.positions) s.load->positions = *asked.positions;
  return s;
}

}  // namespace toothpath::under_load
