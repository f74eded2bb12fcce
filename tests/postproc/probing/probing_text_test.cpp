// The probing program of every control, walked by a reader of this test: where the ball goes, how, and what it logs.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <sstream>

#include "postproc/probing/probing.h"

#include "postproc/controls/registry.h"
#include "tests/support/random.h"
#include "tests/support/rs274.h"
#include "tests/support/siemens_probe.h"

namespace toothpath::test {
namespace {

using probing::ProbeProgram;

constexpr double kBall = 2;  // mm

ProbeProgram sample() {
  ProbeProgram p;
  p.job_name = "ring";
  p.machine_name = "trial";
  p.work_offset = "G54";
  p.tool = 1;
  p.number = 7992;
  p.ball_diameter_mm = kBall;
  p.probe_length_mm = 100;
  p.feed = 50;
  p.guarded_feed = 1000;
  p.top_mm = 399.9;
  p.clear_mm = 12.5;
  const std::vector<std::pair<char, double>> zero = {{'A', 0}, {'C', 0}}, tilted = {{'A', -47.5}, {'C', 30.25}};
  p.touches = {{1, "ZONE 0 TOOTH 0 FLANK +1", {62, -1.25, -2.5}, {}, {61.8, -3.1234, -3.25}, zero},
               {2, "ZONE 0 TOOTH 1 FLANK -1", {62, 1, -2.5}, {}, {62.25, 2.875, -3.5}, zero},
               {3, "ZONE 0 TOOTH 15 FLANK +1", {-0.00001, 62, -2.5}, {}, {-1.5, 62.5, -3}, zero},
               {4, "HALF 0 SPACE 2 WALL L", {12, -33.5, -2.5}, {}, {13.5, -33, -3}, tilted},
               {5, "HALF 0 SPACE 2 WALL U", {12, -30.5, -2.5}, {}, {10.5, -31, -3}, tilted},
               {6, "TOP OF THE BLANK", {20, -10, 3}, {}, {20, -10, 0.5}, tilted},
               {7, "RIM OF THE BLANK", {66, -0.5, -2.5}, {}, {63.5, -0.5, -2.5}, tilted},
               {8, "RIM OF THE BLANK", {-39.6, 52.8, -2.5}, {}, {-38.1, 50.8, -2.5}, tilted}};
  for (auto& touch : p.touches) touch.meets = touch.start + (touch.past - touch.start).normalized();
  return p;
}

/// A walk: places of the ball and what leads there.
struct Step {
  char kind;  ///< 'r' rapid, 'g' guarded, 't' touch, 'c' by a cycle, 'b' feed away
  Vec3 to;
  double feed;
};

struct Walk {
  std::vector<Step> steps;
  std::vector<std::pair<double, double>> poses;  ///< A and C, in the order in which they are gone to
  bool top_before_each = true;                   ///< .. and the probe was at its top
  std::vector<int> logged;                       ///< numbers, in order
};

std::optional<double> value_of(const std::string& line, const std::string& letter) {
  std::smatch m;
  if (!std::regex_search(line, m, std::regex("(?:^|[ A-Z=])" + letter + "=?([+-]?[0-9]+\\.[0-9]+)"))) return {};
  return std::stod(m[1]);
}

Vec3 moved(Vec3 at, const std::string& line) {
  for (int k = 0; k < 3; ++k)
    if (const auto v = value_of(line, std::string(1, "XYZ"[k]))) at[k] = *v;
  return at;
}

Walk walk_of(const std::string& text) {
  Walk out;
  Vec3 at(NAN, NAN, NAN), incremental = Vec3::Zero();
  double feed = 0, turn = 0;
  std::istringstream in(text);
  std::smatch m;
  bool at_top = false;
  for (std::string line; std::getline(in, line);) {
    const bool to_top = (line.find("G53") != std::string::npos || line.find("SUPA") != std::string::npos ||
                         line.find("M91") != std::string::npos) &&
                        line.find("399.9") != std::string::npos;
    if (const auto a = value_of(line, "A"), c = value_of(line, "C"); a && c && line[0] != '(') {
      out.poses.emplace_back(*a, *c);
      out.top_before_each = out.top_before_each && at_top;
    }
    at_top = to_top;
    if (line.find("G53") != std::string::npos || line.find("SUPA") != std::string::npos ||
        line.find("M91") != std::string::npos || (line[0] == '(' && line.rfind("(LOG,", 0) != 0) || line[0] == ';')
      continue;
    if (const auto f = value_of(line, "F")) feed = *f;
    else if (std::regex_search(line, m, std::regex(" F([0-9]+)(?: |$)"))) feed = std::stod(m[1]);
    if (std::regex_match(line, m, std::regex(R"(o7001 call \[(\S+)\] \[(\S+)\] \[(\S+)\] \[(\S+)\])"))) {
      at = {std::stod(m[1]), std::stod(m[2]), std::stod(m[3])};
      out.steps.push_back({'g', at, std::stod(m[4])});
    } else if (line.rfind("G38.2 ", 0) == 0 || line.rfind("G31 ", 0) == 0) {
      out.steps.push_back({'t', moved(at, line), feed});
    } else if (line.rfind("G65 P9810 ", 0) == 0 || (line.rfind("MEAS=1", 0) == 0)) {
      const bool touches =
          line.rfind("MEAS=1", 0) == 0 && line.find("X=") != std::string::npos && line.find("Z=") != std::string::npos;
      const Vec3 to = moved(at, line);
      out.steps.push_back({touches ? 't' : 'g', to, feed});
      if (!touches) at = to;
    } else if (std::regex_match(line, m, std::regex(R"(ROT(?: Z=(\S+))?)"))) {
      turn = m[1].matched ? std::stod(m[1]) * M_PI / 180 : 0;
    } else if (std::regex_search(line, m, std::regex(R"(^CYCLE978\(0,,,1,(\S+?),(\S+?),\S+?,([1-3]),([12]),)"))) {
      // To the setpoint as far as the way ahead of it is long, and as far again.
      const int axis = std::stoi(m[3]) - 1;
      const Vec3 unit = axis < 2 ? turned(Vec3(Vec3::Unit(axis)), turn) : Vec3(Vec3::UnitZ());
      const double sense = m[4] == "1" ? 1 : -1, centre = std::stod(m[1]) - sense * kBall / 2;
      EXPECT_NEAR(sense * (centre - unit.dot(at)), std::stod(m[2]), 2e-4) << line;
      out.steps.push_back({'c', at + 2 * sense * std::stod(m[2]) * unit, 0});
    } else if (line.rfind("TCH PROBE 4.2 ", 0) == 0) {
      for (int k = 0; k < 3; ++k) incremental[k] = *value_of(line, std::string("I") + "XYZ"[k]);
    } else if (line.rfind("TCH PROBE 4.3 ", 0) == 0) {
      EXPECT_NEAR(*value_of(line, "DIST "), incremental.norm(), 2e-4);
      out.steps.push_back({'t', at + incremental, feed});
    } else if (std::regex_search(line, m, std::regex("^(G0|G1|L|G43 H[0-9]+) ")) && !value_of(line, "A")) {
      const bool rapid = m[1] == "G0" || m[1].str().rfind("G43", 0) == 0 || line.find("FMAX") != std::string::npos;
      if (!std::isnan(moved(at, line).x())) {
        at = moved(at, line);
        out.steps.push_back({rapid ? 'r' : 'b', at, feed});
      }
    } else if (std::regex_search(
                   line, m, std::regex(R"(^\(LOG,([0-9]+) #5061 #5062 #5063\)$|^#100=([0-9]+)$|"([0-9]+) "<<R1)"))) {
      for (std::size_t k = 1; k < m.size(); ++k)
        if (m[k].matched) out.logged.push_back(std::stoi(m[k]));
    } else if (std::regex_match(line, m, std::regex("TCH PROBE 4.1 Q([0-9]+)"))) {
      out.logged.push_back((std::stoi(m[1]) - 1600) / 4 + 1);
    }
  }
  return out;
}

TEST(ProbingText, EveryControlGoesDownTouchesGoesBackAndUp) {
  const ProbeProgram p = sample();
  for (const char* dialect : {"linuxcnc", "fanuc", "mitsubishi_m80", "haas", "siemens", "heidenhain"}) {
    const auto text = controls::probing_text(p, dialect);
    ASSERT_TRUE(text) << dialect;
    std::istringstream in(*text);
    for (std::string line; std::getline(in, line);) {
      EXPECT_LE(line.size(), 120u) << line;
      EXPECT_EQ(line.find("-0.0000"), std::string::npos) << line;
      for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~') << line;
    }
    const Walk walk = walk_of(*text);
    EXPECT_EQ(walk.logged, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8})) << dialect << "\n" << *text;
    EXPECT_EQ(walk.poses, (std::vector<std::pair<double, double>>{{0, 0}, {-47.5, 30.25}})) << dialect;
    EXPECT_TRUE(walk.top_before_each) << dialect << "\n" << *text;
    std::size_t next = 0;
    double height = INFINITY;
    Vec3 at(NAN, NAN, NAN);
    for (std::size_t k = 0; k < walk.steps.size(); ++k) {
      const Step& s = walk.steps[k];
      if (s.kind == 't' || s.kind == 'c') {
        ASSERT_LT(next, p.touches.size()) << dialect;
        const auto& touch = p.touches[next];
        EXPECT_LT((at - touch.start).norm(), 2e-4) << dialect << " " << at.transpose();
        const Vec3 end = s.kind == 'c' ? Vec3(touch.start + 2 * (touch.meets - touch.start)) : touch.past;
        EXPECT_LT((s.to - end).norm(), 3e-4) << dialect << " " << s.to.transpose();
        EXPECT_EQ(s.kind == 'c', dialect == std::string("siemens") && touch.number > 5) << dialect;
        if (s.kind == 't') { EXPECT_EQ(s.feed, p.feed) << dialect; }
        // Back to where it came from, then straight up, before anything else.
        ASSERT_LT(k + 2, walk.steps.size());
        EXPECT_EQ(walk.steps[k + 1].kind, 'b') << dialect;
        EXPECT_LT((walk.steps[k + 1].to - p.touches[next].start).norm(), 2e-4) << dialect;
        EXPECT_NEAR(walk.steps[k + 2].to.z(), p.clear_mm, 1e-4) << dialect;
        EXPECT_LT((walk.steps[k + 2].to - walk.steps[k + 1].to).head<2>().norm(), 1e-9) << dialect;
        ++next;
        continue;
      }
      // Below the clear height nothing moves across but by a touch and back from it.
      if (!std::isnan(at.x()) && std::min(at.z(), s.to.z()) < p.clear_mm - 1e-6 && walk.steps[k - 1].kind != 't' &&
          walk.steps[k - 1].kind != 'c') {
        EXPECT_LT((s.to - at).head<2>().norm(), 1e-9) << dialect << " step " << k;
      }
      if (s.to.z() < p.clear_mm - 1e-6) { EXPECT_NE(s.kind, 'r') << dialect << " step " << k; }
      at = s.to;
      height = std::min(height, s.to.z());
    }
    EXPECT_EQ(next, p.touches.size()) << dialect;
    EXPECT_NEAR(height, -2.5, 1e-9) << dialect;
  }
  const auto none = controls::probing_text(p, "apt");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("dialect = \"apt\" has no words for a probe"), std::string::npos);
  // Four Q parameters a touch, and 400 of them: more touches have no place for their results.
  ProbeProgram many = p;
  while (many.touches.size() < 101) many.touches.push_back(p.touches.front());
  EXPECT_EQ(controls::probing_text(many, "heidenhain").error().message,
            "101 touches, at most 100: Q1600 to Q1999 hold the results; fewer --spaces");
  EXPECT_TRUE(controls::probing_text(many, "fanuc"));
}

