#include "postproc/nc_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "postproc/fixed_point.h"

namespace toothpath {
namespace {

constexpr int kFirstSubprogram = 2001;  // Fanuc O numbers of the sub-programs; LinuxCNC o-words count from 100
constexpr int kFirstOWord = 100;
constexpr double kFreeFeed = 1000;      // F that goes with G94 where nothing is cut, mm/min

std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t h = 14695981039346656037ULL;
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

/// How the word of the index rotary is printed.
enum class IndexWord { literal, parameter, left_out };

/// Blocks [first, last) of one tooth.
struct Segment {
  std::size_t first = 0, last = 0;
};

class Writer {
 public:
  Writer(const AxisProgram& program, const NcDialect& dialect, const NcHeader& header)
      : program_(program), dialect_(dialect), header_(header) {}

  Result<NcText> write() {
    safe_start();
    for (std::size_t i = 0; i < program_.operations.size(); ++i) {
      operation(program_.operations[i], static_cast<int>(i));
      if (error_) return *error_;
    }
    program_end();
    return assemble();
  }

 private:
  // Lines.
  void line(std::string_view text) {
    body_ += text;
    end_line(body_.size() - text.size(), true);
  }
  void comment(std::string_view text) {
    const std::size_t begin = body_.size();
    body_ += '(';
    body_ += text.substr(0, dialect_.max_line - 2);
    body_ += ')';
    end_line(begin, false);
  }
  void end_line(std::size_t begin, bool block) {
    if (body_.size() - begin > dialect_.max_line && !error_)
      error_ = fail("block of {} characters exceeds {}, the longest line of {}", body_.size() - begin, dialect_.max_line,
                    dialect_.name);
    body_ += '\n';
    if (block) ++blocks_;
  }
  void number(std::int64_t scaled, int decimals) { append_fixed(body_, scaled, decimals, dialect_.point_always); }
  std::string value(std::int64_t scaled, int decimals) const {
    std::string s;
    append_fixed(s, scaled, decimals, dialect_.point_always);
    return s;
  }
  int decimals(std::size_t axis) const {
    return axis < 3 ? program_.format.linear_decimals : program_.format.rotary_decimals;
  }
  std::string free_feed() const { return fmt::format("G94 F{}", value(to_fixed(kFreeFeed, 0), 0)); }
  std::string retract() const {
    const int digits = program_.format.linear_decimals;
    return fmt::format("Z{}", value(to_fixed(program_.retract_z_mm, digits), digits));
  }

  void forget() {
    known_.fill(false);
    motion_ = -1;
  }

  void safe_start() {
    for (const auto& text : dialect_.safe_start) line(text);
    line(program_.work_offset);
    if (dialect_.blend) line(fmt::format("G64 P{} Q0", value(to_fixed(header_.blend_mm, 6), 6)));
  }

  void machine_retract() {
    line(fmt::format("{} {}", dialect_.compensation_with_z ? "G0 G49 G53" : "G53 G0", retract()));
    forget();
  }

  void operation(const AxisOperation& op, int position) {
    comment(fmt::format("OP {} {}", op.operation, op.type));  // as in the job, in every dialect: programs look for it
    comment(comment_text(fmt::format("T{} {} LENGTH {} MM TO THE TIP", op.tool_number, op.tool_name,
                                     value(to_fixed(op.tool_length_mm, 4), 4))));
    if (program_.loop && dialect_.o_words) o_subprogram(op, position);
    machine_retract();
    line(fmt::format("T{} M6", op.tool_number));
    for (const auto& text : dialect_.safe_start) line(text);
    line(program_.work_offset);
    line(fmt::format("S{} M3", std::llround(op.spindle_rpm)));
    compensation(op);
    if (header_.coolant) line("M8");
    if (program_.loop && dialect_.o_words) {
      o_loop(position);
    } else if (program_.loop) {
      m98_calls(op);
    } else {
      for (const auto& tooth : op.teeth) {
        comment(fmt::format("TOOTH {}", tooth.tooth));
        forget();
        blocks(tooth.blocks, {0, tooth.blocks.size()}, IndexWord::literal);
      }
    }
    line(free_feed());
    if (header_.coolant) line("M9");
    line("M5");
    machine_retract();
  }

