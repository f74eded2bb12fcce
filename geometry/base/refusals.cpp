#include "geometry/base/refusals.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath {

std::optional<double> that_does(double from, double to, const std::function<bool(double)>& does) {
  constexpr int kTried = 16, kCloser = 20;
  double bad = from;
  for (int k = 1; k <= kTried; ++k) {
    double good = from + (to - from) * k / kTried;
    if (!does(good)) {
      bad = good;
      continue;
    }
    for (int n = 0; n < kCloser; ++n) {
      const double x = 0.5 * (bad + good);
      (does(x) ? good : bad) = x;
    }
    return good;
  }
  return {};
}

double told_upwards(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / digit - 1e-9) * digit;
}

double told_that_does(double from, double ratio, double most, const std::function<bool(double)>& does) {
  double told = told_upwards(from);
  while (told < most && !does(told)) told = told_upwards(ratio * told);
  return told;
}

namespace {

constexpr double kMostLength = 1e5, kMostHelixAngle = 60;  // mm, deg
constexpr std::size_t kMostZones = 2;

}  // namespace

void Refusals::add(Refusal refusal) {
  const bool said = std::any_of(refusals.begin(), refusals.end(), [&](const Refusal& r) {
    return r.key == refusal.key && r.diagnostic.message == refusal.diagnostic.message;
  });
  if (!said) refusals.push_back(std::move(refusal));
}

void Refusals::range(const std::string& key, double value, double low, double high, const char* unit) {
  if (!(value >= low && value <= high))
    refuse(key, "{} = {:.6g}{} is outside [{:g}, {:g}]{}", key.substr(key.rfind('.') + 1), value, unit, low, high,
           unit);
}

void Refusals::integer_range(const char* key, int value, int low, int high) {
  if (value < low || value > high) refuse(key, "{} = {} is outside [{}, {}]", key, value, low, high);
}

void Refusals::positive(const char* key, double value_mm) {
  if (!(value_mm > 0 && value_mm < kMostLength))
    refuse(key, "{} = {:.6g} mm is outside (0, {:.0f}) mm", key, value_mm, kMostLength);
}

void Refusals::not_negative(const char* key, double value_mm) {
  if (!(value_mm >= 0)) refuse(key, "{} = {:.6g} mm is below 0", key, value_mm);
}

void Refusals::zone_count(std::size_t zones) {
  if (zones == 0) refuse("zone", "the gear has no zone: at least 1 is needed");
  if (zones > kMostZones) refuse("zone", "{} zones exceed the limit {}", zones, kMostZones);
}

void Refusals::helix_angle(std::size_t zone, double helix_angle_rad) {
  const double beta = degrees(helix_angle_rad);
  if (!(std::abs(beta) <= kMostHelixAngle))
    refuse(zone_key(zone, "helix_angle"), "helix_angle = {:.6g} deg is outside [-{:g}, {:g}] deg", beta,
           kMostHelixAngle, kMostHelixAngle);
}

}  // namespace toothpath
