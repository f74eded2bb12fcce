// The best pose of a mill's side at one station of a flank: its gap along the whole line stands between zero and the
// least `left`.
//
// Unknown are the lean psi, the turn eps away from the flank and the gap delta at the anchor. d is linear in small
// turns, so that the problem is a discrete Chebyshev one (cam/line/minimax.h), linearised again until the answer stands
// still. Gear frame, space 0 (between flank +1 of tooth 0 and flank -1 of tooth 1), mm, rad. Stations are s of the
// chart, heights are depths below the tip surface. Derivation: docs/line_milling.md, section 4.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "cam/line/contact.h"
#include "geometry/base/result.h"
#include "geometry/tooth_space/flank_depth.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::line {

/// Parameters of a flank.
struct Place {
  double u = 0, v = 0;
};
/// From a to b by the share w.
[[nodiscard]] inline Place between(const Place& a, const Place& b, double w) {
  return {(1 - w) * a.u + w * b.u, (1 - w) * a.v + w * b.v};
}

/// A place of a flank with its point and derivatives.
struct FlankPlace {
  Place at;
  tooth_space::PatchPoint on;
};

/// One flank of one ring, as far as it is finished by line contact. The part must outlive it.
struct FlankTask {
  const tooth_space::ToothSpace* space = nullptr;
  int zone = 0, side = 1;
  double s_from = 0, s_to = 0;  ///< ends of the ring
  double u_end = 0;             ///< at the fillet line
  double mm_per_u = 0;          ///< towards the tip, at the fillet line in the middle of the ring
  double depth = 0;             ///< of the fillet line there
  /// Is the flank straight along the tooth, or nearly (`kAlongTheTooth`), or does an axis along its zero lean too far
  /// somewhere on a cylinder or a cone (`kMostTilt`)? Its strips are cut by an upright tool.
  bool upright = false;
  /// Of an upright flank, and of teeth on a cone, depths are counted in shares of the fillet line's: strips taper as
  /// the teeth do. Else the anchors of the lowest would leave the flank where the teeth are low.
  tooth_space::FlankDepth deep;
  double module_mm = 0;
  double allowance_mm = 0;  ///< that the gap leaves on the flank

  [[nodiscard]] tooth_space::Piece piece() const { return tooth_space::flank_of(side); }
  [[nodiscard]] const tooth_space::Chart& chart() const { return space->outline().chart; }
  /// Unit vector in the meridian plane of p along which h of the chart rises.
  [[nodiscard]] Vec3 up(const Vec3& p) const;
  [[nodiscard]] double along(const Vec3& p) const { return chart().along(p); }
  /// Below the tip surface, as strips count it: mm in the middle of the ring.
  [[nodiscard]] double depth_of(const Vec3& p) const { return depth_of(along(p), p); }
  [[nodiscard]] double depth_of(double s, const Vec3& p) const {
    return (space->tip(s) - (chart().sine == 0 ? chart().cosine * p.z() : chart().up(p))) / deep.share(s);
  }
  /// Above the fillet line, measured by u.
  [[nodiscard]] double above_fillet(double u) const { return (u - u_end) * mm_per_u; }
  /// The place at a station and a depth; nothing where the flank has none: beyond the undercut edge.
  [[nodiscard]] std::optional<FlankPlace> at_depth(double s, double depth) const;
  /// The place at a station on a line of the flank that u names; nothing where that line does not reach it.
  [[nodiscard]] std::optional<tooth_space::PatchPoint> at_u(double s, double u) const;
  [[nodiscard]] TangentFrame<double> frame(const tooth_space::PatchPoint& on) const {
    return tangent_frame<double>(side, on.n, up(on.p));
  }
};

/// The flank of one side of a ring. Refused: a ring whose flank has no fillet line at its middle.
[[nodiscard]] Result<FlankTask> flank_task(const tooth_space::ToothedPart& part, int zone, int side,
                                           double allowance_mm = 0);

/// Shape operator of a flank at one of its places.
[[nodiscard]] inline TangentShape<double> shape_at(const TangentFrame<double>& frame,
                                                   const tooth_space::PatchPoint& on) {
  return {frame, on.pu, on.pv, on.nu, on.nv};
}

/// A strip of the flank between two depths; without `bottom` it ends at the fillet line.
struct Strip {
  double top = 0;
  std::optional<double> bottom;
  double anchor = 0;  ///< depth of the anchors
};

