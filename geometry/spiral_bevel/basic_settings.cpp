#include "geometry/spiral_bevel/basic_settings.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/spiral_bevel/set_up.h"

namespace toothpath::spiral_bevel {
namespace {

// Gleason's proportions of spiral bevel gears, in outer transverse modules.
constexpr double kWorkingDepth = 1.7, kClearance = 0.188, kWheelAddendum = 0.46, kOfRatio = 0.39;
constexpr double kMostTaper = 1.3;           // of the dedendum angles of standard taper (ISO 23509)
constexpr double kMostPitch = 88 * kDegree;  // of either gear: a crown gear has no cone to roll on
constexpr int kRounds = 40;
constexpr double kSettled = 1e-10;  // rad, and of the module

/// Heights in the middle of the face, and the angles of root and face against the pitch cone.
struct Proportions {
  double addendum = 0, dedendum = 0, mate_addendum = 0;
  double dedendum_angle = 0, addendum_angle = 0;
};

Proportions proportions(const Drawing& d) {
  const double R_e = outer_cone_distance(d), R_m = R_e - 0.5 * d.face_width_mm,
               m = d.outer_transverse_module_mm * R_m / R_e;
  // (z1/z2)^2 of the pair at 90 deg with the same cones' curvatures: z1 cos(d2)/(z2 cos(d1)).
  const double own = pitch_angle(d), other = d.shaft_angle_rad - own,
               ratio_2 = d.teeth <= d.mate_teeth ? d.teeth * std::cos(other) / (d.mate_teeth * std::cos(own))
                                                 : d.mate_teeth * std::cos(own) / (d.teeth * std::cos(other)),
               of_wheel = m * (kWheelAddendum + kOfRatio * ratio_2), of_pinion = kWorkingDepth * m - of_wheel;
  Proportions p;
  p.addendum = d.teeth <= d.mate_teeth ? of_pinion : of_wheel;
  p.mate_addendum = kWorkingDepth * m - p.addendum;
  p.dedendum = p.mate_addendum + kClearance * m;
  // Duplex taper: the sum of the dedendum angles with which both flanks of a space of one width taper with the pitch.
  const double standard = std::atan(p.dedendum / R_m) + std::atan((p.addendum + kClearance * m) / R_m),
               crown = R_e / (0.5 * d.outer_transverse_module_mm),
               duplex = 0.5 * kPi / (crown * std::tan(d.pressure_angle_rad) * std::cos(d.spiral_angle_rad)) *
                        (1 - R_m * std::sin(d.spiral_angle_rad) / d.cutter_radius_mm) * 2;
  const double sum = std::clamp(duplex, 0.0, kMostTaper * standard);
  p.dedendum_angle = sum * p.mate_addendum / (kWorkingDepth * m);
  p.addendum_angle = sum - p.dedendum_angle;
  return p;
}

/// What the flanks of a set-up are in the middle of the face, on the pitch cone.
struct Middle {
  std::array<double, 2> pressure_rad{}, spiral_rad{};
};
Middle middle_of(const SetUp& made) {
  const CutterKernel& k = made.kernel;
  const tooth_space::Chart chart{-k.sin_d, k.cos_d};
  Middle out;
  for (std::size_t i = 0; i < 2; ++i) {
    Vec3 p, n;
    (void)k.place<double>(tooth_space::flank_of((i == 0 ? 1 : -1) * k.hand), k.middle[i].x(), k.middle[i].y(), p, n);
    const double about = azimuth(p);
    out.pressure_rad[i] = std::asin(n.dot(chart.up_at(about)));
    out.spiral_rad[i] = std::atan(k.hand * n.dot(chart.along_at(about)) / (p.x() * n.y() - p.y() * n.x()) * radius(p));
  }
  return out;
}
}  // namespace

double pitch_angle(const Drawing& d) {
  return std::atan2(std::sin(d.shaft_angle_rad), double(d.mate_teeth) / d.teeth + std::cos(d.shaft_angle_rad));
}

std::optional<double> shaft_angle_of(double pitch_angle_rad, double ratio) {
  const double sine = ratio * std::sin(pitch_angle_rad);
  if (!(sine < 1)) return {};
  return pitch_angle_rad + std::asin(sine);
}

double outer_cone_distance(const Drawing& d) {
  return 0.5 * d.outer_transverse_module_mm * d.teeth / std::sin(pitch_angle(d));
}

Expected<SpiralBevelParameters, Refusal> basic_settings(const Drawing& d, double edge_radius_mm) {
  const double delta = pitch_angle(d), R_e = outer_cone_distance(d), R_m = R_e - 0.5 * d.face_width_mm,
               alpha = d.pressure_angle_rad, beta = d.spiral_angle_rad, r_c = d.cutter_radius_mm;
  if (const double other = d.shaft_angle_rad - delta; !(delta < kMostPitch && other < kMostPitch)) {
    const double ratio = double(std::min(d.teeth, d.mate_teeth)) / std::max(d.teeth, d.mate_teeth);
    return Refusal{
        "shaft_angle",
        fail("shaft_angle = {:.4f} deg: the wheel's pitch angle of {:.4f} deg is not below {:g} deg, teeth on "
             "the outside of a cone; a shaft angle below {:.4f} deg would do",
             degrees(d.shaft_angle_rad), degrees(std::max(delta, other)), degrees(kMostPitch),
             degrees(kMostPitch + std::asin(ratio * std::sin(kMostPitch))))};
  }
  const Proportions depth = proportions(d);
  SpiralBevelParameters p;
  p.teeth = d.teeth;
  p.hand = d.hand;
  p.shaft_angle_rad = d.shaft_angle_rad;
  p.pitch_angle_rad = delta;
  p.outer_cone_distance_mm = R_e;
  p.face_width_mm = d.face_width_mm;
  p.tip_angle_rad = delta + depth.addendum_angle;
  const double slope = std::tan(depth.addendum_angle);
  p.tip_apex_mm = (depth.addendum - slope * R_m) / (std::sin(delta) + slope * std::cos(delta));
  const double space =
      kPi * R_m * std::sin(delta) / d.teeth - (depth.addendum - depth.mate_addendum) * std::tan(alpha) / std::cos(beta);
  Cut cut;
  cut.root_angle_rad = delta - depth.dedendum_angle;
  // The cradle's axis passes the pitch apex, and the work rolls without slip on the pitch line.
  cut.ratio_of_roll = std::cos(depth.dedendum_angle) / std::sin(delta);
  cut.sliding_base_mm = R_m * std::sin(depth.dedendum_angle) - depth.dedendum * std::cos(depth.dedendum_angle);
  p.cuts = {cut};
  double spiral = beta, width = space * std::cos(beta) - 2 * depth.dedendum * std::tan(alpha);
  std::array<double, 2> pressure{alpha, alpha};
  for (int round = 0;; ++round) {
    Cut& c = p.cuts.front();
    const double across = R_m * std::cos(depth.dedendum_angle) - r_c * std::sin(spiral), along = r_c * std::cos(spiral);
    c.radial_distance_mm = std::hypot(across, along);
    c.cradle_angle_rad = std::atan2(along, across);
    for (std::size_t i = 0; i < 2; ++i)
      c.blades[i] = {r_c + (i == 0 ? 0.5 : -0.5) * width, pressure[i], edge_radius_mm};
    const auto made = set_up(p);
    if (const Refusal* refusal = made.refused()) return *refusal;
    const Middle is = middle_of(made.value());
    const double turn = beta - 0.5 * (is.spiral_rad[0] + is.spiral_rad[1]),
                 lacks = (space - made.value().space_width_mm) * std::cos(beta);
    double off = std::abs(turn) + std::abs(lacks) / d.outer_transverse_module_mm;
    spiral += turn;
    width += lacks;
    for (std::size_t i = 0; i < 2; ++i) {
      off += std::abs(alpha - is.pressure_rad[i]);
      pressure[i] += alpha - is.pressure_rad[i];
    }
    if (off < kSettled) return p;
    if (round == kRounds)
      return Refusal{"cut[0].radial_distance",
                     fail("radial_distance: no place of a cutter of {:.4f} mm radius was found that makes a spiral "
                          "angle of {:.4f} deg at cone distance {:.4f} mm; another cutter radius would help",
                          r_c, degrees(beta), R_m)};
  }
}

}  // namespace toothpath::spiral_bevel
