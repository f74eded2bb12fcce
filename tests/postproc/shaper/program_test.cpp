// The emitted text against the rules of the output, read back by a reader that shares no code with the writer; planted
// faults; and LinuxCNC's own interpreter as second opinion.
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "postproc/shaper/program.h"
#include "tests/postproc/shaper/case.h"

namespace toothpath::test {
namespace {

std::vector<std::string> faults_in(const std::string& text, const ShaperFacts& facts) {
  return shaper_program_faults(read_shaper_program(text), facts);
}
TEST(ShaperProgram, KeepsEveryRule) {
  const auto w = shaper_work();
  const auto facts = facts_of(w, 0.5, 359, +1);
  const auto text = shaper::shaper_program_text(shaper_setup(w, shaper_machine()));
  EXPECT_EQ(joined(faults_in(text, facts)), "");
  const auto program = read_shaper_program(text);
  const auto strokes = cutting_strokes(program, facts);
  ASSERT_EQ(strokes.size(), std::size_t(338 + 8294));
  // One whole turn between the last infeed stroke and the last stroke, to the last printed digit.
  EXPECT_NEAR(strokes.back().c_to - strokes[337].c_to, 360, 1.01e-5);
  EXPECT_NEAR(strokes.back().a_to - strokes[337].a_to, 360.0 * 88 / 25, 1.01e-5);
  // After strokes_turn strokes from the start the angles are exact numbers.
  EXPECT_EQ(strokes[8293].c_to, 360);
  EXPECT_EQ(strokes[8293].a_to, 1267.2);
}

TEST(ShaperProgram, OtherJobsKeepTheRulesToo) {
  for (const int trial : {0, 1, 2, 3}) {
    auto w = shaper_work();
    auto machine = shaper_machine();
    double n = 359;
    if (trial == 0) w.gear.offset_mm = -15;
    if (trial == 1) w.gear.offset_mm = 0, w.shaping.circular_feed_mm = 0.37, w.shaping.radial_feed_mm = 6.75;
    if (trial == 2) machine.axes['Z'].max_speed = 17500;  // uneven split of the double stroke
    if (trial == 3) machine.stroke_steps = {60.5, 97.3}, n = 97.3, w.shaping.radial_feed_mm = 0.75;
    const auto text = shaper::shaper_program_text(shaper_setup(w, machine));
    EXPECT_EQ(joined(faults_in(text, facts_of(w, 0.5, n, +1))), "") << "trial " << trial;
  }
}

TEST(ShaperProgram, SignsOfTheAxesReverseTheSense) {
  const auto w = shaper_work();
  for (const char* a : {"1", "-1"})
    for (const char* c : {"1", "-1"}) {
      const auto s = shaper_setup(w, shaper_machine(a, c));
      const int sense = std::atoi(a) * std::atoi(c);
      EXPECT_EQ(s.sense, sense);
      EXPECT_EQ(joined(faults_in(shaper::shaper_program_text(s), facts_of(w, 0.5, 359, sense))), "");
      EXPECT_NE(faults_in(shaper::shaper_program_text(s), facts_of(w, 0.5, 359, -sense)).size(), 0u);
    }
}

TEST(ShaperProgram, SameSetupSameBytes) {
  const auto w = shaper_work();
  EXPECT_EQ(shaper::shaper_program_text(shaper_setup(w, shaper_machine())),
            shaper::shaper_program_text(shaper_setup(w, shaper_machine())));
}

TEST(ShaperProgram, NamesCannotBreakOutOfTheComment) {
  auto w = shaper_work();
  w.job_name = "x) G0 X-5 (\nG0 Z0 \xc3\xa4" + std::string(400, 'n');
  EXPECT_EQ(joined(faults_in(shaper::shaper_program_text(shaper_setup(w, shaper_machine())), facts_of(w, 0.5, 359, 1))),
            "");
}

// Each fault is one that a wrong writer or a damaged file could produce; the checker must see it.
struct Planted {
  const char* name;
  std::function<void(std::vector<std::string>&)> plant;
};

std::size_t line_of(const std::vector<std::string>& lines, const std::string& start, int nth) {
  for (std::size_t k = 0; k < lines.size(); ++k)
    if (lines[k].rfind(start, 0) == 0 && --nth == 0) return k;
  ADD_FAILURE() << "no line " << start;
  return 0;
}
/// Adds to the number after `letter`.
void shift_word(std::string& line, char letter, double by) {
  const auto at = line.find(letter) + 1;
  const auto stop = line.find(' ', at);
  char text[40];
  std::snprintf(text, sizeof text, "%.5f", std::strtod(line.c_str() + at, nullptr) + by);
  line.replace(at, (stop == std::string::npos ? line.size() : stop) - at, text);
}

TEST(ShaperProgram, PlantedFaultsAreFound) {
  const auto w = shaper_work();
  const auto facts = facts_of(w, 0.5, 359, +1);
  const auto good = shaper::shaper_program_text(shaper_setup(w, shaper_machine()));
  const std::vector<Planted> faults = {
      {"two units of the last digit of C", [](auto& l) { shift_word(l[line_of(l, "G1 Z", 4001)], 'C', 2e-5); }},
      {"two units of the last digit of A", [](auto& l) { shift_word(l[line_of(l, "G1 Z", 7777)], 'A', 2e-5); }},
      {"wrong sense",
       [](auto& l) {
         for (auto& line : l)
           if (const auto at = line.find(" C"); line.rfind("G1 Z", 0) == 0 && at != std::string::npos)
             line.insert(at + 2, "-");
       }},
      {"angles added up from rounded steps",
       [](auto& l) {
         char text[40];
         int j = 0;
         for (auto& line : l)
           if (const auto at = line.find(" C"); line.rfind("G1 Z", 0) == 0 && at != std::string::npos) {
             std::snprintf(text, sizeof text, " C%.5f", ++j * 0.0434);  // 360/8294 = 0.043405..
             line.replace(at, line.find(" F") - at, text);
           }
       }},
      {"infeed at the wrong end",
       [](auto& l) {
         const auto k = line_of(l, "G1 Z", 21);  // lift and approach exchanged
         std::swap(l[k + 1], l[k + 3]);
       }},
      {"no lift", [](auto& l) { l.erase(l.begin() + std::ptrdiff_t(line_of(l, "G1 Z", 4001) + 1)); }},
      {"a dropped double stroke",
       [](auto& l) {
         const auto k = std::ptrdiff_t(line_of(l, "G1 Z", 4001) & ~std::size_t{0});
         l.erase(l.begin() + k, l.begin() + k + 4);
       }},
      {"F of one block times 60", [](auto& l) { shift_word(l[line_of(l, "G1 Z", 901)], 'F', 359 * 2 * 59); }},
      {"F missing",
       [](auto& l) {
         auto& s = l[line_of(l, "G1 Z", 901)];
         s.erase(s.find(" F"));
       }},
      {"G93 missing", [](auto& l) { l.erase(l.begin() + std::ptrdiff_t(line_of(l, "G93", 1))); }},
      {"work turns on the return", [](auto& l) { l[line_of(l, "G1 Z", 902)] += " C100"; }},
      {"rapid into the work",
       [](auto& l) {
         auto& s = l[line_of(l, "G1 X", 1)];
         s[1] = '0';
       }},
      {"offset slide of the other sign", [](auto& l) { l[line_of(l, "G0 Y", 1)] = "G0 Y-15"; }},
      {"offset slide moved while cutting",
       [](auto& l) { l.insert(l.begin() + std::ptrdiff_t(line_of(l, "G1 Z", 51)), "G1 Y15 F100"); }},
      {"first motion is not clear", [](auto& l) { std::swap(l[line_of(l, "G53 G0 X", 1)], l[line_of(l, "G0 Z", 1)]); }},
      {"not lifted at the end", [](auto& l) { l.erase(l.end() - 2); }},
      {"stroke away before the lift at the end", [](auto& l) { l.insert(l.end() - 2, "G1 Z300 F100"); }},
      {"M2 missing", [](auto& l) { l.pop_back(); }},
      {"text after M2", [](auto& l) { l.push_back("G0 X0"); }},
      {"safe start incomplete", [](auto& l) { l[0] = "G21 G17 G90 G94 G40 G80"; }},
  };
  for (const auto& fault : faults) {
    std::vector<std::string> lines;
    std::istringstream in(good);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    fault.plant(lines);
    const std::string text = joined(lines);
    ASSERT_NE(text, good) << fault.name;
    EXPECT_FALSE(faults_in(text, facts).empty()) << fault.name << " was not found";
  }
}

/// The program through LinuxCNC's interpreter: X Y Z A C of every feed and rapid motion it understood.
struct Interpreted {
  int exit_code = -1;
  std::vector<std::array<double, 5>> positions;
  std::vector<bool> rapid;
};
Interpreted interpreted_by_linuxcnc(const std::string& text, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  fs::create_directories(folder);
  std::ofstream(folder / "in.ngc") << text;
  std::ofstream(folder / "tool.tbl") << "";
  const std::string command = "cd '" + folder.string() + "' && HOME='" + folder.string() + "' timeout 60 '" +
                              TOOTHPATH_SOURCE_DIR "/.deps/rs274/rs274' -g -t tool.tbl in.ngc out.txt > log.txt 2>&1";
  Interpreted result;
  const int status = std::system(command.c_str());
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::ifstream out(folder / "out.txt");
  for (std::string line; std::getline(out, line);) {
    const auto feed = line.find("STRAIGHT_FEED("), rapid = line.find("STRAIGHT_TRAVERSE(");
    if (feed == std::string::npos && rapid == std::string::npos) continue;
    std::array<double, 6> v{};
    if (std::sscanf(line.c_str() + line.find('(', feed == std::string::npos ? rapid : feed),
                    "(%lf, %lf, %lf, %lf, %lf, %lf", &v[0], &v[1], &v[2], &v[3], &v[4], &v[5]) != 6) {
      ADD_FAILURE() << line;
      break;
    }
    result.positions.push_back({v[0], v[1], v[2], v[3], v[5]});
    result.rapid.push_back(rapid != std::string::npos);
  }
  fs::remove_all(folder);
  return result;
}

TEST(ShaperProgram, LinuxCncReadsItToTheEnd) {
  ASSERT_TRUE(std::filesystem::exists(TOOTHPATH_SOURCE_DIR "/.deps/rs274/rs274"))
      << "LinuxCNC's rs274 is missing: run tools/get_rs274.sh";
  const auto folder = std::filesystem::temp_directory_path() / ("shaper_rs274_" + std::to_string(::getpid()));
  for (const bool reversed : {false, true}) {
    const auto text =
        shaper::shaper_program_text(shaper_setup(shaper_work(), shaper_machine("1", reversed ? "-1" : "1")));
    const auto seen = interpreted_by_linuxcnc(text, folder);
    ASSERT_EQ(seen.exit_code, 0);
    const auto moves = read_shaper_program(text).moves;
    ASSERT_EQ(seen.positions.size(), moves.size());
    double worst = 0;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      EXPECT_EQ(seen.rapid[k], moves[k].rapid) << "line " << moves[k].line;
      // Nothing is known of an axis before its first word.
      for (std::size_t axis = 0; axis < 5; ++axis)
        worst = std::max(worst, std::abs(seen.positions[k][axis] - moves[k].to[axis]));
    }
    EXPECT_LE(worst, 6e-5);  // rs274 prints 4 decimals
  }
  // The interpreter is awake: it refuses a program with a broken block.
  auto broken = shaper::shaper_program_text(shaper_setup(shaper_work(), shaper_machine()));
  broken.insert(broken.find("G1 Z"), "G1 Z Z1\n");
  EXPECT_NE(interpreted_by_linuxcnc(broken, folder).exit_code, 0);
}

}  // namespace
}  // namespace toothpath::test
