#include "app/studies/strategies.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/job/file.h"
#include "app/process/opening_and_end.h"
#include "app/report/page/study_page.h"
#include "app/report/svg/html_text.h"
#include "app/studies/strategy_trial.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::studies {
namespace {

const std::vector<std::string> kStrategiesOutputs = {"strategies.html", "strategies.json"};
constexpr double kLean = 10.0 * kDegree;  ///< of the tilted ball
/// The leans of the tilted ball in the order in which they are tried; the first that is not refused is taken.
constexpr PrescribedLean kLeans[] = {{kLean, kLean}, {0, kLean}, {kLean, 0}};

/// Runs the strategies of one job, one after the other.
class Study {
 public:
  Study(const job::Job& job, const LineMilledFlanks& flanks, app::OutputDir& scratch, const StrategiesRequest& request)
      : job_(job), flanks_(flanks), scratch_(scratch), request_(request) {}

  /// All trials, or why the job cannot be run whatever the strategy.
  [[nodiscard]] process::ValueOrErrors<std::vector<StrategyTrial>> run() {
    add("line", job_);
    if (!errors_.empty()) return std::move(errors_);
    const int own = strips_of(trials_.front()), most = std::min(request_.strips.value_or(own + 1), path::kMostStrips);
    for (int strips = own + 1; strips <= most; ++strips)
      add(fmt::format("{} strips", strips), with_strips(job_, flanks_, strips));
    add("ball", with_ball(job_, flanks_, nullptr));
    add_tilted();
    if (!errors_.empty()) return std::move(errors_);
    return std::move(trials_);
  }

 private:
  /// Strips of the plan; one where there is none.
  [[nodiscard]] int strips_of(const StrategyTrial& line) const {
    int strips = 1;
    for (const auto& pass : line.report.passes)
      if (pass.side && std::size_t(pass.operation) == flanks_.finisher) strips = std::max(strips, pass.side->strip + 1);
    return job_.operations[flanks_.finisher].strips.value_or(strips);
  }

  [[nodiscard]] std::optional<StrategyTrial> tried(const std::string& name, const Result<job::Job>& job) {
    if (!job) return refused_strategy(name, job.error());
    auto trial = try_strategy(name, *job, flanks_, scratch_, request_.quiet);
    if (auto* errors = trial.refused()) {
      errors_ = std::move(*errors);
      return std::nullopt;
    }
    return std::move(trial).value();
  }

  void add(const std::string& name, const Result<job::Job>& job) {
    if (!errors_.empty()) return;
    if (auto trial = tried(name, job)) trials_.push_back(std::move(*trial));
  }

  /// The first lean whose program comes to its proof. Where none does, the row says why of each.
  void add_tilted() {
    const std::string name = "tilted ball";
    std::string refusals;
    double seconds = 0;
    if (!job_.face_gear()) return add(name, with_ball(job_, flanks_, kLeans));
    for (const PrescribedLean& lean : kLeans) {
      if (!errors_.empty()) return;
      auto trial = tried(name, with_ball(job_, flanks_, &lean));
      if (!trial) return;
      trial->seconds += std::exchange(seconds, 0);
      if (trial->proven) {
        trial->remark = "lean: " + to_string(lean) + (refusals.empty() ? "" : "; refused: " + refusals);
        trials_.push_back(std::move(*trial));
        return;
      }
      refusals += fmt::format("{}{}: {}", refusals.empty() ? "" : "; ", to_string(lean), trial->reason);
      seconds = trial->seconds;
      if (&lean != std::end(kLeans) - 1) continue;
      trial->reason = refusals;
      trials_.push_back(std::move(*trial));
    }
  }

