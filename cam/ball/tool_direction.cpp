#include "cam/ball/tool_direction.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "cam/path/asked_stock.h"
#include "geometry/base/angle.h"

namespace toothpath::ball {
namespace {

constexpr double kEnough = 2.0;                // mm: a gap beyond this is not measured further, if it is clear
constexpr double kDirectionDeepest = 3.0;      // mm: how far a body in the way is followed
constexpr double kDirectionResolution = 0.02;  // mm
constexpr double kFluteSkin = 0.03;  // mm: the flute grazes the walls that it cuts; thinner by this it may cut nowhere
constexpr double kFluteResolution = 1e-3;  // mm
constexpr double kFacetRoom = 0.01;        // mm: walls of facets beside a flute that keeps an allowance

/// The flute above the ball as a body. It stands on the side that is away from its own walls where these have draft;
/// the other ring of teeth, across a relief groove, may still be in its way.
std::optional<tool::Frustum> flute_body(const tool::ToolAssembly& tool) {
  const double R = tool.radius_mm(), skin = std::min(kFluteSkin, 0.1 * R), top = tool.flute_length_mm;
  if (top - R < skin) return std::nullopt;
  const double wider = (top - R - skin) * std::tan(tool.half_angle_rad);
  return tool::Frustum{R + skin, top, R - skin, R - skin + wider, tool::Body::flute};
}

/// Where it goes when the tool draws back: above it, if a thinner shank stands there.
std::optional<tool::Frustum> drawn_back(const tool::Frustum& flute, const tool::ToolAssembly& tool) {
  if (0.5 * tool.shank_diameter_mm >= flute.radius_to || tool.stick_out_mm <= flute.to) return std::nullopt;
  return tool::Frustum{flute.to, tool.stick_out_mm, flute.radius_to, flute.radius_to, tool::Body::flute};
}

std::vector<Vec3> all_centres(const std::vector<BallPass>& passes) {
  std::vector<Vec3> all;
  for (const auto& p : passes)
    for (const auto& q : p.points) all.push_back(q.centre);
  return all;
}
std::vector<Vec3> some_of(const std::vector<Vec3>& all, std::size_t count) {
  std::vector<Vec3> out;
  const std::size_t step = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t k = 0; k < all.size(); k += step) out.push_back(all[k]);
  return out;
}

/// One zone and tool: what a direction is worth.
class Search {
 public:
  Search(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
         const tooth_space::OffsetSheet& sheet, const std::vector<BallPass>& passes, const tool::ToolAssembly& tool,
         const DirectionOptions& options)
      : tree_(tree),
        zone_(zone),
        sheet_(sheet),
        tool_(tool),
        o_(options),
        all_(all_centres(passes)),
        few_(some_of(all_, 24)),
        many_(some_of(all_, 400)),
        frame_(pitch_frame(part, zone)),
        needed_(options.clearance_mm + options.room_mm),
        enough_(std::max(kEnough, needed_)),
        beside_ring_(part.zones() > 1),
        upright_first_(beside_ring_ && part.part().chart().sine == 0) {
    if (beside_ring_ || tool.half_angle_rad > 0) flute_ = flute_body(tool);
    if (flute_) {
      const double skin = tool.radius_mm() - flute_->radius_from;
      beside_mm_ = path::kPlannedStock * options.allowance_mm + skin;
      if (options.allowance_mm > 0) own_mm_ = std::max(0.0, beside_mm_ - kFacetRoom);
      if (beside_ring_) drawn_back_ = drawn_back(*flute_, tool);
    }
    choice_.zone = zone;
    choice_.fixed = false;
  }