/// Ways down, and to all sides, and aslant; a plane stands across each, off its place by up to nine tenths of the way.
struct Walls {
  ProbeProgram program;
  std::vector<Vec3> at;  ///< of the ball's centre at the touch

  explicit Walls(std::uint64_t seed) : program(sample()) {
    Random random(seed);
    program.touches.clear();
    for (int k = 0; k < 40; ++k) {
      const double azimuth = k % 3 == 0 ? k * M_PI / 6 : random(-M_PI, M_PI);
      const double aslant = random(0.1, 1.0);
      const Vec3 side(std::cos(azimuth), std::sin(azimuth), 0), down(0, 0, -1);
      const Vec3 way = k % 4 == 0 ? down : k % 4 == 1 ? Vec3((side + aslant * down).normalized()) : side;
      probing::ProbeTouch touch;
      touch.number = k + 1;
      touch.remark = "WALL";
      touch.start = {random(-60, 60), random(-60, 60), random(-9, 2)};
      touch.meets = touch.start + random(0.2, 1) * way;
      touch.past = touch.meets + 1.5 * way;
      const double ahead = (touch.meets - touch.start).norm();
      at.push_back(touch.meets + random(-0.9, 0.9) * ahead * way);
      program.touches.push_back(touch);
    }
  }
  [[nodiscard]] Vec3 way(int number) const {
    const auto& touch = program.touches[std::size_t(number - 1)];
    return (touch.past - touch.start).normalized();
  }
  [[nodiscard]] SiemensProbe part(double pretravel) const {
    return {[this](int number, const Vec3& centre) {
              // The plane is no wall that the ball has gone by: what is behind its end belongs to no touch.
              const auto& touch = program.touches[std::size_t(number - 1)];
              const Vec3 off = centre - touch.start;
              if ((off - off.dot(way(number)) * way(number)).norm() > 1e-3) return 1.0;
              return (at[std::size_t(number - 1)] - centre).dot(way(number));
            },
            kBall / 2, pretravel};
  }
};

