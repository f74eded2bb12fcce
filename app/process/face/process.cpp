#include "app/process/face/process.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/job/measured_file.h"
#include "app/process/face/contact.h"
#include "app/process/face/ledger.h"
#include "app/process/face/proof.h"
#include "app/process/face/shaped_flanks.h"
#include "app/process/face/surface_files.h"
#include "app/process/proof_limits.h"
#include "app/report/limits/chart.h"
#include "app/report/page/tool_body.h"
#include "app/report/svg/html_text.h"
#include "cam/analytic/gouge_check.h"
#include "cam/cut/cut_surface.h"
#include "cam/cut/swept_tool.h"
#include "cam/plan/face_gear.h"
#include "cam/plan/first_ball.h"
#include "geometry/exchange/face_shell.h"
#include "geometry/mesh/tooth_mesh.h"
#include "postproc/joints/pole.h"

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

constexpr double kSolidSag = 0.02;    // mm
constexpr double kPictureSag = 0.02;  // of the module
constexpr double kLinkFeed = 6000;    // mm/min: of moves under feed through air, where the machine is no slower
constexpr double kSmallFirst = 0.7;   // of what the space admits: a first roughing tool that is told
constexpr double kBiasShare = 0.4;    // of the rounding, taken up by the poses: the rest is counted

cut::CutSurfaceOptions surface_options(const process::FlankGrid& grid) {
  cut::CutSurfaceOptions options;
  if (grid.rows > 0) options.flank_rows = grid.rows;
  if (grid.columns > 0) options.columns = grid.columns;
  return options;
}

plan::Options plan_options(const proof::ProofLimits& limits, const machines::Machine& machine, double outer_radius_mm) {
  plan::Options options;
  options.limits = limits;
  options.link_feed_mm_min = std::min(machine.max_cutting_feed, kLinkFeed);
  options.simultaneous_axes = machine.max_simultaneous_axes;
  options.line_bias_mm = line::kBias + kBiasShare * process::word_rounding(machine, outer_radius_mm);
  // `tilt` keeps what it asks between two records, too, where the axis dips by less than this margin.
  if (machine.post.pole == machines::PoleOption::tilt)
    options.least_tilt_rad =
        std::max(options.least_tilt_rad, machine.post.pole_angle_rad.value_or(joints::kLeastPoleTilt) + 1e-3);
  options.pole_is_passed =
      machine.post.pole != machines::PoleOption::error && machine.post.pole != machines::PoleOption::tilt;
  return options;
}

void add_side_passes(const line::LinePlan& plan, int operation, std::vector<report::PassReport>& out) {
  for (const auto& pass : plan.passes) {
    report::SidePass side{pass.side, pass.strip, to_string(plan.rotaries), pass.left_mm, pass.contact_top_mm, {}};
    for (const auto& s : pass.stations) side.stations.push_back({s.r, s.lean, s.tilt, s.misfit});
    std::string name = fmt::format("flank {:+d}", pass.side);
    if (plan.strips > 1) name += fmt::format(", strip {}", pass.strip);
    const int number = (pass.side > 0 ? 0 : plan.strips) + pass.strip;
    out.push_back(
        {operation, pass.zone, number, std::move(name), true, pass.contact_mm, pass.records.size(), std::move(side)});
  }
}

/// Passes that end before their flank does, and why.
std::vector<std::string> shortened_passes(const plan::FaceGearPlan& plan) {
  std::vector<std::string> out;
  for (std::size_t n = 0; n < plan.lines.size(); ++n) {
    if (!plan.lines[n]) continue;
    for (const line::LinePass& pass : plan.lines[n]->passes) {
      const auto& b = pass.shortened_by;
      if (!b) continue;
      std::string text = fmt::format(
          "operation {}: the pass on zone {}, flank {:+d} ends early: beyond its end the {} has a gap of {:.4f} mm to "
          "the {}, {:.4f} mm is the least; a wider groove, or a mill of smaller diameter or half_angle",
          n, pass.zone, pass.side, b->body, b->gap_mm, b->patch, b->least_mm);
      out.push_back(std::move(text));
    }
  }
  return out;
}