/// The flank cut into n strips, from the tip down: of equal height, or of an upright flank so that its profile sags by
/// as much in each. Anchors at mid height; that of the lowest of several lies near its top, because towards the
/// undercut edge the flank ends higher.
[[nodiscard]] std::vector<Strip> strips_of(const FlankTask& flank, int n);
/// Strips of which each leaves about `left_mm`, as far as the bend of the profile tells: of an upright flank. 1 of any
/// other.
[[nodiscard]] int strips_for(const FlankTask& flank, double left_mm);
/// About as many will do, of any flank: 1 where the axis of the mill may lean along a direction in which the flank does
/// not bend.
[[nodiscard]] int strips_about(const FlankTask& flank, double left_mm);
/// Passes of a ball end, side by side over the height of the flank, that leave cusps of about `left_mm`: they lie
/// sqrt(8 left / (1/R + k)) apart, k > 0 where the profile is convex.
[[nodiscard]] int ball_passes_for(const FlankTask& flank, double ball_radius_mm, double left_mm);
/// Along the tooth from end to end of the ring, at half the depth, mm.
[[nodiscard]] double length_along(const FlankTask& flank);

/// The gap at one height of the axis, beyond the allowance.
struct GapNode {
  double t = 0, e = 0;
  double s = 0, depth = 0;  ///< of the foot
  double above_fillet = 0;  ///< likewise
  Place at;                 ///< likewise
  Vec3 n = Vec3::Zero();
};

/// Vertex of the parabola through three nodes, or the middle one where they do not bend.
[[nodiscard]] inline double vertex(const GapNode& a, const GapNode& b, const GapNode& c) {
  const double d0 = (b.e - a.e) / (b.t - a.t), d1 = (c.e - b.e) / (c.t - b.t), bend = (d1 - d0) / (c.t - a.t);
  return bend == 0 ? b.t : std::clamp(0.5 * (a.t + b.t - d0 / bend), a.t, c.t);
}

/// The gap along an axis, over the feet that lie in the domain: the trimmed flank and a rim of `kRim` modules beyond
/// the ends of the ring. The rim keeps the edges there whole: without it a pose could sink as soon as a foot has left
/// the ring, and cut the edge behind it.
struct GapLine {
  double t_from = 0, t_to = 0;        ///< exact ends of the domain
  double ring_from = 0, ring_to = 0;  ///< of its part in the ring
  double t_top = 0;                   ///< where the foot is at the height of the tips, in the ring or not
  double strip_to = 0;                ///< likewise at the top of the strip
  std::vector<GapNode> nodes;   ///< Chebyshev points from t_from to t_to, ends included, and the ends of ring and strip
  double least = 0;             ///< over the domain, between the nodes by parabolas
  Vec3 n_least = Vec3::Zero();  ///< normal at the foot of the least
  double most = 0;              ///< over the strip in the ring; least, where no foot is there
  double beyond_ring =
      0;  ///< how far the nearest foot between bottom and tips lies beyond the ends of the ring; 0: some foot is in it
  bool strip_in_ring = false;  ///< is some foot both in the strip and in the ring?
  [[nodiscard]] bool in_ring() const { return !nodes.empty() && beyond_ring <= 0; }
  [[nodiscard]] double misfit() const { return most - least; }
};
inline constexpr double kRim = 0.05;

/// Which of the two rotaries of a table moves during a pass: a condition w . a = c on the axis.
struct AxisCondition {
  Vec3 w = Vec3::UnitZ();
  double c = 0;
};
/// The tilt from the gear axis stands (its azimuth turns).
[[nodiscard]] inline AxisCondition tilt_stands(double tilt_rad) { return {Vec3::UnitZ(), std::cos(tilt_rad)}; }
/// The azimuth of the axis stands (its tilt turns).
[[nodiscard]] inline AxisCondition azimuth_stands(double azimuth_rad) {
  return {{-std::sin(azimuth_rad), std::cos(azimuth_rad), 0}, 0};
}

/// Largest tilt of a tool axis from upright that is planned: beyond it is the other zero direction, of no use.
inline constexpr double kMostTilt = 1.0471975511965976;  // 60 deg
/// A wanted axis that is tilted farther than that lies along the tooth: the flank is straight (or nearly) along it, as
/// an involute is. There strips are cut by an upright tool.
inline constexpr double kAlongTheTooth = 1.3089969389957472;  // 75 deg

/// Angles about which a pose is sought, and how far it may turn from them.
struct Neighbourhood {
  double psi = 0, eps = 0;
  double most_psi = 0.20943951023931953, most_eps = 0.06;  ///< rad
};

/// A pose at one station.
struct StationPose {
  double s = 0;  ///< of the anchor
  PoseAngles<double> angles;
  AxisLine<double> axis;
  Place at;                    ///< of the anchor
  Vec3 anchor = Vec3::Zero();  ///< on the allowance, over its place on the flank
  Vec3 up = Vec3::UnitZ();     ///< there
  Neighbourhood about;         ///< of the start: 12 deg and 0.06, or what the bend of the flank asks for
  GapLine gap;                 ///< empty (no nodes) where no foot lies in the domain
  double covered = 0;  ///< share of the height of the line that lies in the ring, or of the strip where it is less
  double lift = 0;     ///< of the ball end above the bottom of the strip, along the axis
  [[nodiscard]] double tilt() const { return std::acos(axis.a.z()); }  ///< from the gear axis
  [[nodiscard]] double from_upright() const { return std::acos(std::clamp(axis.a.dot(up), -1.0, 1.0)); }
};

