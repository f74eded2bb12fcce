// The section on the work of the tools: numbers of a program that is known by heart, and its place on the page.
#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "app/report/page/page_of_run.h"
#include "app/report/sections/sections.h"

namespace toothpath::test {
namespace {

/// Two operations of tool 7 and one of tool 3; 10 teeth; each path feeds 30 mm and draws back 5 mm.
class ToolWork : public ::testing::Test {
 protected:
  ToolWork() {
    for (int op = 0; op < 3; ++op) {
      path::ClPath& path = paths_[static_cast<std::size_t>(op)];
      path.operation = op;
      const auto go = [&](double x, double z, path::MoveKind kind) {
        path.records.push_back({Vec3(x, 0, z), Vec3::UnitZ(), 100, kind, 0, 0});
      };
      go(0, 5, path::MoveKind::rapid);
      go(0, 0, path::MoveKind::engage);
      go(10, 0, path::MoveKind::feed);
      go(30, 0, path::MoveKind::feed);
      go(30, 5, path::MoveKind::retract);
      report_.operations.push_back({op, "finishing", op == 1 ? 3 : 7, 1000, 100, 5, 2.0, 0.5});
    }
    report_.teeth = 10;
    report_.gouge = proof::GougeResult{};
    report_.gouge->deepest.operation = 1;
    report_.gouge->deepest.line = 42;
    report_.gouge->deepest.depth_mm = 0.0005;
  }
  /// Our section, if it is there.
  [[nodiscard]] std::optional<report::Section> section() const {
    const path::ClPath* list[] = {&paths_[0], &paths_[1], &paths_[2]};
    for (auto& s : sections::sections_of({job_, machine_, report_, program_, list}))
      if (s.id == "tool-work") return s;
    return std::nullopt;
  }

  job::Job job_;
  machines::Machine machine_;
  joints::AxisProgram program_;
  report::RunReport report_;
  std::array<path::ClPath, 3> paths_;
};

TEST_F(ToolWork, SumsWayTimeAndTurnsOfAllTeeth) {
  const auto s = section();
  ASSERT_TRUE(s);
  ASSERT_EQ(s->rows.size(), 2u);
  for (const auto& row : s->rows) EXPECT_EQ(row.size(), s->columns.size());
  // 2 operations x 30 mm x 10 teeth = 0.6 m in 2 x 2 min at 1000 1/min.
  EXPECT_EQ(s->rows[0], (std::vector<std::string>{"7", "0, 2", "0.60", "4.0", "150", "4.0", ""}));
  EXPECT_EQ(s->rows[1], (std::vector<std::string>{"3", "1", "0.30", "2.0", "150", "2.0",
                                                  "line 42, r 0.000 mm, z 0.000 mm: 0.50 um"}));
}

TEST_F(ToolWork, AProgramThatBeginsInTheMiddleHasNone) {
  report_.restart = joints::ProgramRestart{1, 3};
  EXPECT_FALSE(section());
}

TEST_F(ToolWork, StandsOnThePage) {
  report_.sections = {*section()};
  const auto text = page::render_report_page(page::page_of_run({}, report_, {}, ""));
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("<a href=\"#tool-work\">Work of the tools</a>"), std::string::npos);
  EXPECT_NE(text->find("<section id=\"tool-work\">"), std::string::npos);
  EXPECT_NE(text->find("0.60"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
