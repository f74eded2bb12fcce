#include "postproc/joints/program.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "postproc/choice/solution.h"
#include "postproc/choice/ways.h"
#include "postproc/joints/clearance.h"
#include "postproc/joints/inputs.h"
#include "postproc/joints/rollover.h"
#include "postproc/joints/time.h"
#include "postproc/joints/tooth.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/joints/travel.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::joints {
namespace {

constexpr double kCoincident = 1e-9;             // mm: the gear axis lies on the index axis
constexpr double kParallel = 1e-12;              // sine of the angle between gear axis and index axis
constexpr int kLowerPlaces = 4;                  // that are tried for a part that stands too high
constexpr std::size_t kMostBlocks = 20'000'000;  // of 20 bytes in memory, and 30 to 100 bytes of text each

/// Decides about angles, loop and copies; the blocks of a tooth come from ToothBuilder.
class ProgramBuilder {
 public:
  ProgramBuilder(std::span<const path::ClPath* const> paths, std::span<const tool::ToolAssembly> tools,
                 const Setup& setup, const machines::Machine& machine, int teeth, const ClearanceBody& body,
                 const AxisOptions& options)
      : paths_(paths),
        tools_(tools),
        setup_(setup),
        machine_(machine),
        chain_(machine.chain),
        options_(options),
        teeth_(teeth),
        gear_{setup.rotation(), setup.origin_mm},
        words_(machine.chain, options.format, setup.work_offset_at_mm),
        body_(body) {}

  Result<AxisProgram> build() {
    if (auto bad = check_axis_inputs(paths_, tools_, machine_, teeth_, options_)) return *bad;
    describe_machine();
    if (auto bad = place_planes()) return *bad;
    place_index_axis();
    if (program_.loop) {
      if (!choose_all(true)) leave_loop("its turns leave the travels");  // one tooth at a time may still find its own
    }
    if (!program_.loop && !choose_all(false)) return *error_;
    if (auto bad = planes_stand()) return *bad;
    note_poles();
    if (program_.loop && rounding_of_loop() > options_.nc_step_mm)
      leave_loop("the angles that the control works out are rounded by too much");
    if (auto bad = check_size()) return *bad;
    // With TCP the words of the tip differ from tooth to tooth.
    copies_ = !tcp() && !program_.loop && coincident_ && teeth_ > 1 && rounding_of_copies() <= options_.nc_step_mm;
    program_.rounding_bound_mm = program_.loop ? rounding_of_loop()
                                 : copies_     ? rounding_of_copies()
                                               : words_.linear_rounding();
    program_.rounding_bound_mm += rounding_of_planes();
    if (program_.rounding_bound_mm > options_.nc_step_mm)
      return fail("rounding the words moves the tip by up to {:.6f} mm, more than {:.6f}", program_.rounding_bound_mm,
                  options_.nc_step_mm);
    if (options_.search_origin) {
      poses_.emplace(chain_, machine_.limit_margin,
                     coincident_ ? std::optional(chain_.table[0].direction) : std::nullopt);
      placed_.collect(&*poses_);
    }
    const AxisJob job{machine_, body_, options_, teeth_, gear_, coincident_};
    ToothBuilder builder(job, program_, placed_, setup_.work_offset_at_mm);
    for (std::size_t p = 0; p < paths_.size(); ++p) {
      if (auto bad = operation(p, builder)) {
        lack_ = builder.lack_mm();
        return with_lower_place(*bad);
      }
      if (!loop_is_entered_) return written_out();
    }
    if (poses_) program_.offer = poses_->best();
    if (auto bad = check_travel(program_, machine_, placed_)) return with_offer(*bad);
    finish();
    return std::move(program_);
  }

 private:
  [[nodiscard]] bool tcp() const { return machine_.tcp != machines::TcpMode::none && !options_.tilted_planes; }

