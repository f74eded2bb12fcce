#include "app/process/bevel/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/process/bevel/cut_walls.h"
#include "app/process/bevel/loaded_contact.h"
#include "app/process/bevel/pair_ease_off.h"
#include "app/process/under_load/loaded_page.h"
#include "app/process/under_load/settings.h"
#include "app/report/page/study_page.h"
#include "app/report/svg/contact_pattern.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/contact/bevel_contact.h"

namespace toothpath::bevel {
namespace {

/// Everything that was found about the pair.
struct PairAnalysis {
  std::string name, mate;
  bool job_is_pinion = true;
  int pinion_teeth = 0, wheel_teeth = 0;
  contact::BevelAssembly assembly;
  double compound_mm = 0.006;
  std::vector<contact::BevelContact> walls;  ///< L, U
  std::string route;                         ///< of the walls as cut or measured; empty: there are none
  std::vector<contact::BevelContact> cut;    ///< those, L, U
  std::vector<std::string> notes;            ///< of their route
  std::vector<contact::MismatchChange> changes;
  std::optional<under_load::LoadedContact> loaded;  ///< where the settings have a load
  PairEaseOff ease_off;
};

constexpr std::array<const char*, 2> kWall = {"L", "U"};

/// A wall that was rolled, as drawn or as cut.
struct RolledWall {
  const contact::BevelContact& rolled;
  const char* wall;     ///< "L"
  const char* surface;  ///< "exact", "cut"
  std::string name;     ///< "L", "L, as cut"
};
std::vector<RolledWall> rolled_walls(const PairAnalysis& a) {
  std::vector<RolledWall> out;
  for (std::size_t w = 0; w < a.walls.size(); ++w) out.push_back({a.walls[w], kWall[w], "exact", kWall[w]});
  for (std::size_t w = 0; w < a.cut.size(); ++w)
    out.push_back({a.cut[w], kWall[w], "cut", fmt::format("{}, {}", kWall[w], process::words_of_route(a.route))});
  return out;
}

page::PageTable wall_table(const PairAnalysis& a) {
  page::PageTable t{"Walls",
                    {"wall", "transmission error um", "urad of the pinion", "mismatch least um", "greatest um",
                     "rms um", "pairs marking", "marked"},
                    {},
                    "Transmission error: peak to peak over one pitch, um at the mean pitch circle. Mismatch: normal "
                    "distance of the flanks at the exact ratio; 0 everywhere only for conjugate flanks."};
  for (const RolledWall& wall : rolled_walls(a)) {
    const contact::BevelContact& c = wall.rolled;
    std::string marked;
    for (const auto& g : c.patterns)
      marked += fmt::format("{}{:.0f} %", marked.empty() ? "" : ", ", g.marked_share * 100);
    t.rows.push_back({wall.name, fmt::format("{:.2f}", c.error_range_mm * 1000),
                      fmt::format("{:.1f}", c.error_range_rad * 1e6), fmt::format("{:.2f}", c.mismatch_min_mm * 1000),
                      fmt::format("{:.2f}", c.mismatch_max_mm * 1000), fmt::format("{:.2f}", c.mismatch_rms_mm * 1000),
                      fmt::format("{:.2f} ({} to {})", c.marking_ratio, c.least_marking, c.most_marking), marked});
  }
  return t;
}

page::PageTable change_table(const PairAnalysis& a) {
  page::PageTable t{
      "What would bring the flanks closer",
      {"change", "best amount", "unit", "rms before um", "after um", ""},
      {},
      "Both walls together, a constant of each wall (play) left out. One change at a time: first order. Sets: rolled "
      "again with the changed pinion. Convex and concave name the walls by their shape at the large end."};
  for (const auto& c : a.changes)
    t.rows.push_back({c.name, fmt::format("{:.4f}", c.amount), c.unit, fmt::format("{:.2f}", c.rms_before_mm * 1000),
                      fmt::format("{:.2f}", c.rms_after_mm * 1000), c.measured ? "measured" : "first order"});
  return t;
}

/// How far from conjugate, in words.
std::string finding(const PairAnalysis& a) {
  double range = 0, rms = 0;
  for (const auto& c : a.walls) range = std::max(range, c.error_range_mm), rms = std::max(rms, c.mismatch_rms_mm);
  if (rms < 1e-6) return "The flanks are conjugate: the mismatch is below 0.001 um rms.";
  const double best = a.changes.empty() ? 0 : a.changes.back().rms_after_mm,
               before = a.changes.empty() ? 0 : a.changes.back().rms_before_mm;
  return fmt::format(
      "The flanks are not conjugate: at the exact ratio they miss each other by up to {:.1f} um rms on a wall, and the "
      "transmission error is {:.1f} um peak to peak. The best change of the pinion's mills and traces that was tried "
      "takes the mismatch of both walls from {:.1f} to {:.1f} um rms.",
      rms * 1000, range * 1000, before * 1000, best * 1000);
}

std::vector<svg::LineChart> charts_of(const PairAnalysis& a) {
  svg::LineChart error{"Transmission error over one pitch",
                       "turn of the wheel [deg]",
                       "pinion ahead of the exact ratio [urad]",
                       {},
                       {},
                       false,
                       false,
                       false,
                       "The pinion stops at the first pair that touches; jumps of the slope are changes of the pair."};
  svg::LineChart pairs{"Pairs within the compound", "turn of the wheel [deg]", "pairs", {}, {}, false, false, true, ""};
  for (const RolledWall& wall : rolled_walls(a)) {
    const std::string name = "wall " + wall.name;
    svg::ChartSeries e{name, {}, {}}, n{name, {}, {}};
    for (const auto& at : wall.rolled.cycle) {
      e.x.push_back(degrees(at.phi_2));
      e.y.push_back((at.error_rad - wall.rolled.error_mean_rad) * 1e6);
      n.x.push_back(degrees(at.phi_2));
      n.y.push_back(at.marking);
    }
    error.series.push_back(std::move(e));
    pairs.series.push_back(std::move(n));
  }
  return {error, pairs};
}

std::vector<page::StudyPage::Figure> figures_of(const PairAnalysis& a) {
  std::vector<page::StudyPage::Figure> figures;
  for (const RolledWall& wall : rolled_walls(a))
    for (const auto& g : wall.rolled.patterns) {
      const std::string where =
          fmt::format("wall {} of the wheel{}", wall.name,
                      wall.rolled.patterns.size() > 1 ? g.half == 0 ? ", inner half" : ", outer half" : "");
      svg::PatternDrawing pattern;
      pattern.title = "contact pattern, " + where;
      pattern.x_label = "cone distance [mm]";
      pattern.y_label = "height [mm]";
      pattern.rows = g.rows;
      pattern.columns = g.columns;
      pattern.compound_um = a.compound_mm * 1000;
      svg::FlankFieldDrawing field{
          "mismatch, " + where, "cone distance [mm]", "height [mm]", "um", g.rows, g.columns, {}, {}, {}, 0};
      for (std::size_t k = 0; k < g.places.size(); ++k) {
        pattern.x.push_back(g.places[k].ell);
        pattern.y.push_back(g.places[k].height);
        pattern.gap_um.push_back(std::isnan(g.gap_mm[k]) ? 1e9 : g.gap_mm[k] * 1000);
        field.value.push_back(std::isnan(g.mismatch_mm[k]) ? 0 : g.mismatch_mm[k] * 1000);
      }
      field.x = pattern.x, field.y = pattern.y;
      for (const auto& at : wall.rolled.cycle)
        if (at.half == g.half) pattern.path.emplace_back(at.ell, at.height);
      std::sort(pattern.path.begin(), pattern.path.end());
      figures.push_back({"Contact pattern, " + where, svg::svg_contact_pattern(pattern),
                         fmt::format("Compound {:g} um; line: places that touch first.", a.compound_mm * 1000)});
      figures.push_back({"Mismatch at the exact ratio, " + where, svg::svg_flank_field(field),
                         fmt::format("Above zero ({}): a gap; below ({}): the flanks would overlap and lift the other "
                                     "pairs off. White also where the pinion's flank has ended.",
                                     svg::kAboveZero, svg::kBelowZero)});
    }
  return figures;
}

std::string page_of(const PairAnalysis& a) {
  page::StudyPage page;
  page.title = a.name + ": contact of the pair";
  page.subtitle = fmt::format("pinion of {} teeth, wheel of {} teeth; mate: {}", a.pinion_teeth, a.wheel_teeth, a.mate);
  const contact::BevelAssembly& m = a.assembly;
  if (m.offset_mm != 0 || m.pinion_axial_mm != 0 || m.wheel_axial_mm != 0 || m.shaft_angle_rad != 0)
    page.subtitle +=
        fmt::format("; offset {:+g} mm, shaft angle {:+g} deg, pinion axial {:+g} mm, wheel axial {:+g} mm",
                    m.offset_mm, degrees(m.shaft_angle_rad), m.pinion_axial_mm, m.wheel_axial_mm);
  double rms = 0;
  for (const auto& c : a.walls) rms = std::max(rms, c.mismatch_rms_mm);
  page.good = rms < 1e-6;
  page.verdict = page.good ? "conjugate" : fmt::format("not conjugate: {:.1f} um rms", rms * 1000);
  page.introduction = {finding(a),
                       "Both gears are the exact envelopes of their mills and turn as rigid bodies without load. Wall "
                       "L of the pinion runs on wall L of the wheel, U on U."};
  for (const auto& note : a.notes) page.introduction.push_back(note);
  page.charts = charts_of(a);
  page.figures = figures_of(a);
  page.tables = {wall_table(a), change_table(a)};
  if (a.loaded) under_load::add_to_page(page, *a.loaded);
  add_to_page(page, a.ease_off);
  return study_page_html(page);
}

std::string places_csv(const PairAnalysis& a) {
  std::string out = "wall,half,cone_distance,height,x,y,z,mismatch_um,gap_um,surface\n";
  const auto um = [](double mm) { return std::isnan(mm) ? std::string() : fmt::format("{:.4f}", mm * 1000); };
  for (const RolledWall& wall : rolled_walls(a))
    for (const auto& g : wall.rolled.patterns)
      for (std::size_t k = 0; k < g.places.size(); ++k) {
        const auto& p = g.places[k];
        if (!p.point.allFinite()) continue;
        out += fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{},{},{}\n", wall.wall, g.half, p.ell, p.height,
                           p.point.x(), p.point.y(), p.point.z(), um(g.mismatch_mm[k]), um(g.gap_mm[k]), wall.surface);
      }
  return out;
}

std::string transmission_csv(const PairAnalysis& a) {
  std::string out = "wall,phi_2_deg,phi_1_deg,error_urad,half,pair,cone_distance,height,marking,surface\n";
  for (const RolledWall& wall : rolled_walls(a))
    for (const auto& at : wall.rolled.cycle)
      out += fmt::format("{},{:.9f},{:.9f},{:.4f},{},{},{:.6f},{:.6f},{},{}\n", wall.wall, degrees(at.phi_2),
                         degrees(at.phi_1), at.error_rad * 1e6, at.half, at.tooth, at.ell, at.height, at.marking,
                         wall.surface);
  return out;
}

std::string json_of(const PairAnalysis& a) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = "contact";
  json["job"] = a.name;
  json["mate"] = a.mate;
  json["pinion_teeth"] = a.pinion_teeth;
  json["wheel_teeth"] = a.wheel_teeth;
  json["compound_um"] = a.compound_mm * 1000;
  json["assembly"] = {{"offset_mm", a.assembly.offset_mm},
                      {"shaft_angle_deg", degrees(a.assembly.shaft_angle_rad)},
                      {"pinion_axial_mm", a.assembly.pinion_axial_mm},
                      {"wheel_axial_mm", a.assembly.wheel_axial_mm}};
  json["cut_surface"] = a.route.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(a.route);
  const auto rolled = rolled_walls(a);
  for (std::size_t w = 0; w < rolled.size(); ++w) {
    const contact::BevelContact& c = rolled[w].rolled;
    nlohmann::ordered_json wall = {{"wall", rolled[w].wall},
                                   {"surface", rolled[w].surface},
                                   {"transmission_error_urad", c.error_range_rad * 1e6},
                                   {"transmission_error_um", c.error_range_mm * 1000},
                                   {"mismatch_least_um", c.mismatch_min_mm * 1000},
                                   {"mismatch_greatest_um", c.mismatch_max_mm * 1000},
                                   {"mismatch_rms_um", c.mismatch_rms_mm * 1000},
                                   {"pairs_marking", c.marking_ratio},
                                   {"pairs_least", c.least_marking},
                                   {"pairs_most", c.most_marking}};
    for (const auto& g : c.patterns) wall["marked_share"].push_back(g.marked_share);
    if (w < a.walls.size()) add_wall(wall, a.ease_off, w);
    json["walls"].push_back(wall);
  }
  for (const auto& c : a.changes)
    json["changes"].push_back({{"name", c.name},
                               {"amount", c.amount},
                               {"unit", c.unit},
                               {"rms_before_um", c.rms_before_mm * 1000},
                               {"rms_after_um", c.rms_after_mm * 1000},
                               {"measured", c.measured}});
  ease_off::add_misaligned(json, a.ease_off.misaligned);
  json["finding"] = finding(a);
  json["notes"] = a.notes;
  if (a.loaded) json["loaded"] = under_load::loaded_json(*a.loaded);
  return json_text(json, 1) + "\n";
}

