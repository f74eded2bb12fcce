#include "postproc/text/writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <regex>
#include <sstream>

#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string l; std::getline(in, l);) out.push_back(l);
  return out;
}

std::string without_comments(const std::string& line) {
  return std::regex_replace(line, std::regex("\\([^)]*\\)"), "");
}

std::vector<path::ClPath> three_operations() {
  std::vector<path::ClPath> paths = {sample_path(0.3, 0.2), sample_path(0, 0, 20, 1), sample_path(0, 0, 20, 2)};
  paths[1].tool = 1;
  return paths;
}

std::string program(const std::string& dialect, bool expand = false) {
  const auto t = nc_text(three_operations(), with_dialect(trunnion(), dialect), standing(), 5, expand);
  EXPECT_TRUE(t) << (t ? "" : t.error().message);
  return t ? t->text : "";
}

class BothDialects : public testing::TestWithParam<std::pair<const char*, bool>> {
 protected:
  std::string text() const { return program(GetParam().first, GetParam().second); }
  bool fanuc() const { return std::string(GetParam().first) == "fanuc"; }
};
INSTANTIATE_TEST_SUITE_P(Dialects, BothDialects,
                         testing::Values(std::pair{"linuxcnc", false}, std::pair{"linuxcnc", true},
                                         std::pair{"fanuc", false}, std::pair{"fanuc", true}));

// Danger 1 and 3: all modal groups are reset before the first motion, and that motion is a machine retract.
TEST_P(BothDialects, SafeStart) {
  std::string before;
  for (const auto& l : lines(text())) {
    const std::string code = without_comments(l);
    if (std::regex_search(code, std::regex("o1\\d\\d sub"))) break;
    if (code.rfind("G52", 0) != 0 && std::regex_search(code, std::regex("[XYZAC]-?[0-9.\\[]"))) {
      EXPECT_NE(code.find("G53"), std::string::npos) << l;
      before += code;
      break;
    }
    before += code + " ";
  }
  for (const char* g : {"G21", "G17", "G90", "G94", "G40", "G49", "G80", "G54"})
    EXPECT_NE(before.find(g), std::string::npos) << g;
}

// Danger 2 and 25: modes at the end and at every tool change.
TEST_P(BothDialects, ModesAtToolChangeAndEnd) {
  bool spindle = false, coolant = false, g93 = false, g43 = false, retracted = false, ended = false;
  int changes = 0;
  for (const auto& l : lines(text())) {
    const std::string c = without_comments(l) + " ";
    const auto has = [&](const char* w) { return std::regex_search(c, std::regex(std::string(w) + "\\b")); };
    if (ended) continue;
    if (has("M3")) spindle = true;
    if (has("M5")) spindle = false;
    if (has("M8")) coolant = true;
    if (has("M9")) coolant = false;
    if (has("G94")) g93 = false;
    if (has("G93")) g93 = true;
    if (has("G49")) g43 = false;
    if (has("G43")) g43 = true;
    if (has("M6")) {
      ++changes;
      EXPECT_TRUE(std::regex_search(c, std::regex("T\\d+ M6")));
      EXPECT_FALSE(spindle || coolant || g93) << l;
      EXPECT_TRUE(retracted) << l;
    }
    if (has("G53")) retracted = true;
    else if (!has("G52") && std::regex_search(c, std::regex("[XYZAC]-?[0-9.\\[]"))) retracted = false;
    if (has("M2") || has("M30")) {
      ended = true;
      EXPECT_FALSE(spindle || coolant || g93 || g43);
      EXPECT_TRUE(retracted);
    }
  }
  EXPECT_EQ(changes, 3);
  EXPECT_TRUE(ended);
}