  void leave_loop(const char* why) {
    program_.loop = false;
    program_.no_loop = why;
  }
  /// The same without the loop.
  Result<AxisProgram> written_out() const {
    AxisOptions options = options_;
    options.expand_teeth = true;
    auto program = ProgramBuilder(paths_, tools_, setup_, machine_, teeth_, body_, options).build();
    if (program) program->no_loop = "its first tooth is not entered as the others are";
    return program;
  }
  /// Only for a program that is refused as it stands: it takes as long as the program itself.
  void try_offer() {
    choice::TravelOffer& offer = *program_.offer;
    if (*std::min_element(offer.room_then_mm.begin(), offer.room_then_mm.end()) < 0) return;
    Setup there = setup_;
    there.origin_mm += offer.shift_mm;
    there.work_offset_at_mm += offer.shift_mm;
    AxisOptions options = options_;
    options.search_origin = false;
    offer.posted = ProgramBuilder(paths_, tools_, there, machine_, teeth_, body_, options).build().has_value();
  }
  /// The error of a part that stands too high for its links, with a place farther down where they have room.
  Diagnostic with_lower_place(Diagnostic bad) const {
    if (!(lack_ > 0) || !options_.search_origin) return bad;
    const auto up = [](double mm) { return std::ceil(mm * 1000) / 1000; };
    bad.message += fmt::format("; a tool that is shorter by {:.3f} mm or more helps", up(lack_));
    Setup there = setup_;
    AxisOptions options = options_;
    options.search_origin = false;
    double lack = lack_;
    for (int k = 0; k < kLowerPlaces && lack > 0; ++k) {
      there.origin_mm.z() -= up(lack);
      there.work_offset_at_mm.z() -= up(lack);
      ProgramBuilder lower(paths_, tools_, there, machine_, teeth_, body_, options);
      const auto made = lower.build();
      lack = lower.lack_;
      const Vec3 &at = there.origin_mm, &work = there.work_offset_at_mm;
      if (made)
        bad.message += fmt::format(
            ", or the part {:.3f} mm lower: setup.origin = [{:.3f}, {:.3f}, {:.3f}] with work_offset_at = [{:.3f}, "
            "{:.3f}, {:.3f}] fits",
            setup_.origin_mm.z() - at.z(), at.x(), at.y(), at.z(), work.x(), work.y(), work.z());
      else if (!(lack > 0))
        bad.message += fmt::format("; {:.3f} mm lower the links have room, but {}", setup_.origin_mm.z() - at.z(),
                                   made.error().message.substr(0, made.error().message.find('\n')));
    }
    return bad;
  }
  /// The error of a travel that is exceeded, with the place of the part that has the most room.
  Diagnostic with_offer(Diagnostic bad) {
    if (!program_.offer) return bad;
    try_offer();
    const choice::TravelOffer& offer = *program_.offer;
    const auto& room = offer.room_then_mm;
    const Vec3 at = setup_.origin_mm + offer.shift_mm, work = setup_.work_offset_at_mm + offer.shift_mm;
    if (offer.posted)
      bad.message += fmt::format(
          "; most room: set-up origin [{:.3f}, {:.3f}, {:.3f}] with work_offset_at [{:.3f}, {:.3f}, {:.3f}] leaves X "
          "{:.3f}, Y {:.3f}, Z {:.3f} mm",
          at.x(), at.y(), at.z(), work.x(), work.y(), work.z(), room[0], room[1], room[2]);
    else if (*std::min_element(room.begin(), room.end()) < 0)
      bad.message += fmt::format("; nowhere{} does the part have room: at best X {:.3f}, Y {:.3f}, Z {:.3f} mm",
                                 offer.on_index_axis ? " on the axis that turns it" : "", room[0], room[1], room[2]);
    return bad;
  }

  void describe_machine() {
    program_.format = options_.format;
    program_.teeth = teeth_;
    program_.tooth_stride = options_.tooth_stride;
    program_.letters = {'X', 'Y', 'Z', 0, 0};
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
      program_.letters[3 + k] = chain_.rotary(k).letter;
      program_.rollover[3 + k] = chain_.rotary(k).rollover;
    }
    program_.work_offset = setup_.work_offset;
    program_.work_offset_at_mm = setup_.work_offset_at_mm;
    program_.tcp = tcp() ? machine_.tcp : machines::TcpMode::none;
    program_.corners = options_.corners;
    program_.tcp_starts_at_zero = tcp() && options_.tcp_starts_at_zero;
    const double top = machine_.top_mm();
    const double unit = std::pow(10.0, options_.format.linear_decimals);
    program_.retract_z_mm = std::floor(top * unit + 1e-6) / unit;
    program_.assumed = machine_.assumed_keys;
    program_.time_rulers.assign(kTimeNames, kTimeNames + kTimeTerms);
    program_.time_ruled.assign(kTimeTerms, 0);
  }

