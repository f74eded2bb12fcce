#include "app/report/machine_moves.h"

#include <cmath>

#include <fmt/format.h>

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
    text += fmt::format(" {} {:.3f}", machine.chain.rotary(k).letter, degrees(joints.rotary_rad[k]));
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

}  // namespace toothpath::report
