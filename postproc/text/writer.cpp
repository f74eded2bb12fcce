#include "postproc/text/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/base/hash.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/numbers/comment.h"
#include "postproc/numbers/fixed_point.h"
#include "postproc/text/axis_words.h"
#include "postproc/text/clamps.h"
#include "postproc/text/corners.h"
#include "postproc/text/lines.h"
#include "postproc/text/planes.h"
#include "postproc/text/tool_checks.h"

namespace toothpath::text {
namespace {

constexpr int kLastProgram = 7999;  // O numbers from 8000 on are the builder's
constexpr int kFirstLabel = 100;
constexpr int kNumbersOfOperation = 1000;  // N words: of the operation, then of its teeth
constexpr int kVectorDecimals = 8;
constexpr int kBlankDecimals = 3;

class Writer {
 public:
  Writer(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header)
      : program_(program),
        dialect_(dialect),
        header_(header),
        corners_(corner_words(program, dialect, header)),
        out_(dialect),
        words_(program, dialect, out_),
        planes_(program, dialect, words_, out_),
        clamps_(program, dialect, header.wishes.stops == Stops::teeth),
        tcp_(program.tcp != machines::TcpMode::none),
        zero_moves_(program.loop && !dialect.loop.zero_on.empty() && (!tcp_ || dialect.loop.zero_with_tcp)) {}

  Result<NcText> write() {
    if (header_.coolant != machines::Coolant::off) {
      auto words = coolant_words(dialect_, header_.coolant);
      if (!words) return words.error();
      coolant_ = std::move(*words);
    }
    values_ = program_values(program_, dialect_, header_);
    values_["top"] = linear(program_.retract_z_mm);
    if (program_.loop) fill(dialect_.loop.define);
    blank();
    fill(dialect_.start);
    print(offset_check_lines(dialect_, program_.work_offset, program_.letters));
    fill(dialect_.own_start);
    for (std::size_t i = 0; i < program_.operations.size(); ++i) {
      operation(program_.operations[i], static_cast<int>(i));
      if (error_) return *error_;
      if (out_.error()) return *out_.error();
    }
    fill(dialect_.end);
    fill(dialect_.own_end);
    return assemble();
  }

