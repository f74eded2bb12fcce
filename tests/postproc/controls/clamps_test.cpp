// Clamps of the rotaries in every form of output: released ahead of every turn, held in the cuts where they stand; the
// reader finds what is left out.
#include <gtest/gtest.h>

#include "machines/machine_file.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/readback/conditions.h"
#include "postproc/readback/scanner.h"
#include "postproc/text/clamps.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;
using readback::ExecutedMove;

constexpr int kClampTeeth = 5;

machines::Machine clamped(const PostForm& form) {
  machines::Machine m = machine_of(form);
  const std::string d = form.dialect;
  if (d == "apt") return m;
  const bool linuxcnc = d == "linuxcnc", haas = d == "haas";
  m.chain.table[0].clamp = {linuxcnc ? "M64 P0"
                            : haas   ? "M12"
                                     : "M10",
                            linuxcnc ? "M65 P0"
                            : haas   ? "M13"
                                     : "M11",
                            0.5 / 60, 0.25 / 60};
  m.chain.table[1].clamp = {linuxcnc ? "M101"
                            : haas   ? "M10"
                                     : "M68",
                            linuxcnc ? "M102"
                            : haas   ? "M11"
                                     : "M69",
                            1.0 / 60, 2.0 / 60};
  return m;
}

std::vector<path::ClPath> paths_of(const PostForm& form) {
  return {sample_path(0.3, form.swing, 4, 0), sample_path(0.2, 0, 4, 1)};
}

Result<text::NcText> text_of(const PostForm& form, const machines::Machine& m, text::Stops stops = text::Stops::none,
                             std::optional<joints::ProgramRestart> restart = {}) {
  const auto dialect = controls::dialect_of(m);
  if (!dialect) return dialect.error();
  joints::AxisOptions o = controls::axis_options(*dialect, m);
  o.expand_teeth = form.expand;
  auto program = joints::AxisProgramTestAccess::build(paths_of(form), tools(), standing(), m, kClampTeeth, kBody, o);
  if (!program) return program.error();
  if (restart) {
    program = joints::program_from(std::move(*program), restart->operation, restart->tooth);
    if (!program) return program.error();
  }
  text::NcHeader header;
  header.job_name = "clamps";
  header.wishes.stops = stops;
  return write_nc(*program, *dialect, header);
}

struct Executed {
  std::string refused, warnings;
  double waits = 0;                                // s
  std::size_t held[2] = {0, 0}, free[2] = {0, 0};  // feeds in which a rotary stands
};

Executed executed(const machines::Machine& m, const std::string& text) {
  const auto control = controls::control_of(m, standing(), tools());
  readback::AskedConditions asked;
  readback::ConditionJudge judge(m, *control, asked);
  Executed out;
  ExecutedMove before;
  const auto s = readback::execute_nc(text, "p", *control, [&](const ExecutedMove& e) {
    out.waits += double(e.dwell_min) * 60;
    judge.add(e);
    for (std::size_t k = 0; k < 2 && !e.rapid && e.known; ++k)
      if (e.joints[3 + k] == before.joints[3 + k]) ++((e.clamped & (8U << k)) != 0 ? out.held : out.free)[k];
    before = e;
  });
  if (!s) out.refused = s.error().text();
  for (const auto& w : judge.finish().warnings)
    if (w.find("clamp") != std::string::npos) out.warnings += w + "\n";
  return out;
}

class Clamps : public testing::TestWithParam<PostForm> {};
INSTANTIATE_TEST_SUITE_P(Forms, Clamps, testing::ValuesIn(post_forms()));

TEST_P(Clamps, AreReleasedForEveryTurnAndHeldInTheCuts) {
  const PostForm form = GetParam();
  const machines::Machine m = clamped(form);
  for (const auto stops : {text::Stops::none, text::Stops::teeth}) {
    if (form.dialect == std::string("apt")) continue;
    const auto text = text_of(form, m, stops);
    ASSERT_TRUE(text) << text.error().text();
    const Executed e = executed(m, text->text);
    EXPECT_EQ(e.refused, "") << text->text;
    EXPECT_EQ(e.warnings, "") << text->text;
    for (std::size_t k = 0; k < 2; ++k) {
      if (form.tcp == machines::TcpMode::vectors) {
        EXPECT_EQ(e.held[k], 0U) << k << ": the control makes angles of its own";
        continue;
      }
      EXPECT_GT(e.held[k], 0U) << k;
      if (form.swing == 0) { EXPECT_EQ(e.free[k], 0U) << k; }
    }
    // Begun at another tooth.
    for (const int operation : {0, 1}) {
      const auto part = text_of(form, m, stops, joints::ProgramRestart{operation, 3});
      ASSERT_TRUE(part) << part.error().text();
      const Executed r = executed(m, part->text);
      EXPECT_EQ(r.refused + r.warnings, "") << part->text;
    }
  }
}

