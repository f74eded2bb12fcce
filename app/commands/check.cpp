#include "app/commands/check.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <regex>

#include "app/base/output_dir.h"
#include "app/job/file.h"
#include "app/job/measured_points.h"
#include "app/process/flow/graphics_blank.h"
#include "app/process/flow/machine_moves.h"
#include "app/process/flow/machine_picture.h"
#include "app/process/flow/stages.h"
#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "app/report/deviation_vtp.h"
#include "app/report/page/motion_charts.h"
#include "app/report/page/page_of_run.h"
#include "app/report/sections/sections.h"
#include "app/report/sheet/setup_sheet.h"
#include "geometry/base/hash.h"
#include "postproc/readback/program_hash.h"
#include "postproc/timing/model_text.h"

namespace toothpath::commands {

/// What one check has read and found so far. Steps fill it in order.
struct ProgramCheck {
  const CheckRequest request;
  app::Progress progress;
  app::StageClock clock{progress};
  job::Job job;
  proof::ProofLimits limits;
  flow::GearToCut gear;
  machines::Machine machine;
  std::string text, file;  ///< the program
  std::optional<process::Scene> scene;
  std::unique_ptr<process::GearMilling> milling;
  std::optional<process::ProgramProof> proof;
  page::SceneStates states;  ///< of the picture
  report::RunReport report;