 private:
  // Lines.
  void fill(const NcLinesOfText& templates) {
    for (const auto& t : templates)
      if (t == "{safe_start}") safe_start();
      else if (t == "{pick}") out_.fill(program_.tooth_stride == 1 ? NcLinesOfText{} : dialect_.loop.pick, values_);
      else if (t == "{zero_on}") move_zero(dialect_.loop.zero_on, dialect_.loop.offset_on, !tilts_);
      else if (t == "{zero_off}") move_zero(dialect_.loop.zero_off, dialect_.loop.offset_off, true);
      else if (t == "{first_tooth}") out_.comment(first_tooth_comment(program_, *now_));
      else if (t == "{corners}") corner_lines();
      else if (t == "{path_group_end}")
        out_.fill(corners_.group ? NcLinesOfText{dialect_.path_group_end} : NcLinesOfText{}, values_);
      else out_.fill({t}, values_);
  }
  /// The lines of the loop that move the zero of the index rotary, with TCP also those that write its work offset.
  void move_zero(const NcLinesOfText& zero, const NcLinesOfText& offset, bool wanted) {
    if (zero_moves_ && wanted) out_.fill(zero, values_);
    if (zero_moves_ && wanted && tcp_) out_.fill(offset, values_);
  }
  /// Without a loop: the zero of the index rotary by the lines of the loop.
  void count_from(const std::optional<double>& deg) {
    if (deg == counts_from_) return;
    counts_from_ = deg;
    if (deg) {
      const int decimals = program_.format.rotary_decimals;
      out_.line(fmt::format("{}={}", dialect_.loop.index, out_.value(numbers::to_fixed(*deg, decimals), decimals)));
      out_.fill(dialect_.loop.zero_on, values_);
    } else {
      out_.fill(dialect_.loop.zero_off, values_);
    }
    zero_moves_ = deg.has_value();
    forget();
  }
  void safe_start() {
    out_.fill(dialect_.safe_start, values_);
    if (!program_.planes) return;
    for (const auto& line : dialect_.planes.off)
      if (std::none_of(dialect_.safe_start.begin(), dialect_.safe_start.end(),
                       [&](const std::string& all) { return all.find(line) != std::string::npos; }))
        out_.fill({line}, values_);
  }
  /// How far the control may leave corners: as it stands, or behind the axes of the path.
  void corner_lines() {
    wide_in_force_ = corners_.wide;
    if (corners_.contour) return;
    if (corners_.group) out_.fill({dialect_.path_group}, values_);
    for (std::size_t a = 3; a < 5 && corners_.group; ++a)
      if (program_.letters[a] != 0) {
        values_["axis"] = program_.letters[a];
        out_.fill({dialect_.path_radius}, values_);
      }
    out_.fill(dialect_.corners, values_);
  }
  /// The blank of the graphics.
  void blank() {
    if (dialect_.blank.empty() || !header_.blank) return;
    const joints::GraphicsBlank& b = *header_.blank;
    const auto scaled = [](double mm) { return numbers::to_fixed(mm, kBlankDecimals); };
    const auto size = [&](const char* name, std::int64_t v) {
      values_[name].clear();
      numbers::append_fixed(values_[name], v, kBlankDecimals, dialect_.point_always);
    };
    const std::int64_t top = scaled(b.top_mm), bottom = scaled(b.bottom_mm);
    values_["blank_top"] = out_.value(top, kBlankDecimals);
    values_["blank_bottom"] = out_.value(bottom, kBlankDecimals);
    size("blank_length", top - bottom);
    size("blank_radius", scaled(b.radius_mm));
    size("blank_diameter", 2 * scaled(b.radius_mm));
    size("bore_radius", scaled(b.bore_mm));
    size("bore_diameter", 2 * scaled(b.bore_mm));
    fill(b.bore_mm > 0 ? dialect_.blank_ring : dialect_.blank);
  }
  std::string linear(double mm) const {
    return out_.value(numbers::to_fixed(mm, program_.format.linear_decimals), program_.format.linear_decimals);
  }
  void print(const std::vector<std::string>& lines) {
    for (const auto& line : lines) out_.line(line);
  }
  void forget() {
    words_.forget();
    motion_ = -1;
    feed_ = -1;
  }

  void machine_retract() {
    fill(dialect_.retract);
    forget();
  }

  // Places where the operator stops or begins again.
  void stop() { out_.line(header_.wishes.stop_word == StopWord::optional_stop ? "M1" : "/M0"); }
  /// The same of a program that begins in the middle. @param place of the order; -1: the operation begins
  void number_here(const joints::AxisOperation& op, int place) {
    if (header_.wishes.restart_numbers && !dialect_.block_numbers && place + 1 < kNumbersOfOperation)
      out_.number_next(kNumbersOfOperation * (op.operation + 1) + place + 1);
  }
  /// Lines of the shop behind a tooth, and a stop; what the stop may have ended is switched on again.
  void behind_tooth() {
    clamps_.leave();
    fill(dialect_.own_between_teeth);
    if (header_.wishes.stops != Stops::teeth) return;
    stop();
    fill(dialect_.spindle_on);
    if (coolant_) out_.line(coolant_->on);
  }

  /// The tool, if it is another than before, and the one that follows it.
  void tool_call(const joints::AxisOperation& op, int position) {
    const auto at = static_cast<std::size_t>(position);
    const auto& all = program_.operations;
    const bool changes = at == 0 || all[at - 1].tool_number != op.tool_number;
    const bool begins = at == 0 || all[at - 1].operation != op.operation;
    const Stops stops = header_.wishes.stops;
    if (at > 0 && ((stops == Stops::operations && begins) || (stops == Stops::tool_changes && changes))) stop();
    fill(changes ? dialect_.tool_call : dialect_.tool_keep);
    if (op.check_ahead) {
      if (changes) machine_retract();
      check_tool(op, 2 * position);
      fill(dialect_.tool_recall);
    }
    fill(dialect_.tool_change);
    if (changes && header_.wishes.stop_at_first_cut) {
      stop();
      fill(dialect_.spindle_on);  // what the stop may have ended
    }
    const auto next = std::find_if(all.begin() + position, all.end(),
                                   [&](const auto& other) { return other.tool_number != op.tool_number; });
    if (!changes || next == all.end()) return;
    values_["next"] = std::to_string(next->tool_number);
    fill(dialect_.tool_next);
  }