  // Tilted planes.
  /// Their origin is that of the gear, so that all teeth have the same words.
  std::optional<Diagnostic> place_planes() {
    if (!options_.tilted_planes) return std::nullopt;
    const auto planes = plane_form_of(chain_, options_.format);
    if (!planes) return fail_at(*options_.tilted_planes, "tilted_planes: {}", planes.error().message);
    program_.planes = *planes;
    const double unit = std::pow(10.0, options_.format.linear_decimals);
    for (int i = 0; i < 3; ++i)
      program_.planes->origin_mm[i] = std::round((setup_.origin_mm[i] - setup_.work_offset_at_mm[i]) * unit) / unit;
    words_.set_planes(program_.planes);
    return std::nullopt;
  }
  /// How far their origin stands beside the axis that turns them, by its rounding: teeth that are the first one turned
  /// on are off by twice that.
  double rounding_of_planes() const {
    if (!program_.planes) return 0;
    return 2 * (setup_.work_offset_at_mm + program_.planes->origin_mm - setup_.origin_mm).norm();
  }
  /// No rotary turns in a cut.
  std::optional<Diagnostic> planes_stand() const {
    if (!program_.planes) return std::nullopt;
    for (const FollowedPath& f : followed_)
      for (std::size_t i = 1; i < f.angles.size(); ++i) {
        if (f.path().records[i].kind == path::MoveKind::rapid) continue;
        for (std::size_t k = 0; k < 2; ++k)
          if (const double turn = f.angles[i][k] - f.angles[i - 1][k];
              words_.rotary_word(f.angles[i][k]) != words_.rotary_word(f.angles[i - 1][k]))
            return fail_at(*options_.tilted_planes,
                           "tilted_planes: operation {} record {} turns {} by {:.4f} deg in a cut, limit 0: a plane "
                           "stands still. Leave tilted_planes out{}, or give the operation a tool axis that stands in "
                           "every pass",
                           f.path().operation, i, chain_.rotary(k).letter, degrees(turn),
                           machine_.tcp == machines::TcpMode::none ? "" : ", so that it is written with TCP");
      }
    return std::nullopt;
  }

  /// Is the gear axis parallel to the rotary that carries the work, and is it that axis?
  void place_index_axis() {
    program_.no_loop = "no rotary turns the gear about its own axis";
    if (chain_.table.empty()) return;
    const machines::RotaryAxis& c = chain_.table[0];
    const Vec3 gear_axis = gear_.rotation.col(2);
    if (c.direction.cross(gear_axis).norm() > kParallel) return;
    parallel_ = true;
    program_.index_axis = 3;
    program_.index_sign = c.sign * (c.direction.dot(gear_axis) > 0 ? 1 : -1);
    program_.no_loop = "";
    coincident_ = (gear_.origin - c.point_mm).cross(c.direction).norm() <= kCoincident;
    const bool in_every_text = options_.tilted_planes && options_.index_is_rounded;  // no variable in a called tooth
    program_.loop =
        coincident_ && !options_.expand_teeth && !in_every_text && teeth_ > 1 && (!tcp() || frame_can_turn());
    if (in_every_text) program_.no_loop = "the tilted plane of this control stands in the text of every tooth";
    if (!coincident_) program_.no_loop = "the gear does not turn about its own axis";
    else if (tcp() && !frame_can_turn())
      program_.no_loop = options_.tcp_loop
                             ? "with TCP this control turns a frame about its work offset, which is not the gear axis"
                             : options_.no_tcp_loop;
    program_.frame_sign = gear_axis.z() > 0 ? 1 : -1;
  }

  /// The control turns a frame about the Z axis through its work offset: that must be the gear axis. One that is
  /// the table's turns with it.
  bool frame_can_turn() const {
    if (!options_.tcp_loop || options_.tcp_frame_is_table) return options_.tcp_loop;
    const Vec3 gear_axis = gear_.rotation.col(2);
    return std::abs(std::abs(gear_axis.z()) - 1) <= kParallel &&
           (gear_.origin - setup_.work_offset_at_mm).head<2>().norm() <= kCoincident;
  }

