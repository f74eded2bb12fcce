#include "machines/kinematic_chain.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toothpath::machines {
namespace {

/// An axis this close to the first rotary axis leaves that rotary free: any angle then errs by at most twice this.
constexpr double kPoleAngle = 1e-13;  // rad
/// A wanted axis that misses the reachable directions by no more than this is served by the nearest one. Covers tool
/// axes that went through text; 1e-10 rad moves a tip at 1 m by 1e-7 mm.
constexpr double kReachTolerance = 1e-10;  // rad
/// How far the length of a tool axis may be from 1.
constexpr double kUnitTolerance = 1e-9;
/// Two axes are parallel when the sine between them is below this.
constexpr double kParallelSine = 1e-6;

Vec3 across(const Vec3& v, const Vec3& d) { return v - d.dot(v) * d; }

/// Angle between two vectors, 0..pi, full precision everywhere.

/// Angle of the turn about d that takes the direction of a to that of b; both perpendicular to d.
double turn_angle(const Vec3& a, const Vec3& b, const Vec3& d) { return std::atan2(d.dot(a.cross(b)), a.dot(b)); }

double command_for(const RotaryAxis& axis, double angle_rad) { return axis.zero_rad + axis.sign * angle_rad; }

/// By how much the turn of p about d misses q (Paden-Kahan subproblem 1): the difference of the two cone angles.
double cone_gap(const Vec3& p, const Vec3& q, const Vec3& d) {
  return std::abs(angle_between(p, d) - angle_between(q, d));
}

Diagnostic out_of_reach(const Vec3& u, char letter, double gap_rad) {
  return fail("tool axis ({:.6f}, {:.6f}, {:.6f}) is out of reach of axis {} by {:.6f} deg", u.x(), u.y(), u.z(),
              letter, degrees(gap_rad));
}

}  // namespace

Mat3 RotaryAxis::rotation(double command_rad) const {
  return Eigen::AngleAxisd(sign * (command_rad - zero_rad), direction).toRotationMatrix();
}

std::optional<std::size_t> KinematicChain::rotary_index(char letter) const {
  for (std::size_t k = 0; k < rotary_count(); ++k)
    if (rotary(k).letter == letter) return k;
  return std::nullopt;
}

std::string KinematicChain::letters() const {
  std::string all = "XYZ";
  for (std::size_t k = 0; k < rotary_count(); ++k) all += rotary(k).letter;
  return all;
}

Vec3 KinematicChain::tool_axis_in_machine(const std::array<double, 2>& rotary_rad) const {
  Vec3 u = Vec3::UnitZ();
  for (std::size_t k = rotary_count(); k-- > table.size();) u = rotary(k).rotation(rotary_rad[k]) * u;
  return u;
}

Vec3 KinematicChain::gauge_shift(const std::array<double, 2>& rotary_rad) const {
  Vec3 g = Vec3::Zero();
  for (std::size_t k = rotary_count(); k-- > table.size();)
    g = rotary(k).point_mm + rotary(k).rotation(rotary_rad[k]) * (g - rotary(k).point_mm);
  return g;
}

Vec3 KinematicChain::table_to_machine(const Vec3& point_mm, const std::array<double, 2>& rotary_rad) const {
  Vec3 p = point_mm;
  for (std::size_t k = 0; k < table.size(); ++k)
    p = table[k].point_mm + table[k].rotation(rotary_rad[k]).transpose() * (p - table[k].point_mm);
  return p;
}

TablePose KinematicChain::forward(const Joints& joints, double tool_length_mm) const {
  const auto& theta = joints.rotary_rad;
  Vec3 u = tool_axis_in_machine(theta);
  Vec3 p = joints.linear_mm + gauge_shift(theta) - tool_length_mm * u;
  for (std::size_t k = table.size(); k-- > 0;) {
    const Mat3 r = table[k].rotation(theta[k]);
    p = table[k].point_mm + r * (p - table[k].point_mm);
    u = r * u;
  }
  return {p, u};
}