/// The gear that the job's gear runs with.
process::ValueOrErrors<bevel_gear::BevelGear> mate_of(const process::ContactAsked& request, const job::Job& job,
                                                      const bevel_gear::BevelGear& gear, std::string& name) {
  if (request.other_job.empty()) {
    auto mate = contact::bevel_mate(gear);
    if (!mate) {
      Diagnostic error = mate.error();
      error.message += "; that is the mate as the same mill would cut it: --mate JOB names the one that is there";
      return std::vector{process::located(job, "gear.mate_teeth", std::move(error))};
    }
    name = "by the rules of the pair, cut with the same mill";
    return std::move(mate.value());
  }
  auto read = job::read_job_file(request.other_job);
  if (auto* errors = read.refused()) return std::move(*errors);
  const job::Job& other = read.value();
  name = request.other_job;
  return process::make_bevel_gear(other);
}

/// Both walls of a pair.
process::ValueOrErrors<std::vector<contact::BevelContact>> roll_walls(const job::Job& job,
                                                                      const contact::BevelPair& pair,
                                                                      const contact::BevelContactOptions& options) {
  std::vector<contact::BevelContact> out;
  for (const int sigma : {1, -1}) {
    auto contact = contact::bevel_contact(pair, sigma, options);
    if (!contact) return std::vector{process::located(job, "gear", contact.error())};
    out.push_back(std::move(contact.value()));
  }
  return out;
}

