#include "app/process/bevel/process.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/process/bevel/contact.h"
#include "app/process/bevel/files.h"
#include "app/process/bevel/ledger.h"
#include "app/process/bevel/proof.h"
#include "app/report/page/tool_body.h"
#include "cam/finger/bodies.h"
#include "cam/finger/check.h"
#include "cam/finger/milling.h"
#include "cam/path/motions.h"
#include "cam/rest/swept_body.h"
#include "geometry/base/angle.h"
#include "geometry/exchange/bevel_shell.h"
#include "geometry/mesh/bevel_mesh.h"

namespace toothpath::bevel {
namespace {

constexpr double kRootRounding = 1e-9;  // mm
constexpr mesh::BevelMeshOptions kPictureFacets{.stations = 7, .rows = 5, .root_points = 2, .land_points = 1};
constexpr double kAboveTip_mm = 2, kBesideMill_mm = 4;  // where distances from a swept mill are asked most
constexpr double kRootShare = 1;  // the flat tip of the mill faces the root: a length error reaches it in full

finger::FingerCheckOptions check_options(const process::FlankGrid& grid) {
  finger::FingerCheckOptions options;
  if (grid.rows > 0) options.rows = grid.rows;
  if (grid.columns > 0) options.columns = grid.columns;
  return options;
}

class BevelMilling final : public process::GearMilling {
 public:
  BevelMilling(const job::Job& job, const machines::Machine& machine, const bevel_gear::BevelGear& gear,
               const proof::ProofLimits& limits, const process::FlankGrid& grid)
      : job_(job),
        gear_(gear),
        limits_(limits),
        gouge_(gear, job.tools, job.operations, limits, check_options(grid)),
        check_(job, machine, limits, gear, gouge_) {}

  [[nodiscard]] Status plan(app::StageClock& clock, app::Progress&) override {
    for (std::size_t i = 0; i < job_.operations.size(); ++i) {
      const auto& operation = job_.operations[i];
      const auto& tool = job_.tools[static_cast<std::size_t>(operation.tool)];
      auto plan = clock.run(
          "plan", [&] { return finger::plan_finger_operation(gear_, tool, operation, static_cast<int>(i), limits_); });
      if (!plan) return process::located(job_, fmt::format("operation[{}]", i), plan.error());
      plans_.push_back(std::move(plan).value());
    }
    return Ok{};
  }
  [[nodiscard]] std::vector<const path::ClPath*> paths() const override {
    std::vector<const path::ClPath*> out;
    for (const auto& plan : plans_) out.push_back(&plan.path);
    return out;
  }
  [[nodiscard]] std::vector<proof::DirectionChoice> directions() const override { return {}; }
  [[nodiscard]] std::vector<report::PassReport> passes() const override {
    std::vector<report::PassReport> out;
    for (const auto& plan : plans_)
      for (const auto& pass : plan.passes)
        out.push_back(
            {plan.path.operation, pass.half, pass.pass, pass.name, pass.outward, pass.length_mm, pass.points});
    return out;
  }
  [[nodiscard]] Result<proof::CheckedClPath> approve(const path::ClPath& path) const override {
    return gouge_.approve(path);
  }
  [[nodiscard]] path::OperationType roughing() const override { return path::OperationType::finger_roughing; }
  [[nodiscard]] rest::Excess roughed() const override {
    std::vector<rest::Excess> removed;
    for (const auto& plan : plans_) {
      if (job_.operations[std::size_t(plan.path.operation)].type != roughing()) continue;
      const auto own = finger::gear_for_finger_mill(gear_, job_.tools[std::size_t(plan.path.tool)]);
      if (!own) continue;
      const double depth = gear_.parameters().addendum_mm + own->parameters().dedendum_mm;
      const auto one = std::make_shared<const rest::SweptBody>(
          path::motions_of(plan.path),
          [solid = bevel_gear::FingerSolid(own->cutter()), h_f = own->parameters().dedendum_mm](
              double height, double radius) { return solid.signed_distance(height - h_f, radius); },
          depth + kAboveTip_mm, own->cutter().rho_D + kBesideMill_mm);
      removed.emplace_back([one](const Vec3& p, double cap) { return one->excess(p, cap); });
    }
    return rest::excess_of(std::move(removed));
  }
  [[nodiscard]] process::GearCheck& check() override { return check_; }
  [[nodiscard]] std::vector<proof::LedgerEntry> ledger(const joints::AxisProgram& program,
                                                       const process::ProgramProof& proof,
                                                       double blend_mm) const override {
    return bevel::ledger(gear_, plans_, program, proof, check_.result, blend_mm);
  }
  [[nodiscard]] sheet::OtherSurface beside_the_grid() const override { return {kRootShare}; }

 private:
  const job::Job& job_;
  const bevel_gear::BevelGear& gear_;
  proof::ProofLimits limits_;
  finger::FingerGougeCheck gouge_;
  BevelGearCheck check_;
  std::vector<finger::FingerPlan> plans_;
};

class BevelProcess final : public process::GearProcess {
 public:
  BevelProcess(const job::Job& job, bevel_gear::BevelGear gear) : job_(job), gear_(std::move(gear)) {
    const auto& p = gear_.parameters();
    part_ = {p.teeth, 2 * (gear_.R_e() * gear_.sin_delta() + p.addendum_mm * gear_.cos_delta()),
             2 * clearance_body(gear_).radius_mm, gear_.warnings()};
    if (gear_.modified()) part_.modified = report::ModifiedFlanks{p.modifications, {}, gear_.modified()};
  }