  /// With Z at its top. The lines may leave all modes and the tool as they like: every mode is said again, then Z.
  void check_tool(const joints::AxisOperation& op, int check) {
    out_.comment(check_comment(op));
    out_.fill(dialect_.tool_check->lines,
              check_values(values_, op, dialect_, kFirstLabel + 2 * operations() + 2 * check));
    fill(dialect_.start);
    machine_retract();
  }

  void set_values(const joints::AxisOperation& op, int position) {
    values_["tool"] = std::to_string(op.tool_number);
    values_["speed"] = std::to_string(std::llround(op.spindle_rpm));
    values_["label"] = std::to_string(kFirstLabel + 2 * body_of(position));
    values_["label+1"] = std::to_string(kFirstLabel + 2 * position + 1);
    values_["first"] = std::to_string(op.first_place);
    values_["end"] = std::to_string(op.end_of(program_.teeth));
    values_["last"] = std::to_string(op.end_of(program_.teeth) - 1);
    now_ = &op;
    corners_ = corner_words(program_, dialect_, header_, &op);
    set_corner_values(values_, corners_, program_, dialect_);
    values_["work_top"] = linear(program_.retract_z_mm - op.tool_length_mm - program_.work_offset_at_mm.z());
    values_["operation"] = std::to_string(op.operation);
    values_["operation_type"] = numbers::comment_text(op.type);
    values_["program"] = std::to_string(header_.program_number + bodies(body_of(position) + 1));
  }

  void operation(const joints::AxisOperation& op, int position) {
    set_values(op, position);
    out_.comment(
        fmt::format("OP {} {}", op.operation, op.type));  // as in the job, in every dialect: programs look for it
    out_.comment(
        numbers::comment_text(fmt::format("T{} {} LENGTH {} MM TO THE TIP{}", op.tool_number, op.tool_name,
                                          out_.value(numbers::to_fixed(op.tool_length_mm, 4), 4),
                                          op.sister_of == 0 ? "" : fmt::format(", SISTER OF T{}", op.sister_of))));
    for (const std::string& name : op.shop_names)
      out_.comment(numbers::comment_text(fmt::format("T{} {}", op.tool_number, name)));
    out_.fill(dialect_.message, values_);
    const NcLoop& loop = dialect_.loop;
    std::vector<joints::AxisBlock> room;
    tilts_ = planes_.any(op.teeth.front().all(room));
    if (program_.loop && loop.form == NcLoop::Form::sub_program && body_of(position) == position) loop_body(op);
    const auto at = static_cast<std::size_t>(position);
    if (at == 0 || program_.operations[at - 1].operation != op.operation) number_here(op, -1);
    machine_retract();
    tool_call(op, position);
    fill(tcp_ ? dialect_.tcp_compensation : dialect_.compensation);
    forget();
    if (coolant_) out_.line(coolant_->on);
    print(dialect_.smoothing_on);
    if (corners_.contour) out_.fill(dialect_.contour_on, values_);
    else if (corners_.wide || wide_in_force_) corner_lines();
    print(clamps_.opening());
    if (!program_.loop) {
      int place = op.first_place;
      for (const auto& tooth : op.teeth) {
        number_here(op, place++);
        const std::vector<joints::AxisBlock>& list = tooth.all(room);
        out_.comment(tooth.remark.empty() ? fmt::format("TOOTH {}", tooth.tooth) : numbers::comment_text(tooth.remark));
        forget();
        clamps_.enter(list, false);
        count_from(tooth.zero_deg);
        blocks(list, IndexWord::literal);
        if (tooth.pause) {
          fill(dialect_.pause);
          clamps_.stopped();
        }
        behind_tooth();
      }
      count_from({});
    } else if (loop.form == NcLoop::Form::called) {
      calls(op);
    } else if (loop.form == NcLoop::Form::sub_program) {
      fill(loop.call);
    } else {
      loop_body(op);
    }
    print(dialect_.smoothing_off);
    if (tilts_) fill(dialect_.planes.off);
    if (corners_.contour) out_.fill(dialect_.contour_off, values_);
    fill(dialect_.operation_end);
    if (coolant_) out_.line(coolant_->off);
    fill(dialect_.spindle_off);
    machine_retract();
    if (op.check_behind) check_tool(op, 2 * position + 1);
  }

