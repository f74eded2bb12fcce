// Heidenhain: touch probe cycle 4, measuring in 3-D along a vector; its results and the sign of a touch stand in four Q
// parameters in a row. Ways between are plain blocks: the control watches the probe in them.
#include <cmath>

#include "postproc/probing/probing_text.h"

namespace toothpath::probing {
namespace {

constexpr int kFirstResult = 1600, kLastResult = 1999;  ///< Q parameters that are free for programs; four a touch
constexpr std::size_t kMostTouches = (kLastResult - kFirstResult + 1) / 4;

}  // namespace

Result<std::string> touch_probe_probing(const ProbeProgram& program) {
  if (program.touches.size() > kMostTouches)
    return fail("{} touches, at most {}: Q{} to Q{} hold the results; fewer --spaces", program.touches.size(),
                kMostTouches, kFirstResult, kLastResult);
  std::string out = "BEGIN PGM PROBE_SETUP MM\n";
  const auto add = [&](const std::string& line) { out += line + "\n"; };
  for (const auto& line : header(program)) add("; " + line);
  add("; RESULTS OF TOUCH N: Q1600 + 4 (N - 1) AND THE TWO BEHIND IT, TO BE TYPED AS N X Y Z");
  for (const char* line : {"PLANE RESET STAY", "FUNCTION RESET TCPM", "TRANS DATUM RESET"}) add(line);
  add(fmt::format("CYCL DEF 247 DATUM SETTING Q339=+{}", program.datum));
  const std::string top = "L " + word('Z', program.top_mm, true) + " R0 FMAX M91";
  add(top);
  add(fmt::format("TOOL CALL {} Z", program.tool));
  const auto turn = [&](const ProbeTouch& touch) {
    add(top);
    std::string rotaries;
    for (const auto& [letter, degrees] : touch.rotaries) rotaries += " " + word(letter, degrees, true);
    if (!rotaries.empty()) add("L" + rotaries + " R0 FMAX");
  };
  turn(program.touches.front());
  for (std::size_t k = 0; k < program.touches.size(); ++k) {
    const ProbeTouch& touch = program.touches[k];
    const Coming coming = coming_to(program, k);
    const std::string feed = fmt::format(" R0 F{:.0f}", program.guarded_feed);
    const int result = kFirstResult + 4 * (touch.number - 1);
    const Vec3 way = touch.past - touch.start;
    add(fmt::format("; TOUCH {} {}", touch.number, touch.remark));
    if (coming == Coming::turned) turn(touch);
    add("L " + words(touch.start, 2, true) + (coming == Coming::beside ? feed : " R0 FMAX"));
    if (coming != Coming::beside) add("L " + word('Z', program.clear_mm, true) + feed);
    add("L " + word('Z', touch.start.z(), true) + feed);
    add("TCH PROBE 4.0 MEASURING IN 3-D");
    add(fmt::format("TCH PROBE 4.1 Q{}", result));
    add(fmt::format("TCH PROBE 4.2 I{} I{} I{}", word('X', way.x(), true), word('Y', way.y(), true),
                    word('Z', way.z(), true)));
    add(fmt::format("TCH PROBE 4.3 DIST {:+.4f} F{:.0f} MB{:.4f} REFERENCE SYSTEM:0", way.norm(), program.feed, 0.0));
    add(fmt::format("FN 9: IF +Q{} EQU -1 GOTO LBL 99", result + 3));
    add("L " + words(touch.start, 3, true) + feed);
    add("L " + word('Z', program.clear_mm, true) + feed);
  }
  add(top);
  add("STOP M30");
  add("LBL 99");
  add("; THE PROBE MET NOTHING");
  add("STOP");
  add("LBL 0");
  add("END PGM PROBE_SETUP MM");
  return out;
}

}  // namespace toothpath::probing
