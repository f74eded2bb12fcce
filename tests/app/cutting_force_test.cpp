// Force and deflection of the operations of a job: which cut each is taken for, the keys of [material] and of
// operations, warnings, the row of the ledger that is a model, and what page and report.json say.
#include "app/process/cutting_force.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/report/page/page_of_run.h"
#include "app/report/sections/sections.h"
#include "app/report/svg/html_text.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

job::Job job_of(const std::string& text) {
  auto read = job::parse_job(text, "job.toml");
  if (auto* errors = read.refused()) {
    ADD_FAILURE() << to_text(*errors);
    return {};
  }
  return std::move(read).value();
}
std::string with(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

/// The report of a run as far as forces need it.
report::RunReport noted(const job::Job& job) {
  report::RunReport report;
  for (std::size_t k = 0; k < job.operations.size(); ++k) {
    const auto& o = job.operations[k];
    report.operations.push_back(
        {int(k), path::to_string(o.type), job.tools[std::size_t(o.tool)].number, o.speed_rpm, o.feed_mm_min, 0, 1, 1});
  }
  report.ledger.push_back({proof::ErrorSource::chord, 0.5, 0.4, "middles"});
  process::note_cutting_forces(report, job);
  return report;
}
const report::CuttingLoad& cutting(const report::RunReport& report, std::size_t k) {
  return *report.operations.at(k).cutting;
}

// dhfg_ball: slots for roughing, allowances and cusps for what comes after, and the mill of the old sample.
TEST(CuttingForce, OfTheOldSample) {
  const job::Job job = job_of(file_text(kSamples + "/dhfg_ball.toml"));
  const report::RunReport report = noted(job);
  ASSERT_EQ(report.operations.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    ASSERT_TRUE(cutting(report, k).load) << k;
    EXPECT_NEAR(cutting(report, k).load->deflection_mm,
                cutting(report, k).load->force_N * cutting(report, k).compliance->total(), 1e-15);
  }
  EXPECT_NEAR(degrees(cutting(report, 0).load->engaged_rad), 180, 1e-9);
  EXPECT_FALSE(cutting(report, 0).stock_mm);
  // Semi-finishing: 0.05 and the cusp of passes 0.2 apart, less 0.02; finishing: 0.02 and the cusp of 0.008.
  EXPECT_NEAR(*cutting(report, 2).stock_mm, 0.05 + 0.25 - std::sqrt(0.25 * 0.25 - 0.01) - 0.02, 1e-12);
  EXPECT_NEAR(*cutting(report, 3).stock_mm, 0.028, 1e-12);
  EXPECT_EQ(*cutting(report, 3).may_leave_mm, 0.002);
  EXPECT_EQ(*cutting(report, 1).may_leave_mm, 0.05);
  // One warning a tool, with its number.
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[1].find("tool 2 is slender: 662 um/N"), std::string::npos) << report.warnings[1];
  EXPECT_NE(report.warnings[1].find("does not cut it"), std::string::npos) << report.warnings[1];
  // The ledger: predicted, not measured.
  ASSERT_EQ(report.ledger.size(), 2u);
  const proof::LedgerEntry& row = report.ledger.back();
  EXPECT_EQ(row.source, proof::ErrorSource::deflection);
  EXPECT_NEAR(row.predicted_um, 1000 * cutting(report, 3).load->deflection_mm, 1e-9);
  EXPECT_FALSE(row.measured_um);
  EXPECT_NE(row.note.find("+-50 %"), std::string::npos);
}

// A stout mill in the same place is no warning.
TEST(CuttingForce, AStoutToolIsNotSlender) {
  std::string text = file_text(kSamples + "/spur_quick.toml");
  text = with(text, "shank_diameter = 0.95", "shank_diameter = 6.0");
  text = with(text, "flute_length = 6.0", "flute_length = 1.0");
  text = with(text, "stick_out = 16.0", "stick_out = 4.0");
  text = with(text, "step_down = 0.8", "step_down = 0.3");
  const report::RunReport report = noted(job_of(text));
  EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
  EXPECT_LT(cutting(report, 1).load->deflection_mm, 0.005);
}

TEST(CuttingForce, MaterialOfTheJob) {
  const std::string text = file_text(kSamples + "/spur_quick.toml");
  const job::Job plain = job_of(text);
  EXPECT_FALSE(plain.material.stated);
  EXPECT_EQ(plain.operations[0].chip_load_mm, 0);
  const job::Job soft = job_of(text +
                               "\n[material]\ncutting_coefficient = 1500.0\nedge_coefficient = 7.5\nyoungs_modulus = "
                               "300.0\nuncertainty = 0.3\n");
  EXPECT_TRUE(soft.material.stated);
  const report::RunReport a = noted(plain), b = noted(soft);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(cutting(b, k).load->force_N / cutting(a, k).load->force_N, 0.5, 1e-12);
    EXPECT_NEAR(cutting(b, k).compliance->total() / cutting(a, k).compliance->total(), 2, 1e-12);
    EXPECT_EQ(cutting(b, k).load->uncertainty, 0.3);
  }
  EXPECT_NE(a.force_basis.find("defaults"), std::string::npos);
  EXPECT_NE(b.force_basis.find("K = 1500 N/mm^2, K_e = 7.5 N/mm, tools of 300 GPa ([material]"), std::string::npos)
      << b.force_basis;
}

