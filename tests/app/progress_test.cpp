// What a long run says while it runs: nothing of short stages in a file, a line of a long one; one line on a terminal.
#include "app/base/progress.h"

#include <gtest/gtest.h>
#include <pty.h>

#include <chrono>
#include <regex>
#include <thread>

#include "app/base/stage_clock.h"
#include "app/base/units.h"
#include "geometry/base/work_share.h"
#include "tests/app/program.h"

namespace toothpath {
namespace {

void wait(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

TEST(Progress, ShareAndRest) {
  EXPECT_EQ(app::share_and_rest(0, 10), "");
  EXPECT_EQ(app::share_and_rest(0.5, 0.5), "50 %") << "too soon to tell the rest";
  EXPECT_EQ(app::share_and_rest(0.25, 10), "25 %, about 30 s left");
  EXPECT_EQ(app::share_and_rest(0.02, 100), "2 %, about 1 h 21 min left");
  EXPECT_EQ(app::duration_text(59.4, true), "59 s");
  EXPECT_EQ(app::duration_text(59.4), "0 min 59 s");
  EXPECT_EQ(app::duration_text(59.6, true), "1 min 00 s");
  EXPECT_EQ(app::duration_text(3600 * 2 + 60 * 5), "2 h 05 min");
}

TEST(Progress, AFileGetsALineOfALongStageOnly) {
  testing::internal::CaptureStderr();
  {
    app::Progress progress(false);
    app::StageClock clock(progress);
    clock.run("short", [] { wait(1); });
    clock.run("whole", [&] {
      clock.run("long", [] {
        WorkShare share(4);
        share.add(2);
        wait(2900);
      });
      wait(500);  // told with the stage in it
    });
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(std::regex_match(said, std::regex("long: \\d+ s, 50 %, about \\d+ s left\n"))) << said;
}

TEST(Progress, QuietSaysNothing) {
  testing::internal::CaptureStderr();
  {
    app::Progress progress(true);
    app::StageClock clock(progress);
    clock.run("long", [] { wait(2500); });
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// What comes to a terminal on which the program runs.
std::string on_terminal(const std::vector<std::string>& arguments) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    ::setenv("TERM", "xterm", 1);
    std::vector<std::string> words = {TOOTHPATH_BINARY};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  std::string text;
  char part[4096];
  for (ssize_t n = 0; (n = ::read(terminal, part, sizeof part)) > 0;) text.append(part, std::size_t(n));
  ::close(terminal);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  return text;
}

TEST(Progress, ATerminalHasOneLineThatIsRewrittenAndGone) {
  const test::TestDir dir;
  const std::string text = on_terminal({"run", test::kSamples + "/spur_quick.toml", "--out", dir / "out"});
  const std::size_t table = text.find("spur-quick\r\n");
  ASSERT_NE(table, std::string::npos) << text;
  const std::string before = text.substr(0, table);
  EXPECT_EQ(before.find('\n'), std::string::npos) << "one line: " << before;
  EXPECT_NE(before.find("proof of the program"), std::string::npos);
  EXPECT_TRUE(before.ends_with("\r\033[2K")) << "the line is gone before the results";
  EXPECT_EQ(text.substr(table).find('\r' + std::string("\033")), std::string::npos) << "nothing behind them";
  EXPECT_EQ(on_terminal({"run", test::kSamples + "/spur_quick.toml", "--quiet", "--out", dir / "out"}), "");
}

TEST(Progress, AStageSaysHowFarItIs) {
  const test::TestDir dir;
  const std::string text =
      on_terminal({"run", test::kSamples + "/dhfg_ball.toml", "--threads", "1", "--out", dir / "out"});
  EXPECT_TRUE(std::regex_search(text, std::regex("proof of the program: [^\r\n]*\\d+ %"))) << text;
}

}  // namespace
}  // namespace toothpath
