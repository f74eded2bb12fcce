#include "app/process/face/contact.h"

#include "app/process/face/contact_figures.h"
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
  if (moved.offset_mm != 0 || moved.axial_mm != 0 || moved.angle_rad != 0)
    page.subtitle += fmt::format("; offset {:+g} mm, shaft angle {:+g} deg, axial {:+g} mm", moved.offset_mm,
                                 degrees(moved.angle_rad), moved.axial_mm);
  bool edge = false;
  for (const auto& side : a.sides) edge |= side.kind.find("edge") != std::string::npos;
  page.good = !edge;
  page.verdict = edge ? "edge contact" : "contact inside the flanks";
  page.introduction = {
      "Both members turn as rigid bodies without load, as on a rolling tester. The compound marks every place where "
      "the flanks come closer than its thickness at any moment of the mesh; the orange line is the path of contact, "
      "orange lines are lines of contact.",
      "A pinion with fewer teeth than the shaper touches the exact flank in one point that runs along a straight line "
      "of the housing; a pinion that is the shaper touches along lines. In both cases the transmission error is a "
      "constant, aligned or not, as long as contact stays inside the flank."};
  for (const auto& note : a.notes) page.introduction.push_back(note);
  page.charts = contact_charts(a);
  for (auto& f : contact_patterns(a))
    page.figures.push_back({std::move(f.caption), std::move(f.svg), std::move(f.note)});
  page.tables = {contact_table(a)};
  if (a.loaded) {
    page.introduction.push_back(
        fmt::format("Under load both members are elastic: {:g} N m on the gear, the pinion {} along its axis. All "
                    "teeth and rings share "
                    "it; the first touch of the unloaded flanks is the zero of approach and transmission error.",
                    a.loaded->torque_gear_Nm, a.loaded->floating ? "floats" : "is held"));
    for (const auto& note : a.loaded->notes) page.introduction.push_back(note);
    page.tables.push_back(loaded_table(*a.loaded));
    for (auto& chart : loaded_charts(*a.loaded)) page.charts.push_back(std::move(chart));
  }
  return study_page_html(page);
}

}  // namespace

job::ContactSettings contact_settings(const job::Job& job, const process::ContactAsked& asked) {
  job::ContactSettings s = job.contact.value_or(job::ContactSettings{});
  if (asked.pinion_teeth) s.pinion_teeth = *asked.pinion_teeth;
  if (asked.offset_error_mm) s.moved.offset_mm = *asked.offset_error_mm;
  if (asked.axial_error_mm) s.moved.axial_mm = *asked.axial_error_mm;
  if (asked.angle_error_deg) s.moved.angle_rad = radians(*asked.angle_error_deg);
  if (asked.compound_um) s.compound_mm = *asked.compound_um / 1000;
  if (asked.torque_Nm) {
    if (!s.load) s.load.emplace();
    s.load->torque_Nm = *asked.torque_Nm;
    s.load->on_pinion = asked.torque_on_pinion;
  }
  if (s.load && asked.pinion_held) s.load->pinion_axial = job::PinionHold::held;
  if (s.load && asked.positions) s.load->positions = *asked.positions;
  return s;
}

process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job, const face_gear::FaceGear& gear,
                                                        const process::ContactAsked& asked,
                                                        const process::CutFlanks* cut, app::StageClock& clock) {
  auto analysed = clock.run("contact", [&] { return analyse_contact(job, gear, contact_settings(job, asked), cut); });
  if (auto* errors = analysed.refused()) return std::move(*errors);
  ContactAnalysis& analysis = analysed.value();
  if (cut != nullptr) {
    if (!cut->verified) analysis.notes.push_back("the program of the cut surface is not verified");
    for (const auto& assumed : cut->assumed) analysis.notes.push_back("assumed: " + assumed);
  }
  if (!asked.ccx_dir.empty() && !analysis.loaded)
    return std::vector{fail_at(job.where(""), "--ccx needs a load: --torque or [contact.load]")};
  process::ContactFound found;
  found.json = contact_json(analysis);
  found.summary = contact_summary(analysis);
  found.files = {{"contact.csv", contact_csv(analysis)},
                 {"transmission.csv", transmission_csv(analysis)},
                 {"contact.json", found.json},
                 {"contact.html", contact_page(analysis)}};
  if (analysis.loaded) {
    found.files.emplace_back("loaded.csv", loaded_csv(*analysis.loaded));
    found.files.emplace_back("pressure.csv", pressure_csv(*analysis.loaded));
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