/// Errors of measured files have their place already.
Diagnostic located_in_file(const job::Job& job, Diagnostic error) {
  return error.position.file.empty() ? process::located(job, "gear", std::move(error)) : error;
}

/// The walls as cut or measured, rolled as `pair` stands: into `a`. What stands on them.
process::ValueOrErrors<contact::BevelLeft> roll_as_cut(const job::Job& job, const bevel_gear::BevelGear& gear,
                                                       const process::ContactAsked& asked,
                                                       const process::CutFlanks* cut, const contact::BevelPair& pair,
                                                       const contact::BevelContactOptions& options,
                                                       app::StageClock& clock, PairAnalysis& a) {
  auto walls = clock.run(
      "cut walls", [&] { return cut != nullptr ? walls_as_cut(gear, *cut) : walls_as_measured(gear, asked.measured); });
  if (!walls) return std::vector{located_in_file(job, walls.error())};
  a.route = walls->route, a.notes = walls->notes;
  contact::BevelLeft left = left_on_pair(*walls, a.job_is_pinion);
  const auto as_cut = contact::BevelPair::make(pair.pinion(), pair.wheel(), a.assembly, {}, left);
  if (!as_cut) return std::vector{process::located(job, "gear", as_cut.error())};
  auto rolled = clock.run("contact", [&] { return roll_walls(job, *as_cut, options); });
  if (auto* errors = rolled.refused()) return std::move(*errors);
  a.cut = std::move(rolled).value();
  return left;
}

