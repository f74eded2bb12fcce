#include "app/process/milled/toothed_process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/process/milled/bodies.h"
#include "app/process/milled/milling.h"
#include "app/report/page/study_page.h"
#include "app/report/page/tool_body.h"
#include "cam/analytic/gear_distance.h"
#include "cam/ball/plan.h"
#include "cam/rest/toothed_blank.h"
#include "geometry/exchange/tooth_shell.h"
#include "geometry/tooth_space/limits.h"
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

Diagnostic no_contact(const job::Job& job) {
  return fail_at(job.where("gear.type"),
                 "type = \"{}\": contact is not there yet for it; it rolls face_gear and equal_base_circle_bevel_gear",
                 job.gear_type());
}

/// With the rows that the gear type adds to the ledger.
class ToothedMilling final : public Milling {
 public:
  ToothedMilling(const job::Job& job, const machines::Machine& machine, const ToothedGear& gear,
                 const proof::ProofLimits& limits, const process::FlankGrid& grid)
      : Milling(job, machine, analytic::GearDistance(gear.part, ball::reach_of(job.tools)), gear.body, limits, grid),
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

Result<process::Correction> ToothedProcess::correct(const job::MeasuredInput&, app::StageClock&) {
  return process::needs_face_gear(job_);
}
page::GearOnPage ToothedProcess::on_page(const std::string& machine_name) const {
  page::GearOnPage out;
  out.subtitle = gear_.subtitle + ", " + machine_name;
  for (const auto& tool : job_.tools) out.tools.push_back(page::page_end_mill(tool));
  return out;
}
Result<process::SceneGear> ToothedProcess::scene(double clearance_mm) const {
  process::SceneGear out{gear_.facts.teeth, clearance_mm, {}, [part = gear_.part](const Vec3& tip) {
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
rest::Blank ToothedProcess::blank() const { return rest::blank_of(gear_.solid); }
Result<exchange::GearShell> ToothedProcess::shell() const { return exchange::tooth_shell(gear_.solid); }
Status ToothedProcess::write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>&, app::StageClock& clock,
                                   std::vector<std::string>& files) const {
  process::GearFiles to(output, files);
  if (const auto s = to.write("limits.json", gear_.limits_json()); !s) return s;
  const auto& charts = gear_.limit_charts;
  for (std::size_t zone = 0; zone < charts.size(); ++zone)
    if (const auto s = to.write(charts.size() == 1 ? "limits.svg" : fmt::format("limits_{}.svg", zone),
                                page::standalone_svg(charts[zone]));
        !s)
      return s;
  return write_bodies(
      to, gear_.solid, job_.name, [&] { return inspection_text(); }, surface, clock);
}
std::unique_ptr<process::GearMilling> ToothedProcess::milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock& clock) const {
  return clock.run("distance index",
                   [&] { return std::make_unique<ToothedMilling>(job_, machine, gear_, limits, grid); });
}
process::ValueOrErrors<process::CutFlanks> ToothedProcess::shaped(const process::FlankGrid&) const {
  return std::vector{process::needs_face_gear(job_)};
}
Status ToothedProcess::accepts(const process::ContactAsked&) const { return no_contact(job_); }
process::ValueOrErrors<process::ContactFound> ToothedProcess::contact(const process::ContactAsked&,
                                                                      const process::CutFlanks*,
                                                                      app::StageClock&) const {
  return std::vector{no_contact(job_)};
}

std::unique_ptr<process::GearProcess> toothed_process(const job::Job& job, ToothedGear gear) {
  return std::make_unique<ToothedProcess>(job, std::move(gear));
}

}  // namespace toothpath::milled