// Danger 4, 5, 8, 18: F with every G93 block, an F since G94 was said, G94 only while the rotaries stand (Fanuc), only
// G0 and G1, points on Fanuc.
TEST_P(BothDialects, WordsOfEveryBlock) {
  bool g93 = false, feed = false, cut = false;
  std::string rotaries;
  int motion = -1;
  for (const auto& l : lines(text())) {
    const std::string c = without_comments(l);
    EXPECT_FALSE(std::regex_search(c, std::regex("G[023]?[23]\\b|G4[12]\\b|G91\\b|G20\\b"))) << l;
    EXPECT_LE(l.size(), fanuc() ? 80u : 252u);
    if (c.find("G93") != std::string::npos) g93 = true;
    if (c.find("G94") != std::string::npos) g93 = feed = false;
    feed = feed || c.find('F') != std::string::npos;
    if (std::regex_search(c, std::regex("G0\\b"))) motion = 0;
    if (std::regex_search(c, std::regex("G1\\b"))) motion = 1;
    if (c.rfind("G52", 0) == 0) continue;  // where words count from
    const bool moves = c.find("o1") == std::string::npos && std::regex_search(c, std::regex("[XYZAC]-?[0-9.\\[]"));
    if (moves && motion == 1) {
      EXPECT_TRUE(g93 ? c.find('F') != std::string::npos : feed) << l;
      const auto turn = c.find_first_of("AC");
      if (cut && !g93 && fanuc() && turn != std::string::npos) {
        EXPECT_EQ(c.substr(turn, c.find(" F") - turn), rotaries) << l;
      }
    }
    if (const auto turn = c.find_first_of("AC"); moves && turn != std::string::npos)
      rotaries = c.substr(turn, c.find(" F") - turn);
    cut = moves && motion == 1;
    if (moves && motion == 0) {
      const bool xy = c.find_first_of("XY") != std::string::npos, z = c.find('Z') != std::string::npos,
                 rotary = c.find_first_of("AC") != std::string::npos;
      EXPECT_EQ(int{xy} + int{z} + int{rotary}, 1) << l;
    }
    static const std::regex value("[XYZACF](-?[0-9]*\\.?[0-9]*)");
    for (std::sregex_iterator it(c.begin(), c.end(), value), end; fanuc() && it != end; ++it) {
      EXPECT_NE((*it)[1].str().find('.'), std::string::npos) << l;
    }
    EXPECT_FALSE(std::regex_search(c, std::regex("-0\\.?(?![0-9.])|[eE][-+]?[0-9]|nan|inf"))) << l;
  }
}

// Danger 10: after every break all words of the group are there, although nothing changes between operations 1 and 2.
TEST_P(BothDialects, ForcedWordsAfterBreaks) {
  bool after_rapid = true;
  bool fresh = true;  // since the tool change or the tooth
  for (const auto& l : lines(text())) {
    const std::string c = without_comments(l);
    if (c.find("M6") != std::string::npos || l.find("TOOTH") != std::string::npos ||
        c.find(" sub") != std::string::npos)
      fresh = true;
    if (c.rfind("G0", 0) == 0 && c.find("G53") == std::string::npos && c.find("G43") == std::string::npos) {
      if (fresh && c.find('A') == std::string::npos && !fanuc()) ADD_FAILURE() << "no rotaries first: " << l;
      fresh = false;
      after_rapid = true;
    }
    if (c.rfind("G1", 0) == 0 && after_rapid) {
      for (const char a : {'X', 'Y', 'Z', 'A'}) EXPECT_NE(c.find(a), std::string::npos) << l;
      after_rapid = false;
    }
  }
}

TEST_P(BothDialects, OperationCommentsAndSpeeds) {
  const std::string t = text();
  std::size_t from = 0;
  for (int op = 0; op < 3; ++op) {
    const auto at = t.find(fmt::format("(OP {} finishing)", op), from);
    ASSERT_NE(at, std::string::npos);
    const auto next = t.find("(OP ", at + 5);
    const std::string section = t.substr(at, next == std::string::npos ? next : next - at);
    EXPECT_NE(section.find("S12000 M3"), std::string::npos);
    from = at + 1;
  }
}

TEST_P(BothDialects, SameInputSameBytesAndHash) {
  const std::string t = text();
  EXPECT_EQ(t, text());
  const auto first = t.find("HASH "), last = t.rfind("HASH ");
  ASSERT_NE(first, last);
  EXPECT_EQ(t.substr(first, 30), t.substr(last, 30));
  EXPECT_EQ(t.back(), '\n');
}

// Danger 27: whatever the name, the comment stays a comment.
TEST(NcWriter, CommentsAreFiltered) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    text::NcHeader header;
    for (int k = 0; k < 40; ++k) header.job_name += static_cast<char>(random() & 0xff);
    header.machine_name = header.job_name;
    header.assumed = {header.job_name};
    const auto p = axis_program({sample_path(0, 0, 2)}, trunnion(), standing(), 2);
    const auto t = text::write_nc(*p, words_of("linuxcnc"), header);
    ASSERT_TRUE(t);
    for (const char c : t->text) ASSERT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
    const auto head = lines(t->text);
    for (std::size_t l = 0; l < 4; ++l) {
      ASSERT_EQ(head[l].front(), '(');
      ASSERT_EQ(head[l].find(')'), head[l].size() - 1);
      ASSERT_EQ(head[l].find('(', 1), std::string::npos);
    }
  }
}

