#include "app/process/face/contact_analysis.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/process/face/searched_pair.h"
#include "app/process/under_load/loaded_page.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/base/work_share.h"

namespace toothpath::face {
namespace {

constexpr std::size_t kMotionStride = 4;  // positions of the roll to one of contact.json

bool is_modified(const ContactOfSide& side) {
  return std::any_of(side.members.begin(), side.members.end(), [](const auto& m) { return m.modified(); });
}

std::string kind_of(const ContactOfSide& side) {
  if (is_modified(side)) return "modified";
  bool line = false, whole = false;
  for (std::size_t m = 0; m < side.members.size(); ++m) {
    line |= side.paths[m] && side.paths[m]->line_contact;
    whole |= side.ranges[m].has_value();
  }
  if (line) return "line";
  if (!whole) return "edge";
  return side.as_cut || side.roll.error_range_rad < kNoError ? "point" : "point and edge";
}

Result<ContactOfSide> side_of(const face_gear::FaceGear& gear, std::vector<contact::ContactFlank> flanks,
                              const job::ContactSettings& settings, int steps, bool as_cut) {
  ContactOfSide side;
  side.side = flanks.front().side;
  side.as_cut = as_cut;
  for (auto& flank : flanks) {
    side.members.push_back(
        contact::make_member(gear, std::move(flank), settings.pinion_teeth, settings.moved, settings.modifications));
    const contact::ContactMember& member = side.members.back();
    const auto& surface = member.flank.surface;
    // The closed form is of plain flanks.
    side.paths.push_back(member.modified() ? std::nullopt : contact::contact_path(surface, member.pinion, side.side));
    side.ranges.push_back(side.paths.back() && !side.paths.back()->line_contact
                              ? contact::path_on_flanks(*side.paths.back(), member)
                              : std::nullopt);
  }
  contact::RollOptions options;
  options.steps = steps;
  options.compound_mm = settings.compound_mm;
  auto rolled = contact::roll(side.members, options);
  if (!rolled) return rolled.error();
  side.roll = std::move(*rolled);
  side.kind = kind_of(side);
  if (auto found = contact::ease_off(side.members)) side.ease_off = std::move(*found);
  for (std::size_t m = 0; side.ease_off && m < side.members.size(); ++m)
    side.places.push_back(
        contact::pattern_place(side.members[m], side.ease_off->maps[m], side.roll.patterns[m], options.compound_mm, 0));
  return side;
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

/// Edges of gear and pinion that a pattern reaches.
std::vector<std::string> edges_reached(const contact::FlankPattern& p, const contact::PatternPlace* place,
                                       double compound_mm) {
  const auto at_pinion = [&](contact::Edge edge) { return place != nullptr && place->reaches(edge, compound_mm); };
  std::vector<std::string> edges;
  for (const auto& [there, edge] : {std::pair(p.at_inner_end, contact::Edge::inner_end),
                                    {p.at_outer_end, contact::Edge::outer_end},
                                    {p.at_tip, contact::Edge::tip},
                                    {p.at_fillet, contact::Edge::fillet_line},
                                    {at_pinion(contact::Edge::pinion_tip), contact::Edge::pinion_tip},
                                    {at_pinion(contact::Edge::pinion_root), contact::Edge::pinion_root}})
    if (there) edges.emplace_back(to_string(edge));
  return edges;
}

/// The pattern in words, as on a rolling tester: along the tooth or across it, how inclined, where it runs out.
std::string words_of(const contact::FlankPattern& p, const contact::PatternPlace* place, double compound_mm) {
  if (!(p.marked_share > 0)) return "no mark";
  const double inclination = degrees(p.inclination_rad);
  std::string text;
  if (p.marked_share > 0.95) text = "whole flank";
  else if (p.length_mm < 1.3 * p.width_mm) text = "patch";
  else text = std::abs(inclination) < 50 ? "longitudinal" : "across the tooth";
  if (p.marked_share <= 0.95 && p.length_mm >= 1.3 * p.width_mm)
    text += fmt::format(", inclined {:.1f} deg", inclination);
  const auto ends = edges_reached(p, place, compound_mm);
  return text + (ends.empty() ? "; keeps off all edges" : fmt::format("; runs out at: {}", fmt::join(ends, ", ")));
}

}  // namespace

bool is_modified(const ContactAnalysis& analysis) {
  return std::any_of(analysis.sides.begin(), analysis.sides.end(),
                     [](const ContactOfSide& side) { return is_modified(side); });
}

ContactVerdict verdict_of(const ContactAnalysis& analysis) {
  std::vector<std::string> edges;
  bool beside = false;
  for (const ContactOfSide& side : analysis.sides) {
    beside |= side.kind.find("edge") != std::string::npos;
    for (std::size_t m = 0; m < side.members.size(); ++m)
      for (auto& edge : edges_reached(side.roll.patterns[m], m < side.places.size() ? &side.places[m] : nullptr,
                                      analysis.settings.compound_mm))
        if (std::find(edges.begin(), edges.end(), edge) == edges.end()) edges.push_back(std::move(edge));
  }
  double line_load = 0;
  if (analysis.loaded)
    for (const auto& side : analysis.loaded->sides)
      line_load = std::max(line_load, under_load::range_of(side.cycle, [](const loaded::LoadedPosition& p) {
                                        return p.end_line_load;
                                      }).most);
  ContactVerdict verdict;
  verdict.inside = !beside && edges.empty() && line_load == 0;
  if (beside) verdict.words = "edge contact";
  else if (!edges.empty()) verdict.words = fmt::format("pattern runs out at: {}", fmt::join(edges, ", "));
  else verdict.words = "contact inside the flanks";
  if (line_load > 0) verdict.words += fmt::format("; under load edges carry {:.0f} N/mm at most", line_load);
  return verdict;
}

std::string words_of(const contact::Misalignment& moved) {
  std::string text = fmt::format("offset {:+g} mm, angle {:+g} deg, axial {:+g} mm", moved.offset_mm,
                                 degrees(moved.angle_rad), moved.axial_mm);
  if (moved.gear_axial_mm != 0) text += fmt::format(", gear axial {:+g} mm", moved.gear_axial_mm);
  return text;
}

namespace {

using Json = nlohmann::ordered_json;

/// Path of contact and pattern in one ring.
Json zone_json(const ContactOfSide& side, std::size_t m, double compound_mm) {
  const contact::FlankPattern& p = side.roll.patterns[m];
  Json zone;
  zone["zone"] = side.members[m].flank.zone;
  if (const auto& path = side.paths[m]) {
    zone["path"] = {
        {"line_contact", path->line_contact}, {"B_deg", degrees(path->B)}, {"error_urad", path->error() * app::kMicro}};
    if (const auto& range = side.ranges[m]) {
      const Vec3 from = path->point(range->theta_1_from), to = path->point(range->theta_1_to);
      zone["path"]["ratio"] = range->ratio;
      zone["path"]["from"] = {{"r", std::hypot(from.x(), from.y())}, {"z", from.z()}};
      zone["path"]["to"] = {{"r", std::hypot(to.x(), to.y())}, {"z", to.z()}};
    }
  } else {
    zone["path"] = nullptr;
  }
  if (!p.path.empty()) {
    const double pitch = side.members[m].flank.surface.pitch;
    const auto place = [](const contact::RollPosition& at) { return Json{{"r", at.radius_mm}, {"z", at.height_mm}}; };
    zone["rolled_path"] = {{"from", place(p.path.front())},
                           {"to", place(p.path.back())},
                           {"pitches", (p.path.back().phi_2 - p.path.front().phi_2) / pitch}};
  } else {
    zone["rolled_path"] = nullptr;
  }
  const contact::PatternPlace* at = m < side.places.size() ? &side.places[m] : nullptr;
  zone["pattern"] = {{"words", words_of(p, at, compound_mm)},
                     {"share", p.marked_share},
                     {"r", {p.inner_mm, p.outer_mm}},
                     {"z", {p.low_mm, p.high_mm}},
                     {"centre", {{"r", p.centre_radius_mm}, {"z", p.centre_height_mm}}},
                     {"inclination_deg", degrees(p.inclination_rad)},
                     {"length_mm", p.length_mm},
                     {"width_mm", p.width_mm},
                     {"at_inner_end", p.at_inner_end},
                     {"at_outer_end", p.at_outer_end},
                     {"at_tip", p.at_tip},
                     {"at_fillet_line", p.at_fillet}};
  if (at != nullptr) {
    zone["pattern"]["at_pinion_tip"] = at->reaches(contact::Edge::pinion_tip, compound_mm);
    zone["pattern"]["profile"] = at->profile;
    zone["pattern"]["lead"] = at->lead;
  }
  return zone;
}

/// Adds the loaded pair where the settings have a load, on the exact flanks and on the cut ones.
process::ValueOrErrors<ContactAnalysis> with_load(const job::Job& job, const face_gear::FaceGear& gear,
                                                  ContactAnalysis analysis) {
  if (!analysis.settings.load) return analysis;
  std::vector<const contact::ContactFlank*> cut;
  std::vector<const contact::ContactMember*> exact;
  for (const auto& side : analysis.sides)
    for (const auto& member : side.members) {
      if (side.as_cut) cut.push_back(&member.flank);
      else exact.push_back(&member);
    }
  auto loaded =
      analyse_loaded(job, gear, analysis.settings, analysis.settings.pinion_teeth, exact, cut, analysis.route);
  if (auto* errors = loaded.refused()) return std::move(*errors);
  analysis.loaded = std::move(loaded).value();
  return analysis;
}

}  // namespace

ease_off::SideMap ease_off_of(const ContactOfSide& side) {
  ease_off::SideMap map{&kFaceWords,
                        fmt::format("{},{}", side.as_cut ? "cut" : "exact", side.side),
                        {},
                        side.ease_off ? &*side.ease_off : nullptr};
  for (const auto& member : side.members) {
    ease_off::MappedFlank flank{member.flank.zone, member.flank.rows, member.flank.columns, {}, {}};
    for (const Vec3& p : member.flank.points) {
      flank.x.push_back(radius(p));
      flank.y.push_back(p.z());
    }
    map.flanks.push_back(std::move(flank));
  }
  return map;
}

ease_off::MotionCurve motion_of(const ContactOfSide& side) {
  ease_off::MotionCurve curve{fmt::format("flank {:+}", side.side),
                              side.side,
                              {},
                              {},
                              side.roll.error_mean_rad,
                              side.roll.error_range_rad,
                              side.roll.cycle.front().phi_2,
                              side.members.front().flank.surface.pitch};
  for (const auto& at : side.roll.pair) {
    curve.phi_2.push_back(at.phi_2);
    curve.error_rad.push_back(at.error_rad);
  }
  return curve;
}

process::ValueOrErrors<ContactAnalysis> analyse_contact(const job::Job& job, const face_gear::FaceGear& gear,
                                                        const job::ContactSettings& asked,
                                                        const process::CutFlanks* cut, const ContactGrid& grid) {
  ContactAnalysis analysis;
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
  analysis.base_radius_mm = surface.M2;
  analysis.pinion_r_b_mm = pinion.r_b;
  analysis.pinion_r_p_mm = pinion.r_p;
  analysis.pinion_r_a_mm = pinion.r_a;
  if (p.backlash_mm != 0)
    analysis.notes.push_back(fmt::format("the gear's backlash {:.4f} mm only adds a constant to phi_2", p.backlash_mm));
  if (gear.rings().size() > 1 && settings.moved.axial_mm != 0)
    analysis.notes.push_back(
        "an axial error turns the halves of a double helical pinion against each other: a pinion that floats would "
        "take the place without it");
  if (auto refusal = refused_pinion(gear, settings))
    return std::vector{process::located(job, "contact." + refusal->key, std::move(refusal->diagnostic))};

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
    analysis.sides.push_back(std::move(*side));
  }
  if (!cut) return with_load(job, gear, std::move(analysis));
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
    analysis.sides.push_back(std::move(*side));
  }
  return with_load(job, gear, std::move(analysis));
}