/// The gap function of one tool on one strip of one flank, and its best poses. A value; asked from several threads at
/// once.
class LineFit {
 public:
  LineFit(FlankTask flank, tool::RadiusLaw<double> law, Strip strip)
      : flank_(std::move(flank)), law_(std::move(law)), strip_(strip) {}
  [[nodiscard]] const FlankTask& flank() const { return flank_; }
  [[nodiscard]] const tool::RadiusLaw<double>& law() const { return law_; }
  [[nodiscard]] const Strip& strip() const { return strip_; }

  /// e(t) with its foot, from parameters nearby. Nothing beyond the undercut edge.
  [[nodiscard]] std::optional<GapNode> gap_at(const AxisLine<double>& axis, double t, const Place& start) const;
  /// The gap over the domain. Nothing where the axis leaves the regular sheet inside the ring; no nodes where no foot
  /// is in the domain.
  [[nodiscard]] std::optional<GapLine> gap_along(const AxisLine<double>& axis, double t_start,
                                                 const Place& start) const;

  /// Pose by the zero direction of the parallel surface, eps = delta = 0; the ball end touches at the bottom of the
  /// strip, or is lifted to the last regular place above it. Upright where that direction lies along the tooth. Nothing
  /// where the flank has no anchor.
  [[nodiscard]] std::optional<StationPose> start(double s) const;
  /// The pose with these angles at a station: its t_m such that the ball end touches at the bottom of the strip, then
  /// `lift` higher; its delta such that the least gap over the domain is `bias`. Without a bias, and where no foot is
  /// in the ring, `delta` stays as given; where none of the strip is, it does not sink below that.
  [[nodiscard]] std::optional<StationPose> place(double s, double psi, double eps, double delta, double lift,
                                                 std::optional<double> bias) const;
  /// The best pose over psi and eps in the neighbourhood (without one: that of the start), delta free; under a
  /// condition psi alone. Relinearised until the predicted gain is below 1e-8 mm, at most 30 times; no step that is not
  /// better is taken.
  [[nodiscard]] std::optional<StationPose> best(double s, const std::optional<AxisCondition>& condition = {},
                                                const std::optional<Neighbourhood>& about = {}) const;
  /// eps that fulfils a condition at a station with lean psi, the root nearer to 0. Nothing where none does.
  [[nodiscard]] std::optional<double> eps_under(double s, double psi, double t_m, const AxisCondition& condition) const;

  /// Height on the axis by which the ball end must be lifted so that its foot lies no farther than `s_most` towards
  /// rising s (sense = 1), or falling s (sense = -1).
  [[nodiscard]] double lift_to(const StationPose& pose, double s_most, int sense) const;

 private:
  struct Anchor {
    FlankPlace place;
    Vec3 P;
    TangentFrame<double> frame;
  };
  [[nodiscard]] std::optional<Anchor> anchor(double s) const;
  [[nodiscard]] std::optional<double> wanted_lean(const Anchor& anchor, double t_m) const;
  [[nodiscard]] double step_along(const AxisLine<double>& axis) const;
  [[nodiscard]] double inside(const GapNode& node, double rim) const;
  [[nodiscard]] std::vector<GapNode> walk(const AxisLine<double>& axis, double t_start, const Place& start) const;
  template <typename F>
  [[nodiscard]] double crossing(const AxisLine<double>& axis, const GapNode& a, const GapNode& b, const F& g) const;
  [[nodiscard]] bool add_nodes(const AxisLine<double>& axis, std::vector<double> splits, Place start,
                               GapLine& line) const;
  [[nodiscard]] bool extremes(const AxisLine<double>& axis, GapLine& line) const;
  [[nodiscard]] double bottom_depth() const { return strip_.bottom.value_or(flank_.depth); }
  [[nodiscard]] double above_bottom(const GapNode& node) const;
  [[nodiscard]] bool in_strip(const GapNode& node) const;
  [[nodiscard]] std::optional<double> reach_bottom(const Anchor& anchor, PoseAngles<double> pose) const;
  [[nodiscard]] std::optional<StationPose> posed(double s, const Anchor& anchor, PoseAngles<double> pose,
                                                 double lift) const;
  [[nodiscard]] bool measure(StationPose& pose) const;
  void settle(StationPose& pose, const Anchor& anchor, double bias) const;
  [[nodiscard]] std::optional<PoseAngles<double>> step(const StationPose& pose, const Anchor& anchor,
                                                       const Neighbourhood& about,
                                                       const std::optional<AxisCondition>& condition, double trust,
                                                       double& gain) const;

  FlankTask flank_;
  tool::RadiusLaw<double> law_;
  Strip strip_;
};

}  // namespace toothpath::line
