// APT / CLDATA (ISO 3592, words of ISO 4343): cutter location data, no axes. What stands in the file is the tip in work
// coordinates and the tool axis, tooth after tooth; the axis program is that of a machine whose tool turns freely. A
// subset: PARTNO UNITS MULTAX LOADTL CUTTER SPINDL COOLNT RAPID FEDRAT GOTO END FINI.
#include <fmt/format.h>

#include <cmath>

#include "geometry/base/hash.h"
#include "machines/assumed.h"
#include "postproc/controls/apt/apt_reader.h"
#include "postproc/controls/control.h"
#include "postproc/numbers/comment.h"
#include "postproc/numbers/fixed_point.h"
#include "postproc/text/lines.h"
#include "postproc/text/writer.h"

namespace toothpath::controls {
namespace {

constexpr int kAxisDecimals = 9;
constexpr int kCutterDecimals = 4;
constexpr std::size_t kLongestTip = 34;  // 72 characters less the longest axis

class AptWriter {
 public:
  AptWriter(const joints::AxisProgram& program, const text::NcDialect& dialect, const text::NcHeader& header)
      : program_(program), dialect_(dialect), out_(dialect), header_(header) {}

  Result<text::NcText> write() {
    if (header_.coolant != machines::Coolant::off) {
      auto words = text::coolant_words(dialect_, header_.coolant);
      if (!words) return words.error();
      coolant_ = std::move(*words);
    }
    out_.line("MULTAX/ON");
    int loaded = -1;
    for (const auto& op : program_.operations) {
      out_.comment(fmt::format("OP {} {}", op.operation, op.type));
      if (op.tool_number != loaded) {
        out_.line(
            fmt::format("LOADTL/{},LENGTH,{}", op.tool_number, number(numbers::to_fixed(op.tool_length_mm, 4), 4)));
        cutter(op);
        if (op.sister_of != 0) out_.comment(fmt::format("SISTER OF T{}", op.sister_of));
      }
      loaded = op.tool_number;
      out_.line(fmt::format("SPINDL/RPM,{},CLW", std::llround(op.spindle_rpm)));
      if (coolant_) out_.line(coolant_->on);
      feed_ = -1;
      std::vector<joints::AxisBlock> room;
      for (const auto& tooth : op.teeth) {
        out_.comment(fmt::format("TOOTH {}", tooth.tooth));
        feed_ = -1;  // a tooth can be begun with
        for (const auto& b : tooth.all(room)) block(b);
      }
      if (coolant_) out_.line(coolant_->off);
      out_.line("SPINDL/OFF");
    }
    if (error_) return *error_;
    if (out_.error()) return *out_.error();
    return assemble();
  }

 private:
  static std::string number(std::int64_t scaled, int decimals) {
    std::string s;
    numbers::append_fixed(s, scaled, decimals, true);
    return s;
  }

  void cutter(const joints::AxisOperation& op) {
    if (!op.cutter) return out_.comment("FORM CUTTER, ITS MERIDIAN STANDS IN THE DRAWING");
    std::string text;
    for (const double v : *op.cutter) {
      text += text.empty() ? "CUTTER/" : ",";
      text += number(numbers::to_fixed(v, kCutterDecimals), kCutterDecimals);
    }
    out_.line(text);
  }

  void block(const joints::AxisBlock& b) {
    if (!b.tip) return;  // before the tool is over the part, and after it has left
    if (b.kind == joints::BlockKind::feed) feedrate(b);
    else out_.line("RAPID");
    std::string& text = out_.text();
    std::size_t begin = text.size();
    text += "GOTO/";
    for (std::size_t i = 0; i < 3; ++i) {
      numbers::append_fixed(text, b.words[i], program_.format.linear_decimals, true);
      text += ',';
    }
    if (text.size() - begin > kLongestTip) {  // 72 characters: the axis goes on in the next line
      text += '$';
      out_.end_line(begin, false);
      begin = text.size();
    }
    for (int i = 0; i < 3; ++i) {
      numbers::append_fixed(text, numbers::to_fixed(b.axis[i], kAxisDecimals), kAxisDecimals, true);
      if (i < 2) text += ',';
    }
    out_.end_line(begin, true);
  }

  void feedrate(const joints::AxisBlock& b) {
    const std::int64_t scaled = b.per_minute < 9e8 ? numbers::to_fixed_down(b.per_minute * (1 + 1e-12), 6) : 0;
    if (scaled == feed_ && scaled > 0) return;
    if (scaled <= 0) error_ = fail("record {}: feed {} cannot be printed", b.record, b.per_minute);
    feed_ = scaled;
    out_.line(fmt::format("FEDRAT/{},MMPM", number(scaled, 6)));
  }

  Result<text::NcText> assemble() {
    text::NcText result;
    result.body_hash = fnv1a(out_.text());
    result.blocks = out_.blocks() + 4;
    const std::string body = std::move(out_.text());
    out_.text().clear();
    out_.line(fmt::format("PARTNO/{}", text::program_id(header_.job_name, header_.name_end)));
    out_.line("UNITS/MM");
    out_.comment(numbers::comment_text("JOB " + header_.job_name));
    out_.comment(numbers::comment_text("MACHINE " + header_.machine_name));
    const std::string hash = fmt::format("HASH {:016X} BLOCKS {}", result.body_hash, result.blocks);
    out_.comment(hash);
    out_.comment("TIP AND TOOL AXIS IN WORK COORDINATES");
    for (const auto& line : text::order_comments(program_)) out_.comment(line);
    constexpr std::size_t kAbove = 6;  // lines so far, without the order of the teeth
    const auto order = text::order_comments(program_).size();
    for (const auto& line : text::assumed_comments(header_.assumed, dialect_, kAbove + order)) out_.comment(line);
    out_.text() += body;
    out_.comment(hash);
    out_.line("END");
    out_.line("FINI");
    if (out_.error()) return *out_.error();
    result.text = std::move(out_.text());
    return result;
  }

  const joints::AxisProgram& program_;
  const text::NcDialect& dialect_;
  text::NcLines out_;
  const text::NcHeader& header_;
  std::optional<machines::CoolantWords> coolant_;
  std::int64_t feed_ = -1;
  std::optional<Diagnostic> error_;
};

Result<text::NcText> write_apt(const joints::AxisProgram& program, const text::NcDialect& dialect,
                               const text::NcHeader& header) {
  return AptWriter(program, dialect, header).write();
}

text::NcDialect words() {
  text::NcDialect d;
  d.name = "apt";
  d.extension = ".apt";
  d.format = {.linear_decimals = 6, .rotary_decimals = 7};
  d.comment_open = "$$ ";
  d.comment_close = "";
  d.max_line = 72;
  d.tcp_on = d.tcp_off = {"MULTAX/ON"};
  d.tcp_starts_at_zero = true;
  d.cutter_locations = true;
  d.vector_words = {"I", "J", "K"};
  d.coolant = {{machines::Coolant::mist, {"COOLNT/MIST", "COOLNT/OFF"}},
               {machines::Coolant::flood, {"COOLNT/FLOOD", "COOLNT/OFF"}}};
  d.takes_coolant = false;
  d.write = write_apt;
  return d;
}

/// Tips are relative to the one offset of the job, whatever it is called.
bool has_offset(std::string_view) { return true; }

}  // namespace

Control apt() { return {words(), {"cldata"}, {"any: the data do not name it", has_offset}, execute_apt}; }

}  // namespace toothpath::controls
