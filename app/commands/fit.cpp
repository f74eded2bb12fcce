// `toothpath fit JOB --points FILE`: the numbers of a gear that come nearest to measured points.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/base/new_file.h"
#include "app/base/option_number.h"
#include "app/commands/command.h"
#include "app/fit/job_text.h"
#include "app/fit/report.h"
#include "app/job/file.h"
#include "app/job/loose_points.h"
#include "app/job/measured_points.h"
#include "app/process/flow/stages.h"
#include "app/process/opening_and_end.h"
#include "geometry/base/json_text.h"
#include "geometry/base/printable.h"
#include "machines/toml/regular_file.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kFitOutputs = {"fit.json", "fit.csv", "fit.html"};

struct FitRequest : JobRequest {
  std::string points, points_unit, write_file;
  std::vector<std::string> free, bounds;
  bool clocked = false, axial = false;
  std::optional<double> ball_diameter_mm;
};

constexpr toml::Range kBound{-1e5, 1e5};

/// "KEY=a:b".
Result<fit::Bound> bound_of(const std::string& text) {
  const auto equal = text.find('='), colon = text.find(':', equal == std::string::npos ? 0 : equal);
  if (equal == std::string::npos || equal == 0 || colon == std::string::npos)
    return fail_as(DiagnosticKind::usage, "--bounds {}: KEY=a:b is needed, as in --bounds profile_shift=-0.2:0.6",
                   printable(text));
  const auto low = app::read_number("--bounds", std::string_view(text).substr(equal + 1, colon - equal - 1), kBound),
             high = app::read_number("--bounds", std::string_view(text).substr(colon + 1), kBound);
  if (!low) return low.error();
  if (!high) return high.error();
  return fit::Bound{text.substr(0, equal), *low, *high};
}

Result<fit::Asked> asked_of(const FitRequest& request) {
  fit::Asked asked;
  for (const std::string& list : request.free)
    for (std::size_t from = 0; from <= list.size();) {
      const std::size_t comma = std::min(list.find(',', from), list.size());
      asked.free.push_back(list.substr(from, comma - from));
      from = comma + 1;
    }
  for (const std::string& text : request.bounds) {
    auto bound = bound_of(text);
    if (!bound) return bound.error();
    asked.bounds.push_back(std::move(*bound));
  }
  asked.turns = !request.clocked;
  asked.shifts = request.axial;
  asked.ball_radius_mm = 0.5 * request.ball_diameter_mm.value_or(0);
  return asked;
}

/// The fitted job: its text, and why its gear is none that can be cut.
struct FittedJob {
  std::string text;
  std::vector<std::string> refused;
};
process::ValueOrErrors<FittedJob> fitted_job(const FitRequest& request, const job::Job& job, const fit::Fitted& fitted,
                                             app::StageClock& clock) {
  const auto text = toml::read_input_file(request.job_file, job::kMaxJobBytes);
  if (!text) return std::vector{text.error()};
  const std::string& file = request.write_file.empty() ? request.job_file : request.write_file;
  auto changed = fit::job_with_numbers(job, *text, fitted, file);
  if (auto* errors = changed.refused()) return std::move(*errors);
  FittedJob out{std::move(changed).value(), {}};
  const auto read = job::parse_job(out.text, file);
  if (const auto* errors = read.refused()) return *errors;
  const auto made = flow::make_gear(*read, {}, clock);
  if (const auto* errors = made.refused())
    for (const Diagnostic& error : *errors) out.refused.push_back(error.message);
  return out;
}

CommandOutcome run_fit(const FitRequest& request) {
  if (!request.write_file.empty())
    if (auto fresh = app::check_new_file(request.write_file, "--write"); !fresh) return failed(fresh.error());
  const auto unit = app::read_length_unit("--points-unit", request.points_unit);
  if (!unit) return failed(unit.error());
  const auto asked = asked_of(request);
  if (!asked) return failed(asked.error());
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, kFitOutputs, {request.job_file, request.points});
  if (!output) return failed(output.error());
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value();
  const auto points = clock.run("points", [&] { return job::read_loose_points(request.points, *unit); });
  if (!points) return failed(points.error());
  const auto fitted = clock.run("fit", [&] { return fit::fit_gear(job, *points, *asked); });
  if (!fitted) return failed(fitted.error());
  auto made = fitted_job(request, job, *fitted, clock);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  const FittedJob& text = made.value();
  const fit::Told told{job, *points, *fitted, text.refused};
  const page::StudyPage page = fit::fit_page(told);
  CommandOutcome outcome;
  outcome.summary = fit::fit_summary(told, page);
  nlohmann::ordered_json json = fit::fit_json(told);
  json["text"] = text.text;
  if (!text.refused.empty()) {
    outcome.exit_code = app::ExitCode::unverified;
    if (!request.write_file.empty()) outcome.summary += "  no job was written\n";
  } else if (!request.write_file.empty()) {
    if (const Status written = app::write_new_file(request.write_file, text.text); !written)
      return failed(written.error());
    json["file"] = request.write_file;
    outcome.summary += "  job in " + request.write_file + "\n";
  }
  const std::string report = json_text(json, 2) + "\n";
  outcome.report_json = report;
  outcome.summary += "  files in " + request.out_dir + "\n";
  progress.clear();
  return process::finished(
      *output, {{"fit.json", report}, {"fit.csv", fit::points_csv(told)}, {"fit.html", page::study_page_html(page)}},
      std::move(outcome));
}

}  // namespace

void add_fit(Commands& commands) {
  commands.push_back(command_of<FitRequest>(
      "fit", "the numbers of a gear that come nearest to measured points",
      [](OptionSet& set, FitRequest& request) {
        job_options(set, request);
        set.examples(
            {"fit gear.toml --points measured.csv", "fit gear.toml --points measured.csv --write fitted.toml"});
        set.required_text(
            "--points", request.points,
            "measured points of its flanks, any teeth, any order: x y z[ i j k], DMIS, or an inspection grid", "FILE");
        set.word("--points-unit", request.points_unit, "unit of x, y and z for which the file states none", "UNIT",
                 app::kLengthUnits);
        set.number("--ball-diameter", request.ball_diameter_mm,
                   "the points are centres of a ball of this diameter, not places of the surface", job::kBallDiameter);
        set.texts("--free", request.free,
                  "numbers of [gear] that are fitted, with commas between: profile_shift,zone[0].helix_angle "
                  "(default: the usual ones of its type)",
                  "KEYS");
        set.texts("--bounds", request.bounds, "of one of them: profile_shift=-0.2:0.6", "KEY=A:B");
        set.flag("--clocked", request.clocked, "the teeth stand about the axis as in the job: no turn is sought");
        set.flag("--axial", request.axial, "the place along the axis is sought, too");
        set.text("--write", request.write_file, "the job with the fitted numbers, a new file", "JOB.toml");
      },
      run_fit));
}

}  // namespace toothpath::commands
