#include "tests/support/brute_force_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "tests/support/modified_flank.h"

namespace toothpath::test {
namespace {
constexpr double kPiHere = 3.14159265358979323846;
const double kNan = std::numeric_limits<double>::quiet_NaN();

/// Azimuth of the modified flank at radius r and height z: the plain place is moved until the modified point is there.
double modified_azimuth(const face_gear::FaceGear& gear, int zone, int side, double r, double z,
                        std::optional<face_gear::FlankCoordinates>& near) {
  const auto& f = gear.rings().at(std::size_t(zone)).surface;
  double r_plain = r, z_plain = z;
  for (int k = 0; k < 8; ++k) {
    near = face_gear::invert_flank(f, side, r_plain, z_plain, near);
    if (!near || near->theta < 0) return kNan;
    if (gear.parameters().modifications.empty()) return face_gear::flank_azimuth(f, side, *near);
    const Vec3 p = modified_by_the_words<double>(f, gear.parameters(), zone, side, near->theta, near->B),
               plain = f.flank(side, near->theta, near->B).p;
    r_plain += r - std::hypot(p.x(), p.y());
    z_plain += z - p.z();
    if (k == 7)
      return face_gear::flank_azimuth(f, side, *near) +
             std::atan2(plain.x() * p.y() - plain.y() * p.x(), plain.x() * p.x() + plain.y() * p.y());
  }
  return kNan;
}
}  // namespace

PinionByTheWords::PinionByTheWords(const face_gear::FaceGear& gear, int zone, int side, int teeth,
                                   const contact::Misalignment& moved,
                                   const std::vector<modification::Modification>& modifications)
    : side_(side), zone_(zone), modifications_(modifications) {
  const face_gear::FaceGearRing& ring = gear.rings().at(std::size_t(zone));
  const auto& f = ring.surface;
  const auto& parameters = gear.parameters();
  const double m_t = f.shaper.m_t, r_p = m_t * teeth / 2;
  alpha_ = f.shaper.alpha_t;
  r_b_ = r_p * std::cos(alpha_);
  r_a_ = r_p + parameters.addendum_coefficient * parameters.module_mm;
  twist_ = std::tan(ring.zone.helix_angle_rad) / r_p;
  L0_ = f.L0;
  space_ = kPiHere / (2 * teeth);
  depth_ = 2 * parameters.addendum_coefficient * parameters.module_mm;
  const auto section = [&](double r) {  // where the pitch line is at radius r
    return (std::sqrt(r * r - f.E * f.E) + m_t * f.shaper.teeth / 2 * f.Cg) / f.Sg;
  };
  from_ = section(ring.zone.inner_radius_mm);
  to_ = section(ring.zone.outer_radius_mm);
  const double g = parameters.shaft_angle_rad, g_moved = g + moved.angle_rad;
  placed_.a = {std::sin(g_moved), 0, -std::cos(g_moved)};
  placed_.d = {-std::cos(g_moved), 0, -std::sin(g_moved)};
  placed_.b = {0, 1, 0};
  placed_.foot = Vec3(0, parameters.offset_mm + moved.offset_mm, moved.gear_axial_mm) +
                 0.5 * m_t * (f.shaper.teeth - teeth) * Vec3(-std::cos(g), 0, -std::sin(g)) +
                 moved.axial_mm * placed_.a;
}

Vec3 PinionByTheWords::plain(double R, double Z) const {
  const double roll = std::acos(std::min(1.0, r_b_ / R));
  // Half the space grows outwards: on the pitch circle `space_`, elsewhere plus the difference of the involute
  // functions.
  const double half = space_ + (std::tan(roll) - roll) - (std::tan(alpha_) - alpha_),
               angle = side_ * half + twist_ * (Z - L0_);
  return {R * std::cos(angle), R * std::sin(angle), Z};
}

Vec3 PinionByTheWords::own(double R, double Z) const {
  const Vec3 q = plain(R, Z);
  double taken = 0;
  for (const auto& m : modifications_)
    if (m.meets(side_, zone_)) taken += taken_by_the_words<double>(m, r_a_ - R, Z, depth_, from_, to_);
  if (taken == 0 || R <= r_b_ + 1e-3) return q;
  const double h = 1e-4;  // into the material: away from the space
  Vec3 into = (plain(R + h, Z) - plain(R - h, Z)).cross(plain(R, Z + h) - plain(R, Z - h)).normalized();
  if (side_ * (q.x() * into.y() - q.y() * into.x()) < 0) into = -into;
  return q + taken * into;
}

BruteForceContact::BruteForceContact(const face_gear::FaceGear& gear, int zone, int side, int pinion_teeth,
                                     const contact::Misalignment& moved,
                                     const std::vector<modification::Modification>& on_pinion)
    : side_(side), pinion_teeth_(pinion_teeth) {
  const face_gear::FaceGearRing& ring = gear.rings().at(std::size_t(zone));
  const auto& f = ring.surface;
  const auto& parameters = gear.parameters();
  pitch_ = 2 * kPiHere / parameters.teeth;
  r_in_ = ring.zone.inner_radius_mm;
  r_out_ = ring.zone.outer_radius_mm;

  // The gear's cloud: azimuth over columns of constant radius, even in height between the fillet line and the tip.
  columns_ = 301;
  rows_ = 121;
  azimuth_.resize(std::size_t(columns_ * rows_));
  for (int c = 0; c < columns_; ++c) {
    const double r = r_in_ + (r_out_ - r_in_) * c / (columns_ - 1);
    low_.push_back(*face_gear::fillet_line_height(f, side, r));
    top_.push_back(f.z_tip(r));
    std::optional<face_gear::FlankCoordinates> near;
    for (int k = 0; k < rows_; ++k) {
      const double z = low_.back() + (top_.back() - low_.back()) * k / (rows_ - 1);
      azimuth_[std::size_t(c * rows_ + k)] = modified_azimuth(gear, zone, side, r, z, near);
    }
  }

  // The pinion's cloud, in its own axes.
  const PinionByTheWords pinion(gear, zone, side, pinion_teeth, moved, on_pinion);
  const double Z_from = std::sqrt(r_in_ * r_in_ - 900) - 4, Z_to = r_out_ + 4;
  const int along = 900, high = 240;
  for (int n = 0; n < along; ++n)
    for (int k = 0; k < high; ++k) {
      const double Z = Z_from + (Z_to - Z_from) * n / (along - 1),
                   R = pinion.r_b() + (pinion.r_a() - pinion.r_b()) * k / (high - 1);
      pinion_.push_back(pinion.own(R, Z));
    }
  placed_ = pinion.placed();
}

double BruteForceContact::azimuth_at(double r, double z) const {
  if (r < r_in_ || r > r_out_) return kNan;
  const double place = (r - r_in_) / (r_out_ - r_in_) * (columns_ - 1);
  const int c = std::min(columns_ - 2, int(place));
  double value[2];
  for (const int k : {0, 1}) {
    const auto column = std::size_t(c + k);
    const double height = (z - low_[column]) / (top_[column] - low_[column]) * (rows_ - 1);
    if (height < 0 || height > rows_ - 1) return kNan;
    const int row = std::min(rows_ - 2, int(height));
    const double* from = &azimuth_[column * std::size_t(rows_) + std::size_t(row)];
    value[k] = from[0] + (height - row) * (from[1] - from[0]);
  }
  return value[0] + (place - c) * (value[1] - value[0]);
}

double BruteForceContact::gear_turn(double phi_1) const {
  // The gear's flank of side +1 lies on the pinion from below in azimuth: the least turn; side -1 the greatest.
  double best = std::numeric_limits<double>::quiet_NaN();
  for (int tooth = -2; tooth <= 2; ++tooth) {
    const double turn = phi_1 + tooth * 2 * kPiHere / pinion_teeth_, c = std::cos(turn), s = std::sin(turn);
    for (const Vec3& q : pinion_) {
      const double x = c * q.x() - s * q.y(), y = s * q.x() + c * q.y();
      const Vec3 p = placed_.foot + q.z() * placed_.a + x * placed_.d + y * placed_.b;
      const double azimuth = azimuth_at(std::hypot(p.x(), p.y()), p.z());
      if (std::isnan(azimuth)) continue;
      const double needed = std::atan2(p.y(), p.x()) - azimuth - tooth * pitch_;
      if (std::isnan(best) || side_ * needed < side_ * best) best = needed;
    }
  }
  return best;
}

}  // namespace toothpath::test
