#include <cmath>

#include "app/base/units.h"
#include "app/report/sections/sections.h"

namespace toothpath::sections {
namespace {

using app::um;

constexpr int kFirstClass = 1, kLastClass = 11;  // of ISO 1328-1

/// Of the ledger: measured where it was, else predicted.
double ledger_um(const SectionInput& input, std::initializer_list<proof::ErrorSource> sources) {
  double sum = 0;
  for (const proof::LedgerEntry& entry : input.report.ledger)
    for (const proof::ErrorSource source : sources)
      if (entry.source == source && entry.counted) sum += entry.measured_um.value_or(entry.predicted_um);
  return sum;
}

/// Proven to stand on the flanks; where the regions are not told apart, on the finished surface.
double left_um(const SectionInput& input) {
  const proof::ExcessResult& all = *input.report.finished;
  for (const report::Finding& finding : input.report.findings)
    if (finding.key == "left_um")
      for (const auto& [region, value] : finding.details)
        if (const double* flank = std::get_if<double>(&value); flank != nullptr && region == "flank")
          return *flank + um(all.bound_mm - all.max_mm);
  return um(all.bound_mm);
}

/// The worst of the operations that finish: bending adds to what they leave, never more than the stock that bends them.
std::optional<double> bending_um(const SectionInput& input) {
  std::optional<double> worst;
  for (const report::OperationReport& o : input.report.operations) {
    const auto n = static_cast<std::size_t>(o.operation);
    if (n >= input.job.operations.size() || !input.job.operations[n].finishes() || !o.cutting || !o.cutting->load)
      continue;
    const double bends_mm = o.cutting->load->deflection_mm;
    worst = std::max(worst.value_or(0), um(std::min(bends_mm, o.cutting->stock_mm.value_or(bends_mm))));
  }
  return worst;
}

std::string length_text(const SectionInput& input) {
  double flank_share = 0;
  std::optional<double> too_long, too_short;
  for (const report::LengthTolerance& t : input.report.length_tolerances) {
    const auto n = static_cast<std::size_t>(t.operation);
    if (n >= input.job.operations.size() || !input.job.operations[n].finishes()) continue;
    flank_share = std::max(flank_share, t.flank_share);
    too_long = std::min(too_long.value_or(t.too_long_mm), t.too_long_mm);
    if (t.too_short_mm) too_short = std::min(too_short.value_or(*t.too_short_mm), *t.too_short_mm);
  }
  if (!too_long) return "";
  return fmt::format(
      " A tool 1 um too long or short moves a flank by up to {:.2f} um, not in the sum; the limits hold from -{} to "
      "+{:.2f} um.",
      flank_share, too_short ? fmt::format("{:.2f}", um(*too_short)) : std::string("any"), um(*too_long));
}

/// A class is sqrt(2) times the one below it: ISO 1328-1.
std::string reached_text(double sum_um, const job::VerifySettings& verify) {
  const double asked_um = um(*verify.form_tolerance_mm);
  std::string out = fmt::format("{:.2f} um asked: {}", asked_um, sum_um <= asked_um ? "reached" : "not reached");
  if (!verify.iso_class) return out;
  const int reached = *verify.iso_class + static_cast<int>(std::ceil(2 * std::log2(sum_um / asked_um) - 1e-9));
  return out + fmt::format("; class {} asked, {} reached", *verify.iso_class,
                           reached > kLastClass ? std::string("none") : std::to_string(std::max(reached, kFirstClass)));
}

}  // namespace

/// What the form of the flanks is made of, against what is asked; on the page alone.
report::Section budget(const SectionInput& input) {
  report::Section section;
  if (!input.report.gouge || !input.report.finished) return section;
  section.title = "What the accuracy is made of";
  section.id = "budget";
  section.sheet_rows = 0;
  section.columns = {"part", "um", "how it is known"};
  const double deep = um(std::max(0.0, input.report.gouge->bound_mm)), left = left_um(input);
  const auto row = [&](const char* part, double um, const std::string& how) {
    section.rows.push_back({part, fmt::format("{:.2f}", um), how});
  };
  using enum proof::ErrorSource;
  row("cut too deep", deep, "proven from the program's text");
  row("left on the flanks", left, "proven from the program's text");
  row("- words rounded", ledger_um(input, {rounding}), "of these, by the ledger");
  row("- corners", ledger_um(input, {path_blending}), "of these, by the ledger");
  const double tool = ledger_um(input, {tool_form, half_angle, run_out});
  if (tool > 0) row("form of the tool", tool, "as the job states them");
  const std::optional<double> bends = bending_um(input);
  section.rows.push_back({"bending", bends ? report::estimate(*bends) : std::string("-"),
                          bends ? "estimated by the force" : "not estimated"});
  const double sum = deep + left + tool + bends.value_or(0);
  row("together", sum,
      input.job.verify.form_tolerance_mm ? reached_text(sum, input.job.verify)
                                         : "nothing is asked: [verify] form_tolerance, or new --class");
  section.note =
      "\"Together\" is the sum of what is proven, stated and estimated; what errors of the machine cost tells study "
      "machine-errors. The class is that of the profile form f_f_alpha of ISO 1328-1, the standard of cylindrical "
      "gears." +
      length_text(input);
  return section;
}

}  // namespace toothpath::sections
