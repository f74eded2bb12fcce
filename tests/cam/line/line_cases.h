// The gears, tools and worked poses that the tests of line milling speak of. The expected numbers were made by an
// independent program: closed forms of its own, checked against a brute-force sweep of the shaper.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "cam/line/pose.h"
#include "cam/tool/profile.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/flank_foot.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "geometry/face_gear/part.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {

inline tool::RadiusLaw<double> tapered(double r_0, double half_angle_deg = 5) {
  tool::RadiusLaw<double> law;
  law.r_0 = r_0;
  law.sin_tau = std::sin(radians(half_angle_deg));
  law.cos_tau = std::cos(radians(half_angle_deg));
  return law;
}

/// A tapered mill as it is ordered, in a slim holder.
inline tool::CutterData tapered_mill(double diameter, double half_angle_deg, double flute, double shank,
                                     double stick_out) {
  tool::CutterData d;
  d.shape = tool::CutterShape::tapered_ball;
  d.diameter_mm = diameter;
  d.half_angle_rad = radians(half_angle_deg);
  d.flute_length_mm = flute;
  d.shank_diameter_mm = shank;
  d.stick_out_mm = stick_out;
  d.length_mm = 92;
  d.holder = {{10, 10, 30}, {32, 32, 30}};
  return d;
}

/// A gear as a part, kept as long as the tests run.
inline const tooth_space::ToothedPart& kept(const face_gear::FaceGear& gear) {
  static std::deque<std::shared_ptr<const tooth_space::ToothedPart>> parts;
  return *parts.emplace_back(face_gear::part_of(gear));
}

/// A flank of a face gear as line milling asks for it, and its closed forms. Those speak of tooth 0; flank -1 of the
/// task belongs to tooth 1.
struct FaceFlank : line::FlankTask {
  face_gear::FaceGearSurface<double> surface;
  double z_tip = 0, z_end = 0, theta_end = 0;

  FaceFlank(const face_gear::FaceGear& gear, int of_zone, int of_side)
      : line::FlankTask(*line::flank_task(kept(gear), of_zone, of_side)),
        surface(gear.rings()[std::size_t(of_zone)].surface),
        z_tip(surface.z_tip(0.5 * (s_from + s_to))),
        z_end(*face_gear::fillet_line_height(surface, side, 0.5 * (s_from + s_to))),
        theta_end(surface.shaper.theta_t) {}
  /// From the space to tooth 0 and back.
  [[nodiscard]] Vec3 own(const Vec3& p) const { return side > 0 ? p : turned(p, -surface.pitch); }
  [[nodiscard]] Vec3 spaced(const Vec3& p) const { return side > 0 ? p : turned(p, surface.pitch); }
  [[nodiscard]] line::AxisLine<double> own(const line::AxisLine<double>& axis) const {
    return {own(axis.c_0), own(axis.a)};
  }
  [[nodiscard]] line::Place place(double r, double z) const {
    const auto at = face_gear::invert_flank(surface, side, r, z);
    return {at->theta, at->B};
  }
};

/// Shape operator of a flank by its closed forms, in the frame of tooth 0.
template <typename S>
line::TangentShape<S> closed_shape(const face_gear::FaceGearSurface<S>& f, int side,
                                   const face_gear::FlankParameters<S>& at) {
  const auto H = f.flank_shape(side, at.theta, at.B);
  const auto b = f.flank_basis(side, at.theta, at.B);
  const auto frame = line::tangent_frame<S>(side, f.flank(side, at.theta, at.B).n, Vec3T<S>(S(0), S(0), S(1)));
  return {frame, b.e, b.l, Vec3T<S>(b.e * H.ee + b.l * H.el), Vec3T<S>(b.e * H.el + b.l * H.ll)};
}
template <typename S>
std::optional<S> closed_lean(const face_gear::FaceGearSurface<S>& f, int side, const face_gear::FlankParameters<S>& at,
                             const S& distance) {
  return line::lean<S>(closed_shape<S>(f, side, at), distance);
}

/// d'' along an axis at height t, by the shape operator at the foot.
inline double bend_along(const line::FlankTask& f, const line::AxisLine<double>& axis, double t,
                         const line::Place& start) {
  const auto foot = f.space->foot(f.piece(), axis.at(t), start.u, start.v);
  const auto frame = f.frame(foot->at);
  return line::distance_bend<double>(frame, line::shape_at(frame, foot->at), foot->distance, axis.a);
}
/// d''' there, by fourth-order differences. 1/mm^2
inline double third_along(const line::FlankTask& f, const line::AxisLine<double>& axis, double t,
                          const line::Place& start) {
  const double h = 0.02 * f.module_mm;
  const auto rise = [&](double x) { return bend_along(f, axis, t + x, start) - bend_along(f, axis, t - x, start); };
  return (8 * rise(h) - rise(2 * h)) / (12 * h);
}
/// What the best pose leaves of a gap with this third derivative over a line of half length h along the axis: the
/// Chebyshev polynomial T_3 stood on zero. mm
inline double left_estimate(double third, double half_length) {
  return std::abs(third) * half_length * half_length * half_length / 12;
}

/// One flank of one gear and the ball radius of its mill, 5 deg; then what the independent study found, um: misfit of
/// the best poses, left and gouge of the swept pass.
struct LineCase {
  std::string name;
  face_gear::FaceGearParameters gear;
  int zone = 0, side = 1;
  double r_0 = 0;
  double best = 0, left = 0, gouge = 0;

