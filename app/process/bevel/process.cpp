#include "app/process/bevel/process.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/process/bevel/contact.h"
#include "app/process/bevel/cut_walls.h"
#include "app/process/bevel/files.h"
#include "app/process/bevel/ledger.h"
#include "app/process/bevel/proof.h"
#include "app/process/least_values.h"
#include "app/process/milled/toothed_process.h"
#include "app/report/page/tool_body.h"
#include "cam/finger/bodies.h"
#include "cam/finger/check.h"
#include "cam/finger/milling.h"
#include "cam/finger/poses.h"
#include "cam/finger/reference.h"
#include "cam/path/motions.h"
#include "cam/rest/swept_body.h"
#include "geometry/base/angle.h"
#include "geometry/bevel_gear/part.h"
#include "geometry/inspection/bevel_grid.h"
#include "geometry/inspection/bevel_touches.h"

namespace toothpath::bevel {
namespace {

constexpr double kToldClearance = 0.01;                 // mm
constexpr double kAboveTip_mm = 2, kBesideMill_mm = 4;  // where distances from a swept mill are asked most
constexpr double kRootShare = 1;  // the flat tip of the mill faces the root: a length error reaches it in full

finger::FingerCheckOptions check_options(const process::FlankGrid& grid) {
  finger::FingerCheckOptions options;
  if (grid.rows > 0) options.rows = grid.rows;
  if (grid.columns > 0) options.columns = grid.columns;
  return options;
}

/// By finger mills.
class FingerMilling final : public process::GearMilling {
 public:
  FingerMilling(const job::Job& job, const machines::Machine& machine, const bevel_gear::BevelGear& gear,
                const proof::ProofLimits& limits, const process::FlankGrid& grid, const process::Taken& taken)
      : job_(job),
        gear_(gear),
        limits_(limits),
        taken_(taken),
        gouge_(gear, job.tools, job.operations, limits, check_options(grid)),
        check_(job, machine, limits, gear, gouge_) {
    check_.plan_anew = process::planned_once([this](std::size_t operations) -> process::PlannedMotions {
      std::vector<path::ToolMotion> motions;
      for (std::size_t n = 0; n < operations; ++n) {
        const auto plan = plan_of(n);
        if (!plan) return plan.error();
        const auto own = path::motions_of(plan->path);
        motions.insert(motions.end(), own.begin(), own.end());
      }
      return motions;
    });
  }

