#include "app/process/face/contact.h"

#include "app/base/units.h"
#include "app/process/face/contact_figures.h"
#include "app/process/face/searched_pair.h"
#include "app/process/under_load/asked_besides.h"
#include "app/process/under_load/loaded_page.h"
#include "app/process/under_load/settings.h"
#include "app/report/page/study_page.h"

namespace toothpath::face {
namespace {

std::string contact_page(const ContactAnalysis& a) {
  page::StudyPage page;
  page.title = a.job_name + ": contact";
  page.subtitle = fmt::format("pinion of {} teeth, gear of {} teeth, compound {:g} um", a.pinion_teeth, a.gear_teeth,
                              a.settings.compound_mm * 1000);
  const contact::Misalignment& moved = a.settings.moved;
  if (!moved.none()) page.subtitle += "; " + words_of(moved);
  ContactVerdict verdict = verdict_of(a);
  page.good = verdict.inside, page.verdict = std::move(verdict.words);
  page.introduction = {
      "Both members turn as rigid bodies without load, as on a rolling tester. The compound marks every place where "
      "the flanks come closer than its thickness at any moment of the mesh; the orange line is the path of contact, "
      "orange lines are lines of contact.",
      is_modified(a)
          ? "The flanks are modified: the transmission error is what they depart from each other along the path of "
            "contact, and at its ends where one pair takes over from the other."
          : "A pinion with fewer teeth than the shaper touches the exact flank in one point that runs along a straight "
            "line of the housing; a pinion that is the shaper touches along lines. In both cases the transmission "
            "error is a constant, aligned or not, as long as contact stays inside the flank."};
  for (const auto& note : a.notes) page.introduction.push_back(note);
  page.charts = contact_charts(a);
  for (auto& f : contact_patterns(a))
    page.figures.push_back({std::move(f.caption), std::move(f.svg), std::move(f.note)});
  for (const auto& side : a.sides)
    for (auto& figure : ease_off::map_figures(ease_off_of(side), name_of(a, side)))
      page.figures.push_back(std::move(figure));
  page.tables = {contact_table(a)};
  ease_off::add_to_page(page, a.misaligned);
  if (a.loaded) {
    page.introduction.push_back(under_load::loaded_introduction(*a.loaded));
    for (const auto& note : a.loaded->notes) page.introduction.push_back(note);
    for (auto& table : under_load::loaded_tables(*a.loaded)) page.tables.push_back(std::move(table));
    for (auto& chart : under_load::loaded_charts(*a.loaded)) page.charts.push_back(std::move(chart));
  }
  return study_page_html(page);
}

/// The table of misalignments, and what keeps the pattern inside over its box, as far as that is asked for.
process::ValueOrErrors<ease_off::Misaligned> misalign(const job::Job& job, const face_gear::FaceGear& gear,
                                                      const process::ContactAsked& asked, const ContactAnalysis& a,
                                                      app::StageClock& clock) {
  const ContactGrid grid;
  contact::RollOptions roll;
  roll.steps = grid.steps;
  roll.compound_mm = a.settings.compound_mm;
  const std::string modify = asked.modify.empty() ? job.shaping ? "pinion" : "both" : asked.modify;
  const auto pair = searched_pair({&job, &gear, a.pinion_teeth, a.settings, modify, roll, grid.rows, grid.columns});
  return ease_off::misalign(*pair, job, a.settings, asked, modify, clock);
}

/// The flanks as files of measurements tell of them: the fit of their deviations, on the grid of the roll.
process::ValueOrErrors<process::CutFlanks> measured_flanks(const face_gear::FaceGear& gear,
                                                           const job::MeasuredInput& measured) {
  const auto fitted = job::correct_gear(gear, measured);
  if (!fitted) return std::vector{fitted.error()};
  process::CutFlanks out;
  out.route = "measured";
  out.warnings = fitted->fit.warnings;
  for (const auto& f : fitted->fit.flanks)
    out.warnings.push_back(
        fmt::format("zone {}, flank {:+}: {} measured places up to {:.2f} um off, met by the fit "
                    "within {:.2f} um",
                    f.zone, f.side, f.residual.points, f.residual.measured_max_mm * app::kUm,
                    f.residual.residual_max_mm * app::kUm));
  const ContactGrid grid;
  for (int zone = 0; zone < static_cast<int>(gear.rings().size()); ++zone)
    for (const int side : {1, -1}) {
      const auto flank = contact::exact_flank(gear, zone, side, grid.rows, grid.columns);
      if (!flank) return std::vector{flank.error()};
      process::CutFlanks::Flank f{zone, side, flank->rows, flank->columns, flank->points, flank->normals, {}};
      const auto& target = fitted->fit.rings[static_cast<std::size_t>(zone)]->side(side);
      for (std::size_t k = 0; k < flank->points.size(); ++k)
        f.deviation_mm.push_back(-target.at(flank->theta[k], radius(flank->points[k])).value);
      out.flanks.push_back(std::move(f));
    }
  return out;
}

}  // namespace

process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job, const face_gear::FaceGear& gear,
                                                        const process::ContactAsked& asked,
                                                        const process::CutFlanks* cut, app::StageClock& clock) {
  std::optional<process::CutFlanks> measured;
  if (!asked.measured.files.empty()) {
    auto read = clock.run("measured", [&] { return measured_flanks(gear, asked.measured); });
    if (auto* errors = read.refused()) return std::move(*errors);
    measured = std::move(read).value();
    cut = &*measured;
  }
  auto analysed =
      clock.run("contact", [&] { return analyse_contact(job, gear, under_load::contact_settings(job, asked), cut); });
  if (auto* errors = analysed.refused()) return std::move(*errors);
  ContactAnalysis& analysis = analysed.value();
  if (cut != nullptr) {
    if (!cut->verified) analysis.notes.push_back("the program of the cut surface is not verified");
    for (const auto& assumed : cut->assumed) analysis.notes.push_back("assumed: " + assumed);
    if (measured) analysis.notes.insert(analysis.notes.end(), measured->warnings.begin(), measured->warnings.end());
  }
  if (!asked.ccx_dir.empty() && !analysis.loaded)
    return std::vector{fail_at(job.where(""), "--ccx needs a load: --torque or [contact.load]")};
  process::ContactFound found;
  auto misaligned = misalign(job, gear, asked, analysis, clock);
  if (auto* errors = misaligned.refused()) return std::move(*errors);
  analysis.misaligned = std::move(misaligned).value();
  found.missed = analysis.misaligned.missed();
  found.job_text = analysis.misaligned.job_text;
  found.json = contact_json(analysis);
  found.summary = contact_summary(analysis);
  std::vector<ease_off::SideMap> maps;
  for (const auto& side : analysis.sides) maps.push_back(ease_off_of(side));
  found.files = {{"contact.csv", contact_csv(analysis)},
                 {"ease_off.csv", ease_off::map_csv(maps)},
                 {"transmission.csv", transmission_csv(analysis)},
                 {"contact.json", found.json},
                 {"contact.html", contact_page(analysis)}};
  if (analysis.loaded) {
    found.files.emplace_back("loaded.csv", under_load::loaded_csv(*analysis.loaded));
    found.files.emplace_back("pressure.csv", under_load::pressure_csv(*analysis.loaded));
    if (analysis.loaded->settings.root_stress)
      found.files.emplace_back("root_stress.csv", under_load::root_csv(*analysis.loaded));
    if (!asked.ccx_dir.empty()) {
      auto decks = loaded_decks(job, gear, *analysis.loaded);
      if (auto* errors = decks.refused()) return std::move(*errors);
      found.decks = std::move(decks).value();
    }
  }
  return found;
}

std::string contact_section(const job::Job& job, const face_gear::FaceGear& gear,
                            const std::vector<proof::SurfaceGrid>& surface, std::vector<std::string>& warnings) {
  if (!job.contact) return {};
  process::CutFlanks cut;
  cut.route = "milled";
  cut.flanks = process::flanks_of(surface);
  auto analysed = analyse_contact(job, gear, *job.contact, cut.flanks.empty() ? nullptr : &cut);
  if (const auto* errors = analysed.refused()) {
    warnings.push_back("no contact analysis: " + errors->front().message);
    return {};
  }
  auto& analysis = analysed.value();
  if (!analysis.route.empty())
    analysis.notes.emplace_back(
        "The cut surface is taken from the report's grid, which does not resolve every cusp: for its transmission "
        "error run `toothpath contact --as-cut`.");
  return contact_section_body(analysis);
}

}  // namespace toothpath::face
