#include "app/process/cutting_force.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "app/base/units.h"
#include "app/process/gear_of_job.h"
#include "app/process/ledger_sources.h"
#include "cam/finger/finger_profile.h"
#include "cam/finger/milling.h"
#include "cam/force/load.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"

namespace toothpath::process {
namespace {

using path::OperationType;
using report::estimate;

constexpr double kHelix = 30 * kDegree;  // of end mills as they are sold, where the job does not say
constexpr double kRounding = 1e-9;
constexpr double kFingerSag = 1e-3;  // mm: of a finger mill's profile

bool finger(OperationType type) {
  return type == OperationType::finger_roughing || type == OperationType::finger_finishing;
}

/// What the operation may leave beside what it was asked to; none where it has no such number.
std::optional<double> may_leave(const path::MillingOperation& o) {
  double limit = o.allowance_mm;
  if (o.type == OperationType::finishing) limit = o.scallop_mm;
  if (o.type == OperationType::line_milling && o.finishes()) limit = o.most_misfit_mm();
  return limit > 0 && !finger(o.type) ? std::optional(limit) : std::nullopt;
}

/// The most stock that an operation meets: what those before it in its regions left. None: one of them is uncut.
std::optional<double> stock_before(const job::Job& job, std::size_t index) {
  const path::MillingOperation& o = job.operations[index];
  double stock = 0;
  for (const path::Region region : path::kRegions) {
    if (!o.regions[region]) continue;
    const auto k = path::last_before(job.operations, index, region);
    if (!k) return {};
    const path::MillingOperation& left = job.operations[*k];
    stock = std::max(stock, path::left_by(left, job.tools[std::size_t(left.tool)].radius_mm()) - o.allowance_mm);
  }
  return stock;
}

/// The line of a side along a flank: from its ball end up to its highest contact. As planned.
std::optional<std::pair<double, double>> contact_line(const report::RunReport& report, int operation,
                                                      const tool::Profile& mill) {
  double top = 0;
  for (const auto& pass : report.passes)
    if (pass.operation == operation && pass.side) top = std::max(top, pass.side->contact_top_mm);
  const double from = mill.cutting().pieces().front().to[0];
  return top > from ? std::optional(std::pair(from, std::min(top, mill.cutting().to()))) : std::nullopt;
}

/// The tool of an operation as a profile. Refused: a finger mill that does not fit the gear.
Result<tool::Profile> profile_of(const tool::ToolAssembly& t, const std::optional<bevel_gear::BevelGear>& gear) {
  if (!tool::kind_of(t).form_from_gear) return tool::profile_of(t);
  if (!gear) return fail("a finger mill's form follows from a bevel gear");
  const auto own = finger::gear_for_finger_mill(*gear, t);
  if (!own) return own.error();
  return finger::finger_profile(own->cutter(), t, kFingerSag);
}

/// The cut of an operation. Refused: one whose stock the job does not tell.
Result<force::Engagement> cut_of(const job::Job& job, const report::RunReport& report, std::size_t index,
                                 const tool::Profile& mill, report::CuttingLoad& out) {
  const path::MillingOperation& o = job.operations[index];
  if (o.type == OperationType::roughing)
    return force::slot_engagement(mill, std::min(o.step_down_mm, mill.cutting().to()));
  if (const auto* bevel = job.bevel_gear(); bevel && o.type == OperationType::finger_roughing)
    return force::slot_engagement(mill, std::min(bevel->addendum_mm + bevel->dedendum_mm, mill.cutting().to()));
  if (finger(o.type)) return fail("the stock on the walls follows from form and ridge of the roughing mill");
  out.stock_mm = stock_before(job, index);
  if (!out.stock_mm) return fail("no operation before it says what stock it meets");
  if (o.type == OperationType::line_milling) {
    const auto line = contact_line(report, int(index), mill);
    if (!line) return fail("where the side touches is known from its plan: this program was not planned here");
    return force::side_engagement(mill, line->first, line->second, *out.stock_mm);
  }
  const double radius = job.tools[std::size_t(o.tool)].radius_mm();
  return force::ball_engagement(radius, *out.stock_mm, force::step_of_scallop(radius, o.scallop_mm));
}

report::CuttingLoad load_of(const job::Job& job, const report::RunReport& report, std::size_t index,
                            const std::optional<bevel_gear::BevelGear>& gear) {
  report::CuttingLoad out;
  const path::MillingOperation& o = job.operations[index];
  const tool::ToolAssembly& tool = job.tools[std::size_t(o.tool)];
  out.may_leave_mm = may_leave(o);
  const auto not_computed = [&](const Diagnostic& why) {
    out.not_computed = why.message;
    return out;
  };
  const auto mill = profile_of(tool, gear);
  if (!mill) return not_computed(mill.error());
  const bool ball = !tool::kind_of(tool).form_from_gear;
  const double height = ball ? tool.radius_mm() : mill->cutting().to() / 2;
  if (const auto c = force::compliance(*mill, height, height, job.material.tools)) out.compliance = *c;
  const auto cut = cut_of(job, report, index, *mill, out);
  if (!cut) return not_computed(cut.error());
  const double feed = finger(o.type) ? o.feed_mm_min : o.feed_for(cut->steepest, tool.teeth);
  const auto load = force::load_of(*mill, {tool.teeth, ball ? tool.helix_rad.value_or(kHelix) : 0, o.speed_rpm, feed},
                                   *cut, job.material.cutting, job.material.tools);
  if (!load) return not_computed(load.error());
  out.load = *load;
  out.compliance = load->compliance;
  out.slender = out.may_leave_mm && force::slender(*load, *out.may_leave_mm);
  return out;
}

/// "in operation 3 a force of 2.2 N (+-50 %) bends it by 1450 um, .."
std::string slender_text(const report::OperationReport& o) {
  const report::CuttingLoad& c = *o.cutting;
  const double um = app::um(c.load->deflection_mm);
  std::string text = fmt::format(
      "tool {} is slender: {} um/N at {:.3f} mm above its tip; in operation {} a force of {} N (+-{:.0f} %) bends it "
      "by {} um, the operation may leave {} um more than it was asked to",
      o.tool_number, estimate(app::um(c.compliance->total())), c.load->height_mm, o.operation,
      estimate(c.load->force_N), 100 * c.load->uncertainty, estimate(um), estimate(app::um(*c.may_leave_mm)));
  if (c.stock_mm && c.load->deflection_mm > *c.stock_mm)
    text += fmt::format("; its stock is {} um: it bends away and does not cut it", estimate(app::um(*c.stock_mm)));
  return text;
}

/// As measured along the path, or of the load model: chip [mm], angle [rad].
struct LargestCut {
  double chip_mm = 0, engaged_rad = 0;
};
LargestCut largest_cut(const report::RunReport& report, const report::OperationReport& o) {
  for (const report::EngagementReport& t : report.engagement)
    if (t.operation == o.operation && !t.way_mm.empty())
      return {*std::max_element(t.chip_mm.begin(), t.chip_mm.end()),
              *std::max_element(t.engaged_rad.begin(), t.engaged_rad.end())};
  return {o.cutting->load->chip_mm, o.cutting->load->engaged_rad};
}

/// What exceeds `max_engagement`, and where no step-over helps.
std::string engagement_text(const report::RunReport& report, const report::OperationReport& o,
                            const path::MillingOperation& asked, double engaged_rad) {
  std::string text = fmt::format(
      "operation {}: its teeth are in the material over {:.1f} deg, which exceeds max_engagement = {:g} deg",
      o.operation, degrees(engaged_rad), degrees(asked.max_engagement_rad));
  for (const report::EngagementReport& t : report.engagement) {
    if (t.operation != o.operation || t.way_mm.empty() || asked.type != path::OperationType::roughing) continue;
    if (t.beside_rad > asked.max_engagement_rad)
      text += fmt::format(
          "; beside the passes that open a layer over {:.1f} deg: no step_over down to a fifth of what "
          "is asked keeps it",
          degrees(t.beside_rad));
    else
      text += fmt::format(
          " where a pass opens a layer, on {:.1f} of {:.1f} mm; beside these {:.1f} deg, by passes "
          "{:.3g} mm apart",
          t.opening_mm, t.way_mm.back(), degrees(t.beside_rad), t.step_over_mm);
  }
  return text;
}

/// One warning a slender tool, from its worst operation; one for every chip and engagement that is too large.
void add_warnings(report::RunReport& report, const job::Job& job) {
  std::map<int, const report::OperationReport*> worst;
  const auto ratio = [](const report::OperationReport& o) {
    return o.cutting->load->deflection_mm / *o.cutting->may_leave_mm;
  };
  std::set<int> seen;
  for (const report::OperationReport& o : report.operations) {
    if (!seen.insert(o.operation).second || !o.cutting || !o.cutting->load) continue;  // a sister does the same
    const path::MillingOperation& asked = job.operations[std::size_t(o.operation)];
    const LargestCut load = largest_cut(report, o);
    if (asked.chip_load_mm > 0 && load.chip_mm > asked.chip_load_mm * (1 + kRounding))
      report.warnings.push_back(fmt::format("operation {}: its largest chip of {} um exceeds chip_load = {:g} mm",
                                            o.operation, estimate(app::um(load.chip_mm)), asked.chip_load_mm));
    if (asked.max_engagement_rad > 0 && load.engaged_rad > asked.max_engagement_rad)
      report.warnings.push_back(engagement_text(report, o, asked, load.engaged_rad));
    if (!o.cutting->slender) continue;
    const report::OperationReport*& known = worst[o.tool_number];
    if (!known || ratio(o) > ratio(*known)) known = &o;
  }
  for (const auto& [number, o] : worst) report.warnings.push_back(slender_text(*o));
}

/// The operation that finishes, where its load is known: the one that bends most.
void add_to_ledger(report::RunReport& report, const job::Job& job) {
  const report::OperationReport* most = nullptr;
  for (const report::OperationReport& o : report.operations)
    if (o.cutting && o.cutting->load && job.operations[std::size_t(o.operation)].finishes() &&
        (!most || o.cutting->load->deflection_mm > most->cutting->load->deflection_mm))
      most = &o;
  if (!most || report.ledger.empty()) return;
  report.ledger.push_back(unmeasured(
      proof::ErrorSource::deflection, most->cutting->load->deflection_mm,
      fmt::format("a model, not measured, and not in the sum: force times compliance in operation {}, +-{:.0f} %; the "
                  "bounds of the proof are geometric",
                  most->operation, 100 * most->cutting->load->uncertainty)));
}

}  // namespace

void note_cutting_forces(report::RunReport& report, const job::Job& job) {
  std::optional<bevel_gear::BevelGear> gear;
  if (job.bevel_gear())
    if (auto made = make_bevel_gear(job)) gear = std::move(made).value();
  for (report::OperationReport& o : report.operations) o.cutting = load_of(job, report, std::size_t(o.operation), gear);
  const job::MaterialSettings& m = job.material;
  report.force_basis = fmt::format(
      "Forces +-{:.0f} %: K = {:g} N/mm^2, K_e = {:g} N/mm, tools of {:g} GPa ({}); flutes of ball mills with a helix "
      "of {:g} deg where the job does not say, of finger mills straight, 0.8 of their diameter bears.",
      100 * m.cutting.uncertainty, m.cutting.cutting_N_mm2, m.cutting.edge_N_mm, m.tools.youngs_modulus_N_mm2 / 1000,
      m.stated ? "[material] of the job; what it leaves out: steel, carbide" : "defaults: steel, carbide",
      degrees(kHelix));
  add_warnings(report, job);
  add_to_ledger(report, job);
}

}  // namespace toothpath::process
