#include "app/process/face/contact_analysis.h"

#include <cmath>

#include "app/process/face/searched_pair.h"
#include "geometry/base/work_share.h"

namespace toothpath::face {
namespace {

/// A side of the gear with what rolled there.
struct FaceSide {
  rolled::RolledSide rolled;
  std::vector<contact::ContactMember> members;  ///< a ring each
};

std::string kind_of(const rolled::RolledSide& side) {
  if (side.modified) return "modified";
  bool line = false, whole = false;
  for (const auto& flank : side.flanks) {
    line |= flank.path && flank.path->line_contact;
    whole |= flank.path && flank.path->on_flanks;
  }
  if (line) return "line";
  if (!whole) return "edge";
  return side.as_cut || side.roll.error_range_rad < rolled::kNoError ? "point" : "point and edge";
}

/// The closed form is of plain flanks.
std::optional<rolled::ClosedPath> path_of(const contact::ContactMember& member) {
  if (member.modified()) return std::nullopt;
  const auto path = contact::contact_path(member.flank.surface, member.pinion, member.flank.side);
  if (!path) return std::nullopt;
  rolled::ClosedPath out{path->line_contact, path->B, path->error()};
  const auto range = path->line_contact ? std::nullopt : contact::path_on_flanks(*path, member);
  if (!range) return out;
  out.on_flanks = true;
  out.ratio = range->ratio;
  out.from = contact::ContactFlank::meridian(path->point(range->theta_1_from));
  out.to = contact::ContactFlank::meridian(path->point(range->theta_1_to));
  return out;
}

Result<FaceSide> side_of(const face_gear::FaceGear& gear, std::vector<contact::ContactFlank> flanks,
                         const job::ContactSettings& settings, int steps, bool as_cut) {
  FaceSide out;
  auto& side = out.rolled;
  side.side = flanks.front().side;
  side.as_cut = as_cut;
  for (auto& flank : flanks) {
    out.members.push_back(
        contact::make_member(gear, std::move(flank), settings.pinion_teeth, settings.moved, settings.modifications));
    const contact::ContactMember& member = out.members.back();
    side.pitch_rad = member.pitch();
    side.modified |= member.modified();
    side.flanks.push_back(rolled::rolled_flank(member.flank));
    side.flanks.back().path = path_of(member);
  }
  contact::RollOptions options;
  options.steps = steps;
  options.compound_mm = settings.compound_mm;
  auto rolled = contact::roll(out.members, options);
  if (!rolled) return rolled.error();
  side.roll = std::move(*rolled);
  side.kind = kind_of(side);
  if (side.kind == "line")
    for (std::size_t m = 0; m < out.members.size(); ++m) {
      const contact::ContactFlank& f = out.members[m].flank;
      for (std::size_t k = 0; k < f.points.size(); ++k)
        side.flanks[m].turn_rad.push_back(f.surface.flank_phi(f.side, f.theta[k], f.B[k]));
    }
  if (auto found = contact::ease_off(out.members)) side.ease_off = std::move(*found);
  for (std::size_t m = 0; side.ease_off && m < out.members.size(); ++m)
    side.places.push_back(
        contact::pattern_place(out.members[m], side.ease_off->maps[m], side.roll.patterns[m], options.compound_mm, 0));
  return out;
}

/// Modifications of the pinion that do not fit it.
std::optional<Refusal> refused_pinion(const face_gear::FaceGear& gear, const job::ContactSettings& settings) {
  const auto zones = static_cast<int>(gear.rings().size());
  for (std::size_t k = 0; k < settings.modifications.size(); ++k)
    if (const auto zone = settings.modifications[k].zone; zone && *zone >= zones)
      return Refusal{fmt::format("modification[{}].zone", k),
                     fail("zone = {} is not below {}, the number of zones", *zone, zones)};
  for (int zone = 0; zone < zones; ++zone) {
    const auto& ring = gear.rings()[static_cast<std::size_t>(zone)];
    const auto on = contact::rectangle_of(contact::make_pinion(ring.surface, settings.pinion_teeth), ring);
    if (auto refusal = modification::refused(settings.modifications, zone, on)) return refusal;
  }
  return std::nullopt;
}

/// Takes the sides, and adds the loaded pair where the settings have a load, on the exact flanks and on the cut ones.
process::ValueOrErrors<rolled::RolledPair> with_load(const job::Job& job, const face_gear::FaceGear& gear,
                                                     rolled::RolledPair analysis, std::vector<FaceSide> sides) {
  std::vector<const contact::ContactFlank*> cut;
  std::vector<const contact::ContactMember*> exact;
  for (FaceSide& side : sides) {
    for (const auto& member : side.members) {
      if (side.rolled.as_cut) cut.push_back(&member.flank);
      else exact.push_back(&member);
    }
    analysis.sides.push_back(std::move(side.rolled));
  }
  if (!analysis.settings.load) return analysis;
  auto loaded =
      analyse_loaded(job, gear, analysis.settings, analysis.settings.pinion_teeth, exact, cut, analysis.route);
  if (auto* errors = loaded.refused()) return std::move(*errors);
  analysis.loaded = std::move(loaded).value();
  return analysis;
}

}  // namespace

process::ValueOrErrors<rolled::RolledPair> analyse_contact(const job::Job& job, const face_gear::FaceGear& gear,
                                                           const job::ContactSettings& asked,
                                                           const process::CutFlanks* cut, const ContactGrid& grid) {
  rolled::RolledPair analysis;
  analysis.words = &kFaceWords;
  analysis.job_name = job.name;
  analysis.job_file = job.file;
  analysis.settings = asked;
  const face_gear::FaceGearParameters& p = gear.parameters();
  const char* key = asked.pinion_teeth > 0 ? "contact.pinion_teeth"
                    : p.mate_teeth > 0     ? "gear.mate_teeth"
                                           : "gear.shaper_teeth";
  job::ContactSettings& settings = analysis.settings;
  if (settings.pinion_teeth <= 0) settings.pinion_teeth = p.mate_teeth > 0 ? p.mate_teeth : p.shaper_teeth;
  if (const auto fits = contact::check_pinion(p, settings.pinion_teeth); !fits)
    return std::vector{process::located(job, key, fits.error())};
  analysis.pinion_teeth = settings.pinion_teeth;
  analysis.gear_teeth = p.teeth;
  const auto& surface = gear.rings().front().surface;
  const auto pinion = contact::make_pinion(surface, settings.pinion_teeth, settings.moved);
  analysis.pitch_radius_mm = surface.L_p;
  analysis.involute_pinion = {pinion.r_b, pinion.r_p, pinion.r_a};
  if (p.backlash_mm != 0)
    analysis.notes.push_back(fmt::format("the gear's backlash {:.4f} mm only adds a constant to phi_2", p.backlash_mm));
  if (gear.rings().size() > 1 && settings.moved.axial_mm != 0)
    analysis.notes.push_back(
        "an axial error turns the halves of a double helical pinion against each other: a pinion that floats would "
        "take the place without it");
  if (auto refusal = refused_pinion(gear, settings))
    return std::vector{process::located(job, "contact." + refusal->key, std::move(refusal->diagnostic))};

  std::vector<FaceSide> sides;
  const WorkShare share(cut ? 4 : 2);  // rolls
  for (const int s : {1, -1}) {
    std::vector<contact::ContactFlank> flanks;
    for (int zone = 0; zone < static_cast<int>(gear.rings().size()); ++zone) {
      auto flank = contact::exact_flank(gear, zone, s, grid.rows, grid.columns);
      if (!flank) return std::vector{process::located(job, fmt::format("gear.zone[{}]", zone), flank.error())};
      flanks.push_back(std::move(*flank));
    }
    auto side = side_of(gear, std::move(flanks), settings, grid.steps, false);
    if (!side) return std::vector{process::located(job, key, side.error())};
    sides.push_back(std::move(*side));
  }
  if (!cut) return with_load(job, gear, std::move(analysis), std::move(sides));
  analysis.route = cut->route;
  for (const int s : {1, -1}) {
    std::vector<contact::ContactFlank> flanks;
    for (const auto& f : cut->flanks) {
      if (f.side != s) continue;
      auto flank = contact::measured_flank(gear, f.zone, s, f.rows, f.columns, f.nominal, f.deviation_mm);
      if (!flank) return std::vector{process::located(job, fmt::format("gear.zone[{}]", f.zone), flank.error())};
      flanks.push_back(std::move(*flank));
    }
    if (flanks.empty()) return std::vector{fail_at(job.where(""), "the cut surface has no flank of side {:+}", s)};
    auto side = side_of(gear, std::move(flanks), settings, grid.steps, true);
    if (!side) return std::vector{process::located(job, key, side.error())};
    sides.push_back(std::move(*side));
  }
  return with_load(job, gear, std::move(analysis), std::move(sides));
}

}  // namespace toothpath::face