  const job::Job& job_;
  const LineMilledFlanks& flanks_;
  app::OutputDir& scratch_;
  const StrategiesRequest& request_;
  std::vector<StrategyTrial> trials_;
  std::vector<Diagnostic> errors_;
};

std::string hours(double minutes) { return fmt::format("{:.2f}", minutes / 60); }
std::string shown_um(double mm) { return fmt::format("{:.2f}", app::um(mm)); }
constexpr const char* kNone = "-";  ///< where the strategy did not get so far

page::PageTable time_table(const std::vector<StrategyTrial>& trials) {
  page::PageTable table{
      "Time",
      {"strategy", "total h", "flanks h", "finish h", "passes"},
      {},
      "All teeth, rapids among them. flanks: the operations in which the strategies differ; finish: the one that "
      "finishes the flanks; passes: of it, in one tooth space."};
  for (const auto& t : trials)
    table.rows.push_back(t.proven
                             ? std::vector<std::string>{t.name, hours(t.report.total_minutes), hours(t.flank_minutes),
                                                        hours(t.finish_minutes), std::to_string(t.passes)}
                             : std::vector<std::string>{t.name, kNone, kNone, kNone, kNone});
  if (!trials.empty()) table.note += " The times are " + report::times_text(trials.front().report) + ".";
  return table;
}

page::PageTable left_table(const std::vector<StrategyTrial>& trials) {
  page::PageTable table{"Left on the flanks, um",
                        {"strategy", "worst", "rms", "least", "gouge"},
                        {},
                        "Along the normal, at the grid of the proof, of the program as read back, where the ball of "
                        "the last tool reaches; least < 0: material is missing. gouge: proven bound over all surfaces "
                        "and operations."};
  for (const auto& t : trials)
    table.rows.push_back(t.proven
                             ? std::vector<std::string>{t.name, shown_um(t.left.max_mm), shown_um(t.left.rms_mm),
                                                        shown_um(t.left.min_mm),
                                                        t.report.gouge ? shown_um(t.report.gouge->bound_mm) : kNone}
                             : std::vector<std::string>{t.name, kNone, kNone, kNone, kNone});
  return table;
}

page::PageTable load_table(const std::vector<StrategyTrial>& trials) {
  page::PageTable table{
      "Deflection while the flanks are finished",
      {"strategy", "stock um", "force N", "bends um"},
      {},
      "A model of the cut, beside the geometry above and not in it; a flank in strips is computed as if each met the "
      "whole line."};
  for (const auto& t : trials) {
    const report::CuttingLoad* c = t.cutting();
    table.rows.push_back({t.name, c && c->stock_mm ? report::estimate(app::um(*c->stock_mm)) : kNone,
                          c && c->load ? report::estimate(c->load->force_N) : kNone,
                          c && c->load ? report::estimate(app::um(c->load->deflection_mm)) : kNone});
    if (c && !c->load) table.note += fmt::format(" {}: {}.", t.name, c->not_computed);
  }
  if (!trials.empty() && !trials.front().report.force_basis.empty())
    table.note += " " + trials.front().report.force_basis;
  return table;
}

page::PageTable verdict_table(const std::vector<StrategyTrial>& trials) {
  page::PageTable table{"Verdicts",
                        {"strategy", "verified", "tool axis and remarks"},
                        {},
                        "Tool axis: of the operation that finishes the flanks; leans are from the normal of the pitch "
                        "surface, of a fixed one from the gear axis."};
  for (const auto& t : trials) {
    std::string remarks = t.reason;
    for (const std::string& more : {t.tool_axis, t.remark})
      if (!more.empty()) remarks += (remarks.empty() ? "" : "; ") + more;
    table.rows.push_back({t.name, t.reason.empty() ? "yes" : "no", remarks});
  }
  return table;
}

/// One row a strategy, for the screen.
std::string screen_text(const std::vector<StrategyTrial>& trials) {
  const page::PageTable time = time_table(trials), left = left_table(trials), load = load_table(trials);
  page::PageTable all{"", time.columns, {}, ""};
  for (std::size_t k = 1; k < left.columns.size(); ++k) all.columns.push_back(left.columns[k] + " um");
  all.columns.emplace_back("bends um");
  all.columns.emplace_back("verified");
  for (std::size_t k = 0; k < trials.size(); ++k) {
    std::vector<std::string> row = time.rows[k];
    row.insert(row.end(), left.rows[k].begin() + 1, left.rows[k].end());
    row.push_back(load.rows[k].back());
    row.push_back(trials[k].reason.empty() ? "yes" : "no");
    all.rows.push_back(std::move(row));
  }
  std::string text = page::table_text(all);
  for (const auto& t : trials) {
    if (!t.reason.empty()) text += t.name + ": " + t.reason + "\n";
    if (!t.remark.empty()) text += t.name + ": " + t.remark + "\n";
  }
  return text;
}

/// Each strategy is an upright stroke from rms to worst.
template <typename Minutes>
svg::LineChart chart_of(const std::vector<StrategyTrial>& trials, const char* title, const char* x_label,
                        Minutes minutes) {
  svg::LineChart chart;
  chart.title = title;
  chart.x_label = x_label;
  chart.y_label = "left on the flanks [um]";
  chart.log_x = chart.markers = true;
  chart.note =
      "Each strategy has two dots, joined: rms below and worst above. Left is faster, down is more exact. What the "
      "mill "
      "bends is not in it.";
  for (const auto& t : trials) {
    if (!t.proven) continue;
    const double h = minutes(t) / 60;
    chart.series.push_back({t.name + (t.reason.empty() ? "" : ", not verified"),
                            {h, h},
                            {app::um(t.left.rms_mm), app::um(t.left.max_mm)}});
  }
  return chart;
}

page::StudyPage page_of(const job::Job& job, const LineMilledFlanks& flanks, const std::vector<StrategyTrial>& trials) {
  const auto verified = std::count_if(trials.begin(), trials.end(), [](const auto& t) { return t.reason.empty(); });
  const path::MillingOperation& line = job.operations[flanks.finisher];
  page::StudyPage page;
  page.title = "Line against ball";
  page.subtitle =
      fmt::format("{}: the same gear, machine, set-up and tools, its flanks cut in {} ways", job.name, trials.size());
  page.good = std::size_t(verified) == trials.size();
  page.verdict = fmt::format("{} of {} verified", verified, trials.size());
  page.introduction = {
      "Every row is a whole run of the job: planning, gouge check, axis motion, NC text, reading it back, proof and "
      "cut "
      "surface. Roughing, fillets and roots are the same in all of them.",
      fmt::format("line: the job as it stands, the side of the mill along the whole flank with at most {:g} um of "
                  "misfit. strips: the flank in more strips where the line finishes.",
                  app::um(line.most_misfit_mm())),
      fmt::format("ball: the ball end of the same mill, with tool, speed, feed and chord tolerance of the line "
                  "operation that it stands for. It finishes with a scallop of {:g} um, what the line may leave. Line "
                  "operations with an allowance become semi-finishing with that allowance and cusps of {:g} of it, at "
                  "least {:g} um.",
                  app::um(line.most_misfit_mm()), path::kCuspPerAllowance, app::um(path::kLeastCusp_mm)),
      fmt::format(
          "tilted ball: the same with a prescribed tool axis, the first of these leans that is not refused: {}; {}; "
          "{}. Outwards is along the teeth, aside is away from the flank that is cut.",
          to_string(kLeans[0]), to_string(kLeans[1]), to_string(kLeans[2]))};
  page.charts = {chart_of(trials, "What is left against all of the time", "total time [h]",
                          [](const StrategyTrial& t) { return t.report.total_minutes; }),
                 chart_of(trials, "What is left against the time for the flanks", "time for the flanks [h]",
                          [](const StrategyTrial& t) { return t.flank_minutes; })};
  page.tables = {time_table(trials), left_table(trials), load_table(trials), verdict_table(trials)};
  return page;
}

using Json = nlohmann::ordered_json;

/// Numbers that a strategy did not come to are left out.
Json json_of(const StrategyTrial& t) {
  Json row = {{"strategy", t.name}, {"verified", t.reason.empty()}, {"reason", svg::valid_utf8(t.reason)}};
  if (!t.remark.empty()) row["remark"] = svg::valid_utf8(t.remark);
  if (!t.tool_axis.empty()) row["tool_axis"] = t.tool_axis;
  row["seconds"] = t.seconds;
  if (!t.proven) return row;
  row["total_minutes"] = t.report.total_minutes;
  row["cutting_minutes"] = t.report.feed_minutes;
  row["flank_minutes"] = t.flank_minutes;
  row["finishing_minutes"] = t.finish_minutes;
  row["finishing_op"] = t.finisher;
  row["passes"] = t.passes;
  row["cl_points"] = t.report.cl_points;
  row["blocks"] = t.report.blocks;
  row["flank_left_um"] = {{"max", app::um(t.left.max_mm)},
                          {"min", app::um(t.left.min_mm)},
                          {"rms", app::um(t.left.rms_mm)},
                          {"points", t.left.points}};
  if (const auto& f = t.report.finished)
    row["finished_um"] = {{"max", app::um(f->max_mm)}, {"min", app::um(f->min_mm)}, {"rms", app::um(f->rms_mm)}};
  if (const auto& g = t.report.gouge)
    row["gouge_um"] = {{"measured", app::um(g->measured_mm)}, {"bound", app::um(g->bound_mm)}};
  const report::CuttingLoad* c = t.cutting();
  row["force_n"] = c && c->load ? Json(c->load->force_N) : Json(nullptr);
  row["deflection_um"] = c && c->load ? Json(app::um(c->load->deflection_mm)) : Json(nullptr);
  if (c && !c->load) row["force_note"] = c->not_computed;
  return row;
}

std::string trials_json(const job::Job& job, const std::vector<StrategyTrial>& trials) {
  Json json = {{"schema", 1},
               {"command", "study strategies"},
               {"job", svg::valid_utf8(job.name)},
               {"job_file", svg::valid_utf8(job.file)},
               {"strategies", Json::array()}};
  for (const auto& t : trials) json["strategies"].push_back(json_of(t));
  return json_text(json, 2) + "\n";
}

}  // namespace