TEST(ProbingText, SiemensLogsTheCentreOfTheBallWhetherByMeasOrByCycle978) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Walls walls(seed);
    const auto text = controls::probing_text(walls.program, "siemens");
    ASSERT_TRUE(text);
    constexpr double kPretravel = 0.013;
    const SiemensProbing ran = run_siemens_probing(*text, walls.part(kPretravel));
    ASSERT_EQ(ran.alarm, "") << *text;
    ASSERT_EQ(ran.touches.size(), walls.at.size());
    std::istringstream log(ran.log);
    for (const SiemensTouch& touch : ran.touches) {
      const auto k = std::size_t(touch.number - 1);
      int number = 0;
      Vec3 logged;
      ASSERT_TRUE(log >> number >> logged.x() >> logged.y() >> logged.z());
      EXPECT_EQ(number, touch.number);
      EXPECT_EQ(touch.cycle, k % 4 != 1);
      // MEAS has what the signal comes late, the cycle is calibrated with it.
      const Vec3 late = touch.cycle ? Vec3(Vec3::Zero()) : Vec3(kPretravel * walls.way(number));
      EXPECT_LT((logged - late - walls.at[k]).norm(), 3e-4) << "seed " << seed << " touch " << number;
      EXPECT_LT((logged - late - touch.met).norm(), 1.5e-4) << "seed " << seed << " touch " << number;
      // As far behind the expected place as ahead of it.
      const auto& plan = walls.program.touches[k];
      if (touch.cycle) {
        EXPECT_NEAR((touch.farthest - touch.from).norm(), 2 * (plan.meets - plan.start).norm(), 5e-4) << number;
      }
    }
  }
}

