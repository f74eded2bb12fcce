// Simultaneous five-axis: a tool axis for every ball centre of a zone in which no fixed direction keeps shank and
// holder clear.
//
// At stations along every pass the directions on a grid around the pitch normal are clear or not. A pass takes the
// cheapest way through them (dynamic programming over stations and directions: lean, turn per mm, distance from the
// pass beside it); all ways are then relaxed together as far as they stay clear, which takes the steps of the grid out,
// and read as smooth curves. Where no way goes over the whole pass, it is cut in as few strokes as possible, which
// overlap.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cam/ball/axis_records.h"
#include "cam/ball/orientation_way.h"
#include "cam/ball/tool_direction.h"
#include "cam/proof/limits.h"

namespace toothpath::ball {

/// Of the proof of shank and holder: it may tell of so much less than there is, mm.
inline constexpr double kProofRoom = 0.01;
/// Margin and resolution of the gaps where there is little room, mm.
inline constexpr double kTightMargin = 0.012, kTightResolution = 0.002;
/// Stations there, mm; and the smallest squares of leans that are asked, tangent.
inline constexpr double kTightStation = 0.35, kFinestLean = 0.002;

/// Angle between an axis and that of the gear.
[[nodiscard]] double off_pole(const Vec3& axis);

struct OrientationOptions {
  double clearance_mm = proof::ProofLimits{}.clearance_mm;  ///< least gap of shank and holder
  double allowance_mm = 0;    ///< that stays on all teeth: the flute leaves `path::kPlannedStock` of it
  double margin_mm = 0.02;    ///< kept beyond it at the stations, for what lies between them
  double least_draft = 0.02;  ///< least cosine between the axis and the normal at the contact
  double least_tilt_rad =
      0.035;  ///< kept from the gear axis where the axis turns: a rotary that carries the work has its pole there
  double widest_lean_rad = 0.66;    ///< of the grid, from the pitch normal
  double farthest_lean_rad = 1.05;  ///< the same where the grid does not do
  bool trial = false;  ///< asked only whether there are axes that are found at once: what takes the closer searches
                       ///< of tight places is refused, without a reason and without a look for other tools
  double chord_mm = 0.0002;  ///< how far the ball centre may leave the pass because the axis turns between two records
};

struct Orientation {
  std::vector<std::vector<Vec3>>
      axes;  ///< of every point of every pass; the passes have been given more points where the axis turns
  double least_lean_rad = 0, greatest_lean_rad = 0;  ///< from the pitch normal
  double greatest_turn_rad_per_mm = 0;               ///< of the axis, along the ball centre
  double greatest_step_rad = 0;                      ///< between neighbouring records
  double clearance_mm = 0;                           ///< least gap found at the records, at most 2
  bool clearance_at_least = false;                   ///< it is cut there
  int turning_passes = 0;  ///< passes inside which the axis turns; the others keep one direction
};

/// Where and why there is none.
/// A tool that would do, planned as a trial.
struct ToolTrial {
  tool::ToolAssembly tool;
  std::string words;  ///< as they stand in the reason: "a shank of 3.55 mm (now 4.00)"
};

struct OrientationRefusal {
  std::string reason;
  std::vector<ToolTrial> trials = {};
};

/// What another tool like this one has other: a longer flute with as much more stick-out, a thinner shank, or a longer
/// stick-out.
[[nodiscard]] std::string change_words(const tool::ToolAssembly& now, const tool::ToolAssembly& other);

/// Which directions keep the ball cutting and every body clear at one place of the ball.
class OrientationCheck {
 public:
  OrientationCheck(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
                   const tool::ToolAssembly& tool, const OrientationOptions& options);
  /// With the ball centre at `point`. `clearance_mm`: of shank and holder.
  [[nodiscard]] bool clear(const BallPass::Point& point, const Vec3& axis, double clearance_mm,
                           double resolution_mm = 0.01) const;
  /// The part of it that concerns the cutting: draft at the contact, flute free of the part.
  [[nodiscard]] bool cutting(const BallPass::Point& point, const Vec3& axis) const;
  /// `least_tilt_rad` off the gear axis: asked of axes that turn.
  [[nodiscard]] bool away_from_pole(const Vec3& axis) const;
  /// What is known of all axes within `angle_rad` of this one: for searches that settle whole squares of leans.
  [[nodiscard]] Leans about(const BallPass::Point& point, const Vec3& axis, double angle_rad, double clearance_mm,
                            double resolution_mm) const;
  struct Moment {
    double at = 0;  ///< mm along the pass, or any measure of the way
    BallPass::Point point;
    Vec3 axis = Vec3::UnitZ();
  };
  /// The first moment found of the motion from one record to the next at which shank and holder do not keep
  /// `clearance_mm`; none where they keep it at all of them, but for what happens within 4 um.
  [[nodiscard]] std::optional<Moment> not_kept(const Moment& from, const Moment& to, double clearance_mm) const;
  /// By how much `cutting` fails: depth of the flute in the part, or what is missing of the draft at the ball. mm
  [[nodiscard]] double flute_depth(const BallPass::Point& point, const Vec3& axis) const;
  /// Depth of the flute in the part, with the allowance that it leaves, where it is so far above the ball centre; of a
  /// taper it widens. Negative: clear. mm
  [[nodiscard]] double flute_cut(const BallPass::Point& point, const Vec3& axis, double above) const;
  /// Makes shank and holder slimmer by so much, and begin as much higher: by how much does something fail?
  void slim(double by_mm);
  [[nodiscard]] const PitchFrame& frame() const { return frame_; }
  [[nodiscard]] const std::vector<tool::Frustum>& bodies() const { return bodies_; }

