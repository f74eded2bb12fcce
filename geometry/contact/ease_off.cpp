#include "geometry/contact/ease_off.h"

#include <cmath>
#include <limits>

#include "geometry/contact/rolling.h"

namespace toothpath::contact {

EaseOffMap::EaseOffMap(std::size_t places) {
  for (auto* list : {&gap_mm, &phi_2, &bend_mm, &pinion_across_mm, &pinion_along_mm})
    list->assign(places, std::numeric_limits<double>::quiet_NaN());
}

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

Result<EaseOff> ease_off(const std::vector<ContactMember>& members) { return rolling::ease_off_of(members); }

}  // namespace toothpath::contact