  proof::DirectionChoice run() {
    // Beside another ring of teeth an axis that leans may bring the flute into it, an upright one never does.
    if (upright_first_ && frame_.up.z() < 1 - 1e-9)
      try_one({std::acos(frame_.up.z()), frame_.outwards.z() > 0 ? 0 : kPi});
    try_one({0, 0});
    // A job whose upright tool is clear needs no more of the map than its neighbourhood.
    const int step = choice_.fixed ? 10 : 5, widest = choice_.fixed ? 20 : 45;
    for (int lean_deg = step; lean_deg <= widest; lean_deg += step) {
      const int sides = choice_.fixed && lean_deg <= 20 && step == 10
                            ? 8
                            : std::max(8, 4 * int(std::ceil(std::sin(radians(lean_deg)) * 13)));
      std::vector<Lean> round;
      for (int k = 0; k < sides; ++k) round.push_back({radians(lean_deg), 2 * kPi * k / sides});
      try_all(round);
      if (choice_.fixed && lean_deg >= 20) break;
    }
    if (!choice_.fixed) refine();
    if (!choice_.fixed) explain_failure();
    candidates_in_gear_frame();
    return std::move(choice_);
  }

 private:
  struct Lean {
    double by = 0, azimuth = 0;
  };
  /// What is measured of a direction, whatever was found before: draft, and the gap at few centres where there is
  /// draft.
  struct Measured {
    proof::DirectionChoice::Candidate candidate;
    double least_draft = 0;
  };

  [[nodiscard]] Vec3 axis_at(double lean, double azimuth) const {
    const Vec3 to = std::cos(azimuth) * frame_.outwards + std::sin(azimuth) * frame_.side;
    return lean == 0 ? frame_.up : Vec3((std::cos(lean) * frame_.up + std::sin(lean) * to).normalized());
  }

  /// The search leans from the normal of the pitch surface; the map is about the gear axis, as `axis` and `lean_rad`
  /// are.
  void candidates_in_gear_frame() {
    for (auto& c : choice_.candidates) {
      const Vec3 axis = axis_at(c.lean_rad, c.azimuth_rad);
      c.lean_rad = std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
      c.azimuth_rad = std::atan2(axis.y(), axis.x());
    }
  }

  [[nodiscard]] double draft(const Vec3& axis) const {
    double least = INFINITY;
    for (const auto& s : sheet_.stations())
      for (const auto& node : s.nodes) least = std::min(least, node.at.contact.n.dot(axis));
    return least;
  }

  /// Least gap of shank and holder over the centres, up to some; of a body that cuts in: minus its `depth`.
  [[nodiscard]] double gap(const Vec3& axis, const std::vector<Vec3>& centres, tool::Body& worst) const {
    return gap_below(enough_, axis, centres, worst);
  }
  [[nodiscard]] double gap_below(double enough, const Vec3& axis, const std::vector<Vec3>& centres,
                                 tool::Body& worst) const {
    std::vector<Vec3> tips;
    for (const Vec3& c : centres) tips.push_back(c - tool_.radius_mm() * axis);
    double least = enough;
    for (const auto& body : tool::shank_and_holder(tool_)) {
      double here = least_gap(body, tips, axis, least);
      if (here < 0) here = -tree_.depth(body, tips, axis, kDirectionDeepest, kDirectionResolution);
      if (here >= least) continue;
      least = here;
      worst = body.body;
    }
    return least;
  }

  /// Over the tips, on all threads: every one looks only for less than was found so far. Ends where the body cuts in.
  [[nodiscard]] double least_gap(const tool::Frustum& body, const std::vector<Vec3>& tips, const Vec3& axis,
                                 double enough) const {
    std::atomic<double> least{enough};
    tbb::parallel_for(std::size_t(0), tips.size(), [&](std::size_t k) {
      double seen = least;
      if (seen < 0) return;
      const double here = tree_.gap(body, tips[k], axis, seen, kDirectionResolution);
      while (here < seen && !least.compare_exchange_weak(seen, here)) {}
    });
    return least;
  }

  [[nodiscard]] bool flute_cuts(const Vec3& axis, const std::vector<Vec3>& centres) const {
    std::atomic<bool> cuts{false};
    tbb::parallel_for(std::size_t(0), centres.size(), [&](std::size_t k) {
      if (!cuts && flute_cuts(axis, Vec3(centres[k] - tool_.radius_mm() * axis))) cuts = true;
    });
    return cuts;
  }
  [[nodiscard]] bool flute_cuts(const Vec3& axis, const Vec3& tip) const {
    if (!tree_.keeps(*flute_, tip, axis, own_mm_, kFluteResolution)) return true;
    if (!beside_ring_) return false;
    const auto keeps = [&](const tool::Frustum& body) {
      return tree_.keeps_other_rings(zone_, body, tip, axis, beside_mm_, kFluteResolution);
    };
    return !keeps(*flute_) || (drawn_back_ && !keeps(*drawn_back_));
  }

