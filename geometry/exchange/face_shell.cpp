#include "geometry/exchange/face_shell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "geometry/base/angle.h"
#include "geometry/mesh/tooth_section.h"

namespace toothpath::exchange {
namespace {

using mesh::Segment;
using mesh::ToothSection;

constexpr double kNoWidth_mm = 1e-7;   ///< root lands below it over the whole ring are none: the fillets meet
constexpr double kOnCircle_mm = 1e-9;  ///< two heights that agree so well are one
constexpr int kLooks = 33;             ///< radii at which widths are looked at

/// Sections of one ring, each continued from the nearest one that is known.
class Sections {
 public:
  Sections(const face_gear::SpaceSheet& sheet, int teeth)
      : sheet_(sheet),
        teeth_(teeth),
        inner_(sheet.ring().zone.inner_radius_mm),
        outer_(sheet.ring().zone.outer_radius_mm) {}

  [[nodiscard]] double radius(double u) const { return u >= 1 ? outer_ : inner_ + u * (outer_ - inner_); }
  Result<const ToothSection*> at(double u) {
    const auto after = known_.lower_bound(u);
    if (after != known_.end() && after->first == u) return &after->second;
    const ToothSection* near = nullptr;
    if (after != known_.end()) near = &after->second;
    if (after != known_.begin()) {
      const auto before = std::prev(after);
      if (!near || u - before->first < after->first - u) near = &before->second;
    }
    auto made = ToothSection::at(sheet_, teeth_, radius(u), near);
    if (!made) return made.error();
    return &known_.emplace(u, std::move(*made)).first->second;
  }
  [[nodiscard]] int teeth() const { return teeth_; }

