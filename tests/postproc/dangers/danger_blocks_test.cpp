// What stands in the blocks that move, turn or change the tool: docs/dangers.md, rows 3, 8, 10, 12, 17, 18, 25. Every
// dialect in every way that it is posted, several jobs.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "tests/postproc/dangers/danger_modal_run.h"

namespace toothpath {
namespace {

using namespace test;

// 3: the first motion is a retract in machine coordinates, and no Z in work coordinates stands before the tool length
// counts.
TEST_F(DangerModes, NoWorkZBeforeLengthCompensation) {
  every_post([&] {
    if (apt())
      return;  // tips in work coordinates; the length is LOADTL, which the post processor of the control compensates
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
        // A turned work offset is the program's own, and in force with TCP alone.
        const bool turned = b.mode("tcp") == "on" && b.mode("written offset") == "turned";
        EXPECT_EQ(b.mode("offset"), turned ? "G59.3" : "G54") << b.line << ": " << b.code;
      }
      EXPECT_GT(z, 10);
    });
  });
}

// 8: G94 with rotary words only with TCP, or with the exact F of a block that inverse time cannot express (its time is
// checked in DangerTimes), or where the rotary words repeat what stands.
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
        if (b.mode("shift") == "on" && b.before.at("shift") != "on") at["C"].clear();  // words count from elsewhere
        if (!b.moves || b.rapid || b.mode("feed") == "inverse time" || b.mode("tcp") == "on" || !turns) continue;
        EXPECT_EQ(std::string(post().dialect), "linuxcnc") << b.line << ": " << b.code;
        EXPECT_TRUE(b.has("F")) << b.line << ": " << b.code;
      }
    });
  });
}

// 10: after a tool change, a retract, a change of TCP or a new tooth all words of the next blocks are printed, also
// those that are zero.
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
        // Ahead of the first X, Y or feed behind a break both rotaries have been named.
        if (b.has("X") || b.has("Y") || !b.rapid) { EXPECT_TRUE(rotaries || b.vector) << b.line << ": " << b.code; }
        if (b.rapid && b.has("X") && b.has("Y")) known_xy = true;
        if (b.rapid && b.has("Z") && b.mode("tcp") != "on" && b.code.find("G43") == std::string::npos) {
          EXPECT_TRUE(known_xy) << b.line << ": " << b.code;
        }
        if (b.rapid || !b.linear()) continue;
        if (!linear) {
          for (const char* a : {"X", "Y", "Z"}) EXPECT_TRUE(b.has(a)) << b.line << ": " << b.code;
          EXPECT_TRUE(b.vector || (b.has("A") && b.has("C"))) << b.line << ": " << b.code;
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
      if (b.has("A") && !b.rapid && post().tcp != machines::TcpMode::none)
        tilts[op].insert(std::abs(std::stod(b.words.at("A"))));
    }
    ASSERT_EQ(tilts.size(), 3u);
    EXPECT_EQ(tilts[0].count(30), 1u);
    EXPECT_EQ(tilts[1], std::set<double>{0});
    EXPECT_EQ(tilts[2], std::set<double>{0});
  });
}

// 12: every rapid without TCP moves Z alone, or X and Y, or rotaries. With TCP the tip goes straight and the rotaries
// stand.
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

// 17: TCP of a Fanuc begins with both rotaries at zero, commanded as such, with Z alone; the others switch it on after
// the turn.
TEST_F(DangerModes, TcpStartsWhereItMay) {
  every_post([&] {
    if (apt() || post().tcp == machines::TcpMode::none) return;
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
    const std::regex forbidden(
        R"(\b(G0?[23]|G[23]\.[1-9]|G12|G13|G5|G6|G4[12]|G8[1-9]|G7[3-6]|CIP|CT|CR|CC|CP|RL|RR|SPLINE|BSPLINE|G41\.\d|ARCMOV|CIRCLE)\b|CIRCLE/|TURN=)");
    every_job([&](const ModalRun& run, const auto&) {
      for (const auto& b : run.blocks) {
        EXPECT_FALSE(std::regex_search(b.code, forbidden)) << b.line << ": " << b.code;
        EXPECT_NE(b.mode("radius"), "on");
        EXPECT_NE(b.mode("cycle"), "on");
      }
    });
  });
}

// 25: the tool is named with its change, the spindle and the coolant stand, Z is at its top, TCP and inverse time are
// off.
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
          if (b.moves && !b.rapid) { EXPECT_EQ(b.mode("spindle"), "on") << b.line << ": " << b.code; }
          continue;
        }
        // Named in the same block, or in the one before it.
        EXPECT_TRUE(b.code.rfind("T", 0) == 0 || b.code.rfind("LOADTL", 0) == 0 ||
                    (i > 0 && run.blocks[i - 1].code.rfind("T=", 0) == 0))
            << b.line;
        changed.push_back(last_t);
        EXPECT_NE(b.before.count("spindle") != 0 ? b.before.at("spindle") : "off", "on") << b.line;
        EXPECT_NE(b.before.count("coolant") != 0 ? b.before.at("coolant") : "off", "on") << b.line;
        EXPECT_NE(b.mode("tcp"), "on") << b.line;
        EXPECT_NE(b.mode("feed"), "inverse time") << b.line;
        if (!apt()) { EXPECT_EQ(b.before.at("place"), "machine top") << b.line; }
      }
      // Where it changes, and nowhere else.
      std::vector<int> expected;
      for (const auto& path : paths)
        if (const int t = tools()[static_cast<std::size_t>(path.tool)].number; expected.empty() || expected.back() != t)
          expected.push_back(t);
      EXPECT_EQ(changed, expected);
    });
  });
}

}  // namespace
}  // namespace toothpath