  /// Refuses by number what would not fit into memory, before a block is made.
  std::optional<Diagnostic> check_size() const {
    std::size_t records = 0;
    for (const path::ClPath* path : paths_) records += path->records.size();
    const std::size_t written = program_.loop ? 1 : static_cast<std::size_t>(teeth_);
    if (records <= kMostBlocks / written) return std::nullopt;
    return fail("the program would have at least {} blocks ({} records, {} teeth written out), more than {}",
                records * written, records, written, kMostBlocks);
  }

  double tooth_angle(int k) const { return 2 * kPi * k / teeth_; }
  Mat3 tooth_rotation(int k) const {
    return gear_.rotation * Eigen::AngleAxisd(tooth_angle(k), Vec3::UnitZ()).toRotationMatrix();
  }

  // Angles.
  std::array<choice::RotaryRange, 2> ranges(bool leave_room_for_index) const {
    std::array<choice::RotaryRange, 2> out{};
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
      const auto& axis = chain_.rotary(k);
      out[k] = {axis.min_rad + machine_.limit_margin.rotary_rad, axis.max_rad - machine_.limit_margin.rotary_rad};
    }
    if (leave_room_for_index) {
      const double span = tooth_angle(teeth_ - 1);
      if (program_.index_sign > 0) out[0].upper -= span;
      else out[0].lower += span;
    }
    return out;
  }
  /// Poles handled, then the angles. @param rotation table frame from the gear frame of this tooth
  Result<FollowedPath> follow(std::size_t p, const Mat3& rotation, bool leave_room_for_index, int only_pair = 0) {
    FollowedPath out;
    out.planned = paths_[p];
    const PoleRules rules = pole_rules_of(machine_, options_, tools_[static_cast<std::size_t>(paths_[p]->tool)], body_);
    std::vector<Vec3> poles = poles_of(chain_);
    for (Vec3& pole : poles) pole = rotation.transpose() * pole;
    auto handled = handle_poles(*paths_[p], poles, rules);
    if (!handled) return handled.error();
    out.changed = std::move(*handled);
    out.ball_radius_mm = rules.ball_radius_mm;
    if (out.changed && out.changed->passages > 0) {
      program_.pole_axis_rad = std::max(program_.pole_axis_rad, rules.change_rad);
      program_.pole_tip_mm = std::max(program_.pole_tip_mm, 2 * rules.ball_radius_mm * std::sin(rules.change_rad / 2));
    }
    auto angles =
        choice::choose_rotaries(out.path(), rotation, chain_, ranges(leave_room_for_index), machine_.post.pole,
                                out.changed ? out.changed->switches : std::vector<char>{}, only_pair);
    if (!angles) return angles.error();
    out.angles = std::move(*angles);
    return out;
  }
  /// Angles of tooth 0 for every path; false (and error_) if some path has none.
  bool choose_all(bool leave_room_for_index) {
    followed_.clear();
    error_.reset();
    for (std::size_t p = 0; p < paths_.size(); ++p) {
      auto f = follow(p, gear_.rotation, leave_room_for_index);
      if (!f) {
        error_ = f.error();
        return false;
      }
      followed_.push_back(std::move(*f));
    }
    return true;
  }
  void note_poles() {
    bool changed = false;
    for (const auto& f : followed_) {
      changed = changed || f.changed;
      program_.pole_passages += f.changed ? f.changed->passages : 0;
    }
    if (changed)
      for (const auto& f : followed_) program_.followed.push_back(f.path());
  }
  /// How a tooth is cut: on the angles of a tooth 0, turned on, or on angles of its own.
  struct Way {
    const FollowedPath* turned = nullptr;
    std::shared_ptr<const FollowedPath> own;
    double shift = 0;   ///< of the rotary that carries the work
    bool copy = false;  ///< the way of the first tooth that is written, turned

    [[nodiscard]] const FollowedPath& path() const { return own ? *own : *turned; }
  };
  /// The commands of tooth 0 further on by the index, in whole turns that fit.
  std::vector<Way> turned_ways(const FollowedPath& first, int k) const {
    double least = first.angles.front()[0], greatest = least;
    for (const auto& r : first.angles) {
      least = std::min(least, r[0]);
      greatest = std::max(greatest, r[0]);
    }
    const auto range = ranges(false)[0];
    std::vector<Way> ways;
    for (const int turn : {0, -1, 1, -2, 2}) {
      const double shift = program_.index_sign * tooth_angle(k) + 2 * kPi * turn;
      if (least + shift < range.lower - 1e-9 || greatest + shift > range.upper + 1e-9) continue;
      ways.push_back({&first, nullptr, shift, false});
    }
    return ways;
  }
  choice::ToothWay ends_of(const Way& way) const {
    const FollowedPath& followed = way.path();
    choice::ToothWay out{followed.angles.front(), followed.angles.back(), 0};
    out.begin[0] += way.shift;
    out.end[0] += way.shift;
    for (std::size_t i = 1; i < followed.angles.size(); ++i)
      if (followed.path().records[i].kind == path::MoveKind::rapid)
        out.minutes += choice::reposition_minutes(chain_, followed.angles[i - 1], followed.angles[i]);
    return out;
  }
  /// The ways of all teeth that are written, by their place in the program. Where the gear turns about an axis parallel
  /// to its own those of tooth 0 serve all; where they do not reach every tooth, the other pair of angles and other
  /// pairs from pass to pass are looked at for all of them.
  Result<std::vector<Way>> ways_of_teeth(std::size_t p, const RotaryPair& from) {
    const int written = program_.loop ? 1 : teeth_;
    std::vector<Way> ways;
    for (int n = 0; n < written; ++n) {
      const int k = tooth_of_place(n, options_.tooth_stride, teeth_);
      const auto turned = k == 0 ? std::vector<Way>{{&followed_[p], nullptr, 0, true}} : turned_ways(followed_[p], k);
      if (turned.empty()) return ways_by_search(p, from);
      ways.push_back(turned.front());
      ways.back().copy = true;
    }
    return ways;
  }
  Result<std::vector<Way>> ways_by_search(std::size_t p, const RotaryPair& from) {
    other_pairs_.clear();
    for (const int pair : {1, 2})
      if (auto f = follow(p, gear_.rotation, false, pair)) other_pairs_.push_back(std::move(*f));
    std::vector<std::vector<Way>> of_tooth;
    std::vector<std::vector<choice::ToothWay>> ends;
    for (int n = 0; n < teeth_; ++n) {
      const int k = tooth_of_place(n, options_.tooth_stride, teeth_);
      std::vector<Way> ways = turned_ways(followed_[p], k);
      for (const FollowedPath& other : other_pairs_)
        for (Way& way : turned_ways(other, k)) ways.push_back(std::move(way));
      auto own = follow(p, tooth_rotation(k), false);
      if (own) ways.push_back({nullptr, std::make_shared<const FollowedPath>(std::move(*own)), 0, false});
      else if (ways.empty()) return in_tooth(own.error(), k);
      ends.emplace_back();
      for (const Way& way : ways) ends.back().push_back(ends_of(way));
      of_tooth.push_back(std::move(ways));
    }
    const auto chosen = choice::choose_ways(ends, from, chain_);
    std::vector<Way> out;
    for (std::size_t n = 0; n < of_tooth.size(); ++n) out.push_back(of_tooth[n][chosen[n]]);
    // Its last blocks make ready for the next tooth: that one must be cut as the second is.
    const auto alike = [&](std::size_t a, std::size_t b) { return !out[a].own && out[a].turned == out[b].turned; };
    for (std::size_t n = 0; n < out.size(); ++n) out[n].copy = alike(n, 0) && (n + 1 == out.size() || alike(n + 1, 1));
    return out;
  }
  static Diagnostic in_tooth(Diagnostic bad, int k) {
    bad.message = fmt::format("tooth {}: {}", k, bad.message);
    return bad;
  }
  /// The angles of one tooth that is written.
  Result<FollowedPath> angles_of(std::size_t p, const std::vector<Way>& ways, int n) {
    const int k = tooth_of_place(n, options_.tooth_stride, teeth_);
    if (!parallel_) return k == 0 ? Result<FollowedPath>(followed_[p]) : follow(p, tooth_rotation(k), false);
    const Way& way = ways[static_cast<std::size_t>(n)];
    FollowedPath out = way.path();
    for (auto& r : out.angles) r[0] += way.shift;
    return out;
  }

  // Rounding. The linear words are computed for the rounded rotary words, so that only their own last digit and, in a
  // loop whose index is printed rounded, half a digit of the index displace the tip.
  double rounding_of_loop() const {
    return options_.index_is_rounded ? rounding_of_copies() : words_.linear_rounding();
  }
  double rounding_of_copies() const {
    double reach = 0;
    for (const path::ClPath* path : paths_)
      for (const auto& r : path->records) reach = std::max(reach, r.tip.head<2>().norm());
    return words_.linear_rounding() + reach * 0.5 * words_.rotary_step();
  }

  // Operations.
  std::optional<Diagnostic> operation(std::size_t p, ToothBuilder& builder) {
    const path::ClPath& path = *paths_[p];
    const tool::ToolAssembly& tool = tools_[static_cast<std::size_t>(path.tool)];
    AxisOperation op;
    op.operation = path.operation;
    op.type = path.operation_type;
    op.tool_number = tool.number;
    op.tool_length_mm = tool.length_mm;
    op.tool_name = tool::cutter_comment(tool);
    op.shop_names = tool::shop_names(tool);
    op.cutter = tool::apt_cutter(tool);
    op.spindle_rpm = path.spindle_rpm;
    builder.begin(op, tool);
    const int written = program_.loop ? 1 : teeth_;
    std::vector<Way> ways;
    if (parallel_ || written == 1) {
      auto found = ways_of_teeth(p, builder.start_rotaries());
      if (!found) return found.error();
      ways = std::move(*found);
    }
    auto angles = angles_of(p, ways, 0);
    double first_index = 0;  // angle of the index rotary at the beginning of the first tooth
    for (int n = 0; n < written; ++n) {
      const int k = tooth_of_place(n, options_.tooth_stride, teeth_);
      if (!angles) return angles.error();
      auto next = n + 1 < written ? angles_of(p, ways, n + 1) : angles;
      if (!next) return next.error();
      roll_to(chain_, builder.start_rotaries(), angles->angles);
      roll_to(chain_, angles->angles.back(), next->angles);
      if (n == 0) first_index = angles->angles.front()[0];
      op.teeth.push_back({k, {}});
      auto& blocks = op.teeth.back().blocks;
      if (copies_ && n > 0 && ways[static_cast<std::size_t>(n)].copy) {
        turned_copy(op.teeth.front().blocks, angles->angles.front()[0] - first_index, k, blocks);
        builder.take_over(blocks, k);
      } else {
        blocks.reserve(path.records.size() + 16);
        builder.tooth(*angles, next->angles.front(), k, tooth_rotation(k), blocks);
      }
      if (builder.error()) return builder.error();
      if (options_.pack_teeth && n > 0) op.teeth.back().pack();
      angles = std::move(next);
    }
    if (program_.loop && rolls_over(chain_) && !program_.planes) {
      loop_is_entered_ = enter_loop(op);
      stood_ = words_.joints(op.teeth.back().blocks.back()).rotary_rad;
      (*stood_)[0] += program_.index_sign * tooth_angle(tooth_of_place(teeth_ - 1, options_.tooth_stride, teeth_));
    }
    if (program_.loop)
      op.rapid_minutes +=
          tooth_angle(1) * pitches_turned(0, teeth_, options_.tooth_stride, teeth_) / chain_.table[0].max_speed;
    program_.operations.push_back(std::move(op));
    return std::nullopt;
  }

  /// A loop on a rotary that rolls over: a tooth is entered from the end of the one before, a pitch back, the first one
  /// from the end of the operation before. No way may reach half a turn: the first gets one block more, with the second
  /// there is no loop (false).
  bool enter_loop(AxisOperation& op) {
    std::vector<AxisBlock>& blocks = op.teeth.front().blocks;
    auto first = std::find_if(blocks.begin(), blocks.end(),
                              [](const AxisBlock& b) { return b.kind == BlockKind::rapid_rotary; });
    if (first == blocks.end()) return true;
    const auto entry = loop_entry(blocks, program_);
    auto turn = blocks_of_turn(chain_, words_, {words_.word_angle(entry[0]), words_.word_angle(entry[1])}, *first);
    turn.pop_back();
    for (const AxisBlock& b : turn) op.rapid_minutes += b.minutes * teeth_;
    first = blocks.insert(first, turn.begin(), turn.end());
    return !stood_ || blocks_of_turn(chain_, words_, *stood_, *first).size() == 1;
  }

  /// Blocks of tooth k where the index rotary turns the gear about its own axis: the same words, the index from
  /// integers.
  void turned_copy(const std::vector<AxisBlock>& first, double shift, int k, std::vector<AxisBlock>& blocks) const {
    const auto turn = std::llround((shift - program_.index_sign * tooth_angle(k)) / (2 * kPi));
    const int digits = options_.format.rotary_decimals;
    const std::int64_t word = numbers::ratio_to_fixed(std::int64_t{360} * k * program_.index_sign, teeth_, digits) +
                              turn * 360 * numbers::power_of_ten(digits);
    blocks = first;
    for (auto& b : blocks) b.words[3] += word;
  }

  void finish() {
    for (const auto& op : program_.operations) {
      program_.feed_minutes += op.feed_minutes;
      program_.minutes += op.feed_minutes + op.rapid_minutes;
    }
    program_.turns_in_cuts = std::any_of(program_.operations.begin(), program_.operations.end(), turns_in_cuts);
    estimate_times(program_, machine_);
  }
  static bool turns_in_cuts(const AxisOperation& op) {
    std::vector<AxisBlock> room;
    return std::any_of(op.teeth.begin(), op.teeth.end(),
                       [&](const ToothBlocks& tooth) { return turns_in_cut(tooth.all(room)); });
  }

  std::span<const path::ClPath* const> paths_;
  std::span<const tool::ToolAssembly> tools_;
  const Setup& setup_;
  const machines::Machine& machine_;
  const machines::KinematicChain& chain_;
  AxisOptions options_;
  int teeth_;
  GearPlacement gear_;
  AxisWords words_;
  ClearanceBody body_;
  AxisProgram program_;
  std::vector<FollowedPath> followed_;     // tooth 0, by path
  std::vector<FollowedPath> other_pairs_;  // tooth 0 of the path at hand on one pair of angles alone
  bool parallel_ = false, coincident_ = false, copies_ = false;
  std::optional<RotaryPair> stood_;  // the rotaries behind the operation before
  bool loop_is_entered_ = true;
  std::optional<Diagnostic> error_;
  TravelRecord placed_;
  std::optional<choice::TravelPoses> poses_;
  double lack_ = 0;  // mm: that the links of the program are short of
};

