// What the modes of a control are at every block of a program: docs/dangers.md, rows 1 to 3, 5, 8, 10, 12, 17 to 19, 25, 26. Every dialect
// in every way that it is posted, several jobs, walked through by a simulator that shares nothing with the writer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "tests/postproc/danger_case.h"

namespace toothpath {
namespace {

using namespace test;

class DangerModes : public EveryPost {
 protected:
  [[nodiscard]] bool apt() const { return std::string(post().dialect) == "apt"; }
  [[nodiscard]] bool heidenhain() const { return std::string(post().dialect) == "heidenhain"; }
  /// Calls `look` with every job's run.
  template <typename Look>
  void every_job(Look look) const {
    for (const auto& [name, paths] : jobs_for(post())) {
      SCOPED_TRACE(name);
      const ModalRun run = simulate_modes(text_of(post(), paths), post().dialect);
      ASSERT_TRUE(run.unknown.empty()) << "not in the data of the control: " << run.unknown.front();
      ASSERT_TRUE(run.ended);
      look(run, paths);
    }
  }
};

/// A cutting block gives a rotary axis another word than it had.
bool turns_in_cuts(const ModalRun& run) {
  std::map<std::string, std::string> last;
  bool turns = false;
  for (const auto& b : run.blocks)
    for (const char* axis : {"A", "B", "C"}) {
      if (!b.has(axis)) continue;
      const auto known = last.find(axis);
      turns = turns || (!b.rapid && known != last.end() && known->second != b.words.at(axis));
      last[axis] = b.words.at(axis);
    }
  return turns;
}

// 1: whatever the last program left, every modal group is set before anything moves, and again behind every tool change.
TEST_F(DangerModes, SafeStartBeforeTheFirstMotion) {
  every_post([&] {
    every_job([&](const ModalRun& run, const auto&) {
      const auto first = std::find_if(run.blocks.begin(), run.blocks.end(), [](const ModalBlock& b) { return b.moves; });
      ASSERT_NE(first, run.blocks.end());
      for (const auto& [group, value] : safe_modes(post().dialect)) {
        ASSERT_EQ(first->before.count(group), 1u) << group << " is left as the last program left it, at line " << first->line;
        EXPECT_EQ(first->before.at(group), value) << group << " at line " << first->line;
      }
    });
  });
}

// 1: the lines that reset the modes stand behind every tool change as well.
TEST_F(DangerModes, SafeStartAgainBehindEveryToolChange) {
  every_post([&] {
    if (apt()) return;  // CLDATA has no modes of a control
    every_job([&](const ModalRun& run, const auto& paths) {
      const std::string first = heidenhain() ? "PLANE RESET STAY" : std::string(post().dialect) == "siemens" ? "G17 G40 G90 G94 G710" : "G21 G17 G90 G94";
      int changes = 0, resets = 0;
      bool open = false;
      for (const auto& b : run.blocks) {
        if (b.tool_change) {
          ++changes;
          open = true;
        }
        if (open && b.code.rfind(first, 0) == 0) {
          ++resets;
          open = false;
        }
        EXPECT_FALSE(open && b.moves) << "line " << b.line << " moves before the modes are reset";
      }
      EXPECT_EQ(changes, static_cast<int>(paths.size()));
      EXPECT_EQ(resets, changes);
    });
  });
}

// 2: the program leaves the control as it wants to find it; spindle, coolant, TCP, G93 and smoothing are off.
TEST_F(DangerModes, EndStateIsTheResetState) {
  every_post([&] {
    every_job([&](const ModalRun& run, const auto&) {
      const ModalBlock& last = run.blocks.back();
      for (const auto& [group, value] : end_modes(post().dialect)) EXPECT_EQ(last.mode(group), value) << group;
      EXPECT_EQ(last.mode("coolant"), "off");
      if (!apt()) {
        EXPECT_EQ(last.mode("place"), "machine top");
        EXPECT_NE(last.mode("tcp"), "on");
      }
      for (const auto& b : run.blocks) EXPECT_TRUE(b.mode("coolant") != "on" || b.mode("spindle") == "on" || !b.moves) << b.line;
    });
  });
}

// 3: the first motion is a retract in machine coordinates, and no Z in work coordinates stands before the tool length counts.
TEST_F(DangerModes, NoWorkZBeforeLengthCompensation) {
  every_post([&] {
    if (apt()) return;  // tips in work coordinates; the length is LOADTL, which the post processor of the control compensates
    every_job([&](const ModalRun& run, const auto&) {
      bool moved = false;
      int z = 0;
      for (const auto& b : run.blocks) {
        if (!b.moves) continue;
        if (!moved) {
          EXPECT_TRUE(b.machine && b.has("Z") && !b.has("X") && !b.has("Y") && !b.rotary()) << b.line << ": " << b.code;
        }
        moved = true;
        if (b.machine || !b.has("Z")) continue;
        ++z;
        EXPECT_EQ(b.mode("length"), "on") << b.line << ": " << b.code;
        EXPECT_EQ(b.mode("offset"), "G54") << b.line << ": " << b.code;
      }
      EXPECT_GT(z, 10);
    });
  });
}

// 5: F stands in every block of inverse time, and in the first feed block behind every change between G93 and G94.
TEST_F(DangerModes, FeedWithEveryChangeOfItsMeaning) {
  every_post([&] {
    if (apt() || heidenhain()) return;  // one meaning of F only
    every_job([&](const ModalRun& run, const auto&) {
      bool given = false;
      int inverse = 0, changes = 0;
      for (const auto& b : run.blocks) {
        if (b.before.count("feed") == 0 || b.before.at("feed") != b.mode("feed")) {
          given = false;
          ++changes;
        }
        given = given || b.has("F");
        if (!b.moves || b.rapid) continue;
        if (b.mode("feed") == "inverse time") {
          EXPECT_TRUE(b.has("F")) << b.line << ": " << b.code;
          ++inverse;
        }
        EXPECT_TRUE(given) << b.line << ": " << b.code;
      }
      EXPECT_EQ(inverse > 0, post().tcp == TcpMode::none);
      EXPECT_GE(changes, post().tcp == TcpMode::none ? 3 : 1);
    });
  });
}

// 8: G94 with rotary words only with TCP, or with the exact F of a block that inverse time cannot express (its time is checked in
// DangerTimes), or where the rotary words repeat what stands.
TEST_F(DangerModes, NoFeedPerMinuteWithRotariesWithoutTcp) {
  every_post([&] {
    if (apt()) return;
    every_job([&](const ModalRun& run, const auto&) {
      std::map<std::string, std::string> at;
      for (const auto& b : run.blocks) {
        bool turns = false;
        for (const char* a : {"A", "C"})
          if (b.has(a)) {
            turns = turns || at[a] != b.words.at(a);
            at[a] = b.words.at(a);
          }
        if (b.code.rfind("FN 1: Q5", 0) == 0) at["C"].clear();  // the index angle is another one now
        if (!b.moves || b.rapid || b.mode("feed") == "inverse time" || b.mode("tcp") == "on" || !turns) continue;
        EXPECT_EQ(std::string(post().dialect), "linuxcnc") << b.line << ": " << b.code;
        EXPECT_TRUE(b.has("F")) << b.line << ": " << b.code;
      }
    });
  });
}

// 10: after a tool change, a retract, a change of TCP or a new tooth all words of the next blocks are printed, also those that are zero.
TEST_F(DangerModes, WordsAreForcedAfterBreaks) {
  every_post([&] {
    every_job([&](const ModalRun& run, const auto&) {
      bool rotaries = false, linear = false, known_xy = false;
      for (const auto& b : run.blocks) {
        if (apt()) {
          for (const char* a : {"X", "Y", "Z", "I", "J", "K"}) EXPECT_TRUE(!b.moves || b.has(a)) << b.line;
          continue;
        }
        const bool tcp_switch = b.before.count("tcp") != 0 && b.before.at("tcp") != b.mode("tcp");
        if (b.machine || b.tool_change || b.comment.rfind("TOOTH", 0) == 0) rotaries = known_xy = false;
        if (b.machine || b.tool_change || tcp_switch || b.rapid) linear = false;
        if (!b.moves || b.machine) continue;
        if (b.has("A") && b.has("C")) rotaries = true;
        const bool index_left_to_the_call = is_iso_point(post()) && !post().expand && b.has("A");
        // Ahead of the first X, Y or feed behind a break both rotaries have been named.
        if (b.has("X") || b.has("Y") || !b.rapid) {
          EXPECT_TRUE(rotaries || b.vector || index_left_to_the_call) << b.line << ": " << b.code;
        }
        if (b.rapid && b.has("X") && b.has("Y")) known_xy = true;
        if (b.rapid && b.has("Z") && b.mode("tcp") != "on" && b.code.find("G43") == std::string::npos) {
          EXPECT_TRUE(known_xy) << b.line << ": " << b.code;
        }
        if (b.rapid || !b.linear()) continue;
        if (!linear) {
          for (const char* a : {"X", "Y", "Z"}) EXPECT_TRUE(b.has(a)) << b.line << ": " << b.code;
          EXPECT_TRUE(b.vector || (b.has("A") && (b.has("C") || index_left_to_the_call))) << b.line << ": " << b.code;
        }
        linear = true;
      }
    });
  });
}

// 10: operations at A-30, A0, A0. The third says A0 again, although nothing changes.
TEST_F(DangerModes, ATiltOfZeroIsSaidAgain) {
  every_post([&] {
    if (apt()) return;
    const auto paths = jobs_for(post()).at("A-30, A0, A0");
    const ModalRun run = simulate_modes(text_of(post(), paths), post().dialect);
    std::map<int, std::set<double>> tilts;
    int op = -1;
    for (const auto& b : run.blocks) {
      if (b.comment.rfind("OP ", 0) == 0) op = std::stoi(b.comment.substr(3));
      if (b.has("A") && b.rapid) tilts[op].insert(std::abs(std::stod(b.words.at("A"))));
      if (b.has("A") && !b.rapid && post().tcp != TcpMode::none) tilts[op].insert(std::abs(std::stod(b.words.at("A"))));
    }
    ASSERT_EQ(tilts.size(), 3u);
    EXPECT_EQ(tilts[0].count(30), 1u);
    EXPECT_EQ(tilts[1], std::set<double>{0});
    EXPECT_EQ(tilts[2], std::set<double>{0});
  });
}

// 12: every rapid without TCP moves Z alone, or X and Y, or rotaries. With TCP the tip goes straight and the rotaries stand.
TEST_F(DangerModes, RapidsMoveOneGroupOfAxes) {
  every_post([&] {
    if (apt()) return;  // tips and vectors: the order of the joints is the business of the post processor
    every_job([&](const ModalRun& run, const auto&) {
      int rapids = 0;
      for (const auto& b : run.blocks) {
        if (!b.rapid) continue;
        ++rapids;
        const int groups = int{b.has("X") || b.has("Y")} + int{b.has("Z")} + int{b.rotary()};
        if (b.mode("tcp") == "on" && b.before.at("tcp") == "on") {
          EXPECT_FALSE(b.rotary()) << b.line << ": " << b.code;
        } else {
          EXPECT_EQ(groups, 1) << b.line << ": " << b.code;
        }
      }
      EXPECT_GT(rapids, 5);
    });
  });
}

// 17: what the numbers mean stands at the top: work offset and where it is, what the tool lengths refer to, how TCP must be set.
TEST_F(DangerModes, HeaderSaysWhatTheNumbersMean) {
  every_post([&] {
    every_job([&](const ModalRun& run, const auto&) {
      std::string head;
      for (const auto& b : run.blocks) {
        if (b.moves) break;
        head += b.comment + "\n";
      }
      EXPECT_NE(head.find("MACHINE TRUNNION"), std::string::npos);
      EXPECT_NE(head.find(apt() ? "TIP AND TOOL AXIS IN WORK COORDINATES" : "TOOL LENGTHS RUN FROM THE GAUGE LINE TO THE TIP"), std::string::npos);
      if (!apt()) {
        EXPECT_TRUE(std::regex_search(head, std::regex(R"(WORK OFFSET G54 AT X\+?3\.? Y-2\.? Z\+?0\.? MM MACHINE)"))) << head;
      }
      if (std::string(post().dialect) == "fanuc" && post().tcp == TcpMode::angles) {
        EXPECT_NE(head.find("19696#5 WKP=0"), std::string::npos);
      }
    });
  });
}

// 17: TCP of a Fanuc begins with both rotaries at zero, commanded as such, with Z alone; the others switch it on after the turn.
TEST_F(DangerModes, TcpStartsWhereItMay) {
  every_post([&] {
    if (apt() || post().tcp == TcpMode::none) return;
    every_job([&](const ModalRun& run, const auto&) {
      std::map<std::string, std::string> at;
      int starts = 0;
      for (const auto& b : run.blocks) {
        const bool on = b.mode("tcp") == "on" && (b.before.count("tcp") == 0 || b.before.at("tcp") != "on");
        if (on) {
          ++starts;
          EXPECT_EQ(b.mode("spindle"), "on") << b.line;
          if (std::string(post().dialect) == "fanuc") {
            EXPECT_EQ(at["A"] + at["C"], "0.0.") << b.line << ": " << b.code;
            EXPECT_TRUE(b.has("Z") && b.has("H") && !b.has("X") && !b.has("Y") && !b.rotary()) << b.code;
          } else {
            EXPECT_FALSE(b.moves) << b.line << ": " << b.code;
            EXPECT_FALSE(at["A"].empty() || at["C"].empty()) << b.line;
          }
        }
        if (b.tool_change) at.clear();
        for (const char* a : {"A", "C"})
          if (b.has(a)) at[a] = b.words.at(a);
        // Machine coordinates with TCP on would be those of the tip.
        EXPECT_FALSE(b.machine && b.mode("tcp") == "on") << b.line << ": " << b.code;
        EXPECT_FALSE(b.tool_change && b.mode("tcp") == "on") << b.line;
      }
      EXPECT_GE(starts, 2);
    });
  });
}

// 18: G0 and G1 only (L and LN, GOTO): no arc, helix, spline, cycle or radius compensation anywhere.
TEST_F(DangerModes, NoArcsNoCyclesNoRadiusCompensation) {
  every_post([&] {
    const std::regex forbidden(R"(\b(G0?[23]|G[23]\.[1-9]|G12|G13|G5|G6|G4[12]|G8[1-9]|G7[3-6]|CIP|CT|CR|CC|CP|RL|RR|SPLINE|BSPLINE|G41\.\d|ARCMOV|CIRCLE)\b|CIRCLE/|TURN=)");
    every_job([&](const ModalRun& run, const auto&) {
      for (const auto& b : run.blocks) {
        EXPECT_FALSE(std::regex_search(b.code, forbidden)) << b.line << ": " << b.code;
        EXPECT_NE(b.mode("radius"), "on");
        EXPECT_NE(b.mode("cycle"), "on");
      }
    });
  });
}

// 19: smoothing never without its tolerance, and never with LinuxCNC, where that does not hold; what is on in a cut is off at the end.
TEST_F(DangerModes, SmoothingHasItsToleranceAndEnds) {
  every_post([&] {
    const std::string d = post().dialect;
    const std::regex bounded(R"(G641 ADIS=0\.000(212|122)|CYCL DEF 32\.1 T0\.0003)"), any(R"(\bG64\b|\bG64[1-5]\b|CYCL DEF 32\.1 |CYCLE832|G5\.1|G05|G8 P|COMPON|COMPCURV|COMPCAD)");
    every_job([&](const ModalRun& run, const auto&) {
      int on = 0, exact = 0;
      for (const auto& b : run.blocks) {
        if (std::regex_search(b.code, any)) {
          EXPECT_TRUE(std::regex_search(b.code, bounded)) << b.line << ": " << b.code;
          ++on;
        }
      }
      if (d == "linuxcnc") {
        for (const auto& b : run.blocks) exact += std::regex_search(b.code, std::regex(R"(\bG61\b)"));
        EXPECT_EQ(on, 0);
        EXPECT_EQ(exact, 2);  // at the start and at the end
        for (const auto& b : run.blocks)
          if (b.moves && !b.rapid) {
            EXPECT_EQ(b.mode("smoothing"), "off") << b.line;
          }
      } else if (d == "siemens" || d == "heidenhain") {
        EXPECT_EQ(on, 1);
        EXPECT_EQ(run.blocks.back().mode("smoothing"), "off");
        for (const auto& b : run.blocks)
          if (b.moves && !b.rapid) {
            EXPECT_EQ(b.mode("smoothing"), "on") << b.line;
            if (d == "heidenhain") {
              EXPECT_EQ(b.mode("axis smoothing"), "on") << b.line;
            } else if (turns_in_cuts(run) && b.mode("tcp") != "on") {
              EXPECT_EQ(b.mode("path group"), "named") << b.line;
            }
          }
        if (d == "siemens") {
          EXPECT_NE(run.blocks.back().mode("path group"), "named");
        }
      } else {
        EXPECT_EQ(on, 0);
      }
    });
  });
}

// 25: the tool is named with its change, the spindle and the coolant stand, Z is at its top, TCP and inverse time are off.
TEST_F(DangerModes, ToolChangesAreSafe) {
  every_post([&] {
    static const std::regex named(R"re(^T(\d+) M6$|^T="T(\d+)"$|^TOOL CALL (\d+) |^LOADTL/(\d+),)re");
    every_job([&](const ModalRun& run, const auto& paths) {
      std::vector<int> changed;
      int last_t = 0;
      for (std::size_t i = 0; i < run.blocks.size(); ++i) {
        const auto& b = run.blocks[i];
        std::smatch m;
        if (std::regex_search(b.code, m, named))
          for (std::size_t k = 1; k < m.size(); ++k)
            if (m[k].matched) last_t = std::stoi(m[k]);
        const bool m6 = b.code.find("M6") != std::string::npos && b.code.find("M6") + 2 == b.code.size();
        if (!b.tool_change && !m6) {
          if (b.moves && !b.rapid) {
            EXPECT_EQ(b.mode("spindle"), "on") << b.line << ": " << b.code;
          }
          continue;
        }
        // Named in the same block, or in the one before it.
        EXPECT_TRUE(b.code.rfind("T", 0) == 0 || b.code.rfind("LOADTL", 0) == 0 || (i > 0 && run.blocks[i - 1].code.rfind("T=", 0) == 0)) << b.line;
        changed.push_back(last_t);
        EXPECT_NE(b.before.count("spindle") != 0 ? b.before.at("spindle") : "off", "on") << b.line;
        EXPECT_NE(b.before.count("coolant") != 0 ? b.before.at("coolant") : "off", "on") << b.line;
        EXPECT_NE(b.mode("tcp"), "on") << b.line;
        EXPECT_NE(b.mode("feed"), "inverse time") << b.line;
        if (!apt()) {
          EXPECT_EQ(b.before.at("place"), "machine top") << b.line;
        }
      }
      ASSERT_EQ(changed.size(), paths.size());
      for (std::size_t k = 0; k < paths.size(); ++k) EXPECT_EQ(changed[k], tools()[static_cast<std::size_t>(paths[k].tool)].number);
    });
  });
}

// 26: the unit code stands in every program, mm always; the reader refuses the other one.
TEST_F(DangerModes, UnitCodeIsPrintedAndInchesAreRefused) {
  every_post([&] {
    const std::map<std::string, std::pair<std::string, std::string>> codes = {
        {"linuxcnc", {"G21", "G20"}}, {"fanuc", {"G21", "G20"}},          {"mitsubishi_m80", {"G21", "G20"}},
        {"siemens", {"G710", "G700"}}, {"heidenhain", {" MM\n", " INCH\n"}}, {"apt", {"UNITS/MM", "UNITS/INCHES"}}};
    const auto& [mm, inch] = codes.at(post().dialect);
    const Machine m = machine_of(post());
    const auto control = control_of(m, standing(), tools());
    every_job([&](const ModalRun& run, const auto& paths) {
      for (const auto& b : run.blocks)
        if (b.moves) {
          EXPECT_EQ(b.mode("units"), "mm") << b.line;
        }
      const std::string text = text_of(post(), paths);
      const auto with = [&](const std::string& replacement) {
        std::string t = text;
        for (std::size_t at = 0; (at = t.find(mm, at)) != std::string::npos; at += replacement.size()) t.replace(at, mm.size(), replacement);
        return execute_nc(t, "p", *control, [](const ExecutedMove&) {});
      };
      EXPECT_TRUE(with(mm));
      EXPECT_FALSE(with(inch)) << "inches";
      EXPECT_FALSE(with(heidenhain() ? "\n" : "")) << "no unit code";
    });
  });
}

}  // namespace
}  // namespace toothpath
