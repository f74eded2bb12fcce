// Reads cutter location data back (APT, the subset that we write): GOTO with tip and axis in work coordinates. The
// machine is the one of the job, whose axes follow the tool; LOADTL stands for a tool change at the top of Z with the
// rotaries at zero.
#include "postproc/controls/apt/apt_reader.h"

#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/readback/execution.h"
#include "postproc/readback/scanner.h"

namespace toothpath::controls {
namespace {

class AptReader {
 public:
  AptReader(std::string_view text, const std::string& file, const readback::NcControl& control,
            const readback::MoveSink& sink)
      : file_(file), control_(control), lines_(readback::lines_of(text)), execution_(control, {}, sink) {
    execution_.set_feed_mode(readback::NcExecution::Feed::per_minute);
  }

  Status run() {
    if (!control_.chain) return place(0, 0, "APT data need a machine with tcp = \"vectors\"");
    for (line_ = 0; line_ < lines_.size(); ++line_) {
      if (ended_) return here(1, "text behind FINI");
      if (auto bad = execute(lines_[line_])) return *bad;
    }
    if (!ended_) return place(lines_.size(), 0, "the data end without FINI");
    return Ok{};
  }

 private:
  using Problem = std::optional<Diagnostic>;

  Diagnostic place(std::size_t line, int column, std::string message) const {
    return {DiagnosticKind::refused_input, {file_, static_cast<int>(line), column}, std::move(message)};
  }
  Diagnostic here(int column, std::string message) const { return place(line_ + 1, column, std::move(message)); }
  Problem placed(readback::NcExecution::Problem problem) const {
    if (!problem) return std::nullopt;
    return here(1, std::move(*problem));
  }

  Problem execute(std::string_view text) {
    readback::NcScanner s(text);
    if (s.done()) return std::nullopt;
    if (s.take("$$")) {
      if (const int op = readback::comment_label(s.rest(), "OP "); op >= 0) execution_.begin_operation(op);
      if (const int tooth = readback::comment_label(s.rest(), "TOOTH "); tooth >= 0) execution_.begin_tooth(tooth);
      return std::nullopt;
    }
    if (s.take("PARTNO/")) return part_name(s);
    s = readback::NcScanner(text.substr(0, text.find("$$")));  // a comment may stand behind a statement
    s.skip_blanks();
    const int column = s.column();
    auto bad = statement(s, column);
    if (!bad && !s.done()) return here(s.column(), "words that do not belong to the statement");
    return bad;
  }

  /// The post processor writes it into the machine's program, most of them as a comment: ( ) ; and the like would end
  /// that.
  Problem part_name(const readback::NcScanner& s) const {
    const auto bad = s.rest().find_first_of("();%\"$");
    if (bad == std::string_view::npos) return std::nullopt;
    return here(
        s.column() + static_cast<int>(bad),
        fmt::format("PARTNO with {}: a post processor that writes the name as a comment would end it there, and "
                    "what follows would be executed",
                    readback::shown_character(s.rest()[bad])));
  }

  Problem statement(readback::NcScanner& s, int column) {
    if (s.take("GOTO/")) return go_to(s);
    if (s.take("RAPID")) return rapid_ = true, std::nullopt;
    if (s.take("FEDRAT/")) return feedrate(s, column);
    if (s.take("LOADTL/")) return load(s, column);
    if (s.take("CUTTER/")) return cutter(s, column);
    if (s.take("SPINDL/RPM,")) {
      const auto v = s.number();
      if (!v || !s.take(",CLW")) return here(s.column(), "SPINDL/RPM,speed,CLW expected");
      if (auto bad = placed(execution_.set_speed(*v))) return bad;
      return placed(execution_.spindle_on());
    }
    if (s.take("SPINDL/OFF")) return execution_.spindle_off(), std::nullopt;
    if (s.take("UNITS/MM")) return execution_.set_unit(), execution_.set_absolute(), std::nullopt;
    if (s.take("MULTAX/ON")) return std::nullopt;
    for (const char* word : {"COOLNT/ON", "COOLNT/FLOOD", "COOLNT/MIST", "COOLNT/OFF"})
      if (s.take(word)) return execution_.switch_coolant(word), std::nullopt;
    if (s.take("END")) {
      if (auto bad = placed(execution_.tcp_off())) return bad;
      stopped_ = true;
      return placed(execution_.end_program(false));
    }
    if (s.take("FINI")) {
      if (!stopped_) return here(column, "FINI without END: the machine's program would not end");
      return ended_ = true, std::nullopt;
    }
    for (const char* word : {"INSERT", "PPRINT", "PPFUN"})
      if (s.take(word))
        return here(column,
                    fmt::format("{} hands its text to the post processor, which may write it into the machine's "
                                "program as it stands: leave it out",
                                word));
    return here(column,
                fmt::format("{} is not in the subset", readback::shown_text(s.rest().substr(0, s.rest().find('/')))));
  }

