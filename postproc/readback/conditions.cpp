#include "postproc/readback/conditions.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::readback {
namespace {

constexpr double kRounding = 1 + 1e-3;  // of feeds and speeds: digits of F and of the words
constexpr double kSampled = 1 + 1e-2;   // of joints that are followed in steps
constexpr double kToldShare = 1.5;      // of the job's feed
constexpr double kAlong = 0.999;        // cosine to the tool axis: a move along it
constexpr double kStill = 1e-6;         // mm: the tip does not move
constexpr double kPiece_deg = 5;        // of a block that turns
constexpr double kSameSpeed = 1e-3;     // of S

void keep_most(ValueAt& at, double value, int line) {
  if (at.line == 0 || value > at.value) at = {value, line};
}
std::string unchecked_text(const std::string& at, int tool, const std::string& times) {
  return fmt::format(
      "{} cuts with T{}, which no check has met since it came{}: the job asks for one (program.tool_check)", at, tool,
      times);
}
std::string unseen_text(const std::string& at, const std::string& times) {
  return fmt::format(
      "{} cuts from a work offset whose turn R and zeros of the rotaries are taken as 0, and no line of the program "
      "looks at them{}: the lines o99 ahead of the first motion of a program from run do",
      at, times);
}
void keep_least(ValueAt& at, double value, int line) {
  if (at.line == 0 || value < at.value) at = {value, line};
}

}  // namespace

/// A feed as the work sees it.
struct ConditionJudge::Step {
  double way_mm = 0;  // of the tip
  double along = 0;   // cosine between the way and the tool axis
};

ConditionJudge::ConditionJudge(const machines::Machine& machine, const NcControl& control, const AskedConditions& asked)
    : machine_(machine),
      control_(control),
      asked_(asked),
      most_share_(std::max(1.0, machine.feed_factor) * kRounding),
      told_share_(std::min(kToldShare * kRounding, most_share_)) {}

const AskedCut* ConditionJudge::asked(int operation) const {
  const auto n = static_cast<std::size_t>(operation);
  return operation >= 0 && n < asked_.operations.size() ? &asked_.operations[n] : nullptr;
}

ConditionJudge::Step ConditionJudge::step_to(const ExecutedMove& m) const {
  const auto length = control_.tool_length_mm.find(m.tool);
  if (length == control_.tool_length_mm.end()) return {};
  const machines::KinematicChain& chain = machine_.chain;
  const auto& a = before_.joints;
  const auto& b = m.joints;
  const auto pose = [&](double t) {
    return chain.forward({Vec3(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])),
                          {radians(a[3] + t * (b[3] - a[3])), radians(a[4] + t * (b[4] - a[4]))}},
                         length->second);
  };
  Step step;
  const machines::TablePose end = pose(1);
  const Vec3 start = pose(0).tip_mm;
  step.way_mm = (end.tip_mm - start).norm();
  if (step.way_mm > kStill) step.along = (end.tip_mm - start).dot(end.axis) / step.way_mm;
  const double turn = std::abs(b[3] - a[3]) + std::abs(b[4] - a[4]);
  if (m.tcp || turn <= kPiece_deg) return step;
  const int n = static_cast<int>(std::min(1e4, std::ceil(turn / kPiece_deg)));
  step.way_mm = 0;
  Vec3 from = start;
  for (int i = 1; i <= n; ++i) {
    const Vec3 to = pose(double(i) / n).tip_mm;
    step.way_mm += (to - from).norm();
    from = to;
  }
  step.along = 0;
  return step;
}

