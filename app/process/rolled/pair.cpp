#include "app/process/rolled/pair.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/process/under_load/loaded_page.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::rolled {
namespace {

constexpr std::size_t kMotionStride = 4;  // positions of the roll to one of contact.json

/// Edges of gear and pinion that the pattern of a flank reaches.
std::vector<std::string> edges_reached(const RolledPair& a, const RolledSide& side, std::size_t m) {
  const contact::FlankPattern& p = side.roll.patterns[m];
  const auto at_other = [&](contact::Edge edge) {
    return m < side.places.size() && side.places[m].reaches(edge, a.settings.compound_mm);
  };
  const std::vector<std::pair<bool, std::string>> all = {
      {p.at_inner_end, to_string(contact::Edge::inner_end)},
      {p.at_outer_end, to_string(contact::Edge::outer_end)},
      {p.at_tip, to_string(contact::Edge::tip)},
      {p.at_fillet, to_string(contact::Edge::fillet_line)},
      {at_other(contact::Edge::pinion_tip), a.other + " tip"},
      {at_other(contact::Edge::pinion_root), "end of the " + a.other + "'s flank"}};
  std::vector<std::string> edges;
  for (const auto& [reached, name] : all)
    if (reached) edges.push_back(name);
  return edges;
}

/// The pattern in words, as on a rolling tester: along the tooth or across it, how inclined, where it runs out.
std::string words_of(const RolledPair& a, const RolledSide& side, std::size_t m) {
  const contact::FlankPattern& p = side.roll.patterns[m];
  if (!(p.marked_share > 0)) return "no mark";
  const double inclination = degrees(p.inclination_rad);
  std::string text;
  if (p.marked_share > 0.95) text = "whole flank";
  else if (p.length_mm < 1.3 * p.width_mm) text = "patch";
  else text = std::abs(inclination) < 50 ? "longitudinal" : "across the tooth";
  if (p.marked_share <= 0.95 && p.length_mm >= 1.3 * p.width_mm)
    text += fmt::format(", inclined {:.1f} deg", inclination);
  const auto ends = edges_reached(a, side, m);
  return text + (ends.empty() ? "; keeps off all edges" : fmt::format("; runs out at: {}", fmt::join(ends, ", ")));
}

}  // namespace

bool is_modified(const RolledPair& pair) {
  return std::any_of(pair.sides.begin(), pair.sides.end(), [](const RolledSide& side) { return side.modified; });
}

