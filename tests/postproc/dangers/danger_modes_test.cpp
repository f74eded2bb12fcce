// What the modes of a control are at every block of a program: docs/dangers.md, rows 1, 2, 5, 17 to 19, 26. Every
// dialect in every way that it is posted, several jobs.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/postproc/dangers/danger_modal_run.h"

namespace toothpath {
namespace {

using namespace test;

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

// 1: whatever the last program left, every modal group is set before anything moves, and again behind every tool
// change.
TEST_F(DangerModes, SafeStartBeforeTheFirstMotion) {
  every_post([&] {
    every_job([&](const ModalRun& run, const auto&) {
      const auto first =
          std::find_if(run.blocks.begin(), run.blocks.end(), [](const ModalBlock& b) { return b.moves; });
      ASSERT_NE(first, run.blocks.end());
      for (const auto& [group, value] : safe_modes(post().dialect)) {
        ASSERT_EQ(first->before.count(group), 1u)
            << group << " is left as the last program left it, at line " << first->line;
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
      const std::string first = heidenhain()                               ? "PLANE RESET STAY"
                                : std::string(post().dialect) == "siemens" ? "G17 G40 G90 G94 G710"
                                                                           : "G21 G17 G90 G94";
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
      int tools_used = 0, last = -1;  // fetched where it changes
      for (const auto& path : paths) {
        if (path.tool != last) ++tools_used;
        last = path.tool;
      }
      EXPECT_EQ(changes, tools_used);
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
      for (const auto& b : run.blocks)
        EXPECT_TRUE(b.mode("coolant") != "on" || b.mode("spindle") == "on" || !b.moves) << b.line;
    });
  });
}

// 5: F stands in every block of inverse time, and in the first feed block behind every change between G93 and G94.
TEST_F(DangerModes, FeedWithEveryChangeOfItsMeaning) {
  every_post([&] {
    if (apt() || heidenhain()) return;  // one meaning of F only
    int of_all_jobs = 0;
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
      EXPECT_GE(changes, inverse > 0 ? 3 : 1);
      of_all_jobs += inverse;
    });
    EXPECT_EQ(of_all_jobs > 0, post().tcp == machines::TcpMode::none);
  });
}

// 17: what the numbers mean stands at the top: work offset and where it is, what the tool lengths refer to, how TCP
// must be set.
TEST_F(DangerModes, HeaderSaysWhatTheNumbersMean) {
  every_post([&] {
    every_job([&](const ModalRun& run, const auto&) {
      std::string head;
      for (const auto& b : run.blocks) {
        if (b.moves) break;
        head += b.comment + "\n";
      }
      EXPECT_NE(head.find("MACHINE TRUNNION"), std::string::npos);
      EXPECT_NE(head.find(apt() ? "TIP AND TOOL AXIS IN WORK COORDINATES"
                                : "TOOL LENGTHS RUN FROM THE GAUGE LINE TO THE TIP"),
                std::string::npos);
      if (!apt()) {
        EXPECT_TRUE(std::regex_search(head, std::regex(R"(WORK OFFSET G54 AT X\+?3\.? Y-2\.? Z\+?0\.? MM MACHINE)")))
            << head;
      }
      if (post().tcp == machines::TcpMode::none) return;
      for (const auto& [dialect, said] : {std::pair{"fanuc", "19696#5 WKP=0"},
                                          {"linuxcnc", "MOTION.TOOLOFFSET.Z MUST REACH XYZAC-TRT-KINS.TOOL-OFFSET"},
                                          {"siemens", "MACHINE DATA 21104 ORI_IPO_WITH_G_CODE = 1"}})
        if (post().dialect == std::string(dialect)) { EXPECT_NE(head.find(said), std::string::npos) << head; }
    });
  });
}

// 19: smoothing never without its tolerance, and never with LinuxCNC, where that does not hold; what is on in a cut is
// off at the end.
TEST_F(DangerModes, SmoothingHasItsToleranceAndEnds) {
  every_post([&] {
    const std::string d = post().dialect;
    const std::regex bounded(R"(G641 ADIS=0\.000(212|122)|CYCL DEF 32\.1 T0\.0003)"),
        any(R"(\bG64\b|\bG64[1-5]\b|CYCL DEF 32\.1 |CYCLE832|G5\.1|G05|G8 P|COMPON|COMPCURV|COMPCAD)");
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
          if (b.moves && !b.rapid) { EXPECT_EQ(b.mode("smoothing"), "off") << b.line; }
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
        if (d == "siemens") { EXPECT_NE(run.blocks.back().mode("path group"), "named"); }
      } else {
        EXPECT_EQ(on, 0);
        for (const auto& b : run.blocks)  // G61 of Fanuc, Mitsubishi and Haas; cutter locations have no such modes
          if (d != "apt" && b.moves && !b.rapid) { EXPECT_EQ(b.mode("smoothing"), "off") << b.line; }
      }
    });
  });
}

// 26: the unit code stands in every program, mm always; the reader refuses the other one.
TEST_F(DangerModes, UnitCodeIsPrintedAndInchesAreRefused) {
  every_post([&] {
    const std::map<std::string, std::pair<std::string, std::string>> codes = {
        {"linuxcnc", {"G21", "G20"}},         {"fanuc", {"G21", "G20"}},
        {"mitsubishi_m80", {"G21", "G20"}},   {"haas", {"G21", "G20"}},
        {"siemens", {"G710", "G700"}},        {"heidenhain", {" MM\n", " INCH\n"}},
        {"apt", {"UNITS/MM", "UNITS/INCHES"}}};
    const auto& [mm, inch] = codes.at(post().dialect);
    const machines::Machine m = machine_of(post());
    const auto control = controls::control_of(m, standing(), tools());
    every_job([&](const ModalRun& run, const auto& paths) {
      for (const auto& b : run.blocks)
        if (b.moves) { EXPECT_EQ(b.mode("units"), "mm") << b.line; }
      const std::string text = text_of(post(), paths);
      const auto with = [&](const std::string& replacement) {
        std::string t = text;
        for (std::size_t at = 0; (at = t.find(mm, at)) != std::string::npos; at += replacement.size())
          t.replace(at, mm.size(), replacement);
        return execute_nc(t, "p", *control, [](const readback::ExecutedMove&) {});
      };
      EXPECT_TRUE(with(mm));
      EXPECT_FALSE(with(inch)) << "inches";
      EXPECT_FALSE(with(heidenhain() ? "\n" : "")) << "no unit code";
    });
  });
}

}  // namespace
}  // namespace toothpath
