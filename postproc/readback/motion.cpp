// Executed joint moves as motions of the tool in the gear frame, with a proven bound on what is left out.
//
// A move is straight in the joints. With w = sum of the turns of the rotaries, R = the greatest distance of the tip from a
// rotary axis and |dX| the linear step, the tip's second derivative is at most w^2 R + 2 w |dX| (nested rotations, each
// pair of derivatives bounded by the inner arm), so that it stays within an eighth of that from its chord. With TCP the
// control keeps the tip on its chord; the rotaries are linear in time all the same, and the bound of the axis holds.
//
// At a corner that the control may leave within a way (G641), each axis stays between its least and its greatest position on the pieces
// of both blocks: off the corner by the larger of the two pieces, axis by axis. With d of X Y Z, w the sum of the turns and R the distance of
// the corner's tip from the rotary axes, the tip is off by |d| + w (R + |d| + w R) at most, the tool axis by w. With TCP the pieces are of
// the tip itself: |d|, w.
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/readback/reader.h"

namespace toothpath::readback {
namespace {

constexpr double kRapidFactor = 50;  // rapids are cut this much coarser
constexpr int kMostPieces = 1 << 16;
constexpr double kRoundOff = 1e-9;   // mm: of the forward kinematics at 1 m

struct Placed {
  machines::Joints joints;
  machines::TablePose table;
  Vec3 tip, axis;  // W
};

class Motions {
 public:
  Motions(const machines::KinematicChain& chain, const joints::Setup& setup) : chain_(chain), setup_(setup) {}

  machines::Joints joints(const std::array<double, 5>& j) const {
    machines::Joints out;
    out.linear_mm = Vec3(j[0], j[1], j[2]);
    out.rotary_rad = {radians(j[3]), radians(j[4])};
    return out;
  }
  Placed place(const machines::Joints& j, double length) const {
    Placed p;
    p.joints = j;
    p.table = chain_.forward(j, length);
    p.tip = setup_.rotation().transpose() * (p.table.tip_mm - setup_.origin_mm);
    p.axis = setup_.rotation().transpose() * p.table.axis;
    return p;
  }
  static double turn(const machines::Joints& a, const machines::Joints& b) {
    return std::abs(b.rotary_rad[0] - a.rotary_rad[0]) + std::abs(b.rotary_rad[1] - a.rotary_rad[1]);
  }

  /// Greatest distance of the tip from a rotary axis, mm.
  double reach_of(const Placed& p, double length) const {
    double reach = 0, arm = length;
    for (std::size_t k = 0; k < chain_.table.size(); ++k) {
      const Vec3 tip = k == 0 ? p.table.tip_mm : chain_.table_to_machine(p.table.tip_mm, p.joints.rotary_rad);
      reach = std::max(reach, (tip - chain_.table[k].point_mm).cross(chain_.table[k].direction).norm());
    }
    for (const auto& axis : chain_.head) arm += 2 * axis.point_mm.norm();
    return chain_.head.empty() ? reach : std::max(reach, arm);
  }

  /// Bounds of the whole move, tip [mm] and axis [rad]; halving the step divides both by 4 or more.
  std::pair<double, double> bounds(const Placed& a, const Placed& b, double length) const {
    const double w = turn(a.joints, b.joints);
    if (w == 0) return {0, 0};
    const double dx = (b.joints.linear_mm - a.joints.linear_mm).norm();
    double reach = std::max(reach_of(a, length), reach_of(b, length)), slope = 0;
    for (std::size_t k = 0; k < chain_.table.size(); ++k) {
      const machines::RotaryAxis& axis = chain_.table[k];
      for (const Placed* p : {&a, &b}) {
        const Vec3 u = k == 0 ? p->table.axis : chain_.tool_axis_in_machine(p->joints.rotary_rad);
        slope = std::max(slope, u.cross(axis.direction).norm());
      }
    }
    if (!chain_.head.empty()) slope = 1;
    reach += 0.5 * (dx + w * reach);
    // Only the second table axis meets the whole sine of the tool axis when the first does not turn it.
    const bool first_only = chain_.head.empty() && a.joints.rotary_rad[1] == b.joints.rotary_rad[1];
    if (first_only) slope = a.table.axis.cross(chain_.table[0].direction).norm();
    else slope = std::min(1.0, slope + 0.5 * w);
    return {(w * w * reach + 2 * w * dx) / 8, w * w * slope / 4 * 1.1};
  }

