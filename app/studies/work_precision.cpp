#include "app/studies/work_precision.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/process/flow/stages.h"
#include "app/process/opening_and_end.h"
#include "app/process/proof_limits.h"
#include "app/report/page/study_page.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/json_text.h"

namespace toothpath::studies {
namespace {

const std::vector<std::string> kWorkPrecisionOutputs = {"work_precision.csv", "work_precision.json",
                                                        "work_precision.html", "work_precision.svg", "report.html"};

/// Which tolerances a line of the study multiplies.
struct Sweep {
  const char* name;
  bool chord, scallop, proof;
};
constexpr Sweep kSweeps[] = {{"chord", true, false, false},
                             {"scallop", false, true, false},
                             {"verification", false, false, true},
                             {"all", true, true, true}};
constexpr double kFactors[] = {0.1, 0.316227766016838, 3.16227766016838, 10.0};  ///< and 1, the job itself

/// A coarse chord must be measured, not refused: the study lifts the gouge tolerance to this many chord tolerances.
constexpr double kGougePerChord = 4;

struct StudyRun {
  std::string varied;
  double factor = 1;
  double chord_mm = 0, scallop_mm = 0, proof_mm = 0;
  report::RunReport report;

  [[nodiscard]] double seconds() const {
    double sum = 0;
    for (const auto& stage : report.stages) sum += stage.second;
    return sum;
  }
  [[nodiscard]] double stage(const std::string& name) const {
    for (const auto& [stage, s] : report.stages)
      if (stage == name) return s;
    return 0;
  }
  /// Largest size of material left or missing on the finished surface; NaN where the run did not get so far.
  [[nodiscard]] double worst_mm() const {
    return report.finished ? std::max(std::abs(report.finished->max_mm), std::abs(report.finished->min_mm)) : NAN;
  }
  [[nodiscard]] double rms_mm() const { return report.finished ? report.finished->rms_mm : NAN; }
};

/// The tolerances of the job that the finished surface depends on: those of its last operation with a scallop height.
void asked(const job::Job& job, StudyRun& run) {
  for (const auto& operation : job.operations) {
    run.chord_mm = operation.chord_tolerance_mm;
    if (operation.scallop_mm > 0) run.scallop_mm = operation.scallop_mm;
  }
}

job::Job varied_job(job::Job job, const Sweep& sweep, double factor) {
  double coarsest = 0;
  for (auto& operation : job.operations) {
    if (sweep.chord) operation.chord_tolerance_mm *= factor;
    if (sweep.scallop) operation.scallop_mm *= factor;
    coarsest = std::max(coarsest, operation.chord_tolerance_mm);
  }
  job.verify.gouge_tolerance_mm = std::max(job.verify.gouge_tolerance_mm, kGougePerChord * coarsest);
  return job;
}

/// One run, or why the job itself cannot be run.
std::vector<Diagnostic> add_run(const job::Job& job, const Sweep& sweep, const char* name, double factor,
                                app::OutputDir& output, bool quiet, std::vector<StudyRun>& runs) {
  const job::Job varied = varied_job(job, sweep, factor);
  StudyRun run;
  run.varied = name;
  run.factor = factor;
  run.proof_mm = proof::ProofLimits{}.proof_mm * (sweep.proof ? factor : 1);
  asked(varied, run);
  auto outcome = flow::run_stages(varied, process::proof_limits(varied, run.proof_mm), output, quiet);
  run.report = std::move(outcome.report);
  if (!outcome.errors.empty()) {
    if (factor == 1) return outcome.errors;  // not the study's doing
    run.report.reasons = {outcome.errors.front().message};
  }
  // The verdict is that of the job, not of the lifted tolerance.
  const bool within = run.report.gouge && run.report.gouge->bound_mm <= job.verify.gouge_tolerance_mm;
  if (run.report.verified && !within)
    run.report.reasons.push_back(
        fmt::format("the bound of the gouge exceeds the job's tolerance {:.4f} mm", job.verify.gouge_tolerance_mm));
  run.report.verified = run.report.verified && within;
  runs.push_back(std::move(run));
  return {};
}

std::string um_text(double mm) { return std::isfinite(mm) ? fmt::format("{:.4f}", mm * 1000) : ""; }
std::string seconds_text(double s) { return fmt::format("{:.3f}", s); }

page::PageTable table_of(const std::vector<StudyRun>& runs) {
  std::vector<std::string> stages;  // all names, in the order of the first run that has them
  for (const auto& run : runs)
    for (const auto& [name, s] : run.report.stages)
      if (std::find(stages.begin(), stages.end(), name) == stages.end()) stages.push_back(name);
  page::PageTable table{
      "Runs",
      {"varied", "factor", "chord_um", "scallop_um", "verification_um", "cl_points", "blocks", "cutting_minutes",
       "worst_um", "rms_um", "left_bound_um", "gouge_um", "gouge_bound_um", "verified", "seconds"},
      {},
      ""};
  for (const auto& name : stages) {
    std::string column = name + "_s";
    std::replace(column.begin(), column.end(), ' ', '_');
    table.columns.push_back(column);
  }
  table.columns.emplace_back("reason");
  for (const auto& run : runs) {
    const report::RunReport& r = run.report;
    std::vector<std::string> row = {run.varied,
                                    svg::short_number(run.factor),
                                    um_text(run.chord_mm),
                                    um_text(run.scallop_mm),
                                    um_text(run.proof_mm),
                                    std::to_string(r.cl_points),
                                    std::to_string(r.blocks),
                                    fmt::format("{:.3f}", r.feed_minutes),
                                    um_text(run.worst_mm()),
                                    um_text(run.rms_mm()),
                                    um_text(r.finished ? r.finished->bound_mm : NAN),
                                    um_text(r.gouge ? r.gouge->measured_mm : NAN),
                                    um_text(r.gouge ? r.gouge->bound_mm : NAN),
                                    r.verified ? "yes" : "no",
                                    seconds_text(run.seconds())};
    for (const auto& name : stages) row.push_back(seconds_text(run.stage(name)));
    row.push_back(r.reasons.empty() ? "" : r.reasons.front());
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The same for the page: what was asked and found, and the seconds of the stages, which would run off it.
std::vector<page::PageTable> page_tables(const page::PageTable& table) {
  const auto seconds = std::find(table.columns.begin(), table.columns.end(), "seconds") - table.columns.begin();
  page::PageTable found{table.title, {}, {}, table.note}, stages{"Seconds by stage", {}, {}, ""};
  const auto share = [&](const std::vector<std::string>& from, std::vector<std::string>& a,
                         std::vector<std::string>& b) {
    a.assign(from.begin(), from.begin() + seconds + 1);
    a.push_back(from.back());
    b.assign(from.begin(), from.begin() + 2);
    b.insert(b.end(), from.begin() + seconds, from.end() - 1);
  };
  share(table.columns, found.columns, stages.columns);
  for (const auto& row : table.rows) share(row, found.rows.emplace_back(), stages.rows.emplace_back());
  return {std::move(found), std::move(stages)};
}

/// The runs of one sweep with the job's own run among them, by factor.
std::vector<const StudyRun*> line_of(const std::vector<StudyRun>& runs, const std::string& name) {
  std::vector<const StudyRun*> line;
  for (const auto& run : runs)
    if ((run.varied == name || run.varied == "job") && run.report.blocks > 0) line.push_back(&run);
  std::sort(line.begin(), line.end(), [](const auto* a, const auto* b) { return a->factor < b->factor; });
  return line;
}

template <typename X, typename Y>
void add_series(svg::LineChart& chart, const std::vector<StudyRun>& runs, const Sweep& sweep, const std::string& name,
                X x, Y y) {
  svg::ChartSeries series{name, {}, {}};
  for (const StudyRun* run : line_of(runs, sweep.name)) {
    series.x.push_back(x(*run));
    series.y.push_back(y(*run));
  }
  if (series.x.size() > 1) chart.series.push_back(std::move(series));
}

std::vector<svg::LineChart> charts_of(const std::vector<StudyRun>& runs, double gouge_tolerance_mm) {
  const auto chart = [](std::string title, std::string x, std::string y, std::string note) {
    svg::LineChart c;
    c.title = std::move(title), c.x_label = std::move(x), c.y_label = std::move(y), c.note = std::move(note);
    c.log_x = c.log_y = c.markers = true;
    return c;
  };
  svg::LineChart error =
      chart("Error against run time", "run time [s]", "deviation of the finished surface [um]",
            "Each line multiplies one tolerance (or all) by 0.1 to 10; every dot is a whole run. Right is slower, down "
            "is more exact. A line that falls steeply buys accuracy with its time; a flat one only costs. Seconds are "
            "wall time: other work on the computer shows as scatter to the right.");
  svg::LineChart cutting =
      chart("Error against cutting time", "cutting time [min]", "deviation of the finished surface [um]",
            "The same runs with the time on the machine: passes and blocks that the tolerances ask for.");
  svg::LineChart proof =
      chart("Sharpness of the proof against its time", "proof of the program [s]", "bound minus measured gouge [um]",
            "How far the proven bound stands above what was measured, and the seconds of the check.");
  svg::LineChart points = chart("Size of the program", "factor of the tolerance", "CL points of one tooth space",
                                "Where one tolerance decides, the slope is -1/2: sag and cusp grow with the square of "
                                "the step. Where a line gets flat, something else decides.");
  proof.limits.push_back({"gouge tolerance", gouge_tolerance_mm * 1000});
  for (const Sweep& sweep : kSweeps) {
    const auto seconds = [](const StudyRun& r) { return r.seconds(); };
    const std::string name = sweep.name;
    add_series(error, runs, sweep, name + ", worst", seconds, [](const StudyRun& r) { return r.worst_mm() * 1000; });
    add_series(error, runs, sweep, name + ", rms", seconds, [](const StudyRun& r) { return r.rms_mm() * 1000; });
    add_series(
        cutting, runs, sweep, name + ", worst", [](const StudyRun& r) { return r.report.feed_minutes; },
        [](const StudyRun& r) { return r.worst_mm() * 1000; });
    add_series(
        proof, runs, sweep, name, [](const StudyRun& r) { return r.stage("proof of the program"); },
        [](const StudyRun& r) {
          return r.report.gouge ? (r.report.gouge->bound_mm - r.report.gouge->measured_mm) * 1000 : NAN;
        });
    add_series(
        points, runs, sweep, name, [](const StudyRun& r) { return r.factor; },
        [](const StudyRun& r) { return static_cast<double>(r.report.cl_points); });
  }
  return {error, cutting, proof, points};
}

std::string json_of(const job::Job& job, const page::PageTable& table) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = "study work-precision";
  json["job"] = svg::valid_utf8(job.name);
  json["job_file"] = svg::valid_utf8(job.file);
  json["gouge_tolerance_um"] = job.verify.gouge_tolerance_mm * 1000;
  json["runs"] = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json run;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string& name = table.columns[k];
      if (name == "varied" || name == "reason") run[name] = svg::valid_utf8(row[k]);
      else if (name == "verified") run[name] = row[k] == "yes";
      else if (row[k].empty()) run[name] = nullptr;
      else run[name] = nlohmann::ordered_json::parse(row[k]);
    }
    json["runs"].push_back(std::move(run));
  }
  return json_text(json, 2) + "\n";
}

/// The report page of the job as it stands, its own gouge tolerance and all, the plots of the study among its sections.
Result<std::string> report_page_text(const job::Job& job, app::OutputDir& output, bool quiet,
                                     const std::vector<svg::LineChart>& charts) {
  auto own = flow::run_stages(job, process::proof_limits(job), output, quiet, {}, true);
  if (!own.errors.empty()) return own.errors.front();
  assert(own.page);
  own.page->work_precision = charts;
  own.page->warnings.emplace_back(
      "this page belongs to a study: its program was measured and not kept; `toothpath run` writes it");
  return render_report_page(*own.page);
}

/// The columns that a screen has room for.
std::string screen_table(const page::PageTable& table) {
  page::PageTable narrow = table;
  const std::vector<std::size_t> keep = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14};
  const auto take = [&](const std::vector<std::string>& cells) {
    std::vector<std::string> kept;
    for (const auto k : keep) kept.push_back(cells[k]);
    return kept;
  };
  narrow.columns = take(table.columns);
  for (auto& row : narrow.rows) row = take(row);
  return table_text(narrow);
}

}  // namespace

