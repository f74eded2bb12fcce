#include "app/process/cylinder/process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/process/cylinder/limits.h"
#include "app/process/milled/bodies.h"
#include "app/process/milled/milling.h"
#include "app/report/page/study_page.h"
#include "app/report/page/tool_body.h"
#include "app/report/svg/html_text.h"
#include "cam/analytic/gear_distance.h"
#include "cam/ball/plan.h"
#include "cam/rest/toothed_blank.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "geometry/exchange/tooth_shell.h"

namespace toothpath::cylinder {
namespace {

using cylindrical::CylindricalGear;
using cylindrical::CylindricalParameters;

std::string gear_words(const CylindricalGear& gear) {
  const CylindricalParameters& p = gear.parameters();
  std::string text = fmt::format(
      "cylindrical gear, z {}, {} module {:g} mm, pressure angle {:g} deg, "
      "profile shift {:g}, tip diameter {:.3f} mm",
      p.teeth, p.module_plane == ModulePlane::normal ? "normal" : "transverse", p.module_mm,
      degrees(p.pressure_angle_rad), p.profile_shift, gear.tip_diameter());
  for (const auto& zone : p.zones)
    text += fmt::format(
        "; z {:g} to {:g} mm, {}", zone.from_mm, zone.to_mm,
        zone.helix_angle_rad == 0 ? std::string("spur") : fmt::format("helix {:g} deg", degrees(zone.helix_angle_rad)));
  return text;
}

double lower_end(const CylindricalGear& gear) { return gear.parameters().zones.front().from_mm; }
double upper_end(const CylindricalGear& gear) { return gear.parameters().zones.back().to_mm; }

/// Links and rapids keep clear of the blank: a cylinder, its bore closed.
milled::GearBody body_of(const CylindricalGear& gear, const tooth_space::ToothedPart& part) {
  const double r = 0.5 * gear.tip_diameter();
  milled::GearBody body;
  body.teeth = part.teeth();
  body.outer_radius_mm = r;
  body.blank_top_mm = part.blank_top();
  body.links = {r, lower_end(gear), upper_end(gear)};
  body.rapids = {r, 0, upper_end(gear), lower_end(gear)};
  body.in_blank = [&part](const Vec3& p) { return part.in_blank(p); };
  return body;
}

class CylinderProcess final : public process::GearProcess {
 public:
  CylinderProcess(const job::Job& job, CylindricalGear gear)
      : job_(job), gear_(std::move(gear)), toothed_(cylindrical::part_of(gear_)) {
    facts_ = {gear_.parameters().teeth, gear_.tip_diameter(), gear_.tip_diameter(), {}};
  }

  [[nodiscard]] const process::PartFacts& part() const override { return facts_; }
  [[nodiscard]] Result<process::Correction> correct(const job::MeasuredInput&, app::StageClock&) override {
    return process::needs_face_gear(job_);
  }
  [[nodiscard]] joints::ClearanceBody link_body(const machines::Machine&) const override {
    return body_of(gear_, *toothed_).links;
  }
  [[nodiscard]] sheet::PartOutline outline() const override {
    sheet::PartOutline out{0.5 * gear_.root_diameter(),
                           0.5 * gear_.tip_diameter(),
                           upper_end(gear_),
                           lower_end(gear_),
                           lower_end(gear_),
                           gear_words(gear_)};
    out.around = true;
    return out;
  }
  [[nodiscard]] page::GearOnPage on_page(const std::string& machine_name) const override {
    const CylindricalParameters& p = gear_.parameters();
    page::GearOnPage out;
    out.subtitle = fmt::format("cylindrical gear z {}, module {} mm, {}, {}", p.teeth, svg::short_number(p.module_mm),
                               p.zones.size() > 1                       ? "double helical"
                               : p.zones.front().helix_angle_rad == 0.0 ? "spur"
                                                                        : "helical",
                               machine_name);
    for (const auto& tool : job_.tools) out.tools.push_back(page::page_end_mill(tool));
    return out;
  }
  [[nodiscard]] std::vector<svg::LineChart> limit_charts() const override { return cylinder::limit_charts(gear_); }
  [[nodiscard]] Result<process::SceneGear> scene(double clearance_mm) const override {
    process::SceneGear out{facts_.teeth, clearance_mm, {}, [gear = gear_](const Vec3& tip) {
                             // The helix of the nearest zone; z of a groove counts to the lower
                             // one.
                             const auto& zones = gear.parameters().zones;
                             int zone = 0;
                             for (int k = 1; k < gear.zones(); ++k)
                               if (tip.z() >= zones[std::size_t(k)].from_mm) zone = k;
                             return std::atan2(tip.y(), tip.x()) - gear.space(zone).kernel().kappa * tip.z();
                           }};
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
  [[nodiscard]] rest::Blank blank() const override { return rest::blank_of(drawn_solid(gear_)); }
  [[nodiscard]] Result<exchange::GearShell> shell() const override { return exchange::tooth_shell(drawn_solid(gear_)); }
  [[nodiscard]] Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>&, app::StageClock& clock,
                                   std::vector<std::string>& files) const override {
    process::GearFiles to(output, files);
    if (const auto s = to.write("limits.json", limits_json(gear_)); !s) return s;
    const auto charts = cylinder::limit_charts(gear_);
    for (std::size_t zone = 0; zone < charts.size(); ++zone)
      if (const auto s = to.write(charts.size() == 1 ? "limits.svg" : fmt::format("limits_{}.svg", zone),
                                  page::standalone_svg(charts[zone]));
          !s)
        return s;
    return milled::write_bodies(to, drawn_solid(gear_), job_.name, surface, clock);
  }
  [[nodiscard]] std::unique_ptr<process::GearMilling> milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock& clock) const override {
    return clock.run("distance index", [&] {
      return std::make_unique<milled::Milling>(job_, machine,
                                               analytic::GearDistance(toothed_, ball::reach_of(job_.tools)),
                                               body_of(gear_, *toothed_), limits, grid);
    });
  }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped(const process::FlankGrid&) const override {
    return std::vector{process::needs_face_gear(job_)};
  }
  [[nodiscard]] Status accepts(const process::ContactAsked&) const override { return no_contact(); }
  [[nodiscard]] process::ValueOrErrors<process::ContactFound> contact(const process::ContactAsked&,
                                                                      const process::CutFlanks*,
                                                                      app::StageClock&) const override {
    return std::vector{no_contact()};
  }
  [[nodiscard]] std::string contact_section(const std::vector<proof::SurfaceGrid>&,
                                            std::vector<std::string>&) const override {
    return {};
  }

 private:
  [[nodiscard]] Diagnostic no_contact() const {
    return fail_at(job_.where("gear.type"),
                   "type = \"cylindrical_gear\": contact is not there yet for "
                   "it; it rolls face_gear and "
                   "equal_base_circle_bevel_gear");
  }

  const job::Job& job_;
  CylindricalGear gear_;
  std::shared_ptr<const tooth_space::ToothedPart> toothed_;
  process::PartFacts facts_;
};

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_cylindrical_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return std::unique_ptr<process::GearProcess>(std::make_unique<CylinderProcess>(job, std::move(made).value()));
}

}  // namespace toothpath::cylinder
