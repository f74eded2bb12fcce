// The words of a program: docs/dangers.md, rows 4, 14, 20, 23, 24, 27. Every dialect in every way that it is posted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <regex>
#include <sstream>

#include "tests/postproc/dangers/danger_case.h"

namespace toothpath {
namespace {

using namespace test;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string l; std::getline(in, l);) out.push_back(l);
  return out;
}

/// Executed moves of a program.
class DangerWords : public EveryPost {};

// 4: on Fanuc and Mitsubishi every value has its point, whatever the job; no dialect prints -0, an exponent, NaN or
// Inf.
TEST_F(DangerWords, NumbersOfRandomJobs) {
  every_post([&] {
    const Post& p = post();
    std::mt19937 random(21);
    std::uniform_real_distribution<double> u(0, 1);
    const std::regex value(R"(([A-Z])(=?)([+-]?\d*\.?\d*))"),
        bad(R"(-0(\.0*)?(?![0-9.])|\d[eE][+-]?\d|\bnan\b|\binf\b)", std::regex::icase);
    const std::string whole = "GMTHDNOSPLQ";  // codes, numbers of tools and programs, the spindle speed
    for (int trial = 0; trial < 6; ++trial) {
      std::vector<path::ClPath> paths = {sample_path(0.5 * u(random), may_turn(p) ? 0.3 * u(random) : 0, 3 + trial, 0)};
      // Round numbers are those that lose their point first.
      if (trial % 2 == 0) {
        for (auto& r : paths[0].records) {
          r.tip = r.tip.array().round();
          r.axis = Vec3::UnitZ();
        }
        paths[0].spindle_rpm = 10000;
      }
      const std::string text = text_of(p, paths, 2 + trial);
      std::size_t values = 0;
      for (const auto& l : lines_of(text)) {
        const std::string code = std::regex_replace(l, std::regex(R"(\([^)]*\)|;.*|\$\$.*)"), "");
        EXPECT_FALSE(std::regex_search(code, bad)) << l;
        if (!is_iso_point(p)) continue;
        for (std::sregex_iterator it(code.begin(), code.end(), value), end; it != end; ++it) {
          const std::string number = (*it)[3];
          if (number.empty()) continue;
          if (whole.find((*it)[1].str()) != std::string::npos) {
            EXPECT_TRUE(number.find('.') == std::string::npos || (*it)[0] == "G43.4") << l;
          } else {
            EXPECT_NE(number.find('.'), std::string::npos) << l;
            EXPECT_LE(std::count_if(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; }), 9) << l;
            ++values;
          }
        }
      }
      if (is_iso_point(p)) { EXPECT_GT(values, 40u); }
    }
  });
}

/// A pass whose tool azimuth goes from `from` to `to` [rad]; links far above.
path::ClPath azimuth_pass(double lean, double from, double to, int steps, int pass = 0) {
  path::ClPath path = sample_path(lean, 0, steps);
  std::vector<path::ClRecord> kept;
  for (auto& r : path.records) {
    if (r.pass != 0) continue;
    r.pass = pass;
    kept.push_back(r);
  }
  path.records = kept;
  const auto n = static_cast<double>(path.records.size() - 3);
  for (std::size_t i = 0; i < path.records.size(); ++i) {
    auto& r = path.records[i];
    const double t = std::clamp((static_cast<double>(i) - 1) / n, 0.0, 1.0);
    r.axis = leaning(lean, from + (to - from) * t);
    if (r.kind == path::MoveKind::rapid || r.kind == path::MoveKind::retract) r.tip.z() = 60;
  }
  path.records.push_back(path.records.back());
  path.records.back().kind = path::MoveKind::rapid;
  return path;
}

/// No rotary jumps inside a cut, and the tilt keeps its side.
void expect_continuous(const std::vector<readback::ExecutedMove>& moves, const std::string& what) {
  std::size_t cuts = 0;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const readback::ExecutedMove &a = moves[i - 1], &b = moves[i];
    if (b.rapid || a.rapid || !a.known || !b.known || (b.commanded & 7) == 0 || (a.commanded & 7) == 0) continue;
    ++cuts;
    for (std::size_t x = 3; x < 5; ++x)
      ASSERT_LT(std::abs(b.joints[x] - a.joints[x]), 15) << what << " line " << b.line;
    ASSERT_GE(b.joints[4] * a.joints[4], -1e-9) << what << " line " << b.line;
  }
  EXPECT_GT(cuts, 10u) << what;
}