commands::CommandOutcome study_strategies(const StrategiesRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kStrategiesOutputs, {request.job_file});
  if (!output) return commands::failed(output.error());
  auto read = job::read_job_file(request.job_file);
  if (auto* errors = read.refused()) return commands::failed(std::move(*errors));
  job::Job& job = read.value();
  for (path::MillingOperation& o : job.operations) o.best_way = false;  // every way is tried
  const auto flanks = line_milled_flanks(job);
  if (!flanks) return commands::failed(flanks.error());

  auto made = Study(job, *flanks, *output, request).run();
  if (auto* errors = made.refused()) return commands::failed(std::move(*errors));
  const std::vector<StrategyTrial>& trials = made.value();

  commands::CommandOutcome outcome;
  outcome.report_json = trials_json(job, trials);
  outcome.summary = screen_text(trials) + "files in " + request.out_dir + "\n";
  const process::NamedFiles files = {{"strategies.html", page::study_page_html(page_of(job, *flanks, trials))},
                                     {"strategies.json", outcome.report_json}};
  return process::finished(*output, files, std::move(outcome));
}

void add_strategies(commands::Commands& commands) {
  commands.push_back(commands::command_of<StrategiesRequest>(
      "strategies", "the flanks of a job by the side of its mill and by its ball: hours, what is left, what bends",
      [](commands::OptionSet& set, StrategiesRequest& request) {
        job_options(set, request);
        set.examples({"study strategies gear.toml"});
        set.whole_number("--strips", request.strips,
                         "most strips of a flank that are tried; without: one more than the job's plan has",
                         {1, path::kMostStrips});
      },
      study_strategies, &commands::kStudies));
}

}  // namespace toothpath::studies