/// Files, JSON and what stands on the screen.
process::ContactFound told(const PairAnalysis& a) {
  process::ContactFound found;
  found.missed = a.ease_off.misaligned.missed();
  found.job_text = a.ease_off.misaligned.job_text;
  found.json = json_of(a);
  found.summary = fmt::format("{}: pinion {} teeth, wheel {} teeth\n{}\n{}\n{}\n{}", a.name, a.pinion_teeth,
                              a.wheel_teeth, page::table_text(wall_table(a)), finding(a),
                              page::table_text(change_table(a)), ease_off_summary(a.ease_off));
  found.files = {{"contact.csv", places_csv(a)},
                 {"ease_off.csv", ease_off_csv(a.ease_off)},
                 {"transmission.csv", transmission_csv(a)},
                 {"contact.json", found.json},
                 {"contact.html", page_of(a)}};
  if (a.loaded) {
    found.summary += under_load::loaded_summary(*a.loaded);
    under_load::add_files(found.files, *a.loaded);
  }
  for (const auto& note : a.notes) found.summary += "  note: " + note + "\n";
  return found;
}

}  // namespace

process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job, const bevel_gear::BevelGear& gear,
                                                        const process::ContactAsked& asked,
                                                        const process::CutFlanks* cut, app::StageClock& clock) {
  PairAnalysis a;
  a.name = job.name;
  const job::ContactSettings settings = under_load::contact_settings(job, asked);
  if (!asked.ccx_dir.empty() && !settings.load)
    return std::vector{fail_at(job.where(""), "--ccx needs a load: --torque or [contact.load]")};
  auto mated = clock.run("mate", [&] { return mate_of(asked, job, gear, a.mate); });
  if (auto* errors = mated.refused()) return std::move(*errors);
  const bevel_gear::BevelGear& mate = mated.value();
  a.job_is_pinion = gear.parameters().teeth <= mate.parameters().teeth;
  const bevel_gear::BevelGear &pinion = a.job_is_pinion ? gear : mate, &wheel = a.job_is_pinion ? mate : gear;
  a.pinion_teeth = pinion.parameters().teeth;
  a.wheel_teeth = wheel.parameters().teeth;
  a.assembly = contact::assembly_of(settings.moved);
  a.compound_mm = settings.compound_mm;
  const auto pair = contact::BevelPair::make(pinion, wheel, a.assembly);
  if (!pair) return std::vector{process::located(job, "gear", pair.error())};
  // Two rows and columns lie in a margin of 5 %.
  const contact::BevelContactOptions options{25, 25, 32, a.compound_mm};
  auto rolled = clock.run("contact", [&] { return roll_walls(job, *pair, options); });
  if (auto* errors = rolled.refused()) return std::move(*errors);
  a.walls = std::move(rolled).value();
  contact::BevelLeft left;
  if (cut != nullptr || !asked.measured.files.empty()) {
    auto found = roll_as_cut(job, gear, asked, cut, *pair, options, clock, a);
    if (auto* errors = found.refused()) return std::move(*errors);
    left = std::move(found).value();
  }
  auto changes = clock.run("changes", [&] {
    return contact::mismatch_changes(pinion, wheel, {11, 9, 24, a.compound_mm});
  });
  if (!changes) return std::vector{process::located(job, "gear", changes.error())};
  a.changes = std::move(changes.value());
  if (settings.load) {
    auto loaded = clock.run("load", [&] { return analyse_loaded(job, pinion, wheel, settings, left, a.route); });
    if (auto* errors = loaded.refused()) return std::move(*errors);
    a.loaded = std::move(loaded).value();
  }

  BevelPairAsked searched{&job, &gear, &mate, asked.other_job, settings, asked.modify, options};
  if (searched.modify.empty()) searched.modify = searched.own();
  auto eased = analyse_ease_off(searched, *pair, a.walls, asked, clock);
  if (auto* errors = eased.refused()) return std::move(*errors);
  a.ease_off = std::move(eased).value();

  process::ContactFound found = told(a);
  if (a.loaded && !asked.ccx_dir.empty()) {
    auto decks = loaded_decks(job, pinion, wheel, *a.loaded, settings);
    if (auto* errors = decks.refused()) return std::move(*errors);
    found.decks = std::move(decks).value();
  }
  return found;
}

}  // namespace toothpath::bevel
