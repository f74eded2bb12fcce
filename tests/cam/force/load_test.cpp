// Force and deflection: the table of the specification of line contact, section 9; what must hold of any load; and the
// rule for slender tools.
#include "cam/force/load.h"

#include <gtest/gtest.h>

#include "tests/cam/force/mills.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using force::OperationLoad;

OperationLoad got(const Result<OperationLoad>& load) {
  if (!load) {
    ADD_FAILURE() << load.error().message;
    return {};
  }
  return *load;
}

/// A row of the table: R = rho half way up the line, heights of the line as in compliance_test.
OperationLoad line_pass(double r_0, double half_angle, double shank, double stick_out, double stock,
                        double helix = 30) {
  const bool small = r_0 < 0.5;
  const double L = small ? 3.1 : 12.4;
  const auto mill = made(tapered_data(r_0, half_angle, small ? 13 : 16, shank, stick_out));
  const auto cut = force::side_engagement(L, r_0 + L / 2 * std::sin(radians(half_angle)), L / 2, stock);
  // 300 mm/min at 20000 1/min; the large mill 800 mm/min at 20000 1/min.
  return got(force::load_of(mill, {2, radians(helix), 20000, small ? 300.0 : 800.0}, cut));
}

// Left out: R1.0 with straight flutes, 56 um in the table; the length of line that gives the other three of its row
// gives 50.
TEST(Load, TheTableOfTheSpecification) {
  struct Row {
    double r_0, half_angle, shank, stick_out, stock, helix, force_N, um;
  };
  for (const Row& row :
       {Row{0.25, 3, 4, 22, 0.01, 30, 4.0, 54}, Row{0.25, 5, 4, 20, 0.01, 30, 3.7, 12},
        Row{0.25, 7, 6, 20, 0.01, 30, 3.5, 4.1}, Row{0.25, 10, 6, 16, 0.01, 30, 3.2, 1.2},
        Row{1, 5, 8, 32, 0.01, 30, 7.7, 1.7}, Row{0.25, 3, 4, 22, 0.02, 30, 0, 79},
        Row{0.25, 5, 4, 20, 0.02, 30, 0, 18}, Row{0.25, 7, 6, 20, 0.02, 30, 0, 6},
        Row{0.25, 10, 6, 16, 0.02, 30, 0, 1.7}, Row{0.25, 3, 4, 22, 0.1, 30, 0, 207},
        Row{0.25, 5, 4, 20, 0.1, 30, 0, 46}, Row{0.25, 3, 4, 22, 0.02, 0, 0, 715}, Row{0.25, 5, 4, 20, 0.02, 0, 0, 172},
        Row{1, 5, 8, 32, 0.02, 30, 0, 2.5}, Row{1, 5, 8, 32, 0.1, 30, 0, 7}}) {
    const OperationLoad load = line_pass(row.r_0, row.half_angle, row.shank, row.stick_out, row.stock, row.helix);
    if (row.force_N > 0) { EXPECT_NEAR(load.force_N, row.force_N, 0.05 + 1e-9) << row.half_angle; }
    EXPECT_NEAR(load.deflection_mm * 1000 / row.um, 1, 0.08) << row.r_0 << " " << row.half_angle << " " << row.stock;
  }
}

// Edges of a helical mill unrolled, over the patch L x a, turned through a pitch: what is in the cut at most.
TEST(Load, EdgeInTheCutAgainstTurningEdges) {
  Random random(7);
  for (int i = 0; i < 30; ++i) {
    const double L = random(0.2, 5), R = random(0.3, 2), q = random(0.005, 0.05), psi = radians(random(5, 50));
    const int z = 1 + int(random.index(6));
    const auto cut = force::side_engagement(L, R, L / 2, q);
    const OperationLoad load = got(force::load_of(made(tapered_data(0.25, 7, 4, 6, 20)), {z, psi, 20000, 300}, cut));
    const double pitch = 2 * kPi * R / z, of_one = std::min(L, cut.arc_mm / std::tan(psi));
    double peak = 0;
    for (int k = 0; k < 500; ++k) {
      double in_cut = 0;
      for (int tooth = -50; tooth <= 50; ++tooth) {  // u = first + h tan(psi), in the patch for 0 <= u <= a
        const double first = (tooth + k / 500.0) * pitch;
        const double from = std::max(0.0, -first / std::tan(psi)),
                     to = std::min(L, (cut.arc_mm - first) / std::tan(psi));
        in_cut += std::max(0.0, to - from);
      }
      peak = std::max(peak, in_cut);
    }
    // Whole teeth come and go: the formula counts parts of them.
    EXPECT_LE(std::abs(load.edge_mm - peak), of_one * (1 + 1e-9));
    if (L * std::tan(psi) + cut.arc_mm < pitch) { EXPECT_NEAR(load.edge_mm, peak, 0.02 * of_one); }
  }
}