  [[nodiscard]] Status plan(app::StageClock& clock, app::Progress&) override {
    for (std::size_t i = 0; i < job_.operations.size(); ++i) {
      auto plan = clock.run("plan", [&] { return plan_of(i); });
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
    auto passed = gouge_.approve(path, clearance_room());
    if (passed || !job_.verify.clearance_mm) return passed;
    const auto keeps = most_clearance();
    if (!keeps || *keeps >= limits_.clearance_mm) return passed;
    return process::located(
        job_, "verify.clearance",
        fail("clearance = {:g} mm is more than these tools keep: {}; {:g} or less does, or a thinner or longer shank "
             "and holder",
             limits_.clearance_mm, passed.error().message, *keeps));
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
  [[nodiscard]] process::GearCheck& check() override {
    check_.forget();
    return check_;
  }
  [[nodiscard]] std::vector<proof::LedgerEntry> ledger(const joints::AxisProgram& program,
                                                       const process::ProgramProof& proof,
                                                       double blend_mm) const override {
    return bevel::ledger(gear_, plans_, program, proof, check_.result, blend_mm);
  }
  [[nodiscard]] sheet::OtherSurface beside_the_grid() const override { return {kRootShare}; }

 private:
  /// The largest clearance that all paths keep with room for words and control, downwards to `kToldClearance`. Nothing:
  /// they are refused for something else, too.
  [[nodiscard]] std::optional<double> most_clearance() const {
    const auto keep = [&](double clearance_mm) {
      proof::ProofLimits limits = limits_;
      limits.clearance_mm = clearance_mm;
      const finger::FingerGougeCheck check(gear_, job_.tools, job_.operations, limits);
      return std::all_of(plans_.begin(), plans_.end(), [&](const finger::FingerPlan& plan) {
        return bool(check.approve(plan.path, clearance_room()));
      });
    };
    double low = 0, high = limits_.clearance_mm;
    if (!keep(low)) return std::nullopt;
    while (high - low > kToldClearance) (keep(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return std::floor(low / kToldClearance) * kToldClearance;
  }
  /// What a gap of shank and holder may lose from plan to proof.
  [[nodiscard]] double clearance_room() const { return taken_.of_gouge(limits_.gouge_mm) + taken_.turns_mm; }

  [[nodiscard]] Result<finger::FingerPlan> plan_of(std::size_t n) const {
    const auto& operation = job_.operations[n];
    proof::ProofLimits planned = limits_;
    planned.gouge_mm = process::planned_gouge(limits_.gouge_mm, taken_);
    return finger::plan_finger_operation(gear_, job_.tools[std::size_t(operation.tool)], operation, int(n), planned);
  }

  const job::Job& job_;
  const bevel_gear::BevelGear& gear_;
  proof::ProofLimits limits_;
  process::Taken taken_;
  finger::FingerGougeCheck gouge_;
  BevelGearCheck check_;
  std::vector<finger::FingerPlan> plans_;
};

/// The pair, and what files and pages say of any such gear.
class BevelProcess : public milled::ToothedProcess {
 public:
  BevelProcess(const job::Job& job, std::shared_ptr<const bevel_gear::BevelPart> part)
      : ToothedProcess(job, toothed(job, part)), part_(std::move(part)), bevel_(part_->gear()) {}

  [[nodiscard]] Result<process::Correction> correct(const job::MeasuredInput&, app::StageClock&) override {
    return fail_at(
        job().where("gear.type"),
        "type = \"{}\" answers no measurement: its flanks are what one mill on its paths leaves, which follows "
        "no field of deviations; a [[gear.modification]] with a grid that is a sum over depth and face does",
        job().gear_type());
  }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> measured(const job::MeasuredInput& files) const override {
    const auto walls = walls_as_measured(bevel_, files);
    if (!walls) return std::vector{walls.error()};
    auto flanks = flanks_of(bevel_, *walls);
    if (!flanks) return std::vector{flanks.error()};
    return std::move(*flanks);
  }
  [[nodiscard]] std::unique_ptr<inspection::TouchedPart> touched() const override {
    return std::make_unique<inspection::TouchedBevelGear>(part_);
  }
  [[nodiscard]] Status accepts(const process::ContactAsked& asked) const override {
    if (asked.pinion_teeth.has_value())
      return fail_at(job().where("gear.type"), "type = \"{}\", but --pinion-teeth needs a face_gear",
                     job().gear_type());
    return Ok{};
  }
  [[nodiscard]] process::ValueOrErrors<process::ContactFound> contact(const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock) const override {
    return roll_pair(job(), bevel_, asked, cut, clock);
  }

  [[nodiscard]] Result<process::InspectedFlanks> inspected(const process::GridAsked& asked = {}) const override {
    process::InspectedFlanks out{asked.instead_of(inspection::kBevelInspection), {}, inspection::kWallNames};
    auto points = inspection::bevel_inspection_grid(bevel_, out.grid);
    if (!points) return points.error();
    out.points = std::move(*points);
    return out;
  }

 protected:
  [[nodiscard]] const bevel_gear::BevelGear& bevel() const { return bevel_; }

 private:
  static milled::ToothedGear toothed(const job::Job& job, const std::shared_ptr<const bevel_gear::BevelPart>& part) {
    const bevel_gear::BevelGear& gear = part->gear();
    const auto& p = gear.parameters();
    milled::ToothedGear out;
    out.part = part;
    out.solid = drawn_solid(*part);
    out.owner = part;
    const joints::ClearanceBody links = clearance_body(gear);
    out.facts = {p.teeth, 2 * (gear.R_e() * gear.sin_delta() + p.addendum_mm * gear.cos_delta()), 2 * links.radius_mm,
                 gear.warnings()};
    if (gear.modified()) out.facts.modified = report::ModifiedFlanks{p.modifications, {}, gear.modified()};
    const auto defines = [](const tool::ToolAssembly& t) { return tool::serves(t, tool::CutterUse::tooth_form); };
    if (!p.mill && std::none_of(job.tools.begin(), job.tools.end(), defines))
      out.facts.warnings.push_back(fmt::format(
          "the flanks are those that a finger mill by the rules leaves (module {:g}, tip radius {:g}, rack depth {:g}, "
          "profile height {:g} mm); [gear.mill] states another one",
          gear.cutter_data().module_mm, gear.cutter_data().tip_radius_mm, gear.cutter_data().rack_depth_mm,
          gear.cutter_data().profile_height_mm));
    out.body = {links, {links.radius_mm, 0, links.z_max_mm, links.z_min_mm, proof::Roof(*part)}};
    out.outline = bevel::outline(gear);
    out.subtitle = fmt::format("equal-base-circle bevel gear z {}, outer module {:g} mm, {}, pitch angle {:.4f} deg",
                               p.teeth, p.outer_transverse_module_mm,
                               gear.herringbone() ? "herringbone" : "single hand", degrees(gear.delta()));
    out.data = {gear_data(gear)};
    for (int half = 0; half < part->zones(); ++half) {
      const auto& ring = part->space(half).outline();
      out.measured_at.push_back({half, 0.5 * (ring.s_from + ring.s_to), 0, "pitch cone, middle of the half"});
    }
    out.limits_json = [&gear] { return bevel::limits_json(gear); };  // the gear lives as long as the part
    return out;
  }

  std::shared_ptr<const bevel_gear::BevelPart> part_;
  const bevel_gear::BevelGear& bevel_;
};

/// By the mill whose envelope the flanks are.
class FingerProcess final : public BevelProcess {
 public:
  using BevelProcess::BevelProcess;

  [[nodiscard]] joints::ClearanceBody link_body(const machines::Machine& machine) const override {
    return bevel::link_body(bevel(), job().tools, machine);
  }
  [[nodiscard]] page::GearOnPage on_page(const std::string& machine_name) const override {
    page::GearOnPage out = BevelProcess::on_page(machine_name);
    out.tools.clear();
    for (const auto& tool : job().tools) out.tools.push_back(page::page_finger_mill(bevel(), tool));
    return out;
  }
  [[nodiscard]] Result<process::SceneGear> scene(double clearance_mm) const override {
    // W stands in the pitch apex.
    process::SceneGear out{gear().facts.teeth, clearance_mm, {}, [gear = bevel()](const Vec3& tip) {
                             return azimuth_from_space_0(gear, tip);
                           }};
    out.bodies.resize(job().tools.size());
    for (const auto& operation : job().operations) {
      const auto k = std::size_t(operation.tool);
      if (!out.bodies[k].empty()) continue;
      const auto own = finger::gear_for_finger_mill(bevel(), job().tools[k]);
      if (!own) return process::located(job(), fmt::format("tool[{}]", k), own.error());
      out.bodies[k] = finger::finger_bodies(own->cutter(), job().tools[k]);
      for (std::size_t sister = 0; sister < job().tools.size(); ++sister)
        if (job().tools[sister].sister_of == job().tools[k].number) out.bodies[sister] = out.bodies[k];
    }
    return out;
  }
  /// The proof counts a shift of the centre with its leverage, and what may lie between two poses.
  [[nodiscard]] process::Taken taken(const machines::Machine& machine) const override {
    process::Taken out = BevelProcess::taken(machine);
    const double lever = finger::centre_leverage(bevel());
    out.proof_mm = (std::hypot(lever, 1) - 1) * out.words_mm + lever * finger::kBetweenPoses + kFingerMotionTolerance;
    out.chords = process::kFingerChords;
    return out;
  }
  [[nodiscard]] std::unique_ptr<process::GearMilling> milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock&) const override {
    return std::make_unique<FingerMilling>(job(), machine, bevel(), limits, grid, taken(machine));
  }
};

/// Does anything cut this gear that is not its own mill?
bool ball_milled(const job::Job& job) {
  return std::any_of(job.operations.begin(), job.operations.end(), [](const path::MillingOperation& o) {
    return o.type != path::OperationType::finger_roughing && o.type != path::OperationType::finger_finishing;
  });
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_bevel_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  auto part = std::make_shared<const bevel_gear::BevelPart>(std::move(made).value());
  if (!ball_milled(job))
    return std::unique_ptr<process::GearProcess>(std::make_unique<FingerProcess>(job, std::move(part)));
  if (part->gear().parameters().shaft_diameter_mm > 0)
    return std::vector{
        fail_at(job.where("gear.shaft_diameter"),
                "shaft_diameter = {:g} mm: ball mills do not look at a shaft before the small end; leave "
                "it out and hold it as a [[body]] of the machine, or cut with the finger mill",
                part->gear().parameters().shaft_diameter_mm)};
  return std::unique_ptr<process::GearProcess>(std::make_unique<BevelProcess>(job, std::move(part)));
}

}  // namespace toothpath::bevel