// LinuxCNC is told to keep the path; what its servo period leaves of a corner is counted, as the machine says it.
TEST(NcWriter, LinuxcncKeepsThePathAndCountsWhatItLeaves) {
  machines::Machine m = trunnion();
  const auto counts = [&](const path::ClPath& path, double counted, const std::string& comment) {
    const auto control = controls::control_of(m, standing(), tools());
    const auto dialect = controls::dialect_of(m);
    const auto p = axis_program({path}, m, standing(), 3);
    const auto t = text::write_nc(*p, *dialect, text::NcHeader{});
    EXPECT_DOUBLE_EQ(text::granted_blend_mm(*p, *dialect, text::NcHeader{}), counted);
    int cuts = 0;
    const auto s = readback::execute_nc(t->text, "p.ngc", *control, [&](const readback::ExecutedMove& e) {
      if (e.rapid) return;
      ++cuts;
      EXPECT_EQ(e.blend_mm, static_cast<float>(counted));
    });
    EXPECT_TRUE(s) << s.error().text();
    EXPECT_GT(cuts, 10);
    const auto text = lines(t->text);
    EXPECT_NE(std::find(text.begin(), text.end(), "G61"), text.end());
    EXPECT_NE(std::find(text.begin(), text.end(), comment), text.end()) << comment;
    EXPECT_EQ(t->text.find("G64"), std::string::npos);
  };
  const std::string usual = "(CORNERS WITHIN 0.0005 MM: TOOL ACCELERATION X SERVO PERIOD SQUARED IS AT MOST 0.002 MM)";
  counts(sample_path(0.3, 0), 0.0005, usual);
  counts(sample_path(0.3, 0.6), 0.0005, usual);
  m.post.corner_tolerance_mm = 0.0001;
  counts(sample_path(0.3, 0.6), 0.0001,
         "(CORNERS WITHIN 0.0001 MM: TOOL ACCELERATION X SERVO PERIOD SQUARED IS AT MOST 0.0004 MM)");
  // Accelerations that are stated and leave more: 3000 mm/s^2 along X, 4000 along Y in 1 ms squared, a quarter of 5 um.
  m.post.corner_tolerance_mm.reset();
  m.tcp = machines::TcpMode::angles;
  m.post.tcp_on = {"M428"};
  m.post.tcp_off = {"M429"};
  m.chain.linear[0].max_acceleration = 3000 * 3600.0;
  m.chain.linear[1].max_acceleration = 4000 * 3600.0;
  EXPECT_NEAR(m.exact_corner_mm(), 0.00125, 1e-12);
  EXPECT_EQ(controls::dialect_of(m)->exact_path_mm, m.exact_corner_mm());
  // 1000 deg/s^2 at the rim of the largest part, where the words are the joints.
  m.chain.table[0].max_acceleration = radians(1000 * 3600.0);
  EXPECT_NEAR(m.exact_corner_mm(), 0.00125, 1e-12);
  m.tcp = machines::TcpMode::none;
  EXPECT_NEAR(m.exact_corner_mm(), 0.00125 + radians(1000) * m.largest_part_mm() / 2 * 1e-6 / 4, 1e-12);
}

