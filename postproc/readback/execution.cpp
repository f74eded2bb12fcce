#include "postproc/readback/execution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/angle.h"
#include "postproc/choice/solution.h"
#include "postproc/tool_check/lines.h"

namespace toothpath::readback {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kTipStill = 1e-9;    // mm: round-off of a tip that does not move
constexpr double kZeroRotary = 1e-9;  // deg
constexpr double kLongestBlock_min = 1440;
constexpr double kFullTurn = 360;             // deg
constexpr double kHalfTurn = 180 - 1e-6;      // deg: from here on round-off decides which way is the nearer one
constexpr double kBelowZero = 1e-9;           // deg: round-off of a remainder
constexpr double kLastDigit = 0.5e-3 + 1e-9;  // mm: half of the last one that lines of a check are printed with
constexpr double kAtTop = 1e-3;               // mm
constexpr double kFlip = 170;  // deg: a tool vector that turns further in one block leaves the plane of the turn open

bool known(const std::array<double, 5>& joints) {
  return std::none_of(joints.begin(), joints.end(), [](double v) { return std::isnan(v); });
}

std::uint64_t print_of(const Vec3& v) {
  std::uint64_t h = 14695981039346656037ULL;
  for (int i = 0; i < 3; ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(v[i]);
    for (int k = 0; k < 64; k += 8) h = (h ^ ((bits >> k) & 0xff)) * 1099511628211ULL;
  }
  return h;
}

/// A place within one turn, on a grid of 2^-30 deg: with whole turns added it stays the same number.
double on_grid(double deg) { return std::ldexp(std::nearbyint(std::ldexp(deg, 30)), -30); }

/// The same place as `deg`, in the turn nearest to `now`.
double turned_on(double deg, double now) {
  const double place = on_grid(std::remainder(deg, kFullTurn));
  return place + kFullTurn * std::round((now - place) / kFullTurn);
}

/// Where LinuxCNC takes an axis that rolls over and stands at `now` (published source, 2.9): the sign is the sense.
double by_sign(double word, double now) {
  const double to = std::abs(word) + std::floor(now / kFullTurn) * kFullTurn;
  if (!std::signbit(word) && to < now) return to + kFullTurn;
  if (std::signbit(word) && to > now) return to - kFullTurn;
  return to;
}

Vec3 turned_deg(const Vec3& v, double deg) { return deg == 0 ? v : turned(v, radians(deg)); }

/// What is said of a block that takes longer than a day: its F is wrong, or an axis goes much too far.
std::string block_of_days(double minutes, const std::array<double, 5>& from, const std::array<double, 5>& to) {
  std::size_t far = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::abs(to[a] - from[a]) > std::abs(to[far] - from[far])) far = a;
  return fmt::format(
      "the block takes {:.6g} min, more than {:g} (a day), and {} goes {:.4g} m: is its F right, and is no "
      "decimal point lost?",
      minutes, kLongestBlock_min, "XYZ"[far], std::abs(to[far] - from[far]) / 1000);
}

}  // namespace

int group_of_m(int m) {
  switch (m) {
    case 0:
    case 1:
    case 2:
    case 30: return kStops;
    case 3:
    case 5:
    case 13: return 7;
    case 6: return 6;
    case 97:
    case 98:
    case 99: return kCalls;
    default: return kCoolants;
  }
}

bool clash_of_m(const NcControl& control, int one, int other) {
  if (group_of_m(one) != group_of_m(other)) return group_of_m(one) == kCalls || group_of_m(other) == kCalls;
  if (group_of_m(one) != kCoolants || one == other) return true;
  const auto axis = control.clamped_by(fmt::format("M{}", one));
  if (axis && axis == control.clamped_by(fmt::format("M{}", other))) return true;
  // Two coolants may go on together.
  const auto ends = [&](int m) {
    const std::string word = fmt::format("M{}", m);
    return std::any_of(control.coolants.begin(), control.coolants.end(),
                       [&](const auto& c) { return c.second.off == word; });
  };
  return ends(one) || ends(other);
}

NcExecution::NcExecution(const NcControl& control, const NcRules& rules,
                         const std::function<void(const ExecutedMove&)>& sink)
    : control_(control), rules_(rules), sink_(sink) {
  joints_.fill(kUnknown);
  rolled_.fill(kUnknown);
  for (std::size_t a = 0; a < 5; ++a)
    if (control.letters[a] == 0) joints_[a] = 0;
}

void NcExecution::begin_operation(int operation) {
  operation_ = operation;
  ++piece_;
  clamps_.fill(Clamp::unknown);  // it may be begun with by hand
  spindle_set_ = false;
  tooth_ = -1;
}