  /// One tooth, its index angle given by the control's arithmetic.
  void loop_body(const joints::AxisOperation& op) {
    fill(dialect_.loop.before);
    tooth_of_loop(op);
    behind_tooth();
    fill(dialect_.loop.after);
  }
  void tooth_of_loop(const joints::AxisOperation& op) {
    forget();
    const auto& tooth = op.teeth.front().blocks;
    words_.enter_loop(tooth);
    clamps_.enter(tooth, true);
    blocks(tooth, zero_moves_ ? IndexWord::literal : IndexWord::shifted);
  }

  // One tooth stands behind the main program and is called for each.
  void calls(const joints::AxisOperation& op) {
    const int count = bodies(operations()), last = header_.program_number + count;
    const bool numbered = dialect_.loop.call.front().find("{program}") != std::string::npos;
    if (numbered && last > kLastProgram) {
      error_ = fail(
          "program O{} has sub-programs up to O{}, above O{}: from there on numbers are the builder's; a "
          "number at most {} leaves room",
          header_.program_number, last, kLastProgram, kLastProgram - count);
      return;
    }
    for (int n = op.first_place; n < op.end_of(program_.teeth); ++n) {
      const int k = joints::tooth_of_place(n, program_.tooth_stride, program_.teeth);
      out_.comment(fmt::format("AT TOOTH {}", k));
      number_here(op, n);
      values_["angle"] = out_.value(numbers::ratio_to_fixed(std::int64_t{360} * k * program_.index_sign, program_.teeth,
                                                            program_.format.rotary_decimals),
                                    program_.format.rotary_decimals);
      fill(dialect_.loop.zero_on);
      fill(dialect_.loop.call);
      behind_tooth();
    }
    fill(dialect_.loop.zero_off);
    forget();
  }
  /// Where the sub-program of an operation comes from: a sister that goes on with it calls the one that is there,
  /// unless that names its tool.
  [[nodiscard]] int body_of(int position) const {
    const NcLoop::Form form = dialect_.loop.form;
    const bool apart = form == NcLoop::Form::sub_program || form == NcLoop::Form::called;
    const auto& all = program_.operations;
    const auto& op = all[static_cast<std::size_t>(position)];
    const auto shares = [&](const joints::AxisOperation& other) {
      return other.operation == op.operation && (!tcp_ || other.tool_number == op.tool_number);
    };
    int first = position;
    while (apart && first > 0 && shares(all[static_cast<std::size_t>(first) - 1])) --first;
    return first;
  }
  /// Sub-programs of the operations ahead of `end`. Their numbers stand behind that of the main program, so that those
  /// of another job are not called.
  [[nodiscard]] int bodies(int end) const {
    int count = 0;
    for (int i = 0; i < end; ++i) count += body_of(i) == i ? 1 : 0;
    return count;
  }
  [[nodiscard]] int operations() const { return static_cast<int>(program_.operations.size()); }
  [[nodiscard]] bool has_subprograms() const { return program_.loop && dialect_.loop.form == NcLoop::Form::called; }
  void write_subprograms() {
    if (!has_subprograms()) return;
    for (int i = 0; i < operations() && !error_; ++i) {
      if (body_of(i) != i) continue;
      const joints::AxisOperation& op = program_.operations[static_cast<std::size_t>(i)];
      set_values(op, i);
      fill(dialect_.loop.before);
      tooth_of_loop(op);
      fill(dialect_.loop.after);
    }
  }