std::string contact_csv(const ContactAnalysis& a) {
  std::string out = "surface,flank,zone,row,column,r,z,deviation_um,gap_um,marked,pinion_radius,pinion_Z\n";
  for (const auto& side : a.sides)
    for (std::size_t m = 0; m < side.members.size(); ++m) {
      const contact::ContactFlank& f = side.members[m].flank;
      const contact::FlankPattern& p = side.roll.patterns[m];
      for (int r = 0; r < f.rows; ++r)
        for (int c = 0; c < f.columns; ++c) {
          const auto k = f.index(r, c);
          const bool met = p.gap_mm[k] < 1e100;
          out += fmt::format(
              "{},{},{},{},{},{:.6f},{:.6f},{:.4f},{},{},{},{}\n", side.as_cut ? "cut" : "exact", side.side, f.zone, r,
              c, std::hypot(f.points[k].x(), f.points[k].y()), f.points[k].z(), f.deviation_mm[k] * app::kUm,
              met ? fmt::format("{:.4f}", std::max(0.0, p.gap_mm[k]) * app::kUm) : "",
              p.gap_mm[k] <= a.settings.compound_mm ? 1 : 0, met ? fmt::format("{:.6f}", p.pinion_radius_mm[k]) : "",
              met ? fmt::format("{:.6f}", p.pinion_Z_mm[k]) : "");
        }
    }
  return out;
}