void NcExecution::set_feed_mode(Feed mode) {
  if (feed_mode_ != mode) feed_.reset();
  feed_mode_ = mode;
}

NcExecution::Problem NcExecution::set_feed(double f) {
  if (!(f > 0)) return "F must be above 0";
  feed_ = f;
  return std::nullopt;
}

NcExecution::Problem NcExecution::set_speed(double s) {
  if (!(s > 0)) return "S must be above 0";
  spindle_set_ = true;
  speed_ = s;
  return std::nullopt;
}

NcExecution::Problem NcExecution::choose_tool(double number) {
  if (!(std::abs(number) < 1e6) || number != std::floor(number) ||
      control_.tool_length_mm.count(static_cast<int>(number)) == 0)
    return fmt::format("tool {} is not in the tool list", number);
  next_tool_ = static_cast<int>(number);
  return std::nullopt;
}

NcExecution::Problem NcExecution::change_tool() {
  if (spindle_) return "tool change while the spindle turns";
  if (feed_mode_ == Feed::inverse_time) return "tool change in G93";
  if (tcp_) return "tool change with TCP on";
  if (plane_) return "tool change in a tilted plane: it must be switched off ahead";
  if (!retracted_) return "tool change without a machine retract before it";
  if (next_tool_ < 0) return "tool change without a T word";
  checked_ = checked_ && tool_ == next_tool_;
  tool_ = next_tool_;
  clamps_.fill(Clamp::unknown);
  return std::nullopt;
}

NcExecution::Problem NcExecution::spindle_on() {
  if (!spindle_set_ && tool_ < 0) return "the spindle starts before a tool was called and S was said";
  if (!spindle_set_ || operation_ < 0) return "M3 without an S word of this operation";
  spindle_ = true;
  spindle_doubt_ = false;
  return std::nullopt;
}

void NcExecution::stop() {
  clamps_.fill(Clamp::unknown);
  if (rules_.stop == ProgramStop::waits) return;
  spindle_doubt_ = spindle_doubt_ || (spindle_ && rules_.stop == ProgramStop::in_doubt);
  coolant_doubt_ = coolant_doubt_ || (coolants_ != 0 && rules_.stop == ProgramStop::in_doubt);
  if (rules_.stop == ProgramStop::in_doubt) return;
  spindle_ = false;
  coolants_ = 0;
}

std::optional<NcExecution::CheckFault> NcExecution::check_tool(int tool, std::span<const std::string_view> lines,
                                                               std::int32_t line) {
  if (auto bad = may_check()) return CheckFault{0, 1, std::move(*bad)};
  if (tool != tool_)
    return CheckFault{0, 1, fmt::format("a check of tool {} while tool {} is in the spindle", tool, tool_)};
  if (lines.size() < check_lines())
    return CheckFault{0, 1,
                      fmt::format("{} lines behind the check of the tool, it has {}", lines.size(), check_lines())};
  if (auto bad = check_says(lines)) return bad;
  if (auto bad = check_ways(line)) return CheckFault{0, 1, std::move(*bad)};
  forget_modes();
  checked_ = true;
  return std::nullopt;
}

NcExecution::Problem NcExecution::may_check() const {
  if (tool_ < 0) return "a check of the tool without a tool in the spindle";
  if (control_.tool_length_mm.count(tool_) == 0) return fmt::format("tool {} is not in the tool list", tool_);
  if (tcp_) return "a check of the tool with TCP on";
  if (plane_) return "a check of the tool in a tilted plane: it must be switched off ahead";
  if (spindle_) return "a check of the tool while the spindle turns: M5 must stand ahead";
  if (feed_mode_ == Feed::inverse_time) return "a check of the tool in G93";
  if (site_smoothing_) return "a check of the tool while the control's own smoothing is on";
  for (std::size_t a = 3; a < 5; ++a)
    if (zero_[a] != 0)
      return fmt::format("a check of the tool while {} counts from {} deg, limit 0", control_.letters[a], zero_[a]);
  if (!retracted_) return "a check of the tool without a machine retract ahead of it";
  if (!(joints_[2] >= control_.top_mm - kAtTop))
    return fmt::format("a check of the tool with Z at {:.4f}, it must stand at its top, {:.4f}", joints_[2],
                       control_.top_mm);
  return std::nullopt;
}

