// Siemens: MEAS=1 deletes the rest of the way when the probe switches; $AC_MEA says whether it did, $AA_MW where.
#include "postproc/probing/probing_text.h"

namespace toothpath::probing {
namespace {

/// "X=.." as Siemens may write every word.
std::string assigned(const Vec3& place, int from, int count) {
  std::string out;
  for (int k = from; k < count; ++k)
    out += (k > from ? " " : "") + fmt::format("{}={}", "XYZ"[k], word("XYZ"[k], place[k]).substr(1));
  return out;
}

}  // namespace

Result<std::string> meas_probing(const ProbeProgram& program) {
  std::string out;
  const auto add = [&](const std::string& line) { out += line + "\n"; };
  for (const auto& line : header(program)) add("; " + line);
  add("DEF INT FAULT");
  add("G17 G40 G90 G94 G710");
  add("TRAFOOF");
  add("ROT");
  add("COMPOF");
  add(program.work_offset);
  const std::string top = fmt::format("G0 SUPA D0 Z={}", word('Z', program.top_mm).substr(1));
  add(top);
  add(fmt::format("T=\"T{}\"", program.tool));
  add("M6");
  const auto turn = [&](const ProbeTouch& touch) {
    add(top);
    std::string rotaries;
    for (const auto& [letter, degrees] : touch.rotaries)
      rotaries += fmt::format(" {}={}", letter, word(letter, degrees).substr(1));
    if (!rotaries.empty()) add("G0" + rotaries);
    add("D1");
  };
  turn(program.touches.front());
  add("DELETE(FAULT,\"PROBE_RESULTS\")");
  const auto guarded = [&](const std::string& where) {
    add("MEAS=1 G1 " + where + fmt::format(" F{}", word('F', program.guarded_feed).substr(1)));
    add("STOPRE");
    add("IF $AC_MEA[1]==1 GOTOF ON_THE_WAY");
  };
  for (std::size_t k = 0; k < program.touches.size(); ++k) {
    const ProbeTouch& touch = program.touches[k];
    const Vec3 above(touch.start.x(), touch.start.y(), program.clear_mm);
    const Coming coming = coming_to(program, k);
    add(fmt::format("; TOUCH {} {}", touch.number, touch.remark));
    if (coming == Coming::turned) turn(touch);
    if (coming == Coming::beside) {
      guarded(assigned(above, 0, 2));
    } else {
      add("G0 " + assigned(above, 0, 2));
      guarded(assigned(above, 2, 3));
    }
    guarded(assigned(touch.start, 2, 3));
    add("MEAS=1 G1 " + assigned(touch.past, 0, 3) + fmt::format(" F{}", word('F', program.feed).substr(1)));
    add("STOPRE");
    add("IF $AC_MEA[1]==0 GOTOF NOTHING_MET");
    add("R1=$AA_MW[X]");
    add("R2=$AA_MW[Y]");
    add("R3=$AA_MW[Z]");
    add(fmt::format("WRITE(FAULT,\"PROBE_RESULTS\",\"{} \"<<R1<<\" \"<<R2<<\" \"<<R3)", touch.number));
    add("G1 " + assigned(touch.start, 0, 3) + fmt::format(" F{}", word('F', program.guarded_feed).substr(1)));
    add("G1 " + assigned(above, 2, 3));
  }
  add(top);
  add("M30");
  for (const char* line : {"ON_THE_WAY:", "SETAL(65001,\"THE PROBE MET SOMETHING ON ITS WAY\")", "M30",
                           "NOTHING_MET:", "SETAL(65002,\"THE PROBE MET NOTHING\")", "M30"})
    add(line);
  return out;
}

}  // namespace toothpath::probing