std::string transmission_csv(const ContactAnalysis& a) {
  std::string out = "surface,flank,position,phi_1_deg,phi_2_deg,error_urad,error_um,touching,marking,zone,r,z\n";
  for (const auto& side : a.sides)
    for (std::size_t k = 0; k < side.roll.cycle.size(); ++k) {
      const contact::RollPosition& p = side.roll.cycle[k];
      out += fmt::format("{},{},{},{:.9f},{:.9f},{:.6f},{:.6f},{},{},{},{:.5f},{:.5f}\n", side.as_cut ? "cut" : "exact",
                         side.side, k, degrees(p.phi_1), degrees(p.phi_2), p.error_rad * app::kMicro,
                         p.error_rad * a.pitch_radius_mm * app::kUm, p.touching, p.marking,
                         side.members[static_cast<std::size_t>(p.member)].flank.zone, p.radius_mm, p.height_mm);
    }
  return out;
}

std::string contact_json(const ContactAnalysis& a) {
  Json json;
  json["schema"] = 1;
  json["command"] = "contact";
  json["job"] = a.job_name;
  json["pinion_teeth"] = a.pinion_teeth;
  json["gear_teeth"] = a.gear_teeth;
  json["misalignment"] = {{"offset_mm", a.settings.moved.offset_mm},
                          {"axial_mm", a.settings.moved.axial_mm},
                          {"angle_deg", degrees(a.settings.moved.angle_rad)},
                          {"gear_axial_mm", a.settings.moved.gear_axial_mm}};
  json["compound_um"] = a.settings.compound_mm * app::kUm;
  json["cut_surface"] = a.route.empty() ? Json(nullptr) : Json(a.route);
  json["pinion"] = {
      {"base_radius", a.pinion_r_b_mm}, {"pitch_radius", a.pinion_r_p_mm}, {"tip_radius", a.pinion_r_a_mm}};
  json["lever_mm"] = a.pitch_radius_mm;
  json["flanks"] = Json::array();
  for (const auto& side : a.sides) {
    Json s;
    s["surface"] = side.as_cut ? "cut" : "exact";
    s["side"] = side.side;
    s["contact"] = side.kind;
    const contact::RollResult& r = side.roll;
    s["transmission_error"] = {{"mean_urad", r.error_mean_rad * app::kMicro},
                               {"range_urad", r.error_range_rad * app::kMicro},
                               {"range_um", r.error_range_rad * a.pitch_radius_mm * app::kUm}};
    s["contact_ratio"] = r.contact_ratio;
    s["pairs_touching"] = {r.least_touching, r.most_touching};
    s["pairs_within_compound"] = {r.least_marking, r.most_marking};
    s["ratio_within_compound"] = r.marking_ratio;
    s["motion_curve"] = ease_off::motion_json(motion_of(side), kMotionStride);
    s["ease_off"] = ease_off::map_json(ease_off_of(side));
    s["zones"] = Json::array();
    for (std::size_t m = 0; m < side.members.size(); ++m)
      s["zones"].push_back(zone_json(side, m, a.settings.compound_mm));
    json["flanks"].push_back(std::move(s));
  }
  ease_off::add_misaligned(json, a.misaligned);
  if (a.loaded) json["loaded"] = under_load::loaded_json(*a.loaded);
  json["notes"] = a.notes;
  return json_text(json, 2) + "\n";
}

