#include "postproc/self_test/dials.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toothpath::self_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kSeenShare = 1e-6;  // of an error, in the reading: below it is round-off
constexpr int kDirections = 720;     // of an error across an axis

using Readings = std::vector<Vec3>;

/// Joints at the stations, by the machine file.
std::vector<machines::Joints> joints_of(const SelfTest& test, const machines::KinematicChain& chain) {
  std::vector<machines::Joints> out;
  for (const SelfTestStation& station : test.stations)
    out.push_back(chain.linear_for(test.point_mm, station.rotary_rad, test.tool_length_mm));
  return out;
}

machines::RotaryAxis& axis_of(machines::KinematicChain& chain, std::size_t k) {
  return k < chain.table.size() ? chain.table[k] : chain.head[k - chain.table.size()];
}

class Sights {
 public:
  Sights(const SelfTest& test, const machines::KinematicChain& chain)
      : test_(test), chain_(chain), joints_(joints_of(test, chain)) {}

  std::vector<DialSight> all() const {
    std::vector<DialSight> out;
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
      const char letter = chain_.rotary(k).letter;
      out.push_back({DialSight::Kind::sense, k, fmt::format("sense of {}", letter), sense(k)});
      out.push_back({DialSight::Kind::axis, k, fmt::format("place of {}", letter), place(k)});
      out.push_back({DialSight::Kind::zero, k, fmt::format("zero of {}", letter), zero(k)});
    }
    out.push_back({DialSight::Kind::length, chain_.rotary_count(), "length of the bar", length()});
    return out;
  }

 private:
  /// What the dials show while another machine stands where these joints take it.
  Readings readings(const machines::KinematicChain& real, double bar_mm) const {
    Readings out;
    for (const machines::Joints& j : joints_)
      out.emplace_back(real.forward(j, bar_mm).tip_mm - real.forward(joints_.front(), bar_mm).tip_mm);
    return out;
  }
  static double shown(const Vec3& reading) { return reading.cwiseAbs().maxCoeff(); }

  std::vector<double> sense(std::size_t k) const {
    machines::KinematicChain real = chain_;
    axis_of(real, k).sign *= -1;
    std::vector<double> out;
    for (const Vec3& r : readings(real, test_.tool_length_mm)) out.push_back(shown(r));
    return out;
  }
  /// Readings follow the place of an axis linearly; of all directions across it the one that shows least counts.
  std::vector<double> place(std::size_t k) const {
    const Vec3& d = chain_.rotary(k).direction;
    const Vec3 e = d.unitOrthogonal(), f = d.cross(e);
    const auto moved = [&](const Vec3& by) {
      machines::KinematicChain real = chain_;
      axis_of(real, k).point_mm += by;
      return readings(real, test_.tool_length_mm);
    };
    const Readings along_e = moved(e), along_f = moved(f);
    std::vector<double> out;
    for (std::size_t s = 0; s < joints_.size(); ++s) {
      double least = kNone;
      for (int n = 0; n < kDirections; ++n) {
        const double phi = n * kPi / kDirections;
        least = std::min(least, shown(std::cos(phi) * along_e[s] + std::sin(phi) * along_f[s]));
      }
      out.push_back(least_error(least * std::cos(kPi / kDirections)));
    }
    return out;
  }
  std::vector<double> zero(std::size_t k) const {
    constexpr double kTurn = 1e-5;  // rad
    machines::KinematicChain real = chain_;
    axis_of(real, k).zero_rad += kTurn;
    std::vector<double> out;
    for (const Vec3& r : readings(real, test_.tool_length_mm)) out.push_back(least_error(shown(r) / degrees(kTurn)));
    return out;
  }
  std::vector<double> length() const {
    std::vector<double> out;
    for (const Vec3& r : readings(chain_, test_.tool_length_mm + 1)) out.push_back(least_error(shown(r)));
    return out;
  }
  /// From what an error of 1 shows.
  static double least_error(double share) { return share > kSeenShare ? kDialStep_mm / share : kNone; }

  const SelfTest& test_;
  const machines::KinematicChain& chain_;
  std::vector<machines::Joints> joints_;
};

}  // namespace

double DialSight::least() const {
  if (at.empty()) return kNone;
  return kind == Kind::sense ? *std::max_element(at.begin(), at.end()) : *std::min_element(at.begin(), at.end());
}

std::vector<DialSight> dial_sights(const SelfTest& test, const machines::KinematicChain& chain) {
  return Sights(test, chain).all();
}

}  // namespace toothpath::self_test
