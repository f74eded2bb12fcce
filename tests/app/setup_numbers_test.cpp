// The numbers of the set-up sheet against brute force: swing and heights over random turns, and how a wrong tool length
// moves the surface.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "app/process/proof_limits.h"
#include "app/report/sheet/length_tolerance.h"
#include "app/report/sheet/part_swing.h"
#include "app/report/sheet/restart_section.h"
#include "app/report/sheet/setup_sheet.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

machines::Machine trunnion_machine(double px, double py, double tilt_y, double tilt_z, int sign) {
  machines::Machine m;
  m.part_diameter_mm = 400;
  machines::RotaryAxis c;
  c.letter = 'C';
  c.point_mm = Vec3(px, py, 0);
  c.sign = sign;
  machines::RotaryAxis a;
  a.letter = 'A';
  a.direction = Vec3::UnitX();
  a.point_mm = Vec3(0, tilt_y, tilt_z);
  a.sign = sign;
  m.chain.table = {c, a};
  return m;
}

// A text that lost its decimal point is judged, not followed for millions of turns.
TEST(PartSwing, MoreThanOneTurnShowsNothingNew) {
  const machines::Machine m = trunnion_machine(1, 2, 3, 4, 1);
  const auto turned = [&](double to) {
    return sheet::part_swing({80, -30, 12}, {}, m, {{'Z', false, 200, 400, 0, 500}, {'A', true, 0, to, -2, 2}});
  };
  EXPECT_EQ(turned(2 * kPi).top_mm, turned(1e9).top_mm);
  EXPECT_EQ(turned(2 * kPi).bottom_mm, turned(1e9).bottom_mm);
}

TEST(PartSwing, HoldsEveryPointOfTheBlank) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const machines::Machine m =
        trunnion_machine(10 * u(random), 10 * u(random), 30 * u(random), 60 * u(random), trial % 2 == 0 ? 1 : -1);
    toothpath::joints::Setup setup;
    setup.axis_up = trial % 3 != 0;
    setup.origin_mm =
        Vec3(m.chain.table[0].point_mm.x() + 5 * u(random), m.chain.table[0].point_mm.y(), 80 + 40 * u(random));
    const sheet::BlankCylinder blank{80 + 50 * u(random), -30, 12};
    const double from = radians(-70 + 20 * u(random)), to = radians(10 + 20 * u(random));
    const std::vector<joints::AxisRange> axes = {
        {'Z', false, 200, 400, 0, 500}, {'C', true, -10, 10, -20, 20}, {'A', true, from, to, -2, 2}};
    const sheet::PartSwing swing = sheet::part_swing(blank, setup, m, axes);
    ASSERT_EQ(swing.axes.size(), 2u);
    EXPECT_EQ(swing.axes[0].limit_mm, 200);
    EXPECT_FALSE(swing.axes[1].limit_mm);
    EXPECT_EQ(swing.lowest_nose_mm, 200);
    double reach_c = 0, reach_a = 0, top = -1e9, bottom = 1e9;
    for (int i = 0; i < 20000; ++i) {
      const double phi = kPi * u(random), z = i % 2 == 0 ? blank.z_min_mm : blank.z_max_mm;
      const Vec3 p = setup.origin_mm +
                     setup.rotation() * Vec3(blank.radius_mm * std::cos(phi), blank.radius_mm * std::sin(phi), z);
      reach_c = std::max(reach_c, (p - m.chain.table[0].point_mm).head<2>().norm());
      const double tilt = i % 5 == 0 ? from : i % 5 == 1 ? to : 0.5 * (from + to) + 0.5 * (to - from) * u(random);
      const Vec3 q = m.chain.table_to_machine(p, {kPi * u(random), tilt});
      reach_a = std::max(reach_a, (q - m.chain.table[1].point_mm).tail<2>().norm());
      top = std::max(top, q.z());
      bottom = std::min(bottom, q.z());
    }
    EXPECT_GE(swing.axes[0].radius_mm, reach_c - 1e-9);
    EXPECT_LE(swing.axes[0].radius_mm, reach_c + 0.01);
    EXPECT_GE(swing.axes[1].radius_mm, reach_a - 1e-9);
    EXPECT_LE(swing.axes[1].radius_mm, reach_a + 1);
    EXPECT_GE(swing.top_mm, top);
    EXPECT_LE(swing.top_mm, top + 1);
    EXPECT_LE(swing.bottom_mm, bottom);
    EXPECT_GE(swing.bottom_mm, bottom - 1);
    EXPECT_EQ(sheet::swing_section(swing).rows.size(), 4u);
  }
}