  /// How far tip [mm] and tool axis [rad] leave the corner between two moves, by the shares of their blocks.
  std::pair<double, double> corner(const ExecutedMove& before, const ExecutedMove& m, const ExecutedMove* next, double length) const {
    const Placed at = place(joints(m.joints), length);
    std::array<double, 5> off{};
    const auto piece = [&](const ExecutedMove& other, const ExecutedMove& block) {
      if (block.corner_share == 0) return;
      const Placed p = place(joints(other.joints), length);
      const Vec3 way = block.tcp ? p.table.tip_mm - at.table.tip_mm : p.joints.linear_mm - at.joints.linear_mm;
      for (std::size_t a = 0; a < 5; ++a) {
        const double moved = a < 3 ? way[static_cast<int>(a)] : p.joints.rotary_rad[a - 3] - at.joints.rotary_rad[a - 3];
        off[a] = std::max(off[a], double(block.corner_share) * std::abs(moved));
      }
    };
    piece(before, m);
    const bool goes_on = next != nullptr && next->known && next->tool == m.tool;
    if (goes_on) piece(*next, *next);
    const double d = Vec3(off[0], off[1], off[2]).norm(), w = off[3] + off[4];
    const bool tcp = m.tcp && (!goes_on || next->tcp || next->corner_share == 0);
    // The first rotary, which carries the work, moves the tool axis by the sine between them, and the second one may turn it away by off[4].
    const bool table = chain_.head.empty() && !chain_.table.empty();
    const double sine = table ? std::min(1.0, at.table.axis.cross(chain_.table[0].direction).norm() + off[4]) : 1;
    return {tcp ? d : d + w * ((1 + w) * reach_of(at, length) + d), off[3] * sine + off[4]};
  }

