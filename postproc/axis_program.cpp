#include "postproc/axis_program.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/base/angle.h"
#include "postproc/axis_clearance.h"
#include "postproc/axis_solution.h"
#include "postproc/axis_travel.h"
#include "postproc/fixed_point.h"

namespace toothpath {
namespace {

constexpr int kDeepestSplit = 12;         // halvings of one CL step
constexpr double kCoincident = 1e-9;      // mm: the gear axis lies on the index axis
constexpr double kParallel = 1e-12;       // sine of the angle between gear axis and index axis
enum TimeTerm { kFeed, kFeedLimit, kLinearSpeed, kRotarySpeed, kBlockTime, kInverseTime, kTimeTerms };
constexpr const char* kTimeNames[kTimeTerms] = {"feed of the path", "largest cutting feed", "speed of a linear axis",
                                                "speed of a rotary axis", "shortest block", "largest F"};

struct Pose {
  Vec3 tip = Vec3::Zero();   // table frame
  Vec3 axis = Vec3::UnitZ();
};

Vec3 slerp(const Vec3& a, const Vec3& b, double t) {
  const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
  if (angle < 1e-9) return ((1 - t) * a + t * b).normalized();
  return (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

class Builder {
 public:
  Builder(std::span<const ClPath* const> paths, std::span<const ToolAssembly> tools, const Setup& setup,
          const Machine& machine, int teeth, const ClearanceBody& body, const AxisOptions& options)
      : paths_(paths), tools_(tools), setup_(setup), machine_(machine), chain_(machine.chain), body_(body),
        options_(options), teeth_(teeth), gear_{setup.rotation(), setup.origin_mm} {}

  Result<AxisProgram> build() {
    if (auto bad = check_inputs()) return *bad;
    describe_machine();
    place_index_axis();
    if (program_.loop) {
      if (!choose_all(true)) program_.loop = false;  // one tooth at a time may still find its turns
    }
    if (!program_.loop && !choose_all(false)) return *error_;
    if (program_.loop && options_.loop_needs_constant_index && index_moves_inside_passes()) program_.loop = false;
    if (program_.loop && rounding_of_loop() > options_.nc_step_mm) program_.loop = false;
    copies_ = !program_.loop && coincident_ && teeth_ > 1 && rounding_of_copies() <= options_.nc_step_mm;
    program_.rounding_bound_mm = program_.loop ? rounding_of_loop() : copies_ ? rounding_of_copies() : rounding_of_words();
    if (program_.rounding_bound_mm > options_.nc_step_mm)
      return fail("rounding the words moves the tip by up to {:.6f} mm, more than {:.6f}", program_.rounding_bound_mm,
                  options_.nc_step_mm);
    for (std::size_t p = 0; p < paths_.size() && !error_; ++p) operation(p);
    if (error_) return *error_;
    if (auto bad = check_travel(program_, machine_, placed_)) return *bad;
    finish();
    return std::move(program_);
  }

 private:
  // Inputs.
  std::optional<Diagnostic> check_inputs() const {
    if (machine_.kind != MachineKind::five_axis) return fail("machine \"{}\" is not a milling machine", machine_.name);
    if (machine_.tcp != TcpMode::none)
      return fail("machine \"{}\": tcp: only \"none\" (joint output) is posted", machine_.name);
    if (machine_.post.length_reference != LengthReference::tip)
      return fail("machine \"{}\": length_reference: only \"tip\" is posted", machine_.name);
    if (machine_.post.pole != PoleOption::error && machine_.post.pole != PoleOption::slow)
      return fail("machine \"{}\": pole: only \"error\" and \"slow\" are posted", machine_.name);
    if (teeth_ < 1) return fail("teeth = {} is below 1", teeth_);
    if (paths_.empty()) return fail("there is no operation to post");
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k)
      if (!(chain_.rotary(k).max_speed > 0)) return fail("axes.{}.max_speed must be above 0", chain_.rotary(k).letter);
    for (std::size_t i = 0; i < 3; ++i)
      if (!(chain_.linear[i].max_speed > 0)) return fail("axes.{}.max_speed must be above 0", "XYZ"[i]);
    if (!(options_.chord_mm > 0) || !(options_.axis_rad > 0)) return fail("chord and axis tolerances must be above 0");
    for (const ClPath* path : paths_) {
      if (path->tool < 0 || static_cast<std::size_t>(path->tool) >= tools_.size())
        return fail("operation {}: tool {} of {} tools", path->operation, path->tool, tools_.size());
      if (path->records.empty()) return fail("operation {}: the path has no records", path->operation);
      if (path->records.front().kind != MoveKind::rapid)
        return fail("operation {}: the path does not begin with a rapid", path->operation);
      if (!(tools_[static_cast<std::size_t>(path->tool)].length_mm > 0))
        return fail("operation {}: tool length must be above 0", path->operation);
      if (!(path->spindle_rpm > 0)) return fail("operation {}: spindle speed must be above 0", path->operation);
      if (machine_.max_spindle_speed > 0 && path->spindle_rpm > machine_.max_spindle_speed)
        return fail("operation {}: spindle speed {} exceeds {}, the machine's", path->operation, path->spindle_rpm,
                    machine_.max_spindle_speed);
      for (std::size_t i = 0; i < path->records.size(); ++i) {
        const ClRecord& r = path->records[i];
        if (!r.tip.allFinite() || !r.axis.allFinite() || r.tip.norm() > 1e5)
          return fail("operation {} record {}: position is not a number below 1e5 mm", path->operation, i);
        if (std::abs(r.axis.norm() - 1) > 1e-9)
          return fail("operation {} record {}: tool axis has length {:.12f}, not 1", path->operation, i, r.axis.norm());
        if (r.kind != MoveKind::rapid && !(r.feed_mm_min > 0 && std::isfinite(r.feed_mm_min)))
          return fail("operation {} record {}: feed must be above 0", path->operation, i);
      }
    }
    return std::nullopt;
  }

  void describe_machine() {
    program_.format = options_.format;
    program_.teeth = teeth_;
    program_.letters = {'X', 'Y', 'Z', 0, 0};
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) program_.letters[3 + k] = chain_.rotary(k).letter;
    program_.work_offset = setup_.work_offset;
    program_.work_offset_at_mm = setup_.work_offset_at_mm;
    const double top = chain_.linear[2].max_mm - machine_.limit_margin.linear_mm;
    const double unit = std::pow(10.0, options_.format.linear_decimals);
    program_.retract_z_mm = std::floor(top * unit + 1e-6) / unit;
    program_.assumed = machine_.assumed_keys;
    program_.time_rulers.assign(kTimeNames, kTimeNames + kTimeTerms);
    program_.time_ruled.assign(kTimeTerms, 0);
  }

  /// Is the gear axis parallel to the rotary that carries the work, and is it that axis?
  void place_index_axis() {
    if (chain_.table.empty()) return;
    const RotaryAxis& c = chain_.table[0];
    const Vec3 gear_axis = gear_.rotation.col(2);
    if (c.direction.cross(gear_axis).norm() > kParallel) return;
    parallel_ = true;
    program_.index_axis = 3;
    program_.index_sign = c.sign * (c.direction.dot(gear_axis) > 0 ? 1 : -1);
    coincident_ = (gear_.origin - c.point_mm).cross(c.direction).norm() <= kCoincident;
    program_.loop = coincident_ && !options_.expand_teeth && teeth_ > 1;
  }

  double tooth_angle(int k) const { return 2 * kPi * k / teeth_; }
  Mat3 tooth_rotation(int k) const {
    return gear_.rotation * Eigen::AngleAxisd(tooth_angle(k), Vec3::UnitZ()).toRotationMatrix();
  }

  // Angles.
  std::array<RotaryRange, 2> ranges(bool leave_room_for_index) const {
    std::array<RotaryRange, 2> out{};
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
      const auto& axis = chain_.rotary(k);
      out[k] = {axis.min_rad + machine_.limit_margin.rotary_rad, axis.max_rad - machine_.limit_margin.rotary_rad};
    }
    if (leave_room_for_index) {
      const double span = tooth_angle(teeth_ - 1);
      if (program_.index_sign > 0)
        out[0].upper -= span;
      else
        out[0].lower += span;
    }
    return out;
  }
  /// Angles of tooth 0 for every path; false (and error_) if some path has none.
  bool choose_all(bool leave_room_for_index) {
    angles_.clear();
    error_.reset();
    for (const ClPath* path : paths_) {
      auto a = choose_rotaries(*path, gear_.rotation, chain_, ranges(leave_room_for_index), machine_.post.pole);
      if (!a) {
        error_ = a.error();
        return false;
      }
      angles_.push_back(std::move(*a));
    }
    return true;
  }
  bool index_moves_inside_passes() const {
    for (std::size_t p = 0; p < paths_.size(); ++p)
      for (std::size_t i = 1; i < angles_[p].size(); ++i)
        if (paths_[p]->records[i].kind != MoveKind::rapid &&
            rotary_word(angles_[p][i][0]) != rotary_word(angles_[p][i - 1][0]))
          return true;
    return false;
  }
  /// Angles of tooth k of path p. Parallel axes: those of tooth 0 further on by the index, in whole turns that fit.
  Result<std::vector<RotaryPair>> tooth_angles(std::size_t p, int k) const {
    if (k == 0) return angles_[p];
    if (!parallel_) {
      return choose_rotaries(*paths_[p], tooth_rotation(k), chain_, ranges(false), machine_.post.pole);
    }
    auto a = angles_[p];
    double least = a.front()[0], greatest = least;
    for (const auto& r : a) {
      least = std::min(least, r[0]);
      greatest = std::max(greatest, r[0]);
    }
    const auto range = ranges(false)[0];
    const double index = program_.index_sign * tooth_angle(k);
    for (const int turn : {0, -1, 1, -2, 2}) {
      const double shift = index + 2 * kPi * turn;
      if (least + shift < range.lower - 1e-9 || greatest + shift > range.upper + 1e-9) continue;
      for (auto& r : a) r[0] += shift;
      return a;
    }
    return fail_as(DiagnosticKind::verification, "operation {} tooth {}: {} = {:.4f} .. {:.4f} deg outside [{:.4f}, {:.4f}]",
                   paths_[p]->operation, k, chain_.table[0].letter, degrees(least + index), degrees(greatest + index),
                   degrees(range.lower), degrees(range.upper));
  }

