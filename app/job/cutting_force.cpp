// What cutting forces are computed from: [material], and the largest chip and engagement of an operation.
#include "app/job/tables.h"
#include "geometry/base/angle.h"

namespace toothpath::job {

MaterialSettings read_material(toml::TableReader& table) {
  MaterialSettings m;
  m.stated = true;
  const auto number = [&](const char* key, const toml::Range& range) {
    return table.if_present(key, [&] { return table.number(key, range); });
  };
  if (const auto K = number("cutting_coefficient", {0, 50000, " N/mm^2", true})) m.cutting.cutting_N_mm2 = *K;
  if (const auto K_e = number("edge_coefficient", {0, 1000, " N/mm"})) m.cutting.edge_N_mm = *K_e;
  if (const auto E = number("youngs_modulus", {10, 1200, " GPa"})) m.tools.youngs_modulus_N_mm2 = *E * 1000;
  if (const auto share = number("uncertainty", {0, 5})) m.cutting.uncertainty = *share;
  table.finish();
  return m;
}

void read_chip_limits(toml::TableReader& table, path::MillingOperation& operation) {
  if (const auto chip = table.if_present("chip_load", [&] { return table.number("chip_load", {0, 5, " mm", true}); }))
    operation.chip_load_mm = *chip;
  if (const auto angle = table.if_present("max_engagement", [&] {
        return table.number("max_engagement", {0, 180, " deg", true});
      }))
    operation.max_engagement_rad = radians(*angle);
}

}  // namespace toothpath::job