  void compensation(const AxisOperation& op) {
    if (!dialect_.compensation_with_z) return line(fmt::format("G43 H{}", op.tool_number));
    const double z = program_.retract_z_mm - op.tool_length_mm - program_.work_offset_at_mm.z();
    line(fmt::format("G0 G43 H{} Z{}", op.tool_number,
                     value(to_fixed(z, program_.format.linear_decimals), program_.format.linear_decimals)));
    forget();
  }

  // LinuxCNC: one sub-program an operation, the angle of the tooth is its argument.
  void o_subprogram(const AxisOperation& op, int position) {
    const int o = kFirstOWord + 2 * position;
    line(fmt::format("o{} sub", o));
    forget();
    const auto& tooth = op.teeth.front().blocks;
    blocks(tooth, {0, tooth.size()}, IndexWord::parameter);
    line(fmt::format("o{} endsub", o));
  }
  void o_loop(int position) {
    const int o = kFirstOWord + 2 * position;
    line("#1=0");
    line(fmt::format("o{} while [#1 LT {}]", o + 1, program_.teeth));
    line(fmt::format("o{} call [{}#1*360/{}]", o, program_.index_sign < 0 ? "0-" : "", program_.teeth));
    line("#1=[#1+1]");
    line(fmt::format("o{} endwhile", o + 1));
  }

  // Fanuc: a sub-program for every stretch with one index angle, called after an explicit rotary block.
  void m98_calls(const AxisOperation& op) {
    const auto& tooth = op.teeth.front().blocks;
    const auto segments = split_at_rotaries(tooth);
    if (!segments) return;
    const int first = kFirstSubprogram + static_cast<int>(subprograms_.size());
    for (const auto& s : *segments) subprograms_.push_back({&op, s});
    const auto index = static_cast<std::size_t>(program_.index_axis);
    for (int k = 0; k < program_.teeth; ++k) {
      for (std::size_t i = 0; i < segments->size(); ++i) {
        AxisBlock turn = tooth[(*segments)[i].first];
        turn.words[index] += ratio_to_fixed(std::int64_t{360} * k * program_.index_sign, program_.teeth,
                                            program_.format.rotary_decimals);
        turn.forced = true;
        forget();
        rapid(turn, IndexWord::literal);
        line(fmt::format("M98 P{}", first + static_cast<int>(i)));
      }
    }
    forget();
  }
  std::optional<std::vector<Segment>> split_at_rotaries(const std::vector<AxisBlock>& tooth) {
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < tooth.size(); ++i) {
      if (tooth[i].kind == BlockKind::rapid_rotary) segments.push_back({i, i});
      const bool moved = !segments.empty() && tooth[i].words[static_cast<std::size_t>(program_.index_axis)] !=
                                                  tooth[segments.back().first].words[static_cast<std::size_t>(program_.index_axis)];
      if (segments.empty() || moved) {
        error_ = fail("the index rotary moves inside a tooth: {} cannot loop over it, write the teeth out", dialect_.name);
        return std::nullopt;
      }
      segments.back().last = i + 1;
    }
    return segments;
  }
  void write_subprograms() {
    for (std::size_t i = 0; i < subprograms_.size() && !error_; ++i) {
      const auto& [op, s] = subprograms_[i];
      line(fmt::format("O{} (OPERATION {} PART {})", kFirstSubprogram + static_cast<int>(i), op->operation, i));
      forget();
      blocks(op->teeth.front().blocks, {s.first + 1, s.last}, IndexWord::left_out);
      line("M99");
    }
  }

  // Blocks of one stretch; begins and ends in G94.
  void blocks(const std::vector<AxisBlock>& list, Segment s, IndexWord index) {
    inverse_time_ = false;
    for (std::size_t i = s.first; i < s.last && !error_; ++i) {
      if (list[i].kind == BlockKind::feed)
        feed(list[i], index);
      else
        rapid(list[i], index);
    }
    if (inverse_time_) line(free_feed());
    inverse_time_ = false;
  }

