// Tilted planes in the words of the controls: the text is read back to the cutter locations of the plain form, and
// planted faults are found.
#include <gtest/gtest.h>

#include "postproc/joints/tooth_order.h"
#include "postproc/restart/proof.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

const std::vector<std::string> kControls = {"fanuc", "mitsubishi_m80", "siemens", "heidenhain"};
constexpr int kTeeth = 7;
const SourcePosition kAsked{"job.toml", 5, 1};

/// A trunnion: sense of its rotaries, and which axis tilts.
struct Table {
  int turn = -1, tilt = -1;
  bool about_y = false;
};

machines::Machine machine_with(const std::string& control, const Table& table = {}) {
  machines::Machine m = with_dialect(trunnion(), control);
  m.chain.table[0].sign = table.turn;
  m.chain.table[1].sign = table.tilt;
  m.chain.table[1].min_rad = radians(table.tilt < 0 ? -5 : -110);
  m.chain.table[1].max_rad = radians(table.tilt < 0 ? 110 : 5);
  if (table.about_y) {
    m.chain.table[1].letter = 'B';
    m.chain.table[1].direction = Vec3::UnitY();
  }
  return m;
}

std::vector<path::ClPath> fixed_paths() {
  std::vector<path::ClPath> paths = {sample_path(0.4, 0, 6, 0), sample_path(0, 0, 6, 1), sample_path(0.25, 0, 6, 2)};
  return paths;
}

struct Written {
  joints::AxisProgram axes;
  std::string text;
};

Result<Written> written(const machines::Machine& machine, bool planes, bool expand, bool shifted = true,
                        const std::vector<path::ClPath>& paths = fixed_paths()) {
  auto dialect = controls::dialect_of(machine);
  if (!dialect) return dialect.error();
  joints::AxisOptions o = axis_options(*dialect, machine);
  o.expand_teeth = o.expand_teeth || expand;
  if (planes) o.tilted_planes = kAsked;
  joints::Setup setup = standing();
  if (!shifted) setup.work_offset_at_mm = setup.origin_mm;
  auto axes = joints::AxisProgramTestAccess::build(paths, tools(), setup, machine, kTeeth, kBody, o);
  if (!axes) return axes.error();
  text::NcHeader header;
  header.wishes.restart_numbers = false;  // edits look for lines as they begin
  header.job_name = "planes";
  auto text = text::write_nc(*axes, *dialect, header);
  if (!text) return text.error();
  return Written{std::move(*axes), std::move(text->text)};
}

struct Seen {
  std::string refused, difference;
  bool copies = false;
  std::array<double, 5> least{}, greatest{};
  std::vector<path::ToolMotion> motions;
};

Seen seen(const machines::Machine& machine, const std::string& text, bool shifted = true) {
  joints::Setup setup = standing();
  if (!shifted) setup.work_offset_at_mm = setup.origin_mm;
  const auto control = control_of(machine, setup, tools());
  Seen out;
  const auto read = readback::read_back(text, "p", *control, machine, setup, {.teeth = kTeeth, .keep_all = true});
  if (!read) return out.refused = read.error().text(), out;
  out.copies = read->copies.copies;
  out.difference = read->copies.difference;
  out.least = read->least;
  out.greatest = read->greatest;
  for (const auto& trace : read->operations) {
    if (auto clear = readback::check_axis_groups(trace); !clear) out.refused = clear.error().text();
    auto m = readback::tool_motions(trace, read->copies, *control, machine, setup, kTeeth, {1e-4, 1e-4});
    if (!m) return out.refused = m.error().text(), out;
    out.motions.insert(out.motions.end(), m->begin(), m->end());
  }
  return out;
}

/// Greatest distance of the cuts of both, mm, and of the tool axes, times 100 mm.
double apart(const Seen& a, const Seen& b) {
  std::vector<const path::ToolMotion*> cuts[2];
  for (const auto& m : a.motions)
    if (!m.rapid) cuts[0].push_back(&m);
  for (const auto& m : b.motions)
    if (!m.rapid) cuts[1].push_back(&m);
  if (cuts[0].size() != cuts[1].size() || cuts[0].empty()) return 1e9;
  double worst = 0;
  for (std::size_t i = 0; i < cuts[0].size(); ++i)
    worst = std::max({worst, (cuts[0][i]->tip_to - cuts[1][i]->tip_to).norm(),
                      100 * (cuts[0][i]->axis_to - cuts[1][i]->axis_to).norm()});
  return worst;
}

/// Rounding of two texts, mm: X Y Z, and the rotaries at 120 mm.
double rounding(const std::string& control) {
  const auto format = words_of(control.c_str()).format;
  return 2 * (std::pow(10.0, -format.linear_decimals) + 120 * radians(std::pow(10.0, -format.rotary_decimals)));
}