void ConditionJudge::add(const ExecutedMove& m) {
  if (any_ && m.known && before_.known) {
    if (m.rapid) {
      end_of_stretch();
      up_ = true;
      way_down_ = {};
    } else if (m.minutes > 0) {
      ConditionsOfOperation& operation =
          found_.operations.try_emplace(m.operation, ConditionsOfOperation{m.tool, {}, {}, {}, {}, 0xff}).first->second;
      const Step step = step_to(m);
      feed(m, step, operation);
      axes(m);
      spindle(m, operation);
      coolant(m, operation);
      if (step.way_mm > kStill) clamps(m);
      else end_of_stretch();  // a turn between cuts, with TCP
      if (m.in_doubt) note(Kind::stop_in_doubt, 0, m, 0);
      if (asked_.tool_checks && !m.checked) note(Kind::unchecked, m.tool, m, 0);
      if (m.offset_unseen) note(Kind::offset_unseen, 0, m, 0);
      if (m.dwell_min > 0 && !up_) note(Kind::dwell, 0, m, double(m.dwell_min) * 60);
    }
  }
  before_ = m;
  any_ = true;
}

void ConditionJudge::feed(const ExecutedMove& m, const Step& step, ConditionsOfOperation& operation) {
  const double ms = m.minutes * 60000;
  keep_least(found_.shortest_ms, ms, m.line);
  if (ms * kRounding < machine_.min_block_ms) note(Kind::short_block, 0, m, -ms);
  if (const AskedCut* cut = asked(m.operation);
      cut != nullptr && m.tool != cut->tool &&
      std::find(cut->sisters.begin(), cut->sisters.end(), m.tool) == cut->sisters.end())
    note(Kind::tool, m.tool, m, 0);
  if (step.way_mm <= kStill) return;
  const double speed = step.way_mm / m.minutes;
  keep_most(operation.any_mm_min, speed, m.line);
  if (machine_.max_cutting_feed > 0 && speed > machine_.max_cutting_feed * kRounding)
    note(Kind::machine_feed, 0, m, speed);
  speed_of_cut(m, step, operation);
}

/// Links are quicker than cuts, and the text does not say which is which: their way does.
void ConditionJudge::speed_of_cut(const ExecutedMove& m, const Step& step, ConditionsOfOperation& operation) {
  const AskedCut* cut = asked(m.operation);
  const double speed = step.way_mm / m.minutes, share = cut == nullptr ? 0 : speed / cut->feed_mm_min;
  if (step.along > kAlong) {  // out of the work
    up_ = true;
    way_down_ = {};
    return;
  }
  if (step.along < -kAlong) {  // into it: the last piece of that way is a cut
    up_ = false;
    way_down_ = share > told_share_ ? ValueAt{speed, m.line} : ValueAt{};
    return;
  }
  if (way_down_.line > 0 && share > 0 && way_down_.value > most_share_ * cut->feed_mm_min)
    note(Kind::way_down, 0, m, way_down_.value, way_down_.line);
  way_down_ = {};
  if (up_ && (share > told_share_ || as_quick_as_can_be(m))) return;
  up_ = false;
  keep_most(operation.cut_mm_min, speed, m.line);
  if (share > most_share_) note(Kind::cut_feed, 0, m, speed);
  else if (share > told_share_) note(Kind::quick_cut, 0, m, speed);
}

/// Is it the control or an axis that makes the block slow, whatever its F?
bool ConditionJudge::as_quick_as_can_be(const ExecutedMove& m) const {
  double least = std::max(machine_.min_block_ms / 60000, control_.shortest_feed_minutes);
  for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k)
    if (const double most = degrees(machine_.chain.rotary(k).max_speed); most > 0)
      least = std::max(least, std::abs(m.joints[3 + k] - before_.joints[3 + k]) / most);
  return m.minutes <= least * kRounding;
}

void ConditionJudge::axes(const ExecutedMove& m) {
  const machines::KinematicChain& chain = machine_.chain;
  const auto look = [&](std::size_t a, double way, double minutes, double share) {
    const double speed = std::abs(way) / minutes;
    const double most = a < 3 ? chain.linear[a].max_speed : degrees(chain.rotary(a - 3).max_speed);
    keep_most(found_.axis_speed[a], speed, m.line);
    if (most > 0 && speed > most * share) note(Kind::axis_speed, static_cast<int>(a), m, speed);
  };
  const std::size_t count = 3 + chain.rotary_count();
  const double turn = std::abs(m.joints[3] - before_.joints[3]) + std::abs(m.joints[4] - before_.joints[4]);
  for (std::size_t a = m.tcp && turn > 0 ? 3 : 0; a < count; ++a)
    look(a, m.joints[a] - before_.joints[a], m.minutes, kRounding);
  if (!m.tcp || turn == 0) return;
  // The joints are curved inside the block: the rotaries say how far a piece of it is.
  std::array<double, 5> at = before_.joints;
  const auto piece = [&](const std::array<double, 5>& to) {
    const double part = (std::abs(to[3] - at[3]) + std::abs(to[4] - at[4])) / turn;
    for (std::size_t a = 0; a < 3 && part > 0; ++a) look(a, to[a] - at[a], part * m.minutes, kSampled);
    at = to;
  };
  follow_tip(before_, m, control_, chain, piece);
  piece(m.joints);
}