  void rapid(const AxisBlock& b, IndexWord index) {
    const std::size_t begin = body_.size();
    body_ += "G0";
    motion_ = 0;
    const std::size_t without_words = body_.size();
    const auto [from, to] = b.kind == BlockKind::rapid_z    ? std::pair<std::size_t, std::size_t>{2, 3}
                            : b.kind == BlockKind::rapid_xy ? std::pair<std::size_t, std::size_t>{0, 2}
                                                            : std::pair<std::size_t, std::size_t>{3, 5};
    for (std::size_t a = from; a < to; ++a) word(b, a, index);
    if (body_.size() == without_words) {
      body_.resize(begin);
      return;
    }
    end_line(begin, true);
  }

  void word(const AxisBlock& b, std::size_t axis, IndexWord index) {
    if (program_.letters[axis] == 0) return;
    const bool is_index = static_cast<int>(axis) == program_.index_axis;
    if (is_index && index == IndexWord::left_out) return;
    const bool unchanged = known_[axis] && last_[axis] == b.words[axis];
    known_[axis] = true;
    last_[axis] = b.words[axis];
    if (unchanged && !b.forced) return;
    body_ += ' ';
    body_ += program_.letters[axis];
    if (is_index && index == IndexWord::parameter) {
      body_ += "[#1";
      if (b.words[axis] >= 0) body_ += '+';
      number(b.words[axis], decimals(axis));
      body_ += ']';
    } else {
      number(b.words[axis], decimals(axis));
    }
  }

  /// Length that the control takes for a feed block: X Y Z if any of them moves, else the rotaries [mm or deg].
  double control_length(const AxisBlock& b) const {
    const auto part = [&](std::size_t from, std::size_t to) {
      double sum = 0;
      for (std::size_t a = from; a < to; ++a) {
        const double d = static_cast<double>(b.words[a] - last_[a]) / static_cast<double>(power_of_ten(decimals(a)));
        sum += d * d;
      }
      return std::sqrt(sum);
    };
    const double linear = part(0, 3);
    return linear > 0 ? linear : part(3, 5);
  }

  void feed(const AxisBlock& b, IndexWord index) {
    const double rate = 1 / b.minutes;
    if (!(b.minutes > 0) || (dialect_.max_inverse_time > 0 && rate > dialect_.max_inverse_time * (1 + 1e-9))) {
      error_ = fail("record {}: F {:.3f} of a block exceeds {:.3f}, the greatest that {} takes", b.record, rate,
                    dialect_.max_inverse_time, dialect_.name);
      return;
    }
    const double length = control_length(b);
    const bool per_minute = dialect_.min_feed_product > 0 && rate * length < dialect_.min_feed_product;
    if (!per_minute && !inverse_time_) line("G93");
    if (per_minute && inverse_time_) line("G94");
    inverse_time_ = !per_minute;
    const std::size_t begin = body_.size();
    if (motion_ != 1) body_ += "G1";
    motion_ = 1;
    for (std::size_t a = 0; a < 5; ++a) word(b, a, index);
    body_ += body_.size() == begin ? "F" : " F";
    feed_number(per_minute ? length / b.minutes : rate, per_minute, b.record);
    if (body_[begin] == ' ') body_.erase(begin, 1);
    end_line(begin, true);
  }

  /// Rounded down, never 0.
  void feed_number(double f, bool per_minute, std::int32_t record) {
    const int digits = dialect_.point_always ? 3 : per_minute ? 9 : f < 10 ? 6 : 3;
    const std::int64_t scaled = f < 9e5 * 1e4 ? to_fixed_down(f, digits) : 0;
    if (scaled <= 0 && !error_) error_ = fail("record {}: F {} cannot be printed with {} decimals", record, f, digits);
    number(scaled, digits);
  }

  void program_end() {
    if (dialect_.blend) line("G61");
    if (!dialect_.compensation_with_z) line("G49");
  }