  // Blocks of one tooth; begins and ends in G94. Inverse time where a rotary turns in a cut; else F is that of the tip.
  void blocks(const std::vector<joints::AxisBlock>& list, IndexWord index) {
    inverse_time_ = false;
    cuts_turn_ = joints::turns_in_cut(list);
    for (std::size_t i = 0; i < list.size() && !error_; ++i) {
      const joints::AxisBlock& b = list[i];
      if (i > 0 && !program_.planes) note_unwinding(list[i - 1], b);
      print(clamps_.ahead(list, i));
      switch (b.kind) {
        case joints::BlockKind::feed:
        case joints::BlockKind::turn:
          if (b.tip) tip_feed(b, index);
          else joint_feed(b, index);
          break;
        case joints::BlockKind::tcp_on:
        case joints::BlockKind::tcp_off: switch_tcp(b); break;
        default: rapid(b, index); break;
      }
      print(clamps_.behind(list, i));
    }
    if (inverse_time_) out_.line(fmt::format("G94 F{}", values_["free"]));
    inverse_time_ = false;
  }

  /// A reposition of a rotary by a whole turn or more is said in the text.
  void note_unwinding(const joints::AxisBlock& from, const joints::AxisBlock& to) {
    if (to.kind != joints::BlockKind::rapid_rotary && to.kind != joints::BlockKind::turn) return;
    for (std::size_t a = 3; a < 5; ++a)
      if (const auto turns = std::abs(to.words[a] - from.words[a]) / words_.turn_word(); turns >= 1)
        out_.comment(fmt::format("{} UNWINDS BY {} TURN{}", program_.letters[a], turns, turns == 1 ? "" : "S"));
  }

  void switch_tcp(const joints::AxisBlock& b) {
    if (inverse_time_) out_.line(fmt::format("G94 F{}", values_["free"]));
    inverse_time_ = false;
    values_["z"] = out_.value(b.words[2], words_.decimals(2));
    const bool on = b.kind == joints::BlockKind::tcp_on;
    const bool turned = program_.loop && dialect_.loop.form != NcLoop::Form::called;
    if (!on && turned) fill(dialect_.loop.frame_off);
    fill(on ? dialect_.tcp_on : dialect_.tcp_off);
    if (on && turned) fill(dialect_.loop.frame_on);
    forget();
  }

  void motion(const std::string& word, int code) {
    if (motion_ != code || !dialect_.motion_is_modal) out_.text() += word;
    motion_ = code;
  }

  void rapid(const joints::AxisBlock& b, IndexWord index) {
    const auto [from, to] = b.kind == joints::BlockKind::rapid_z     ? std::pair<std::size_t, std::size_t>{2, 3}
                            : b.kind == joints::BlockKind::rapid_xy  ? std::pair<std::size_t, std::size_t>{0, 2}
                            : b.kind == joints::BlockKind::rapid_tip ? std::pair<std::size_t, std::size_t>{0, 3}
                                                                     : std::pair<std::size_t, std::size_t>{3, 5};
    if (to == 5 && tilts_ && turn_to_plane(b, index)) return;
    const std::size_t begin = out_.size();
    out_.text() += dialect_.rapid;
    motion_ = 0;
    const std::size_t without_words = out_.size();
    for (std::size_t a = from; a < to; ++a) words_.print(b, a, index);
    if (out_.size() == without_words) {
      out_.text().resize(begin);
      return;
    }
    out_.text() += dialect_.rapid_end;
    out_.end_line(begin, true);
  }