  // Rounding. The linear words are computed for the rounded rotary words, so that only their own last digit and, in a
  // loop whose index is printed rounded, half a digit of the index displace the tip.
  double rounding_of_words() const { return 0.5 * std::sqrt(3.0) * std::pow(10.0, -options_.format.linear_decimals); }
  double rounding_of_loop() const {
    return options_.loop_needs_constant_index ? rounding_of_copies() : rounding_of_words();
  }
  double rounding_of_copies() const {
    double reach = 0;
    for (const ClPath* path : paths_)
      for (const auto& r : path->records) reach = std::max(reach, r.tip.head<2>().norm());
    return rounding_of_words() + reach * radians(0.5 * std::pow(10.0, -options_.format.rotary_decimals));
  }

  std::int64_t rotary_word(double angle) const { return to_fixed(degrees(angle), options_.format.rotary_decimals); }
  double word_angle(std::int64_t word) const {
    return radians(static_cast<double>(word) / static_cast<double>(power_of_ten(options_.format.rotary_decimals)));
  }
  RotaryPair rounded(const RotaryPair& a) const {
    return {chain_.rotary_count() > 0 ? word_angle(rotary_word(a[0])) : 0,
            chain_.rotary_count() > 1 ? word_angle(rotary_word(a[1])) : 0};
  }
  std::int64_t linear_word(double joint, int axis) const {
    const double origin = setup_.work_offset_at_mm[axis] + (axis == 2 ? length_ : 0);
    return to_fixed(joint - origin, options_.format.linear_decimals);
  }
  Joints joints_of(const AxisBlock& b) const {
    Joints j;
    const double unit = static_cast<double>(power_of_ten(options_.format.linear_decimals));
    for (int i = 0; i < 3; ++i)
      j.linear_mm[i] = static_cast<double>(b.words[static_cast<std::size_t>(i)]) / unit + setup_.work_offset_at_mm[i] +
                       (i == 2 ? length_ : 0);
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) j.rotary_rad[k] = word_angle(b.words[3 + k]);
    return j;
  }

