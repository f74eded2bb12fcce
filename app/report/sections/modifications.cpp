#include <cmath>

#include "app/base/units.h"
#include "app/report/sections/sections.h"

namespace toothpath::sections {
namespace {

std::string hollow_words(double radius_mm) {
  return std::isfinite(radius_mm) ? fmt::format("hollow with radii of {:.3f} mm and more", radius_mm)
                                  : "nowhere hollow";
}

/// What the modifications of a zone come to.
std::string zone_words(const report::ModifiedFlanks::Zone& z) {
  const tooth_space::ModifiedForm& f = z.form;
  return fmt::format(
      "Zone {}: {:.2f} um are taken at most (flank {:+d}, r {:.3f} mm, z {:.3f} mm), normals turn by {:.2f} mrad; the "
      "flanks are {}, the fillets {} (plain: {}); the least top land is {:.3f} mm (plain: {:.3f}).",
      z.zone, f.removed_mm.value * app::kUm, f.removed_mm.side, f.removed_mm.radius_mm, f.removed_mm.height_mm,
      f.turned_rad.value * 1000, hollow_words(f.hollow_flank.value), hollow_words(f.hollow_fillet.value),
      hollow_words(f.plain_hollow_fillet_mm), f.land_mm.value, f.plain_land_mm);
}

/// What profile and path of a finger mill take.
std::string wall_words(const bevel_gear::ModifiedForm& f) {
  return fmt::format(
      "The profile of the mill takes up to {:.2f} um and turns normals by {:.2f} mrad; its paths take up to {:.2f} um "
      "at the pitch cone and turn by {:.2f} mrad; the top land at the small end is {:.3f} mm (plain: {:.3f}).",
      f.profile_mm * app::kUm, f.profile_turned_rad * 1000, f.lead_mm * app::kUm, f.lead_turned_rad * 1000,
      f.top_land_mm, f.plain_top_land_mm);
}

}  // namespace

/// What the drawing takes off the plain flanks, and what it comes to.
report::Section modifications(const SectionInput& input) {
  report::Section section;
  if (!input.report.modified) return section;
  section.title = "Modified flanks";
  section.id = "modifications";
  section.columns = {"modification", "amount um", "length mm", "law", "flank", "zone"};
  for (const auto& m : input.report.modified->list) {
    const bool relief = modification::is_relief(m.kind);
    std::string name = to_string(m.kind);
    if (m.kind == modification::Kind::end_relief && m.ends != modification::Ends::both)
      name += std::string(", ") + to_string(m.ends);
    section.rows.push_back({name, m.grid ? "of its file" : fmt::format("{:g}", m.amount_mm * app::kUm),
                            relief ? fmt::format("{:g}", m.length_mm) : "", relief ? to_string(m.law) : "",
                            to_string(m.flanks), m.zone ? fmt::format("{}", *m.zone) : "all"});
  }
  for (const auto& z : input.report.modified->zones) section.note += (section.note.empty() ? "" : " ") + zone_words(z);
  if (input.report.modified->walls) section.note = wall_words(*input.report.modified->walls);
  section.note += " Gouge and left material, inspection points and meshes count from the modified flanks.";
  return section;
}

}  // namespace toothpath::sections