Joints KinematicChain::linear_for(const Vec3& tip_mm, const std::array<double, 2>& rotary_rad,
                                  double tool_length_mm) const {
  return {table_to_machine(tip_mm, rotary_rad) + tool_length_mm * tool_axis_in_machine(rotary_rad) -
              gauge_shift(rotary_rad),
          rotary_rad};
}

Result<std::vector<JointSolution>> KinematicChain::rotary_solutions(const Vec3& axis) const {
  const Vec3 p = Vec3::UnitZ();
  if (const double length = axis.norm(); !(std::abs(length - 1.0) <= kUnitTolerance))
    return fail("tool axis ({:.6f}, {:.6f}, {:.6f}) has length {:.9f}, must be 1", axis.x(), axis.y(), axis.z(),
                length);
  if (rotary_count() == 0) {
    const double gap = angle_between(axis, p);
    if (!(gap <= kReachTolerance))
      return fail("tool axis ({:.6f}, {:.6f}, {:.6f}) leans {:.6f} deg; this machine has no rotary axis", axis.x(),
                  axis.y(), axis.z(), degrees(gap));
    return std::vector<JointSolution>{JointSolution{}};
  }
  if (rotary_count() == 1) return one_rotary(axis);

  // R_1 R_2 p = u. The direction c = R_2 p = R_1^T u lies on both cones: c = (d1.u) d1 + k e + t n in the frame
  // (d1, e, n) with e towards d2. t^2 = h^2 - k^2 is taken as a product, h = |u across d1| without cancellation.
  const RotaryAxis& first = rotary(0);
  const RotaryAxis& second = rotary(1);
  const Vec3 &d1 = first.direction, &d2 = second.direction;
  const double sine = d1.cross(d2).norm();
  const double cosine = d1.dot(d2);
  const Vec3 e = (d2 - cosine * d1) / sine;
  const Vec3 n = d1.cross(d2) / sine;
  const Vec3 u_across = across(axis, d1);
  const double h = u_across.norm();
  const double k = (d2.dot(p) - cosine * d1.dot(axis)) / sine;

  // Reach: the angle from d1 to c runs between |between - cone| and between + cone.
  const double to_first = angle_between(axis, d1);
  const double between = angle_between(d1, d2);
  const double cone = angle_between(p, d2);
  const double most = std::min(between + cone, 2 * kPi - between - cone);
  const double gap = std::max(std::abs(between - cone) - to_first, to_first - most);
  if (!(gap <= kReachTolerance)) return out_of_reach(axis, second.letter, gap);

  const double t = std::sqrt(std::max(0.0, (h - k) * (h + k)));
  // Sign of t in pair 1: the spindle's own side of the plane (d1, d2); in that plane: positive tilt.
  const double side = n.dot(p);
  const double first_sign = (std::abs(side) > kParallelSine ? side : n.dot(d2.cross(p))) < 0.0 ? -1.0 : 1.0;
  const bool pole = h <= kPoleAngle;

  std::vector<JointSolution> solutions;
  for (const int pair : {1, 2}) {
    const Vec3 c_across = k * e + (pair == 1 ? t : -t) * first_sign * n;
    const Vec3 c = d1.dot(axis) * d1 + c_across;
    JointSolution s;
    s.pair = pair;
    s.joints.rotary_rad[1] = command_for(second, turn_angle(across(p, d2), across(c, d2), d2));
    s.joints.rotary_rad[0] = pole ? first.zero_rad : command_for(first, turn_angle(c_across, u_across, d1));
    if (pole) s.free_rotary = 0;
    solutions.push_back(s);
    if (pole || t == 0.0) break;  // the two pairs coincide
  }
  return solutions;
}

