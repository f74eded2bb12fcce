#include "postproc/joints/inputs.h"
#include "cam/tool/cutters.h"

#include <algorithm>
#include <cmath>

namespace toothpath::joints {
namespace {

std::optional<Diagnostic> check_machine(const machines::Machine& machine) {
  if (machine.kind != machines::MachineKind::five_axis)
    return fail("machine \"{}\" is not a milling machine", machine.name);
  if (machine.post.length_reference != machines::LengthReference::tip)
    return fail("machine \"{}\": length_reference: only \"tip\" is posted", machine.name);
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    if (!(machine.chain.rotary(k).max_speed > 0))
      return fail("axes.{}.max_speed must be above 0", machine.chain.rotary(k).letter);
  for (std::size_t i = 0; i < 3; ++i)
    if (!(machine.chain.linear[i].max_speed > 0)) return fail("axes.{}.max_speed must be above 0", "XYZ"[i]);
  return std::nullopt;
}

std::optional<Diagnostic> check_records(const path::ClPath& path) {
  if (path.records.empty()) return fail("operation {}: the path has no records", path.operation);
  if (path.records.front().kind != path::MoveKind::rapid)
    return fail("operation {}: the path does not begin with a rapid", path.operation);
  for (std::size_t i = 0; i < path.records.size(); ++i) {
    const path::ClRecord& r = path.records[i];
    if (!r.tip.allFinite() || !r.axis.allFinite() || r.tip.norm() > 1e5)
      return fail("operation {} record {}: position is not a number below 1e5 mm", path.operation, i);
    if (std::abs(r.axis.norm() - 1) > 1e-9)
      return fail("operation {} record {}: tool axis has length {:.12f}, not 1", path.operation, i, r.axis.norm());
    if (r.kind != path::MoveKind::rapid && !(r.feed_mm_min > 0 && std::isfinite(r.feed_mm_min)))
      return fail("operation {} record {}: feed must be above 0", path.operation, i);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Diagnostic> check_axis_inputs(std::span<const path::ClPath* const> paths,
                                            std::span<const tool::ToolAssembly> tools, const machines::Machine& machine,
                                            int teeth, const AxisOptions& options) {
  if (auto bad = check_machine(machine)) return bad;
  if (teeth < 1) return fail("teeth = {} is below 1", teeth);
  if (paths.empty()) return fail("there is no operation to post");
  if (!(options.chord_mm > 0) || !(options.axis_rad > 0)) return fail("chord and axis tolerances must be above 0");
  for (const path::ClPath* path : paths) {
    if (path->tool < 0 || static_cast<std::size_t>(path->tool) >= tools.size())
      return fail("operation {}: tool {} of {} tools", path->operation, path->tool, tools.size());
    if (!(tools[static_cast<std::size_t>(path->tool)].length_mm > 0))
      return fail("operation {}: tool length must be above 0", path->operation);
    if (!(path->spindle_rpm > 0)) return fail("operation {}: spindle speed must be above 0", path->operation);
    if (machine.max_spindle_speed > 0 && path->spindle_rpm > machine.max_spindle_speed)
      return fail("operation {}: spindle speed {} exceeds {}, the machine's", path->operation, path->spindle_rpm,
                  machine.max_spindle_speed);
    if (auto bad = check_records(*path)) return bad;
  }
  return std::nullopt;
}

PoleRules pole_rules_of(const machines::Machine& machine, const AxisOptions& options, const tool::ToolAssembly& tool,
                        const ClearanceBody& body) {
  const machines::PostSettings& post = machine.post;
  PoleRules rules;
  rules.option = post.pole;
  if (machine.chain.rotary_count() > 0) rules.letter = machine.chain.rotary(0).letter;
  rules.ball = tool::turns_freely(tool);
  rules.ball_radius_mm = rules.ball ? tool.radius_mm() : 0;
  const bool moves = post.pole == machines::PoleOption::hold || post.pole == machines::PoleOption::through ||
                     post.pole == machines::PoleOption::retract;
  rules.change_rad = moves ? post.pole_angle_rad.value_or(options.axis_rad) : options.axis_rad;
  if (!rules.ball) rules.change_rad = std::min(rules.change_rad, options.axis_rad);
  rules.keep_rad = post.pole == machines::PoleOption::tilt ? post.pole_angle_rad.value_or(kLeastPoleTilt) : 0;
  rules.body = body;
  rules.margin_mm = options.clearance_margin_mm;
  return rules;
}

}  // namespace toothpath::joints