commands::CommandOutcome study_work_precision(const WorkPrecisionRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kWorkPrecisionOutputs, {request.job_file});
  if (!output) return commands::failed(output.error());
  auto read = job::read_job_file(request.job_file);
  if (auto* errors = read.refused()) return commands::failed(std::move(*errors));
  const job::Job& job = read.value();
  if (!job.face_gear())
    return commands::failed(process::needs_face_gear(job));  // its tolerances are those of ball mills

  std::vector<StudyRun> runs;
  if (auto refused = add_run(job, {"job", false, false, false}, "job", 1, *output, request.quiet, runs);
      !refused.empty())
    return commands::failed(std::move(refused));
  for (const Sweep& sweep : kSweeps)
    for (const double factor : kFactors) {
      const bool inner = factor > 0.2 && factor < 5, diagonal = sweep.chord && sweep.proof;
      if (request.quick && (inner || diagonal)) continue;
      if (auto failure = add_run(job, sweep, sweep.name, factor, *output, request.quiet, runs); !failure.empty())
        return commands::failed(std::move(failure));
    }

  const page::PageTable table = table_of(runs);
  page::StudyPage page;
  page.title = "Error against run time";
  page.subtitle = fmt::format("{}: chord {} um, scallop {} um, verification {} um at factor 1", job.name,
                              um_text(runs[0].chord_mm), um_text(runs[0].scallop_mm), um_text(runs[0].proof_mm));
  page.good = runs[0].report.verified;
  page.verdict = page.good ? "job verified" : "job not verified";
  page.introduction = {
      "Every row is one whole run of the job: planning, gouge check, axis motion, NC text, reading it back, proof and "
      "cut surface. The first row is the job as it stands; in the others one tolerance, or all of them together, is "
      "multiplied by a factor between 0.1 and 10.",
      "worst and rms: deviation of the finished surface from the exact one, measured on the program as read back, over "
      "all points that the finishing ball can reach. gouge and its bound: the deepest cut below the finished surface "
      "over all operations, measured and proven.",
      fmt::format(
          "So that coarse settings are measured and not refused, the gouge tolerance of a run is lifted to {:g} chord "
          "tolerances where that is more; \"verified\" is the verdict with the job's own tolerance of {:.4f} mm.",
          kGougePerChord, job.verify.gouge_tolerance_mm)};
  page.charts = charts_of(runs, job.verify.gouge_tolerance_mm);
  page.tables = page_tables(table);

  commands::CommandOutcome outcome;
  outcome.report_json = json_of(job, table);
  auto report = report_page_text(job, *output, request.quiet, page.charts);
  if (!report) return commands::failed(report.error());
  const process::NamedFiles files = {{"report.html", std::move(*report)},
                                     {"work_precision.csv", page::table_csv(table)},
                                     {"work_precision.svg", page::standalone_svg(page.charts.front())},
                                     {"work_precision.html", page::study_page_html(page)},
                                     {"work_precision.json", outcome.report_json}};
  outcome.summary = screen_table(table);
  return process::finished(*output, files, std::move(outcome));
}

void add_work_precision(commands::Commands& commands) {
  commands.push_back(commands::command_of<WorkPrecisionRequest>(
      "work-precision", "vary the tolerances of a job: what they cost and what they buy",
      [](commands::OptionSet& set, WorkPrecisionRequest& request) {
        job_options(set, request);
        set.examples({"study work-precision gear.toml --quick"});
        set.flag("--quick", request.quick, "three factors a tolerance instead of five, and none for all together");
      },
      study_work_precision, &commands::kStudies));
}

}  // namespace toothpath::studies