/// Every line is that of the machine, and its numbers are the ones that they must be.
std::optional<NcExecution::CheckFault> NcExecution::check_says(std::span<const std::string_view> lines) const {
  const machines::ToolCheck& check = *control_.tool_check;
  const double length = control_.tool_length_mm.at(tool_), top = control_.top_mm;
  std::map<std::string, double, std::less<>> meant = {{"tool", tool_},
                                                      {"length", length},
                                                      {"clearance", check.clearance_mm},
                                                      {"x", check.position_mm.x()},
                                                      {"y", check.position_mm.y()},
                                                      {"z", check.position_mm.z()},
                                                      {"feed", check.feed_mm_min},
                                                      {"top", top}};
  if (offset_) meant["work_top"] = top - length - offset_->z();
  const auto stated = control_.check_tolerance_mm.find(tool_);
  const double most = stated == control_.check_tolerance_mm.end() ? 0 : stated->second;
  std::optional<double> label;
  for (std::size_t i = 0; i < check.lines.size(); ++i) {
    const auto numbers = tool_check::numbers_of(check.lines[i], lines[i]);
    if (!numbers)
      return CheckFault{i + 1, 1,
                        fmt::format("line {} of the check of the tool must be \"{}\"", i + 1, check.lines[i])};
    for (const tool_check::SaidNumber& n : *numbers) {
      const auto wrong = [&](double must) {
        return CheckFault{
            i + 1, n.column,
            fmt::format("the check of tool {} says {} = {:g}, must be {:g}", tool_, n.name, n.value, must)};
      };
      if (n.name == "label" || n.name == "label+1") {
        const double base = n.value - (n.name == "label" ? 0 : 1);
        if (label && base != *label) return wrong(*label + n.value - base);
        label = base;
      } else if (n.name == "tolerance") {
        if (!(n.value > 0 && n.value <= most + 1e-9))
          return CheckFault{i + 1, n.column,
                            fmt::format("the check of tool {} lets {:g} mm pass, limit {:g}: the tolerance of the job "
                                        "or of the machine file",
                                        tool_, n.value, most)};
      } else if (const auto found = meant.find(n.name); found == meant.end()) {
        return CheckFault{i + 1, n.column, fmt::format("the check names {{{}}}, which is not known here", n.name)};
      } else if (!(std::abs(n.value - found->second) <= kLastDigit)) {
        return wrong(found->second);
      }
    }
  }
  return std::nullopt;
}

/// At the top over the setter, down to its clearance: what follows is meant to touch.
NcExecution::Problem NcExecution::check_ways(std::int32_t line) {
  const machines::ToolCheck& check = *control_.tool_check;
  Move across;
  across.rapid = across.machine_frame = across.to_reference = true;
  across.has = {true, true, false, false, false};
  across.axis = {check.position_mm.x(), check.position_mm.y(), 0, 0, 0};
  Move down = across;
  down.has = {false, false, true, false, false};
  down.axis[2] = check.position_mm.z() + control_.tool_length_mm.at(tool_) + check.clearance_mm;
  if (down.axis[2] > control_.top_mm + kAtTop)
    return fmt::format("tool {} is too long for the setter: Z {:.4f} above it, its top is {:.4f}", tool_, down.axis[2],
                       control_.top_mm);
  double ways = 0;
  for (const Move& m : {across, down}) {
    const auto from = joints_;
    if (auto bad = move_to(m, line)) return bad;
    double way = 0;
    for (std::size_t a = 0; a < 3; ++a)
      if (control_.rapid_speed[a] > 0 && known(from))
        way = std::max(way, std::abs(joints_[a] - from[a]) / control_.rapid_speed[a]);
    ways += way;
  }
  dwell_min_ += std::max(0.0, check.minutes - ways);
  return std::nullopt;
}

/// Whatever a cycle of the builder leaves.
void NcExecution::forget_modes() {
  unit_ = zeros_cleared_ = spindle_set_ = false;
  distance_ = Distance::unsaid;
  feed_mode_ = Feed::none;
  feed_.reset();
  length_.reset();
  length_of_ = -1;
  offset_.reset();
  written_.reset();
  in_written_ = false;
  frame_deg_ = 0;
  coolants_ = 0;
  clamps_.fill(Clamp::unknown);
  set_blend(0);
  blend_axis_rad_.reset();
  path_weights_.reset();
  retracted_ = false;
}

NcExecution::Problem NcExecution::dwell(double minutes) {
  if (!(minutes >= 0)) return "a dwell must not be negative";
  if (minutes > kLongestBlock_min)
    return fmt::format("a dwell of {:.6g} min, more than {:g} (a day): is its unit right?", minutes, kLongestBlock_min);
  dwell_min_ += minutes;
  return std::nullopt;
}

NcExecution::Problem NcExecution::dwell_turns(double turns) {
  if (!spindle_ || !(speed_ > 0)) return "a dwell in turns of the spindle, which stands";
  return dwell(turns / speed_);
}

