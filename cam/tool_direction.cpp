#include "cam/tool_direction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cam/tool_body.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kEnough = 2.0;  // mm: a gap beyond this is not measured further

std::vector<Vec3> some_centres(const std::vector<BallPass>& passes, std::size_t count) {
  std::vector<Vec3> all;
  for (const auto& p : passes)
    for (const auto& q : p.points) all.push_back(q.centre);
  std::vector<Vec3> out;
  const std::size_t step = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t k = 0; k < all.size(); k += step) out.push_back(all[k]);
  return out;
}

/// One zone and tool: what a direction is worth.
class Search {
 public:
  Search(const GearDistance& part, int zone, const OffsetSheet& sheet, const std::vector<BallPass>& passes,
         const ToolAssembly& tool, const DirectionOptions& options)
      : part_(part), sheet_(sheet), tool_(tool), o_(options), few_(some_centres(passes, 24)), many_(some_centres(passes, 400)) {
    choice_.zone = zone;
    choice_.fixed = false;
    const auto& f = sheet.space().surface();
    const auto& ring = sheet.space().ring().zone;
    const double r = 0.5 * (ring.inner_radius_mm + ring.outer_radius_mm), azimuth = part.space_azimuth(zone, r);
    up_ = FaceGearSurface<double>::turned(Vec3(-f.d()), f.Cg == 0 ? 0.0 : azimuth);
    side_ = up_.cross(Vec3(std::cos(azimuth), std::sin(azimuth), 0)).normalized();
    outwards_ = side_.cross(up_);
  }

  DirectionChoice run() {
    try_one(0, 0);
    for (int lean_deg = 10; lean_deg <= 40; lean_deg += 10) {
      for (int k = 0; k < 8; ++k) try_one(lean_deg, k);
      if (choice_.fixed && lean_deg >= 20) break;  // enough of the map to see the neighbourhood
    }
    if (!choice_.fixed) explain_failure();
    return std::move(choice_);
  }

 private:
  [[nodiscard]] double draft(const Vec3& axis) const {
    double least = INFINITY;
    for (const auto& s : sheet_.stations())
      for (const auto& node : s.nodes) least = std::min(least, node.at.contact.n.dot(axis));
    return least;
  }

  [[nodiscard]] double gap(const Vec3& axis, const std::vector<Vec3>& centres, std::string& worst) const {
    double least = kEnough;
    for (const auto& body : shank_and_holder(tool_))
      for (const auto& c : centres) {
        const auto g = body_gap(part_, body, c - tool_.radius_mm() * axis, axis, least, 0.02);
        if (g.gap >= least) continue;
        least = g.gap;
        worst = body.name;
        if (least < -1) return least;
      }
    return least;
  }

  void try_one(int lean_deg, int eighth) {
    DirectionChoice::Candidate c;
    c.lean_rad = radians(lean_deg);
    c.azimuth_rad = kPi / 4 * eighth;
    const Vec3 to = std::cos(c.azimuth_rad) * outwards_ + std::sin(c.azimuth_rad) * side_;
    const Vec3 axis = lean_deg == 0 ? up_ : Vec3((std::cos(c.lean_rad) * up_ + std::sin(c.lean_rad) * to).normalized());
    const double least_draft = draft(axis);
    if (least_draft < o_.least_draft) {
      c.worst_body = "ball";
      c.gap_mm = least_draft < 0 ? -1 : 0;
    } else {
      c.gap_mm = gap(axis, few_, c.worst_body);
      if (c.gap_mm >= o_.clearance_mm && !choice_.fixed) c.gap_mm = gap(axis, many_, c.worst_body);
      c.clear = c.gap_mm >= o_.clearance_mm;
      if (c.clear && !choice_.fixed) take(axis, c, least_draft);
    }
    choice_.candidates.push_back(c);
  }

  void take(const Vec3& axis, const DirectionChoice::Candidate& c, double least_draft) {
    choice_.fixed = true;
    choice_.axis = axis;
    choice_.lean_rad = std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
    choice_.clearance_mm = c.gap_mm;
    const std::string room = c.gap_mm >= kEnough ? fmt::format("more than {:.0f} mm", kEnough) : fmt::format("{:.3f} mm", c.gap_mm);
    if (c.lean_rad == 0)
      choice_.explanation = fmt::format(
          "normal to the pitch surface: every flank has draft (least cosine {:.3f}), shank and holder keep {} from the teeth, "
          "and no axis needs to turn while cutting",
          least_draft, room);
    else
      choice_.explanation = fmt::format(
          "leans {:.0f} deg from the normal of the pitch surface, the least lean of the directions tried that is clear ({} to "
          "the teeth)",
          degrees(c.lean_rad), room);
  }

  void explain_failure() {
    const DirectionChoice::Candidate* best = &choice_.candidates.front();
    // Directions in which the shank, not the ball, would cut are no near miss: a body in the way tells more.
    const auto stands = [](const DirectionChoice::Candidate& c) { return c.worst_body != "ball"; };
    for (const auto& c : choice_.candidates)
      if (stands(c) > stands(*best) || (stands(c) == stands(*best) && c.gap_mm > best->gap_mm)) best = &c;
    choice_.explanation = fmt::format("no fixed direction is clear: the best of {} leans {:.0f} deg and its {} keeps {:.3f} mm",
                                      choice_.candidates.size(), degrees(best->lean_rad), best->worst_body, best->gap_mm);
  }

  const GearDistance& part_;
  const OffsetSheet& sheet_;
  const ToolAssembly& tool_;
  const DirectionOptions& o_;
  std::vector<Vec3> few_, many_;
  Vec3 up_ = Vec3::UnitZ(), side_ = Vec3::UnitY(), outwards_ = Vec3::UnitX();
  DirectionChoice choice_;
};

}  // namespace

DirectionChoice choose_direction(const GearDistance& part, int zone, const OffsetSheet& sheet,
                                 const std::vector<BallPass>& passes, const ToolAssembly& tool,
                                 const DirectionOptions& options) {
  return Search(part, zone, sheet, passes, tool, options).run();
}

}  // namespace toothpath