std::string contact_summary(const ContactAnalysis& a) {
  std::string out = fmt::format("contact of {} with a pinion of {} teeth (gear {} teeth), compound {:g} um\n",
                                a.job_name, a.pinion_teeth, a.gear_teeth, a.settings.compound_mm * app::kUm);
  const contact::Misalignment& moved = a.settings.moved;
  if (!moved.none()) out += "  misaligned: " + words_of(moved) + "\n";
  for (const auto& side : a.sides) {
    const contact::RollResult& r = side.roll;
    out += fmt::format("  flank {:+}, {}: {} contact\n", side.side, side.as_cut ? a.route : "exact", side.kind);
    if (r.error_range_rad < kNoError) out += "    transmission error: none, the ratio is constant\n";
    else
      out += fmt::format("    transmission error: range {:.3g} urad = {:.3g} um at {:.3f} mm, mean {:.4g} urad\n",
                         r.error_range_rad * app::kMicro, r.error_range_rad * a.pitch_radius_mm * app::kUm,
                         a.pitch_radius_mm, r.error_mean_rad * app::kMicro);
    out += fmt::format("    contact ratio {:.3f}, pairs in contact {} to {}; within the compound {:.3f}, {} to {}\n",
                       r.contact_ratio, r.least_touching, r.most_touching, r.marking_ratio, r.least_marking,
                       r.most_marking);
    out += ease_off::map_summary(ease_off_of(side));
    for (std::size_t m = 0; m < side.members.size(); ++m) {
      const contact::FlankPattern& p = r.patterns[m];
      const std::string zone = side.members.size() > 1 ? fmt::format("zone {}: ", side.members[m].flank.zone) : "";
      if (const auto& range = side.ranges[m]; range && !side.as_cut)
        out += fmt::format("    {}path at B = {:.4f} deg, ratio {:.3f}, radii {:.3f} (tip) to {:.3f} (pinion tip) mm\n",
                           zone, degrees(side.paths[m]->B), range->ratio,
                           side.paths[m]->point(range->theta_1_from).head<2>().norm(),
                           side.paths[m]->point(range->theta_1_to).head<2>().norm());
      out += fmt::format("    {}pattern: {:.1f} % of the flank, r {:.2f} to {:.2f}, z {:.2f} to {:.2f} mm; {}\n", zone,
                         p.marked_share * 100, p.inner_mm, p.outer_mm, p.low_mm, p.high_mm,
                         words_of(p, m < side.places.size() ? &side.places[m] : nullptr, a.settings.compound_mm));
    }
  }
  out += ease_off::misaligned_summary(a.misaligned);
  if (a.loaded) out += under_load::loaded_summary(*a.loaded);
  for (const auto& note : a.notes) out += "  note: " + note + "\n";
  return out;
}

}  // namespace toothpath::face