Result<std::array<double, 5>> NcExecution::reference(std::size_t which, std::string_view word) const {
  if (const auto& place = control_.reference[which]) return *place;
  return fail("{}: nothing says where it goes: {} = [X, Y, Z, rotaries] in the machine file does", word,
              which == 0 ? "post.reference_position" : "post.second_reference_position");
}

NcExecution::Problem NcExecution::to_reference(const Move& m, std::size_t which, std::string_view word, bool by_way,
                                               std::int32_t line) {
  if (tcp_) return fmt::format("{} with TCP on", word);
  if (plane_) return fmt::format("{} in a tilted plane: it must be switched off ahead", word);
  const auto place = reference(which, word);
  if (!place) return place.error().message;
  Move way = m;
  way.rapid = way.to_reference = true;
  if (by_way && distance_ == Distance::unsaid)
    return fmt::format("{} ahead of G90 or G91: whether its words are steps would depend on the last program", word);
  if (by_way && distance_ == Distance::incremental) {
    way.machine_frame = true;
    bool steps = false;
    for (std::size_t a = 0; a < 5; ++a) {
      steps = steps || (m.has[a] && m.axis[a] != 0);
      if (m.has[a]) way.axis[a] = joints_[a] + m.axis[a];
      if (m.has[a] && m.axis[a] != 0 && control_.rollover[a])
        return fmt::format("{} by steps of {}, which rolls over: which way it turns is not said", word,
                           control_.letters[a]);
    }
    by_way = steps;
    if (steps && std::any_of(way.axis.begin(), way.axis.end(), [](double v) { return std::isnan(v); }))
      return fmt::format("{} by steps from a position that the program did not set", word);
  }
  if (by_way)
    if (auto bad = move(way, line)) return bad;
  way.machine_frame = true;
  way.axis = *place;
  if (auto bad = move(way, line)) return bad;
  if (m.has[2] && !rules_.reference_keeps_length) length_.reset();
  return std::nullopt;
}

NcExecution::Problem NcExecution::set_length(int tool) {
  if (tool < 0) return "the length of a tool before a tool was called";
  const auto found = control_.tool_length_mm.find(tool);
  if (found == control_.tool_length_mm.end()) return fmt::format("tool length {} is not in the tool list", tool);
  length_ = found->second;
  length_of_ = tool;
  return std::nullopt;
}

void NcExecution::switch_coolant(std::string_view word) {
  coolant_doubt_ = false;
  for (const auto& [coolant, words] : control_.coolants) {
    const std::uint8_t bit = machines::bit_of(coolant);
    if (words.on == word) coolants_ = static_cast<std::uint8_t>(coolants_ | bit);
    else if (words.off == word) coolants_ = static_cast<std::uint8_t>(coolants_ & ~bit);
  }
}

bool NcExecution::switch_clamp(std::string_view word) {
  const auto axis = control_.clamped_by(word);
  if (!axis) return false;
  const machines::RotaryClamp& clamp = *control_.clamps[*axis];
  const Clamp to = clamp.on == word ? Clamp::clamped : Clamp::released;
  if (clamps_[*axis] != to) dwell_min_ += to == Clamp::clamped ? clamp.on_min : clamp.off_min;
  clamps_[*axis] = to;
  return true;
}

/// No block turns a rotary that is held, or may be.
NcExecution::Problem NcExecution::clamps_allow(const std::array<double, 5>& goal, std::uint8_t commanded) const {
  for (std::size_t a = 3; a < 5; ++a) {
    const double turn = std::abs(goal[a] - joints_[a]);
    if (!control_.clamps[a] || (commanded & (1U << a)) == 0 || turn <= kZeroRotary || clamps_[a] == Clamp::released)
      continue;
    const char letter = control_.letters[a];
    const std::string& release = control_.clamps[a]->off;
    if (clamps_[a] == Clamp::clamped)
      return std::isnan(turn)
                 ? fmt::format("{} turns while it is clamped: {} ahead of the block releases it", letter, release)
                 : fmt::format(
                       "{} turns by {:.4f} deg while it is clamped, limit 0: {} ahead of the block "
                       "releases it",
                       letter, turn, release);
    return fmt::format(
        "{} turns, and nothing has released it since the operation, a change of the tool or a stop: {} "
        "must stand ahead of the block",
        letter, release);
  }
  return std::nullopt;
}

