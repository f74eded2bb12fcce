#include "geometry/contact/ease_off.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/contact/touch_search.h"

namespace toothpath::contact {

EaseOffMap::EaseOffMap(std::size_t places) {
  for (auto* list : {&gap_mm, &phi_2, &bend_mm, &pinion_across_mm, &pinion_along_mm})
    list->assign(places, std::numeric_limits<double>::quiet_NaN());
}

namespace {

/// One place of the gear's tooth 0 with its pinion, at the exact ratio.
class Approach {
 public:
  Approach(const ContactMember& member, const Vec3& point)
      : pinion_(member.pinion), field_(member.on_pinion.get()), side_(member.flank.side), point_(point) {}

  [[nodiscard]] std::optional<ToPinion> at(double phi_2) const {
    return to_pinion(pinion_, field_, side_, pinion_.place(Turn(phi_2)(point_)), phi_2 / pinion_.ratio);
  }
  /// How near the pinion is, mm: greatest where it is nearest; never where its involute does not come.
  [[nodiscard]] double operator()(double phi_2) const {
    const auto found = at(phi_2);
    return found ? -found->distance_mm : kNever;
  }

 private:
  const Pinion<double>& pinion_;
  const modification::Field* field_;
  int side_;
  const Vec3& point_;
};

EaseOffMap map_of(const ContactMember& member) {
  const ContactFlank& flank = member.flank;
  const std::size_t size = flank.points.size();
  EaseOffMap map(size);
  for (std::size_t k = 0; k < size; ++k) {
    const Vec3 point = flank.points[k] + flank.deviation_mm[k] * flank.normals[k];
    const Approach approach(member, point);
    const double cut_at = flank.surface.i * flank.surface.flank_phi(flank.side, flank.theta[k], flank.B[k]);
    const auto top = nearest_turn(approach, cut_at, flank.surface.pitch);
    if (!top) continue;
    const ToPinion nearest = approach.at(top->phi_2).value();
    map.gap_mm[k] = nearest.distance_mm;
    map.phi_2[k] = top->phi_2;
    map.bend_mm[k] = top->bend;
    map.pinion_across_mm[k] = nearest.radius_mm;
    map.pinion_along_mm[k] = nearest.Z_mm;
  }
  return map;
}

}  // namespace

Result<EaseOff> brought_to_touch(std::vector<EaseOffMap> maps) {
  EaseOff found;
  found.maps = std::move(maps);
  for (std::size_t m = 0; m < found.maps.size(); ++m)
    for (std::size_t k = 0; k < found.maps[m].gap_mm.size(); ++k) {
      const double gap = found.maps[m].gap_mm[k];
      if (std::isnan(gap)) continue;
      ++found.places;
      if (found.places == 1 || gap / found.maps[m].lever(k) < found.shift) {
        found.shift = gap / found.maps[m].lever(k);
        found.shift_mm = gap;
        found.least = {m, k, 0};
      }
    }
  if (found.places == 0) return fail("no place of the flank has a common normal with its pinion");
  bool first = true;
  for (std::size_t m = 0; m < found.maps.size(); ++m)
    for (std::size_t k = 0; k < found.maps[m].gap_mm.size(); ++k) {
      double& gap = found.maps[m].gap_mm[k];
      if (std::isnan(gap)) continue;
      gap -= found.shift * found.maps[m].lever(k);
      if (first || gap > found.greatest.gap_mm) found.greatest = {m, k, gap};
      first = false;
    }
  return found;
}

Result<EaseOff> ease_off(const std::vector<ContactMember>& members) {
  std::vector<EaseOffMap> maps;
  for (const auto& member : members) maps.push_back(map_of(member));
  return brought_to_touch(std::move(maps));
}

}  // namespace toothpath::contact