// Every word left out is a refusal or a warning, or it says again what holds.
TEST_P(Clamps, WordsThatAreLeftOutAreFound) {
  const PostForm form = GetParam();
  if (form.dialect == std::string("apt") || form.dialect == std::string("heidenhain")) return;  // counts its blocks
  if (form.tcp == machines::TcpMode::vectors) return;                                           // released all the time
  const machines::Machine m = clamped(form);
  const auto text = text_of(form, m);
  ASSERT_TRUE(text) << text.error().text();
  std::size_t refused = 0, warned = 0, same = 0;
  const Executed good = executed(m, text->text);
  std::vector<std::string> lines;
  for (const std::string_view line : readback::lines_of(text->text)) lines.emplace_back(line);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const bool on[2] = {lines[n] == m.chain.table[0].clamp->on, lines[n] == m.chain.table[1].clamp->on};
    const bool off[2] = {lines[n] == m.chain.table[0].clamp->off, lines[n] == m.chain.table[1].clamp->off};
    if (!on[0] && !on[1] && !off[0] && !off[1]) continue;
    std::string without;
    for (std::size_t i = 0; i < lines.size(); ++i) without += i == n ? std::string() : lines[i] + "\n";
    const Executed e = executed(m, without);
    const bool fewer = e.held[0] < good.held[0] || e.held[1] < good.held[1];
    if (!e.refused.empty()) {
      ++refused;
      EXPECT_TRUE(off[0] || off[1]) << e.refused;
      EXPECT_NE(e.refused.find(off[0] ? "C turns" : "A turns"), std::string::npos) << e.refused;
      EXPECT_NE(e.refused.find(off[0] ? m.chain.table[0].clamp->off : m.chain.table[1].clamp->off), std::string::npos);
    } else if (!e.warnings.empty()) {
      ++warned;
      EXPECT_TRUE(on[0] || on[1]) << e.warnings;
    } else {
      ++same;
      EXPECT_FALSE(fewer) << "line " << n + 1 << " " << lines[n];
    }
  }
  EXPECT_GT(refused, 0U);
  EXPECT_GT(warned, 0U);
}

// What the plan counts is what the text waits.
TEST_P(Clamps, TheirTimesCount) {
  const PostForm form = GetParam();
  if (form.dialect == std::string("apt")) return;
  const machines::Machine m = clamped(form);
  const auto dialect = controls::dialect_of(m);
  ASSERT_TRUE(dialect);
  joints::AxisOptions o = controls::axis_options(*dialect, m);
  o.expand_teeth = form.expand;
  auto program = joints::AxisProgramTestAccess::build(paths_of(form), tools(), standing(), m, kClampTeeth, kBody, o);
  ASSERT_TRUE(program) << program.error().text();
  for (const auto stops : {text::Stops::none, text::Stops::teeth}) {
    text::note_clamp_times(*program, *dialect, stops == text::Stops::teeth);
    text::NcHeader header;
    header.wishes.stops = stops;
    const auto text = write_nc(*program, *dialect, header);
    ASSERT_TRUE(text);
    if (form.tcp != machines::TcpMode::vectors) { EXPECT_GT(program->clamp_minutes, kClampTeeth * 0.5 / 60); }
    EXPECT_NEAR(executed(m, text->text).waits, program->clamp_minutes * 60, 1e-3) << text->text;
  }
}

TEST(ClampWords, StandAlone) {
  const PostForm forms[] = {{"fanuc", machines::TcpMode::none, 0, true},
                            {"siemens", machines::TcpMode::none, 0, true},
                            {"linuxcnc", machines::TcpMode::none, 0, true}};
  for (const PostForm& form : forms) {
    const machines::Machine m = clamped(form);
    const std::string good = text_of(form, m)->text, on = m.chain.table[1].clamp->on;  // a motion follows
    std::string text = good;
    const std::size_t at = text.find("\n" + on + "\n");
    ASSERT_NE(at, std::string::npos);
    text.erase(at + 1 + on.size(), 1);
    text.insert(at + 1 + on.size(), " ");
    EXPECT_NE(executed(m, text).refused.find("a block of its own"), std::string::npos) << executed(m, text).refused;
  }
}

TEST(ClampWords, ATurnOfAClampedAxisNamesHowFarAndWhatReleasesIt) {
  const PostForm form{"fanuc", machines::TcpMode::none, 0, true};
  const machines::Machine m = clamped(form);
  std::string text = text_of(form, m)->text;
  const std::size_t tooth = text.find("(TOOTH 1)"), at = text.find("M11\n", tooth);
  ASSERT_NE(at, std::string::npos);
  text.erase(at, 4);
  const std::string refused = executed(m, text).refused;
  EXPECT_NE(refused.find("C turns by 72.0000 deg while it is clamped, limit 0: M11 ahead of the block releases it"),
            std::string::npos)
      << refused;
  EXPECT_EQ(refused.substr(0, 2), "p:");
}

