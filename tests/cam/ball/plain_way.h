// A pass of even stations whose balls touch nothing, for tests of the search for tool directions.
#pragma once

#include "cam/ball/orientation_way.h"

namespace toothpath::test {

inline ball::OrientationWay plain_way(int stations, double spacing) {
  ball::OrientationWay way;
  for (int k = 0; k < stations; ++k) {
    way.s.push_back(k * spacing);
    way.r.push_back(100 + k * spacing);
    way.points.emplace_back();
    way.lean.emplace_back(0, 0);
  }
  return way;
}

}  // namespace toothpath::test
