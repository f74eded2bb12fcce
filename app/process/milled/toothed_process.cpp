#include "app/process/milled/toothed_process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/job/measured_file.h"
#include "app/process/milled/bodies.h"
#include "app/process/milled/milling.h"
#include "app/report/page/study_page.h"
#include "app/report/page/tool_body.h"
#include "cam/analytic/gear_distance.h"
#include "cam/ball/plan.h"
#include "cam/rest/toothed_blank.h"
#include "geometry/exchange/tooth_shell.h"
#include "geometry/inspection/grid.h"
#include "geometry/inspection/tooth_touches.h"
#include "geometry/tooth_space/limits.h"
#include "geometry/tooth_space/modified_form.h"
#include "geometry/tooth_space/modified_part.h"
#include "geometry/tooth_space/zone_next_to.h"

namespace toothpath::milled {
namespace {

/// Of the root's middle in the zone next to a place.
double azimuth_of_space(const tooth_space::ToothedPart& part, const Vec3& p) {
  const double s = part.chart().along(p);
  const int zone = tooth_space::zone_next_to(part, s);
  const tooth_space::Outline& ring = part.space(zone).outline();
  const auto root =
      tooth_space::place_at(part.space(zone), tooth_space::Piece::root, 0.5, std::clamp(s, ring.s_from, ring.s_to));
  return root ? azimuth(root->p) : 0;
}

Diagnostic needs_mate(const job::Job& job) {
  return fail_at(job.where("gear.type"),
                 "type = \"{}\" rolls with a mate that has a job of its own: --mate JOB is needed", job.gear_type());
}

/// With the rows that the gear type adds to the ledger.
class ToothedMilling final : public Milling {
 public:
  /// @param aimed  the gear's part, or what its flanks answer to a measurement
  ToothedMilling(const job::Job& job, const machines::Machine& machine, const ToothedGear& gear,
                 std::shared_ptr<const tooth_space::ToothedPart> aimed, const proof::ProofLimits& limits,
                 const process::FlankGrid& grid)
      : Milling(job, machine, analytic::GearDistance(std::move(aimed), ball::reach_of(job.tools)), gear.body, limits,
                grid, gear.facts.modified),
        rows_(gear.ledger) {}
  [[nodiscard]] std::vector<proof::LedgerEntry> ledger(const joints::AxisProgram& program,
                                                       const process::ProgramProof& proof,
                                                       double blend_mm) const override {
    std::vector<proof::LedgerEntry> out = Milling::ledger(program, proof, blend_mm);
    out.insert(out.end(), rows_.begin(), rows_.end());
    return out;
  }