// LinuxCNC's interpreter takes the outputs as they stand.
TEST(ClampWords, LinuxCncSwitchesItsOutputs) {
  const PostForm form{"linuxcnc", machines::TcpMode::none, 0, false};
  machines::Machine m = clamped(form);
  m.chain.table[1].clamp = {"M64 P1", "M65 P1"};
  m.post.tcp_on.clear();  // codes of a site that the interpreter lacks
  m.post.tcp_off.clear();
  const auto text = text_of(form, m);
  ASSERT_TRUE(text) << text.error().text();
  EXPECT_EQ(executed(m, text->text).refused, "");
  const Canonical canonical = interpret(text->text, "clamps");
  EXPECT_EQ(canonical.exit, 0) << canonical.messages;
  std::size_t on = 0, off = 0;
  for (const auto& line : canonical.lines) {
    on += line.find("SET_AUX_OUTPUT_BIT") != std::string::npos ? 1 : 0;
    off += line.find("CLEAR_AUX_OUTPUT_BIT") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(on, 2U * kClampTeeth);  // both axes, every tooth of each operation
  EXPECT_GE(off, kClampTeeth + 2U);
}

/// What is wrong with a machine file that has these words.
std::string fault(const char* machine, const std::string& lines) {
  std::string text;
  const auto path = machines::find_machine_file(machine, ".", "");
  if (!path) return path.error().text();
  const auto file = machines::open_machine_file(*path);
  if (!file) return file.error().text();
  text = file->text;
  const std::string table = "[axes.C]\n";
  text.insert(text.find(table) + table.size(), lines);
  const auto read = controls::read_machine_of_text(text, "m.toml");
  std::string out;
  for (const auto& e : read.errors) out += e.text() + "\n";
  return out;
}

TEST(ClampWords, OfTheMachineFileAreJudgedByTheControl) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"fanuc_ac", "clamp = [\"M10\", \"M11\"]\nclamp_time = [0.5, 0.3]\n", ""},
      {"haas_ac", "clamp = [\"M10\", \"M11\"]\n", ""},
      {"xyzac_large", "clamp = [\"M64 P3\", \"M65 P3\"]\n", ""},
      {"xyzac_large", "clamp = [\"M110\", \"M111\"]\n", ""},
      {"xyzac_large", "clamp = [\"M10\", \"M11\"]\n", "axes.C.clamp: \"M10\" is none of M100 to M199"},
      {"xyzac_large", "clamp = [\"M64 P64\", \"M65 P3\"]\n", "axes.C.clamp: \"M64 P64\" is none of M100 to M199"},
      {"fanuc_ac", "clamp = [\"M64 P0\", \"M65 P0\"]\n", "axes.C.clamp: \"M64 P0\" is no M word such as M7"},
      {"fanuc_ac", "clamp = [\"M8\", \"M11\"]\n", "axes.C.clamp: M8 switches flood"},
      {"fanuc_ac", "clamp = [\"M10\", \"M10\"]\n", "axes.C.clamp: M10 cannot both clamp and release"},
      {"fanuc_ac", "clamp = [\"M10\"]\n", "has 1 word"},
      {"fanuc_ac", "clamp = [\"M10\", \"M30\"]\n", "axes.C.clamp: M30 means something else to dialect \"fanuc\""},
      {"siemens_ac", "clamp = [\"M3\", \"M11\"]\n", "axes.C.clamp: M3 means something else to dialect \"siemens\""},
      {"heidenhain_ac", "clamp = [\"M126\", \"M11\"]\n", "axes.C.clamp: M126 means something else"},
      {"apt_free", "clamp = [\"M10\", \"M11\"]\n", "axes.C.clamp: dialect \"apt\" has no words of a builder"},
      {"fanuc_ac", "clamp_time = [0.5, 0.3]\n", "axes.C.clamp_time needs axes.C.clamp"},
      {"fanuc_ac", "clamp = [\"M10\", \"M11\"]\nclamp_time = [500, 0.3]\n", "clamp_time"}};
  for (const auto& [machine, lines, expected] : cases) {
    const std::string found = fault(machine, lines);
    if (*expected == 0) {
      EXPECT_EQ(found, "") << machine << " " << lines;
    } else {
      EXPECT_NE(found.find(expected), std::string::npos) << machine << " " << lines << " gave " << found;
    }
  }
}

}  // namespace
}  // namespace toothpath
