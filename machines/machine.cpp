#include "machines/machine.h"

namespace toothpath {

bool Machine::has_acceleration() const {
  for (const auto& axis : chain.linear)
    if (!(axis.max_acceleration > 0)) return false;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k)
    if (!(chain.rotary(k).max_acceleration > 0)) return false;
  return true;
}

Status check_simultaneous_axes(const Machine& machine, std::string_view moving) {
  if (static_cast<int>(moving.size()) <= machine.max_simultaneous_axes) return Ok{};
  return fail("{} axes move at once ({}), the control of {} interpolates {}: fix the tilt in each pass and index C (3+2)",
              moving.size(), moving, machine.name, machine.max_simultaneous_axes);
}

Status check_part_fits(const Machine& machine, double part_diameter_mm) {
  if (part_diameter_mm <= machine.largest_part_mm()) return Ok{};
  return fail("part diameter = {:.4f} mm exceeds {:.4f} mm, the largest that turns on {}", part_diameter_mm,
              machine.largest_part_mm(), machine.name);
}

}  // namespace toothpath