TEST(ProbingText, SiemensStopsWhereNothingIsMetOrSomethingIsOnTheWay) {
  Walls walls(7);
  const auto text = controls::probing_text(walls.program, "siemens");
  ASSERT_TRUE(text);
  const auto alarm = [&](std::size_t k, double behind) {
    Walls other = walls;
    const auto& plan = other.program.touches[k];
    other.at[k] = plan.meets + behind * (plan.meets - plan.start).norm() * other.way(int(k) + 1);
    return run_siemens_probing(*text, other.part(0)).alarm;
  };
  EXPECT_EQ(alarm(0, 0.99), "");
  EXPECT_EQ(alarm(0, 1.01), "61301");        // down
  EXPECT_EQ(alarm(2, 1.01), "61301");        // across
  EXPECT_EQ(alarm(1, 20), "NOTHING_MET");    // aslant, by MEAS
  EXPECT_EQ(alarm(4, -1.02), "ON_THE_WAY");  // there already where the ball comes down
}

TEST(ProbingTextLinuxcnc, TheInterpreterProbesThePlannedPlaces) {
  const auto text = controls::probing_text(sample(), "linuxcnc");
  ASSERT_TRUE(text);
  const Canonical seen = interpret(*text, "probing");
  // Nothing trips in the stand-alone interpreter: a touch ends where its way ends, and that is what is logged.
  std::vector<std::string> probes;
  for (const auto& line : seen.lines)
    if (line.find("STRAIGHT_PROBE") != std::string::npos) probes.push_back(line);
  // Two ways and one touch for each.
  ASSERT_EQ(probes.size(), 24u) << seen.exit << seen.messages;
  EXPECT_NE(probes[2].find("61.8000, -3.1234, -3.2500"), std::string::npos) << probes[2];
  EXPECT_NE(probes[8].find("-1.5000, 62.5000, -3.0000"), std::string::npos) << probes[8];
  std::vector<std::string> logged;
  for (const auto& line : seen.lines)
    if (line.find("LOG(\"") != std::string::npos) logged.push_back(line.substr(line.find("LOG(\"")));
  ASSERT_EQ(logged.size(), 8u);
  EXPECT_EQ(logged[0], "LOG(\"1 61.800000 -3.123400 -3.250000\")");
  EXPECT_NE(probes[0].find("62.0000, -1.2500, 12.5000"), std::string::npos) << probes[0];
  EXPECT_EQ(seen.messages.find("rror"), std::string::npos) << seen.messages;
}

TEST(ProbingTextLinuxcnc, EndsWhereTheWorkOffsetTurns) {
  ProbeProgram p = sample();
  p.offset_check = text::offset_check_lines(controls::find("linuxcnc")->words, "G54", {'X', 'Y', 'Z', 'C', 'A'});
  ASSERT_EQ(p.offset_check.size(), 3u);
  const auto text = controls::probing_text(p, "linuxcnc");
  ASSERT_TRUE(text);
  const auto probes = [&](const std::string& parameters) {
    const Canonical seen = interpret(*text, "probing_turned", "", parameters);
    return std::count_if(seen.lines.begin(), seen.lines.end(),
                         [](const std::string& line) { return line.find("STRAIGHT_") != std::string::npos; });
  };
  EXPECT_GT(probes(""), 15);
  EXPECT_EQ(probes("5230 5"), 0);
  EXPECT_EQ(probes("5226 0.25"), 0);
}

}  // namespace
}  // namespace toothpath::test
