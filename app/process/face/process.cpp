#include "app/process/face/process.h"

#include <memory>
#include <utility>

#include "app/job/measured_file.h"
#include "app/process/face/body.h"
#include "app/process/face/contact.h"
#include "app/process/face/shaped_flanks.h"
#include "app/process/milled/toothed_process.h"
#include "app/report/limits/chart.h"
#include "app/report/limits/json.h"
#include "app/report/page/study_page.h"
#include "app/report/svg/html_text.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/dmis.h"
#include "geometry/tooth_space/limits.h"

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

std::vector<sheet::DataGroup> gear_data(const face_gear::FaceGear& gear, const face_gear::Body& body) {
  const face_gear::FaceGearParameters& p = gear.parameters();
  const bool normal = p.module_plane == face_gear::ModulePlane::normal;
  sheet::DataGroup whole{
      "Face gear",
      {sheet::data_number("z_2", "number of teeth", p.teeth),
       sheet::data_number("z_s", "teeth of the shaper", p.shaper_teeth),
       sheet::data_length(normal ? "m_n" : "m_t", normal ? "module, normal" : "module, transverse", p.module_mm),
       sheet::data_angle(normal ? "alpha_n" : "alpha_t", "pressure angle", p.pressure_angle_rad),
       sheet::data_angle("Sigma", "shaft angle", p.shaft_angle_rad),
       sheet::data_length("a", "offset of the axes", p.offset_mm),
       sheet::data_number("h_a*", "addendum, in modules", p.addendum_coefficient),
       sheet::data_number("c*", "clearance, in modules", p.clearance_coefficient),
       sheet::data_length("rho_s", "tip radius of the shaper", p.shaper_tip_radius_mm),
       sheet::data_length("j_n", "normal backlash", p.backlash_mm),
       sheet::data_length("d_o", "outside diameter of the teeth", 2 * gear.outer_radius()),
       sheet::data_length("d_i", "inside diameter of the teeth", 2 * gear.inner_radius())}};
  if (p.mate_teeth > 0) whole.rows.push_back(sheet::data_number("z_1", "teeth of the pinion", p.mate_teeth));
  if (body.thickness_mm > 0) whole.rows.push_back(sheet::data_length("H", "from tips to back", body.thickness_mm));
  if (body.bore_mm) whole.rows.push_back(sheet::data_length("", "bore", *body.bore_mm));
  if (body.hub_length_mm > 0) {
    whole.rows.push_back(sheet::data_length("d_h", "hub, diameter", body.hub_mm));
    whole.rows.push_back(sheet::data_length("l_h", "hub, length behind the back", body.hub_length_mm));
  }
  std::vector<sheet::DataGroup> out{std::move(whole)};
  const auto part = face_gear::part_of(gear);
  for (int zone = 0; zone < part->zones(); ++zone) {
    const auto& z = p.zones[std::size_t(zone)];
    const auto& space = part->space(zone);
    const auto root =
        tooth_space::place_at(space, tooth_space::Piece::root, 0.5, 0.5 * (z.inner_radius_mm + z.outer_radius_mm));
    sheet::DataGroup ring{
        part->zones() > 1 ? fmt::format("Zone {}", zone) : std::string("Ring of teeth"),
        {sheet::data_length("R_i", "inner radius", z.inner_radius_mm),
         sheet::data_length("R_o", "outer radius", z.outer_radius_mm),
         sheet::data_length("b", "face width", z.outer_radius_mm - z.inner_radius_mm),
         sheet::data_helix("beta", "helix angle of the shaper", z.helix_angle_rad),
         sheet::data_length("Z_a", "height of the tips along the gear axis, inner end", space.tip(z.inner_radius_mm)),
         sheet::data_length("Z_a", "the same, outer end", space.tip(z.outer_radius_mm))}};
    if (root)
      ring.rows.push_back(sheet::data_length("h", "tooth depth, middle of the face",
                                             space.tip(0.5 * (z.inner_radius_mm + z.outer_radius_mm)) - root->p.z()));
    out.push_back(std::move(ring));
  }
  return out;
}

using Owned = std::shared_ptr<const face_gear::FaceGear>;