  Problem feedrate(readback::NcScanner& s, int column) {
    const auto v = s.number();
    if (!v || !s.take(",MMPM")) return here(s.column(), "FEDRAT/feed,MMPM expected");
    if (!(*v > 0)) return here(column, "FEDRAT must be above 0");
    return placed(execution_.set_feed(*v));
  }

  Problem load(readback::NcScanner& s, int column) {
    const auto n = s.number();
    if (!n || !s.take(",LENGTH,")) return here(s.column(), "LOADTL/number,LENGTH,length expected");
    const auto length = s.number();
    const auto known = control_.tool_length_mm.find(static_cast<int>(*n));
    if (!length || known == control_.tool_length_mm.end()) return here(column, "a tool that is not in the list");
    if (std::abs(*length - known->second) > 1e-4)
      return here(column, fmt::format("LENGTH {} differs from {}, the tool's in the job", *length, known->second));
    if (control_.work_offsets.size() != 1) return here(column, "one work offset is needed");
    if (auto bad = placed(execution_.tcp_off())) return bad;
    readback::NcExecution::Move top;
    top.rapid = top.machine_frame = true;
    top.has.fill(true);
    top.axis[2] = control_.top_mm;
    for (std::size_t k = 0; k < control_.chain->rotary_count(); ++k)
      top.axis[3 + k] = degrees(control_.chain->rotary(k).zero_rad);
    for (std::size_t a = 0; a < 5; ++a)
      if (control_.letters[a] == 0) top.has[a] = false;
    if (auto bad = move(top)) return bad;
    if (auto bad = placed(execution_.choose_tool(*n))) return bad;
    if (auto bad = placed(execution_.change_tool())) return bad;
    if (auto bad = placed(execution_.select_offset(control_.work_offsets.begin()->first))) return bad;
    if (auto bad = placed(execution_.set_length(execution_.tool()))) return bad;
    return placed(execution_.tcp_on());
  }

  /// What a viewer draws must be the tool of the job.
  Problem cutter(readback::NcScanner& s, int column) {
    const auto known = control_.cutters.find(static_cast<int>(execution_.tool()));
    if (known == control_.cutters.end()) return here(column, "CUTTER of a tool that it cannot state");
    for (std::size_t i = 0; i < known->second.size(); ++i) {
      const int at = s.column();
      const auto v = s.number();
      if (!v) return here(s.column(), "CUTTER/d,r,e,f,a,b,h expected");
      if (std::abs(*v - known->second[i]) > 1e-4)
        return here(at, fmt::format("{} of CUTTER is {}, that of the job's tool is {:.4f}", "drefabh"[i], *v,
                                    known -> second[i]));
      if (i + 1 < known->second.size() && !s.take(",")) return here(s.column(), ", expected");
    }
    return std::nullopt;
  }

  Problem go_to(readback::NcScanner& s) {
    std::array<double, 6> v{};
    for (std::size_t i = 0; i < 6; ++i) {
      const auto n = s.number();
      if (!n || std::abs(*n) > 1e9) return here(s.column(), "number expected");
      v[i] = *n;
      if (i < 5 && !s.take(",")) return here(s.column(), ", expected");
      if (s.at() != '$') continue;
      s.advance(1);
      if (!s.done() || line_ + 1 >= lines_.size())
        return here(s.column(), "nothing may stand behind $, and a line must follow");
      s = readback::NcScanner(lines_[++line_]);
    }
    if (!execution_.tcp()) return here(1, "GOTO before LOADTL");
    readback::NcExecution::Move m;
    for (std::size_t a = 0; a < 3; ++a) {
      m.has[a] = true;
      m.axis[a] = v[a];
    }
    m.vector = Vec3(v[3], v[4], v[5]);
    m.rapid = rapid_;
    rapid_ = false;
    return move(m);
  }
  Problem move(const readback::NcExecution::Move& m) {
    return placed(execution_.move(m, static_cast<std::int32_t>(line_) + 1));
  }

  const std::string& file_;
  const readback::NcControl& control_;
  std::vector<std::string_view> lines_;
  readback::NcExecution execution_;
  std::size_t line_ = 0;
  bool rapid_ = false, stopped_ = false, ended_ = false;  // END, FINI
};

}  // namespace

Status execute_apt(std::string_view text, const std::string& file, const readback::NcControl& control,
                   const readback::MoveSink& sink) {
  return AptReader(text, file, control, sink).run();
}

}  // namespace toothpath::controls
