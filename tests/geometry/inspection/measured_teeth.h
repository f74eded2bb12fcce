// Gears with planted errors as a measuring machine would see them; nothing goes through the code that reads them.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "geometry/inspection/grid.h"
#include "tests/support/random.h"

namespace toothpath::test {

/// What is wrong with a gear; mm and rad.
struct PlantedErrors {
  std::vector<double> index;  ///< of every tooth, along the normals of side +1 (turned forward); those of side -1: less
  std::vector<double> thick;  ///< of every tooth, on both sides
  Vec3 shifted = Vec3::Zero();                                                ///< the whole gear
  std::function<double(const inspection::InspectionPoint&)> shape = nullptr;  ///< of every tooth alike
  double noise = 0;                                                           ///< largest, of every point by itself
};

struct SeenPoint {
  Vec3 p, n;  ///< n: the nominal normal, as machines state it
  int tooth = 0;
  const inspection::InspectionPoint* nominal = nullptr;
};

/// The grid on each of the teeth: true places of a surface whose parallel, `ball` above it, the centre of a probe is
/// on.
inline std::vector<SeenPoint> seen(const std::vector<inspection::InspectionPoint>& grid, const std::vector<int>& teeth,
                                   double pitch, double M2, const PlantedErrors& errors, double ball = 0) {
  std::vector<SeenPoint> out;
  Random random(71);
  for (const int k : teeth)
    for (const auto& p : grid) {
      const double along = ball + (errors.shape ? errors.shape(p) : 0) +
                           (errors.thick.empty() ? 0 : errors.thick[std::size_t(k)]) + random(-1, 1) * errors.noise;
      // A tooth off its place is the tooth turned: its flanks stand off by the turn times M2.
      const double turn = k * pitch + (errors.index.empty() ? 0 : errors.index[std::size_t(k)]) / M2;
      const double nominal = k * pitch;
      out.push_back({turned(p.p + along * p.n, turn) + errors.shifted, turned(p.n, nominal), k, &p});
    }
  return out;
}

inline std::vector<int> teeth_of(int count) {
  std::vector<int> out;
  for (int k = 0; k < count; ++k) out.push_back(k);
  return out;
}

}  // namespace toothpath::test