  explicit ProgramCheck(const CheckRequest& r) : request(r), progress(r.quiet), file(r.program_file) {}
};

namespace {

constexpr const char* kSheet = "setup_check.html";  // not that of `run`, which knows more of its program

/// Job, gear, machine, the program that is asked for and meshes; the first of them that is refused ends it.
std::vector<Diagnostic> read_inputs(ProgramCheck& check) {
  const CheckRequest& request = check.request;
  auto read = check.clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return std::move(*errors);
  check.job = std::move(read).value();
  check.limits = process::proof_limits(check.job);
  auto gear = flow::make_gear(check.job, request.measured, check.clock);
  if (auto* errors = gear.refused()) return std::move(*errors);
  check.gear = std::move(gear).value();
  auto loaded = check.clock.run("machine", [&] { return process::load_machine(check.job); });
  if (auto* errors = loaded.refused()) return std::move(*errors);
  check.machine = std::move(loaded).value();
  if (!check.job.setup)
    return {fail_at(check.job.where("setup"), "the job lacks a [setup]: where the gear stands is not known")};
  if (!request.program_file.empty()) {
    auto text = process::read_program_file(request.program_file);
    if (!text) return {text.error()};
    check.text = std::move(text.value());
  }
  if (!process::wants_scene(request)) return {};
  auto meshes = check.clock.run("stock and fixture meshes",
                                [&] { return process::load_scene(request, check.job.setup->clocking_rad); });
  if (!meshes) return {meshes.error()};
  check.scene = std::move(meshes.value());
  const auto placed = check.clock.run("stock and fixture meshes", [&]() -> Status {
    const auto solid = check.gear.process->solid();
    return solid ? process::place_scene(*check.scene, *solid, check.limits.clearance_mm) : Status(solid.error());
  });
  if (!placed) return {placed.error()};
  return {};
}

/// What stands around the gear joins the proof.
Status judge_scene(ProgramCheck& check) {
  if (!check.scene || !check.proof->swept) return Ok{};
  auto verdicts = check.clock.run("stock and fixture", [&]() -> Result<std::vector<report::SceneVerdict>> {
    const auto around = check.gear.process->scene(check.limits.clearance_mm);
    if (!around) return around.error();
    return process::check_scene(*check.scene, check.text, check.file, check.job, check.machine, check.proof->read,
                                *around);
  });
  if (!verdicts) return verdicts.error();
  process::add_scene(*verdicts, check.proof->reasons, check.proof->gouge, check.report);
  check.report.sections.push_back(sections::scene(check.report));
  return Ok{};
}

/// What the header of a program says that holds a part of the teeth; empty: it is a whole one.
std::string part_of_header(std::string_view text) {
  constexpr std::size_t kHeader = 4096;
  static const std::regex kPart("PART ([0-9]+ OF [0-9]+): (OPERATION [0-9]+, [A-Z0-9 ]+[A-Z0-9])");
  const std::string head(text.substr(0, kHeader));
  std::smatch found;
  if (!std::regex_search(head, found, kPart)) return {};
  std::string teeth = found[2];
  std::transform(teeth.begin(), teeth.end(), teeth.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  std::string which = found[1];
  which.replace(which.find("OF"), 2, "of");
  return fmt::format(
      "by its header this is part {} ({}): it is judged alone, and what the other parts cut is missing. The run that "
      "made it has proven it beside the whole program",
      which, teeth);
}

/// Everything that is asked of the program. Errors: what the reader refuses; a program that is read but not safe is
/// none.
Status prove(ProgramCheck& check) {
  if (!check.milling) {
    check.milling = check.gear.process->milling(check.machine, check.limits, {}, check.clock);
    // Which way was taken where the job leaves it open, the plan knows alone.
    if (std::any_of(check.job.operations.begin(), check.job.operations.end(), [](const auto& o) { return o.best_way; }))
      if (auto planned = flow::plan_job(check.job, *check.milling, check.clock, check.progress); !planned)
        return planned.error();
  }
  auto bodies =
      flow::bodies_in_machine(check.job, check.machine, *check.gear.process, check.scene ? &*check.scene : nullptr);
  if (!bodies) return bodies.error();
  bodies::MovesJudge moves = flow::judge_of(check.machine, std::move(*bodies), check.job, check.limits.clearance_mm);
  page::StateRecorder states = flow::recorder_of(check.job, check.gear.process->part().teeth);
  auto proof = process::prove_program(
      {check.text, check.file, check.job, check.machine, &moves,
       [&](const readback::ExecutedMove& move) { states.add(move); },
       flow::graphics_blank(*check.gear.process, *check.job.setup), !check.request.stock_files.empty()},
      {}, check.milling->check(), check.clock);
  if (!proof) return proof.error();
  check.proof = std::move(proof.value());
  check.states = states.finish(check.proof->read);
  report::RunReport& report = check.report;
  report = process::report_of("check", check.job, check.machine, check.gear.process->part().warnings);
  report.modified = check.gear.process->part().modified;
  if (auto judged = judge_scene(check); !judged) return judged;
  process::note_proof(report, *check.proof);
  if (std::string part = part_of_header(check.text); !part.empty()) report.warnings.push_back(std::move(part));
  const auto& hash = report.hash;
  report.blocks = hash && hash->fits() && hash->blocks > 0 ? hash->blocks : readback::count_blocks(check.text);
  report.has_acceleration = check.machine.has_acceleration();
  report.time_model = timing::model_text(check.machine, check.proof->read.corners);
  report.feed_minutes = check.proof->read.accelerated.feed;
  report.total_minutes = report.feed_minutes + check.proof->read.accelerated.rapid;
  report.axes = process::ranges_of(check.proof->read, check.machine);
  if (auto section = sections::machine_moves_of(check.machine, report); !section.rows.empty())
    report.sections.push_back(std::move(section));
  report.sections.insert(report.sections.begin(), sections::conditions(check.job, check.machine, report));
  report.verified = report.reasons.empty();
  report.program_file = check.file;
  report.program_sha256 = sha256_hex(check.text);
  report.program_bytes = check.text.size();
  return Ok{};
}

Status write_results(ProgramCheck& check, app::OutputDir& output, std::string& json) {
  report::RunReport& report = check.report;
  const process::ProgramProof& proof = *check.proof;
  const auto vtp = report::deviation_vtp(proof.surface);
  if (!vtp) return vtp.error();
  if (const auto s = output.write("tooth.vtp", *vtp); !s) return s;
  const auto outline = check.gear.process->outline();
  if (const auto s = output.write(kSheet, sheet::setup_sheet(check.job, outline, check.machine, report)); !s) return s;
  report.files = {"tooth.vtp", kSheet, "report.html", "report.json"};
  report.stages = check.clock.seconds();
  const auto page = check.clock.run("report page", [&] {
    page::ReportPage content =
        page::page_of_run(check.gear.process->on_page(report.machine_name), report, {}, check.text);
    content.surface = proof.surface;
    content.motion = page::motion_charts(proof.read, proof.motions, check.machine);
    content.machine = flow::machine_picture(check.job, check.machine, *check.gear.process, std::move(check.states),
                                            check.scene ? &*check.scene : nullptr);
    return page::render_report_page(content);
  });
  if (!page) return page.error();
  if (const auto s = output.write("report.html", *page); !s) return s;
  report.stages = check.clock.seconds();
  json = report::report_json(report);
  return output.write("report.json", json);
}

}  // namespace

CommandOutcome check_program(const CheckRequest& request) {
  std::vector<std::string> inputs = {request.job_file, request.program_file};
  for (const auto* more : {&request.stock_files, &request.fixture_files, &request.measured.files})
    inputs.insert(inputs.end(), more->begin(), more->end());
  auto output = app::OutputDir::open(request.out_dir, {"report.json", "report.html", "tooth.vtp", kSheet}, inputs);
  if (!output) return failed(output.error());
  ProgramCheck check(request);
  if (auto errors = read_inputs(check); !errors.empty()) {
    check.progress.clear();
    return failed(std::move(errors));
  }
  if (const auto kept = output->keeps_inputs(); !kept) return failed(kept.error());
  if (const auto proven = prove(check); !proven) {
    check.progress.clear();
    return failed(proven.error());
  }
  CommandOutcome outcome;
  outcome.exit_code = check.report.verified ? app::ExitCode::ok : app::ExitCode::unverified;
  outcome.errors = process::errors_of(check.report.reasons, request.program_file);
  if (const auto written = write_results(check, *output, outcome.report_json); !written) return failed(written.error());
  check.progress.clear();
  if (const auto committed = output->commit(); !committed) return failed(committed.error());
  check.report.directory = output->path();
  outcome.summary = report::summary_table(check.report, request.color) + process::table_of_worst(check.proof->gouge);
  return outcome;
}

ProgramChecker::ProgramChecker(const CheckRequest& request) : check_(std::make_unique<ProgramCheck>(request)) {}

ProgramChecker::~ProgramChecker() = default;

std::vector<Diagnostic> ProgramChecker::read() { return read_inputs(*check_); }

Result<report::RunReport> ProgramChecker::prove(std::string text, const std::string& file) {
  check_->text = std::move(text);
  check_->file = file;
  if (auto proven = commands::prove(*check_); !proven) return proven.error();
  return std::move(check_->report);
}

void add_check(Commands& commands) {
  commands.push_back(command_of<CheckRequest>(
      "check", "proves an NC program that exists already against its job",
      [](OptionSet& set, CheckRequest& request) {
        job_options(set, request);
        set.examples({"check gear.toml out/program.nc", "check gear.toml edited.nc --stock out/blank.stl"});
        set.file("PROGRAM", request.program_file, "NC program in the dialect of the job's machine");
        set.files("--stock", request.stock_files,
                  "closed mesh of the stock before the program (STL or OBJ, mm, gear frame); repeatable");
        set.files(
            "--fixture", request.fixture_files,
            "closed mesh of what holds the work and turns with it (STL or OBJ, mm, gear frame); repeatable. Facets are "
            "taken as exact: what they leave out of the true part must lie within the clearance of the job");
        set.files("--measured", request.measured.files,
                  "what was measured, where the program is compensated for it (see correct)");
        set.number("--ball-diameter", request.measured.ball_diameter_mm,
                   "the measured points are centres of a ball of this diameter (see correct)", job::kBallDiameter);
      },
      check_program));
}

}  // namespace toothpath::commands