  /// The rotaries turn by a tilted plane; where the block has none the one before ends.
  bool turn_to_plane(const joints::AxisBlock& b, IndexWord index) {
    if (planes_.tilted(b)) {
      if (zero_moves_) fill(dialect_.loop.zero_off);  // the plane has the turn of the index itself
      planes_.on(b, program_.loop ? IndexWord::shifted : index, values_);
    } else {
      fill(dialect_.planes.off);
      if (zero_moves_) fill(dialect_.loop.zero_on);
    }
    forget();
    if (!planes_.tilted(b)) return false;
    words_.turn_by_plane(b);
    return true;
  }

  void joint_feed(const joints::AxisBlock& b, IndexWord index) {
    const double rate = 1 / b.minutes;
    if (!(b.minutes > 0) || (dialect_.inverse_time && cuts_turn_ && dialect_.max_inverse_time > 0 &&
                             rate > dialect_.max_inverse_time * (1 + 1e-9))) {
      error_ = fail("record {}: F {:.3f} of a block exceeds {:.3f}, the greatest that {} takes", b.record, rate,
                    dialect_.max_inverse_time, dialect_.name);
      return;
    }
    const bool turns = words_.turns(b);
    if (!dialect_.inverse_time && turns) {
      error_ = fail(
          "record {}: rotaries move in a cutting block, and {} has no inverse time feed for it: tcp = \"angles\" is "
          "supported, or a tilt that is fixed in every pass",
          b.record, dialect_.name);
      return;
    }
    const double length = words_.length(b);
    const bool exact =
        dialect_.inverse_time && dialect_.min_feed_product > 0 && rate * length < dialect_.min_feed_product;
    const bool modal = !dialect_.inverse_time || program_.planes || !cuts_turn_;
    const bool per_minute = exact || modal;
    if (!per_minute && !inverse_time_) out_.line("G93");
    if (per_minute && inverse_time_) out_.line("G94");
    inverse_time_ = !per_minute;
    const std::size_t begin = out_.size();
    motion(dialect_.feed, 1);
    for (std::size_t a = 0; a < 5; ++a) words_.print(b, a, index);
    if (!modal)
      feed_number(per_minute ? length / b.minutes : rate,
                  dialect_.point_always ? 3
                  : per_minute          ? 9
                  : rate < 10           ? 6
                                        : 3,
                  b.record, begin);
    else modal_feed(length / b.minutes, b.record, begin);
    finish_block(begin);
  }

  /// With TCP: feed of the tip, or of the rotaries where nothing linear moves.
  void tip_feed(const joints::AxisBlock& b, IndexWord index) {
    const std::size_t begin = out_.size();
    const bool vectors = program_.tcp == machines::TcpMode::vectors && b.kind == joints::BlockKind::feed;
    if (vectors && !dialect_.vector_feed.empty()) motion(dialect_.vector_feed, 1);
    else motion(dialect_.feed, 1);
    for (std::size_t a = b.kind == joints::BlockKind::turn ? 3 : 0; a < (vectors ? 3U : 5U); ++a)
      words_.print(b, a, index);
    if (vectors) vector(b);
    words_.stand(b);
    modal_feed(b.per_minute, b.record, begin);
    finish_block(begin);
  }

  void vector(const joints::AxisBlock& b) {
    const Vec3& axis = b.axis;
    for (int i = 0; i < 3; ++i) {
      out_.text() += ' ';
      out_.text() += dialect_.vector_words[static_cast<std::size_t>(i)];
      out_.number(numbers::to_fixed(axis[i], kVectorDecimals), kVectorDecimals);
    }
  }

  void finish_block(std::size_t begin) {
    std::string& text = out_.text();
    if (text.size() > begin && text[begin] == ' ') text.erase(begin, 1);
    out_.end_line(begin, true);
  }

  /// F on change. Rounded down but for round-off, never 0.
  void modal_feed(double f, std::int32_t record, std::size_t begin) {
    const int digits = dialect_.point_always || f >= 10 ? 3 : 6;
    const double kept = f * (1 + 1e-12);
    const std::int64_t scaled = kept < 9e9 ? numbers::to_fixed_down(kept, digits) : 0;
    const std::int64_t common = scaled * numbers::power_of_ten(6 - digits);
    if (common == feed_ && scaled > 0) return;
    feed_number(kept, digits, record, begin);
    feed_ = common;
  }