/// Modifications that bend a flank or a fillet so hollow that the ball of an operation no longer fits, where it would
/// fit the plain one.
std::optional<Diagnostic> ball_in_hollow(const job::Job& job, const face_gear::FaceGear& gear) {
  for (std::size_t n = 0; n < job.operations.size(); ++n) {
    const path::MillingOperation& op = job.operations[n];
    if (op.type != path::OperationType::finishing && op.type != path::OperationType::semi_finishing) continue;
    const double R = job.tools[std::size_t(op.tool)].radius_mm() + op.allowance_mm;
    for (std::size_t zone = 0; zone < gear.rings().size(); ++zone) {
      const auto& form = gear.rings()[zone].form;
      if (!form) continue;
      for (const auto& [region, what, most, plain] :
           {std::tuple(path::Region::flank, "flank", form->hollow_flank, form->plain_hollow_flank_mm),
            {path::Region::fillet, "fillet", form->hollow_fillet, form->plain_hollow_fillet_mm}}) {
        if (!op.regions[region] || most.value >= R || plain < R) continue;
        const auto key = fmt::format("operation[{}].tool", n);
        return process::located(
            job, key,
            fail("operation {}: the modifications make {} {:+d} of zone {} hollow with a radius of {:.4f} mm at radius "
                 "{:.4f} mm, height {:.4f} mm (plain: {:.4f} mm at least): a ball of {:.4f} mm does not fit; a smaller "
                 "ball, less amount or more length would do",
                 n, what, most.side, zone, most.value, most.radius_mm, most.height_mm, plain, R));
      }
    }
  }
  return std::nullopt;
}

class FaceMilling final : public process::GearMilling {
 public:
  FaceMilling(const job::Job& job, const machines::Machine& machine, const face_gear::FaceGear& gear,
              const proof::ProofLimits& limits, const process::FlankGrid& grid)
      : job_(job),
        limits_(limits),
        options_(plan_options(limits, machine, gear.outer_radius())),
        part_(gear, ball::reach_of(job.tools)),
        gouge_(part_, job.tools, {limits, gear.blank_top()}),
        check_(job, machine, limits, part_, gouge_, surface_options(grid)) {}

  [[nodiscard]] Status plan(app::StageClock& clock, app::Progress& progress) override {
    if (auto refused = ball_in_hollow(job_, part_.gear())) return std::move(*refused);
    plan::Options options = options_;
    options.stage = [&](const std::string& name, const std::function<void()>& work) { clock.run(name, work); };
    auto planned = clock.run("plan", [&] {
      return plan::plan_face_gear(part_, job_.tools, job_.operations, options,
                                  [&](const std::string& text) { progress.show(text); });
    });
    if (auto* refusal = planned.refused()) return process::located(job_, refusal->key, std::move(refusal->diagnostic));
    plan_ = std::move(planned).value();
    check_.shortened = shortened_passes(plan_);
    return Ok{};
  }
  [[nodiscard]] std::vector<const path::ClPath*> paths() const override {
    std::vector<const path::ClPath*> out;
    for (const auto& path : plan_.paths) out.push_back(&path);
    return out;
  }
  [[nodiscard]] std::vector<proof::DirectionChoice> directions() const override { return plan_.directions; }
  [[nodiscard]] std::vector<report::PassReport> passes() const override {
    std::vector<report::PassReport> out;
    for (std::size_t n = 0; n < plan_.lines.size(); ++n)
      if (plan_.lines[n]) add_side_passes(*plan_.lines[n], int(n), out);
    return out;
  }
  [[nodiscard]] std::vector<report::EngagementReport> engagement() const override {
    std::vector<report::EngagementReport> out;
    for (const plan::EngagementTrack& t : plan_.engagement)
      out.push_back(
          {t.operation, t.way_mm, t.engaged_rad, t.chip_mm, t.feed_mm_min, t.step_over_mm, t.beside_rad, t.opening_mm});
    return out;
  }
  [[nodiscard]] std::vector<std::string> advice() const override {
    if (plan_.paths.empty() || job_.operations.front().type != path::OperationType::roughing) return {};
    const path::MillingOperation& first = job_.operations.front();
    const tool::ToolAssembly& tool = job_.tools[std::size_t(first.tool)];
    const double admitted = plan::first_ball_mm(part_, first.allowance_mm, ball::reach_of(job_.tools));
    if (tool.diameter_mm >= kSmallFirst * admitted) return {};
    return {
        fmt::format("operation 0 roughs with tool {}, {:g} mm; the upper half of the tooth spaces, where most of "
                    "the material is, admits a ball of {:.2f} mm",
                    tool.number, tool.diameter_mm, admitted)};
  }
  [[nodiscard]] Result<proof::CheckedClPath> approve(const path::ClPath& path) const override {
    return gouge_.check_path(path);
  }
  [[nodiscard]] path::OperationType roughing() const override { return path::OperationType::roughing; }
  [[nodiscard]] rest::Excess roughed() const override {
    std::vector<rest::Excess> removed;
    for (const path::ClPath& path : plan_.paths) {
      if (job_.operations[std::size_t(path.operation)].type != roughing()) continue;
      const auto one = std::make_shared<const cut::Removed>(analytic::GougeCheck::motions_of(path),
                                                            tool::proof_tool(job_.tools[std::size_t(path.tool)]),
                                                            part_.gear().blank_top());
      removed.emplace_back([one](const Vec3& p, double cap) { return one->excess(p, cap); });
    }
    return rest::excess_of(std::move(removed));
  }
  [[nodiscard]] process::GearCheck& check() override { return check_; }
  [[nodiscard]] std::vector<proof::LedgerEntry> ledger(const joints::AxisProgram& program,
                                                       const process::ProgramProof& proof,
                                                       double blend_mm) const override {
    return face::ledger({part_, plan_, job_.tools, job_.operations, check_.surface}, program, proof,
                        {blend_mm, limits_.proof_mm, options_.line_bias_mm, *job_.setup});
  }
  [[nodiscard]] sheet::OtherSurface beside_the_grid() const override { return {}; }