milled::ToothedGear toothed(const Owned& owned, const face_gear::Body& body) {
  const face_gear::FaceGear& gear = *owned;
  const face_gear::FaceGearParameters& p = gear.parameters();
  milled::ToothedGear out;
  out.part = face_gear::part_of(gear);
  out.solid = drawn_solid(gear, body);
  out.owner = owned;
  out.facts = {p.teeth, 2 * gear.outer_radius(), 2 * gear.outer_radius(), gear.warnings()};
  report::ModifiedFlanks modified{p.modifications, {}};
  for (std::size_t zone = 0; zone < gear.rings().size(); ++zone)
    if (const auto& form = gear.rings()[zone].form) modified.zones.push_back({static_cast<int>(zone), *form});
  if (!modified.zones.empty()) out.facts.modified = std::move(modified);
  out.above_mm = p.allowance_top_mm;
  out.body = body_of(gear, body);
  out.outline = {gear.inner_radius(),
                 gear.outer_radius(),
                 gear.blank_top(),
                 gear.lowest_root(),
                 face_gear::underside_z(gear, body),
                 gear_words(p)};
  out.subtitle = fmt::format("face gear {}/{}, module {} mm", p.shaper_teeth, p.teeth, svg::short_number(p.module_mm));
  out.data = gear_data(gear, body);
  out.limits_json = [owned] { return limits::limits_json(*owned); };
  return out;
}

/// The pair with the pinion of its shaper, corrections of points, and what files and pages say of its limits.
class FaceProcess final : public milled::ToothedProcess {
 public:
  FaceProcess(const job::Job& job, Owned gear)
      : ToothedProcess(job, face::toothed(gear, job.face_body)), gear_(std::move(gear)) {}

  [[nodiscard]] Result<process::Correction> correct(const job::MeasuredInput& measured,
                                                    app::StageClock& clock) override {
    auto corrected = clock.run("correction", [&] { return job::correct_gear(*gear_, measured); });
    if (!corrected) return corrected.error();
    process::Correction out;
    for (const auto& f : corrected->fit.flanks) out.rows.push_back({f.zone, f.side, f.file, f.teeth, f.residual});
    out.index = corrected->fit.index;
    out.warnings = corrected->fit.warnings;
    out.json = job::correction_json(*corrected);
    gear_ = std::make_shared<const face_gear::FaceGear>(std::move(corrected->gear));
    become(face::toothed(gear_, job().face_body));
    return out;
  }
  [[nodiscard]] std::vector<svg::LineChart> limit_charts() const override { return limits::limit_charts(*gear_); }
  [[nodiscard]] Result<process::SceneGear> scene(double clearance_mm) const override {
    auto out = ToothedProcess::scene(clearance_mm);
    // Spaces are radial enough to count teeth by the tip's azimuth.
    if (out) out->azimuth = [](const Vec3& tip) { return azimuth(tip); };
    return out;
  }
  [[nodiscard]] Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>& assumed, app::StageClock& clock,
                                   std::vector<std::string>& files) const override {
    process::GearFiles to(output, files);
    if (const auto s = to.write("limits.json", limits_json()); !s) return s;
    if (const auto s = to.write("data_sheet.html", sheet::data_sheet_html(data_sheet())); !s) return s;
    if (const auto s = to.write("limits.html", limits::limits_page(*gear_, job().name, assumed)); !s) return s;
    const auto charts = limit_charts();  // two a zone
    for (std::size_t zone = 0; 2 * zone < charts.size(); ++zone)
      if (const auto s = to.write(charts.size() == 2 ? "limits.svg" : fmt::format("limits_{}.svg", zone),
                                  page::standalone_svg(charts[2 * zone]));
          !s)
        return s;
    const auto flanks = inspected();
    if (!flanks) return flanks.error();
    if (const auto s = to.write("inspection.dmi", inspection::inspection_dmis(*gear_, flanks->points, job().name)); !s)
      return s;
    return milled::write_bodies(
        to, gear().solid, job().name, [&] { return inspected(); }, surface, clock);
  }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped(const process::FlankGrid& grid) const override {
    auto places = places_on(job(), *gear_, grid.rows, grid.columns);
    if (auto* errors = places.refused()) return std::move(*errors);
    return shaped_flanks(job(), *gear_, std::move(places).value());
  }
  [[nodiscard]] Status accepts(const process::ContactAsked&) const override { return Ok{}; }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> measured(const job::MeasuredInput& files) const override {
    return measured_flanks(*gear_, files);
  }
  [[nodiscard]] process::ValueOrErrors<process::ContactFound> contact(const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock) const override {
    return roll_pair(job(), *gear_, asked, cut, clock);
  }
  [[nodiscard]] std::string contact_section(const std::vector<proof::SurfaceGrid>& surface,
                                            std::vector<std::string>& warnings) const override {
    return face::contact_section(job(), *gear_, surface, warnings);
  }

 private:
  Owned gear_;
};

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_face_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return std::unique_ptr<process::GearProcess>(
      std::make_unique<FaceProcess>(job, std::make_shared<const face_gear::FaceGear>(std::move(made).value())));
}

}  // namespace toothpath::face
