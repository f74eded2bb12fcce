// LinuxCNC's own interpreter as the second opinion on the text that we write (tests/support/rs274.h).
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "tests/postproc/joints/trunnion_post.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;

/// What of a Fanuc program LinuxCNC would not understand: sub-programs as o-words, G69, the O number; M98 as a call.
std::string iso_subset(const std::string& fanuc) {
  std::istringstream in(fanuc);
  std::string main, subs, l, open;
  bool behind_end = false, in_main = false;
  while (std::getline(in, l)) {
    std::smatch m;
    if (l == "%") continue;
    if (std::regex_search(l, m, std::regex("^O(\\d+) "))) {
      if (in_main) {
        open = m[1];
        subs += "o" + open + " sub\n";
      }
      in_main = true;
      continue;
    }
    l = std::regex_replace(l, std::regex(" G69"), "");
    if (std::regex_search(l, m, std::regex("^M98 P(\\d+)"))) l = "o" + std::string(m[1]) + " call";
    if (l == "M99") l = "o" + open + " endsub";
    (behind_end ? subs : main) += l + "\n";
    if (l == "M30") behind_end = true;
  }
  return subs + main;
}

/// Where the words count from: C of SET_G92_OFFSET, the canonical form of G52.
void note_zero(const std::string& line, double& zero) {
  std::smatch m;
  if (std::regex_search(line, m, std::regex("SET_G92_OFFSET\\((?:[-0-9.]+, ){5}([-0-9.]+)"))) zero = std::stod(m[1]);
}

class Rs274 : public testing::TestWithParam<std::tuple<const char*, double, double, bool>> {};
INSTANTIATE_TEST_SUITE_P(Programs, Rs274,
                         testing::Values(std::tuple{"linuxcnc", 0.0, 0.0, false},
                                         std::tuple{"linuxcnc", 0.3, 0.4, false},
                                         std::tuple{"linuxcnc", 0.3, 0.4, true}, std::tuple{"fanuc", 0.3, 0.0, false},
                                         std::tuple{"fanuc", 0.3, 0.2, false}, std::tuple{"fanuc", 0.3, 0.2, true}));

// LinuxCNC executes the program to its end, and what it executes are the turned CL records in order, tooth by tooth.
TEST_P(Rs274, ExecutesTheClPathOfEveryTooth) {
  const auto& [dialect, lean, swing, expand] = GetParam();
  const machines::Machine m = with_dialect(trunnion(), dialect);
  const int z = 5;
  std::vector<path::ClPath> paths = {sample_path(lean, swing, 12), sample_path(lean, swing, 9, 1)};
  paths[1].tool = 1;
  const auto text = nc_text(paths, m, standing(), z, expand);
  ASSERT_TRUE(text) << text.error().message;
  const std::string program = std::string(dialect) == "fanuc" ? iso_subset(text->text) : text->text;
  const auto out = interpret(program, testing::UnitTest::GetInstance()->current_test_info()->name());
  ASSERT_EQ(out.exit, 0) << out.messages;

  std::array<std::size_t, 2> next{};  // record, over all teeth
  std::size_t feeds = 0;
  bool ended = false;
  int op = -1;
  double zero = 0;
  const std::regex motion(
      "STRAIGHT_(FEED|TRAVERSE)\\(([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\\)");
  for (const auto& l : out.lines) {
    std::smatch match;
    if (std::regex_search(l, match, std::regex("COMMENT\\(\"OP (\\d)"))) op = std::stoi(match[1]);
    if (l.find("PROGRAM_END") != std::string::npos) ended = true;
    note_zero(l, zero);
    if (!std::regex_search(l, match, motion) || op < 0 || match[1] != "FEED") continue;
    ++feeds;
    const auto o = static_cast<std::size_t>(op);
    const double length = tools()[o].length_mm;
    const Vec3 origin = standing().work_offset_at_mm;
    const auto pose = trunnion_forward(kTrunnion, std::stod(match[2]) + origin.x(), std::stod(match[3]) + origin.y(),
                                       std::stod(match[4]) + origin.z() + length, std::stod(match[5]),
                                       zero + std::stod(match[7]), length);
    const Vec3 tip = pose.tip - standing().origin_mm;
    const auto& records = paths[o].records;
    while (records[next[o] % records.size()].kind == path::MoveKind::rapid) ++next[o];
    const auto k = next[o] / records.size();
    const auto& r = records[next[o] % records.size()];
    const Eigen::AngleAxisd turn(2 * kPi * static_cast<double>(k) / z, Vec3::UnitZ());
    if ((tip - turn * r.tip).norm() < 2e-4 + tip.norm() * 1e-5 + (std::string(dialect) == "fanuc" ? 3e-3 : 0) &&
        (pose.axis - turn * r.axis).norm() < 1e-4)
      ++next[o];
  }
  EXPECT_TRUE(ended);
  for (std::size_t o = 0; o < 2; ++o) {
    const auto& records = paths[o].records;
    while (next[o] < records.size() * z && records[next[o] % records.size()].kind == path::MoveKind::rapid) ++next[o];
    EXPECT_EQ(next[o], records.size() * z) << "operation " << o << ": first record not met";
  }
  EXPECT_GE(feeds, static_cast<std::size_t>(z) * (2 * 14 + 2 * 11));
}