  Result<NcText> assemble() {
    if (dialect_.percent_frame) {
      line(dialect_.program_end);
      write_subprograms();
    }
    if (error_) return *error_;
    NcText result;
    result.body_hash = fnv1a(body_);
    result.blocks = blocks_ + (dialect_.percent_frame ? 0 : 1);
    const std::string hash = fmt::format("HASH {:016X} BLOCKS {}", result.body_hash, result.blocks);
    std::string body = std::move(body_);
    body_.clear();
    if (dialect_.percent_frame) {
      body_ += "%\n";
      body_ += fmt::format("O{} ({})\n", header_.program_number, comment_text(header_.job_name).substr(0, 32));
    }
    header_comments(hash);
    result.text = std::move(body_);
    result.text.reserve(result.text.size() + body.size() + 100);
    result.text += body;
    result.text += fmt::format("({})\n", hash);
    result.text += dialect_.percent_frame ? "%" : dialect_.program_end;
    result.text += '\n';
    return result;
  }

  void header_comments(const std::string& hash) {
    comment(comment_text("JOB " + header_.job_name));
    if (!header_.job_hash.empty()) comment(comment_text("JOB FILE " + header_.job_hash));
    comment(comment_text("MACHINE " + header_.machine_name));
    comment(hash);
    comment("TOOL LENGTHS RUN FROM THE GAUGE LINE TO THE TIP");
    const auto at = [&](int i) { return value(to_fixed(program_.work_offset_at_mm[i], 4), 4); };
    comment(fmt::format("WORK OFFSET {} AT X{} Y{} Z{} MM MACHINE", program_.work_offset, at(0), at(1), at(2)));
    if (!header_.assumed.empty()) comment("WARNING, ASSUMED AND NOT MEASURED:");
    for (const auto& a : header_.assumed) comment(comment_text("ASSUMED " + a));
  }

  const AxisProgram& program_;
  const NcDialect& dialect_;
  const NcHeader& header_;
  std::string body_;
  std::size_t blocks_ = 0;
  std::optional<Diagnostic> error_;
  std::array<std::int64_t, 5> last_{};
  std::array<bool, 5> known_{};
  int motion_ = -1;  // 0, 1; -1: to be printed
  bool inverse_time_ = false;
  std::vector<std::pair<const AxisOperation*, Segment>> subprograms_;
};

}  // namespace

Result<NcDialect> find_dialect(std::string_view name) {
  for (auto make : {linuxcnc_dialect, fanuc_dialect}) {
    NcDialect d = make();
    if (d.name == name) return d;
  }
  return fail("dialect = \"{}\" is not one of \"linuxcnc\", \"fanuc\"", name);
}

Result<NcDialect> dialect_of(const Machine& machine) {
  auto d = find_dialect(machine.dialect);
  if (!d) return d;
  d->format.linear_decimals = machine.post.linear_decimals.value_or(d->format.linear_decimals);
  d->format.rotary_decimals = machine.post.rotary_decimals.value_or(d->format.rotary_decimals);
  for (const int digits : {d->format.linear_decimals, d->format.rotary_decimals})
    if (digits < 1 || digits > 7) return fail("{} decimals in a word of the machine: 1 to 7 are possible", digits);
  return d;
}

AxisOptions axis_options(const NcDialect& dialect, const Machine& machine) {
  AxisOptions options;
  options.format = dialect.format;
  options.max_inverse_time = dialect.max_inverse_time;
  options.loop_needs_constant_index = !dialect.o_words;
  options.expand_teeth = !machine.post.index_loop.value_or(true);
  return options;
}

std::string comment_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c >= 'a' && c <= 'z')
      out += static_cast<char>(c - 'a' + 'A');
    else if (c == '(' || c == ')')
      out += c == '(' ? '[' : ']';
    else if (c == '%' || c == ';' || c < ' ' || c > '~')
      out += '?';
    else
      out += c;
  }
  return out;
}

Result<NcText> write_nc(const AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  if (program.format.linear_decimals != dialect.format.linear_decimals ||
      program.format.rotary_decimals != dialect.format.rotary_decimals)
    return fail("the axis program has {} and {} decimals, the dialect {} and {}", program.format.linear_decimals,
                program.format.rotary_decimals, dialect.format.linear_decimals, dialect.format.rotary_decimals);
  return Writer(program, dialect, header).write();
}

}  // namespace toothpath
