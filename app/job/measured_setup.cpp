#include "app/job/measured_setup.h"

#include <filesystem>

#include "app/job/words.h"
#include "geometry/base/angle.h"
#include "geometry/inspection/touches.h"
#include "machines/toml/regular_file.h"

namespace toothpath::job {
namespace {

constexpr std::size_t kMostBytes = 1u << 16;
constexpr toml::Range kPlace{-1e5, 1e5, " mm"}, kTurn{-180, 180, " deg"}, kTouches{0, 1e6}, kRest{0, 1e4, " um"};

}  // namespace

Result<MeasuredSetup> parse_measured_setup(std::string_view text, const std::string& file) {
  const auto document = toml::parse_toml(text, file, kJobSyntax);
  if (!document) return document.error();
  toml::ReaderFindings findings(job_words());
  toml::TableReader root(*document, "", findings);
  MeasuredSetup out;
  if (auto table = root.required_table("measured")) {
    if (const auto origin = table->numbers("origin", 3, kPlace))
      out.origin_mm = Vec3((*origin)[0], (*origin)[1], (*origin)[2]);
    out.clocking_rad = radians(table->optional_number("clocking", kTurn).value_or(0));
    (void)table->optional_integer("touches", kTouches);
    (void)table->optional_number("residual_um", kRest);
    table->finish();
  }
  root.finish();
  if (findings.errors.empty()) return out;
  toml::sort_by_position(findings.errors);
  return findings.errors.front();
}

std::string measured_setup_text(const MeasuredSetup& measured, std::size_t touches, double residual_mm) {
  const Vec3& o = measured.origin_mm;
  return fmt::format(
      "# Where the part stands: name this file in the job, [setup] measured = \"..\".\n"
      "[measured]\n"
      "origin = [{:.6f}, {:.6f}, {:.6f}]  # mm, of the gear frame in machine coordinates, all rotaries at zero\n"
      "clocking = {:.7f}  # deg, turn of the teeth about gear z\n"
      "touches = {}\n"
      "residual_um = {:.3f}  # largest that these numbers leave of a touch\n",
      o.x(), o.y(), o.z(), degrees(measured.clocking_rad), touches, residual_mm * 1000);
}

void take_measured(toml::TableReader& table, const std::string& name, Job& job, joints::Setup& setup) {
  const auto path = (std::filesystem::path(job.directory()) / name).string();
  const auto text = toml::read_input_file(path, kMostBytes);
  if (!text) return table.refuse("measured", "measured = \"{}\": {}", name, text.error().message);
  const auto measured = parse_measured_setup(*text, name);
  if (!measured) {
    const auto& at = measured.error().position;
    return table.refuse("measured", "measured = \"{}\", line {}, column {}: {}", name, at.line, at.column,
                        measured.error().message);
  }
  const Vec3 moved = measured->origin_mm - setup.origin_mm;
  if (!(moved.norm() <= inspection::kFarthestMoved))
    return table.refuse("measured",
                        "measured = \"{}\": origin = [{:.3f}, {:.3f}, {:.3f}] lies {:.3f} mm from that of the job, at "
                        "most {:g} mm: another set-up or unit; state its origin in [setup]",
                        name, measured->origin_mm.x(), measured->origin_mm.y(), measured->origin_mm.z(), moved.norm(),
                        inspection::kFarthestMoved);
  const int teeth = std::visit([](const auto& gear) { return gear.teeth; }, job.gear);
  const double half_pitch = teeth > 0 ? kPi / teeth : kPi;
  if (!(std::abs(measured->clocking_rad) <= half_pitch))
    return table.refuse("measured",
                        "measured = \"{}\": clocking = {:g} deg exceeds {:g} deg, half a pitch of {} teeth: take whole "
                        "pitches off, they are other teeth",
                        name, degrees(measured->clocking_rad), degrees(half_pitch), teeth);
  setup.origin_mm = measured->origin_mm;
  setup.clocking_rad = measured->clocking_rad;
  setup.measured_file = name;
  job.warnings.push_back(
      fmt::format("the part stands as measured in {}: origin [{:.4f}, {:.4f}, {:.4f}], ({:+.4f}, {:+.4f}, {:+.4f}) mm "
                  "from that of the job, teeth turned by {:+.5f} deg; program and proof are for this part alone",
                  name, setup.origin_mm.x(), setup.origin_mm.y(), setup.origin_mm.z(), moved.x(), moved.y(), moved.z(),
                  degrees(setup.clocking_rad)));
}

}  // namespace toothpath::job