// The same program through both interpreters: joints of every move.
TEST_P(Rs274, AgreesWithOurReaderMoveByMove) {
  const auto& [dialect, lean, swing, expand] = GetParam();
  const machines::Machine m = with_dialect(trunnion(), dialect);
  const auto text = nc_text({sample_path(lean, swing, 15)}, m, standing(), 4, expand);
  ASSERT_TRUE(text);
  const auto out = interpret(std::string(dialect) == "fanuc" ? iso_subset(text->text) : text->text,
                             testing::UnitTest::GetInstance()->current_test_info()->name());
  ASSERT_EQ(out.exit, 0) << out.messages;
  const auto control = controls::control_of(m, standing(), tools());
  std::vector<readback::ExecutedMove> ours;
  const auto s =
      readback::execute_nc(text->text, "p", *control, [&](const readback::ExecutedMove& e) { ours.push_back(e); });
  ASSERT_TRUE(s) << s.error().text();
  const std::regex motion(
      "STRAIGHT_(FEED|TRAVERSE)\\(([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\\)");
  std::size_t i = 0;
  double zero = 0;
  for (const auto& l : out.lines) {
    std::smatch match;
    note_zero(l, zero);
    if (!std::regex_search(l, match, motion)) continue;
    ASSERT_LT(i, ours.size());
    const readback::ExecutedMove& e = ours[i++];
    EXPECT_EQ(e.rapid, match[1] == "TRAVERSE");
    if (!e.known || e.machine) continue;
    EXPECT_NEAR(e.joints[0] - 3, std::stod(match[2]), 6e-5);
    EXPECT_NEAR(e.joints[1] + 2, std::stod(match[3]), 6e-5);
    EXPECT_NEAR(e.joints[2] - 95, std::stod(match[4]), 6e-5);
    EXPECT_NEAR(e.joints[4], std::stod(match[5]), 6e-5);
    EXPECT_NEAR(e.joints[3], zero + std::stod(match[7]), 6e-5);
  }
  EXPECT_EQ(i, ours.size());
}

/// How X and Y are turned.
void note_turn(const std::string& line, double& turn) {
  std::smatch m;
  if (std::regex_search(line, m, std::regex("SET_XY_ROTATION\\(([-0-9.]+)"))) turn = std::stod(m[1]);
}

class Rs274Tcp : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WrittenOut, Rs274Tcp, testing::Bool());

// With TCP the words are the tip. LinuxCNC's interpreter knows no remaps: without the two codes it reads the same
// numbers. In the loop it turns X and Y by the work offset that the program writes, and moves the zero of C.
TEST_P(Rs274Tcp, AgreesAboutTipWordsAndFeeds) {
  const machines::Machine m = trunnion_with("linuxcnc", machines::TcpMode::angles);
  const auto text = nc_text({sample_path(0.3, 0.4, 12)}, m, standing(), 3, GetParam());
  ASSERT_TRUE(text) << text.error().message;
  ASSERT_EQ(text->text.find("G59.3\n") == std::string::npos, GetParam());
  const auto out = interpret(std::regex_replace(text->text, std::regex("M42[89]\n"), ""), "tcp");
  ASSERT_EQ(out.exit, 0) << out.messages;
  const auto control = controls::control_of(m, standing(), tools());
  std::vector<readback::ExecutedMove> ours;
  ASSERT_TRUE(
      readback::execute_nc(text->text, "p", *control, [&](const readback::ExecutedMove& e) { ours.push_back(e); }));
  const std::regex motion(
      "STRAIGHT_(FEED|TRAVERSE)\\(([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\\)");
  std::size_t i = 0, tips = 0;
  double zero = 0, turn = 0;
  for (const auto& l : out.lines) {
    std::smatch match;
    note_zero(l, zero);
    note_turn(l, turn);
    if (!std::regex_search(l, match, motion)) continue;
    ASSERT_LT(i, ours.size());
    const readback::ExecutedMove& e = ours[i++];
    EXPECT_EQ(e.rapid, match[1] == "TRAVERSE");
    if (!e.tcp) {
      EXPECT_EQ(turn, 0) << l;
      continue;
    }
    ++tips;
    const Vec3 words(std::stod(match[2]), std::stod(match[3]), std::stod(match[4]));
    const Vec3 tip = standing().work_offset_at_mm + Eigen::AngleAxisd(radians(turn), Vec3::UnitZ()) * words;
    // Four decimals of the turn, too.
    EXPECT_LT((e.tip - tip).norm(), 1e-4 + 1e-4 * words.norm() * radians(1)) << l;
    EXPECT_NEAR(e.joints[4], std::stod(match[5]), 6e-5);
    EXPECT_NEAR(e.joints[3], zero + std::stod(match[7]), 1.2e-4);
  }
  EXPECT_EQ(turn, 0);
  EXPECT_EQ(zero, 0);
  EXPECT_EQ(i, ours.size());
  EXPECT_GT(tips, 3u * 24u);
}

// The golden files that are plain ISO are programs for LinuxCNC too.
TEST(Rs274Golden, ReadsTheFiles) {
  for (const char* file :
       {"linuxcnc_joints.ngc", "linuxcnc_tcp.ngc", "linuxcnc_tcp_turned.ngc", "fanuc_joints.nc", "mitsubishi_m80.nc"}) {
    std::ifstream in(std::string(TOOTHPATH_SOURCE_DIR) + "/tests/golden/posts/" + file);
    ASSERT_TRUE(in) << file;
    std::stringstream text;
    text << in.rdbuf();
    const std::string program = std::regex_replace(text.str(), std::regex("M42[89]\n"), "");
    const bool percent = program.substr(0, 1) == "%";
    const auto out = interpret(percent ? iso_subset(program) : program, "golden");
    EXPECT_EQ(out.exit, 0) << file << ": " << out.messages;
    EXPECT_TRUE(std::any_of(out.lines.begin(), out.lines.end(), [](const std::string& l) {
      return l.find("PROGRAM_END") != std::string::npos;
    })) << file;
  }
}

}  // namespace
}  // namespace toothpath
