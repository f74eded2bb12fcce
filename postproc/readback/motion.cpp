// Executed joint moves as motions of the tool in the gear frame, with a proven bound on what is left out.
//
// A move is straight in the joints. With w = sum of the turns of the rotaries, R = the greatest distance of the tip
// from a rotary axis and |dX| the linear step, the tip's second derivative is at most w^2 R + 2 w |dX| (nested
// rotations, each pair of derivatives bounded by the inner arm), so that it stays within an eighth of that from its
// chord. With TCP the control keeps the tip on its chord; the rotaries are linear in time all the same, and the bound
// of the axis holds.
//
// At a corner that the control may leave within a way (G641), each axis stays between its least and its greatest
// position on the pieces of both blocks: off the corner by the larger of the two pieces, axis by axis. With d of X Y Z,
// w the sum of the turns and R the distance of the corner's tip from the rotary axes, the tip is off by |d| + w (R +
// |d| + w R) at most, the tool axis by w. With TCP the pieces are of the tip itself: |d|, w.
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/base/angle.h"
#include "postproc/readback/reader.h"

namespace toothpath::readback {
namespace {

constexpr double kRapidFactor = 50;  // rapids are cut this much coarser
constexpr int kMostPieces = 1 << 16;
constexpr double kRoundOff = 1e-9;  // mm: of the forward kinematics at 1 m

struct Placed {
  machines::Joints joints;
  machines::TablePose table;
  Vec3 tip, axis;  // W
  // Taken when they are asked for: the end of a motion is the beginning of the next.
  mutable bool measured = false;
  mutable double reach = 0;  // of the tip from a rotary axis
  mutable double slope = 0;  // greatest sine between the tool axis and a rotary axis of the table
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
    p.tip = in_work(p.table.tip_mm);
    p.axis = turned_to_work(p.table.axis);
    return p;
  }
  /// From the table frame to W.
  Vec3 in_work(const Vec3& point_mm) const { return setup_.rotation().transpose() * (point_mm - setup_.origin_mm); }
  Vec3 turned_to_work(const Vec3& direction) const { return setup_.rotation().transpose() * direction; }
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
    for (const Placed* p : {&a, &b}) measure(*p, length);
    double reach = std::max(a.reach, b.reach), slope = std::max(a.slope, b.slope);
    if (!chain_.head.empty()) slope = 1;
    reach += 0.5 * (dx + w * reach);
    // Only the second table axis meets the whole sine of the tool axis when the first does not turn it.
    const bool first_only = chain_.head.empty() && a.joints.rotary_rad[1] == b.joints.rotary_rad[1];
    if (first_only) slope = a.table.axis.cross(chain_.table[0].direction).norm();
    else slope = std::min(1.0, slope + 0.5 * w);
    return {(w * w * reach + 2 * w * dx) / 8, w * w * slope / 4 * 1.1};
  }

  /// How far tip [mm] and tool axis [rad] leave the corner between two moves, by the shares of their blocks.
  std::pair<double, double> corner(const ExecutedMove& before, const ExecutedMove& m, const ExecutedMove* next,
                                   double length) const {
    const Placed at = place(joints(m.joints), length);
    std::array<double, 5> off{};
    const auto piece = [&](const ExecutedMove& other, const ExecutedMove& block) {
      if (block.corner_share == 0) return;
      const Placed p = place(joints(other.joints), length);
      const Vec3 way = block.tcp ? p.table.tip_mm - at.table.tip_mm : p.joints.linear_mm - at.joints.linear_mm;
      for (std::size_t a = 0; a < 5; ++a) {
        const double moved =
            a < 3 ? way[static_cast<int>(a)] : p.joints.rotary_rad[a - 3] - at.joints.rotary_rad[a - 3];
        off[a] = std::max(off[a], double(block.corner_share) * std::abs(moved));
      }
    };
    piece(before, m);
    const bool goes_on = next != nullptr && next->known && next->tool == m.tool;
    if (goes_on) piece(*next, *next);
    const double d = Vec3(off[0], off[1], off[2]).norm(), w = off[3] + off[4];
    const bool tcp = m.tcp && (!goes_on || next->tcp || next->corner_share == 0);
    // The first rotary, which carries the work, moves the tool axis by the sine between them, and the second one may
    // turn it away by off[4].
    const bool table = chain_.head.empty() && !chain_.table.empty();
    const double sine = table ? std::min(1.0, at.table.axis.cross(chain_.table[0].direction).norm() + off[4]) : 1;
    return {tcp ? d : d + w * ((1 + w) * reach_of(at, length) + d), off[3] * sine + off[4]};
  }

