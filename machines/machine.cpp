#include "machines/machine.h"

#include <algorithm>
#include <cmath>

namespace toothpath::machines {

namespace {

constexpr double kUpright = 1e-9;  // sine of the lean of an upright axis
constexpr double kCrosses = 1e-3;  // and the least sine between an axis and the table's face that it crosses

/// The limit stands at every axis.
bool stated(const KinematicChain& chain, double LinearAxis::*linear, double RotaryAxis::*rotary) {
  for (const auto& axis : chain.linear)
    if (!(axis.*linear > 0)) return false;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k)
    if (!(chain.rotary(k).*rotary > 0)) return false;
  return true;
}

}  // namespace

std::optional<double> Machine::top_under(const Vec3& at) const {
  std::optional<double> top;
  for (const MachineBody& body : bodies) {
    if (body.link != 0) continue;
    double high = 0;
    if (const auto* box = std::get_if<BoxShape>(&body.shape)) {
      if (((at - box->low).head<2>().array() < 0).any() || ((box->high - at).head<2>().array() < 0).any()) continue;
      high = box->high.z();
    } else if (const auto* cone = std::get_if<ConeShape>(&body.shape)) {
      const bool upright = (cone->to - cone->from).head<2>().norm() <= kUpright * (cone->to - cone->from).norm();
      if (!upright || (at - cone->from).head<2>().norm() > std::max(cone->radius_from, cone->radius_to)) continue;
      high = std::max(cone->from.z(), cone->to.z());
    } else {
      continue;
    }
    if (high <= at.z() && (!top || high > *top)) top = high;
  }
  return top;
}

Vec3 Machine::table_middle_mm() const {
  const RotaryAxis& axis = chain.table.front();
  Vec3 middle = axis.point_mm;
  if (!table_face_mm) return middle;
  if (std::abs(axis.direction.z()) > kCrosses)
    middle += (*table_face_mm - middle.z()) / axis.direction.z() * axis.direction;
  middle.z() = *table_face_mm;
  return middle;
}

bool Machine::has_acceleration() const {
  return stated(chain, &LinearAxis::max_acceleration, &RotaryAxis::max_acceleration);
}

bool Machine::has_jerk() const { return stated(chain, &LinearAxis::max_jerk, &RotaryAxis::max_jerk); }

SourcePosition Machine::where(std::string_view key) const {
  const auto found = positions.find(key);
  return found == positions.end() ? SourcePosition{file, 0, 0} : found->second;
}

double Machine::top_mm() const {
  const std::vector<double>& reference = post.reference_positions[0];
  if (post.retracts_to_reference && reference.size() > 2) return reference[2];
  return chain.linear[2].max_mm - limit_margin.linear_mm;
}

double Machine::exact_corner_mm() const {
  constexpr double kUsual = 0.0005, kPeriod = 0.001 / 60;  // mm, min
  double square = 0;
  for (const auto& axis : chain.linear) square += axis.max_acceleration * axis.max_acceleration;
  double turning = 0;  // with TCP the words of X, Y and Z are the tip
  for (std::size_t k = 0; k < chain.rotary_count() && tcp == TcpMode::none; ++k)
    turning += chain.rotary(k).max_acceleration;
  const double tip = std::sqrt(square) + turning * largest_part_mm() / 2;
  return post.corner_tolerance_mm.value_or(std::max(kUsual, tip * kPeriod * kPeriod / 4));
}

Status check_part_fits(const Machine& machine, double part_diameter_mm) {
  if (part_diameter_mm <= machine.largest_part_mm()) return Ok{};
  return fail("part diameter = {:.4f} mm exceeds {:.4f} mm, the largest that turns on {}", part_diameter_mm,
              machine.largest_part_mm(), machine.name);
}

}  // namespace toothpath::machines