void ConditionJudge::spindle(const ExecutedMove& m, ConditionsOfOperation& operation) {
  const double speed = static_cast<double>(m.speed_rpm);
  if (speed <= 0) return;  // a dry run: the reader refuses a cut with a standing spindle
  keep_least(operation.least_rpm, speed, m.line);
  keep_most(operation.greatest_rpm, speed, m.line);
  if (machine_.max_spindle_speed > 0 && speed > machine_.max_spindle_speed * kRounding)
    note(Kind::spindle_most, 0, m, speed);
  const AskedCut* cut = asked(m.operation);
  if (cut == nullptr || !(cut->speed_rpm > 0)) return;
  const double off = std::max(speed / cut->speed_rpm, cut->speed_rpm / speed);
  const double rounded = 0.5 / cut->speed_rpm;  // S is printed as a whole number
  if (off > std::max(1.0, machine_.speed_factor) * kRounding + rounded) note(Kind::spindle_off_job, 0, m, speed);
  else if (off > 1 + kSameSpeed + rounded) note(Kind::spindle_near_job, 0, m, speed);
}

void ConditionJudge::coolant(const ExecutedMove& m, ConditionsOfOperation& operation) {
  operation.coolants = static_cast<std::uint8_t>(operation.coolants & m.coolants);
  if (!asked_.coolant || m.operation < 0) return;
  if (*asked_.coolant != machines::Coolant::off && !is_on(m.coolants, *asked_.coolant)) note(Kind::coolant, 0, m, 0);
  for (const machines::Coolant other : machines::kCoolants)
    if (other != *asked_.coolant && is_on(m.coolants, other)) note(Kind::other_coolant, static_cast<int>(other), m, 0);
}

/// A rotary that turns somewhere in a stretch of feeds is not held there; one that stands in all of it should be.
void ConditionJudge::clamps(const ExecutedMove& m) {
  for (std::size_t a = 3; a < 5; ++a) {
    if (!control_.clamps[a]) continue;
    Loose& loose = loose_[a];
    loose.turned = loose.turned || m.joints[a] != before_.joints[a] || m.vector_print != 0;
    if (loose.turned || (m.clamped & (1U << a)) != 0) continue;
    if (loose.first.empty()) loose.first.push_back(m);
    ++loose.blocks;
  }
}

void ConditionJudge::end_of_stretch() {
  for (std::size_t a = 3; a < 5; ++a) {
    Loose& loose = loose_[a];
    if (!loose.turned && !loose.first.empty())
      for (std::size_t n = 0; n < loose.blocks; ++n) note(Kind::unclamped, static_cast<int>(a), loose.first.front(), 1);
    loose = {};
  }
}

void ConditionJudge::note(Kind kind, int detail, const ExecutedMove& m, double value, int line) {
  Fault& fault = faults_[{static_cast<int>(kind), m.operation, detail}];
  if (fault.blocks == 0 || value > fault.worst) {
    fault.worst = value;
    fault.line = line > 0 ? line : m.line;
  }
  ++fault.blocks;
}

