// `toothpath probe JOB`: a program that touches a blank or teeth that are there, or, with its results, where they
// stand.
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/base/listed.h"
#include "app/commands/command.h"
#include "app/commands/surface.h"
#include "app/job/file.h"
#include "app/job/measured_points.h"
#include "app/job/measured_setup.h"
#include "app/probing/stations.h"
#include "app/probing/touch_file.h"
#include "app/process/flow/registry.h"
#include "app/process/gear_of_job.h"
#include "app/process/opening_and_end.h"
#include "geometry/base/json_text.h"
#include "machines/toml/input_text.h"
#include "postproc/controls/of_machine.h"
#include "postproc/controls/registry.h"

namespace toothpath::probing {
namespace {

using app::CommandOutcome;

constexpr const char* kProgram = "probe_setup";
constexpr const char* kMeasured = "part.measured.toml";
constexpr int kProgramNumber = 7992;
constexpr std::size_t kMostResults = 1u << 20;
constexpr toml::Range kLength{0, 1000, " mm", true}, kAllowance{0, 2, " mm"}, kTool{1, 999}, kSpaces{3, 100},
    kFeed{1, 500, " mm/min"};
constexpr double kGuardedFeed = 1000;

struct ProbeRequest : commands::JobRequest {
  std::optional<double> ball_mm, length_mm, allowance_mm, feed;
  std::optional<int> tool, spaces;
  bool blank = false;
  std::string results;
};

struct Inputs {
  job::Job job;
  std::unique_ptr<process::GearProcess> gear;
  std::unique_ptr<inspection::TouchedPart> part;
  machines::Machine machine;
  inspection::TouchOptions options;
  inspection::TouchPlan plan;
  std::optional<Stations> stations;
};

std::vector<Diagnostic> read_inputs(const ProbeRequest& request, Inputs& in) {
  auto read = job::read_job_file(request.job_file);
  if (auto* errors = read.refused()) return std::move(*errors);
  in.job = std::move(read).value();
  auto gear = flow::make_process(in.job);
  if (auto* errors = gear.refused()) return std::move(*errors);
  in.gear = std::move(gear).value();
  in.part = in.gear->touched();
  if (!in.job.setup)
    return {fail_at(in.job.where("setup"), "the job lacks a [setup]: where the gear stands is not known")};
  auto machine = process::load_machine(in.job);
  if (auto* errors = machine.refused()) return std::move(*errors);
  in.machine = std::move(machine).value();
  in.options.ball_diameter_mm = request.ball_mm.value_or(0);
  in.options.allowance_mm = request.allowance_mm.value_or(0);
  in.options.spaces = request.spaces.value_or(in.options.spaces);
  auto plan = request.blank ? inspection::plan_blank_touches(*in.part, in.options)
                            : inspection::plan_touches(*in.part, in.options);
  if (!plan) return {process::located(in.job, "gear", plan.error())};
  in.plan = std::move(*plan);
  auto stations = Stations::make(in.plan, *in.job.setup, in.machine);
  if (!stations) return {process::located(in.job, "setup.axis", stations.error())};
  in.stations.emplace(std::move(*stations));
  return {};
}

const char* blank_words(const job::Job& job) {
  return job.bevel_gear() ? "face cone" : job.face_gear() ? "top and rim" : "tips and end";
}

CommandOutcome write_program(const ProbeRequest& request, const Inputs& in, app::OutputDir& output) {
  const auto dialect = controls::dialect_of(in.machine);
  if (!dialect) return app::failed(dialect.error());
  const joints::Setup& setup = *in.job.setup;
  ProbeProgram program;
  program.job_name = in.job.name;
  program.machine_name = in.machine.name;
  program.work_offset = setup.work_offset;
  program.offset_check = text::offset_check_lines(*dialect, setup.work_offset, controls::axis_letters(in.machine));
  if (dialect->datum != nullptr) program.datum = dialect->datum(setup.work_offset);
  program.tool = request.tool.value_or(0);
  program.number = kProgramNumber;
  program.ball_diameter_mm = in.options.ball_diameter_mm;
  program.probe_length_mm = request.length_mm.value_or(0);
  program.feed = request.feed.value_or(50);
  program.guarded_feed = kGuardedFeed;
  if (const auto placed = in.stations->place(in.plan, program); !placed)
    return app::failed(process::located(in.job, "setup.origin", placed.error()));
  const auto text = controls::probing_text(program, in.machine.dialect);
  if (!text) return app::failed(process::located(in.job, "machine.file", text.error()));
  CommandOutcome outcome;
  const std::string name = std::string(kProgram) + dialect->extension;
  const std::string where = request.blank
                                ? fmt::format("{} of the blank in {} places", blank_words(in.job), in.options.spaces)
                                : fmt::format("both flanks in {} tooth spaces", in.options.spaces);
  outcome.summary = fmt::format(
      "  probing program     {}: {} touches of {}, ball of {:g} mm\n"
      "  not looked at       the bodies of the machine and the holder of the probe\n"
      "  results             \"number x y z\" a line: toothpath probe JOB --results FILE\n",
      name, in.plan.touches.size(), where, in.options.ball_diameter_mm);
  if (!request.blank)
    outcome.summary +=
        fmt::format("  least gap           {:.3f} mm of ball and stem to what is not touched\n", in.plan.gap_mm);
  outcome.report_json = json_text(nlohmann::ordered_json{{"schema", 1},
                                                         {"command", "probe"},
                                                         {"program", name},
                                                         {"touches", in.plan.touches.size()},
                                                         {"gap", in.plan.gap_mm}},
                                  2) +
                        "\n";
  return process::finished(output, {{name, *text}}, std::move(outcome));
}

CommandOutcome solve(const ProbeRequest& request, const Inputs& in, app::OutputDir& output) {
  const auto text = toml::read_input_text(request.results, kMostResults);
  if (!text) return app::failed(text.error());
  auto results = parse_touches(*text, request.results);
  if (!results) return app::failed(results.error());
  const joints::Setup& setup = *in.job.setup;
  for (auto& r : *results)
    if (r.number >= 1 && r.number <= int(in.plan.touches.size())) r.centre = in.stations->in_gear(r.number, r.centre);
  const auto place = inspection::place_of_part(*in.part, in.plan, in.options, *results, request.results);
  if (!place) return app::failed(place.error());
  const job::MeasuredSetup measured{setup.origin_mm + setup.rotation() * place->moved_mm,
                                    setup.clocking_rad + place->clocking_rad};
  const double rim = in.part->reach().radius_mm;
  CommandOutcome outcome;
  outcome.summary = fmt::format(
      "  origin              [{:.4f}, {:.4f}, {:.4f}], ({:+.4f}, {:+.4f}, {:+.4f}) mm from the job's, +- ({:.4f}, "
      "{:.4f}, "
      "{:.4f})\n"
      "  clocking            {:+.5f} deg, {:+.4f} mm at radius {:.3f} mm, +- {:.5f} deg\n"
      "  touches             {}: largest left {:.2f} um, rms {:.2f} um\n"
      "  axis                leans by {:.2f} um at radius {:.3f} mm\n"
      "  written             {}: [setup] measured = \"{}\"\n",
      measured.origin_mm.x(), measured.origin_mm.y(), measured.origin_mm.z(), place->moved_mm.x(), place->moved_mm.y(),
      place->moved_mm.z(), place->moved_sigma_mm.x(), place->moved_sigma_mm.y(), place->moved_sigma_mm.z(),
      degrees(measured.clocking_rad), place->clocking_rad * rim, rim, degrees(place->clocking_sigma_rad),
      results->size(), place->residual_mm * 1000, place->rms_mm * 1000, place->tilt_rad.norm() * rim * 1000, rim,
      kMeasured, kMeasured);
  outcome.report_json =
      json_text(
          nlohmann::ordered_json{{"schema", 1},
                                 {"command", "probe"},
                                 {"origin", {measured.origin_mm.x(), measured.origin_mm.y(), measured.origin_mm.z()}},
                                 {"moved", {place->moved_mm.x(), place->moved_mm.y(), place->moved_mm.z()}},
                                 {"clocking_deg", degrees(measured.clocking_rad)},
                                 {"lean_um", place->tilt_rad.norm() * rim * 1000},
                                 {"residual_um", place->residual_mm * 1000},
                                 {"rms_um", place->rms_mm * 1000}},
          2) +
      "\n";
  return process::finished(output,
                           {{kMeasured, job::measured_setup_text(measured, results->size(), place->residual_mm)}},
                           std::move(outcome));
}

CommandOutcome run_probe(const ProbeRequest& request) {
  const bool writes = request.results.empty();
  std::vector<std::string> missing;
  if (!request.ball_mm) missing.emplace_back("--ball-diameter");
  if (writes && !request.length_mm) missing.emplace_back("--probe-length");
  if (writes && !request.tool) missing.emplace_back("--tool");
  if (!missing.empty()) return app::failed(fail_as(DiagnosticKind::usage, "probe needs {}", app::listed(missing)));
  std::vector<std::string> inputs = {request.job_file};
  if (!request.results.empty()) inputs.push_back(request.results);
  const std::string made = request.results.empty() ? std::string(kProgram) + "." : kMeasured;
  auto output = app::OutputDir::open(request.out_dir, {made}, inputs);
  if (!output) return app::failed(output.error());
  Inputs in;
  if (auto errors = read_inputs(request, in); !errors.empty()) return app::failed(std::move(errors));
  return request.results.empty() ? write_program(request, in, *output) : solve(request, in, *output);
}

}  // namespace

void add_probe(commands::Commands& commands) {
  commands.push_back(commands::command_of<ProbeRequest>(
      "probe", "writes a program that touches the blank or its teeth; finds from the results where the gear stands",
      [](commands::OptionSet& set, ProbeRequest& request) {
        commands::job_options(set, request);
        set.examples({"probe gear.toml --ball-diameter 2 --probe-length 120 --tool 20",
                      "probe gear.toml --ball-diameter 2 --results touches.txt"});
        set.number("--ball-diameter", request.ball_mm, "of the probe; needed", job::kBallDiameter);
        set.number("--probe-length", request.length_mm,
                   "from the gauge line to the centre of its ball; needed without --results", kLength);
        set.whole_number("--tool", request.tool, "number of the probe; needed without --results", kTool);
        set.number("--allowance", request.allowance_mm, "that still stands on the flanks (default 0)", kAllowance);
        set.number("--feed", request.feed, "of a touch (default 50)", kFeed);
        set.flag("--blank", request.blank, "the turned blank is touched, not teeth: top and rim, or its face cone");
        set.whole_number("--spaces", request.spaces,
                         "tooth spaces, or places of the blank, that are touched (default 4)", kSpaces);
        set.text("--results", request.results,
                 "what the program logged, \"number x y z\" a line: writes part.measured.toml for [setup] measured",
                 "FILE");
      },
      run_probe));
}

}  // namespace toothpath::probing