  // Operations.
  void operation(std::size_t p) {
    const ClPath& path = *paths_[p];
    const ToolAssembly& tool = tools_[static_cast<std::size_t>(path.tool)];
    AxisOperation op;
    op.operation = path.operation;
    op.type = path.operation_type;
    op.tool_number = tool.number;
    op.tool_length_mm = length_ = tool.length_mm;
    op.tool_name = tool.type == CutterType::ball_end_mill ? fmt::format("BALL END MILL D{}", tool.diameter_mm)
                                                          : fmt::format("FINGER MILL M{}", tool.module_mm);
    op.spindle_rpm = path.spindle_rpm;
    current_op_ = &op;
    const int written = program_.loop ? 1 : teeth_;
    machine_retract();
    auto angles = tooth_angles(p, 0);
    for (int k = 0; k < written && !error_; ++k) {
      if (!angles) {
        error_ = angles.error();
        break;
      }
      auto next = k + 1 < written ? tooth_angles(p, k + 1) : angles;
      if (!next) {
        error_ = next.error();
        break;
      }
      op.teeth.push_back({k, {}});
      if (copies_ && k > 0) {
        turned_copy(op.teeth.front().blocks, angles->front()[0] - angles_[p].front()[0], k, op.teeth.back().blocks);
        angles = std::move(next);
        continue;
      }
      op.teeth.back().blocks.reserve(path.records.size() + 16);
      tooth(path, *angles, next->front(), k, op.teeth.back().blocks);
      angles = std::move(next);
    }
    if (program_.loop) op.rapid_minutes += tooth_angle(teeth_ - 1) / chain_.table[0].max_speed;
    program_.operations.push_back(std::move(op));
  }

