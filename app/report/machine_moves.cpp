#include "app/report/machine_moves.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/report/svg/turned_text.h"
#include "geometry/base/angle.h"

namespace toothpath::report {
namespace {

std::string place_text(const bodies::Meeting& m) {
  std::string text;
  if (m.operation >= 0) text += fmt::format(", operation {}", m.operation);
  if (m.tooth >= 0) text += fmt::format(", tooth {}", m.tooth);
  if (m.rapid) text += ", on a rapid";
  return text;
}

}  // namespace

std::string meeting_text(const bodies::Meeting& m, double required_mm) {
  const std::string pair = fmt::format("{} and {}", m.second, m.first);
  if (m.measured_mm <= 0)
    return fmt::format("{} meet{}: {:.2f} mm deep, free along ({:.2f}, {:.2f}, {:.2f})", pair, place_text(m),
                       m.depth_mm, m.direction.x(), m.direction.y(), m.direction.z());
  if (m.proven_mm <= 0) return fmt::format("{} may touch{}: nothing of a gap is proven", pair, place_text(m));
  return fmt::format("{} come within {:.4f} mm (proven){}, the clearance is {:.4f} mm", pair, m.proven_mm,
                     place_text(m), required_mm);
}

std::string joints_text(const machines::Machine& machine, const machines::Joints& joints) {
  std::string text =
      fmt::format("X {:.3f} Y {:.3f} Z {:.3f}", joints.linear_mm.x(), joints.linear_mm.y(), joints.linear_mm.z());
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    text += fmt::format(" {} {}", machine.chain.rotary(k).letter, svg::turned_text(degrees(joints.rotary_rad[k])));
  return text;
}

std::string machine_moves_text(const bodies::MovesFound& found) {
  if (found.stated == 0) return "none stated, moves of the machine are not checked against each other";
  if (!found.clear()) return fmt::format("NOT clear: {}", meeting_text(found.failed.front(), found.required_mm));
  if (found.nearest.empty()) return fmt::format("clear by more than {:g} mm", found.look_mm);
  const bodies::Meeting& m = found.nearest.front();
  return fmt::format("clear: least {:.2f} mm proven ({} and {}{}, line {}), clearance {:.3f} mm", m.proven_mm, m.second,
                     m.first, place_text(m), m.line, found.required_mm);
}

std::vector<std::string> reasons_of(const machines::Machine& machine, const bodies::MovesFound& found) {
  std::vector<std::string> out;
  for (const bodies::Meeting& m : found.failed)
    out.push_back(fmt::format("machine: line {}: {}, at {}", m.line, meeting_text(m, found.required_mm),
                              joints_text(machine, m.joints)));
  return out;
}

std::vector<std::string> help_for(const bodies::MovesFound& found) {
  std::vector<std::string> out;
  if (found.failed.empty()) return out;
  const auto add = [&](std::string text) {
    if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
  };
  double higher = 0;  // so that all of them keep apart; infinite: no height does
  for (const bodies::Meeting& m : found.failed) higher = std::max(higher, m.higher_mm.value_or(INFINITY));
  if (std::isfinite(higher)) add(fmt::format("setup.origin {:g} mm higher, where they keep apart", higher));
  for (const bodies::Meeting& m : found.failed) {
    const auto either = [&](bodies::Kind kind) { return m.first_kind == kind || m.second_kind == kind; };
    if (either(bodies::Kind::work)) add(fmt::format("a longer tool than T{} (length, stick_out)", m.tool));
    else if (either(bodies::Kind::tool)) add(fmt::format("a longer T{}", m.tool));
    else if (m.neighbours)
      add(fmt::format("touches in the machine file, where \"{}\" and \"{}\" bear on one another", m.first, m.second));
    if (std::isfinite(higher)) continue;
    if (m.machine_place)
      add("axes.Z.max or the bodies in the machine file: the way is to or from the machine's own height");
    else
      add(either(bodies::Kind::work) ? "another setup.origin"
                                     : fmt::format("setup.origin with the gear farther from \"{}\"",
                                                   m.first_kind == bodies::Kind::tool ? m.second : m.first));
  }
  return out;
}

}  // namespace toothpath::report
