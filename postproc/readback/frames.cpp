// Frames that words stand in: the work offset, one that the program writes, zeros of rotaries that it moves, and tilted
// planes.
//
// Tilted planes of the control (G68.2 with G53.1, CYCLE800, PLANE SPATIAL): the plane is fixed to the table, and words
// in it are coordinates of the tip. With R its rotation, o its origin and the rotaries at t, T(t) the turn of the table
// frame into the machine, the tip is at T(o) + T R w: T R e_z = e_z where the tool stands upright on it, and T R turns
// about Z by what the pair of angles leaves. Written from the makers' manuals.
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "postproc/readback/execution.h"

namespace toothpath::readback {
namespace {

constexpr double kGrid = 1 << 30;       // 1/deg: with whole turns added a place stays the same number
constexpr double kUpright = 1e-9;       // sine of the angle between tool and plane: round-off
constexpr double kAlongAxes = 1e-11;    // sine of a turn that is none
constexpr double kWholeTurn = 360;      // deg
constexpr double kInsideTravel = 1e-7;  // deg

double half_turn_place(double deg) { return std::nearbyint(std::remainder(deg, kWholeTurn) * kGrid) / kGrid; }

/// Right-handed and orthonormal.
bool is_rotation(const Mat3& r) {
  return (r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff() < kUpright && r.determinant() > 0;
}

}  // namespace

NcExecution::Problem NcExecution::select_offset(const std::string& name) {
  const bool written = !name.empty() && name == control_.index_offset;
  if (written && !written_) return fmt::format("work offset {} ahead of the line that writes it", name);
  const auto found = control_.work_offsets.find(name);
  if (!written && found == control_.work_offsets.end()) return fmt::format("work offset {} is not defined", name);
  const Vec3& at = written ? written_->at_mm : found->second;
  if (tcp_ && !rules_.offsets_turn && offset_ != at) return "another work offset with TCP on";
  if (plane_ && offset_ != at) return "another work offset in a tilted plane";
  offset_ = at;
  in_written_ = written;
  if (rules_.offsets_turn) frame_deg_ = written ? written_->turn_deg : 0;
  return std::nullopt;
}

NcExecution::Problem NcExecution::write_offset(const std::optional<Vec3>& at_mm, double turn_deg) {
  if (in_written_) return fmt::format("{} is written while words count from it", control_.index_offset);
  if (!at_mm && !written_)
    return fmt::format("{} is turned ahead of the line that says where it is", control_.index_offset);
  written_ = WrittenOffset{at_mm ? *at_mm : written_->at_mm, turn_deg};
  return std::nullopt;
}

NcExecution::Problem NcExecution::move_zero(std::size_t axis, double degrees, std::string_view word) {
  if (tcp_) return fmt::format("{} moves the zero of {} with TCP on", word, control_.letters[axis]);
  if (!zeros_cleared_ && degrees != 0)
    return fmt::format("{} ahead of the line that clears it: what an earlier program has left is not known", word);
  if (control_.rollover[axis] && rules_.sign_is_sense && !(std::abs(degrees) < kWholeTurn))
    return fmt::format("{} moves the zero of {}, which rolls over, by {} deg, outside -360 .. 360", word,
                       control_.letters[axis], degrees);
  set_zero(axis, degrees);
  return std::nullopt;
}

NcExecution::Problem NcExecution::replace_zeros(std::size_t axis, double degrees, std::string_view word) {
  if (zero_[axis] == degrees && zero_[7 - axis] == 0) return std::nullopt;
  if (auto bad = clear_zeros()) return bad;
  return move_zero(axis, degrees, word);
}

/// Nothing turns: the axis stands elsewhere in its words.
void NcExecution::set_zero(std::size_t axis, double degrees) {
  rolled_[axis] -= degrees - zero_[axis];
  zero_[axis] = degrees;
}

NcExecution::Problem NcExecution::clear_zeros() {
  if (tcp_ && (zero_[3] != 0 || zero_[4] != 0)) return "the zero of a rotary goes back with TCP on";
  for (const std::size_t a : {3U, 4U}) set_zero(a, 0);
  zeros_cleared_ = true;
  return std::nullopt;
}

/// Nothing that a program has moved may be left to the next one.
NcExecution::Problem NcExecution::zeros_allow_end() const {
  for (std::size_t a = 3; a < 5; ++a)
    if (zero_[a] != 0)
      return fmt::format("program end while {} counts from {} deg: the next program would begin there",
                         control_.letters[a], zero_[a]);
  if (in_written_) return fmt::format("program end in {}: the next program would begin there", control_.index_offset);
  if (written_ && written_->turn_deg != 0)
    return fmt::format("program end while {} is turned by {} deg: the next program would find it so",
                       control_.index_offset, written_->turn_deg);
  return std::nullopt;
}

NcExecution::Problem NcExecution::define_plane(const Vec3& origin_mm, const Mat3& rotation, std::string_view word) {
  if (!control_.plane_chain)
    return fmt::format("{}: this control has no tilted planes, or none with a zero of a rotary that is not 0", word);
  if (!control_.plane_chain->head.empty() || control_.plane_chain->table.size() != 2)
    return fmt::format("{} on a machine without two rotaries in its table is not in the subset", word);
  if (tcp_) return fmt::format("{} with TCP on", word);
  if (frame_deg_ != 0) return fmt::format("{} in a turned frame", word);
  for (std::size_t a = 3; a < 5; ++a)
    if (zero_[a] != 0)
      return fmt::format("{} while {} counts from {} deg, limit 0: its zero must be moved back ahead of it", word,
                         control_.letters[a], zero_[a]);
  if (!offset_) return fmt::format("{} ahead of a work offset", word);
  if (!is_rotation(rotation)) return fmt::format("{}: the angles are no rotation", word);
  plane_.emplace();
  plane_->origin_mm = origin_mm;
  plane_->rotation = rotation;
  return std::nullopt;
}

/// A place of a rotary in the turn nearest to where it stands, of those within its travel where there are any.
double NcExecution::turn_within_travel(std::size_t rotary, double deg) const {
  const double now = std::isnan(joints_[3 + rotary]) ? 0 : joints_[3 + rotary];
  const double nearest = deg + kWholeTurn * std::round((now - deg) / kWholeTurn);
  const machines::RotaryAxis& axis = control_.plane_chain->rotary(rotary);
  if (axis.rollover) return nearest;
  const double least = degrees(axis.min_rad) - kInsideTravel, most = degrees(axis.max_rad) + kInsideTravel;
  const auto inside = [&](double at) { return at >= least && at <= most; };
  if (inside(nearest)) return nearest;
  const double lowest = deg + kWholeTurn * std::ceil((least - deg) / kWholeTurn);
  const double highest = deg + kWholeTurn * std::floor((most - deg) / kWholeTurn);
  if (!inside(lowest)) return nearest;  // nowhere: that the travel is exceeded is told of the move
  return std::abs(lowest - now) <= std::abs(highest - now) ? lowest : highest;
}

NcExecution::Problem NcExecution::turn_to_plane(PlanePair pair, std::string_view word, std::int32_t line) {
  if (!plane_) return fmt::format("{} without a tilted plane", word);
  const machines::KinematicChain& chain = *control_.plane_chain;
  const auto solutions = chain.rotary_solutions(plane_->rotation.col(2));
  if (!solutions) return fmt::format("{}: {}", word, solutions.error().message);
  const machines::JointSolution* taken = nullptr;
  for (const machines::JointSolution& s : *solutions) {
    if (s.free_rotary >= 0)
      return fmt::format("{}: the tool stands along {}, whose angle the plane leaves open", word,
                         chain.rotary(static_cast<std::size_t>(s.free_rotary)).letter);
    const double tilt = std::remainder(s.joints.rotary_rad[1] - chain.rotary(1).zero_rad, 2 * kPi);
    if (pair == PlanePair::not_below_zero ? tilt >= 0 : tilt <= 0) taken = &s;
  }
  if (taken == nullptr) return fmt::format("{}: no angle of {} on that side of its zero", word, chain.rotary(1).letter);
  Move m;
  m.rapid = true;
  std::array<double, 2> at{};
  for (std::size_t k = 0; k < 2; ++k) {
    plane_->at_deg[k] = half_turn_place(degrees(taken->joints.rotary_rad[k]));
    at[k] = radians(plane_->at_deg[k]);
    m.has[3 + k] = true;
    m.axis[3 + k] = turn_within_travel(k, plane_->at_deg[k]);
  }
  const Mat3 table = chain.rotary(0).rotation(at[0]) * chain.rotary(1).rotation(at[1]);
  const Mat3 left = table.transpose() * plane_->rotation;
  plane_->cosine = left(0, 0);
  plane_->sine = left(1, 0);
  if (std::abs(plane_->sine) < kAlongAxes) {
    plane_->cosine = plane_->cosine > 0 ? 1 : -1;
    plane_->sine = 0;
  }
  plane_->zero_mm = chain.table_to_machine(*offset_ + plane_->origin_mm, at);
  plane_->state = TiltedPlane::State::turning;
  if (auto bad = move_to(m, line)) return bad;
  plane_->state = TiltedPlane::State::turned;
  return std::nullopt;
}

/// Words in the plane; the turn to it has rotary words alone.
NcExecution::Problem NcExecution::plane_goal(const Move& m, std::array<double, 5>& joints,
                                             std::uint8_t& commanded) const {
  if (m.machine_frame) return "machine coordinates in a tilted plane: it must be switched off ahead";
  for (std::size_t a = 0; a < 5; ++a) {
    if (!m.has[a]) continue;
    commanded = static_cast<std::uint8_t>(commanded | (1U << a));
    if (a >= 3 && plane_->state != TiltedPlane::State::turning)
      return "a rotary word in a tilted plane: the plane says where the rotaries stand";
    if (a >= 3) joints[a] = m.axis[a];
    else if (plane_->state != TiltedPlane::State::turned)
      return "an axis word in a tilted plane to which the rotaries have not been turned";
  }
  if (m.has[2]) {
    if (!length_) return "Z word without tool length compensation";
    joints[2] = plane_->zero_mm.z() + m.axis[2] + *length_;
  }
  if (!m.has[0] && !m.has[1]) return std::nullopt;
  const double c = plane_->cosine, s = plane_->sine;
  if (s == 0) {  // an axis without a word stays, bit for bit
    for (std::size_t a = 0; a < 2; ++a)
      if (m.has[a]) joints[a] = plane_->zero_mm[static_cast<int>(a)] + c * m.axis[a];
    return std::nullopt;
  }
  const double x = joints[0] - plane_->zero_mm.x(), y = joints[1] - plane_->zero_mm.y();
  const double u = m.has[0] ? m.axis[0] : c * x + s * y, v = m.has[1] ? m.axis[1] : c * y - s * x;
  joints[0] = plane_->zero_mm.x() + c * u - s * v;
  joints[1] = plane_->zero_mm.y() + s * u + c * v;
  return std::nullopt;
}

}  // namespace toothpath::readback