// 14: passes whose C crosses 0 and 360 deg, both ways, and several turns on: C goes on, it never runs back 359 degrees.
TEST_F(DangerWords, StepsAcrossZeroAndAWholeTurn) {
  every_post([&] {
    const Post& p = post();
    if (!may_turn(p)) return;
    // On this machine the axis has azimuth pi/2 at C = 0 (A > 0) and C falls while the azimuth grows.
    for (const double at : {kPi / 2, -3 * kPi / 2, 5 * kPi / 2, kPi / 2 + kPi})
      for (const double way : {0.5, -0.5}) {
        const std::vector<path::ClPath> paths = {azimuth_pass(0.3, at - way, at + way, 30)};
        const auto moves = executed(p, text_of(p, paths));
        expect_continuous(moves, p.name);
        double least = 1e9, greatest = -1e9;
        for (const auto& m : moves)
          if (!m.rapid && m.operation == 0 && (m.commanded & 7) != 0 && m.tooth <= 0) {
            least = std::min(least, m.joints[3]);
            greatest = std::max(greatest, m.joints[3]);
          }
        EXPECT_GT(greatest - least, degrees(0.99)) << "the pass turns by a radian";
      }
  });
}

// 14: how the control takes a rotary word is stated where it has a choice, and no word leaves it to the shorter way.
TEST_F(DangerWords, TheWayOfARotaryIsNeverLeftToTheControl) {
  every_post([&] {
    const Post& p = post();
    for (const auto& [name, paths] : jobs_for(p)) {
      const std::string text = text_of(p, paths);
      EXPECT_FALSE(std::regex_search(text, std::regex(R"(=(DC|ACP|ACN|IC|AC)\(|\bI[ABC][+-]|\bG91\b|\b[UVWH]-?\d+\.)")))
          << name;
      if (std::string(p.dialect) == "heidenhain") {
        const auto on = text.find("M126"), first = text.find(" L ");
        EXPECT_LT(on, first) << name;
        EXPECT_NE(text.find("M127", first), std::string::npos) << name;
      }
    }
  });
}

// 20: random paths across C = 180 deg: neither pair nor winding changes inside a cut, in any dialect.
TEST_F(DangerWords, RandomPathsAcrossHalfATurnNeverFlip) {
  every_post([&] {
    const Post& p = post();
    if (!may_turn(p)) return;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> lean(0.15, 0.7), around(-0.6, 0.6), way(-2.5, 2.5);
    for (int trial = 0; trial < 8; ++trial) {
      // C = +-180 deg is the azimuth -pi/2 of the first pair, and pi/2 of the second.
      const double middle = (trial % 2 == 0 ? -1 : 1) * kPi / 2 + around(random), half = way(random) / 2;
      const std::vector<path::ClPath> paths = {azimuth_pass(lean(random), middle - half, middle + half, 40)};
      expect_continuous(executed(p, text_of(p, paths, 1)), fmt::format("{} trial {}", p.name, trial));
    }
  });
}

// 23: the angle of tooth k comes from k * 360 / z afresh: half a digit off at most, and no drift up to the last tooth.
TEST_F(DangerWords, IndexAnglesDoNotDrift) {
  every_post([&] {
    const Post& p = post();
    path::ClPath path = azimuth_pass(0.3, 0.4, 0.4, 1);
    const auto dialect = controls::dialect_of(machine_of(p));
    const double digit = std::pow(10.0, -dialect->format.rotary_decimals);
    for (const int z : {89, 997}) {
      const auto moves = executed(p, text_of(p, {path}, z));
      std::vector<double> angles;
      for (const auto& m : moves)
        if (!m.rapid && (m.commanded & 7) != 0 && (angles.empty() || std::abs(m.joints[3] - angles.back()) > 0.1))
          angles.push_back(m.joints[3]);
      ASSERT_EQ(angles.size(), static_cast<std::size_t>(z));
      // Joint words are shifted by a rounded k * 360 / z: half a digit. A word that is rounded with the angle of its
      // own tooth: two halves. Vectors of eight decimals know no rounding of angles.
      const double bound =
          p.tcp == machines::TcpMode::vectors ? 4e-6 : (p.tcp == machines::TcpMode::none ? 0.5 : 1) * digit + 1e-9;
      const double sense = std::fmod(angles[1] - angles[0] + 540, 360) - 180 > 0 ? 1 : -1;
      for (int k = 0; k < z; ++k) {
        const double off =
            std::remainder(angles[static_cast<std::size_t>(k)] - angles[0] - sense * k * 360.0 / z, 360.0);
        ASSERT_LE(std::abs(off), bound) << p.name << " z = " << z << " tooth " << k;
      }
    }
  });
}

