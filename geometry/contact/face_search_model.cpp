// The model of the search of a face gear and its pinion.
#include <cmath>

#include "geometry/contact/modification_search.h"

namespace toothpath::contact {
namespace {

struct FacePlace {
  double depth, along;
};

SearchFlank flank_of(const face_gear::FaceGearRing& ring, const ContactMember& member, const EaseOffMap& map,
                     const std::vector<SearchedModification>& searched, double margin) {
  const ContactFlank& f = member.flank;
  std::vector<BeyondMargins> margins;
  std::vector<FacePlace> on_gear, on_pinion;
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c) {
      const auto k = f.index(r, c);
      margins.push_back(beyond_margins(member, map, r, c, margin, 0));
      const Vec3 plain = f.surface.flank(f.side, f.theta[k], f.B[k]).p;
      const double radius = std::hypot(plain.x(), plain.y());
      on_gear.push_back({face_gear::FlankField::depth(f.surface, plain, radius), radius});
      on_pinion.push_back({member.pinion.r_a - map.pinion_across_mm[k], map.pinion_along_mm[k]});
    }
  SearchFlank flank(f.rows, f.columns, map, margins, 1);
  flank.add_removals(searched, f.side, 0, [&](const modification::Modification& m, bool of_pinion, int) {
    const auto rectangle =
        of_pinion ? rectangle_of(member.pinion, ring) : face_gear::rectangle_of(f.surface, ring.zone);
    const modification::Field field({m}, f.side, f.zone, rectangle);
    const auto& places = of_pinion ? on_pinion : on_gear;
    std::vector<double> taken(places.size());
    for (std::size_t k = 0; k < taken.size(); ++k)
      if (!std::isnan(map.gap_mm[k])) taken[k] = field.removal(places[k].depth, places[k].along);
    return taken;
  });
  return flank;
}

}  // namespace

Result<SearchModel> SearchModel::make(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                      const std::vector<modification::Modification>& on_pinion,
                                      const Misalignment& moved, const std::vector<SearchedModification>& searched,
                                      const SearchOptions& options) {
  std::vector<ContactMember> members;
  for (int zone = 0; zone < static_cast<int>(gear.rings().size()); ++zone) {
    auto flank = exact_flank(gear, zone, side, options.rows, options.columns);
    if (!flank) return flank.error();
    members.push_back(make_member(gear, std::move(*flank), pinion_teeth, moved, on_pinion));
  }
  const auto map = ease_off(members);
  if (!map) return map.error();
  std::vector<SearchFlank> flanks;
  for (std::size_t m = 0; m < members.size(); ++m)
    flanks.push_back(flank_of(gear.rings()[m], members[m], map->maps[m], searched, options.margin));
  return SearchModel(std::move(flanks), members.front().flank.surface.pitch, options.steps);
}

}  // namespace toothpath::contact
