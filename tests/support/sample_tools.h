// Tools that tests and benches share.
#pragma once

#include "cam/tool/assembly.h"

namespace toothpath::test {

/// Tool 1, a ball mill 80 mm long; its holder is a cylinder of 30 mm under a wider one.
inline tool::ToolAssembly ball_mill(double diameter, double flute, double shank, double stick_out, double holder) {
  tool::ToolAssembly t;
  t.number = 1;
  t.diameter_mm = diameter;
  t.flute_length_mm = flute;
  t.shank_diameter_mm = shank;
  t.length_mm = 80;
  t.holder = {{holder, holder, 30}, {32, 32, 30}};
  t.stick_out_mm = stick_out;
  return t;
}

/// A ball of 2 mm whose holder begins in a cone 9 mm above the tip: near meshes every body of it counts.
inline tool::ToolAssembly stubby_mill() {
  tool::ToolAssembly t;
  t.diameter_mm = 2;
  t.flute_length_mm = 4;
  t.shank_diameter_mm = 1.8;
  t.length_mm = 60;
  t.stick_out_mm = 9;
  t.holder = {{3, 10, 6}, {10, 10, 12}};
  return t;
}

}  // namespace toothpath::test