// The operator reads which coolant is meant, and in which words the program switches it.
TEST(SetupSheet, NamesTheCoolantAndItsWords) {
  job::Job job;
  job.setup.emplace();
  machines::Machine m = trunnion_machine(0, 0, 0, 0, 1);
  m.dialect = "linuxcnc";
  const auto sheet = [&] {
    return sheet::setup_sheet(job, sheet::PartOutline{40, 60, 0, -5, -20, "a gear"}, m, report::RunReport{});
  };
  EXPECT_NE(sheet().find("<tr><td>coolant</td><td>off</td>"), std::string::npos);
  job.coolant = machines::Coolant::mist;
  EXPECT_NE(sheet().find("<tr><td>coolant</td><td>mist: on with M7, off with M9</td>"), std::string::npos) << sheet();
  m.post.coolant[machines::Coolant::through_spindle] = {"M150", "M151"};
  job.coolant = machines::Coolant::through_spindle;
  EXPECT_NE(sheet().find("through_spindle: on with M150, off with M151"), std::string::npos);
  EXPECT_NE(sheet().find("<td>a gear</td>"), std::string::npos);
}

/// The line that the words of a cell give a tooth: "tooth k, 0 to 59: line 36 + 3 k; tooth 60: line 300". 0: none.
int line_told(const std::string& cell, int tooth) {
  for (std::size_t at = 0; at < cell.size();) {
    const std::size_t end = std::min(cell.find("; ", at), cell.size());
    const std::string words = cell.substr(at, end - at);
    at = end + 2;
    int first = 0, last = 0, start = 0, step = 0;
    char sign = '+';
    if (std::sscanf(words.c_str(), "tooth k, %d to %d: line %d %c %d k", &first, &last, &start, &sign, &step) == 5) {
      if (tooth >= first && tooth <= last) return start + (sign == '-' ? -step : step) * tooth;
    } else if (std::sscanf(words.c_str(), "tooth k, %d to %d: line %d k", &first, &last, &step) == 3) {
      if (tooth >= first && tooth <= last) return step * tooth;
    } else if (std::sscanf(words.c_str(), "tooth %d: line %d", &first, &start) == 2) {
      if (tooth == first) return start;
    }
  }
  return 0;
}

// Teeth whose lines follow a rule stand in one cell; others in the appendix. What is told is the line of the menu.
TEST(RestartSheet, TellsTheLineOfEveryTooth) {
  job::Job job;
  job.file = "/x/job.toml";
  job.setup.emplace();
  job.setup->work_offset = "G54";
  std::mt19937 random(20261127);
  for (int n = 0; n < 200; ++n) {
    report::RunReport report;
    report.teeth = 10 + int(random() % 50);
    restart::RestartOperation op;
    op.tool = 1;
    op.at = {20, -1};
    const int breaks = int(random() % 7), first = n % 3 == 0 ? int(random() % 5) : 0;
    int line = 1 + int(random() % 60), step = 1 + int(random() % 9);
    for (int k = first; k < report.teeth; ++k) {
      op.teeth.push_back({k, k, {line, -1}});
      if (breaks > 0 && int(random() % unsigned(report.teeth)) < breaks) step = 1 + int(random() % 9);
      line += step;
    }
    report.restart_menu = restart::RestartMenu{{10, -1}, {op}};
    sheet::Sheet table, appendix;
    sheet::restart_section(table, job, report);
    sheet::restart_appendix(appendix, report);
    const std::string said = std::move(table).finish(), rest = std::move(appendix).finish();
    const std::size_t cell = said.rfind("<td>", said.find("</tbody>")) + 4;
    const std::string words = said.substr(cell, said.find("</td>", cell) - cell);
    const bool listed = words == "see the appendix";
    EXPECT_EQ(listed, rest.find("first line of every tooth") != std::string::npos);
    if (breaks == 0) { EXPECT_FALSE(listed) << words; }
    for (const auto& t : op.teeth) {
      if (listed) EXPECT_NE(rest.find(fmt::format("<b>{}</b> {}</span>", t.tooth, t.at.line)), std::string::npos);
      else EXPECT_EQ(line_told(words, t.tooth), t.at.line) << words;
    }
  }
}