Result<AxisProgram> build_from(std::span<const path::ClPath* const> paths, std::span<const tool::ToolAssembly> tools,
                               const Setup& setup, const machines::Machine& machine, int teeth,
                               const ClearanceBody& body, const AxisOptions& options) {
  return ProgramBuilder(paths, tools, setup, machine, teeth, body, options).build();
}

}  // namespace

bool turns_in_cut(const std::vector<AxisBlock>& blocks) {
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const auto &from = blocks[i - 1].words, &to = blocks[i].words;
    if (blocks[i].kind == BlockKind::feed && (from[3] != to[3] || from[4] != to[4])) return true;
  }
  return false;
}

Result<AxisProgram> build_axis_program(std::span<const proof::CheckedClPath> paths,
                                       std::span<const tool::ToolAssembly> tools, const Setup& setup,
                                       const machines::Machine& machine, int teeth, const ClearanceBody& body,
                                       const AxisOptions& options) {
  std::vector<const path::ClPath*> list;
  for (const auto& p : paths) list.push_back(&p.path());
  return build_from(list, tools, setup, machine, teeth, body, options);
}

Result<AxisProgram> AxisProgramTestAccess::build(std::span<const path::ClPath> paths,
                                                 std::span<const tool::ToolAssembly> tools, const Setup& setup,
                                                 const machines::Machine& machine, int teeth, const ClearanceBody& body,
                                                 const AxisOptions& options) {
  std::vector<const path::ClPath*> list;
  for (const auto& p : paths) list.push_back(&p);
  return build_from(list, tools, setup, machine, teeth, body, options);
}

}  // namespace toothpath::joints
