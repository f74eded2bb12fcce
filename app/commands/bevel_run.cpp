#include "app/commands/bevel_run.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/commands/bevel_files.h"
#include "app/job_file.h"
#include "app/report/cl_csv.h"
#include "app/report/page_of_run.h"
#include "app/report/setup_sheet.h"
#include "app/sha256.h"
#include "cam/finger_check.h"
#include "cam/finger_milling.h"
#include "geometry/base/angle.h"
#include "postproc/nc_reader.h"
#include "postproc/nc_writer.h"

namespace toothpath {
namespace {

constexpr double kMotionTolerance = 5e-5;  // mm and rad: proven distance of a read-back motion from its straight line
constexpr double kWallAllowance = 1.5e-3;  // mm above the chord tolerance that a finished wall may stand proud

struct BevelRun {
  const CommandRequest& request;
  const Job& job;
  Progress progress;
  StageClock clock{progress};
  std::optional<BevelGear> gear;
  Machine machine;
  Tolerances tolerances;
  std::vector<FingerPlan> plans;
  std::vector<CheckedClPath> checked;
  RunReport report;
  FingerCheckResult result;
  std::string program_text;

  BevelRun(const CommandRequest& r, const Job& j) : request(r), job(j), progress(r.quiet) {
    tolerances.gouge_mm = j.verify.gouge_tolerance_mm;
    if (j.verify.clearance_mm) tolerances.clearance_mm = *j.verify.clearance_mm;
  }
  [[nodiscard]] std::vector<const ClPath*> paths() const {
    std::vector<const ClPath*> out;
    for (const auto& plan : plans) out.push_back(&plan.path);
    return out;
  }
};

std::vector<Diagnostic> read_inputs(BevelRun& run) {
  if (run.job.operations.empty()) return {fail_at(run.job.where("operation"), "the job lacks an [[operation]]: there is nothing to run")};
  std::vector<Diagnostic> errors;
  auto gear = run.clock.run("gear", [&] { return make_bevel_gear(run.job); });
  if (auto* refused = std::get_if<1>(&gear)) errors = std::move(*refused);
  else run.gear = std::move(std::get<0>(gear));
  auto machine = run.clock.run("machine", [&] { return load_machine(run.job); });
  if (auto* refused = std::get_if<1>(&machine)) errors.insert(errors.end(), refused->begin(), refused->end());
  else run.machine = std::move(std::get<0>(machine));
  if (!errors.empty()) return errors;
  if (const auto fits = check_part_on_machine(run.job, run.machine, 2 * bevel_clearance_body(*run.gear).radius_mm); !fits) return {fits.error()};
  return {};
}

void begin_report(BevelRun& run) {
  RunReport& r = run.report;
  r.command = "run";
  r.job_name = run.job.name;
  r.job_file = run.job.file;
  r.machine_name = run.machine.name;
  r.machine_file = run.job.machine.file;
  r.dialect = run.machine.dialect;
  r.gouge_tolerance_mm = run.job.verify.gouge_tolerance_mm;
  if (run.machine.assumed)
    for (const auto& key : run.machine.assumed_keys) r.assumed.push_back(fmt::format("{}: {}", run.job.machine.file, key));
  r.warnings = run.job.warnings;
  r.warnings.insert(r.warnings.end(), run.gear->warnings().begin(), run.gear->warnings().end());
}

/// The axis stands at one angle to the gear axis all the way; only its azimuth follows the blank.
void note_directions(BevelRun& run) {
  const BevelGear& g = *run.gear;
  for (const auto& plan : run.plans)
    for (std::size_t zone = 0; zone < g.halves().size(); ++zone) {
      DirectionChoice d;
      d.operation = plan.path.operation;
      d.zone = static_cast<int>(zone);
      d.axis = g.axis(0);
      d.lean_rad = kPi / 2 - g.delta();
      d.clearance_mm = run.result.gouge.clearance_mm;
      d.explanation = fmt::format("normal to the pitch cone: {:.4f} deg to the gear axis throughout; two axes move together, the cutter along "
                                  "the generatrix and the blank about its axis", degrees(d.lean_rad));
      run.report.directions.push_back(std::move(d));
    }
}

std::optional<Diagnostic> plan_and_check(BevelRun& run, const FingerGougeCheck& check) {
  for (std::size_t i = 0; i < run.job.operations.size(); ++i) {
    const auto& operation = run.job.operations[i];
    const auto& tool = run.job.tools[static_cast<std::size_t>(operation.tool)];
    auto plan = run.clock.run("plan", [&] { return plan_finger_operation(*run.gear, tool, operation, static_cast<int>(i), run.tolerances); });
    if (!plan) return located(run.job, fmt::format("operation[{}]", i), plan.error());
    run.report.cl_points += plan->path.records.size();
    run.plans.push_back(std::move(plan.value()));
  }
  for (const auto& plan : run.plans) {
    auto passed = run.clock.run("gouge check", [&] { return check.approve(plan.path); });
    if (!passed) return located(run.job, fmt::format("operation[{}]", plan.path.operation), passed.error());
    run.checked.push_back(std::move(passed.value()));
  }
  return std::nullopt;
}

void report_axis_program(BevelRun& run, const AxisProgram& program) {
  RunReport& report = run.report;
  report.axes = program.ranges;
  report.feed_minutes = program.feed_minutes;
  report.total_minutes = program.minutes;
  for (const auto& name : program.assumed)
    if (std::find(report.assumed.begin(), report.assumed.end(), name) == report.assumed.end()) report.assumed.push_back(name);
  for (const AxisOperation& o : program.operations) {
    const auto& asked = run.job.operations[static_cast<std::size_t>(o.operation)];
    OperationReport operation{o.operation, o.type, o.tool_number, asked.speed_rpm, asked.feed_mm_min, 0, o.feed_minutes, o.rapid_minutes};
    for (const auto& plan : run.plans)
      if (plan.path.operation == o.operation) operation.cl_points += plan.path.records.size();
    report.operations.push_back(operation);
  }
}

/// Chord tolerance of the walls: of the last finishing operation.
std::optional<double> finishing_chord(const Job& job) {
  std::optional<double> chord;
  for (const auto& operation : job.operations)
    if (operation.type == OperationType::finger_finishing) chord = operation.chord_tolerance_mm;
  return chord;
}

void judge(const Job& job, const FingerCheckResult& v, const Tolerances& tolerances, std::vector<std::string>& reasons) {
  const WorstPlace& place = v.gouge.deepest;
  if (v.gouge.bound_mm > tolerances.gouge_mm)
    reasons.push_back(fmt::format("gouge: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um; {} against {}, operation {}, line {}, r {:.3f} mm, z {:.3f} mm",
                                  v.gouge.measured_mm * 1000, v.gouge.bound_mm * 1000, tolerances.gouge_mm * 1000, place.body, place.patch,
                                  place.operation, place.line, place.radius_mm, place.height_mm));
  if (v.gouge.clearance_mm < v.gouge.required_clearance_mm)
    reasons.push_back(fmt::format("clearance of shank and holder: {:.4f} mm is below {:.4f} mm", v.gouge.clearance_mm, v.gouge.required_clearance_mm));
  if (!v.gouge.rapids_clear) reasons.push_back("a rapid passes through the blank");
  if (v.ridge.requested_mm > 0 && v.ridge.reached_mm > v.ridge.requested_mm)
    reasons.push_back(fmt::format("ridge: {:.4f} mm is left on the root at cone distance {:.3f} mm, asked {:.4f} mm", v.ridge.reached_mm,
                                  v.ridge.cone_distance_mm, v.ridge.requested_mm));
  if (const auto chord = finishing_chord(job); chord && v.finished.bound_mm > *chord + kWallAllowance)
    reasons.push_back(fmt::format("material left on the walls: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um", v.finished.max_mm * 1000,
                                  v.finished.bound_mm * 1000, (*chord + kWallAllowance) * 1000));
}

/// Reads the bytes back and proves them against the gear.
Result<FingerCheckResult> prove(BevelRun& run, const FingerGougeCheck& check, const AxisProgram& program, const std::string& file,
                                std::optional<ClComparison>& comparison) {
  const Job& job = run.job;
  const int teeth = run.gear->parameters().teeth;
  const auto control = control_of(run.machine, *job.setup, job.tools);
  if (!control) return control.error();
  auto read = run.clock.run("read back", [&] {
    return read_back(run.program_text, file, *control, run.machine, *job.setup, {.teeth = teeth, .keep_all = job.verify.all_teeth});
  });
  if (!read) return read.error();
  std::vector<ToolMotion> motions;
  for (const OperationTrace& trace : read->operations) {
    auto part = run.clock.run("read back", [&] {
      return tool_motions(trace, read->copies, *control, run.machine, *job.setup, teeth, kMotionTolerance, kMotionTolerance);
    });
    if (!part) return part.error();
    motions.insert(motions.end(), part->begin(), part->end());
  }
  if (!read->copies.copies && !job.verify.all_teeth)
    run.report.reasons.push_back(fmt::format("line {}: the teeth are not turned copies of the first: {}", read->copies.line, read->copies.difference));
  auto verified = run.clock.run("proof of the program", [&] { return check.verify(motions); });
  const double path_mm = program.chord_bound_mm + program.rounding_bound_mm + 2 * kMotionTolerance;
  const double path_rad = program.axis_bound_rad + 2 * kMotionTolerance;
  const auto paths = run.paths();
  comparison = run.clock.run("compare with the path", [&] { return compare_with_cl(motions, paths, path_mm, path_rad); });
  if (!comparison->complete)
    run.report.reasons.push_back(fmt::format("operation {}, record {} is not met by the program: {}", comparison->missed_operation,
                                             comparison->missed_record, comparison->message));
  if (comparison->worst_extra_mm > path_mm)
    run.report.reasons.push_back(fmt::format("the program leaves the path by {:.4f} mm, limit {:.4f} mm, near line {}", comparison->worst_extra_mm,
                                             path_mm, comparison->line));
  return verified;
}

std::vector<LedgerEntry> ledger_of(const BevelRun& run, const AxisProgram& program, const std::optional<ClComparison>& comparison) {
  double chord = 0, ridge = 0;
  for (const auto& plan : run.plans) {
    chord = std::max(chord, plan.chord_mm);
    ridge = std::max(ridge, plan.ridge_predicted_mm);
  }
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto& v = run.result;
  return {{"flank solve", Tolerances{}.flank_mm * 1000, nothing},
          {"chord", chord * 1000, nothing},
          {"ridge", ridge * 1000, v.ridge.reached_mm * 1000},
          {"orientation", 0, v.tilt_rad * 1000 * (run.gear->parameters().addendum_mm + run.gear->parameters().dedendum_mm)},
          {"axis linearisation", program.chord_bound_mm * 1000, comparison ? comparison->worst_extra_mm * 1000 : nothing},
          {"rounding", program.rounding_bound_mm * 1000, comparison ? comparison->worst_mm * 1000 : nothing},
          {"verification", (v.gouge.bound_mm - v.gouge.measured_mm) * 1000, nothing}};
}

std::optional<Diagnostic> post_and_prove(BevelRun& run, OutputDir& output, const FingerGougeCheck& check) {
  const auto dialect = dialect_of(run.machine);
  if (!dialect) return located(run.job, "machine.file", dialect.error());
  auto program = run.clock.run("axis program", [&] {
    return build_axis_program(run.checked, run.job.tools, *run.job.setup, run.machine, run.gear->parameters().teeth,
                              bevel_clearance_body(*run.gear), axis_options(*dialect, run.machine));
  });
  if (!program) return located(run.job, "setup", program.error());
  report_axis_program(run, *program);

  NcHeader header;
  header.job_name = run.job.name;
  header.machine_name = run.machine.name;
  header.assumed = run.report.assumed;
  header.coolant = run.job.coolant != Coolant::off;
  auto text = run.clock.run("NC text", [&] { return write_nc(*program, *dialect, header); });
  if (!text) return located(run.job, "machine.file", text.error());
  run.report.blocks = text->blocks;
  const std::string name = "program" + dialect->extension;
  if (const auto written = output.write(name, text->text); !written) return written.error();
  auto bytes = output.read_back(name);
  if (!bytes) return bytes.error();
  run.program_text = std::move(bytes.value());

  std::optional<ClComparison> comparison;
  auto proof = prove(run, check, *program, output.final_path(name), comparison);
  if (!proof) {
    Diagnostic error = proof.error();
    error.kind = DiagnosticKind::verification;  // our own program must be readable
    return error;
  }
  run.result = std::move(proof.value());
  judge(run.job, run.result, run.tolerances, run.report.reasons);
  run.report.gouge = run.result.gouge;
  run.report.excess = run.result.operations;
  if (finishing_chord(run.job)) run.report.finished = run.result.finished;
  run.report.ledger = ledger_of(run, *program, comparison);
  note_directions(run);
  if (!run.report.reasons.empty()) return std::nullopt;
  run.report.verified = true;
  run.report.program_file = name;
  run.report.program_sha256 = sha256_hex(run.program_text);
  run.report.program_bytes = run.program_text.size();
  run.report.files.push_back(name);
  return std::nullopt;
}

PageTool page_tool(const BevelRun& run, const ToolAssembly& tool) {
  PageTool page;
  page.name = fmt::format("T{} finger mill m {:g} mm", tool.number, tool.module_mm);
  const auto own = gear_for_finger_mill(*run.gear, tool);
  if (!own) return page;
  const auto& c = own->cutter();
  PageToolBody flute{"flute", {Vec2(0, 0)}, true};
  for (int i = 0; i <= 40; ++i) {
    const auto q = c.at(c.p_A + (c.p_D - c.p_A) * i / 40);
    flute.profile.emplace_back(q.rho, q.x + c.h_f);
  }
  flute.profile.emplace_back(c.rho_D, tool.flute_length_mm);
  page.bodies.push_back(std::move(flute));
  page.bodies.push_back({"shank", {Vec2(tool.shank_diameter_mm / 2, tool.flute_length_mm), Vec2(tool.shank_diameter_mm / 2, tool.stick_out_mm)}, false});
  PageToolBody holder{"holder", {}, false};
  double z = tool.stick_out_mm;
  for (const auto& part : tool.holder) {
    holder.profile.emplace_back(part.lower_diameter_mm / 2, z);
    z += part.height_mm;
    holder.profile.emplace_back(part.upper_diameter_mm / 2, z);
  }
  page.bodies.push_back(std::move(holder));
  return page;
}

ReportPage page_of(const BevelRun& run) {
  std::vector<ClPath> paths;
  for (const auto& plan : run.plans) paths.push_back(plan.path);
  ReportPage page = page_of_run(run.job, run.report, paths, run.program_text);
  const auto& p = run.gear->parameters();
  page.subtitle = fmt::format("equal-base-circle bevel gear z {}, outer module {:g} mm, {}, pitch angle {:.4f} deg, {}", p.teeth,
                              p.outer_transverse_module_mm, run.gear->herringbone() ? "herringbone" : "single hand", degrees(run.gear->delta()),
                              run.report.machine_name);
  page.tools.clear();
  for (const auto& tool : run.job.tools) page.tools.push_back(page_tool(run, tool));
  page.surface = run.result.walls;
  PageTable passes{"Passes", {"op", "zone", "pass", "name", "direction", "length mm", "points"}, {}, "one tooth space"};
  for (const auto& plan : run.plans)
    for (const auto& pass : plan.passes)
      passes.rows.push_back({std::to_string(plan.path.operation), std::to_string(pass.half), std::to_string(pass.pass), pass.name,
                             pass.outward ? "outwards" : "inwards", fmt::format("{:.3f}", pass.length_mm), std::to_string(pass.points)});
  page.tables.push_back(std::move(passes));
  if (run.result.ridge.points > 0)
    page.figures.push_back({"highest ridge", fmt::format("{:.4f}", run.result.ridge.reached_mm), "mm",
                            fmt::format("asked {:.4f}", run.result.ridge.requested_mm),
                            run.result.ridge.reached_mm <= run.result.ridge.requested_mm ? KeyFigure::State::good : KeyFigure::State::bad});
  return page;
}

/// What only a bevel gear has, beside the keys that all reports share.
std::string with_bevel_keys(const BevelRun& run, const std::string& json) {
  auto j = nlohmann::ordered_json::parse(json);
  if (run.result.ridge.points > 0)
    j["ridge_mm"] = {{"requested", run.result.ridge.requested_mm},
                     {"reached", run.result.ridge.reached_mm},
                     {"cone_distance", run.result.ridge.cone_distance_mm},
                     {"azimuth_deg", degrees(run.result.ridge.azimuth_rad)}};
  if (j.contains("tilt")) {
    j["tilt"]["lean_deg"] = 90 - degrees(run.gear->delta());
    j["tilt"]["simultaneous_axes"] = 2;
  }
  auto passes = nlohmann::ordered_json::array();
  for (const auto& plan : run.plans)
    for (const auto& pass : plan.passes)
      passes.push_back({{"op", plan.path.operation}, {"zone", pass.half}, {"pass", pass.pass}, {"name", pass.name}, {"length", pass.length_mm}, {"points", pass.points}});
  j["passes"] = std::move(passes);
  return j.dump(2) + "\n";
}

Status write_results(BevelRun& run, OutputDir& output, std::string& json) {
  RunReport& report = run.report;
  const auto write = [&](const std::string& name, const std::string& content) -> Status {
    report.files.push_back(name);
    return output.write(name, content);
  };
  if (report.verified) {
    if (const auto s = write_bevel_files(output, *run.gear, run.job.name, run.result.walls, run.clock, report.files); !s) return s;
    if (const auto s = write("setup.html", setup_sheet(run.job, bevel_outline(*run.gear), run.machine, report)); !s) return s;
  }
  const auto paths = run.paths();
  if (!paths.empty())
    if (const auto s = write("cl.csv", cl_csv(paths)); !s) return s;
  report.stages = run.clock.seconds();
  const auto page = run.clock.run("report page", [&] { return render_report_page(page_of(run)); });
  if (!page) return page.error();
  if (const auto s = write("report.html", *page); !s) return s;
  report.files.push_back("report.json");
  report.stages = run.clock.seconds();
  json = with_bevel_keys(run, report_json(report));
  return output.write("report.json", json);
}

CommandOutcome finish(BevelRun& run, OutputDir& output, const std::optional<Diagnostic>& stopped) {
  CommandOutcome outcome;
  if (stopped) {
    run.report.reasons.push_back(stopped->message);
    outcome.errors.push_back(*stopped);
  }
  if (!stopped)
    for (const auto& reason : run.report.reasons) {
      Diagnostic error = fail_as(DiagnosticKind::verification, "{}", reason);
      error.position.file = run.job.file;
      outcome.errors.push_back(std::move(error));
    }
  if (!run.report.verified) {
    for (const char* extension : {".ngc", ".nc", ".mpf", ".h", ".apt"}) output.discard(std::string("program") + extension);
    outcome.exit_code = ExitCode::unverified;
  }
  if (const auto written = write_results(run, output, outcome.report_json); !written) return failed(located(run.job, "gear", written.error()));
  run.progress.clear();
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  outcome.summary = summary_table(run.report, run.request.color);
  if (run.result.ridge.points > 0)
    outcome.summary += fmt::format("  {:<20}{:.4f} mm (asked {:.4f} mm)\n", "highest ridge", run.result.ridge.reached_mm, run.result.ridge.requested_mm);
  return outcome;
}

}  // namespace

std::optional<Job> bevel_job(const std::string& job_file) {
  auto read = read_job_file(job_file);
  auto* job = std::get_if<0>(&read);
  if (!job || !job->bevel_gear()) return std::nullopt;
  return std::move(*job);
}

ValueOrErrors<BevelGear> make_bevel_gear(const Job& job) {
  const BevelGearParameters* parameters = job.bevel_gear();
  if (!parameters) return std::vector{fail_at(job.where("gear.type"), "type = \"face_gear\", but a bevel gear is needed here")};
  std::optional<std::size_t> tool;
  for (std::size_t i = job.tools.size(); i-- > 0;)
    if (job.tools[i].type == CutterType::finger_mill) tool = i;
  for (const auto& operation : job.operations)
    if (operation.type == OperationType::finger_finishing) tool = static_cast<std::size_t>(operation.tool);
  if (!tool) return std::vector{fail_at(job.where("tool"), "the job lacks a [[tool]] of type \"finger_mill\": it makes the flanks of this gear")};
  auto made = BevelGear::make(*parameters, finger_cutter_data(job.tools[*tool]));
  if (auto* gear = std::get_if<BevelGear>(&made)) return std::move(*gear);
  std::vector<Diagnostic> errors;
  for (auto& refusal : std::get<1>(made)) {
    const std::string key = refusal.key.starts_with("tool.") ? fmt::format("tool[{}].{}", *tool, refusal.key.substr(5)) : "gear." + refusal.key;
    errors.push_back(located(job, key, std::move(refusal.diagnostic)));
  }
  return errors;
}

CommandOutcome run_bevel_surface(const CommandRequest& request, const Job& job, OutputDir& output) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto made = clock.run("gear", [&] { return make_bevel_gear(job); });
  if (auto* errors = std::get_if<1>(&made)) return failed(std::move(*errors));
  const BevelGear& gear = std::get<0>(made);
  RunReport report;
  report.command = "surface";
  report.job_name = job.name;
  report.job_file = job.file;
  report.warnings = gear.warnings();
  report.warnings.insert(report.warnings.begin(), job.warnings.begin(), job.warnings.end());
  if (const auto written = write_bevel_files(output, gear, job.name, {}, clock, report.files); !written)
    return failed(located(job, "gear", written.error()));
  report.files.push_back("report.json");
  report.stages = clock.seconds();
  CommandOutcome outcome;
  outcome.report_json = report_json(report);
  if (const auto written = output.write("report.json", outcome.report_json); !written) return failed(written.error());
  progress.clear();
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  outcome.summary = summary_table(report, request.color);
  return outcome;
}

CommandOutcome run_bevel_job(const CommandRequest& request, const Job& job, OutputDir& output) {
  BevelRun run(request, job);
  if (auto errors = read_inputs(run); !errors.empty()) {
    run.progress.clear();
    return failed(std::move(errors));
  }
  begin_report(run);
  const FingerGougeCheck check(*run.gear, job.tools, job.operations, run.tolerances);
  auto stopped = plan_and_check(run, check);
  if (!stopped) stopped = post_and_prove(run, output, check);
  if (stopped && stopped->kind != DiagnosticKind::verification) {
    run.progress.clear();
    return failed(std::move(*stopped));
  }
  return finish(run, output, stopped);
}

}  // namespace toothpath