  /// Rounded down, never 0.
  void feed_number(double f, int digits, std::int32_t record, std::size_t begin) {
    out_.text() += out_.size() == begin ? "F" : " F";
    const std::int64_t scaled = f < 9e5 * 1e4 ? numbers::to_fixed_down(f, digits) : 0;
    if (scaled <= 0 && !error_)
      error_ = fail(
          "record {}: F {} cannot be printed with {} decimals: the operation's feed, max_speed or max_acceleration of "
          "an axis is out of proportion",
          record, f, digits);
    numbers::append_fixed(out_.text(), scaled, digits, dialect_.point_always);
  }

  Result<NcText> assemble() {
    fill(dialect_.body_end);
    write_subprograms();
    if (error_) return *error_;
    if (out_.error()) return *out_.error();
    NcText result;
    result.body_hash = fnv1a(out_.text());
    result.blocks = out_.blocks();
    result.numbers = 1 + (has_subprograms() ? bodies(operations()) : 0);
    for (const auto& l : dialect_.frame_end) result.blocks += l == "%" ? 0 : 1;
    const std::string hash = fmt::format("HASH {:016X} BLOCKS {}", result.body_hash, result.blocks);
    std::string body;  // of a long program there is one copy
    body.swap(out_.text());
    fill(dialect_.frame_begin);
    for (const auto& line : header_comments(program_, dialect_, header_, hash)) out_.comment(line);
    body.insert(0, out_.text());
    out_.text() = std::move(body);
    out_.comment(hash);
    fill(dialect_.frame_end);
    if (out_.error()) return *out_.error();
    result.text = dialect_.block_numbers ? NcLines::numbered(out_.text()) : std::move(out_.text());
    return result;
  }

  const joints::AxisProgram& program_;
  const NcDialect& dialect_;
  const NcHeader& header_;
  CornerWords corners_;
  NcLines out_;
  NcAxisWords words_;
  NcPlaneWords planes_;
  NcClamps clamps_;
  NcLines::Values values_;
  bool tcp_;
  bool zero_moves_;                    // the index moves the zero of its rotary
  std::optional<double> counts_from_;  // without a loop: where its words count from, deg
  std::optional<machines::CoolantWords> coolant_;
  std::optional<Diagnostic> error_;
  const joints::AxisOperation* now_ = nullptr;
  int motion_ = -1;         // 0, 1; -1: to be printed
  std::int64_t feed_ = -1;  // F per minute in force, millionths; -1: to be printed
  bool cuts_turn_ = false;  // some feed of the tooth at hand turns a rotary
  bool inverse_time_ = false, wide_in_force_ = false;
  bool tilts_ = false;  // some blocks of the operation stand in a tilted plane
};

}  // namespace

Result<NcText> write_nc(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  if (program.format.linear_decimals != dialect.format.linear_decimals ||
      program.format.rotary_decimals != dialect.format.rotary_decimals)
    return fail("the axis program has {} and {} decimals, the dialect {} and {}", program.format.linear_decimals,
                program.format.rotary_decimals, dialect.format.linear_decimals, dialect.format.rotary_decimals);
  if (program.turns_in_cuts && !dialect.smoothing_on.empty() && !dialect.smoothing_axis_rad)
    return fail(
        "cuts turn a rotary axis: post.smoothing_on needs post.smoothing_axis_tolerance beside "
        "post.smoothing_tolerance");
  if (program.planes && dialect.planes.on.empty())
    return fail("{} has no words for tilted planes: the rotaries turn by words of their own", dialect.name);
  if (program.loop && dialect.write == nullptr && dialect.loop.form == NcLoop::Form::none)
    return fail("{} has no loop for the teeth: they must be written out", dialect.name);
  if (dialect.write != nullptr) return dialect.write(program, dialect, header);
  return Writer(program, dialect, header).write();
}

}  // namespace toothpath::text