bool NcExecution::site_smoothing(std::string_view line) {
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  while (!line.empty() && line.back() == ' ') line.remove_suffix(1);
  const auto is = [line](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), line) != list.end();
  };
  const bool on = is(control_.smoothing_on);
  if (line.empty() || (!on && !is(control_.smoothing_off))) return false;
  set_blend(on ? control_.smoothing_mm : 0);
  if (timing::is_bounded(path_mode_)) set_path_mode(timing::Corners::jump, 0);
  blend_axis_rad_ = on ? control_.smoothing_axis_rad : std::nullopt;
  site_smoothing_ = on;
  return true;
}

NcExecution::Problem NcExecution::tcp_on() {
  if (!control_.chain) return "TCP on a machine without TCP (tcp = \"none\")";
  if (tcp_) return "TCP is on already";
  if (plane_) return "TCP in a tilted plane: it must be switched off ahead";
  if (!length_) return tool_ < 0 ? "TCP before a tool was called" : "TCP without tool length compensation";
  if (!offset_) return "TCP without a work offset";
  if (!known(joints_)) return "TCP at a position that the program did not set";
  if (rules_.tcp_needs_zero && !(at_zero(3) && at_zero(4)))
    return "TCP starts with the rotaries away from zero: the table frame would be frozen there";
  if (rules_.tcp_needs_zero && zero_[4] != 0) return "TCP starts where the zero of a second rotary is moved";
  frozen_deg_.reset();
  if (rules_.tcp_needs_zero && zero_[3] != 0) {
    if (!control_.chain->in_table(0)) return "TCP starts where the zero of a rotary of the head is moved";
    frozen_deg_ = joints_[3];
  }
  if (rules_.tcp_may_take_zero && zero_is_moved()) {
    if (!control_.transformation_takes_rotary_offset)
      return fmt::format(
          "TCP starts while {} counts from {} deg: whether the frame turns with it is machine data, and "
          "post.transformation_takes_rotary_offset of the machine file does not grant it",
          control_.letters[zero_[3] != 0 ? 3 : 4], zero_[zero_[3] != 0 ? 3 : 4]);
    if (zero_[4] != 0) return "TCP starts where the zero of a second rotary is moved";
    if (!control_.chain->in_table(0)) return "TCP starts where the zero of a rotary of the head is moved";
    frozen_deg_ = zero_[3];
  }
  tip_ = tip_of(joints_);
  tcp_ = true;
  return std::nullopt;
}

bool NcExecution::at_zero(std::size_t axis) const {
  const double word = joints_[axis] - zero_[axis];
  return std::abs(control_.rollover[axis] ? std::remainder(word, kFullTurn) : word) <= kZeroRotary;
}

/// A point of the table frame as the words of TCP name it, seen from the work offset, and back.
Vec3 NcExecution::in_words(const Vec3& tip) const { return turned_deg(as_frozen(tip, false) - *offset_, -frame_deg_); }
Vec3 NcExecution::from_words(const Vec3& words) const {
  return as_frozen(*offset_ + turned_deg(words, frame_deg_), true);
}
/// Where a point of the table stood when TCP froze the frame; `back`: the point of the table that stood there.
Vec3 NcExecution::as_frozen(const Vec3& point, bool back) const {
  if (!frozen_deg_) return point;
  const machines::RotaryAxis& axis = control_.chain->table[0];
  const double turn = (back ? 1 : -1) * axis.sign * angles_of(*frozen_deg_, 0)[0];
  return axis.point_mm + Eigen::AngleAxisd(turn, axis.direction) * (point - axis.point_mm);
}

NcExecution::Problem NcExecution::tcp_off() {
  tcp_ = false;
  return std::nullopt;
}

NcExecution::Problem NcExecution::end_program(bool inside_call) {
  if (feed_mode_ == Feed::inverse_time) return "program end in G93";
  if (spindle_) return "program end while the spindle turns";
  if (tcp_) return "program end with TCP on";
  if (auto bad = zeros_allow_end()) return bad;
  if (plane_) return "program end in a tilted plane: the next program would begin there";
  if (inside_call) return "program end inside a sub-program or loop";
  if (dwell_min_ > 0) {  // no move follows that it could count with
    ExecutedMove e;
    e.joints = joints_;
    e.dwell_min = static_cast<float>(std::exchange(dwell_min_, 0));
    e.operation = static_cast<std::int16_t>(operation_);
    e.piece = static_cast<std::int16_t>(piece_);
    e.tool = static_cast<std::int16_t>(tool_);
    e.line = last_line_;
    e.rapid = e.machine = true;
    e.known = known(joints_);
    sink_(e);
  }
  return std::nullopt;
}

/// Angles of rotaries, deg, for the kinematics [rad]: of those that roll over the place within the turn, so that whole
/// turns change no digit.
std::array<double, 2> NcExecution::angles_of(double r0, double r1) const {
  const auto angle = [this](std::size_t axis, double deg) {
    return radians(control_.rollover[axis] ? deg - kFullTurn * std::floor(deg / kFullTurn) : deg);
  };
  return {angle(3, r0), angle(4, r1)};
}

