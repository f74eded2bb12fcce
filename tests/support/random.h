// Random numbers of the tests: a fixed seed gives the same numbers on every machine.
#pragma once

#include <cstdint>
#include <random>

#include "geometry/base/vec.h"

namespace toothpath::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  /// Uniform in [low, high).
  double operator()(double low, double high) { return low + (high - low) * double(generator_() >> 11) * 0x1p-53; }
  std::size_t index(std::size_t count) { return std::size_t(generator_() % count); }
  /// Every coordinate uniform in [-size, size).
  Vec3 vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size);
    return {x, y, (*this)(-size, size)};
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace toothpath::test
