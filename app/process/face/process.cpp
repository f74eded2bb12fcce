#include "app/process/face/process.h"

#include <algorithm>
#include <cmath>

#include "app/job/measured_file.h"
#include "app/process/face/body.h"
#include "app/process/face/contact.h"
#include "app/process/face/shaped_flanks.h"
#include "app/process/face/surface_files.h"
#include "app/process/milled/bodies.h"
#include "app/process/milled/milling.h"
#include "app/report/limits/chart.h"
#include "app/report/page/tool_body.h"
#include "app/report/svg/html_text.h"
#include "cam/analytic/gear_distance.h"
#include "cam/ball/plan.h"
#include "cam/rest/toothed_blank.h"
#include "geometry/exchange/tooth_shell.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/tooth_touches.h"

namespace toothpath::face {
namespace {

std::string gear_words(const face_gear::FaceGearParameters& p) {
  const char* plane = p.module_plane == face_gear::ModulePlane::normal ? "normal" : "transverse";
  std::string text = fmt::format(
      "face gear, z {}, shaper z {}, {} module {:g} mm, pressure angle {:g} deg, shaft angle {:g} deg", p.teeth,
      p.shaper_teeth, plane, p.module_mm, degrees(p.pressure_angle_rad), degrees(p.shaft_angle_rad));
  if (p.offset_mm != 0) text += fmt::format(", offset {:g} mm", p.offset_mm);
  for (const auto& zone : p.zones)
    text += fmt::format(
        "; radius {:g} to {:g} mm, {}", zone.inner_radius_mm, zone.outer_radius_mm,
        zone.helix_angle_rad == 0 ? "spur" : fmt::format("shaper helix {:g} deg", degrees(zone.helix_angle_rad)));
  return text;
}

class FaceProcess final : public process::GearProcess {
 public:
  FaceProcess(const job::Job& job, face_gear::FaceGear gear) : job_(job), gear_(std::move(gear)) { note_part(); }

  [[nodiscard]] const process::PartFacts& part() const override { return part_; }
  [[nodiscard]] Result<process::Correction> correct(const job::MeasuredInput& measured,
                                                    app::StageClock& clock) override {
    auto corrected = clock.run("correction", [&] { return job::correct_gear(gear_, measured); });
    if (!corrected) return corrected.error();
    process::Correction out;
    for (const auto& f : corrected->fit.flanks) out.rows.push_back({f.zone, f.side, f.file, f.teeth, f.residual});
    out.index = corrected->fit.index;
    out.warnings = corrected->fit.warnings;
    out.json = job::correction_json(*corrected);
    gear_ = std::move(corrected->gear);
    note_part();
    return out;
  }
  [[nodiscard]] joints::ClearanceBody link_body(const machines::Machine&) const override {
    return body_of(gear_).links;
  }
  [[nodiscard]] sheet::PartOutline outline() const override {
    const double root = gear_.lowest_root();
    return {gear_.inner_radius(),          gear_.outer_radius(),          gear_.blank_top(), root,
            face_gear::underside_z(gear_), gear_words(gear_.parameters())};
  }
  [[nodiscard]] page::GearOnPage on_page(const std::string& machine_name) const override {
    const face_gear::FaceGearParameters& p = gear_.parameters();
    page::GearOnPage out;
    out.subtitle = fmt::format("face gear {}/{}, module {} mm, {}", p.shaper_teeth, p.teeth,
                               svg::short_number(p.module_mm), machine_name);
    for (const auto& tool : job_.tools) out.tools.push_back(page::page_end_mill(tool));
    return out;
  }
  [[nodiscard]] std::vector<svg::LineChart> limit_charts() const override { return limits::limit_charts(gear_); }
  [[nodiscard]] Result<process::SceneGear> scene(double clearance_mm) const override {
    // Spaces are radial enough to count teeth by the tip's azimuth.
    process::SceneGear out{part_.teeth, clearance_mm, {}, [](const Vec3& tip) { return std::atan2(tip.y(), tip.x()); }};
    for (const auto& tool : job_.tools) out.bodies.push_back(clearance::mesh_bodies(tool));
    return out;
  }
  [[nodiscard]] Result<process::FinishedGear> solid() const override {
    auto made = milled::finished_gear(drawn_solid(gear_));
    if (!made) return process::located(job_, "gear", made.error());
    return made;
  }
  [[nodiscard]] Result<mesh::TriangleMesh> mesh() const override { return milled::gear_mesh(drawn_solid(gear_)); }
  [[nodiscard]] Result<mesh::TriangleMesh> pitch_mesh(process::FacetSize size) const override {
    auto pitch = milled::pitch_mesh(drawn_solid(gear_), size);
    if (!pitch) return process::located(job_, "gear", pitch.error());
    return pitch;
  }
  [[nodiscard]] rest::Blank blank() const override {
    return rest::blank_of(drawn_solid(gear_), gear_.parameters().allowance_top_mm);
  }
  [[nodiscard]] Result<exchange::GearShell> shell() const override { return exchange::tooth_shell(drawn_solid(gear_)); }
  [[nodiscard]] Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>& assumed, app::StageClock& clock,
                                   std::vector<std::string>& files) const override {
    return write_surface_files(output, gear_, job_.name, surface, assumed, clock, files);
  }
  [[nodiscard]] std::unique_ptr<process::GearMilling> milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock& clock) const override {
    return clock.run("distance index", [&] {
      return std::make_unique<milled::Milling>(
          job_, machine, analytic::GearDistance(face_gear::part_of(gear_), ball::reach_of(job_.tools)), body_of(gear_),
          limits, grid, part_.modified);
    });
  }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped(const process::FlankGrid& grid) const override {
    auto places = places_on(job_, gear_, grid.rows, grid.columns);
    if (auto* errors = places.refused()) return std::move(*errors);
    return shaped_flanks(job_, gear_, std::move(places).value());
  }
  [[nodiscard]] std::unique_ptr<inspection::TouchedPart> touched() const override {
    return std::make_unique<inspection::TouchedTeeth>(drawn_solid(gear_), gear_.parameters().allowance_top_mm);
  }
  [[nodiscard]] Status accepts(const process::ContactAsked&) const override { return Ok{}; }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> measured(const job::MeasuredInput& files) const override {
    return measured_flanks(gear_, files);
  }
  [[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> toothed() const override {
    return face_gear::part_of(gear_);
  }
  [[nodiscard]] process::ValueOrErrors<process::ContactFound> contact(const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock) const override {
    return roll_pair(job_, gear_, asked, cut, clock);
  }
  [[nodiscard]] std::string contact_section(const std::vector<proof::SurfaceGrid>& surface,
                                            std::vector<std::string>& warnings) const override {
    return face::contact_section(job_, gear_, surface, warnings);
  }

 private:
  void note_part() {
    part_ = {gear_.parameters().teeth, 2 * gear_.outer_radius(), 2 * gear_.outer_radius(), gear_.warnings()};
    report::ModifiedFlanks modified{gear_.parameters().modifications, {}};
    for (std::size_t zone = 0; zone < gear_.rings().size(); ++zone)
      if (const auto& form = gear_.rings()[zone].form) modified.zones.push_back({static_cast<int>(zone), *form});
    if (!modified.zones.empty()) part_.modified = std::move(modified);
  }

  const job::Job& job_;
  face_gear::FaceGear gear_;
  process::PartFacts part_;
};

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_face_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return std::unique_ptr<process::GearProcess>(std::make_unique<FaceProcess>(job, std::move(made).value()));
}

}  // namespace toothpath::face