Vec3 NcExecution::tip_of(const std::array<double, 5>& j) const {
  return control_.chain->forward({Vec3(j[0], j[1], j[2]), angles_of(j[3], j[4])}, *length_).tip_mm;
}

std::array<double, 5> NcExecution::joints_for(const Vec3& tip, double r0, double r1) const {
  const machines::Joints j = control_.chain->linear_for(tip, angles_of(r0, r1), *length_);
  return {j.linear_mm.x(), j.linear_mm.y(), j.linear_mm.z(), r0, r1};
}

/// Joint words.
NcExecution::Problem NcExecution::goal_of(const Move& m, std::array<double, 5>& joints, Vec3& tip,
                                          std::uint8_t& commanded) const {
  if (m.vector) return "a tool vector without TCP";
  tip = Vec3::Zero();
  if (plane_) return plane_goal(m, joints, commanded);
  for (std::size_t a = 0; a < 5; ++a) {
    if (!m.has[a]) continue;
    commanded = static_cast<std::uint8_t>(commanded | (1U << a));
    joints[a] = m.axis[a];
    if (a >= 3 || m.machine_frame) continue;
    if (!offset_) return "axis word before a work offset";
    if (frame_deg_ != 0) return "a turned frame without TCP";
    joints[a] += (*offset_)[static_cast<int>(a)];
    if (a != 2) continue;
    if (!length_)
      return tool_ < 0 ? "Z word in work coordinates before a tool was called: it has no length"
                       : "Z word without tool length compensation";
    joints[a] += *length_;
  }
  return std::nullopt;
}

/// Words of the tip and rotary words or a vector.
NcExecution::Problem NcExecution::tip_goal(const Move& m, std::array<double, 5>& joints, Vec3& tip,
                                           std::uint8_t& commanded) const {
  Vec3 words = in_words(tip_);
  const Vec3 before = words;
  for (std::size_t a = 0; a < 5; ++a) {
    if (!m.has[a]) continue;
    commanded = static_cast<std::uint8_t>(commanded | (1U << a));
    if (a < 3) words[static_cast<int>(a)] = m.axis[a];
    else joints[a] = m.axis[a];
  }
  tip = words == before ? tip_ : from_words(words);
  if (m.vector) {
    if (frozen_deg_) return "a tool vector in a frame that has turned with the zero of a rotary is not in the subset";
    const double size = m.vector->norm();
    if (!(std::abs(size - 1) < 1e-5)) return fmt::format("a tool vector of length {:.6f}", size);
    const Vec3 axis = turned_deg(*m.vector / size, frame_deg_);
    const auto list = control_.chain->rotary_solutions(axis);
    if (!list) return list.error().message;
    double nearest = std::numeric_limits<double>::infinity();
    const std::array<double, 2> now = {radians(joints[3]), radians(joints[4])};
    const Vec3 from = control_.chain->forward({Vec3::Zero(), now}, 1.0).axis;
    const double turn = degrees(std::atan2(from.cross(axis).norm(), from.dot(axis)));
    if (!m.rapid && turn > kFlip + 1e-4)
      return fmt::format("the tool axis turns by {:.4f} deg in one block, limit {:g}: which way is not said", turn,
                         kFlip);
    for (const auto& s : *list) {
      std::array<double, 2> angles{};
      double distance = 0;
      for (std::size_t k = 0; k < control_.chain->rotary_count(); ++k) {
        angles[k] =
            s.free_rotary == static_cast<int>(k) ? now[k] : choice::nearest_turn(s.joints.rotary_rad[k], now[k]);
        distance = std::max(distance, std::abs(angles[k] - now[k]));
      }
      if (distance >= nearest) continue;
      nearest = distance;
      for (std::size_t k = 0; k < 2; ++k)
        joints[3 + k] = control_.rollover[3 + k] ? turned_on(degrees(angles[k]), joints_[3 + k]) : degrees(angles[k]);
    }
    commanded = static_cast<std::uint8_t>(commanded | 0x18U);
  }
  joints = joints_for(tip, joints[3], joints[4]);
  return std::nullopt;
}

