#include "app/report/page/report_page.h"

#include <gtest/gtest.h>

#include <limits>

#include "app/report/svg/html_text.h"
#include "tests/app/page/synthetic_page.h"

namespace toothpath {
namespace {

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

TEST(ReportPage, SameInputSameBytes) {
  const auto a = page::render_report_page(test::synthetic_page({})),
             b = page::render_report_page(test::synthetic_page({}));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*a, *b);
}

TEST(ReportPage, LoadsNothingFromElsewhere) {
  const auto text = page::render_report_page(test::synthetic_page({}));
  ASSERT_TRUE(text);
  for (const char* mark : {"http://", "https://", "src=", "@import", "url(", "<link"})
    EXPECT_EQ(count(*text, mark), 0U) << mark;
}

TEST(ReportPage, AwkwardNamesStayText) {
  test::SyntheticPageOptions options;
  options.awkward_names = true;
  const auto text = page::render_report_page(test::synthetic_page(options));
  ASSERT_TRUE(text);
  EXPECT_EQ(count(*text, "</script"), 3U);  // data, view, page
  EXPECT_EQ(count(*text, "<script"), 3U);
  EXPECT_EQ(count(*text, "<b>"), 0U);
  EXPECT_EQ(count(*text, "\xFF"), 0U);
  EXPECT_EQ(svg::valid_utf8(*text), *text);
}

TEST(ReportPage, NothingInANameTurnsOrHidesWhatFollows) {
  EXPECT_EQ(svg::html_escape("a\u202Eb\u009Bc\u2066d\u2028e\uFEFFf\x1Bg\xC0\xAFh"),
            "a\uFFFDb\uFFFDc\uFFFDd\uFFFDe\uFFFDf\uFFFDg\uFFFD\uFFFDh");
  EXPECT_EQ(svg::html_escape("\u00E4\u6F22 <\"'&>\n"), "\u00E4\u6F22 &lt;&quot;&#39;&amp;&gt;\n");
}

TEST(ReportPage, ThreeHundredThousandPointsStayBelowThreeMegabytes) {
  test::SyntheticPageOptions options;
  options.path_points = 300000;
  const page::ReportPage page = test::synthetic_page(options);
  std::size_t points = 0;
  for (const page::PagePath& path : page.paths) points += path.cl.records.size();
  ASSERT_GT(points, 280000U);
  const auto text = page::render_report_page(page);
  ASSERT_TRUE(text);
  EXPECT_LT(text->size(), 3000000U);
}

TEST(ReportPage, EmptyPartsAreLeftOut) {
  page::ReportPage page;
  page.title = "bare";
  const auto text = page::render_report_page(page);
  ASSERT_TRUE(text);
  for (const char* id : {"gouge", "deviation", "ledger", "direction", "motion", "work-precision", "stages", "tables"})
    EXPECT_EQ(count(*text, fmt::format("<section id=\"{}\">", id)), 0U) << id;
  EXPECT_EQ(count(*text, "<section id=\"space\" class=\"wide\" hidden>"), 1U);
}

TEST(ReportPage, EveryWorstPlaceHasItsRowAndItsLine) {
  const page::ReportPage page = test::synthetic_page({});
  const auto text = page::render_report_page(page);
  ASSERT_TRUE(text);
  for (const proof::WorstPlace& place : page.gouge->worst)
    EXPECT_EQ(count(*text, fmt::format("<div id=\"L{}\">", place.line)), 1U);
  EXPECT_EQ(count(*text, "<tr data-row="), page.gouge->worst.size());
}

TEST(ReportPage, RefusesWhatDoesNotFitTogether) {
  const page::ReportPage good = test::synthetic_page({});
  const auto refused = [&](auto&& spoil) {
    page::ReportPage page = good;
    spoil(page);
    return !page::render_report_page(page);
  };
  EXPECT_FALSE(refused([](page::ReportPage&) {}));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.surface[0].rows += 1; }));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.surface[0].normals.pop_back(); }));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.surface[1].excess_um[0].pop_back(); }));
  EXPECT_TRUE(
      refused([](page::ReportPage& p) { p.surface[0].points[3].x() = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.paths[0].cl.tool = 2; }));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.paths[0].nc_lines.pop_back(); }));
  EXPECT_TRUE(
      refused([](page::ReportPage& p) { p.paths[0].cl.records[5].tip.z() = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.paths[0].cl.records[5].pass = -1; }));
  EXPECT_TRUE(refused([](page::ReportPage& p) { p.tools[0].bodies[0].profile[0].x() = -1; }));
}

TEST(ReportPage, ExcerptsJoinWhereTheyTouch) {
  std::string program;
  for (int i = 1; i <= 100; ++i) program += fmt::format("N{}{}", i, i % 2 == 0 ? "\r\n" : "\n");
  const auto excerpts = page::nc_excerpts(program, {50, 10, 0, -4, 14, 500, 100}, 2);
  ASSERT_EQ(excerpts.size(), 3U);
  EXPECT_EQ(excerpts[0].first_line, 8);
  EXPECT_EQ(excerpts[0].lines.size(), 9U);  // 8 ... 16
  EXPECT_EQ(excerpts[1].first_line, 48);
  EXPECT_EQ(excerpts[2].first_line, 98);
  EXPECT_EQ(excerpts[2].lines.back(), "N100");
  for (const page::NcExcerpt& e : excerpts)
    for (std::size_t i = 0; i < e.lines.size(); ++i)
      EXPECT_EQ(e.lines[i], fmt::format("N{}", e.first_line + static_cast<int>(i)));
}

TEST(ReportPage, WritingToAMissingFolderIsAFileError) {
  const Status status = page::write_report_page(test::synthetic_page({}), "no/such/folder/report.html");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, DiagnosticKind::file_access);
}

}  // namespace
}  // namespace toothpath