  [[nodiscard]] const process::PartFacts& part() const override { return part_; }
  [[nodiscard]] Result<process::Correction> correct(const job::MeasuredInput&, app::StageClock&) override {
    return process::needs_face_gear(job_);
  }
  [[nodiscard]] joints::ClearanceBody link_body(const machines::Machine& machine) const override {
    return bevel::link_body(gear_, job_.tools, machine);
  }
  [[nodiscard]] sheet::PartOutline outline() const override { return bevel::outline(gear_); }
  [[nodiscard]] page::GearOnPage on_page(const std::string& machine_name) const override {
    const auto& p = gear_.parameters();
    page::GearOnPage out;
    out.subtitle =
        fmt::format("equal-base-circle bevel gear z {}, outer module {:g} mm, {}, pitch angle {:.4f} deg, {}", p.teeth,
                    p.outer_transverse_module_mm, gear_.herringbone() ? "herringbone" : "single hand",
                    degrees(gear_.delta()), machine_name);
    for (const auto& tool : job_.tools) out.tools.push_back(page::page_finger_mill(gear_, tool));
    return out;
  }
  [[nodiscard]] std::vector<svg::LineChart> limit_charts() const override { return {}; }
  [[nodiscard]] Result<process::SceneGear> scene(double clearance_mm) const override {
    // W stands in the pitch apex.
    process::SceneGear out{
        part_.teeth, clearance_mm, {}, [gear = gear_](const Vec3& tip) { return azimuth_from_space_0(gear, tip); }};
    out.bodies.resize(job_.tools.size());
    for (const auto& operation : job_.operations) {
      const auto k = std::size_t(operation.tool);
      if (!out.bodies[k].empty()) continue;
      const auto own = finger::gear_for_finger_mill(gear_, job_.tools[k]);
      if (!own) return process::located(job_, fmt::format("tool[{}]", k), own.error());
      out.bodies[k] = finger::finger_bodies(own->cutter(), job_.tools[k]);
      for (std::size_t sister = 0; sister < job_.tools.size(); ++sister)
        if (job_.tools[sister].sister_of == job_.tools[k].number) out.bodies[sister] = out.bodies[k];
    }
    return out;
  }
  [[nodiscard]] Result<process::FinishedGear> solid() const override {
    auto mesh = mesh::bevel_gear_mesh(gear_);
    if (!mesh) return process::located(job_, "gear", mesh.error());
    const auto above = [gear = gear_](const Vec3& p) {
      return bevel_gear::cone_point(p, gear.sin_delta(), gear.cos_delta()).height >
             -gear.parameters().dedendum_mm - kRootRounding;
    };
    process::FinishedGear out{std::move(*mesh), {}, above};
    for (const Vec3& v : out.mesh.vertices) out.teeth.push_back(above(v));
    return out;
  }
  [[nodiscard]] Result<mesh::TriangleMesh> mesh() const override { return mesh::bevel_gear_mesh(gear_); }
  [[nodiscard]] Result<mesh::TriangleMesh> pitch_mesh(process::FacetSize size) const override {
    auto pitch =
        mesh::bevel_pitch_part(gear_, size == process::FacetSize::picture ? kPictureFacets : mesh::BevelMeshOptions());
    if (!pitch) return process::located(job_, "gear", pitch.error());
    return pitch;
  }
  [[nodiscard]] rest::Blank blank() const override {
    rest::Blank out;
    out.teeth = part_.teeth;
    out.outward = -1;
    const auto& p = gear_.parameters();
    const auto& halves = gear_.halves();
    for (std::size_t k = 0; k < halves.size(); ++k) {
      const bool last = k + 1 == halves.size();
      out.rings.push_back({halves[k].ell_from, last ? gear_.R_e() : halves[k].ell_to,
                           [top = p.addendum_mm](double) { return top; }, [](double) { return 0.0; }, -p.dedendum_mm});
      if (!last) out.corners.push_back({{halves[k].ell_to, -p.dedendum_mm}, {halves[k + 1].ell_from, -p.dedendum_mm}});
    }
    const double under = mesh::underside_height(gear_);
    out.corners.push_back({{gear_.R_e(), under}, {gear_.R_i(), under}});
    out.place = [sd = gear_.sin_delta(), cd = gear_.cos_delta()](double ell, double height, double azimuth) {
      return bevel_gear::blank_point(ell, height, azimuth, sd, cd);
    };
    return out;
  }
  [[nodiscard]] Result<exchange::GearShell> shell() const override { return exchange::bevel_gear_shell(gear_); }
  [[nodiscard]] Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>&, app::StageClock& clock,
                                   std::vector<std::string>& files) const override {
    return write_surface_files(output, gear_, job_.name, surface, clock, files);
  }
  [[nodiscard]] std::unique_ptr<process::GearMilling> milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock&) const override {
    return std::make_unique<BevelMilling>(job_, machine, gear_, limits, grid);
  }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped(const process::FlankGrid&) const override {
    return std::vector{process::needs_face_gear(job_)};
  }
  [[nodiscard]] Status accepts(const process::ContactAsked& asked) const override {
    if (asked.pinion_teeth.has_value())
      return fail_at(job_.where("gear.type"), "type = \"{}\", but --pinion-teeth needs a face_gear", job_.gear_type());
    return Ok{};
  }
  [[nodiscard]] process::ValueOrErrors<process::ContactFound> contact(const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock) const override {
    return roll_pair(job_, gear_, asked, cut, clock);
  }
  [[nodiscard]] std::string contact_section(const std::vector<proof::SurfaceGrid>&,
                                            std::vector<std::string>&) const override {
    return {};
  }

 private:
  const job::Job& job_;
  bevel_gear::BevelGear gear_;
  process::PartFacts part_;
};

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_bevel_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return std::unique_ptr<process::GearProcess>(std::make_unique<BevelProcess>(job, std::move(made).value()));
}

}  // namespace toothpath::bevel
