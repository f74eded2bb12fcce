// LinuxCNC: G38.3 stops where the probe meets something, G38.2 must meet it. Fanuc, Mitsubishi, Haas: ways by the
// protected positioning of the Renishaw macros (P9810), touches by the skip function G31; #5061 .. is where it met.
#include "postproc/probing/probing_text.h"

namespace toothpath::probing {
namespace {

class Lines {
 public:
  void add(const std::string& line) { text_ += line + "\n"; }
  void comment(const std::string& text) { add("(" + text + ")"); }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

/// Z to its top and the rotaries to the pose of a touch.
void turn(Lines& out, const ProbeProgram& program, const ProbeTouch& touch) {
  out.add("G53 G0 " + word('Z', program.top_mm));
  std::string rotaries;
  for (const auto& [letter, degrees] : touch.rotaries) rotaries += " " + word(letter, degrees);
  if (!rotaries.empty()) out.add("G0" + rotaries);
}

/// Up, the probe, and the pose of the first touch.
void begin(Lines& out, const ProbeProgram& program) {
  out.add("G53 G0 " + word('Z', program.top_mm));
  out.add(fmt::format("T{} M6", program.tool));
  turn(out, program, program.touches.front());
}

void linuxcnc_subs(Lines& out) {
  out.add("o7001 sub");
  out.add("G38.3 X#1 Y#2 Z#3 F#4");
  out.add("o7002 if [#5070 NE 0]");
  out.add("(LOG,; STOPPED: THE PROBE MET SOMETHING ON ITS WAY)");
  out.add("(LOGCLOSE)");
  out.add("(ABORT,THE PROBE MET SOMETHING ON ITS WAY)");
  out.add("o7002 endif");
  out.add("o7001 endsub");
}

std::string call(const Vec3& to, double feed) {
  return fmt::format("o7001 call [{}] [{}] [{}] [{}]", word('X', to.x()).substr(1), word('Y', to.y()).substr(1),
                     word('Z', to.z()).substr(1), word('F', feed).substr(1));
}

std::string linuxcnc_text(const ProbeProgram& program) {
  Lines out;
  for (const auto& line : header(program)) out.comment(line);
  linuxcnc_subs(out);
  out.add("G21 G17 G90 G94 G40 G49 G80");
  out.add(program.work_offset);
  for (const std::string& line : program.offset_check) out.add(line);
  begin(out, program);
  out.add(fmt::format("G43 H{}", program.tool));
  out.add("(LOGOPEN,probe_results.txt)");
  for (std::size_t k = 0; k < program.touches.size(); ++k) {
    const ProbeTouch& touch = program.touches[k];
    const Vec3 above(touch.start.x(), touch.start.y(), program.clear_mm);
    const Coming coming = coming_to(program, k);
    out.comment(fmt::format("TOUCH {} {}", touch.number, touch.remark));
    if (coming == Coming::turned) turn(out, program, touch);
    if (coming != Coming::beside) out.add("G0 " + words(above, 2));
    out.add(call(above, program.guarded_feed));
    out.add(call(touch.start, program.guarded_feed));
    out.add("G38.2 " + words(touch.past, 3) + " " + word('F', program.feed));
    out.add(fmt::format("(LOG,{} #5061 #5062 #5063)", touch.number));
    out.add("G1 " + words(touch.start, 3) + " " + word('F', program.guarded_feed));
    out.add("G1 " + word('Z', program.clear_mm));
  }
  out.add("(LOGCLOSE)");
  out.add("G53 G0 " + word('Z', program.top_mm));
  out.add("G49");
  out.add("M2");
  return std::move(out).text();
}

std::string guarded(const Vec3& to, int count, double feed) {
  return "G65 P9810 " + words(to, count) + " " + word('F', feed);
}

std::string fanuc_text(const ProbeProgram& program) {
  Lines out;
  out.add("%");
  out.add(fmt::format("O{:04}", program.number));
  for (const auto& line : header(program)) out.comment(line);
  out.comment("P9810 P9832 P9833: RENISHAW MACROS. G31: SKIP BY THE PROBE. DPRNT: LOG");
  out.add("G21 G17 G90 G94 G40 G80 G49");
  out.add(program.work_offset);
  begin(out, program);
  out.add("G0 " + words(program.touches.front().start, 2));
  out.add(fmt::format("G43 H{} {}", program.tool, word('Z', program.clear_mm)));
  out.add("G65 P9832");
  out.add("POPEN");
  for (std::size_t k = 0; k < program.touches.size(); ++k) {
    const ProbeTouch& touch = program.touches[k];
    const Vec3 above(touch.start.x(), touch.start.y(), program.clear_mm);
    out.comment(fmt::format("TOUCH {} {}", touch.number, touch.remark));
    if (coming_to(program, k) == Coming::turned) {
      turn(out, program, touch);
      out.add("G0 " + words(above, 2));
      out.add("G65 P9810 " + word('Z', above.z()) + " " + word('F', program.guarded_feed));
    } else {
      out.add(guarded(above, 2, program.guarded_feed));
    }
    out.add("G65 P9810 " + word('Z', touch.start.z()) + " " + word('F', program.guarded_feed));
    out.add("G31 " + words(touch.past, 3) + " " + word('F', program.feed));
    out.add(fmt::format("#100={}", touch.number));
    out.add("#101=#5061");
    out.add("#102=#5062");
    out.add("#103=#5063");
    out.add(fmt::format("IF[[ABS[#101-[{}]]+ABS[#102-[{}]]+ABS[#103-[{}]]] LT 0.005] GOTO 9000",
                        word('X', touch.past.x()).substr(1), word('Y', touch.past.y()).substr(1),
                        word('Z', touch.past.z()).substr(1)));
    out.add("DPRNT[#100[40]*#101[54]*#102[54]*#103[54]]");
    out.add("G1 " + words(touch.start, 3) + " " + word('F', program.guarded_feed));
    out.add("G1 " + word('Z', program.clear_mm));
  }
  out.add("PCLOS");
  out.add("G65 P9833");
  out.add("G49");
  out.add("G53 G0 " + word('Z', program.top_mm));
  out.add("M30");
  out.add("N9000 #3000=101(THE PROBE MET NOTHING)");
  out.add("%");
  return std::move(out).text();
}

}  // namespace

Result<std::string> g38_probing(const ProbeProgram& program) { return linuxcnc_text(program); }
Result<std::string> g31_probing(const ProbeProgram& program) { return fanuc_text(program); }

}  // namespace toothpath::probing