Result<std::vector<JointSolution>> KinematicChain::one_rotary(const Vec3& axis) const {
  const RotaryAxis& only = rotary(0);
  const Vec3 p = Vec3::UnitZ();
  const Vec3& d = only.direction;
  const Vec3 p_across = across(p, d);
  JointSolution s;
  s.joints.rotary_rad[0] = only.zero_rad;
  if (p_across.norm() <= kParallelSine) {  // a turntable: it cannot tilt the tool, every angle serves
    const double gap = angle_between(axis, p);
    if (!(gap <= kReachTolerance)) return out_of_reach(axis, only.letter, gap);
    s.free_rotary = 0;
    return std::vector<JointSolution>{s};
  }
  const double gap = cone_gap(p, axis, d);
  if (!(gap <= kReachTolerance)) return out_of_reach(axis, only.letter, gap);
  s.joints.rotary_rad[0] = command_for(only, turn_angle(p_across, across(axis, d), d));
  return std::vector<JointSolution>{s};
}

Result<std::vector<JointSolution>> KinematicChain::inverse(const TablePose& pose, double tool_length_mm) const {
  auto solutions = rotary_solutions(pose.axis);
  if (!solutions) return solutions;
  for (JointSolution& s : *solutions) s.joints = linear_for(pose.tip_mm, s.joints.rotary_rad, tool_length_mm);
  return solutions;
}

Result<std::vector<JointSolution>> KinematicChain::candidates(const TablePose& pose, double tool_length_mm,
                                                              const LimitMargin& margin, double free_angle_rad) const {
  const auto branches = rotary_solutions(pose.axis);
  if (!branches) return branches.error();

  std::vector<JointSolution> inside;
  std::string reasons;
  const auto reject = [&reasons](const JointSolution& s, const std::string& why) {
    reasons += fmt::format("{}pair {}: {}", reasons.empty() ? "" : "; ", s.pair, why);
  };
  for (const JointSolution& branch : *branches) {
    std::array<std::vector<double>, 2> angles{std::vector<double>{0.0}, std::vector<double>{0.0}};
    bool reachable = true;
    for (std::size_t k = 0; k < rotary_count(); ++k) {
      const RotaryAxis& axis = rotary(k);
      const double lo = axis.min_rad + margin.rotary_rad, hi = axis.max_rad - margin.rotary_rad;
      if (branch.free_rotary == static_cast<int>(k))
        angles[k] = lo <= hi ? std::vector<double>{std::clamp(free_angle_rad, lo, hi)} : std::vector<double>{};
      else angles[k] = windings(axis, branch.joints.rotary_rad[k], margin.rotary_rad);
      if (angles[k].empty() && reachable) {
        const double wanted = branch.joints.rotary_rad[k];
        reject(branch,
               fmt::format("{} = {:.4f} deg outside [{:.4f}, {:.4f}]{}", axis.letter, degrees(wanted), degrees(lo),
                           degrees(hi), windings(axis, wanted).empty() ? "" : margin_words(true, margin.rotary_rad)));
        reachable = false;
      }
    }
    if (!reachable) continue;
    // A turn by 360 deg leaves the linear axes where they are: their limits are checked once.
    JointSolution s = branch;
    const Joints at = linear_for(pose.tip_mm, {angles[0].front(), angles[1].front()}, tool_length_mm);
    if (const auto beyond = violations(at, margin); !beyond.empty()) {
      reject(branch, beyond.front().text());
      continue;
    }
    for (const double first : angles[0])
      for (const double second : angles[1]) {
        s.joints = {at.linear_mm, {first, second}};
        inside.push_back(s);
      }
  }
  if (inside.empty()) return fail("no solution inside the limits: {}", reasons);
  return inside;
}

