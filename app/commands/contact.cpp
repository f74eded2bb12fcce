#include "app/commands/contact.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include "app/base/new_file.h"
#include "app/base/units.h"
#include "app/job/file.h"
#include "app/job/measured_points.h"
#include "app/process/flow/cut_flanks.h"
#include "app/process/flow/stages.h"
#include "app/process/toothed_pair/contact.h"
#include "geometry/base/printable.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kContactOutputs = {"contact.csv",  "ease_off.csv",   "transmission.csv",
                                                  "contact.json", "contact.html",   "loaded.csv",
                                                  "pressure.csv", "root_stress.csv"};

const std::vector<std::string> kDecks = {"ring_0_flank_plus.inp",  "ring_0_flank_minus.inp", "ring_1_flank_plus.inp",
                                         "ring_1_flank_minus.inp", "half_0_wall_L.inp",      "half_0_wall_U.inp",
                                         "half_1_wall_L.inp",      "half_1_wall_U.inp"};

/// Rows that resolve the cusps of a finishing operation: several to a pass.
constexpr int kCutRows = 241, kCutColumns = 33;

/// Options that contradict each other, or a file that is there already.
Status check_request(const ContactRequest& r) {
  const auto usage = [](std::string message) { return Diagnostic{DiagnosticKind::usage, {}, std::move(message)}; };
  if (r.as_cut && !r.measured.files.empty())
    return usage("--as-cut and --measured contradict each other: one surface is rolled beside the exact one");
  if (r.measured.files.empty() && r.measured.ball_diameter_mm) return usage("--ball-diameter belongs to --measured");
  if (r.other_job.empty() && (r.shaft_angle_deg || r.axis_distance_mm))
    return usage(fmt::format("{} belongs to --mate", r.shaft_angle_deg ? "--shaft-angle" : "--axis-distance"));
  if (!r.optimise && (!r.modify.empty() || !r.write_file.empty()))
    return usage(fmt::format("{} belongs to --optimise", r.modify.empty() ? "--write" : "--modify"));
  if (!r.modify.empty() && std::find(std::begin(process::kModifiable), std::end(process::kModifiable), r.modify) ==
                               std::end(process::kModifiable))
    return usage(fmt::format("--modify {}: gear, pinion or both is needed", printable(r.modify)));
  if (r.write_file.empty()) return Ok{};
  if (auto fresh = app::check_new_file(r.write_file, "--write"); !fresh) return fresh;
  for (const auto& [given, option, key] :
       {std::tuple(r.pinion_teeth.has_value(), "--pinion-teeth", "pinion_teeth"),
        {r.offset_error_mm.has_value(), "--offset-error", "offset_error"},
        {r.angle_error_deg.has_value(), "--angle-error", "angle_error"},
        {r.axial_error_mm.has_value(), "--axial-error", "axial_error"},
        {r.wheel_axial_error_mm.has_value(), "--wheel-axial-error", "gear_axial_error"},
        {r.compound_um.has_value(), "--compound", "compound"}})
    if (given)
      return usage(
          fmt::format("{} and --write contradict each other: the job that is written must say it, as {} in "
                      "[contact]",
                      option, key));
  return Ok{};
}

/// The gear of another job that a gear is rolled with, and how both stand; the gear keeps a reference to its job.
struct Mate {
  std::unique_ptr<const job::Job> job;
  std::unique_ptr<process::GearProcess> gear;
  toothed_pair::Shafts shafts;
};
/// Nothing: the gear rolls with a mate of its own rules.
process::ValueOrErrors<std::optional<Mate>> mate_of(const ContactRequest& request, const job::Job& job,
                                                    const process::GearProcess& gear, app::StageClock& clock) {
  std::optional<Mate> out;
  if (!request.other_job.empty()) {
    auto read = clock.run("mate", [&] { return job::read_job_file(request.other_job); });
    if (auto* errors = read.refused()) return std::move(*errors);
    out.emplace(Mate{std::make_unique<const job::Job>(std::move(read).value()), nullptr, {}});
  }
  const bool bevels = job.bevel_gear() != nullptr && (!out || out->job->bevel_gear() != nullptr);
  if (bevels && (request.shaft_angle_deg || request.axis_distance_mm))
    return std::vector{fail_at(job.where("gear.type"),
                               "type = \"{}\" rolls on the shafts that it was made for: leave out {}", job.gear_type(),
                               request.shaft_angle_deg ? "--shaft-angle" : "--axis-distance")};
  if (!out || bevels) {
    if (auto accepted = gear.accepts(request); !accepted) return std::vector{accepted.error()};
    return std::optional<Mate>();
  }
  auto made = flow::make_gear(*out->job, {}, clock);
  if (auto* errors = made.refused()) return std::move(*errors);
  out->gear = std::move(made.value().process);
  auto shafts = toothed_pair::accepted({job, gear.toothed()}, {*out->job, out->gear->toothed()}, request);
  if (auto* errors = shafts.refused()) return std::move(*errors);
  out->shafts = shafts.value();
  return out;
}

}  // namespace