// A ball that touches a surface everywhere, moved along its axis: no place is cut deeper than the share says.
TEST(LengthTolerance, NoPlaceIsMovedByMoreThanItsShare) {
  job::Job job;
  tool::ToolAssembly tool;
  tool.number = 3;
  tool.diameter_mm = 2;
  job.tools = {tool};
  path::MillingOperation finishing;
  finishing.type = path::OperationType::finishing;
  finishing.scallop_mm = 0.004;
  finishing.chord_tolerance_mm = 0.002;
  job.operations = {finishing};
  // A valley: normals from 20 to 160 deg about the y axis.
  proof::SurfaceGrid grid;
  grid.patch = tooth_space::Piece::flank_plus;
  for (int i = 0; i <= 60; ++i) {
    const double angle = radians(20 + i);  // one flank: to 80 deg
    grid.normals.emplace_back(std::cos(angle), 0, std::sin(angle));
    grid.points.emplace_back(-10 * std::cos(angle), 0, -10 * std::sin(angle));
    grid.reachable.push_back(1);
  }
  const Vec3 axis = Vec3(0.3, 0, 1).normalized();
  path::ClPath path;
  path.records.push_back({Vec3::Zero(), axis, 0, path::MoveKind::rapid, 0, 0});
  path.records.push_back({Vec3(1, 0, 0), axis, 100, path::MoveKind::feed, 0, 0});
  report::RunReport report;
  report.gouge_tolerance_mm = 0.002;
  report.gouge = proof::GougeResult{};
  report.gouge->bound_mm = 0.0005;
  report.finished = proof::ExcessResult{};
  report.finished->bound_mm = 0.004;
  const path::ClPath* list[] = {&path};
  const auto found = sheet::length_tolerances(job, process::proof_limits(job), report, list, {grid}, {});
  ASSERT_EQ(found.size(), 1u);
  const report::LengthTolerance& t = found[0];
  EXPECT_EQ(t.tool_number, 3);
  EXPECT_EQ(t.share, t.flank_share);
  const double R = tool.radius_mm();
  double deepest = -1, highest = -1;
  for (std::size_t k = 0; k < grid.points.size(); ++k) {
    const Vec3 centre = grid.points[k] + R * grid.normals[k];
    deepest = std::max(deepest, R - (centre - t.too_long_mm * axis - grid.points[k]).norm());
    highest = std::max(highest, (centre + *t.too_short_mm * axis - grid.points[k]).norm() - R);
  }
  EXPECT_LE(deepest, 0.002 - 0.0005);
  EXPECT_GT(deepest, 0.98 * (0.002 - 0.0005)) << "no tolerance is given away";
  EXPECT_LE(highest, (0.004 + 0.002 + 0.001 - 0.004) * 1.01);
  EXPECT_GT(highest, 0.98 * (0.004 + 0.002 + 0.001 - 0.004));
  // A corner that the ball does not reach does not count; a root that the tip faces does.
  grid.patch = tooth_space::Piece::root;
  grid.normals.push_back(axis);
  grid.points.push_back(Vec3::Zero());
  grid.reachable.push_back(0);
  EXPECT_EQ(sheet::length_tolerances(job, process::proof_limits(job), report, list, {grid}, {})[0].share, t.share);
  EXPECT_EQ(sheet::length_tolerances(job, process::proof_limits(job), report, list, {grid}, {})[0].flank_share, 0);
  grid.reachable.back() = 1;
  EXPECT_NEAR(sheet::length_tolerances(job, process::proof_limits(job), report, list, {grid}, {})[0].share, 1, 1e-12);
  EXPECT_EQ(sheet::length_tolerances(job, process::proof_limits(job), report, list, {grid}, {1}).front().share, 1);
  // Stock that an operation leaves is eaten before the part is.
  job.operations[0].type = path::OperationType::roughing;
  job.operations[0].allowance_mm = 0.1;
  proof::ExcessResult after;
  after.min_mm = 0.09;
  report.excess = {after};
  const auto rough = sheet::length_tolerances(job, process::proof_limits(job), report, list, {grid}, {1});
  EXPECT_NEAR(rough[0].too_long_mm, 0.09 + 0.0015, 1e-12);
  EXPECT_FALSE(rough[0].too_short_mm);
}

}  // namespace
}  // namespace toothpath
