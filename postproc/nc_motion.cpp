// Executed joint moves as motions of the tool in the gear frame, with a proven bound on what is left out.
//
// A move is straight in the joints. With w = sum of the turns of the rotaries, R = the greatest distance of the tip from a
// rotary axis and |dX| the linear step, the tip's second derivative is at most w^2 R + 2 w |dX| (nested rotations, each
// pair of derivatives bounded by the inner arm), so that it stays within an eighth of that from its chord. With TCP the
// control keeps the tip on its chord; the rotaries are linear in time all the same, and the bound of the axis holds.
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/nc_reader.h"

namespace toothpath {
namespace {

constexpr double kRapidFactor = 50;  // rapids are cut this much coarser
constexpr int kMostPieces = 1 << 16;
constexpr double kRoundOff = 1e-9;   // mm: of the forward kinematics at 1 m

struct Placed {
  Joints joints;
  TablePose table;
  Vec3 tip, axis;  // W
};

class Motions {
 public:
  Motions(const KinematicChain& chain, const Setup& setup) : chain_(chain), setup_(setup) {}

  Joints joints(const std::array<double, 5>& j) const {
    Joints out;
    out.linear_mm = Vec3(j[0], j[1], j[2]);
    out.rotary_rad = {radians(j[3]), radians(j[4])};
    return out;
  }
  Placed place(const Joints& j, double length) const {
    Placed p;
    p.joints = j;
    p.table = chain_.forward(j, length);
    p.tip = setup_.rotation().transpose() * (p.table.tip_mm - setup_.origin_mm);
    p.axis = setup_.rotation().transpose() * p.table.axis;
    return p;
  }
  static double turn(const Joints& a, const Joints& b) {
    return std::abs(b.rotary_rad[0] - a.rotary_rad[0]) + std::abs(b.rotary_rad[1] - a.rotary_rad[1]);
  }

  /// Bounds of the whole move, tip [mm] and axis [rad]; halving the step divides both by 4 or more.
  std::pair<double, double> bounds(const Placed& a, const Placed& b, double length) const {
    const double w = turn(a.joints, b.joints);
    if (w == 0) return {0, 0};
    const double dx = (b.joints.linear_mm - a.joints.linear_mm).norm();
    double reach = 0, slope = 0;
    for (std::size_t k = 0; k < chain_.table.size(); ++k) {
      const RotaryAxis& axis = chain_.table[k];
      for (const Placed* p : {&a, &b}) {
        const Vec3 tip = k == 0 ? p->table.tip_mm : chain_.table_to_machine(p->table.tip_mm, p->joints.rotary_rad);
        reach = std::max(reach, (tip - axis.point_mm).cross(axis.direction).norm());
        const Vec3 u = k == 0 ? p->table.axis : chain_.tool_axis_in_machine(p->joints.rotary_rad);
        slope = std::max(slope, u.cross(axis.direction).norm());
      }
    }
    if (!chain_.head.empty()) {
      double arm = length;
      for (const auto& axis : chain_.head) arm += 2 * axis.point_mm.norm();
      reach = std::max(reach, arm);
      slope = 1;
    }
    reach += 0.5 * (dx + w * reach);
    // Only the second table axis meets the whole sine of the tool axis when the first does not turn it.
    const bool first_only = chain_.head.empty() && a.joints.rotary_rad[1] == b.joints.rotary_rad[1];
    if (first_only) slope = a.table.axis.cross(chain_.table[0].direction).norm();
    else slope = std::min(1.0, slope + 0.5 * w);
    return {(w * w * reach + 2 * w * dx) / 8, w * w * slope / 4 * 1.1};
  }

 private:
  const KinematicChain& chain_;
  const Setup& setup_;
};

int nearest_tooth(const Vec3& tip, double reference, int teeth) {
  const double step = (std::atan2(tip.y(), tip.x()) - reference) / (2 * kPi) * teeth;
  const int k = static_cast<int>(std::lround(step)) % teeth;
  return k < 0 ? k + teeth : k;
}

}  // namespace

Result<std::vector<ToolMotion>> tool_motions(const OperationTrace& trace, const TurnedCopies& copies, const NcControl& control,
                                             const Machine& machine, const Setup& setup, int teeth, double tolerance_mm,
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

  std::vector<ToolMotion> out;
  out.reserve(trace.moves.size() + 64);
  for (std::size_t i = 1; i < trace.moves.size(); ++i) {
    const ExecutedMove& m = trace.moves[i];
    if (!m.known || m.tool != trace.moves[i - 1].tool) continue;
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
    Placed start = from;
    for (int piece = 1; piece <= n; ++piece) {
      Placed end = to;
      if (piece < n) {
        const double t = static_cast<double>(piece) / n;
        Joints j;
        j.linear_mm = (1 - t) * from.joints.linear_mm + t * to.joints.linear_mm;
        for (std::size_t k = 0; k < 2; ++k)
          j.rotary_rad[k] = (1 - t) * from.joints.rotary_rad[k] + t * to.joints.rotary_rad[k];
        if (m.tcp)  // the linear joints follow from the tip
          j = machine.chain.linear_for((1 - t) * from.table.tip_mm + t * to.table.tip_mm, j.rotary_rad, *length);
        end = kinematics.place(j, *length);
      }
      const auto [tip_left, axis_left] = kinematics.bounds(start, end, *length);
      ToolMotion motion;
      motion.tip_from = start.tip;
      motion.tip_to = end.tip;
      motion.axis_from = start.axis;
      motion.axis_to = end.axis;
      motion.deviation_mm = (m.tcp ? 0 : tip_left) + kRoundOff + double(m.blend_mm) +
                            shift * std::max(motion.tip_from.head<2>().norm(), motion.tip_to.head<2>().norm());
      motion.axis_deviation = axis_left + shift;
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

}  // namespace toothpath