 private:
  const machines::KinematicChain& chain_;
  const joints::Setup& setup_;
};

int nearest_tooth(const Vec3& tip, double reference, int teeth) {
  const double step = (std::atan2(tip.y(), tip.x()) - reference) / (2 * kPi) * teeth;
  const int k = static_cast<int>(std::lround(step)) % teeth;
  return k < 0 ? k + teeth : k;
}

}  // namespace

Result<std::vector<path::ToolMotion>> tool_motions(const OperationTrace& trace, const TurnedCopies& copies, const NcControl& control,
                                             const machines::Machine& machine, const joints::Setup& setup, int teeth, double tolerance_mm,
                                             double axis_tolerance_rad) {
  if (!(tolerance_mm > 0) || !(axis_tolerance_rad > 0)) return fail("tolerances of the read-back must be above 0");
  const Motions kinematics(machine.chain, setup);
  const TurnedCopies::Operation* op = nullptr;
  for (const auto& o : copies.operations)
    if (o.operation == trace.operation) op = &o;
  const auto length_of = [&](int tool) -> const double* {
    const auto found = control.tool_length_mm.find(tool);
    return found == control.tool_length_mm.end() ? nullptr : &found->second;
  };
  double reference = 0;
  for (const auto& m : trace.moves)
    if (m.known && !m.rapid && length_of(m.tool) != nullptr) {
      const Vec3 tip = kinematics.place(kinematics.joints(m.joints), *length_of(m.tool)).tip;
      reference = std::atan2(tip.y(), tip.x());
      break;
    }

  // Teeth that were not kept stand where their index words put them: rounded, so off the exact turn by up to this.
  const double shift = copies.copies && trace.kept_teeth == 1 ? radians(copies.worst_shift_deg) : 0;

  std::vector<path::ToolMotion> out;
  out.reserve(trace.moves.size() + 64);
  for (std::size_t i = 1; i < trace.moves.size(); ++i) {
    const ExecutedMove& m = trace.moves[i];
    if (!m.known) continue;  // a change of tool moves nothing: the new one starts where the gauge line stands
    const double* length = length_of(m.tool);
    if (length == nullptr) return fail("line {}: tool {} is not in the tool list", m.line, m.tool);
    const Placed from = kinematics.place(kinematics.joints(trace.moves[i - 1].joints), *length);
    const Placed to = kinematics.place(kinematics.joints(m.joints), *length);
    const double factor = m.rapid ? kRapidFactor : 1;
    auto [tip_bound, axis_bound] = kinematics.bounds(from, to, *length);
    if (m.tcp) tip_bound = 0;
    const double pieces = std::ceil(std::sqrt(std::max(tip_bound / (factor * tolerance_mm), axis_bound / (factor * axis_tolerance_rad))));
    if (pieces > kMostPieces) return fail("line {}: move turns too far to be followed within {} mm", m.line, tolerance_mm);
    const int n = std::max(1, static_cast<int>(pieces));
    int tooth = m.tooth;
    if (tooth < 0 && copies.copies && op != nullptr && op->moves_per_tooth > 0 && !op->turns.empty()) {
      const std::size_t copy = i < trace.lead ? 0 : (i - trace.lead) / op->moves_per_tooth;
      tooth = op->turns[std::min(copy, op->turns.size() - 1)];
    } else if (tooth < 0) {
      tooth = nearest_tooth(to.tip, reference, teeth);
    }
    // The corners at both ends.
    double corner_mm = 0, corner_rad = 0;
    const auto corner = [&](std::size_t k) {
      const auto [tip_off, axis_off] =
          kinematics.corner(trace.moves[k - 1], trace.moves[k], k + 1 < trace.moves.size() ? &trace.moves[k + 1] : nullptr, *length);
      corner_mm = std::max(corner_mm, tip_off);
      corner_rad = std::max(corner_rad, axis_off);
    };
    if (m.corner_share > 0) corner(i);
    if (m.corner_share > 0 && i > 1 && trace.moves[i - 1].known) corner(i - 1);
    Placed start = from;
    for (int piece = 1; piece <= n; ++piece) {
      Placed end = to;
      if (piece < n) {
        const double t = static_cast<double>(piece) / n;
        machines::Joints j;
        j.linear_mm = (1 - t) * from.joints.linear_mm + t * to.joints.linear_mm;
        for (std::size_t k = 0; k < 2; ++k)
          j.rotary_rad[k] = (1 - t) * from.joints.rotary_rad[k] + t * to.joints.rotary_rad[k];
        if (m.tcp)  // the linear joints follow from the tip
          j = machine.chain.linear_for((1 - t) * from.table.tip_mm + t * to.table.tip_mm, j.rotary_rad, *length);
        end = kinematics.place(j, *length);
      }
      const auto [tip_left, axis_left] = kinematics.bounds(start, end, *length);
      path::ToolMotion motion;
      motion.tip_from = start.tip;
      motion.tip_to = end.tip;
      motion.axis_from = start.axis;
      motion.axis_to = end.axis;
      motion.deviation_mm = (m.tcp ? 0 : tip_left) + kRoundOff + double(m.blend_mm) + corner_mm +
                            shift * std::max(motion.tip_from.head<2>().norm(), motion.tip_to.head<2>().norm());
      motion.axis_deviation = axis_left + shift + double(m.blend_axis_rad) + corner_rad;
      motion.minutes = m.minutes / n;
      motion.rapid = m.rapid;
      motion.operation = m.operation;
      motion.tooth = tooth;
      motion.line = m.line;
      out.push_back(motion);
      start = end;
    }
  }
  return out;
}

}  // namespace toothpath::readback