/// Words of rotaries that roll over become positions that go on beyond a turn.
NcExecution::Problem NcExecution::roll(Move& m) {
  for (std::size_t a = 3; a < 5; ++a) {
    if (!control_.rollover[a] || !m.has[a]) continue;
    const double word = m.axis[a], now = joints_[a], zero = m.machine_frame ? 0 : zero_[a];
    if (rules_.sign_is_sense && zero != zero_[a])
      return fmt::format(
          "machine coordinates of {}, which rolls over, while it counts from {} deg: which way it turns "
          "is not known here",
          control_.letters[a], zero_[a]);
    const double least = rules_.sign_is_sense ? -kFullTurn : -kBelowZero;
    if (!(word > least && word < kFullTurn))
      return fmt::format("{} = {} of an axis that rolls over is outside {} 360", control_.letters[a], word,
                         rules_.sign_is_sense ? "-360 .." : "0 ..");
    double turns = 0;
    if (rules_.sign_is_sense) {
      rolled_[a] = std::isnan(rolled_[a]) ? std::abs(word) : by_sign(word, rolled_[a]);
      turns = std::round((rolled_[a] - std::abs(word)) / kFullTurn);
    } else if (!std::isnan(now)) {
      turns = std::round((now - zero - word) / kFullTurn);
    }
    m.axis[a] = kFullTurn * turns + on_grid(std::abs(word)) + on_grid(zero);
    const double turn = std::abs(m.axis[a] - now);
    if (turn >= kHalfTurn && !(rules_.sign_is_sense && m.rapid))
      return fmt::format("{} turns by {:.6f} deg in one block, limit 180: {}", control_.letters[a], turn,
                         rules_.sign_is_sense ? "a cut is not meant to" : "which way is not said");
  }
  return std::nullopt;
}

NcExecution::Problem NcExecution::move(const Move& m, std::int32_t line) {
  Move meant = m;
  for (std::size_t a = 3; a < 5; ++a)
    if (m.has[a] && !m.machine_frame && !control_.rollover[a]) meant.axis[a] += zero_[a];
  if (auto bad = roll(meant)) return bad;
  return move_to(meant, line);
}

NcExecution::Problem NcExecution::next_block() {
  if (++steps_ > control_.max_steps) return too_many_blocks(control_.max_steps);
  if (++idle_ > control_.max_idle)
    return fmt::format("more than {} executed blocks in a row without a move", control_.max_idle);
  return std::nullopt;
}

NcExecution::Problem NcExecution::move_to(const Move& m, std::int32_t line) {
  std::array<double, 5> goal = joints_;
  Vec3 tip = Vec3::Zero();
  ExecutedMove e;
  if (!unit_) return "axis words ahead of the unit code: whether they are mm would depend on the last program";
  if (distance_ == Distance::incremental && !m.to_reference)
    return "axis words in G91: steps are read with G28 and G30 alone, G90 must be said again";
  if (distance_ == Distance::unsaid && !m.to_reference)
    return "axis words ahead of G90: whether they are positions would depend on the last program";
  if (tcp_ && m.machine_frame) return "machine coordinates with TCP on";
  if (auto bad = tcp_ ? tip_goal(m, goal, tip, e.commanded) : goal_of(m, goal, tip, e.commanded)) return bad;
  if (auto bad = clamps_allow(goal, e.commanded)) return bad;
  for (std::size_t a = 3; a < 5; ++a)
    if (clamps_[a] == Clamp::clamped) e.clamped = static_cast<std::uint8_t>(e.clamped | (1U << a));
  e.joints = goal;
  e.tip = tip;
  if (m.vector) e.vector_print = print_of(*m.vector);
  e.tcp = tcp_;
  e.plane = plane_.has_value();
  e.known = known(goal) && known(joints_);
  e.line = line;
  e.operation = static_cast<std::int16_t>(operation_);
  e.piece = static_cast<std::int16_t>(piece_);
  e.tool = static_cast<std::int16_t>(tool_);
  e.rapid = m.rapid;
  e.speed_rpm = spindle_ ? static_cast<float>(speed_) : 0;
  e.coolants = coolants_;
  e.in_doubt = spindle_doubt_ || coolant_doubt_;
  e.checked = checked_;
  e.offset_unseen = offset_unseen_;
  e.dwell_min = static_cast<float>(std::exchange(dwell_min_, 0));
  e.corners = path_mode_;
  e.tolerance_mm = static_cast<float>(path_tolerance_mm_);
  if (!m.rapid && e.known)
    if (auto bad = corners(goal, tip, e)) return bad;
  e.tooth = static_cast<std::int16_t>(tooth_);
  e.machine = m.machine_frame || m.compensation;
  if (m.rapid) {
    for (std::size_t a = 0; a < 5; ++a)
      if ((m.has[a] || tcp_) && e.known && control_.rapid_speed[a] > 0)
        e.minutes = std::max(e.minutes, std::abs(goal[a] - joints_[a]) / control_.rapid_speed[a]);
  } else if (auto bad = feed_minutes(m, goal, tip, e.minutes)) {
    return bad;
  }
  if (e.minutes > kLongestBlock_min) return block_of_days(e.minutes, joints_, goal);
  retracted_ = m.machine_frame && m.has[2];
  last_line_ = line;
  joints_ = goal;
  idle_ = 0;
  tip_ = tip;
  sink_(e);
  return std::nullopt;
}