 private:
  const job::Job& job_;
  proof::ProofLimits limits_;
  plan::Options options_;
  analytic::GearDistance part_;
  analytic::GougeCheck gouge_;
  FaceGearCheck check_;
  plan::FaceGearPlan plan_;
};

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
    return clearance_body(gear_);
  }
  [[nodiscard]] sheet::PartOutline outline() const override {
    const double root = gear_.lowest_root();
    return {gear_.inner_radius(),     gear_.outer_radius(),          gear_.blank_top(), root,
            mesh::underside_z(gear_), gear_words(gear_.parameters())};
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
    const auto pitch = mesh::mesh_tooth_space(gear_, kSolidSag);
    if (!pitch) return process::located(job_, "gear", pitch.error());
    process::FinishedGear out{
        mesh::join_copies(*pitch), {}, [root = gear_.lowest_root()](const Vec3& p) { return p.z() > root; }};
    out.teeth.resize(out.mesh.vertices.size());
    for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t)
      if (pitch->tags[t % pitch->tags.size()].patch != tooth_space::Piece::body)
        for (const auto vertex : out.mesh.triangles[t]) out.teeth[static_cast<std::size_t>(vertex)] = true;
    return out;
  }
  [[nodiscard]] Result<mesh::TriangleMesh> mesh() const override {
    const auto pitch = mesh::mesh_tooth_space(gear_, kStlSag);
    if (!pitch) return pitch.error();
    return mesh::join_copies(*pitch);
  }
  [[nodiscard]] Result<mesh::TriangleMesh> pitch_mesh(process::FacetSize size) const override {
    const double picture = kPictureSag * gear_.parameters().module_mm;
    auto pitch = mesh::mesh_tooth_space(gear_, size == process::FacetSize::picture ? picture : kStlSag);
    if (!pitch) return process::located(job_, "gear", pitch.error());
    return std::move(pitch->mesh);
  }
  [[nodiscard]] rest::Blank blank() const override {
    rest::Blank out;
    out.teeth = part_.teeth;
    const auto& rings = gear_.rings();
    for (std::size_t k = 0; k < rings.size(); ++k) {
      const auto& zone = rings[k].zone;
      out.rings.push_back({zone.inner_radius_mm, zone.outer_radius_mm,
                           [surface = rings[k].surface, above = gear_.parameters().allowance_top_mm](double r) {
                             return surface.z_tip(r) + above;
                           },
                           [](double) { return 0.0; }, gear_.lowest_root()});
      if (k + 1 < rings.size())
        out.corners.push_back(
            {{zone.outer_radius_mm, gear_.groove_floor()}, {rings[k + 1].zone.inner_radius_mm, gear_.groove_floor()}});
    }
    const double under = mesh::underside_z(gear_);
    out.corners.push_back({{gear_.outer_radius(), under}, {gear_.inner_radius(), under}});
    out.place = [](double r, double z, double azimuth) {
      return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z);
    };
    return out;
  }
  [[nodiscard]] Result<exchange::GearShell> shell() const override { return exchange::face_gear_shell(gear_); }
  [[nodiscard]] Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>& assumed, app::StageClock& clock,
                                   std::vector<std::string>& files) const override {
    return write_surface_files(output, gear_, job_.name, surface, assumed, clock, files);
  }
  [[nodiscard]] std::unique_ptr<process::GearMilling> milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock& clock) const override {
    return clock.run("distance index",
                     [&] { return std::make_unique<FaceMilling>(job_, machine, gear_, limits, grid); });
  }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped(const process::FlankGrid& grid) const override {
    auto places = places_on(job_, gear_, grid.rows, grid.columns);
    if (auto* errors = places.refused()) return std::move(*errors);
    return shaped_flanks(job_, gear_, std::move(places).value());
  }
  [[nodiscard]] Status accepts(const process::ContactAsked& asked) const override {
    if (!asked.other_job.empty())
      return fail_at(job_.where("gear.type"), "type = \"{}\", but --mate needs an equal_base_circle_bevel_gear",
                     job_.gear_type());
    return Ok{};
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
