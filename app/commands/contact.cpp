#include "app/commands/contact.h"

#include "app/commands/bevel_contact.h"
#include "app/process/bevel_run.h"
#include "app/process/opening_and_end.h"
#include "app/process/contact_analysis.h"
#include "app/report/page/contact_figures.h"
#include "app/report/page/study_page.h"
#include "geometry/base/angle.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kContactOutputs = {"contact.csv", "transmission.csv", "contact.json", "contact.html"};

/// Rows that resolve the cusps of a finishing operation: several to a pass.
constexpr int kCutRows = 241, kCutColumns = 33;

std::optional<Diagnostic> out_of_range(const ContactRequest& r) {
  const auto check = [](const char* name, const std::optional<double>& value, double low, double high, const char* unit) -> std::optional<Diagnostic> {
    if (!value || (*value >= low && *value <= high)) return std::nullopt;
    return fail_as(DiagnosticKind::usage, "{} = {:g} is not from {:g} to {:g} {}", name, *value, low, high, unit);
  };
  if (auto e = check("--offset-error", r.offset_error_mm, -5, 5, "mm")) return e;
  if (auto e = check("--axial-error", r.axial_error_mm, -5, 5, "mm")) return e;
  if (auto e = check("--wheel-axial-error", r.wheel_axial_error_mm, -5, 5, "mm")) return e;
  if (auto e = check("--angle-error", r.angle_error_deg, -1, 1, "deg")) return e;
  if (auto e = check("--compound", r.compound_um, 0.1, 100, "um")) return e;
  return std::nullopt;
}

std::string page_of(const process::ContactAnalysis& a) {
  page::StudyPage page;
  page.title = a.job_name + ": contact";
  page.subtitle = fmt::format("pinion of {} teeth, gear of {} teeth, compound {:g} um", a.pinion_teeth, a.gear_teeth, a.settings.compound_mm * 1000);
  const contact::Misalignment& moved = a.settings.moved;
  if (moved.offset_mm != 0 || moved.axial_mm != 0 || moved.angle_rad != 0)
    page.subtitle += fmt::format("; offset {:+g} mm, shaft angle {:+g} deg, axial {:+g} mm", moved.offset_mm, degrees(moved.angle_rad), moved.axial_mm);
  bool edge = false;
  for (const auto& side : a.sides) edge |= side.kind.find("edge") != std::string::npos;
  page.good = !edge;
  page.verdict = edge ? "edge contact" : "contact inside the flanks";
  page.introduction = {
      "Both members turn as rigid bodies without load, as on a rolling tester. The compound marks every place where the flanks come closer than its "
      "thickness at any moment of the mesh; the orange line is the path of contact.",
      "A pinion with fewer teeth than the shaper touches the exact flank in one point that runs along a straight line of the housing; a pinion that is the "
      "shaper touches along lines. In both cases the transmission error is a constant, aligned or not, as long as contact stays inside the flank."};
  for (const auto& note : a.notes) page.introduction.push_back(note);
  page.charts = page::contact_charts(a);
  for (auto& f : page::contact_patterns(a)) page.figures.push_back({std::move(f.caption), std::move(f.svg), std::move(f.note)});
  page.tables = {page::contact_table(a)};
  return study_page_html(page);
}

}  // namespace

job::ContactSettings contact_settings(const job::Job& job, const ContactRequest& request) {
  job::ContactSettings s = job.contact.value_or(job::ContactSettings{});
  if (request.pinion_teeth) s.pinion_teeth = *request.pinion_teeth;
  if (request.offset_error_mm) s.moved.offset_mm = *request.offset_error_mm;
  if (request.axial_error_mm) s.moved.axial_mm = *request.axial_error_mm;
  if (request.angle_error_deg) s.moved.angle_rad = radians(*request.angle_error_deg);
  if (request.compound_um) s.compound_mm = *request.compound_um / 1000;
  return s;
}

CommandOutcome run_contact(const ContactRequest& request) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, kContactOutputs, {request.job_file, request.other_job});
  if (!output) return failed(output.error());
  if (auto error = out_of_range(request)) return failed(std::move(*error));
  if (const auto bevel = process::bevel_job(request.job_file)) return run_bevel_contact(request, *bevel, *output);
  auto read = process::read_face_gear_job(request.job_file, clock);
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const auto& [job, gear] = read.value();
  std::optional<process::CutFlanks> cut;
  if (request.as_cut) {
    auto flanks = process::cut_flanks(job, gear, kCutRows, kCutColumns, *output, request.quiet);
    if (auto* errors = flanks.refused()) return failed(std::move(*errors));
    cut = std::move(flanks).value();
  }
  auto analysed = clock.run("contact", [&] { return process::analyse_contact(job, gear, contact_settings(job, request), cut ? &*cut : nullptr); });
  if (auto* errors = analysed.refused()) return failed(std::move(*errors));
  process::ContactAnalysis& analysis = analysed.value();
  if (cut) {
    if (!cut->verified) analysis.notes.push_back("the program of the cut surface is not verified");
    for (const auto& assumed : cut->assumed) analysis.notes.push_back("assumed: " + assumed);
  }

  CommandOutcome outcome;
  outcome.report_json = process::contact_json(analysis);
  outcome.summary = process::contact_summary(analysis) + "  files in " + request.out_dir + "\n";
  const process::NamedFiles files = {{"contact.csv", process::contact_csv(analysis)},
                            {"transmission.csv", process::transmission_csv(analysis)},
                            {"contact.json", outcome.report_json},
                            {"contact.html", page_of(analysis)}};
  progress.clear();
  return process::finished(*output, files, std::move(outcome));
}

void add_contact(Commands& commands) {
  commands.push_back(command_of<ContactRequest>(
      "contact", "gear and pinion rolled: contact pattern, transmission error, pairs",
      [](OptionSet& set, ContactRequest& request) {
        job_options(set, request);
        set.number("--pinion-teeth", request.pinion_teeth, "teeth of the pinion (default: mate_teeth, else the shaper's)");
        set.number("--offset-error", request.offset_error_mm, "pinion axis off its place across the tooth, mm");
        set.number("--angle-error", request.angle_error_deg, "error of the shaft angle, deg");
        set.number("--axial-error", request.axial_error_mm, "pinion off its place along its axis, mm");
        set.number("--compound", request.compound_um, "thickness of the marking compound, um (default 6)");
        set.text("--mate", request.other_job, "bevel gears: job of the mate (default: by the rules of the pair, same mill)", "JOB");
        set.number("--wheel-axial-error", request.wheel_axial_error_mm, "bevel gears: wheel off its place along its axis, mm");
        set.flag("--as-cut", request.as_cut, "roll the surface that the job cuts, too");
      },
      run_contact));
}

}  // namespace toothpath::commands