 private:
  /// Draft and flute, under all axes within that angle.
  [[nodiscard]] bool stands_right(const BallPass::Point& point, const Vec3& axis, double angle_rad = 0) const;
  [[nodiscard]] bool flute_is_free(const BallPass::Point& point, const Vec3& axis, double angle_rad = 0) const;
  /// Of the flute, with the allowance that it leaves, so far above the ball centre; of a taper it widens. mm
  [[nodiscard]] double flute_radius(double above) const;

  const analytic::GearDistance& part_;
  const analytic::BodyTree& tree_;
  const tool::ToolAssembly& tool_;
  const OrientationOptions& o_;
  PitchFrame frame_;
  std::vector<tool::Frustum> bodies_;
};

/// Why there are no axes: the place, the body, what it keeps and must keep, and which like tool would do. Such a tool
/// is told only when the same passes were planned with it. cam/ball/orientation_refusal.cpp
class RefusalWords {
 public:
  using Plans = std::function<bool(const tool::ToolAssembly&)>;

  RefusalWords(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
               const tool::ToolAssembly& tool, const OrientationOptions& options);
  /// Places where no axis at all is clear: how many there are on all passes, and the worst of them.
  [[nodiscard]] OrientationRefusal blocked(const std::vector<BallPass>& passes, const Plans& plans) const;
  /// Axes are clear at every place, but no strokes join them about this station.
  [[nodiscard]] OrientationRefusal parted(const OrientationWay& way, std::size_t station, const Plans& plans) const;
  /// A place between stations where the way that was found is not clear, and no other was found.
  [[nodiscard]] OrientationRefusal no_way_about(const BallPass::Point& point, const Vec3& axis,
                                                const Plans& plans) const;

 private:
  struct Spot;  ///< a place of a pass, what it wants and the best axis there
  enum class Part { flute, stick_out, shank };
  [[nodiscard]] double needed() const { return o_.clearance_mm + kTightMargin; }
  [[nodiscard]] std::optional<Vec2> clear_lean(const OrientationCheck& check, const BallPass::Point& point,
                                               const Vec2& near) const;
  [[nodiscard]] std::vector<Spot> blocked_spots(const std::vector<BallPass>& passes) const;
  [[nodiscard]] Spot worst_of(std::vector<Spot> spots) const;
  [[nodiscard]] std::pair<tool::Body, double> nearest_body(const BallPass::Point& point, const Vec3& axis) const;
  [[nodiscard]] std::string keeps(tool::Body body, double gap) const;
  [[nodiscard]] std::optional<std::string> flute_words(const BallPass::Point& point) const;
  [[nodiscard]] tool::ToolAssembly changed(Part part, double by) const;
  [[nodiscard]] double most(Part part) const;
  [[nodiscard]] std::optional<double> enough(Part part, std::vector<Spot>& spots) const;
  /// The reason, and the tools that would do.
  [[nodiscard]] OrientationRefusal with_trials(std::string reason, std::vector<Spot> spots, const Plans& plans) const;

  const analytic::GearDistance& part_;
  const analytic::BodyTree& tree_;
  const int zone_;
  const tool::ToolAssembly& tool_;
  const OrientationOptions& o_;
  OrientationCheck check_;
};

/// Axes for all passes of one zone; inserts points into the passes where the axis turns, and splits passes into strokes
/// where the clear directions of the whole pass do not join. Deterministic on any number of
/// threads.
[[nodiscard]] Expected<Orientation, OrientationRefusal> orient_passes(const analytic::GearDistance& part,
                                                                      const analytic::BodyTree& tree, int zone,
                                                                      const tool::ToolAssembly& tool,
                                                                      const OrientationOptions& options,
                                                                      std::vector<BallPass>& passes);

/// Puts the records into their passes and measures them: leans, turns, least gap of shank and holder.
[[nodiscard]] Orientation take_axes(std::vector<AxisRecords> made, const OrientationCheck& check,
                                    const analytic::BodyTree& tree, const tool::ToolAssembly& tool,
                                    std::vector<BallPass>& passes);

/// How often `orient_passes` has run in this process: a job whose zones all have a fixed direction leaves it alone.
[[nodiscard]] std::size_t orientation_runs();

}  // namespace toothpath::ball