 private:
  face_gear::SpaceSheet sheet_;
  int teeth_;
  double inner_, outer_;
  std::map<double, ToothSection> known_;
};

/// From the tip of flank -1 of tooth 1 to that of its flank +1.
std::optional<Vec3> land_point(const ToothSection& section, int teeth, double v) {
  const bool right = v < 0.5;
  const auto at = right ? section.point(std::size_t(Segment::land_right), 2 * v)
                        : section.point(std::size_t(Segment::land_left), 2 * v - 1);
  if (!at) return {};
  return right ? at->p : mesh::turned_by_pitches(at->p, 1, teeth);
}

std::optional<Vec3> strip_point(const ToothSection& section, Segment segment, int teeth, double v) {
  if (segment == Segment::land_right) return land_point(section, teeth, v);
  const auto at = section.point(std::size_t(segment), v);
  if (!at) return {};
  return at->p;
}

ExactRow row_of(const std::shared_ptr<Sections>& sections, const std::vector<Segment>& segments) {
  return [sections, segments](double u,
                              const std::vector<std::vector<double>>& v) -> Result<std::vector<std::vector<Vec3>>> {
    const auto section = sections->at(u);
    if (!section) return section.error();
    std::vector<std::vector<Vec3>> out(segments.size());
    for (std::size_t k = 0; k < segments.size(); ++k)
      for (const double share : v[k]) {
        const auto p = strip_point(**section, segments[k], sections->teeth(), share);
        if (!p)
          return fail("{} is not defined at radius {:.4f} mm", to_string(mesh::segment_patch(std::size_t(segments[k]))),
                      sections->radius(u));
        out[k].push_back(*p);
      }
    return out;
  };
}

/// Are there lands at the top and in the root? A land that is too narrow for a face somewhere is refused.
Result<bool> has_root(Sections& sections) {
  double narrowest = INFINITY, widest = 0, at_radius = 0;
  for (int k = 0; k < kLooks; ++k) {
    const double u = double(k) / (kLooks - 1);
    const auto section = sections.at(u);
    if (!section) return section.error();
    const ToothSection& s = **section;
    if (s.land_width() < kLeastFace_mm)
      return fail(
          "top land = {:.6f} mm at radius {:.4f} mm is below {:g} mm: no face of a solid; a smaller outer "
          "radius leaves a wider land",
          s.land_width(), s.radius(), kLeastFace_mm);
    widest = std::max(widest, s.root_width());
    if (s.root_width() < narrowest) narrowest = s.root_width(), at_radius = s.radius();
  }
  if (widest < kNoWidth_mm) return false;
  if (narrowest < kLeastFace_mm)
    return fail(
        "root land = {:.6f} mm at radius {:.4f} mm is below {:g} mm: no face of a solid; a smaller "
        "shaper_tip_radius leaves a wider land",
        narrowest, at_radius, kLeastFace_mm);
  return true;
}

/// Does the groove's floor meet the root at an end of the ring?
Result<bool> floor_meets_root(Sections& sections, double u, double floor, bool root) {
  const auto section = sections.at(u);
  if (!section) return section.error();
  const double above = (*section)->root_height() - floor;
  if (root && std::abs(above) <= kOnCircle_mm) return true;
  if (above >= kLeastFace_mm) return false;
  return fail(
      "the groove's floor, z = {:.6f} mm, lies {:.6f} mm below the root beside it: {:g} mm is the least step of "
      "a solid; a deeper stock.groove_depth leaves it",
      floor, above, kLeastFace_mm);
}

Result<ToothRing> make_ring(const face_gear::SpaceSheet& sheet, std::size_t zone, int teeth,
                            std::shared_ptr<Sections>& sections) {
  sections = std::make_shared<Sections>(sheet, teeth);
  const auto root = has_root(*sections);
  if (!root) return root.error();
  ToothRing out;
  std::vector<Segment> segments{Segment::flank_plus, Segment::fillet_plus};
  out.foot = segments.size();
  if (*root) segments.push_back(Segment::root);
  segments.insert(segments.end(), {Segment::fillet_minus, Segment::flank_minus, Segment::land_right});
  for (const Segment s : segments) {
    const bool next = s == Segment::fillet_minus || s == Segment::flank_minus || s == Segment::land_right;
    const bool land = s == Segment::land_right;
    out.strips.push_back({land ? "top land" : to_string(mesh::segment_patch(std::size_t(s))), next ? 1 : 0});
  }
  out.row = row_of(sections, segments);
  out.place = fmt::format("zone {}", zone);
  out.station = [sections](double u) { return fmt::format("radius {:.4f} mm", sections->radius(u)); };
  return out;
}

}  // namespace

Result<GearShell> face_gear_shell(const face_gear::FaceGear& gear) {
  GearShell shell;
  shell.teeth = gear.parameters().teeth;
  shell.outward = 1;
  const auto& rings = gear.rings();
  std::vector<std::shared_ptr<Sections>> sections(rings.size());
  for (std::size_t k = 0; k < rings.size(); ++k) {
    auto ring = make_ring(gear.drawn(k), k, shell.teeth, sections[k]);
    if (!ring) return ring.error();
    shell.rings.push_back(std::move(*ring));
  }
  const double underside = mesh::underside_z(gear);
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
    const double floor = gear.groove_floor(), from = rings[k].zone.outer_radius_mm,
                 to = rings[k + 1].zone.inner_radius_mm;
    if (!(to - from >= kLeastFace_mm))
      return fail("groove width = {:.6f} mm between ring {} and ring {}: a solid needs {:g} mm", to - from, k, k + 1,
                  kLeastFace_mm);
    for (const auto& [ring, end] : {std::pair(k, std::size_t(1)), {k + 1, std::size_t(0)}}) {
      ToothRing& r = shell.rings[ring];
      const bool root = r.strips[r.foot].name == to_string(tooth_space::Piece::root);
      const auto meets = floor_meets_root(*sections[ring], double(end), floor, root);
      if (!meets) return meets.error();
      r.foot_on_circle[end] = *meets;
    }
    shell.corners.push_back({{from, floor}, {to, floor}});
  }
  shell.corners.push_back({{gear.outer_radius(), underside}, {gear.inner_radius(), underside}});
  return shell;
}

}  // namespace toothpath::exchange
