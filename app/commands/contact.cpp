#include "app/commands/contact.h"

#include <optional>

#include "app/base/units.h"
#include "app/job/file.h"
#include "app/process/flow/cut_flanks.h"
#include "app/process/flow/stages.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kContactOutputs = {"contact.csv",  "transmission.csv", "contact.json",
                                                  "contact.html", "loaded.csv",       "pressure.csv"};

const std::vector<std::string> kDecks = {"ring_0_flank_plus.inp", "ring_0_flank_minus.inp", "ring_1_flank_plus.inp",
                                         "ring_1_flank_minus.inp"};

/// Rows that resolve the cusps of a finishing operation: several to a pass.
constexpr int kCutRows = 241, kCutColumns = 33;

}  // namespace

CommandOutcome run_contact(const ContactRequest& request) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, kContactOutputs, {request.job_file, request.other_job});
  if (!output) return failed(output.error());
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value();
  auto made = flow::make_gear(job, {}, clock);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  const process::GearProcess& gear = *made.value().process;
  if (const auto accepted = gear.accepts(request); !accepted) return failed(accepted.error());
  std::optional<process::CutFlanks> cut;
  if (request.as_cut) {
    auto flanks = flow::cut_flanks(job, {kCutRows, kCutColumns}, *output, request.quiet);
    if (auto* errors = flanks.refused()) return failed(std::move(*errors));
    cut = std::move(flanks).value();
  }
  auto rolled = gear.contact(request, cut ? &*cut : nullptr, clock);
  if (auto* errors = rolled.refused()) return failed(std::move(*errors));
  process::ContactFound found = std::move(rolled).value();
  if (!request.ccx_dir.empty()) {
    auto decks = app::OutputDir::open(request.ccx_dir, kDecks, {request.job_file, request.other_job});
    if (!decks) return failed(decks.error());
    auto written = process::finished(*decks, found.decks, {});
    if (!written.errors.empty()) return written;
    found.summary += "  decks in " + request.ccx_dir + "\n";
  }
  CommandOutcome outcome;
  outcome.report_json = std::move(found.json);
  outcome.summary = found.summary + "  files in " + request.out_dir + "\n";
  progress.clear();
  return process::finished(*output, found.files, std::move(outcome));
}

void add_contact(Commands& commands) {
  commands.push_back(command_of<ContactRequest>(
      "contact", "gear and pinion rolled: contact pattern, transmission error, pairs",
      [](OptionSet& set, ContactRequest& request) {
        job_options(set, request);
        set.whole_number("--pinion-teeth", request.pinion_teeth,
                         "teeth of the pinion (default: mate_teeth, else the shaper's)", job::kPinionTeeth);
        set.number("--offset-error", request.offset_error_mm, "pinion axis off its place across the tooth",
                   job::kMoved);
        set.number("--angle-error", request.angle_error_deg, "error of the shaft angle", job::kAngleError);
        set.number("--axial-error", request.axial_error_mm, "pinion off its place along its axis", job::kMoved);
        set.number("--compound", request.compound_um, "thickness of the marking compound (default 6)",
                   {app::um(job::kCompound.low), app::um(job::kCompound.high), " um"});
        set.text("--mate", request.other_job,
                 "bevel gears: job of the mate (default: by the rules of the pair, same mill)", "JOB");
        set.number("--wheel-axial-error", request.wheel_axial_error_mm,
                   "bevel gears: wheel off its place along its axis", job::kMoved);
        set.number("--torque", request.torque_Nm, "load the elastic pair, too: torque on the gear",
                   job::kContactTorque);
        set.flag("--on-pinion", request.torque_on_pinion, "that torque is the pinion's");
        set.flag("--held", request.pinion_held, "the pinion is held along its axis where it would float");
        set.whole_number("--positions", request.positions, "positions of the loaded pair over a pitch (default 24)",
                         job::kContactPositions);
        set.text("--ccx", request.ccx_dir, "with --torque: write decks of CalculiX, a ring and flank each", "DIR");
        set.flag("--as-cut", request.as_cut, "roll the surface that the job cuts, too");
      },
      run_contact));
}

}  // namespace toothpath::commands