// Controls that state no bound under G64: G61, or what the machine file states; a text that says neither is refused.
TEST(NcWriter, CornersAreStopsOrStatedOnFanucAndTheLike) {
  for (const char* name : {"fanuc", "mitsubishi_m80", "haas"}) {
    machines::Machine m = trunnion();
    m.dialect = name;
    const auto read = [&](const std::string& text, double& most) {
      most = 0;
      return readback::execute_nc(text, "p.nc", *controls::control_of(m, standing(), tools()),
                                  [&](const readback::ExecutedMove& e) {
                                    if (!e.rapid) most = std::max(most, double(e.blend_mm));
                                  });
    };
    const auto p = axis_program({sample_path(0.3, 0)}, m, standing(), 3, true);
    ASSERT_TRUE(p) << p.error().message;
    const auto written = [&] { return text::write_nc(*p, *controls::dialect_of(m), {})->text; };
    const std::string stops = written();
    double most = 0;
    EXPECT_TRUE(read(stops, most)) << name;
    EXPECT_EQ(most, 0) << name;
    EXPECT_EQ(stops.find("G64"), std::string::npos) << name;
    const std::string silent = std::regex_replace(stops, std::regex("\nG61\n"), "\n"),
                      flowing = std::regex_replace(stops, std::regex("\nG61\n"), "\nG64\n");
    for (const std::string& text : {silent, flowing}) {
      const auto refused = read(text, most);
      ASSERT_FALSE(refused) << name;
      EXPECT_NE(refused.error().message.find("G1 without G61"), std::string::npos) << refused.error().message;
    }
    m.post.corner_tolerance_mm = 0.002;
    const std::string stated = written();
    EXPECT_EQ(text::granted_blend_mm(*p, *controls::dialect_of(m), {}), 0.002);
    EXPECT_NE(stated.find("(G64 LEAVES CORNERS BY AT MOST 0.002 MM: STATED IN THE MACHINE FILE)\n"), std::string::npos);
    EXPECT_EQ(stated.find("\nG61\n"), std::string::npos) << name;
    EXPECT_TRUE(read(stated, most)) << name;
    EXPECT_EQ(most, double(float(0.002))) << name;
    EXPECT_FALSE(read(std::regex_replace(stated, std::regex("\nG64\n"), "\nG64 P0.002\n"), most)) << name;
  }
}

// A text with G64 P: more than P is counted, as docs/dialects.md derives it, and lines that are joined without Q.
TEST(NcReader, G64OfLinuxcncCountsMoreThanItsTolerance) {
  const machines::Machine m = trunnion();
  auto control = controls::control_of(m, standing(), tools());
  const auto p = axis_program({sample_path(0.3, 0)}, m, standing(), 3);
  const std::string text = text::write_nc(*p, *controls::dialect_of(m), text::NcHeader{})->text;
  const auto counted = [&](const std::string& word) {
    std::string with = text;
    with.replace(with.find("\nG61\n"), 5, "\n" + word + "\n");
    double most = 0;
    const auto s = readback::execute_nc(
        with, "p.ngc", *control, [&](const readback::ExecutedMove& e) { most = std::max(most, double(e.blend_mm)); });
    EXPECT_TRUE(s) << s.error().text();
    return most;
  };
  // Tip acceleration a = 2000 mm/s^2, period T = 1 ms, P in mm.
  const auto bound = [](double a, double t, double tolerance) {
    return std::pow(std::sqrt(1.06 * tolerance) + t / 2 * std::sqrt(a / 2), 2) + 0.3 * a * t * t;
  };
  EXPECT_NEAR(counted("G64 P0.0003 Q0"), bound(2000, 1e-3, 0.0003), 1e-9);
  EXPECT_NEAR(counted("G64 P0.002 Q0"), bound(2000, 1e-3, 0.002), 1e-9);
  EXPECT_NEAR(counted("G64 P0.002"), bound(2000, 1e-3, 0.002) + 0.002, 1e-9);
  EXPECT_NEAR(counted("G64 P0.002 Q0.001"), bound(2000, 1e-3, 0.002) + 0.001, 1e-9);
  EXPECT_NEAR(counted("G61.1"), 0.0005, 1e-9);
  control->exact_path_mm = 300 * 1e-6 / 4;
  EXPECT_NEAR(counted("G64 P0.0003 Q0"), bound(300, 1e-3, 0.0003), 1e-9);
  EXPECT_NEAR(counted("G61"), 0.000075, 1e-9);
}

TEST(NcWriter, WholeWordsAreKept) {
  using numbers::first_words;
  EXPECT_EQ(first_words("dhfg on a table", 15), "dhfg on a table");
  EXPECT_EQ(first_words("dhfg on a table", 14), "dhfg on a");
  EXPECT_EQ(first_words("coarse, fine", 8), "coarse");
  EXPECT_EQ(first_words("coarse fine", 6), "coarse");
  EXPECT_EQ(first_words("unbroken", 5), "unbro");
  EXPECT_EQ(first_words("gr\u00fcn", 3), "gr");  // no half of a letter
  EXPECT_EQ(first_words("", 3), "");
  using Lines = std::vector<std::string>;
  EXPECT_EQ(numbers::lines_of_words("one two three", 8), (Lines{"one two", "three"}));
  EXPECT_EQ(numbers::lines_of_words("unbroken word", 5), (Lines{"unbro", "ken", "word"}));
  EXPECT_EQ(numbers::lines_of_words("one", 3), Lines{"one"});
  EXPECT_EQ(numbers::lines_of_words("", 3), Lines{""});
}