CommandOutcome run_contact(const ContactRequest& request) {
  if (const Status fits = check_request(request); !fits) return failed(fits.error());
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  std::vector<std::string> read_files = request.measured.files;
  read_files.insert(read_files.end(), {request.job_file, request.other_job});
  auto output = app::OutputDir::open(request.out_dir, kContactOutputs, read_files);
  if (!output) return failed(output.error());
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value();
  auto made = flow::make_gear(job, {}, clock);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  const process::GearProcess& gear = *made.value().process;
  auto read_mate = mate_of(request, job, gear, clock);
  if (auto* errors = read_mate.refused()) return failed(std::move(*errors));
  const std::optional<Mate>& mate = read_mate.value();
  std::optional<process::CutFlanks> cut;
  if (request.as_cut) {
    auto flanks = flow::cut_flanks(job, {kCutRows, kCutColumns}, *output, request.quiet);
    if (auto* errors = flanks.refused()) return failed(std::move(*errors));
    cut = std::move(flanks).value();
  }
  if (mate && !request.measured.files.empty()) {
    auto flanks = clock.run("measured", [&] { return gear.measured(request.measured); });
    if (auto* errors = flanks.refused()) return failed(std::move(*errors));
    cut = std::move(flanks).value();
  }
  const process::CutFlanks* as_cut = cut ? &*cut : nullptr;
  auto rolled = mate ? toothed_pair::roll_pair({job, gear.toothed()}, {*mate->job, mate->gear->toothed()}, mate->shafts,
                                               request, as_cut, clock)
                     : gear.contact(request, as_cut, clock);
  if (auto* errors = rolled.refused()) return failed(std::move(*errors));
  process::ContactFound found = std::move(rolled).value();
  if (!request.ccx_dir.empty()) {
    auto decks = app::OutputDir::open(request.ccx_dir, kDecks, read_files);
    if (!decks) return failed(decks.error());
    auto written = process::finished(*decks, found.decks, {});
    if (!written.errors.empty()) return written;
    found.summary += "  decks in " + request.ccx_dir + "\n";
  }
  if (!found.job_text.empty()) {
    if (const Status written = app::write_new_file(request.write_file, found.job_text); !written)
      return failed(written.error());
    found.summary += "  job in " + request.write_file + "\n";
  }
  CommandOutcome outcome;
  if (found.missed) outcome.exit_code = app::ExitCode::unverified;
  if (found.missed && !request.write_file.empty()) found.summary += "  no job was written\n";
  outcome.report_json = std::move(found.json);
  outcome.summary = found.summary + "  files in " + request.out_dir + "\n";
  progress.clear();
  return process::finished(*output, found.files, std::move(outcome));
}

void add_contact(Commands& commands) {
  commands.push_back(command_of<ContactRequest>(
      "contact", "rolls the gear with its mate: contact pattern, transmission error, pairs in contact",
      [](OptionSet& set, ContactRequest& request) {
        job_options(set, request);
        set.examples({"contact gear.toml", "contact pinion.toml --mate wheel.toml --offset-error 0.02"});
        set.whole_number("--pinion-teeth", request.pinion_teeth,
                         "teeth of the pinion (default: mate_teeth, else the shaper's)", job::kPinionTeeth);
        set.number("--offset-error", request.offset_error_mm, "pinion axis off its place across the tooth",
                   job::kMoved);
        set.number("--angle-error", request.angle_error_deg, "error of the shaft angle", job::kAngleError);
        set.number("--axial-error", request.axial_error_mm, "pinion off its place along its axis", job::kMoved);
        set.number("--compound", request.compound_um, "thickness of the marking compound (default 6)",
                   {app::um(job::kCompound.low), app::um(job::kCompound.high), " um"});
        set.text("--mate", request.other_job,
                 "job of the mate, any gear that meshes with this one (default: face gears the pinion of their shaper; "
                 "equal-base-circle bevel gears by the rules of the pair, same mill)",
                 "JOB");
        set.number("--shaft-angle", request.shaft_angle_deg,
                   "with --mate: between the axes of both gears, where their keys do not say it", {0, 180, " deg"});
        set.number("--axis-distance", request.axis_distance_mm,
                   "with --mate: distance of the axes (default: cylindrical gears without backlash; bevel gears 0)",
                   {-10000, 10000, " mm"});
        set.number("--wheel-axial-error", request.wheel_axial_error_mm,
                   "gear, or wheel of a bevel pair, off its place along its axis, away from its mate", job::kMoved);
        set.number("--torque", request.torque_Nm, "load the elastic pair, too: torque on the gear",
                   job::kContactTorque);
        set.flag("--on-pinion", request.torque_on_pinion, "that torque is the pinion's");
        set.flag("--held", request.pinion_held, "the pinion is held along its axis where it would float");
        set.whole_number("--positions", request.positions, "positions of the loaded pair over a pitch (default 24)",
                         job::kContactPositions);
        set.text("--ccx", request.ccx_dir, "with --torque: write decks of CalculiX, a ring and flank each", "DIR");
        set.flag("--optimise", request.optimise,
                 "seek crownings and reliefs that keep the pattern inside over the box of [contact.misalignment]");
        set.word("--modify", request.modify,
                 "whose flanks --optimise may modify (default both; shaped gears: pinion; bevel gears: their own)",
                 "WHO", process::kModifiable);
        set.text("--write", request.write_file, "with --optimise: the job with what was found, a new file", "JOB.toml");
        set.flag("--as-cut", request.as_cut, "roll the surface that the job cuts, too");
        set.files("--measured", request.measured.files,
                  "roll the surface that was measured, too: files as `correct` reads them; bevel gears: grids");
        set.number("--ball-diameter", request.measured.ball_diameter_mm,
                   "the measured points are centres of a ball of this diameter, not places of the surface",
                   job::kBallDiameter);
      },
      run_contact));
}

}  // namespace toothpath::commands