  /// Blocks of tooth k where the index rotary turns the gear about its own axis: the same words, the index from integers.
  void turned_copy(const std::vector<AxisBlock>& first, double shift, int k, std::vector<AxisBlock>& blocks) {
    tooth_ = k;
    const auto turn = std::llround((shift - program_.index_sign * tooth_angle(k)) / (2 * kPi));
    const int digits = options_.format.rotary_decimals;
    const std::int64_t word = ratio_to_fixed(std::int64_t{360} * k * program_.index_sign, teeth_, digits) +
                              turn * 360 * power_of_ten(digits);
    blocks = first;
    bool set = false;  // before its first X Y block a tooth stands where the one before left it
    for (auto& b : blocks) {
      set = set || b.kind == BlockKind::rapid_xy;
      b.words[3] += word;
      current_op_->feed_minutes += b.kind == BlockKind::feed ? b.minutes : 0;
      current_op_->rapid_minutes += b.kind == BlockKind::feed ? 0 : b.minutes;
      record_ = b.record;
      last_ = b;
      if (set) note_position(joints_of(b));
    }
  }

  void machine_retract() {
    // From wherever it was: the rotaries stay, Z is at its top. Before the first operation they stand at zero.
    at_retract_ = true;
  }

  void tooth(const ClPath& path, const std::vector<RotaryPair>& angles, const RotaryPair& next_start, int k,
             std::vector<AxisBlock>& blocks) {
    blocks_ = &blocks;
    tooth_ = k;
    const Mat3 rotation = tooth_rotation(k);
    const auto pose = [&](std::size_t i) {
      return Pose{rotation * path.records[i].tip + gear_.origin, rotation * path.records[i].axis};
    };
    start_of_tooth_ = true;
    pending_minutes_ = 0;
    for (std::size_t i = 0; i < path.records.size() && !error_; ++i) {
      record_ = static_cast<std::int32_t>(i);
      if (path.records[i].kind == MoveKind::rapid) {
        rapid_to(pose(i), rounded(angles[i]));
      } else {
        feed_to(pose(i - 1), angles[i - 1], pose(i), angles[i], path.records[i].feed_mm_min, 0);
      }
    }
    if (error_) return;
    // Ready to be turned to where the next tooth begins.
    rise_to(tip_height_for_turn(rounded(next_start)));
  }

