// The readers of Siemens, Heidenhain and APT refuse what is not in their subset, where it stands, and survive any
// bytes.
#include <gtest/gtest.h>

#include <random>

#include "tests/postproc/readback/nc_case.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

machines::Machine machine_with(const std::string& dialect) {
  machines::Machine m = with_dialect(trunnion(), dialect);
  m.tcp = dialect == "apt" ? machines::TcpMode::vectors : machines::TcpMode::angles;
  return m;
}

std::string refusal(const std::string& dialect, const std::string& text) {
  const machines::Machine m = machine_with(dialect);
  auto control = controls::control_of(m, standing(), tools());
  control->max_steps = 10000;
  const auto r = readback::execute_nc(text, "p", *control, [](const readback::ExecutedMove&) {});
  return r ? std::string("none") : r.error().text();
}

TEST(SiemensReader, RefusalsNameLineAndColumn) {
  const std::string start =
      "G17 G40 G60 G90 G94 G710\nTRAFOOF\nG54\n;OP 0 finishing\nSUPA G0 Z500 D0\nT=\"T1\"\nM6\nS100 M3\nD1\n";
  const auto error = [&](const std::string& body) { return refusal("siemens", start + body); };
  // What the last program may have left: a transformation in which the retract would move, and corners.
  const auto without = [&](const std::string& words) {
    return refusal("siemens", std::string(start).erase(start.find(words), words.size()) + "G0 X1 Y1 A0 C0\nG1 X2 F9\n");
  };
  EXPECT_TRUE(without("TRAFOOF\n").starts_with("p:4:9: error: an axis word ahead of TRAFOOF: what it does would"));
  EXPECT_TRUE(without("G60 ").starts_with("p:11:4: error: G1 without G60, G641 or CYCLE832 since the program began"));
  EXPECT_EQ(error("G0 A=10 C=R1\nM5\nM30\n"), "p:10:11: error: a parameter that was never set, or no parameter");
  EXPECT_EQ(error("R1=3\nG0 A=10 C=-R1*(2+1)/4\nG0 X1\nM5\nM30\n"), "none");
  const std::pair<const char*, const char*> cases[] = {
      {"G2 X1\n", "p:10:1: error: G2 is not in the subset"},
      {"G0 X1 G91\n", "p:10:7: error: G91 is not in the subset"},
      {"G0 X1 X2\n", "p:10:7: error: two X words in a block"},
      {"CYCLE832(0.01)\n", "p:10:14: error: _FINISH,1 or _ORI_FINISH and its tolerance"},
      {"CYCLE801()\n", "p:10:1: error: CYCLE is not in the subset"},
      {"TRAORI\n", "p:10:1: error: TCP at a position that the program did not set"},
      {"ENDFOR\n", "ENDFOR closes nothing"},
      {"FOR R1=0 TO 3\n", "FOR is never closed"},
      {"FOR R1=0 TO 100000\nR2=R1\nENDFOR\n", "more than 10000 executed blocks"},
      {"G641\n", "G641 and ADIS belong together"},
      {"G0 X1 A3=1\n", "A3, B3 and C3 belong together"},
      {"G0 X1 Y1 A0 C0\nG0 Z300\nTRAORI\nG54\nORIWKS\nORIAXES\nG0 A3=1 B3=1 C3=1\n", "a tool vector of length 1.73"},
      {"G0 X1 Y1 A0 C0\nG0 Z300\nTRAORI\nSUPA G0 Z500\n", "machine coordinates with TCP on"},
      {"G0 X1 Y1 A0 C0\nG0 Z300\nROT Z=30\nG0 X3\n", "a turned frame without TCP"},
      {"G1 X1\n", "G1 from a position that the program did not set"},
      {"T=\"T9\"\n", "tool 9 is not in the tool list"},
      {"R2=1/0\n", "p:10:4: error: division by zero"},
      {"G0 X1\n", "the program ends without M30"},
      {"M5\nM30\nG0 X1\n", "p:12:1: error: text behind the end"},
  };
  for (const auto& [text, expected] : cases)
    EXPECT_NE(error(text).find(expected), std::string::npos) << text << " gave " << error(text);
}

TEST(SiemensReader, WholeVariablesAreDefinedAheadOfAll) {
  const auto said = [](const std::string& text) { return refusal("siemens", text + "M30\n"); };
  EXPECT_EQ(said("; a comment\nN10 def int count , TOOTH\nFOR COUNT=0 TO 4\nTOOTH=COUNT*2-5*TRUNC((COUNT*2+0.5)/5)\n"
                 "R2=TOOTH*360/7\nENDFOR\n"),
            "none");
  const std::pair<const char*, const char*> cases[] = {
      {"FOR COUNT=0 TO 4\nENDFOR\n", "p:1:5: error: FOR needs an R parameter or a variable"},
      {"G90\nDEF INT COUNT\n", "p:2:1: error: DEF behind another block"},
      {"R1=2\nDEF INT COUNT\n", "p:2:1: error: DEF behind another block"},
      {"DEF REAL TURN\n", "p:1:5: error: DEF is read with INT alone"},
      {"DEF INT COUNT,COUNT\n", "variable COUNT is defined twice"},
      {"DEF INT R7\n", "names of 2 to 31 characters that begin with two letters"},
      {"DEF INT COUNT=3\n", "words behind the names of DEF INT"},
      {"DEF INT TOOTH\nTOOTH=7/2\n", "p:2:1: error: TOOTH is INT and takes whole numbers alone"},
      {"DEF INT TOOTH\nR1=TOOTH\n", "p:2:4: error: a parameter that was never set"},
      {"DEF INT TOOTH\nTOOTHS=1\n", "p:2:1: error: TOOTHS is not in the subset"},
      {"/DEF INT TOOTH\n", "a block that may be skipped"}};
  for (const auto& [text, expected] : cases)
    EXPECT_NE(said(text).find(expected), std::string::npos) << text << " gave " << said(text);
}