Verdict verdict_of(const RolledPair& analysis) {
  std::vector<std::string> edges;
  bool beside = false;
  for (const RolledSide& side : analysis.sides) {
    beside |= side.kind.find("edge") != std::string::npos;
    for (std::size_t m = 0; m < side.flanks.size(); ++m)
      for (auto& edge : edges_reached(analysis, side, m))
        if (std::find(edges.begin(), edges.end(), edge) == edges.end()) edges.push_back(std::move(edge));
  }
  double line_load = 0;
  if (analysis.loaded)
    for (const auto& side : analysis.loaded->sides)
      line_load = std::max(line_load, under_load::range_of(side.cycle, [](const loaded::LoadedPosition& p) {
                                        return p.end_line_load;
                                      }).most);
  Verdict verdict;
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
Json zone_json(const RolledPair& a, const RolledSide& side, std::size_t m) {
  const ease_off::PairWords& words = *a.words;
  const double compound_mm = a.settings.compound_mm;
  const auto place = [&](const Vec2& at) { return Json{{words.x_key, at.x()}, {words.y_key, at.y()}}; };
  const contact::FlankPattern& p = side.roll.patterns[m];
  Json zone;
  zone["zone"] = side.flanks[m].zone;
  if (const auto& path = side.flanks[m].path) {
    zone["path"] = {{"line_contact", path->line_contact},
                    {"B_deg", degrees(path->B_rad)},
                    {"error_urad", path->error_rad * app::kMicro}};
    if (path->on_flanks) {
      zone["path"]["ratio"] = path->ratio;
      zone["path"]["from"] = place(path->from);
      zone["path"]["to"] = place(path->to);
    }
  } else {
    zone["path"] = nullptr;
  }
  if (!p.path.empty())
    zone["rolled_path"] = {{"from", place({p.path.front().radius_mm, p.path.front().height_mm})},
                           {"to", place({p.path.back().radius_mm, p.path.back().height_mm})},
                           {"pitches", (p.path.back().phi_2 - p.path.front().phi_2) / side.pitch_rad}};
  else zone["rolled_path"] = nullptr;
  const contact::PatternPlace* at = m < side.places.size() ? &side.places[m] : nullptr;
  zone["pattern"] = {{"words", words_of(a, side, m)},
                     {"share", p.marked_share},
                     {words.x_key, {p.inner_mm, p.outer_mm}},
                     {words.y_key, {p.low_mm, p.high_mm}},
                     {"centre", place({p.centre_radius_mm, p.centre_height_mm})},
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

}  // namespace

ease_off::SideMap ease_off_of(const RolledPair& pair, const RolledSide& side) {
  ease_off::SideMap map{pair.words,
                        fmt::format("{},{}", side.as_cut ? "cut" : "exact", side.side),
                        {},
                        side.ease_off ? &*side.ease_off : nullptr};
  for (const RolledFlank& flank : side.flanks) map.flanks.push_back(flank);
  return map;
}

ease_off::MotionCurve motion_of(const RolledSide& side) {
  ease_off::MotionCurve curve{
      fmt::format("flank {:+}", side.side), side.side,     {}, {}, side.roll.error_mean_rad, side.roll.error_range_rad,
      side.roll.cycle.front().phi_2,        side.pitch_rad};
  for (const auto& at : side.roll.pair) {
    curve.phi_2.push_back(at.phi_2);
    curve.error_rad.push_back(at.error_rad);
  }
  return curve;
}

std::string contact_csv(const RolledPair& a) {
  std::string out =
      fmt::format("surface,flank,zone,row,column,{},{},deviation_um,gap_um,marked,pinion_radius,pinion_Z\n",
                  a.words->x_key, a.words->y_key);
  for (const auto& side : a.sides)
    for (std::size_t m = 0; m < side.flanks.size(); ++m) {
      const RolledFlank& f = side.flanks[m];
      const contact::FlankPattern& p = side.roll.patterns[m];
      for (int r = 0; r < f.rows; ++r)
        for (int c = 0; c < f.columns; ++c) {
          const auto k = f.index(r, c);
          const bool met = p.gap_mm[k] < 1e100;
          out += fmt::format("{},{},{},{},{},{:.6f},{:.6f},{:.4f},{},{},{},{}\n", side.as_cut ? "cut" : "exact",
                             side.side, f.zone, r, c, f.x[k], f.y[k], f.deviation_mm[k] * app::kUm,
                             met ? fmt::format("{:.4f}", std::max(0.0, p.gap_mm[k]) * app::kUm) : "",
                             p.gap_mm[k] <= a.settings.compound_mm ? 1 : 0,
                             met ? fmt::format("{:.6f}", p.pinion_radius_mm[k]) : "",
                             met ? fmt::format("{:.6f}", p.pinion_Z_mm[k]) : "");
        }
    }
  return out;
}

std::string transmission_csv(const RolledPair& a) {
  std::string out =
      fmt::format("surface,flank,position,phi_1_deg,phi_2_deg,error_urad,error_um,touching,marking,zone,{},{}\n",
                  a.words->x_key, a.words->y_key);
  for (const auto& side : a.sides)
    for (std::size_t k = 0; k < side.roll.cycle.size(); ++k) {
      const contact::RollPosition& p = side.roll.cycle[k];
      out += fmt::format("{},{},{},{:.9f},{:.9f},{:.6f},{:.6f},{},{},{},{:.5f},{:.5f}\n", side.as_cut ? "cut" : "exact",
                         side.side, k, degrees(p.phi_1), degrees(p.phi_2), p.error_rad * app::kMicro,
                         p.error_rad * a.pitch_radius_mm * app::kUm, p.touching, p.marking,
                         side.flanks[static_cast<std::size_t>(p.member)].zone, p.radius_mm, p.height_mm);
    }
  return out;
}

std::string contact_json(const RolledPair& a) {
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
  if (!a.mate.empty()) {
    json["mate"] = a.mate;
    json["shafts"] = {{"angle_deg", degrees(a.shaft_angle_rad)}, {"distance_mm", a.distance_mm}};
  }
  if (a.involute_pinion)
    json["pinion"] = {{"base_radius", a.involute_pinion->r_b_mm},
                      {"pitch_radius", a.involute_pinion->r_p_mm},
                      {"tip_radius", a.involute_pinion->r_a_mm}};
  json["lever_mm"] = a.pitch_radius_mm;
  json["flanks"] = Json::array();
  for (const auto& side : a.sides) {
    Json s;
    s["surface"] = side.as_cut ? "cut" : "exact";
    s["side"] = side.side;
    s["contact"] = side.kind;
    const contact::RollResult& r = side.roll;
    s["transmission_error"] = ease_off::transmission_error_json(r.error_mean_rad, r.error_range_rad, a.pitch_radius_mm);
    s["contact_ratio"] = r.contact_ratio;
    s["pairs_touching"] = {r.least_touching, r.most_touching};
    s["pairs_within_compound"] = {r.least_marking, r.most_marking};
    s["ratio_within_compound"] = r.marking_ratio;
    s["motion_curve"] = ease_off::motion_json(motion_of(side), kMotionStride);
    s["ease_off"] = ease_off::map_json(ease_off_of(a, side));
    s["zones"] = Json::array();
    for (std::size_t m = 0; m < side.flanks.size(); ++m) s["zones"].push_back(zone_json(a, side, m));
    json["flanks"].push_back(std::move(s));
  }
  ease_off::add_misaligned(json, a.misaligned);
  if (a.loaded) json["loaded"] = under_load::loaded_json(*a.loaded);
  json["notes"] = a.notes;
  return json_text(json, 2) + "\n";
}

std::string contact_summary(const RolledPair& a) {
  std::string out = fmt::format("contact of {} with a {} of {} teeth ({} {} teeth), compound {:g} um\n", a.job_name,
                                a.other, a.pinion_teeth, a.carrier, a.gear_teeth, a.settings.compound_mm * app::kUm);
  if (!a.mate.empty())
    out += fmt::format("  rolled with {}: shafts at {:g} deg, {:.6g} mm apart\n", a.mate, degrees(a.shaft_angle_rad),
                       a.distance_mm);
  const contact::Misalignment& moved = a.settings.moved;
  if (!moved.none()) out += "  misaligned: " + words_of(moved) + "\n";
  for (const auto& side : a.sides) {
    const contact::RollResult& r = side.roll;
    out += fmt::format("  flank {:+}, {}: {} contact\n", side.side, side.as_cut ? a.route : "exact", side.kind);
    if (r.error_range_rad < kNoError) out += "    transmission error: none, the ratio is constant\n";
    else
      out += fmt::format(
          "    transmission error: range {:.3g} urad = {:.3g} um at {:.3f} mm ({:.3g} arc seconds), mean {:.4g} urad\n",
          r.error_range_rad * app::kMicro, r.error_range_rad * a.pitch_radius_mm * app::kUm, a.pitch_radius_mm,
          degrees(r.error_range_rad) * 3600, r.error_mean_rad * app::kMicro);
    out += fmt::format("    contact ratio {:.3f}, pairs in contact {} to {}; within the compound {:.3f}, {} to {}\n",
                       r.contact_ratio, r.least_touching, r.most_touching, r.marking_ratio, r.least_marking,
                       r.most_marking);
    out += ease_off::map_summary(ease_off_of(a, side));
    for (std::size_t m = 0; m < side.flanks.size(); ++m) {
      const contact::FlankPattern& p = r.patterns[m];
      const std::string zone = side.flanks.size() > 1 ? fmt::format("zone {}: ", side.flanks[m].zone) : "";
      if (const auto& path = side.flanks[m].path; path && path->on_flanks && !side.as_cut)
        out += fmt::format("    {}path at B = {:.4f} deg, ratio {:.3f}, radii {:.3f} (tip) to {:.3f} (pinion tip) mm\n",
                           zone, degrees(path->B_rad), path->ratio, path->from.x(), path->to.x());
      out += fmt::format("    {}pattern: {:.1f} % of the flank, {} {:.2f} to {:.2f}, {} {:.2f} to {:.2f} mm; {}\n",
                         zone, p.marked_share * 100, a.words->x_text, p.inner_mm, p.outer_mm, a.words->y_text, p.low_mm,
                         p.high_mm, words_of(a, side, m));
    }
  }
  out += ease_off::misaligned_summary(a.misaligned);
  if (a.loaded) out += under_load::loaded_summary(*a.loaded);
  for (const auto& note : a.notes) out += "  note: " + note + "\n";
  return out;
}

}  // namespace toothpath::rolled
