#include "app/process/ledger_sources.h"

#include <algorithm>
#include <cmath>

#include "app/base/units.h"
#include "geometry/base/angle.h"

namespace toothpath::process {
namespace {

/// What makes a part of the proven gouge smaller; nullptr: nothing in the job or the machine, or no part of it.
const char* help_against(proof::ErrorSource source) {
  using proof::ErrorSource;
  switch (source) {
    case ErrorSource::chord: return "a smaller chord_tolerance of the finishing operation";
    case ErrorSource::axis_linearisation: return "a smaller chord_tolerance of the finishing operation, or TCP";
    case ErrorSource::rounding:
      return "words of more decimals: post.linear_decimals and post.rotary_decimals of the machine, as far as its "
             "control takes them, another control, or TCP";
    case ErrorSource::path_blending: return "a smaller corner tolerance of the control, or exact stops";
    case ErrorSource::tool_form:
    case ErrorSource::half_angle:
    case ErrorSource::run_out: return "a better tool, or the same one measured more closely";
    case ErrorSource::tool_length: return "a tool setter that measures more closely (tool_check.uncertainty)";
    case ErrorSource::pivots: return "pivots that are measured more closely";
    case ErrorSource::flank_solve:
    case ErrorSource::scallop:
    case ErrorSource::line_misfit:
    case ErrorSource::ridge:
    case ErrorSource::orientation:
    case ErrorSource::verification:
    case ErrorSource::deflection:
    case ErrorSource::point_spacing:
    case ErrorSource::given_normals:
    case ErrorSource::meridian_corners:
    case ErrorSource::continuation: return nullptr;
  }
  return nullptr;
}

/// What the text grants the control in operations that no later one goes over.
double last_blend(const readback::ReadBack& read, const joints::AxisProgram& program) {
  double worst = 0;
  for (const joints::AxisOperation& op : program.operations)
    if (const auto found = read.blend_mm.find(op.operation); !op.wide_corners && found != read.blend_mm.end())
      worst = std::max(worst, found->second);
  return worst;
}

}  // namespace

proof::LedgerEntry entry(proof::ErrorSource source, double predicted_mm, double measured_mm, std::string note) {
  return {source, predicted_mm * app::kUm, measured_mm * app::kUm, std::move(note)};
}

proof::LedgerEntry stated_entry(proof::ErrorSource source, const std::optional<double>& stated_mm, std::string counted,
                                const std::string& missing) {
  if (stated_mm) return unmeasured(source, *stated_mm, std::move(counted));
  return {source, 0, {}, "not counted: " + missing, false};
}

proof::LedgerEntry unmeasured(proof::ErrorSource source, double predicted_mm, std::string note) {
  return {source, predicted_mm * app::kUm, std::nullopt, std::move(note)};
}

double rotary_rounding(const joints::AxisProgram& program) {
  const double one = radians(0.5 * std::pow(10.0, -program.format.rotary_decimals));
  return (program.letters[3] != 0 ? one : 0) + (program.letters[4] != 0 ? one : 0);
}

void add_machine_sources(std::vector<proof::LedgerEntry>& ledger, const joints::AxisProgram& program,
                         const std::optional<readback::ClComparison>& met, const readback::ReadBack& read,
                         double blend_mm) {
  const double worst = met ? met->worst_mm : 0, extra = met ? met->worst_extra_mm : 0;
  const bool turns = program.chord_bound_mm > 0;
  const bool held = !turns && program.turns_in_cuts && program.tcp != machines::TcpMode::none;
  ledger.push_back(
      entry(proof::ErrorSource::axis_linearisation, program.chord_bound_mm, turns ? std::max(0.0, extra - worst) : 0,
            turns  ? "blocks against the chords of the path, rounding taken off"
            : held ? "a rotary axis turns while the tool cuts; the control keeps the tip on the chord (TCP)"
                   : "no rotary axis turns while the tool cuts"));
  ledger.push_back(entry(proof::ErrorSource::rounding, program.rounding_bound_mm, worst,
                         "records against the motions that were read back"));
  // In single precision, as the moves that are read back carry it.
  ledger.push_back(
      entry(proof::ErrorSource::path_blending, double(float(blend_mm)), last_blend(read, program),
            blend_mm > 0 ? "the tolerance that the text grants the control" : "the text grants the control none"));
  if (program.check_uncertainty_mm > 0 || read.length_off_mm > 0)
    ledger.push_back(entry(proof::ErrorSource::tool_length, program.check_uncertainty_mm, read.length_off_mm,
                           "checks of the tools measure their lengths (tool_check.uncertainty)"));
}

std::vector<std::string> what_would_help(const std::vector<proof::LedgerEntry>& ledger, const proof::GougeResult& gouge,
                                         double tolerance_mm) {
  if (gouge.bound_mm <= tolerance_mm || gouge.measured_mm > tolerance_mm) return {};
  std::vector<std::string> help{fmt::format(
      "a larger [verify] gouge_tolerance: this program is proven to keep {:.2f} um, one planned for more may "
      "take a little more",
      gouge.bound_mm * app::kUm)};
  const proof::LedgerEntry* largest = nullptr;
  for (const proof::LedgerEntry& e : ledger)
    if (help_against(e.source) && (!largest || e.predicted_um > largest->predicted_um)) largest = &e;
  if (largest && largest->predicted_um > 0)
    help.push_back(fmt::format("{}; of the parts of the bound, {} is the largest, {:.2f} um",
                               help_against(largest->source), to_string(largest->source), largest->predicted_um));
  return help;
}

}  // namespace toothpath::process