TEST(CuttingForce, ChipAndEngagementAskedFor) {
  const std::string text = file_text(kSamples + "/spur_quick.toml");
  const std::size_t without = noted(job_of(text)).warnings.size();
  const auto asked = [&](const std::string& keys) {
    return job_of(with(text, "step_down = 0.8", "step_down = 0.8\n" + keys));
  };
  const job::Job job = asked("chip_load = 0.02\nmax_engagement = 180.0");
  EXPECT_EQ(job.operations[0].chip_load_mm, 0.02);
  EXPECT_DOUBLE_EQ(job.operations[0].max_engagement_rad, kPi);
  EXPECT_EQ(noted(job).warnings.size(), without);  // 600 mm/min at 18000 1/min and two teeth: 16.7 um
  // The feed follows the chip load; what the teeth meet is told.
  const auto slower = noted(asked("chip_load = 0.016\nmax_engagement = 60.0"));
  EXPECT_NEAR(slower.operations[0].cutting->load->chip_mm, 0.016, 1e-9);
  const auto& warned = slower.warnings;
  ASSERT_EQ(warned.size(), without + 1);
  EXPECT_EQ(warned[0],
            "operation 0: its teeth are in the material over 180.0 deg, which exceeds max_engagement = 60 deg");
}

// What is not known is said, not made up: a finishing pass without an operation before it, walls of finger mills.
TEST(CuttingForce, WhatIsNotComputed) {
  std::string text = file_text(kSamples + "/spur_quick.toml");
  const auto from = text.find("[[operation]]"), to = text.find("[[operation]]", from + 1);
  const report::RunReport alone = noted(job_of(text.erase(from, to - from)));
  EXPECT_FALSE(cutting(alone, 0).load);
  EXPECT_TRUE(cutting(alone, 0).compliance);
  EXPECT_NE(cutting(alone, 0).not_computed.find("no operation before it"), std::string::npos);
  EXPECT_EQ(alone.ledger.size(), 1u);
  EXPECT_TRUE(alone.warnings.empty());
  const report::RunReport bevel = noted(job_of(file_text(kSamples + "/bevel_wheel.toml")));
  EXPECT_TRUE(cutting(bevel, 0).load);
  EXPECT_FALSE(cutting(bevel, 1).load);
  EXPECT_TRUE(cutting(bevel, 1).compliance);
  EXPECT_EQ(bevel.ledger.size(), 1u);
}

TEST(CuttingForce, StandsInReportAndOnThePage) {
  const job::Job job = job_of(file_text(kSamples + "/spur_quick.toml"));
  report::RunReport report = noted(job);
  report.operations[1].cutting->load.reset();
  report.operations[1].cutting->not_computed = "planted";
  const joints::AxisProgram program;
  const machines::Machine machine;
  report.sections = sections::sections_of({job, machine, report, program, {}});
  const auto own =
      std::find_if(report.sections.begin(), report.sections.end(), [](const auto& s) { return s.id == "force"; });
  ASSERT_NE(own, report.sections.end());
  ASSERT_EQ(own->rows.size(), 2u);
  for (const auto& row : own->rows) EXPECT_EQ(row.size(), own->columns.size());
  EXPECT_EQ(own->rows[0].back(), "slender");
  EXPECT_EQ(own->rows[1].back(), "not computed: planted");
  EXPECT_NE(own->note.find("K = 3000"), std::string::npos);
  report.command = "run";
  const auto json = nlohmann::json::parse(report::report_json(report));
  const auto& first = json["operations"][0];
  EXPECT_EQ(first["force_n"].get<double>(), cutting(report, 0).load->force_N);
  EXPECT_EQ(first["deflection_um"].get<double>(), 1000 * cutting(report, 0).load->deflection_mm);
  EXPECT_EQ(first["compliance_um_n"].get<double>(), 1000 * cutting(report, 0).compliance->total());
  EXPECT_EQ(first["chip_um"].get<double>(), 1000 * cutting(report, 0).load->chip_mm);
  EXPECT_TRUE(json["operations"][1]["force_n"].is_null());
  EXPECT_TRUE(json["operations"][1]["compliance_um_n"].is_number());
  EXPECT_EQ(json["operations"][1]["force_note"], "planted");
  EXPECT_TRUE(json["ledger"]["deflection"]["model_only"]);
  EXPECT_EQ(json["ledger"]["chord"]["measured"], 0.4);
  const auto page = page::render_report_page(page::page_of_run({}, report, {}, ""));
  ASSERT_TRUE(page);
  EXPECT_NE(page->find("<section id=\"force\">"), std::string::npos);
  EXPECT_NE(page->find("deflection: a model, not measured"), std::string::npos);
  // The sum of the ledger is that of the sources that are measured: the chord alone.
  EXPECT_NE(page->find(fmt::format("<td>sum</td><td class=\"n\">{}</td><td class=\"n\">{}</td>", svg::short_number(0.5),
                                   svg::short_number(0.4))),
            std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