/// How far the control may leave the corners at both ends of a feed block.
NcExecution::Problem NcExecution::corners(const std::array<double, 5>& goal, const Vec3& tip, ExecutedMove& e) const {
  const bool turns = std::abs(goal[3] - joints_[3]) > kTipStill || std::abs(goal[4] - joints_[4]) > kTipStill;
  if (turns && blend_is_linear_)
    return "G64 bounds X, Y and Z alone, this G1 turns a rotary axis: G61 or G61.1 is needed";
  if (turns && contour_cycle_ && !(tcp_ && blend_axis_rad_))
    return "this block turns a rotary axis, and the tolerance of the cycle bounds X, Y and Z alone";
  if (turns && tcp_ && rules_.turns_need_axis_blend && !blend_axis_rad_)
    return "this block turns a rotary axis and no TA says how far the control may leave its way: CYCL DEF 32.2 is "
           "needed";
  if (turns && site_smoothing_ && !blend_axis_rad_)
    return "this block turns a rotary axis under smoothing that the machine file states, without "
           "post.smoothing_axis_tolerance";
  e.blend_mm = static_cast<float>(blend_mm_);
  if (site_smoothing_) e.blend_axis_rad = static_cast<float>(blend_axis_rad_.value_or(0));
  for (std::size_t a = 3; a < 5 && tcp_ && blend_axis_rad_ && !site_smoothing_; ++a)  // a tolerance of each rotary
    if (control_.letters[a] != 0) e.blend_axis_rad += static_cast<float>(*blend_axis_rad_);
  if (!corner_way_) return std::nullopt;
  if (tcp_ && path_weights_) return "FGROUP with TRAORI is not in the subset";
  if (!tcp_ && turns && !path_weights_)
    return "this G1 turns a rotary axis and no FGROUP says what ADIS is measured over";
  double way = 0;
  if (tcp_) way = (tip - tip_).norm();
  else
    for (std::size_t a = 0; a < 5; ++a)
      way = std::hypot(way, (path_weights_ ? (*path_weights_)[a] : a < 3 ? 1.0 : 0.0) * (goal[a] - joints_[a]));
  e.corner_path_mm = static_cast<float>(*corner_way_);
  if (*corner_way_ > 0)
    e.corner_share = *corner_way_ < 0.5 * way ? static_cast<float>(*corner_way_ / way * (1 + 1e-6)) : 0.5F;
  return std::nullopt;
}

NcExecution::Problem NcExecution::feed_minutes(const Move& m, const std::array<double, 5>& goal, const Vec3& tip,
                                               double& minutes) const {
  if (!spindle_ && !control_.dry_run) return "G1 while the spindle stands";
  if (tool_ < 0) return "G1 before a tool was called";
  if (length_ && length_of_ != tool_)
    return fmt::format("G1 with the length of tool {} while tool {} is in the spindle", length_of_, tool_);
  if (feed_mode_ == Feed::inverse_time && !m.own_feed) return "G1 in G93 without F";
  if (m.machine_frame) return "machine coordinates with G1";
  double linear = 0, rotary = 0;
  for (std::size_t a = 0; a < 5; ++a) {
    const double d = goal[a] - joints_[a];
    if (std::isnan(d)) return "G1 from a position that the program did not set";
    (a < 3 ? linear : rotary) += d * d;
  }
  linear = tcp_ ? (tip - tip_).norm() : std::sqrt(linear);
  if (tcp_ && linear < kTipStill) linear = 0;
  rotary = std::sqrt(rotary);
  const double length = linear > 0 ? linear : rotary;
  if (feed_mode_ == Feed::inverse_time) {
    if (length == 0) minutes = 1 / *feed_;
    else minutes = length / std::max(rules_.least_rate, length * *feed_);
    return std::nullopt;
  }
  if (feed_mode_ != Feed::per_minute || !feed_) return "G1 without F";
  if (!tcp_ && !rules_.per_minute_turns && rotary > 0) return "G94 with a rotary word";
  if (!tcp_ && linear > 0 && rotary > 0 && !m.own_feed) return "G94 with rotary and linear words and no F of its own";
  minutes = length / *feed_;
  return std::nullopt;
}

}  // namespace toothpath::readback