 private:
  void measure(const Placed& p, double length) const {
    if (p.measured) return;
    p.measured = true;
    p.reach = reach_of(p, length);
    for (std::size_t k = 0; k < chain_.table.size(); ++k) {
      const Vec3 u = k == 0 ? p.table.axis : chain_.tool_axis_in_machine(p.joints.rotary_rad);
      p.slope = std::max(p.slope, u.cross(chain_.table[k].direction).norm());
    }
  }

  const machines::KinematicChain& chain_;
  const joints::Setup& setup_;
};

int nearest_tooth(const Vec3& tip, double reference, int teeth) {
  const double step = (std::atan2(tip.y(), tip.x()) - reference) / (2 * kPi) * teeth;
  const int k = static_cast<int>(std::lround(step)) % teeth;
  return k < 0 ? k + teeth : k;
}

/// The moves of one trace, one by one, as motions in W.
class TraceFollower {
 public:
  TraceFollower(const OperationTrace& trace, const TurnedCopies& copies, const Followed& by,
                std::vector<path::ToolMotion>& out)
      : trace_(trace),
        copies_(copies),
        control_(by.control),
        machine_(by.machine),
        kinematics_(by.machine.chain, by.setup),
        teeth_(by.teeth),
        tolerances_(by.tolerances),
        truly_(by.truly),
        unwanted_(by.moves == Followed::Moves::all ? std::nullopt : std::optional(by.moves == Followed::Moves::feeds)),
        // Teeth that were not kept stand where their index words put them: rounded, so off the exact turn by up to
        // this.
        shift_(copies.copies && trace.kept_teeth == 1 ? radians(copies.worst_shift_deg) : 0),
        reference_(first_cut_angle()),
        out_(out) {
    for (const auto& o : copies.operations)
      if (o.operation == trace.operation) operation_ = &o;
  }

  Status run() {
    for (std::size_t i = std::max<std::size_t>(1, trace_.before); i + trace_.after < trace_.moves.size(); ++i) {
      if (!trace_.moves[i].known || unwanted_ == trace_.moves[i].rapid)
        continue;  // a change of tool moves nothing: the new one starts where the gauge line stands
      if (auto s = follow(i); !s) return s.error();
    }
    return Ok{};
  }

 private:
  [[nodiscard]] const double* length_of(int tool) const {
    const auto found = control_.tool_length_mm.find(tool);
    return found == control_.tool_length_mm.end() ? nullptr : &found->second;
  }
  /// Where the first cut stands about the gear axis: tooth space 0 is there.
  [[nodiscard]] double first_cut_angle() const {
    for (const auto& m : trace_.moves)
      if (m.known && !m.rapid && length_of(m.tool) != nullptr) {
        const Vec3 tip = kinematics_.place(kinematics_.joints(m.joints), *length_of(m.tool)).tip;
        return std::atan2(tip.y(), tip.x());
      }
    return 0;
  }
  /// Tooth space of move i: named in the program, known from the copies, or the nearest.
  [[nodiscard]] int tooth_of(std::size_t i, const Vec3& tip) const {
    const int named = trace_.moves[i].tooth;
    if (named >= 0) return named;
    if (!copies_.copies || operation_ == nullptr || operation_->moves_per_tooth == 0 || operation_->turns.empty())
      return nearest_tooth(tip, reference_, teeth_);
    return operation_->turn_of(i);
  }
  /// What the corners at both ends of move i may leave, mm and rad.
  [[nodiscard]] std::pair<double, double> corners(std::size_t i, double length) const {
    const auto& moves = trace_.moves;
    double most_mm = 0, most_rad = 0;
    const auto corner = [&](std::size_t k) {
      const auto [tip_off, axis_off] =
          kinematics_.corner(moves[k - 1], moves[k], k + 1 < moves.size() ? &moves[k + 1] : nullptr, length);
      most_mm = std::max(most_mm, tip_off);
      most_rad = std::max(most_rad, axis_off);
    };
    if (moves[i].corner_share > 0) corner(i);
    if (moves[i].corner_share > 0 && i > 1 && moves[i - 1].known) corner(i - 1);
    return {most_mm, most_rad};
  }
  /// A place within a move; with TCP the linear joints follow from the tip.
  [[nodiscard]] Placed between(const Placed& from, const Placed& to, double t, bool tcp, double length) const {
    machines::Joints j;
    j.linear_mm = (1 - t) * from.joints.linear_mm + t * to.joints.linear_mm;
    for (std::size_t k = 0; k < 2; ++k)
      j.rotary_rad[k] = (1 - t) * from.joints.rotary_rad[k] + t * to.joints.rotary_rad[k];
    if (tcp) j = machine_.chain.linear_for((1 - t) * from.table.tip_mm + t * to.table.tip_mm, j.rotary_rad, length);
    return kinematics_.place(j, length);
  }

