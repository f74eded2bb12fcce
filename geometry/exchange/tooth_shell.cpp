#include "geometry/exchange/tooth_shell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "geometry/base/angle.h"
#include "geometry/mesh/tooth_section.h"

namespace toothpath::exchange {
namespace {

using mesh::Segment;
using mesh::ToothSection;
using tooth_space::ToothedSolid;

constexpr double kNoWidth_mm = 1e-7;   ///< root lands below it over the whole ring are none: the fillets meet
constexpr double kOnCircle_mm = 1e-9;  ///< two heights that agree so well are one
constexpr int kLooks = 33;             ///< stations at which widths are looked at

/// Sections of one ring, each continued from the nearest one that is known.
class Sections {
 public:
  explicit Sections(const tooth_space::ToothSpace& space) : space_(space) {}

  [[nodiscard]] const tooth_space::Outline& outline() const { return space_.outline(); }
  [[nodiscard]] double s(double u) const {
    const auto& o = outline();
    return u >= 1 ? o.s_to : o.s_from + u * (o.s_to - o.s_from);
  }
  [[nodiscard]] std::string station(double u) const { return tooth_space::station(outline(), s(u)); }
  Result<const ToothSection*> at(double u) {
    const auto after = known_.lower_bound(u);
    if (after != known_.end() && after->first == u) return &after->second;
    const ToothSection* near = nullptr;
    if (after != known_.end()) near = &after->second;
    if (after != known_.begin()) {
      const auto before = std::prev(after);
      if (!near || u - before->first < after->first - u) near = &before->second;
    }
    auto made = ToothSection::at(space_, s(u), near);
    if (!made) return made.error();
    return &known_.emplace(u, std::move(*made)).first->second;
  }

 private:
  const tooth_space::ToothSpace& space_;
  std::map<double, ToothSection> known_;
};

/// From the tip of flank -1 of tooth 1 to that of its flank +1.
std::optional<Vec3> land_point(const ToothSection& section, double pitch, double v) {
  const bool right = v < 0.5;
  const auto at = right ? section.point(std::size_t(Segment::land_right), 2 * v)
                        : section.point(std::size_t(Segment::land_left), 2 * v - 1);
  if (!at) return {};
  return right ? at->p : turned(at->p, pitch);
}

std::optional<Vec3> strip_point(const ToothSection& section, Segment segment, double pitch, double v) {
  if (segment == Segment::land_right) return land_point(section, pitch, v);
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
        const auto p = strip_point(**section, segments[k], sections->outline().pitch, share);
        if (!p)
          return fail("{} is not defined at {}", to_string(mesh::segment_patch(std::size_t(segments[k]))),
                      sections->station(u));
        out[k].push_back(*p);
      }
    return out;
  };
}

/// Are there lands at the top and in the root? A land that is too narrow for a face somewhere is refused.
Result<bool> has_root(Sections& sections, const ToothedSolid::WaysOut& ways_out) {
  double narrowest = INFINITY, widest = 0, at = 0;
  const auto too_narrow = [&](const char* what, double width, double u, const char* way_out) {
    return fail("{} = {:.6f} mm at {} is below {:g} mm: no face of a solid; {}", what, width, sections.station(u),
                kLeastFace_mm, way_out);
  };
  for (int k = 0; k < kLooks; ++k) {
    const double u = double(k) / (kLooks - 1);
    const auto section = sections.at(u);
    if (!section) return section.error();
    const ToothSection& s = **section;
    if (s.land_width() < kLeastFace_mm) return too_narrow("top land", s.land_width(), u, ways_out.land);
    widest = std::max(widest, s.root_width());
    if (s.root_width() < narrowest) narrowest = s.root_width(), at = u;
  }
  if (widest < kNoWidth_mm) return false;
  if (narrowest < kLeastFace_mm) return too_narrow("root land", narrowest, at, ways_out.root);
  return true;
}

/// Does the groove's floor meet the root at an end of the ring?
Result<bool> floor_meets_root(Sections& sections, double u, double floor, bool root, const char* way_out) {
  const auto section = sections.at(u);
  if (!section) return section.error();
  const double above = (*section)->root_height() - floor;
  if (root && std::abs(above) <= kOnCircle_mm) return true;
  if (above >= kLeastFace_mm) return false;
  return fail(
      "the groove's floor, height {:.6f} mm, lies {:.6f} mm below the root beside it: {:g} mm is the least step of a "
      "solid; {}",
      floor, above, kLeastFace_mm, way_out);
}

Result<ToothRing> make_ring(const ToothedSolid& gear, const ToothedSolid::Ring& ring,
                            std::shared_ptr<Sections>& sections) {
  sections = std::make_shared<Sections>(*ring.space);
  const auto root = has_root(*sections, gear.ways_out);
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
  out.place = fmt::format("zone {}", ring.zone);
  out.station = [sections](double u) { return sections->station(u); };
  return out;
}

}  // namespace

Result<GearShell> tooth_shell(const ToothedSolid& gear) {
  GearShell shell;
  shell.teeth = gear.teeth;
  shell.outward = 1;
  const auto& chart = gear.chart();
  std::vector<std::shared_ptr<Sections>> sections(gear.rings.size());
  for (std::size_t k = 0; k < gear.rings.size(); ++k) {
    auto ring = make_ring(gear, gear.rings[k], sections[k]);
    if (!ring) return ring.error();
    shell.rings.push_back(std::move(*ring));
  }
  for (std::size_t k = 0; k < gear.rings.size(); ++k) {
    const auto& corners = gear.corners[k];
    std::vector<Corner> meridian;
    for (const Vec2& at : corners) meridian.push_back({chart.r(at.x(), at.y()), chart.z(at.x(), at.y())});
    shell.corners.push_back(std::move(meridian));
    if (k + 1 == gear.rings.size()) break;
    const double width = corners.back().x() - corners.front().x();
    if (!(width >= kLeastFace_mm))
      return fail("groove width = {:.6f} mm between ring {} and ring {}: a solid needs {:g} mm", width, k, k + 1,
                  kLeastFace_mm);
    for (const auto& [ring, end, floor] :
         {std::tuple(k, std::size_t(1), corners.front().y()), {k + 1, std::size_t(0), corners.back().y()}}) {
      ToothRing& r = shell.rings[ring];
      const bool root = r.strips[r.foot].name == to_string(tooth_space::Piece::root);
      const auto meets = floor_meets_root(*sections[ring], double(end), floor, root, gear.ways_out.groove);
      if (!meets) return meets.error();
      r.foot_on_circle[end] = *meets;
    }
  }
  return shell;
}

}  // namespace toothpath::exchange
