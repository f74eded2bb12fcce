// What cutting forces are computed from: [material], and the largest chip and engagement of an operation.
#include "app/job/tables.h"
#include "geometry/base/angle.h"

namespace toothpath::job {

MaterialSettings read_material(toml::TableReader& table) {
  MaterialSettings m;
  m.stated = true;
  m.cutting.cutting_N_mm2 =
      table.number_or("cutting_coefficient", {0, 50000, " N/mm^2", true}, m.cutting.cutting_N_mm2);
  m.cutting.edge_N_mm = table.number_or("edge_coefficient", {0, 1000, " N/mm"}, m.cutting.edge_N_mm);
  m.tools.youngs_modulus_N_mm2 =
      table.number_or("youngs_modulus", {10, 1200, " GPa"}, m.tools.youngs_modulus_N_mm2 / 1000) * 1000;
  m.cutting.uncertainty = table.number_or("uncertainty", {0, 5}, m.cutting.uncertainty);
  table.finish();
  return m;
}

void read_chip_limits(toml::TableReader& table, path::MillingOperation& operation) {
  if (const auto chip = table.optional_number("chip_load", {0, 5, " mm", true})) operation.chip_load_mm = *chip;
  if (const auto angle = table.optional_number("max_engagement", {0, 180, " deg", true}))
    operation.max_engagement_rad = radians(*angle);
}

}  // namespace toothpath::job