// 24: what stands at the top about the text stands at its end again, so that a file that was cut off shows it; another
// text, another hash.
TEST_F(DangerWords, HashAndBlocksStandAtTheTopAndAtTheEnd) {
  const std::regex stamp(R"(HASH [0-9A-F]{16} BLOCKS \d+)");
  every_post([&] {
    const auto stamps = [&](const std::string& text) {
      std::vector<std::string> found;
      for (std::sregex_iterator it(text.begin(), text.end(), stamp), end; it != end; ++it) found.push_back((*it)[0]);
      return found;
    };
    const std::string text = text_of(post(), {sample_path(0.3, 0, 5)});
    const auto both = stamps(text);
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0], both[1]);
    EXPECT_LT(text.find(both[0]), 500u);
    EXPECT_GT(text.rfind(both[1]), text.size() - 100);
    path::ClPath other = sample_path(0.3, 0, 5);
    other.records[4].tip.x() += 0.002;
    EXPECT_NE(stamps(text_of(post(), {other}))[0], both[0]);
  });
}

text::NcHeader named(const std::string& name) {
  text::NcHeader h;
  h.job_name = h.machine_name = name;
  h.assumed = {name};
  return h;
}

// 27: whatever stands in a name stays in the comments: the code of the program is that of a plain name, byte for byte.
TEST_F(DangerWords, NamesStayNames) {
  every_post([&] {
    const Post& p = post();
    const auto program = program_of(p, {sample_path(0.2, 0, 2)}, 2);
    ASSERT_TRUE(program);
    const auto dialect = controls::dialect_of(machine_of(p));
    const auto code_of = [&](const std::string& name) {
      const auto text = text::write_nc(*program, *dialect, named(name));
      EXPECT_TRUE(text) << (text ? "" : text.error().message);
      std::vector<std::string> code;
      if (!text) return code;
      EXPECT_TRUE(std::all_of(text->text.begin(), text->text.end(), [](char c) {
        return c == '\n' || (c >= ' ' && c <= '~');
      })) << name;
      EXPECT_EQ(text->text.back(), '\n');
      for (const auto& b : simulate_modes(text->text, p.dialect).blocks) {
        static const std::regex with_name(R"((BEGIN|END) PGM [A-Z][A-Z0-9_]{0,23} MM|PARTNO/[A-Z][A-Z0-9_]{0,23})");
        const bool name_line = b.code.find("P") < 8 && std::regex_match(b.code, with_name);
        if (b.code.find('%') != std::string::npos && b.code != "%") ADD_FAILURE() << b.code;
        if (!b.code.empty()) code.push_back(name_line ? "NAME" : b.code);  // a long remark takes several lines
      }
      return code;
    };
    const auto plain = code_of("PLAIN");
    EXPECT_GT(plain.size(), 20u);
    std::vector<std::string> names = {"",
                                      ") G0 Z-100 (",
                                      "(((",
                                      "%\nO0666",
                                      "a\nG0 Z-100",
                                      "a\r\nM30\r\n",
                                      "/1",
                                      "$",
                                      "$$ x",
                                      ";",
                                      "\xEF\xBB\xBF"
                                      "bom",
                                      "Zahnr\xC3\xA4"
                                      "der",
                                      "\xC3\x28",
                                      std::string("nul\0byte", 8),
                                      "\t",
                                      "{top}",
                                      "{safe_start}",
                                      "END PGM X MM",
                                      "M30",
                                      std::string(300, 'W'),
                                      "{",
                                      "}"};
    std::mt19937 random(27);
    for (int i = 0; i < 40; ++i) {
      std::string n;
      for (int k = 0; k < 30; ++k) n += static_cast<char>(random() & 0xff);
      names.push_back(n);
    }
    for (const auto& n : names) EXPECT_EQ(code_of(n), plain) << n;
  });
}

}  // namespace
}  // namespace toothpath
