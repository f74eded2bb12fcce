// Does the program cut the right gear? The strokes of the text, swept with the cutter's involute, against the exact
// flank.
#include <algorithm>

#include "postproc/shaper/program.h"
#include "postproc/shaper/simulation.h"
#include "tests/postproc/shaper/case.h"

namespace toothpath::test {
namespace {

/// Strokes of the text as motions of cutter and work: words times the axis signs of the machine.
std::vector<shaper::ShaperStroke> strokes_of_text(const std::string& text, const ShaperFacts& facts, int sign_a,
                                                  int sign_c) {
  std::vector<shaper::ShaperStroke> strokes;
  for (const auto& r : cutting_strokes(read_shaper_program(text), facts))
    strokes.push_back({r.x, r.z_from, r.z_to, radians(sign_a * r.a_from), radians(sign_a * r.a_to),
                       radians(sign_c * r.c_from), radians(sign_c * r.c_to)});
  return strokes;
}
std::vector<shaper::FlankSample> samples_of(const shaper::ShaperSetup& s, int rows, int columns, int tooth) {
  return shaper::flank_samples(s.surface, s.inner_radius_mm, s.outer_radius_mm, rows, columns, tooth);
}
/// Tooth that is generated in the middle of the last turn.
int middle_tooth(const shaper::ShaperSetup& s, int direction) {
  const double turn = direction * 2 * kPi * (s.strokes_infeed + s.strokes_turn / 2.0) / s.strokes_turn;
  const int k = static_cast<int>(std::lround(-turn / s.surface.pitch)) % s.work_teeth;
  return (k + s.work_teeth) % s.work_teeth;
}

// The profile distance against a dense polygon of the profile's own points.
TEST(ShaperSimulation, CutterDistanceAgreesWithPointsOfTheProfile) {
  for (const double rho : {0.0, 0.75}) {
    auto w = shaper_work();
    w.gear.shaper_tip_radius_mm = rho;
    const auto k = face_gear::make_shaper<double>(w.gear, 0);
    std::vector<std::pair<double, double>> outline;
    const int n = 4000;
    for (int j = 0; j <= n; ++j) {
      const double theta = k.theta_t * j / n, A = k.theta_0 + theta;
      outline.emplace_back(k.r_b * (std::cos(A) + theta * std::sin(A)), k.r_b * (std::sin(A) - theta * std::cos(A)));
    }
    for (int j = 0; j <= n; ++j) {
      const double A = k.A_t + (k.A_e - k.A_t) * j / n, h = k.rounding_h(A), g = k.rounding_g(A);
      outline.emplace_back(h * std::cos(A) + g * std::sin(A), h * std::sin(A) - g * std::cos(A));
    }
    for (int j = 0; j <= n; ++j) {
      const double psi = k.psi_c + (kPi / k.teeth - k.psi_c) * j / n;
      outline.emplace_back(k.r_a * std::cos(psi), k.r_a * std::sin(psi));
    }
    for (const auto& [x, y] : outline) EXPECT_NEAR(shaper::cutter_distance(k, x, y), 0, 1e-12);
    int inside = 0, outside = 0;
    for (double R = k.r_b + 0.8; R < k.r_a + 0.5; R += 0.137)
      for (double psi = 0; psi < kPi / k.teeth; psi += 0.0071) {
        const double x = R * std::cos(psi), y = R * std::sin(psi), d = shaper::cutter_distance(k, x, y);
        double nearest = 1e9;
        for (const auto& [px, py] : outline) nearest = std::min(nearest, std::hypot(x - px, y - py));
        // Deep inside the other flank and the base circle may be nearer; only the neighbourhood of the profile counts.
        if (std::abs(d) < 0.5) {
          EXPECT_NEAR(std::abs(d), nearest, 2e-3) << "R " << R << " psi " << psi << " rho " << rho;
        }
        d < 0 ? ++inside : ++outside;
      }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
  }
}

// With an endless number of strokes the sweep is the exact flank: no equation of meshing here, none iterated there.
TEST(ShaperSimulation, EndlessStrokesGiveTheExactFlank) {
  for (const double E : {15.0, -15.0, 0.0}) {
    auto w = shaper_work();
    w.gear.offset_mm = E;
    const auto s = shaper_setup(w, shaper_machine());
    const auto samples = samples_of(s, 4, 5, 0);
    ASSERT_EQ(samples.size(), 40u);
    for (const auto& p : samples) {
      EXPECT_NEAR(shaper::generated_distance(s.surface, p.point), 0, 1e-9);
      // A parallel step along the normal is the distance, unless its foot leaves the involute at the tip edge.
      if (s.surface.shaper.r_b * (s.surface.shaper.theta_t - p.theta) < 0.02) continue;
      EXPECT_NEAR(shaper::generated_distance(s.surface, p.point + 0.01 * p.normal), -0.01, 1e-9);
      EXPECT_NEAR(shaper::generated_distance(s.surface, p.point - 0.01 * p.normal), 0.01, 1e-9);
    }
  }
}

// The emitted text, all of it: nothing is cut below the flank, and what stays is the scallop of the finite feed.
TEST(ShaperSimulation, TheProgramCutsTheRightGear) {
  const auto w = shaper_work();
  for (const int sign_a : {1, -1})
    for (const int sign_c : {1, -1}) {
      const auto s = shaper_setup(w, shaper_machine(std::to_string(sign_a), std::to_string(sign_c)));
      const auto strokes =
          strokes_of_text(shaper::shaper_program_text(s), facts_of(w, 0.5, 359, s.sense), sign_a, sign_c);
      ASSERT_EQ(strokes.size(), std::size_t(s.strokes_total()));
      const auto d = shaped_deviation(s.surface, strokes, samples_of(s, 4, 5, middle_tooth(s, sign_a)));
      EXPECT_GE(d.deepest_um, -0.02);  // rounded words: 1e-5 deg at 147 mm is 0.026 um
      EXPECT_GT(d.max_left_um, 0);
      EXPECT_LT(d.max_left_um, 1.0);
    }
}

// A wrong sense, a wrong offset sign, a drifting work and a cutter that is fed too deep are not the right gear.
TEST(ShaperSimulation, PlantedFaultsAreSeenOnTheFlank) {
  const auto w = shaper_work();
  const auto s = shaper_setup(w, shaper_machine());
  const auto good = strokes_of_text(shaper::shaper_program_text(s), facts_of(w, 0.5, 359, 1), 1, 1);
  const auto samples = samples_of(s, 3, 3, middle_tooth(s, 1));
  const auto deepest = [&](auto&& change) {
    auto strokes = good;
    for (auto& stroke : strokes) change(stroke);
    return shaped_deviation(s.surface, strokes, samples).deepest_um;
  };
  EXPECT_LT(deepest([](shaper::ShaperStroke& k) { k.work_from *= -1, k.work_to *= -1; }), -100);
  EXPECT_LT(deepest([](shaper::ShaperStroke& k) { k.x_mm -= 0.01; }), -1);
  EXPECT_LT(deepest([](shaper::ShaperStroke& k) { k.work_from *= 1.00001, k.work_to *= 1.00001; }), -1);
  auto mirrored = s.surface;
  mirrored.E = -mirrored.E;
  EXPECT_LT(shaped_deviation(mirrored, good, samples).deepest_um, -100);
}

// Three strokes are enough to tell side and sense: at the roll angle of a flank point they touch it and do not cut it.
TEST(ShaperSimulation, ThreeStrokesTouchTheRightFlank) {
  const auto w = shaper_work();
  const auto s = shaper_setup(w, shaper_machine());
  const auto all = strokes_of_text(shaper::shaper_program_text(s), facts_of(w, 0.5, 359, 1), 1, 1);
  const int tooth = middle_tooth(s, 1);
  const double step = 2 * kPi * s.work_teeth / s.cutter_teeth / s.strokes_turn;
  int checked = 0;
  for (const auto& p : samples_of(s, 3, 3, tooth)) {
    // Tooth k is tooth 0 one pitch further: the cutter has turned k shaper pitches less. Whole turns of the work later
    // it is the same.
    const double phi = s.surface.flank_phi(p.side, p.theta, p.B) - tooth * 2 * kPi / s.cutter_teeth;
    const double turns =
        std::ceil((all[std::size_t(s.strokes_infeed)].cutter_from - phi) * s.cutter_teeth / (2 * kPi * s.work_teeth));
    const double at = phi + turns * 2 * kPi * s.work_teeth / s.cutter_teeth;
    const auto j = static_cast<std::size_t>(at / step);
    ASSERT_GE(j, std::size_t(s.strokes_infeed));
    ASSERT_LT(j + 2, all.size());
    const std::vector<shaper::ShaperStroke> three(all.begin() + std::ptrdiff_t(j) - 1,
                                                  all.begin() + std::ptrdiff_t(j) + 2);
    const double um = 1000 * swept_distance(s.surface, three, p.point);
    EXPECT_GT(um, -0.02);
    EXPECT_LT(um, 1.0);
    // The other flank's point with -B is cut at the roll angle -phi: unless that is the same, the three strokes do not
    // touch it.
    if (std::abs(s.surface.flank_phi(p.side, p.theta, p.B)) < 0.05) continue;
    const auto mirrored_side = s.surface.flank(-p.side, p.theta, -p.B);
    const double other = 1000 * swept_distance(s.surface, three, turned(mirrored_side.p, s.surface.pitch * tooth));
    EXPECT_GT(std::abs(other), 20);
    // The wrong sense takes the cutter somewhere else.
    auto wrong = three;
    for (auto& k : wrong) k.work_from *= -1, k.work_to *= -1;
    const double off = 1000 * swept_distance(s.surface, wrong, p.point);
    EXPECT_GT(std::abs(off), 20);
    ++checked;
  }
  EXPECT_GE(checked, 12);
}

// The seam: the first and the last tooth of the turn at full depth are as good as one in the middle. No drift.
TEST(ShaperSimulation, NoDriftOverTheWholeTurn) {
  const auto w = shaper_work();
  const auto s = shaper_setup(w, shaper_machine());
  const auto strokes = strokes_of_text(shaper::shaper_program_text(s), facts_of(w, 0.5, 359, 1), 1, 1);
  const double first = strokes[std::size_t(s.strokes_infeed)].work_from;
  const int seam = static_cast<int>(std::lround(-first / s.surface.pitch)) + s.work_teeth;
  for (const int tooth : {seam - 2, seam - 1, seam, seam + 1, seam + 2}) {
    const auto d = shaped_deviation(s.surface, strokes, samples_of(s, 3, 4, tooth));
    EXPECT_GT(d.deepest_um, -0.02) << tooth;
    EXPECT_LT(d.max_left_um, 1.0) << tooth;
  }
}

// Inside of the involute start the tip corner is cut off by the generating itself, whatever the feed: not an error of
// the feed. What is left of the places is never cut deeper than by rounding, so no mean is above the largest.
TEST(ShaperSimulation, FeedStudyCountsConjugatePlacesAlone) {
  auto w = shaper_work();
  w.gear.module_mm = 5.54395;
  w.gear.shaper_teeth = 15;
  w.gear.teeth = 88;
  w.gear.offset_mm = 47.6744;
  w.gear.zones.front().inner_radius_mm = 247.947;
  w.gear.zones.front().outer_radius_mm = 261.13;
  const auto s = shaper_setup(w, shaper_machine());
  const auto all = shaper::flank_samples(s.surface, s.inner_radius_mm, s.outer_radius_mm, 9, 13);
  const auto not_conjugate = std::count_if(all.begin(), all.end(), [](const auto& q) { return q.theta < 0; });
  EXPECT_GT(not_conjugate, 5);
  double deepest = 0;
  for (const auto& q : all) deepest = std::min(deepest, shaper::generated_distance(s.surface, q.point));
  EXPECT_LT(deepest, -0.03);
  for (const auto& row : shaper::feed_study(s, {0.1, 0.4, 1.6})) {
    EXPECT_EQ(row.deviation.points, all.size() - std::size_t(not_conjugate));
    EXPECT_GT(row.deviation.deepest_um, -0.01) << row.circular_feed_mm;
    EXPECT_LT(row.deviation.rms_um, row.deviation.max_left_um) << row.circular_feed_mm;
  }
}

// What the strokes leave grows with the square of the feed, and is the parabola that the curvature of the envelope
// predicts.
TEST(ShaperSimulation, ScallopsGrowWithTheSquareOfTheFeed) {
  const auto s = shaper_setup(shaper_work(), shaper_machine());
  const auto rows = shaper::feed_study(s, {0.1, 0.2, 0.4, 0.8});
  for (std::size_t k = 1; k < rows.size(); ++k) {
    // The samples meet the strokes at changing phases: one doubling scatters by some 10 %, three of them less so.
    EXPECT_NEAR(rows[k].deviation.rms_um / rows[k - 1].deviation.rms_um, 4, 1) << rows[k].circular_feed_mm;
    EXPECT_LT(rows[k].minutes, rows[k - 1].minutes);
    EXPECT_GT(rows[k].deviation.deepest_um, -1e-6);
  }
  EXPECT_NEAR(rows[3].deviation.rms_um / rows[0].deviation.rms_um, 64, 13);
  // The distance grows over the roll angle with the second derivative c = i^2 Sg cos B J/(r_b theta): c dphi^2/8
  // half-way between two strokes; at the end of the involute the edge takes over on one side, and it may be a whole
  // step: c dphi^2/2.
  const auto& g = s.surface;
  for (const auto& row : rows) {
    const double dphi = 2 * row.circular_feed_mm / s.pitch_diameter_mm;
    double bound = 0;
    for (const auto& p : shaper::flank_samples(g, s.inner_radius_mm, s.outer_radius_mm, 25, 33)) {
      if (p.theta <= 2 * dphi) continue;  // beside the base circle the curvature changes within one step
      const double c = g.i * g.i * std::cos(p.B) * g.flank_J(p.side, p.theta, p.B) / (g.shaper.r_b * p.theta);
      const bool at_edge = p.theta > g.shaper.theta_t - dphi;
      bound = std::max(bound, c * dphi * dphi / (at_edge ? 2 : 8) * 1000);
    }
    EXPECT_LT(row.deviation.max_left_um, 1.05 * bound);
    EXPECT_GT(row.deviation.max_left_um, 0.4 * bound);
  }
}

}  // namespace
}  // namespace toothpath::test