std::string ConditionJudge::text(Kind kind, int operation, int detail, const Fault& f) const {
  const AskedCut none;
  const AskedCut& cut = asked(operation) != nullptr ? *asked(operation) : none;
  const std::string times = f.blocks > 1 ? fmt::format(" ({} blocks so)", f.blocks) : std::string();
  const std::string at = fmt::format("line {}: operation {}", f.line, operation);
  switch (kind) {
    case Kind::cut_feed:
    case Kind::way_down:
      return fmt::format(
          "{} {} with {:.6g} mm/min, {:.3g} times the {:.6g} of the job, limit {:g} times "
          "(limits.feed_factor){}: a smaller F, or a greater feed in the job",
          at, kind == Kind::cut_feed ? "cuts" : "goes down to its cut", f.worst, f.worst / cut.feed_mm_min,
          cut.feed_mm_min, machine_.feed_factor, times);
    case Kind::machine_feed:
      return fmt::format("{} feeds with {:.6g} mm/min, above limits.cutting_feed = {:g} of the machine{}: a smaller F",
                         at, f.worst, machine_.max_cutting_feed, times);
    case Kind::axis_speed: {
      const auto a = static_cast<std::size_t>(detail);
      return fmt::format("{} asks {} for {:.6g} {}/min in a feed, above its max_speed = {:g}{}: a smaller F", at,
                         control_.letters[a], f.worst, a < 3 ? "mm" : "deg",
                         a < 3 ? machine_.chain.linear[a].max_speed : degrees(machine_.chain.rotary(a - 3).max_speed),
                         times);
    }
    case Kind::spindle_most:
      return fmt::format("{} turns with S {:g}, above spindle.max_speed = {:g} of the machine{}", at, f.worst,
                         machine_.max_spindle_speed, times);
    case Kind::spindle_off_job:
      return fmt::format("{} turns with S {:g}, the job says {:g}: more than {:g} times apart (limits.speed_factor){}",
                         at, f.worst, cut.speed_rpm, machine_.speed_factor, times);
    case Kind::tool: return fmt::format("{} cuts with T{}, the job says T{}{}", at, detail, cut.tool, times);
    case Kind::coolant:
      return fmt::format("{} cuts without {}, the coolant of the job{}", at, to_string(*asked_.coolant), times);
    case Kind::quick_cut:
      return fmt::format("{} cuts with {:.6g} mm/min, {:.3g} times the {:.6g} of the job{}", at, f.worst,
                         f.worst / cut.feed_mm_min, cut.feed_mm_min, times);
    case Kind::spindle_near_job:
      return fmt::format("{} turns with S {:g}, the job says {:g}{}", at, f.worst, cut.speed_rpm, times);
    case Kind::other_coolant:
      return fmt::format("{} cuts with {} on, the coolant of the job is {}{}", at,
                         to_string(static_cast<machines::Coolant>(detail)), to_string(*asked_.coolant), times);
    case Kind::stop_in_doubt:
      return fmt::format(
          "{} cuts behind an M0 or M1 that may have ended spindle or coolant{}: the builder of the machine decides "
          "that, M3 and the word of the coolant behind the stop leave no doubt",
          at, times);
    case Kind::unclamped: {
      const auto a = static_cast<std::size_t>(detail);
      return fmt::format("{} cuts while {} stands and is not clamped{}: {} ahead of the cut clamps it", at,
                         control_.letters[a], times, control_.clamps[a]->on);
    }
    case Kind::unchecked: return unchecked_text(at, detail, times);
    case Kind::offset_unseen: return unseen_text(at, times);
    case Kind::dwell:
      return fmt::format("{} waits {:.6g} s in a cut{}: the tool rubs where it stands", at, f.worst, times);
    case Kind::short_block:
      return fmt::format("{} has a block of {:.3g} ms, the control keeps up with {:g} (limits.min_block_ms){}", at,
                         -f.worst, machine_.min_block_ms, times);
  }
  return {};
}

ConditionsFound ConditionJudge::finish() {
  end_of_stretch();
  for (const auto& [key, fault] : faults_) {
    const auto kind = static_cast<Kind>(key[0]);
    (kind < Kind::quick_cut ? found_.reasons : found_.warnings).push_back(text(kind, key[1], key[2], fault));
  }
  return std::move(found_);
}

}  // namespace toothpath::readback