  /// Tip and axis in W, as the tool truly stands.
  [[nodiscard]] std::pair<Vec3, Vec3> stands(const Placed& p, int tool) const {
    if (!truly_) return {p.tip, p.axis};
    const machines::TablePose pose = truly_(p.joints, tool);
    return {kinematics_.in_work(pose.tip_mm), kinematics_.turned_to_work(pose.axis)};
  }

  Status follow(std::size_t i) {
    const ExecutedMove& m = trace_.moves[i];
    const double* length = length_of(m.tool);
    if (length == nullptr) return fail_at({"", m.line, 0}, "tool {} is not in the tool list", m.tool);
    const bool goes_on = ended_ > 0 && ended_ == i - 1 && trace_.moves[i - 1].tool == m.tool;
    const Placed from = goes_on ? end_ : kinematics_.place(kinematics_.joints(trace_.moves[i - 1].joints), *length);
    const Placed to = kinematics_.place(kinematics_.joints(m.joints), *length);
    const double factor = m.rapid ? kRapidFactor : 1;
    const auto whole = kinematics_.bounds(from, to, *length);
    const double tip_bound = m.tcp ? 0 : whole.first, axis_bound = whole.second;
    const double pieces = std::ceil(
        std::sqrt(std::max(tip_bound / (factor * tolerances_.tip_mm), axis_bound / (factor * tolerances_.axis_rad))));
    if (pieces > kMostPieces)
      return fail_at({"", m.line, 0}, "this move turns too far to be followed within {} mm", tolerances_.tip_mm);
    const int n = std::max(1, static_cast<int>(pieces));
    if (out_.size() + static_cast<std::size_t>(n) > tolerances_.most)
      return fail(
          "line {}: more than {} motions of the tool, {} bytes each, would have to be kept to follow the "
          "program within {} mm",
          m.line, tolerances_.most, sizeof(path::ToolMotion), tolerances_.tip_mm);
    const int tooth = tooth_of(i, to.tip);
    const auto [corner_mm, corner_rad] = corners(i, *length);
    Placed start = from;
    for (int piece = 1; piece <= n; ++piece) {
      const Placed end = piece < n ? between(from, to, static_cast<double>(piece) / n, m.tcp, *length) : to;
      const auto [tip_left, axis_left] = n == 1 ? whole : kinematics_.bounds(start, end, *length);
      path::ToolMotion motion;
      const auto [tip_from, axis_from] = stands(start, m.tool);
      const auto [tip_to, axis_to] = stands(end, m.tool);
      motion.tip_from = tip_from;
      motion.tip_to = tip_to;
      motion.axis_from = axis_from;
      motion.axis_to = axis_to;
      motion.deviation_mm = (m.tcp ? 0 : tip_left) + kRoundOff + double(m.blend_mm) + corner_mm +
                            length_off_mm(m, control_.tool_check) +
                            shift_ * std::max(motion.tip_from.head<2>().norm(), motion.tip_to.head<2>().norm());
      motion.axis_deviation = axis_left + shift_ + double(m.blend_axis_rad) + corner_rad;
      motion.minutes = m.minutes / n;
      motion.rapid = m.rapid;
      motion.operation = m.operation;
      motion.tooth = tooth;
      motion.line = m.line;
      out_.push_back(motion);
      start = end;
    }
    ended_ = i;
    end_ = start;
    return Ok{};
  }

  const OperationTrace& trace_;
  const TurnedCopies& copies_;
  const NcControl& control_;
  const machines::Machine& machine_;
  const Motions kinematics_;
  int teeth_;
  MotionTolerances tolerances_;
  const std::function<machines::TablePose(const machines::Joints&, int tool)>& truly_;
  std::optional<bool> unwanted_;  ///< rapids, or feeds
  double shift_, reference_;
  std::size_t ended_ = 0;  ///< move whose end is known, not 0
  Placed end_;
  const TurnedCopies::Operation* operation_ = nullptr;
  std::vector<path::ToolMotion>& out_;
};

}  // namespace

Status add_tool_motions(const OperationTrace& trace, const TurnedCopies& copies, const Followed& by,
                        std::vector<path::ToolMotion>& motions) {
  if (!(by.tolerances.tip_mm > 0) || !(by.tolerances.axis_rad > 0))
    return fail("tolerances of the read-back must be above 0");
  return TraceFollower(trace, copies, by, motions).run();
}

Result<std::vector<path::ToolMotion>> tool_motions(const OperationTrace& trace, const TurnedCopies& copies,
                                                   const NcControl& control, const machines::Machine& machine,
                                                   const joints::Setup& setup, int teeth,
                                                   const MotionTolerances& tolerances) {
  std::vector<path::ToolMotion> motions;
  motions.reserve(trace.moves.size() + 64);
  if (auto s = add_tool_motions(trace, copies, {control, machine, setup, teeth, tolerances}, motions); !s)
    return s.error();
  return motions;
}

}  // namespace toothpath::readback