// F is that of the tip where no rotary turns in a cut of the tooth, and inverse time where one does.
TEST(NcWriter, InverseTimeStandsWhereARotaryTurns) {
  for (const char* dialect : {"fanuc", "haas", "mitsubishi_m80", "linuxcnc"})
    for (const double swing : {0.0, 0.1}) {
      const machines::Machine m = with_dialect(trunnion(), dialect);
      const auto p = axis_program({sample_path(0.3, swing, 6)}, m, standing(), 2, true);
      ASSERT_TRUE(p) << p.error().message;
      text::NcHeader header;
      header.job_name = "sample";
      const auto text = write_nc(*p, *controls::dialect_of(m), header);
      ASSERT_TRUE(text) << text.error().message;
      EXPECT_EQ(text->text.find("G93") != std::string::npos, swing > 0) << dialect;
      const auto control = control_of(m, standing(), tools());
      double minutes = 0, asked = 0;
      const auto read = readback::execute_nc(text->text, "p", *control, [&](const readback::ExecutedMove& e) {
        if (!e.rapid) minutes += double(e.minutes);
      });
      ASSERT_TRUE(read) << read.error().text();
      for (const auto& tooth : p->operations[0].teeth)
        for (const auto& b : tooth.blocks) asked += b.kind == joints::BlockKind::feed ? b.minutes : 0;
      EXPECT_NEAR(minutes, asked, 1e-4 * asked) << dialect << swing;
    }
}

// Danger 7: a block that hardly moves X Y Z but turns keeps its time on a control that raises slow rates.
TEST(NcWriter, TinyLinearStepsKeepTheirTime) {
  path::ClPath path;
  path.operation_type = "finishing";
  path.spindle_rpm = 12000;
  // The tip nearly on the C axis, the axis of the tool turning: hardly any linear motion after the tilt is reached.
  const auto add = [&](double phi, double lift, path::MoveKind kind) {
    const Vec3 u = leaning(0.3, phi);
    path.records.push_back({Vec3(0, 0, 6) + lift * u + Vec3(1e-5 * phi, 0, 0), u, 0.0002, kind, 0, 0});
  };
  add(0, 10, path::MoveKind::rapid);
  path.records.push_back(path.records.back());
  path.records.back().kind = path::MoveKind::engage;
  path.records.back().tip.z() += 0.01;
  path.records.back().feed_mm_min = 10;
  for (int i = 1; i <= 20; ++i) {
    add(0.02 * i, 10, path::MoveKind::feed);
    path.records.back().feed_mm_min = 20;
  }
  machines::Machine m = trunnion();
  m.chain.table[0].max_speed = radians(60);
  const auto p = axis_program({path}, m, standing(), 1);
  ASSERT_TRUE(p) << p.error().message;
  const auto t = text::write_nc(*p, words_of("linuxcnc"), {});
  ASSERT_TRUE(t);
  const auto control = controls::control_of(m, standing(), tools());
  std::vector<double> expected, got;
  for (const auto& b : p->operations[0].teeth[0].blocks)
    if (b.kind == joints::BlockKind::feed) expected.push_back(b.minutes);
  const auto s = readback::execute_nc(t->text, "p.ngc", *control, [&](const readback::ExecutedMove& e) {
    if (!e.rapid) got.push_back(e.minutes);
  });
  ASSERT_TRUE(s) << s.error().text();
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i] / expected[i], 1, 0.01) << i;
}

TEST(NcWriter, FeedBeyondTheControlIsAnErrorNotAClamp) {
  auto p = axis_program({sample_path(0.3, 0.2)}, with_dialect(trunnion(), "fanuc"), standing(), 3);
  ASSERT_TRUE(p);
  EXPECT_TRUE(text::write_nc(*p, words_of("fanuc"), {}));
  p->operations[0].teeth[0].blocks[10].minutes = 1e-5;
  const auto refused = text::write_nc(*p, words_of("fanuc"), {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("exceeds 9999.999"), std::string::npos) << refused.error().message;
}

TEST(NcWriter, UnknownDialect) {
  const auto d = controls::dialect_of(with_dialect(trunnion(), "grbl"));
  ASSERT_FALSE(d);
  EXPECT_EQ(d.error().message, "dialect = \"grbl\" is not one of " + controls::list_of_names());
}

}  // namespace
}  // namespace toothpath