 private:
  std::vector<proof::LedgerEntry> rows_;
};

}  // namespace

Status ToothedProcess::modify() {
  if (job_.modifications.empty()) return Ok{};
  auto drawn = tooth_space::modified_part(gear_.part, job_.modifications);
  if (auto* refusal = drawn.refused())
    return process::located(job_, "gear." + refusal->key, std::move(refusal->diagnostic));
  report::ModifiedFlanks modified{job_.modifications, {}};
  for (int zone = 0; zone < gear_.part->zones(); ++zone) {
    if (&(*drawn)->space(zone) == &gear_.part->space(zone)) continue;
    const auto form = tooth_space::modified_form(gear_.part->space(zone), (*drawn)->space(zone));
    if (auto refusal = tooth_space::refused(form, zone))
      return process::located(job_, "gear." + refusal->key, std::move(refusal->diagnostic));
    if (auto narrow = tooth_space::narrow_land(form, zone, gear_.least_land_mm); !narrow.empty())
      gear_.facts.warnings.push_back(std::move(narrow));
    modified.zones.push_back({zone, form});
  }
  if (modified.zones.empty()) return Ok{};  // all amounts are zero
  gear_.facts.modified = std::move(modified);
  aimed_ = drawn_ = std::move(drawn).value();
  for (auto& ring : gear_.solid.rings) ring.space = &drawn_->space(ring.zone);
  return Ok{};
}
Result<process::Correction> ToothedProcess::correct(const job::MeasuredInput& measured, app::StageClock& clock) {
  return clock.run("correction", [&] { return answer(measured); });
}
job::GridOfGear ToothedProcess::measured_grid() const {
  job::GridOfGear grid;
  grid.zones = std::size_t(gear_.part->zones());
  grid.solid = gear_.solid;
  grid.nominal = [this](int rows, int columns) { return inspection::inspection_grid(gear_.solid, {rows, columns}); };
  std::vector<std::optional<tooth_space::FlankRectangle>> flanks_of_zones;
  for (int zone = 0; zone < gear_.part->zones(); ++zone)
    for (const int side : {1, -1})
      flanks_of_zones.push_back(tooth_space::flank_rectangle(gear_.part->space(zone), side));
  grid.place = [this, flanks_of_zones](const inspection::InspectionPoint& at) -> Vec2 {
    const auto& flank = flanks_of_zones[std::size_t(2 * at.zone + (at.side > 0 ? 0 : 1))];
    const Vec2 share = flank ? flank->share_at(gear_.part->space(at.zone), at.p) : Vec2(NAN, NAN);
    return {share.x(), -share.y()};
  };
  grid.foot = [](int) { return -1.0; };
  return grid;
}
process::ValueOrErrors<process::CutFlanks> ToothedProcess::measured(const job::MeasuredInput& measured) const {
  constexpr int kRows = 21, kColumns = 25;
  const job::GridOfGear grid = measured_grid();
  const auto fitted = job::fit_measured(measured, grid);
  if (!fitted) return std::vector{fitted.error()};
  const auto places = inspection::inspection_grid(gear_.solid, {kRows, kColumns, 0});
  if (!places) return std::vector{places.error()};
  process::CutFlanks out;
  out.route = "measured";
  for (int zone = 0; zone < gear_.part->zones(); ++zone)
    for (const int side : {1, -1}) {
      process::CutFlanks::Flank flank{zone, side, kRows, kColumns, {}, {}, {}};
      for (const inspection::InspectionPoint& at : *places) {
        if (at.zone != zone || at.side != side) continue;
        flank.nominal.push_back(at.p);
        flank.normals.push_back(at.n);
        flank.deviation_mm.push_back(fitted->deviation_mm(zone, side, grid.place(at)));
      }
      out.flanks.push_back(std::move(flank));
    }
  for (const auto& f : fitted->flanks) out.warnings.push_back(process::words_of_fit(f.zone, f.side, f.residual));
  return out;
}
Result<process::Correction> ToothedProcess::answer(const job::MeasuredInput& measured) {
  const job::GridOfGear grid = measured_grid();
  auto fitted = job::fit_measured(measured, grid);
  if (!fitted) return fitted.error();
  process::Correction out;
  const job::FittedCorrection& fit = *fitted;
  out.index = fit.index;
  out.warnings = fit.warnings;
  auto aimed = tooth_space::modified_part(gear_.part, job_.modifications, fit.rings);
  if (auto* refusal = aimed.refused())
    return process::located(job_, "gear." + refusal->key, std::move(refusal->diagnostic));
  aimed_ = std::move(aimed).value();
  for (const auto& f : fit.flanks) out.rows.push_back({f.zone, f.side, f.file, f.teeth, f.residual});
  const auto shown = inspection::inspection_grid(gear_.solid);
  if (!shown) return shown.error();
  out.json = job::correction_json(measured.files, fit.flanks, *shown, [&](const inspection::InspectionPoint& at) {
    const Vec2 place = grid.place(at);
    return fit.rings[std::size_t(at.zone)]->side(at.side).at(-place.y(), place.x()).value;
  });
  return out;
}
page::GearOnPage ToothedProcess::on_page(const std::string& machine_name) const {
  page::GearOnPage out;
  out.subtitle = gear_.subtitle + ", " + machine_name;
  for (const auto& tool : job_.tools) out.tools.push_back(page::page_end_mill(tool));
  return out;
}
Result<process::InspectedFlanks> ToothedProcess::inspected(const process::GridAsked& asked) const {
  process::InspectedFlanks out{asked.instead_of({}), {}, {}};
  auto points = inspection::inspection_grid(gear_.solid, out.grid);
  if (!points) return points.error();
  out.points = std::move(*points);
  return out;
}
Result<process::SceneGear> ToothedProcess::scene(double clearance_mm) const {
  process::SceneGear out{gear_.facts.teeth, clearance_mm, {}, [part = aimed_](const Vec3& tip) {
                           return azimuth(tip) - azimuth_of_space(*part, tip);
                         }};
  for (const auto& tool : job_.tools) out.bodies.push_back(clearance::mesh_bodies(tool));
  return out;
}
Result<process::FinishedGear> ToothedProcess::solid() const {
  auto made = finished_gear(gear_.solid);
  if (!made) return process::located(job_, "gear", made.error());
  return made;
}
Result<mesh::TriangleMesh> ToothedProcess::mesh() const { return gear_mesh(gear_.solid); }
Result<mesh::TriangleMesh> ToothedProcess::pitch_mesh(process::FacetSize size) const {
  auto pitch = milled::pitch_mesh(gear_.solid, size);
  if (!pitch) return process::located(job_, "gear", pitch.error());
  return pitch;
}
rest::Blank ToothedProcess::blank() const { return rest::blank_of(gear_.solid, gear_.above_mm); }
Result<exchange::GearShell> ToothedProcess::shell() const { return exchange::tooth_shell(gear_.solid); }
Status ToothedProcess::write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>&, app::StageClock& clock,
                                   std::vector<std::string>& files) const {
  process::GearFiles to(output, files);
  if (const auto s = to.write("limits.json", limits_json()); !s) return s;
  if (const auto s = to.write("data_sheet.html", sheet::data_sheet_html(data_sheet())); !s) return s;
  const auto& charts = gear_.limit_charts;
  for (std::size_t zone = 0; zone < charts.size(); ++zone)
    if (const auto s = to.write(charts.size() == 1 ? "limits.svg" : fmt::format("limits_{}.svg", zone),
                                page::standalone_svg(charts[zone]));
        !s)
      return s;
  return write_bodies(
      to, gear_.solid, job_.name, [&] { return inspected(); }, surface, clock);
}
sheet::DataSheet ToothedProcess::data_sheet() const {
  sheet::DataSheet out{job_.name, job_.file, gear_.outline.words, gear_.data};
  std::vector<ThicknessPlace> places = gear_.measured_at;
  if (places.empty())
    for (const auto& ring : gear_.solid.rings) places.push_back(middle_of_zone(gear_.solid, ring.zone));
  for (sheet::DataGroup& group : tooth_data(gear_.solid, places)) out.groups.push_back(std::move(group));
  if (job_.verify.form_tolerance_mm)
    out.groups.push_back({"Quality",
                          {{"f_f_alpha",
                            job_.verify.iso_class ? fmt::format("form tolerance of the flanks, ISO 1328-1 class {}",
                                                                *job_.verify.iso_class)
                                                  : std::string("form tolerance of the flanks"),
                            fmt::format("{:.2f} um", 1000 * *job_.verify.form_tolerance_mm)}}});
  if (gear_.facts.modified)
    out.notes.push_back(fmt::format("The flanks are modified ({}); the measures of the tooth contain that.",
                                    gear_.facts.modified->list.size()));
  out.notes.push_back(
      "Measures of the tooth are those of the exact flanks of the drawing, without a tolerance of thickness but what "
      "the job states.");
  return out;
}
std::unique_ptr<process::GearMilling> ToothedProcess::milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock& clock) const {
  return clock.run("distance index",
                   [&] { return std::make_unique<ToothedMilling>(job_, machine, gear_, aimed_, limits, grid); });
}
process::ValueOrErrors<process::CutFlanks> ToothedProcess::shaped(const process::FlankGrid&) const {
  return std::vector{process::needs_face_gear(job_)};
}
std::unique_ptr<inspection::TouchedPart> ToothedProcess::touched() const {
  return std::make_unique<inspection::TouchedTeeth>(gear_.solid, gear_.above_mm);
}
Status ToothedProcess::accepts(const process::ContactAsked&) const { return needs_mate(job_); }
process::ValueOrErrors<process::ContactFound> ToothedProcess::contact(const process::ContactAsked&,
                                                                      const process::CutFlanks*,
                                                                      app::StageClock&) const {
  return std::vector{needs_mate(job_)};
}

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> toothed_process(const job::Job& job, ToothedGear gear) {
  auto made = std::make_unique<ToothedProcess>(job, std::move(gear));
  if (auto modified = made->modify(); !modified) return std::vector{std::move(modified.error())};
  return std::unique_ptr<process::GearProcess>(std::move(made));
}

}  // namespace toothpath::milled