TEST(HeidenhainReader, RefusalsNameLineAndColumn) {
  const std::string lines =
      "BEGIN PGM P MM\n; OP 0 finishing\nCYCL DEF 247 DATUM SETTING Q339=+1\nL Z+500 R0 FMAX M91\nTOOL CALL 1 Z "
      "S100\nM3\n";
  const auto error = [&](const std::string& body) {
    std::string out, all = lines + body;
    std::size_t n = 0, begin = 0;
    while (begin < all.size()) {
      const std::size_t end = all.find('\n', begin);
      out += std::to_string(n++) + " " + all.substr(begin, end + 1 - begin);
      begin = end + 1;
    }
    return refusal("heidenhain", out);
  };
  EXPECT_EQ(error("Q1 = 2\nFN 1: Q5 = +Q1 + -12.5\nL A+10 C+Q5 R0 FMAX\nL X+1 FMAX\nM5\nM30\nEND PGM P MM\n"), "none");
  const std::pair<const char*, const char*> cases[] = {
      {"CC X+1 Y+1\n", "p:7:3: error: CC X+1 Y+1 is not in the subset"},
      {"L X+1 X+2 FMAX\n", "two X words in a block"},
      {"L IX+1 FMAX\n", "p:7:5: error: IX+1 is not in the subset"},
      {"L X+1 R0 F100\n", "G1 from a position that the program did not set"},
      {"L X+Q7 FMAX\n", "a parameter that was never set"},
      {"LN X+1 Y+1 Z+1 TX+0 TY+0 F100\n", "LN needs TX TY TZ"},
      {"FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR\n",
       "p:7:3: error: FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR is not in the subset"},
      {"FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\n", "TCP at a position that the program did not set"},
      {"TOOL CALL 1 Z S100\n", "tool change while the spindle turns"},
      {"CYCL DEF 200 DRILLING\n", "the cycle is not in the subset"},
      {"CALL LBL 3 REP2\n", "label that does not exist"},
      {"LBL 3\nCALL LBL 3 REP99999\n", "more than 10000 executed blocks"},
      {"M5\nM30\nL X+1 FMAX\n", "END PGM expected"},
      {"M5\nM30\nEND PGM Q MM\n", "END PGM names another program"},
      {"M5\n", "ends without END PGM"},
  };
  for (const auto& [text, expected] : cases)
    EXPECT_NE(error(text).find(expected), std::string::npos) << text << " gave " << error(text);
  EXPECT_EQ(refusal("heidenhain", "0 BEGIN PGM P MM\n2 M5\n"), "p:2:1: error: block number 1 expected");
}

TEST(AptReader, RefusalsNameLineAndColumn) {
  const std::string start =
      "PARTNO/P\nUNITS/MM\nMULTAX/ON\n$$ OP 0 finishing\nLOADTL/1,LENGTH,95.\nSPINDL/RPM,100,CLW\n";
  const auto error = [&](const std::string& body) { return refusal("apt", start + body); };
  EXPECT_EQ(
      error("RAPID\nGOTO/1.,2.,300.,0.,0.,1.\nFEDRAT/100.,MMPM\nGOTO/1.,2.,299.,0.,0.,1.\nSPINDL/OFF\nEND\nFINI\n"),
      "none");
  const std::pair<const char*, const char*> cases[] = {
      {"GOTO/1.,2.,300.\n", "p:7:16: error: , expected"},
      {"GOTO/1.,2.,300.,0.,0.,2.\n", "a tool vector of length 2"},
      {"GOTO/1.,2.,300.,0.,0.,1.\n", "G1 without F"},
      {"GOTO/1.,2.,$\n", "a line must follow"},
      {"CYCLE/DRILL\n", "p:7:1: error: CYCLE is not in the subset"},
      {"LOADTL/1,LENGTH,96.\n", "LENGTH 96 differs from 95"},
      {"CUTTER/4.,2.5\n", "p:7:11: error: r of CUTTER is 2.5, that of the job's tool is 2.0000"},
      {"CUTTER/4.,2.\n", "p:7:13: error: , expected"},
      {"LOADTL/2,LENGTH,90.25\n", "tool change while the spindle turns"},
      {"END\n", "program end while the spindle turns"},
      {"SPINDL/OFF\nEND\n", "end without FINI"},
      {"SPINDL/OFF\nEND\nFINI\nEND\n", "text behind FINI"},
  };
  for (const auto& [text, expected] : cases)
    EXPECT_NE(error(text).find(expected), std::string::npos) << text << " gave " << error(text);
}

// Any bytes give an answer.
TEST(DialectReaders, SurviveMutations) {
  for (const char* dialect : {"siemens", "heidenhain", "apt"}) {
    const machines::Machine m = machine_with(dialect);
    auto control = controls::control_of(m, standing(), tools());
    control->max_steps = 20000;
    const auto good = nc_text({sample_path(0.3, 0.2, 4)}, m, standing(), 3);
    ASSERT_TRUE(good) << good.error().message;
    std::mt19937 random(7);
    int refused = 0;
    for (int i = 0; i < 1500; ++i) {
      const std::string t = damaged(good->text, random, 1 + i % 4, "GMXYZACFRQ=/+(0123456789.-");
      const auto r = readback::read_back(t, "p", *control, m, standing(), {.teeth = 3});
      refused += r ? 0 : 1;
      if (!r) { EXPECT_FALSE(r.error().message.empty()); }
    }
    EXPECT_GT(refused, 300) << dialect;
  }
}

}  // namespace
}  // namespace toothpath