  double tip_height() const { return height_of(last_); }
  /// Machine Z of the tip.
  double height_of(const AxisBlock& b) const {
    const Joints j = joints_of(b);
    return (chain_.table_to_machine(chain_.forward(j, length_).tip_mm, j.rotary_rad)).z();
  }
  double retract_height() const { return program_.retract_z_mm - length_; }

  /// Tip height from which the rotaries may go to `to`. With a swinging head that is only the top of Z.
  double tip_height_for_turn(const RotaryPair& to) {
    const RotaryPair from = joints_of(last_).rotary_rad;
    if (from == to && !program_.loop) return body_top(chain_, gear_, body_, to) + options_.clearance_margin_mm;
    if (!chain_.head.empty() && from[1] != to[1]) return retract_height();
    return std::max(swept_top(chain_, gear_, body_, from, to, coincident_),
                    body_top(chain_, gear_, body_, to)) + options_.clearance_margin_mm;
  }

  void rapid_to(const Pose& target, const RotaryPair& rotaries) {
    AxisBlock goal;
    const Joints j = chain_.linear_for(target.tip, rotaries, length_);
    set_words(goal, j.linear_mm, rotaries);
    const double goal_height = height_of(goal);
    const bool turns = goal.words[3] != last_.words[3] || goal.words[4] != last_.words[4];
    double needed = body_top(chain_, gear_, body_, rotaries) + options_.clearance_margin_mm;
    needed = std::max(needed, goal_height);
    const bool first = start_of_tooth_;
    start_of_tooth_ = false;
    if (!first && goal.words == last_.words) return;
    if (first && at_retract_) {
      const double swept = turns ? tip_height_for_turn(rotaries) : needed;
      if (std::max(swept, needed) > retract_height() + 1e-9) return too_low(std::max(swept, needed));
      // Z stands at the top: the words of the axes that do not move yet.
      AxisBlock top = last_;
      top.words[2] = linear_word(program_.retract_z_mm, 2);
      last_ = top;
      at_retract_ = false;
    } else if (turns) {
      rise_to(std::max(needed, tip_height_for_turn(rotaries)));
    } else {
      rise_to(needed);
    }
    if (error_) return;
    if (turns || first) {
      AxisBlock b = last_;
      b.record = -1;
      b.kind = BlockKind::rapid_rotary;
      b.words[3] = goal.words[3];
      b.words[4] = goal.words[4];
      if (chain_.rotary_count() > 0) push_rapid(b, first || turns);
    }
    if (first || turns || goal.words[0] != last_.words[0] || goal.words[1] != last_.words[1]) {
      AxisBlock b = last_;
      b.record = -1;
      b.kind = BlockKind::rapid_xy;
      b.words[0] = goal.words[0];
      b.words[1] = goal.words[1];
      push_rapid(b, first || turns);
    }
    if (first || turns || goal.words[2] != last_.words[2]) {
      AxisBlock b = last_;
      b.kind = BlockKind::rapid_z;
      b.words[2] = goal.words[2];
      b.record = record_;
      push_rapid(b, first || turns);
    }
    broken_ = true;
  }

  /// Z alone, upwards only.
  void rise_to(double height) {
    const double now = tip_height();
    if (height > retract_height() + 1e-9) return too_low(height);
    if (height <= now) return;
    AxisBlock b = last_;
    b.kind = BlockKind::rapid_z;
    const Joints j = joints_of(last_);
    b.words[2] = std::min(linear_word(j.linear_mm.z() + height - now, 2) + 1, linear_word(program_.retract_z_mm, 2));
    b.record = -1;
    push_rapid(b, true);
    broken_ = true;
  }