  [[nodiscard]] FaceFlank task() const { return {made(gear), zone, side}; }
};
inline std::ostream& operator<<(std::ostream& out, const LineCase& c) { return out << c.name; }

inline const std::vector<LineCase>& line_cases() {
  static const std::vector<LineCase> cases = {
      {"inner_plus", quarter_dhfg(), 0, 1, 0.25, 0.58, 0.65, 0.04},
      {"inner_minus", quarter_dhfg(), 0, -1, 0.25, 1.2, 1.24, 0.19},
      {"outer_plus", quarter_dhfg(), 1, 1, 0.25, 0.22, 0.31, 0.21},
      {"outer_minus", quarter_dhfg(), 1, -1, 0.25, 0.21, 0.31, 0.03},
      {"paper_inner_plus", double_helical_parameters(), 0, 1, 1.0, 2.3, 2.6, 0.2},
      {"paper_inner_minus", double_helical_parameters(), 0, -1, 1.0, 4.3, 5.0, 0.8},
      {"paper_outer_plus", double_helical_parameters(), 1, 1, 1.0, 0.9, 1.1, 1.0},
      {"paper_outer_minus", double_helical_parameters(), 1, -1, 1.0, 0.84, 1.2, 0.1},
      {"offset_plus", offset_gear(), 0, 1, 0.8, 3.2, 5.7, 0.1},
      {"offset_minus", offset_gear(), 0, -1, 0.8, 2.8, 4.3, 1.4},
      {"spur_plus", small_spur(), 0, 1, 0.4, 3.1, 3.0, 0.05},
      {"spur_minus", small_spur(), 0, -1, 0.4, 3.1, 3.0, 0.05},
  };
  return cases;
}

/// A worked pose: anchor radius and height, flank parameters there, leans in degrees at the surface and 0.5 mm above
/// it; the pose, and its gap at five even heights of the line, um.
struct WorkedPose {
  std::string name;
  face_gear::FaceGearParameters gear;
  int zone, side;
  double r, z, theta, B, J, lean_surface, lean_half;
  double r_0;
  Vec3 tip, axis;
  double lean, eps, length;
  std::array<double, 5> gap;
  double left, estimate;
};
inline std::ostream& operator<<(std::ostream& out, const WorkedPose& c) { return out << c.name; }

inline const std::vector<WorkedPose>& worked_poses() {
  static const std::vector<WorkedPose> poses = {
      {"outer_plus",
       quarter_dhfg(),
       1,
       1,
       121.5,
       -18.75,
       0.402102835,
       0.541566585,
       3561.029154,
       -29.910061,
       -29.701974,
       0.25,
       {121.771010347, 4.472918238, -20.192451906},
       {-0.250739641470, -0.530444911912, 0.809788754937},
       -29.8507,
       0.0078,
       3.375951,
       {0.1566, 0.0003, 0.0862, 0.1559, -0.0059},
       0.157,
       0.156},
      {"outer_minus",
       quarter_dhfg(),
       1,
       -1,
       121.5,
       -18.75,
       0.387362548,
       -0.493503457,
       3768.036650,
       31.795476,
       32.000970,
       0.25,
       {121.110709768, -0.123465244, -20.200413003},
       {0.290759195796, 0.517290556940, 0.804903453690},
       31.9450,
       0.0084,
       3.383296,
       {0.1618, 0.0001, 0.0763, 0.1634, -0.0085},
       0.163,
       0.164},
      {"inner_plus",
       quarter_dhfg(),
       0,
       1,
       114.625,
       -18.75,
       0.366122040,
       0.388193126,
       2172.494285,
       35.695830,
       35.973529,
       0.25,
       {113.962258049, 4.161948353, -20.128801889},
       {0.420945554446, -0.448095211580, 0.788679606400},
       36.0462,
       0.0224,
       3.309971,
       {0.4333, 0.0012, 0.1891, 0.4301, -0.0297},
       0.433,
       0.427},
      {"inner_minus",
       quarter_dhfg(),
       0,
       -1,
       114.625,
       -18.75,
       0.368847833,
       -0.409487789,
       1614.253205,
       -36.855988,
       -36.536866,
       0.25,
       {115.233331184, -0.198764998, -20.071005647},
       {-0.423056181432, 0.466165665206, 0.776989729620},
       -36.8943,
       0.0336,
       3.302580,
       {0.6667, 0.0068, 0.4011, 0.6481, -0.0399},
       0.667,
       0.622},
      {"offset_plus",
       offset_gear(),
       0,
       1,
       138.75,
       -37.5,
       0.375719208,
       0.446779292,
       4157.892319,
       8.617058,
       8.828056,
       0.8,
       {136.989226344, 19.894793756, -41.051382754},
       {0.154753224330, -0.347027970448, 0.924998933667},
       9.0697,
       0.0265,
       6.942498,
       {1.0618, 0.0002, 0.5125, 1.0653, -0.0588},
       1.065,
       1.069},
      {"spur_plus",
       small_spur(),
       0,
       1,
       62.5,
       -20,
       0.375417200,
       0.445372386,
       814.880986,
       1.832810,
       2.309173,
       0.4,
       {62.373258358, 3.072515596, -22.246341561},
       {0.040169744789, -0.349312042050, 0.936145014879},
       2.3535,
       0.0558,
       4.506171,
       {1.4544, -0.0004, 0.7454, 1.4605, -0.0904},
       1.460,
       1.453},
  };
  return poses;
}

}  // namespace toothpath::test
