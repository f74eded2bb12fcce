#include "app/process/face/contact.h"

#include "app/process/face/contact_figures.h"
#include "app/process/under_load/loaded_page.h"
#include "app/process/under_load/settings.h"
#include "app/report/page/study_page.h"
#include "geometry/base/angle.h"

namespace toothpath::face {
namespace {

std::string contact_page(const ContactAnalysis& a) {
  page::StudyPage page;
  page.title = a.job_name + ": contact";
  page.subtitle = fmt::format("pinion of {} teeth, gear of {} teeth, compound {:g} um", a.pinion_teeth, a.gear_teeth,
                              a.settings.compound_mm * 1000);
  const contact::Misalignment& moved = a.settings.moved;
  if (!moved.none()) page.subtitle += "; " + words_of(moved);
  bool edge = false;
  for (const auto& side : a.sides) edge |= side.kind.find("edge") != std::string::npos;
  page.good = !edge;
  page.verdict = edge ? "edge contact" : "contact inside the flanks";
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
  if (a.misalignments) {
    page.tables.push_back(ease_off::table_page(*a.misalignments, "Misaligned"));
    if (a.misalignments->rows.size() > 1) page.charts.push_back(ease_off::centre_chart(*a.misalignments));
  }
  if (a.optimised) {
    page.introduction.push_back("Optimised: " + a.optimised->finding + ".");
    page.tables.push_back(ease_off::table_page(a.optimised->table, "Misaligned, with what was found"));
  }
  if (a.loaded) {
    page.introduction.push_back(under_load::loaded_introduction(*a.loaded));
    for (const auto& note : a.loaded->notes) page.introduction.push_back(note);
    page.tables.push_back(under_load::loaded_table(*a.loaded));
    for (auto& chart : under_load::loaded_charts(*a.loaded)) page.charts.push_back(std::move(chart));
  }
  return study_page_html(page);
}

/// The table of misalignments, and what keeps the pattern inside over its box, as far as that is asked for.
process::ValueOrErrors<Ok> misalign(const job::Job& job, const face_gear::FaceGear& gear,
                                    const process::ContactAsked& asked, ContactAnalysis& a, app::StageClock& clock) {
  if (!a.settings.box) {
    if (!asked.optimise) return Ok{};
    return std::vector{fail_at(job.where("contact"),
                               "--optimise needs a box of misalignments: [contact.misalignment] "
                               "with offset, angle, pinion_axial or gear_axial")};
  }
  const ContactGrid grid;
  contact::RollOptions roll;
  roll.steps = grid.steps;
  roll.compound_mm = a.settings.compound_mm;
  ease_off::PairSides pair;
  for (const std::size_t s : {0u, 1u}) {
    pair[s] = {&gear, {}, a.pinion_teeth, a.settings.modifications};
    for (const auto& member : a.sides[s].members) pair[s].flanks.push_back(member.flank);
  }
  const job::MisalignmentBox& box = *a.settings.box;
  auto rows = clock.run("misalignments", [&] {
    return ease_off::roll_rows(pair, ease_off::single_misalignments(a.settings.moved, box.most), roll, box.margin);
  });
  if (!rows) return std::vector{process::located(job, "contact.misalignment", rows.error())};
  a.misalignments = {box.most, box.margin, roll.compound_mm, a.pitch_radius_mm, std::move(*rows)};
  if (!asked.optimise) return Ok{};
  const std::string modify = asked.modify.empty() ? job.shaping ? "pinion" : "both" : asked.modify;
  auto found = clock.run("optimise", [&] {
    return ease_off::optimise(
        {&job, a.pinion_teeth, a.settings, modify, roll, grid.rows, grid.columns, a.pitch_radius_mm});
  });
  if (auto* errors = found.refused()) return std::move(*errors);
  a.optimised = std::move(found).value();
  return Ok{};
}

}  // namespace

process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job, const face_gear::FaceGear& gear,
                                                        const process::ContactAsked& asked,
                                                        const process::CutFlanks* cut, app::StageClock& clock) {
  auto analysed =
      clock.run("contact", [&] { return analyse_contact(job, gear, under_load::contact_settings(job, asked), cut); });
  if (auto* errors = analysed.refused()) return std::move(*errors);
  ContactAnalysis& analysis = analysed.value();
  if (cut != nullptr) {
    if (!cut->verified) analysis.notes.push_back("the program of the cut surface is not verified");
    for (const auto& assumed : cut->assumed) analysis.notes.push_back("assumed: " + assumed);
  }
  if (!asked.ccx_dir.empty() && !analysis.loaded)
    return std::vector{fail_at(job.where(""), "--ccx needs a load: --torque or [contact.load]")};
  process::ContactFound found;
  if (auto refused = misalign(job, gear, asked, analysis, clock); auto* errors = refused.refused())
    return std::move(*errors);
  found.missed = analysis.optimised && !analysis.optimised->found;
  if (analysis.optimised && !found.missed && !asked.write_file.empty()) {
    auto text = ease_off::job_with_keys(job, *analysis.optimised, asked.write_file);
    if (!text) return std::vector{text.error()};
    found.job_text = std::move(*text);
  }
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