TEST(TiltedPlanes, AreReadBackToTheCutterLocationsOfThePlainForm) {
  for (const auto& control : kControls)
    for (const Table& table : {Table{-1, -1}, Table{1, 1}, Table{1, -1}, Table{-1, 1, true}, Table{1, 1, true}})
      for (const bool expand : {false, true})
        for (const bool shifted : {false, true}) {
          SCOPED_TRACE(
              fmt::format("{} {} {} {} {} {}", control, table.turn, table.tilt, table.about_y, expand, shifted));
          const machines::Machine m = machine_with(control, table);
          const auto plain = written(m, false, expand, shifted), planes = written(m, true, expand, shifted);
          ASSERT_TRUE(plain) << plain.error().text();
          ASSERT_TRUE(planes) << planes.error().text();
          const Seen a = seen(m, plain->text, shifted), b = seen(m, planes->text, shifted);
          ASSERT_EQ(a.refused, "");
          ASSERT_EQ(b.refused, "") << planes->text.substr(0, 3000);
          EXPECT_TRUE(b.copies) << b.difference;
          EXPECT_LT(apart(a, b), rounding(control)) << planes->text.substr(0, 3000);
          for (std::size_t i = 0; i < 5; ++i) {
            EXPECT_NEAR(a.least[i], b.least[i], i == 3 ? 360.001 : 2e-3) << i;
            EXPECT_NEAR(a.greatest[i], b.greatest[i], i == 3 ? 360.001 : 2e-3) << i;
          }
        }
}

/// The first of `from` behind the first operation's comment, or all of them.
std::string edited(std::string text, const std::string& from, const std::string& to, bool all = false) {
  std::size_t at = text.find(from, text.find("OP 0 "));
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = all ? text.find(from, at + to.size()) : std::string::npos)
    text.replace(at, from.size(), to);
  return text;
}
struct Fault {
  const char* control;
  const char* from;
  const char* to;
  const char* refused;  ///< what the reader says; empty: the cut is elsewhere
};

// The tilt of operation 0 is 0.4 rad, 22.918 deg.
TEST(TiltedPlanes, PlantedFaultsAreFound) {
  const Fault faults[] = {
      {"fanuc", "J-22.918", "J-22.908", ""},
      {"fanuc", "I287.189", "I287.199", ""},
      {"fanuc", "I287.189 J-22.918", "I-22.918 J287.189", ""},
      {"fanuc", "K0.", "K0.01", ""},
      {"fanuc", "X0. Y0. Z0. I", "X0. Y0.02 Z0. I", ""},
      {"fanuc", "G53.1 P1\n", "", "an axis word in a tilted plane to which the rotaries have not been turned"},
      {"fanuc", "G53.1 P1\n", "G53.1\n", "G53.1 stands in a block of its own, with P1 or P2"},
      {"fanuc", "(TOOTH 1)\nG69\n", "(TOOTH 1)\n", "G68.2 in a tilted plane: G69 is missing ahead of it"},
      {"fanuc", "G69\nG94", "G94", "machine coordinates in a tilted plane"},
      {"fanuc", "G53.1 P1\n", "G53.1 P1\nG0 C10.\n", "a rotary word in a tilted plane"},
      {"fanuc", "K0.\nG53.1", "\nG53.1", "G68.2 stands in a block of its own, with X Y Z I J K"},
      {"siemens", ",-22.91831", ",-22.90831", ""},
      {"siemens", ",0,39,", ",0,45,", ""},  // angles about X and Z changed round
      {"siemens", ",0,39,", ",0,57,", ""},
      {"siemens", ",1,0,1)", ",0,0,1)", "CYCLE800 without a direction"},
      {"siemens", "CYCLE800()\nG94", "G94", "machine coordinates in a tilted plane"},
      {"heidenhain", "SPA-22.9183", "SPA-22.9083", ""},
      {"heidenhain", "SPA-22.9183 SPB+0", "SPA+0 SPB-22.9183", ""},
      {"heidenhain", "TURN FMAX SEQ+", "STAY SEQ+", "PLANE SPATIAL is read with TURN FMAX SEQ+"}};
  for (const Fault& f : faults) {
    SCOPED_TRACE(std::string(f.control) + " " + f.from + " -> " + f.to);
    const machines::Machine m = machine_with(f.control);
    const auto good = written(m, true, false, false);
    ASSERT_TRUE(good) << good.error().text();
    const Seen a = seen(m, good->text, false);
    ASSERT_EQ(a.refused, "");
    std::string text = edited(good->text, f.from, f.to);
    const Seen b = seen(m, text, false);
    if (*f.refused != 0) {
      EXPECT_NE(b.refused.find(f.refused), std::string::npos) << b.refused;
    } else if (b.refused.empty()) {
      EXPECT_GT(apart(a, b), 2 * rounding(f.control));
    }
  }
}