  /// Halved steps around the directions that come nearest to being clear: a narrow way through is found too.
  void refine() {
    std::vector<proof::DirectionChoice::Candidate> best = choice_.candidates;
    std::stable_sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.gap_mm > b.gap_mm; });
    best.resize(std::min<std::size_t>(best.size(), 3));
    for (auto at : best) {
      if (at.worst_body == tool::Body::ball) continue;
      for (double step = radians(2.5); step > radians(0.5) && !choice_.fixed; step *= 0.5)
        for (bool better = true; better && !choice_.fixed;) {
          better = false;
          const double x = std::tan(at.lean_rad) * std::cos(at.azimuth_rad),
                       y = std::tan(at.lean_rad) * std::sin(at.azimuth_rad);
          for (int k = 0; k < 8 && !choice_.fixed; ++k) {
            const double u = x + std::tan(step) * std::cos(kPi / 4 * k), v = y + std::tan(step) * std::sin(kPi / 4 * k);
            try_one({std::atan(std::hypot(u, v)), std::atan2(v, u)});
            if (choice_.candidates.back().gap_mm > at.gap_mm + 0.01) {
              at = choice_.candidates.back();
              better = true;
              break;
            }
          }
        }
    }
  }

  void try_one(const Lean& lean) { judge(measure(lean)); }

  /// Measured together, judged one after another.
  void try_all(const std::vector<Lean>& leans) {
    std::vector<Measured> measured(leans.size());
    tbb::parallel_for(std::size_t(0), leans.size(), [&](std::size_t k) { measured[k] = measure(leans[k]); });
    for (auto& m : measured) judge(std::move(m));
  }

  [[nodiscard]] Measured measure(const Lean& lean) const {
    Measured m;
    auto& c = m.candidate;
    c.lean_rad = lean.by;
    c.azimuth_rad = lean.azimuth;
    const Vec3 axis = axis_at(lean.by, lean.azimuth);
    m.least_draft = draft(axis);
    if (m.least_draft < o_.least_draft) {
      c.worst_body = tool::Body::ball;
      c.gap_mm = m.least_draft < 0 ? -1 : 0;
    } else {
      c.gap_mm = gap(axis, few_, c.worst_body);
    }
    return m;
  }

  void judge(Measured m) {
    auto& c = m.candidate;
    if (m.least_draft >= o_.least_draft) {
      const Vec3 axis = axis_at(c.lean_rad, c.azimuth_rad);
      if (c.gap_mm >= needed_ && !choice_.fixed) c.gap_mm = gap(axis, many_, c.worst_body);
      // Some centres lead quickly to a direction; all of them must keep clear in the one that is taken.
      if (c.gap_mm >= needed_ && !choice_.fixed)
        if (const double least = gap_below(needed_, axis, all_, c.worst_body); least < needed_) c.gap_mm = least;
      if (c.gap_mm >= needed_ && flute_ && (flute_cuts(axis, many_) || (!choice_.fixed && flute_cuts(axis, all_)))) {
        c.gap_mm = 0;
        c.worst_body = flute_->body;
      }
      c.clear = c.gap_mm >= needed_;
      if (c.clear && !choice_.fixed) take(axis, c, m.least_draft);
    }
    choice_.candidates.push_back(std::move(c));
  }

  void take(const Vec3& axis, const proof::DirectionChoice::Candidate& c, double least_draft) {
    choice_.fixed = true;
    choice_.axis = axis;
    choice_.lean_rad = std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
    if (choice_.lean_rad < 1e-12) {  // what rounding left of a turn back to the gear axis
      choice_.axis = Vec3::UnitZ();
      choice_.lean_rad = 0;
    }
    choice_.clearance_mm = c.gap_mm;
    choice_.clearance_at_least = c.gap_mm >= enough_;
    const std::string room =
        c.gap_mm >= enough_ ? fmt::format("more than {:g} mm", enough_) : fmt::format("{:.3f} mm", c.gap_mm);
    if (choice_.lean_rad == 0 && c.lean_rad > 0)
      choice_.explanation = fmt::format(
          "along the gear axis, {:.0f} deg from the normal of the pitch surface: the flute stays clear of the other "
          "ring of teeth, every flank has draft (least cosine {:.3f}), shank and holder keep {} from the teeth",
          degrees(c.lean_rad), least_draft, room);
    else if (c.lean_rad == 0)
      choice_.explanation = fmt::format(
          "normal to the pitch surface: every flank has draft (least cosine {:.3f}), shank and holder keep {} from the "
          "teeth, and no axis needs to turn while cutting",
          least_draft, room);
    else
      choice_.explanation = fmt::format(
          "leans {:.0f} deg from the normal of the pitch surface, the least lean of the directions tried that is clear "
          "({} to the teeth)",
          degrees(c.lean_rad), room);
  }

  void explain_failure() {
    const proof::DirectionChoice::Candidate* best = &choice_.candidates.front();
    // Directions in which the shank, not the ball, would cut are no near miss: a body in the way tells more.
    const auto stands = [](const proof::DirectionChoice::Candidate& c) { return c.worst_body != tool::Body::ball; };
    for (const auto& c : choice_.candidates)
      if (stands(c) > stands(*best) || (stands(c) == stands(*best) && c.gap_mm > best->gap_mm)) best = &c;
    choice_.explanation =
        best->gap_mm < 0
            ? fmt::format(
                  "no fixed direction is clear: the best of {} leans {:.1f} deg and its {} cuts in by {}{:.3f} mm",
                  choice_.candidates.size(), degrees(best->lean_rad), best->worst_body,
                  best->gap_mm <= -kDirectionDeepest ? "more than " : "", -best->gap_mm)
            : fmt::format(
                  "no fixed direction is clear: the best of {} leans {:.1f} deg and its {} keeps {:.4f} of {:.4f} mm{}",
                  choice_.candidates.size(), degrees(best->lean_rad), best->worst_body, best->gap_mm, o_.clearance_mm,
                  best->gap_mm >= o_.clearance_mm
                      ? fmt::format(", and {:.4f} mm is for words, control and proof", o_.room_mm)
                      : "");
  }

  const analytic::BodyTree& tree_;
  int zone_;
  const tooth_space::OffsetSheet& sheet_;
  const tool::ToolAssembly& tool_;
  const DirectionOptions& o_;
  std::vector<Vec3> all_, few_, many_;
  PitchFrame frame_;
  double needed_;                       ///< clearance and room, mm
  double enough_;                       ///< gaps beyond are not measured further, mm
  bool beside_ring_;                    ///< a double helical gear: another ring of teeth stands across the groove,
  bool upright_first_;                  ///< which an axis along that of the gear does not meet
  std::optional<tool::Frustum> flute_;  ///< asked for then, and where it is a cone
  std::optional<tool::Frustum> drawn_back_;
  double own_mm_ = 0, beside_mm_ = 0;  ///< what that body keeps from the teeth of the zone and of other rings
  proof::DirectionChoice choice_;
};

}  // namespace

PitchFrame pitch_frame(const analytic::GearDistance& part, int zone) {
  const tooth_space::Outline& ring = part.space(zone).outline();
  const double azimuth = part.space_azimuth(zone, 0.5 * (ring.s_from + ring.s_to));
  const Vec3 normal = ring.pitch_normal.value_or(ring.chart.up_at(0));
  PitchFrame frame;
  frame.up = turned(normal, normal.head<2>().isZero(0) ? 0.0 : azimuth);
  frame.side = frame.up.cross(ring.chart.along_at(azimuth)).normalized();
  frame.outwards = frame.side.cross(frame.up);
  return frame;
}

proof::DirectionChoice choose_direction(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
                                        const tooth_space::OffsetSheet& sheet, const std::vector<BallPass>& passes,
                                        const tool::ToolAssembly& tool, const DirectionOptions& options) {
  return Search(part, tree, zone, sheet, passes, tool, options).run();
}

}  // namespace toothpath::ball
