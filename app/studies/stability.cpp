#include "app/studies/stability.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/process/opening_and_end.h"
#include "app/report/page/study_page.h"
#include "app/studies/stability_rows.h"
#include "geometry/base/json_text.h"

namespace toothpath::studies {
namespace {

const std::vector<std::string> kStabilityOutputs = {"stability.csv", "stability.json", "stability.html"};

std::string size(double value) { return value == 0 ? "" : fmt::format("{:.1e}", value); }

page::PageTable table_of(const std::vector<StabilityRow>& rows) {
  page::PageTable table{
      "Cases",
      {"group", "case", "points", "error_mm", "limit_mm", "condition", "iterations", "swept_mm", "verdict", "reason"},
      {},
      ""};
  for (const auto& row : rows)
    table.rows.push_back({row.group, row.name, row.points ? std::to_string(row.points) : "",
                          row.points ? fmt::format("{:.1e}", row.error_mm) : "", size(row.limit_mm),
                          size(row.condition), row.iterations ? std::to_string(row.iterations) : "", size(row.swept_mm),
                          row.verdict, row.reason});
  return table;
}

std::string json_of(const std::vector<StabilityRow>& rows, bool fine) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = "study stability";
  json["fine"] = fine;
  json["cases"] = nlohmann::ordered_json::array();
  for (const auto& row : rows)  // NaN becomes null
    json["cases"].push_back({{"group", row.group},
                             {"case", row.name},
                             {"points", row.points},
                             {"error_mm", row.error_mm},
                             {"limit_mm", row.limit_mm},
                             {"condition", row.condition},
                             {"iterations", row.iterations},
                             {"swept_mm", row.swept_mm},
                             {"fine", row.fine},
                             {"verdict", row.verdict},
                             {"reason", row.reason}});
  return json_text(json, 2) + "\n";
}

std::string shortened(std::string text) {
  if (text.size() > 100) text = text.substr(0, 97) + "...";
  return text;
}

}  // namespace

void judge(StabilityRow& row, double swept_limit_mm) {
  const bool error_fine = row.points > 0 && row.error_mm <= row.limit_mm;  // false for NaN
  const bool swept_fine = row.swept_mm <= swept_limit_mm || (swept_limit_mm == 0 && row.swept_mm == 0);
  row.fine = error_fine && swept_fine;
  row.verdict = row.fine ? "pass" : "FAIL";
  if (!error_fine && row.reason.empty())
    row.reason = fmt::format("error {:.2e} mm exceeds {:.2e} mm", row.error_mm, row.limit_mm);
  if (!swept_fine)
    row.reason = fmt::format("a point lies {:.2e} mm off the swept solid, limit {:.2e} mm: wrong sheet", row.swept_mm,
                             swept_limit_mm);
}

void judge_refusal(StabilityRow& row, Expected expected, const std::string& message) {
  const bool was_refused = !message.empty();
  // A reason without a number explains nothing.
  const bool explained =
      message.find_first_of("0123456789") != std::string::npos || message.find("nan") != std::string::npos;
  row.fine = expected == Expected::refuse ? was_refused && explained : !was_refused;
  row.verdict = !row.fine ? "FAIL" : was_refused ? "refused" : "pass";
  row.reason = was_refused ? message : expected == Expected::refuse ? "accepted, although it cannot be made" : "";
}

commands::CommandOutcome study_stability(const StabilityRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kStabilityOutputs);
  if (!output) return commands::failed(output.error());
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  std::vector<StabilityRow> rows = clock.run("face gears", face_gear_rows);
  for (auto& row : clock.run("bevel gears", bevel_gear_rows)) rows.push_back(std::move(row));
  for (auto& row : clock.run("kinematics", kinematics_rows)) rows.push_back(std::move(row));
  progress.clear();
  const auto failures = std::count_if(rows.begin(), rows.end(), [](const auto& row) { return !row.fine; });

  const page::PageTable table = table_of(rows);
  page::StudyPage page;
  page.title = "Stability";
  page.subtitle = fmt::format("{} extreme cases, double against 50 digits", rows.size());
  page.good = failures == 0;
  page.verdict = page.good ? "all as they must be" : fmt::format("{} cases fail", failures);
  page.introduction = {
      "error: greatest distance in mm between the double result and the same formulas in 50 digits, over all points of "
      "the case; for flanks of face gears the answer is the point at an exactly given radius and height, found by "
      "iteration. limit: what rounding may do, a small multiple of 2.2e-16 times the size of the part.",
      "condition: by how much the answer's parameters change for a relative change of the question, at the hardest "
      "point (large near an undercut edge or a pole; the position stays exact all the same). iterations: most Newton "
      "steps of one solution, the way from a cold start included; empty where the form is closed.",
      "swept: greatest distance of the points from the solid shaper turned past them, which knows no equation of "
      "meshing: a point on a wrong sheet would show here. refused: the case cannot be made, and the reason says why."};
  page.tables = {table};

  commands::CommandOutcome outcome;
  outcome.report_json = json_of(rows, failures == 0);
  const process::NamedFiles files = {{"stability.csv", page::table_csv(table)},
                                     {"stability.html", page::study_page_html(page)},
                                     {"stability.json", outcome.report_json}};
  page::PageTable screen = table;
  for (auto& row : screen.rows) row.back() = shortened(row.back());
  outcome.summary = page::table_text(screen) + fmt::format("{} cases, {} fail\n", rows.size(), failures);
  if (failures > 0) {
    outcome.exit_code = app::ExitCode::unverified;
    for (const auto& row : rows)
      if (!row.fine)
        outcome.errors.push_back(fail_as(DiagnosticKind::verification, "{}, {}: {}", row.group, row.name, row.reason));
  }
  return process::finished(*output, files, std::move(outcome));
}

void add_stability(commands::Commands& commands) {
  commands.push_back(commands::command_of<StabilityRequest>(
      "stability", "extreme gears and machine poses, double against 50 digits",
      [](commands::OptionSet& set, StabilityRequest& request) {
        set.out_dir(request.out_dir);
        set.examples({"study stability"});
      },
      study_stability, &commands::kStudies));
}

}  // namespace toothpath::studies
