// The best pose of a mill's side at one station of a flank: its gap along the whole line stands between zero and the
// least `left`.
//
// Unknown are the lean psi, the turn eps away from the flank and the gap delta at the anchor. d is linear in small
// turns, so that the problem is a discrete Chebyshev one (cam/line/minimax.h), linearised again until the answer stands
// still. Gear frame, tooth 0, mm, rad. Derivation: docs/line_milling.md, section 4.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cam/line/contact.h"
#include "geometry/base/result.h"
#include "geometry/face_gear/gear.h"
#include "geometry/face_gear/space_sheet.h"

namespace toothpath::line {

/// One flank of one ring, as far as it is finished by line contact. Shaft angle 90 deg: the tip surface is a plane.
struct FlankTask {
  face_gear::FaceGearSurface<double> surface;
  int zone = 0, side = 1;
  double inner_radius = 0, outer_radius = 0;
  double z_tip = 0;
  double theta_end = 0;  ///< roll parameter at the fillet line
  double z_end = 0;      ///< height of the fillet line in the middle of the ring
  double module_mm = 0;
  std::shared_ptr<const face_gear::SpaceSheet> displaced;  ///< of a modified or corrected ring; null: plain
};

/// The flank of one side of a ring. Refused: a shaft angle other than 90 deg, a ring whose flank has no fillet line at
/// its middle.
[[nodiscard]] Result<FlankTask> flank_task(const face_gear::FaceGear& gear, int zone, int side);

/// A strip of the flank between two heights; without `bottom` it ends at the fillet line.
struct Strip {
  double top = 0;
  std::optional<double> bottom;
  double anchor = 0;  ///< height of the anchors
};

/// The flank cut into n strips of equal height, from the tip down. Anchors at mid height; that of the lowest of several
/// lies near its top, because towards the undercut edge the flank ends higher.
[[nodiscard]] std::vector<Strip> strips_of(const FlankTask& flank, int n);

/// The gap at one height of the axis.
struct GapNode {
  double t = 0, e = 0;
  double r_foot = 0, z_foot = 0, theta_foot = 0;
  Place<double> at;
  Vec3 n = Vec3::Zero();
};

/// The gap along an axis, over the feet that lie in the domain: the trimmed flank and a rim of `kRim` modules beyond
/// the ends of the ring. The rim keeps the edges there whole: without it a pose could sink as soon as a foot has left
/// the ring, and cut the edge behind it.
struct GapLine {
  double t_from = 0, t_to = 0;        ///< exact ends of the domain
  double ring_from = 0, ring_to = 0;  ///< of its part in the ring
  double t_top = 0;                   ///< where the foot is at the height of the tips, in the ring or not
  std::vector<GapNode> nodes;   ///< Chebyshev points from t_from to t_to, ends included, and the ends of ring and strip
  double least = 0;             ///< over the domain, between the nodes by parabolas
  Vec3 n_least = Vec3::Zero();  ///< normal at the foot of the least
  double most = 0;              ///< over the strip in the ring; least, where no foot is there
  double beyond_ring =
      0;  ///< how far the nearest foot between bottom and tips lies beyond the ends of the ring; 0: some foot is in it
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

/// Largest lean of a tool axis from the gear axis that is planned: beyond it is the other zero direction, of no use.
inline constexpr double kMostTilt = 1.0471975511965976;  // 60 deg

/// Angles about which a pose is sought, and how far it may turn from them; none: the start of the station, 12 deg and
/// 0.06.
struct Neighbourhood {
  double psi = 0, eps = 0;
  double most_psi = 0.20943951023931953, most_eps = 0.06;  ///< rad
};

/// A pose at one station.
struct StationPose {
  double r = 0;  ///< of the anchor
  PoseAngles<double> angles;
  AxisLine<double> axis;
  Place<double> at;  ///< parameters at the anchor's height on the axis, to start from
  Vec3 anchor = Vec3::Zero();
  GapLine gap;         ///< empty (no nodes) where no foot lies in the domain
  double covered = 0;  ///< share of the height of the line that lies in the ring
  double lift = 0;     ///< of the ball end above the bottom of the strip, along the axis
  [[nodiscard]] double tilt() const { return std::acos(axis.a.z()); }
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
  [[nodiscard]] std::optional<GapNode> gap_at(const AxisLine<double>& axis, double t, const Place<double>& start) const;
  /// The gap over the domain. Nothing where the axis leaves the regular sheet inside the ring; no nodes where no foot
  /// is in the domain.
  [[nodiscard]] std::optional<GapLine> gap_along(const AxisLine<double>& axis, double t_start,
                                                 const Place<double>& start) const;

  /// Pose by the zero direction of the parallel surface, eps = delta = 0; the ball end touches at the bottom of the
  /// strip, or is lifted to the last regular place above it. Nothing where J <= 0 at the anchor.
  [[nodiscard]] std::optional<StationPose> start(double r) const;
  /// The pose with these angles at a station: its t_m such that the ball end touches at the bottom of the strip, then
  /// `lift` higher; its delta such that the least gap over the domain is `bias`. Without a bias, and where no foot is
  /// in the ring, `delta` stays as given.
  [[nodiscard]] std::optional<StationPose> place(double r, double psi, double eps, double delta, double lift,
                                                 std::optional<double> bias) const;
  /// The best pose over psi and eps in the neighbourhood (without one: 12 deg and 0.06 about the start), delta free;
  /// under a condition psi alone. Relinearised until the predicted gain is below 1e-8 mm, at most 30 times; no step
  /// that is not better is taken.
  [[nodiscard]] std::optional<StationPose> best(double r, const std::optional<AxisCondition>& condition = {},
                                                const std::optional<Neighbourhood>& about = {}) const;
  /// eps that fulfils a condition at a station with lean psi, the root nearer to 0. Nothing where none does.
  [[nodiscard]] std::optional<double> eps_under(double r, double psi, double t_m, const AxisCondition& condition) const;

  /// Height on the axis by which the ball end must be lifted so that its foot lies no farther out than `r_most` (sense
  /// = 1), or no farther in than that (sense = -1).
  [[nodiscard]] double lift_to(const StationPose& pose, double r_most, int sense) const;

 private:
  struct Anchor {
    Place<double> at;
    Vec3 P;
    TangentFrame<double> frame;
  };
  [[nodiscard]] std::optional<Anchor> anchor(double r) const;
  [[nodiscard]] std::optional<GapNode> displaced_gap(const Vec3& x, double t,
                                                     const face_gear::FlankFoot<double>& near) const;
  [[nodiscard]] double inside(const GapNode& node, double rim) const;
  [[nodiscard]] std::vector<GapNode> walk(const AxisLine<double>& axis, double t_start,
                                          const Place<double>& start) const;
  template <typename F>
  [[nodiscard]] double crossing(const AxisLine<double>& axis, const GapNode& a, const GapNode& b, const F& g) const;
  [[nodiscard]] bool add_nodes(const AxisLine<double>& axis, std::vector<double> splits, Place<double> start,
                               GapLine& line) const;
  [[nodiscard]] bool extremes(const AxisLine<double>& axis, GapLine& line) const;
  [[nodiscard]] double above_bottom(const GapNode& node) const;
  [[nodiscard]] bool in_strip(const GapNode& node) const;
  [[nodiscard]] std::optional<double> reach_bottom(const Anchor& anchor, PoseAngles<double> pose) const;
  [[nodiscard]] std::optional<StationPose> posed(double r, const Anchor& anchor, PoseAngles<double> pose,
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