  void too_low(double height) {
    error_ = fail_as(DiagnosticKind::verification,
                     "operation {} record {} (tooth {}): the part sweeps up to {:.3f} mm above the machine zero with its "
                     "margin, the tool tip at Z {:.3f} rises to {:.3f} only",
                     current_op_->operation, record_, tooth_, height, program_.retract_z_mm, retract_height());
  }

  void set_words(AxisBlock& b, const Vec3& linear, const RotaryPair& rotaries) const {
    for (int i = 0; i < 3; ++i) b.words[static_cast<std::size_t>(i)] = linear_word(linear[i], i);
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) b.words[3 + k] = rotary_word(rotaries[k]);
  }

  void push_rapid(AxisBlock b, bool forced) {
    b.forced = forced;
    const Joints from = joints_of(last_), to = joints_of(b);
    b.minutes = std::max(linear_time(from, to), rotary_time(from, to));
    current_op_->rapid_minutes += b.minutes * (program_.loop ? teeth_ : 1);
    blocks_->push_back(b);
    last_ = b;
    positioned_ = positioned_ || b.kind == BlockKind::rapid_xy;
    if (positioned_) note_position(to);
  }

  // Feed.
  void feed_to(const Pose& from, const RotaryPair& from_angles, const Pose& to, const RotaryPair& to_angles, double feed,
               int depth) {
    if (error_) return;
    const RotaryPair a = rounded(from_angles), b = rounded(to_angles);
    const Joints ja = chain_.linear_for(from.tip, a, length_), jb = chain_.linear_for(to.tip, b, length_);
    double tip_error = 0, axis_error = 0;
    if (a != b) {
      for (const double t : {0.25, 0.5, 0.75}) {
        Joints j;
        j.linear_mm = (1 - t) * ja.linear_mm + t * jb.linear_mm;
        for (std::size_t k = 0; k < 2; ++k) j.rotary_rad[k] = (1 - t) * a[k] + t * b[k];
        const TablePose p = chain_.forward(j, length_);
        tip_error = std::max(tip_error, (p.tip_mm - ((1 - t) * from.tip + t * to.tip)).norm());
        axis_error = std::max(axis_error, angle_between(p.axis, slerp(from.axis, to.axis, t)));
      }
    }
    if (tip_error <= options_.chord_mm && axis_error <= options_.axis_rad + rounding_of_axis()) {
      if (a != b) note_bounds(ja, jb, from, to, axis_error);
      push_feed(jb, b, feed);
      return;
    }
    if (depth >= kDeepestSplit) {
      error_ = fail("operation {} record {} (tooth {}): after {} halvings the tip still leaves the chord by {:.6f} mm (limit "
                    "{:.6f}), the axis by {:.6f} deg (limit {:.6f})",
                    current_op_->operation, record_, tooth_, depth, tip_error, options_.chord_mm, degrees(axis_error),
                    degrees(options_.axis_rad));
      return;
    }
    // The mean of the commands keeps a fixed tilt fixed; where its axis is too far from the great circle, the inverse of that.
    Pose middle{0.5 * (from.tip + to.tip), slerp(from.axis, to.axis, 0.5)};
    std::optional<RotaryPair> angles = RotaryPair{0.5 * (from_angles[0] + to_angles[0]), 0.5 * (from_angles[1] + to_angles[1])};
    const Vec3 mean_axis = chain_.forward(Joints{Vec3::Zero(), *angles}, length_).axis;
    if (angle_between(mean_axis, middle.axis) <= 0.5 * options_.axis_rad)
      middle.axis = mean_axis;
    else
      angles = angles_between(middle.axis, from_angles, to_angles);
    if (!angles) return;
    ++program_.inserted_blocks;
    feed_to(from, from_angles, middle, *angles, feed, depth + 1);
    feed_to(middle, *angles, to, to_angles, feed, depth + 1);
  }

  double rounding_of_axis() const { return radians(std::pow(10.0, -options_.format.rotary_decimals)); }

  /// The solution for an axis in the middle of a step, on the branch of its ends.
  std::optional<RotaryPair> angles_between(const Vec3& axis, const RotaryPair& a, const RotaryPair& b) {
    const auto list = chain_.rotary_solutions(axis);
    if (!list) {
      error_ = fail("operation {} record {}: {}", current_op_->operation, record_, list.error().message);
      return std::nullopt;
    }
    std::optional<RotaryPair> best;
    double best_distance = 0;
    for (const auto& s : *list) {
      RotaryPair angles{};
      double distance = 0;
      for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
        const double middle = 0.5 * (a[k] + b[k]);
        angles[k] = s.free_rotary == static_cast<int>(k) ? middle : nearest_turn(s.joints.rotary_rad[k], middle);
        distance = std::max(distance, std::abs(angles[k] - middle));
      }
      if (!best || distance < best_distance) {
        best = angles;
        best_distance = distance;
      }
    }
    return best;
  }

  /// Section 3: |p''| / 8 with w the sum of the turns and R the greatest distance of the tip from a rotary axis.
  void note_bounds(const Joints& a, const Joints& b, const Pose& from, const Pose& to, double axis_error) {
    const double w = std::abs(b.rotary_rad[0] - a.rotary_rad[0]) + std::abs(b.rotary_rad[1] - a.rotary_rad[1]);
    const double dx = (b.linear_mm - a.linear_mm).norm();
    double reach = 0;
    for (std::size_t k = 0; k < chain_.table.size(); ++k) {
      const RotaryAxis& axis = chain_.table[k];
      for (const auto& [pose, j] : {std::pair<const Pose&, const Joints&>(from, a), {to, b}}) {
        const Vec3 p = k == 0 ? pose.tip : chain_.table_to_machine(pose.tip, j.rotary_rad);
        reach = std::max(reach, (p - axis.point_mm).cross(axis.direction).norm());
      }
    }
    double arm = length_;
    for (const auto& axis : chain_.head) arm += 2 * axis.point_mm.norm();
    if (!chain_.head.empty()) reach = std::max(reach, arm);
    reach += 0.5 * (dx + w * reach);
    program_.chord_bound_mm = std::max(program_.chord_bound_mm, (w * w * reach + 2 * w * dx) / 8);
    program_.axis_bound_rad = std::max({program_.axis_bound_rad, axis_error, std::min(w * w / 4, options_.axis_rad * 2)});
  }

  void push_feed(const Joints& joints, const RotaryPair& rotaries, double feed) {
    AxisBlock b;
    b.kind = BlockKind::feed;
    set_words(b, joints.linear_mm, rotaries);
    b.record = record_;
    b.forced = broken_;
    const Joints from = joints_of(last_), to = joints_of(b);
    const double tip_path = (chain_.forward(to, length_).tip_mm - chain_.forward(from, length_).tip_mm).norm();
    double times[kTimeTerms] = {tip_path / feed,
                                machine_.max_cutting_feed > 0 ? tip_path / machine_.max_cutting_feed : 0,
                                linear_time(from, to),
                                rotary_time(from, to),
                                machine_.min_block_ms / 60000,
                                options_.max_inverse_time > 0 ? 1 / options_.max_inverse_time : 0};
    if (b.words == last_.words) {
      pending_minutes_ += times[kFeed];
      ++program_.dropped_blocks;
      if (!blocks_->empty() && blocks_->back().kind == BlockKind::feed) blocks_->back().record = record_;
      return;
    }
    times[kFeed] += pending_minutes_;
    pending_minutes_ = 0;
    const auto ruler = std::max_element(times, times + kTimeTerms) - times;
    ++program_.time_ruled[static_cast<std::size_t>(ruler)];
    b.minutes = times[ruler];
    if (!(b.minutes > 0)) {
      error_ = fail("operation {} record {}: a block takes no time", current_op_->operation, record_);
      return;
    }
    int moving = 0;
    for (std::size_t i = 0; i < 5; ++i) moving += b.words[i] != last_.words[i] ? 1 : 0;
    if (machine_.max_simultaneous_axes > 0 && moving > machine_.max_simultaneous_axes) {
      error_ = fail("operation {} record {}: {} axes move in one block, the control interpolates {} (keep the tilt fixed in "
                    "a pass)",
                    current_op_->operation, record_, moving, machine_.max_simultaneous_axes);
      return;
    }
    current_op_->feed_minutes += b.minutes * (program_.loop ? teeth_ : 1);
    blocks_->push_back(b);
    last_ = b;
    broken_ = false;
    note_position(to);
  }

  double linear_time(const Joints& a, const Joints& b) const {
    double t = 0;
    for (int i = 0; i < 3; ++i)
      t = std::max(t, std::abs(b.linear_mm[i] - a.linear_mm[i]) / chain_.linear[static_cast<std::size_t>(i)].max_speed);
    return t;
  }
  double rotary_time(const Joints& a, const Joints& b) const {
    double t = 0;
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k)
      t = std::max(t, std::abs(b.rotary_rad[k] - a.rotary_rad[k]) / chain_.rotary(k).max_speed);
    return t;
  }

  void note_position(const Joints& j) {
    const bool at_top = last_.kind != BlockKind::feed && last_.words[2] == linear_word(program_.retract_z_mm, 2);
    placed_.note(j, !at_top, current_op_->operation, record_, tooth_, chain_, machine_.limit_margin);
  }

  void finish() {
    for (const auto& op : program_.operations) {
      program_.feed_minutes += op.feed_minutes;
      program_.minutes += op.feed_minutes + op.rapid_minutes;
    }
  }

  std::span<const ClPath* const> paths_;
  std::span<const ToolAssembly> tools_;
  const Setup& setup_;
  const Machine& machine_;
  const KinematicChain& chain_;
  ClearanceBody body_;
  AxisOptions options_;
  int teeth_;
  GearPlacement gear_;
  AxisProgram program_;
  std::vector<std::vector<RotaryPair>> angles_;  // tooth 0, by path
  bool parallel_ = false, coincident_ = false, copies_ = false;
  std::optional<Diagnostic> error_;
  TravelRecord placed_;
  // Where the sequence stands.
  double length_ = 0;
  AxisOperation* current_op_ = nullptr;
  std::vector<AxisBlock>* blocks_ = nullptr;
  AxisBlock last_;
  int tooth_ = 0;
  std::int32_t record_ = 0;
  bool at_retract_ = true, start_of_tooth_ = true, broken_ = true;
  bool positioned_ = false;  // X and Y have been commanded
  double pending_minutes_ = 0;
};

Result<AxisProgram> build_from(std::span<const ClPath* const> paths, std::span<const ToolAssembly> tools, const Setup& setup,
                               const Machine& machine, int teeth, const ClearanceBody& body, const AxisOptions& options) {
  return Builder(paths, tools, setup, machine, teeth, body, options).build();
}

}  // namespace

Result<AxisProgram> build_axis_program(std::span<const CheckedClPath> paths, std::span<const ToolAssembly> tools,
                                       const Setup& setup, const Machine& machine, int teeth, const ClearanceBody& body,
                                       const AxisOptions& options) {
  std::vector<const ClPath*> list;
  for (const auto& p : paths) list.push_back(&p.path());
  return build_from(list, tools, setup, machine, teeth, body, options);
}

Result<AxisProgram> AxisProgramTestAccess::build(std::span<const ClPath> paths, std::span<const ToolAssembly> tools,
                                                 const Setup& setup, const Machine& machine, int teeth,
                                                 const ClearanceBody& body, const AxisOptions& options) {
  std::vector<const ClPath*> list;
  for (const auto& p : paths) list.push_back(&p);
  return build_from(list, tools, setup, machine, teeth, body, options);
}

}  // namespace toothpath
