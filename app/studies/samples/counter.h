// Random numbers by counter: each is a function of seed, sample and draw alone, so that a sample is the same wherever
// and after whatever it is computed. Source: SplitMix64, G. L. Steele, D. Lea, C. H. Flood, Fast splittable
// pseudorandom number generators, 2014.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/base/angle.h"

namespace toothpath::samples {

class Numbers {
 public:
  Numbers(std::uint64_t seed, std::uint64_t sample) : state_(mixed(mixed(seed) ^ sample)) {}

  /// 64 bits of draw `n`.
  [[nodiscard]] std::uint64_t bits(std::uint64_t n) const { return mixed(state_ + n * kGamma); }
  /// In [0, 1), 53 bits.
  [[nodiscard]] double share(std::uint64_t n) const { return double(bits(n) >> 11) * 0x1p-53; }
  /// 0 .. count - 1; count > 0.
  [[nodiscard]] int whole(std::uint64_t n, int count) const { return int(share(n) * count); }
  /// Normal, mean 0, standard deviation 1 (Box and Muller 1958). Uses the draws 2 n and 2 n + 1.
  [[nodiscard]] double normal(std::uint64_t n) const {
    return std::sqrt(-2 * std::log(1 - share(2 * n))) * std::cos(2 * kPi * share(2 * n + 1));
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9e3779b97f4a7c15ULL;
  static std::uint64_t mixed(std::uint64_t z) {
    z += kGamma;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace toothpath::samples