// The other pair of angles puts the tool where it was on the part: what differs is where the axes of the machine stand.
TEST(TiltedPlanes, TheOtherPairOfAnglesIsThatOfTheMachine) {
  const std::tuple<const char*, const char*, const char*> pairs[] = {{"fanuc", "G53.1 P1", "G53.1 P2"},
                                                                     {"mitsubishi_m80", "G53.1 P1", "G53.1 P2"},
                                                                     {"siemens", ",0,0,0,1,0,1)", ",0,0,0,-1,0,1)"},
                                                                     {"heidenhain", "SEQ+", "SEQ-"}};
  for (const auto& [control, from, to] : pairs) {
    const machines::Machine m = machine_with(control);
    const auto good = written(m, true, false);
    ASSERT_TRUE(good) << good.error().text();
    const Seen a = seen(m, good->text), b = seen(m, edited(good->text, from, to, true));
    ASSERT_EQ(a.refused + b.refused, "") << control;
    EXPECT_LT(apart(a, b), rounding(control)) << control;
    EXPECT_GT(a.least[4], -5) << control;
    EXPECT_LT(b.least[4], -20) << control << ": below the travel of A, which is -5 to 110 deg";
  }
}

TEST(TiltedPlanes, AllTeethHaveTheSameWords) {
  // A sub-program that is called for every tooth has no variable for the plane: there the teeth are written out.
  const auto called = written(machine_with("fanuc"), true, false);
  ASSERT_TRUE(called);
  EXPECT_FALSE(called->axes.loop);
  EXPECT_EQ(std::string(called->axes.no_loop), "the tilted plane of this control stands in the text of every tooth");
  for (const char* control : {"siemens", "heidenhain"}) {
    const machines::Machine m = machine_with(control);
    const auto loop = written(m, true, false), teeth = written(m, true, true);
    ASSERT_TRUE(loop && teeth) << control;
    EXPECT_TRUE(loop->axes.loop) << control;
    EXPECT_LT(loop->text.size() * 2, teeth->text.size()) << control;
    EXPECT_EQ(loop->text.find("G93"), std::string::npos) << control;
  }
}

TEST(TiltedPlanes, RestartsAreThoseOfTheWholeProgram) {
  for (const auto& control : kControls)
    for (const bool expand : {false, true})
      for (const int operation : {0, 1, 2}) {
        SCOPED_TRACE(fmt::format("{} {} {}", control, expand, operation));
        const machines::Machine m = machine_with(control);
        const auto whole = written(m, true, expand);
        ASSERT_TRUE(whole) << whole.error().text();
        const auto part = joints::program_from(whole->axes, operation, 5);
        ASSERT_TRUE(part) << part.error().text();
        text::NcHeader header;
        header.job_name = "planes";
        const auto text = text::write_nc(*part, *controls::dialect_of(m), header);
        ASSERT_TRUE(text) << text.error().text();
        const auto nc = control_of(m, standing(), tools());
        const auto proof = restart::prove_restart(whole->text, text->text, "p", *nc, {operation, 5, 5, kTeeth});
        ASSERT_TRUE(proof) << proof.error().text();
        EXPECT_TRUE(proof->same) << proof->difference << " line " << proof->line << " of " << proof->whole_line;
      }
}

std::string refusal(const machines::Machine& m, const std::vector<path::ClPath>& paths = fixed_paths()) {
  const auto text = written(m, true, false, true, paths);
  return text ? std::string() : text.error().text();
}

TEST(TiltedPlanes, WhatHasNoneIsRefusedWithItsPlace) {
  EXPECT_NE(refusal(machine_with("haas")).find("haas has no words for tilted planes"), std::string::npos)
      << refusal(machine_with("haas"));
  EXPECT_NE(refusal(machine_with("linuxcnc")).find("linuxcnc has no words for tilted planes"), std::string::npos);
  machines::Machine tcp = machine_with("siemens");
  tcp.tcp = machines::TcpMode::angles;
  EXPECT_EQ(refusal(tcp), "");
  const std::string turning = refusal(tcp, {sample_path(0.3, 0.2, 4)});
  EXPECT_NE(turning.find("job.toml:5:1: error: tilted_planes: operation 0 record 2 turns C by"), std::string::npos)
      << turning;
  EXPECT_NE(turning.find("so that it is written with TCP"), std::string::npos) << turning;
  machines::Machine nutating = machine_with("siemens");
  nutating.chain.table[1].direction = Vec3(0, 1, 1).normalized();
  EXPECT_NE(refusal(nutating).find("job.toml:5:1: error: tilted_planes: they need a table with two rotaries"),
            std::string::npos)
      << refusal(nutating);
  machines::Machine head = machine_with("heidenhain");
  head.chain.head = {head.chain.table[1]};
  head.chain.table.pop_back();
  EXPECT_NE(refusal(head).find("they need a table with two rotaries"), std::string::npos) << refusal(head);
}

// A control whose machine has no such table refuses the words, as does one without planes.
TEST(TiltedPlanes, WordsWithoutAPlaneOfTheMachineAreRefused) {
  const machines::Machine m = machine_with("fanuc");
  const auto good = written(m, true, false);
  ASSERT_TRUE(good);
  EXPECT_NE(seen(machine_with("haas"), good->text).refused.find("G68.2 is not in the dialect"), std::string::npos);
  machines::Machine head = m;
  head.chain.head = {head.chain.table[1]};
  head.chain.table.pop_back();
  EXPECT_NE(seen(head, good->text).refused.find("G68.2 on a machine without two rotaries in its table"),
            std::string::npos)
      << seen(head, good->text).refused;
}

}  // namespace
}  // namespace toothpath