std::vector<LimitViolation> KinematicChain::violations(const Joints& joints, const LimitMargin& margin) const {
  std::vector<LimitViolation> found;
  // A joint put together from a word, an offset and a tool length may miss a limit that it stands on by their rounding.
  constexpr double kRoundOff = 1e-10;
  const auto test = [&](char letter, bool is_rotary, double value, double lo, double hi) {
    if (value >= lo - kRoundOff && value <= hi + kRoundOff) return;
    const double kept = is_rotary ? margin.rotary_rad : margin.linear_mm;
    if (!(value >= lo)) found.push_back({letter, is_rotary, value, lo, false, kept});
    else if (!(value <= hi)) found.push_back({letter, is_rotary, value, hi, true, kept});
  };
  for (std::size_t i = 0; i < 3; ++i)
    test("XYZ"[i], false, joints.linear_mm[static_cast<Eigen::Index>(i)], linear[i].min_mm + margin.linear_mm,
         linear[i].max_mm - margin.linear_mm);
  for (std::size_t k = 0; k < rotary_count(); ++k)
    test(rotary(k).letter, true, joints.rotary_rad[k], rotary(k).min_rad + margin.rotary_rad,
         rotary(k).max_rad - margin.rotary_rad);
  return found;
}

std::string LimitViolation::text() const {
  const double scale = rotary ? 180.0 / kPi : 1.0;
  const bool inside = (above ? value - limit : limit - value) <= margin;
  return fmt::format("{} = {:.4f} {} {} {:.4f}{}", letter, value * scale, rotary ? "deg" : "mm",
                     above ? "exceeds" : "is below", limit * scale, inside ? margin_words(rotary, margin) : "");
}

std::string margin_words(bool rotary, double margin) {
  if (rotary)
    return fmt::format(": inside the limit, but nearer to it than limits.limit_margin_angle = {:.6g} deg",
                       degrees(margin));
  return fmt::format(": inside the limit, but nearer to it than limits.limit_margin = {:.6g} mm", margin);
}

std::vector<double> windings(const RotaryAxis& axis, double command_rad, double margin_rad) {
  const double turn = 2.0 * kPi;
  const double lo = axis.min_rad + margin_rad, hi = axis.max_rad - margin_rad;
  std::vector<double> all;
  if (axis.rollover) return {axis.zero_rad + std::remainder(command_rad - axis.zero_rad, turn)};
  if (!(lo <= hi)) return all;
  const double first = std::ceil((lo - command_rad) / turn), last = std::floor((hi - command_rad) / turn);
  for (double k = first - 1; k <= last + 1; ++k) {  // one more at both ends: the quotients are rounded
    const double angle = command_rad + k * turn;
    if (angle >= lo && angle <= hi) all.push_back(angle);
  }
  return all;
}

Status check_chain(const KinematicChain& chain) {
  if (chain.rotary_count() > 2) return fail("a chain has at most 2 rotary axes, this one has {}", chain.rotary_count());
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    const double length = chain.rotary(k).direction.norm();
    if (!(std::abs(length - 1.0) <= 1e-12))
      return fail("direction of axis {} has length {:.6g}, must be 1", chain.rotary(k).letter, length);
    if (std::abs(chain.rotary(k).sign) != 1)
      return fail("sign of axis {} is {}, must be 1 or -1", chain.rotary(k).letter, chain.rotary(k).sign);
  }
  if (chain.rotary_count() == 2) {
    const RotaryAxis &first = chain.rotary(0), &second = chain.rotary(1);
    const auto line_angle = [](const Vec3& a, const Vec3& b) {
      return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
    };
    const double limit = degrees(kParallelSine);
    if (const double angle = line_angle(first.direction, second.direction); angle < kParallelSine)
      return fail("rotary axes {} and {} are parallel: the angle between them is {:.6f} deg, must be above {:.6f} deg",
                  first.letter, second.letter, degrees(angle), limit);
    if (const double angle = line_angle(second.direction, Vec3::UnitZ()); angle < kParallelSine)
      return fail(
          "rotary axis {} is parallel to the spindle and cannot tilt the tool: its angle to Z is {:.6f} deg, must be "
          "above {:.6f} deg",
          second.letter, degrees(angle), limit);
  }
  return Ok{};
}

}  // namespace toothpath::machines