TEST(Load, StraightFlutesPushHarder) {
  const OperationLoad helical = line_pass(0.25, 7, 6, 20, 0.02), straight = line_pass(0.25, 7, 6, 20, 0.02, 0);
  EXPECT_DOUBLE_EQ(straight.edge_mm, 3.1);
  EXPECT_GT(straight.force_N, 5 * helical.force_N);
  EXPECT_DOUBLE_EQ(straight.chip_mm, helical.chip_mm);
  EXPECT_DOUBLE_EQ(straight.power_W, helical.power_W);  // the same chips, one after the other
}

// More stock, more feed, a harder material: never less force. Nothing but the edge is left without chips.
TEST(Load, RisesWithWhatIsCut) {
  Random random(11);
  const auto mill = made(ball_data(0.5, 3.5, 0.95, 16));
  for (int i = 0; i < 40; ++i) {
    const double q = random(0.005, 0.1), w = random(0.05, 0.4), feed = random(50, 900), more = random(1.05, 2);
    const force::Cutting cutting{2, radians(random(0, 45)), 18000, feed};
    const auto load = [&](double stock, double step, const force::Cutting& c, const force::Material& m) {
      return got(force::load_of(mill, c, *force::ball_engagement(0.5, stock, step), m));
    };
    const OperationLoad once = load(q, w, cutting, {});
    EXPECT_GE(load(q * more, w, cutting, {}).force_N, once.force_N);
    force::Cutting faster = cutting;
    faster.feed_mm_min *= more;
    const OperationLoad fast = load(q, w, faster, {});
    EXPECT_GT(fast.force_N, once.force_N);
    EXPECT_NEAR(fast.chip_mm / once.chip_mm, more, 1e-12);
    EXPECT_NEAR(load(q, w, cutting, {6000, 30, 0.5}).force_N / once.force_N, 2, 1e-12);
    EXPECT_LE(once.mean_chip_mm, once.chip_mm);
    EXPECT_NEAR(once.deflection_mm, once.force_N * once.compliance.total(), 1e-15);
    // Without an edge force the power is K times what is taken off in a second: w q times the feed.
    const OperationLoad pure = load(q, w, cutting, {3000, 0, 0.5});
    const auto cut = *force::ball_engagement(0.5, q, w);
    EXPECT_NEAR(pure.power_W / (3000 * cut.section_mm2 * feed / 60 / 1000), 1, 1e-12);
    EXPECT_NEAR(pure.torque_Nm * 2 * kPi * 18000 / 60 / pure.power_W, 1, 1e-12);
  }
}

TEST(Load, RefusesWhatDoesNotTurn) {
  const auto mill = made(ball_data(0.5, 3.5, 0.95, 16));
  const auto cut = *force::ball_engagement(0.5, 0.02, 0.1);
  EXPECT_FALSE(force::load_of(mill, {0, 0, 18000, 500}, cut));
  EXPECT_FALSE(force::load_of(mill, {2, 0, 0, 500}, cut));
  EXPECT_FALSE(force::load_of(mill, {2, 0, 18000, 0}, cut));
  EXPECT_FALSE(force::load_of(mill, {2, radians(90), 18000, 500}, cut));
  EXPECT_FALSE(force::load_of(mill, {2, -0.1, 18000, 500}, cut));
}

// The old sample's finishing ball bends away; a stout ball does not.
TEST(Load, SlenderToolsAreNamedByTheirNumber) {
  const double step = force::step_of_scallop(0.25, 0.002);
  const auto cut = *force::ball_engagement(0.25, 0.028, step);
  const force::Cutting cutting{2, radians(30), 20000, 300};
  const auto old = force::slender(got(force::load_of(made(ball_data(0.25, 3.2, 0.46, 14)), cutting, cut)), 0.002);
  ASSERT_TRUE(old);
  EXPECT_GT(*old, 100);
  const OperationLoad stout = got(force::load_of(made(tapered_data(0.25, 10, 4, 12, 12)), cutting, cut));
  EXPECT_FALSE(force::slender(stout, 0.002));
  // Either side of the limit.
  EXPECT_FALSE(force::slender(stout, stout.deflection_mm));
  EXPECT_TRUE(force::slender(stout, stout.deflection_mm * (1 - 1e-9)));
}

}  // namespace
}  // namespace toothpath::test
