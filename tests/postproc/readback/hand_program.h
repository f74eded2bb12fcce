// A short program in every dialect, with lines of somebody's own in it: what the reader and the judge of conditions
// say.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "postproc/readback/conditions.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath::test::hand {

using readback::ExecutedMove;

inline machines::Machine machine_with(const std::string& dialect) {
  machines::Machine m = with_dialect(trunnion(), dialect);
  m.post.reference_positions[0] = {10, 20, 480, 0, 0};
  m.post.reference_positions[1] = {-300, 250, 510, 90, -30};
  return m;
}

/// Ahead of the words that are tried: units, offset, tool 1 with its length, the spindle, a cut at X5 Y5 Z40.
inline std::string opening(const std::string& dialect) {
  if (dialect == "siemens")
    return "G17 G40 G60 G90 G94 G710\nTRAFOOF\nG54\n;OP 0 finishing\nSUPA G0 Z500 D0\nT=\"T1\"\nM6\nS1200 M3\nD1\nM8\n"
           "SUPA G0 X0 Y0\nG0 A=0 C=0\nG0 X5 Y5\nG0 Z50\nG1 Z40 F100\n";
  if (dialect == "heidenhain")
    return "BEGIN PGM P MM\n; OP 0 finishing\nCYCL DEF 247 DATUM SETTING Q339=+1\nL Z+500 R0 FMAX M91\nTOOL CALL 1 Z "
           "S1200\nM3\nM8\nL A+0 C+0 R0 FMAX\nL X+5 Y+5 R0 FMAX\nL Z+50 R0 FMAX\nL Z+40 F100\n";
  const std::string frame = dialect == "linuxcnc" ? "o99 while [#5224*#5224+#5226*#5226+#5230*#5230 GT 0]\n(ABORT, "
                                                    "G54)\no99 endwhile\n"
                                                  : "%\nO1000\n";
  return frame +
         "G21 G17 G90 G94 G40 G49 G80 G61\nG54\n(OP 0 finishing)\nG53 G0 Z500.\nT1 M6\nS1200 M3\nG43 Z400. H1\n" +
         "M8\nG0 A0. C0.\nG0 X5. Y5.\nG0 Z50.\nG1 Z40. F100.\n";
}
inline std::string ending(const std::string& dialect) {
  if (dialect == "heidenhain") return "M5\nM30\nEND PGM P MM\n";
  return dialect == "siemens" || dialect == "linuxcnc" ? "M5\nM30\n" : "M5\nM30\n%\n";
}
inline std::string whole(const std::string& dialect, const std::string& body) {
  const std::string text = opening(dialect) + body + ending(dialect);
  if (dialect != "heidenhain") return text;
  std::istringstream in(text);
  std::string out;
  int n = 0;
  for (std::string line; std::getline(in, line);) out += std::to_string(n++) + " " + line + "\n";
  return out;
}

struct Executed {
  std::string refused, reasons, warnings;
  std::vector<ExecutedMove> moves;
  double minutes = 0;
};

inline Executed executed(const std::string& dialect, const std::string& body, bool places = true) {
  machines::Machine m = machine_with(dialect);
  if (!places) m.post.reference_positions = {};
  const auto control = controls::control_of(m, standing(), tools());
  Executed out;
  const readback::AskedConditions asked{{{1, 1200, 100}}, machines::Coolant::flood};
  readback::ConditionJudge judge(m, *control, asked);
  const auto s = readback::execute_nc(whole(dialect, body), "p", *control, [&](const ExecutedMove& e) {
    out.moves.push_back(e);
    out.minutes += e.minutes + double(e.dwell_min);
    judge.add(e);
  });
  if (!s) out.refused = s.error().text();
  const auto found = judge.finish();
  for (const auto& t : found.reasons) out.reasons += t + "\n";
  for (const auto& t : found.warnings) out.warnings += t + "\n";
  return out;
}

inline const std::vector<std::string> kDialects = {"linuxcnc", "fanuc",   "mitsubishi_m80",
                                                   "haas",     "siemens", "heidenhain"};
/// A cut behind the opening.
inline std::string cut(const std::string& dialect) {
  return dialect == "heidenhain" ? "L X+6 F100\n" : "G1 X6. F100.\n";
}
inline std::string up(const std::string& dialect) {
  return dialect == "heidenhain" ? "L Z+400 R0 FMAX\n" : "G0 Z400.\n";
}

inline bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace toothpath::test::hand
