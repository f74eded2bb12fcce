// Every kind of gear that a job can ask for, by the design rules of the samples: planned, approved and verified. A
// clean program is never reported.
#include "tests/cam/finger/jobs.h"

namespace toothpath {
namespace {

using namespace bevel_test;

struct Kind {
  int teeth, mate;
  double shaft_angle_deg, module, spiral_deg, width;
  bevel_gear::BevelForm form;
  int hand;
  double backlash;
};

void PrintTo(const Kind& k, std::ostream* out) {
  *out << k.teeth << "/" << k.mate << " Sigma " << k.shaft_angle_deg << " m " << k.module << " beta " << k.spiral_deg
       << " hand " << k.hand << (k.form == bevel_gear::BevelForm::herringbone ? " herringbone" : " single") << " j_t "
       << k.backlash;
}

/// By the design rules; the shaft angle enters through the pitch angle alone.
Designed designed(const Kind& k) {
  const double sigma = radians(k.shaft_angle_deg);
  const double delta = std::atan2(std::sin(sigma), static_cast<double>(k.mate) / k.teeth + std::cos(sigma));
  Designed d = design(k.teeth, 0, k.module, k.spiral_deg, k.width, k.hand, degrees(delta));
  d.p.form = k.form;
  d.p.backlash_mm = k.backlash;
  if (k.form == bevel_gear::BevelForm::herringbone) {
    const double R_e = k.teeth * k.module / (2 * std::sin(delta));
    d.p.apex_cone_distance_mm = R_e - d.p.face_width_mm / 2;
    d.p.relief_half_width_mm = 0.95 * d.p.addendum_mm;
  }
  return d;
}

class FingerKinds : public ::testing::TestWithParam<Kind> {};

TEST_P(FingerKinds, VerifyClean) {
  const Designed d = designed(GetParam());
  expect_good(mill_all(d), 5e-4, 0.3, {.columns = 9, .rows = 9, .ridge_columns = 10, .ridge_rows = 17});
}

constexpr auto kSingle = bevel_gear::BevelForm::single, kHerringbone = bevel_gear::BevelForm::herringbone;
INSTANTIATE_TEST_SUITE_P(
    All, FingerKinds,
    ::testing::Values(
        Kind{16, 31, 90, 4, 30, 0.35, kSingle, 1, 0}, Kind{31, 16, 90, 4, 30, 0.35, kSingle, -1, 0},
        Kind{16, 31, 90, 4, 30, 0.35, kHerringbone, -1, 0.2}, Kind{31, 16, 90, 4, 30, 0.35, kHerringbone, 1, 0.2},
        Kind{16, 31, 90, 4, 0, 0.35, kSingle, -1, 0.2}, Kind{31, 16, 90, 4, 0, 0.35, kHerringbone, 1, 0},
        Kind{16, 31, 60, 4, 0, 0.28, kHerringbone, -1, 0}, Kind{31, 16, 60, 4, 30, 0.28, kHerringbone, -1, 0.1},
        Kind{16, 31, 110, 4, 30, 0.35, kHerringbone, 1, 0}, Kind{31, 16, 110, 4, 5, 0.35, kSingle, 1, 0.1},
        Kind{12, 60, 90, 3, 45, 0.2, kHerringbone, 1, 0}, Kind{60, 12, 90, 3, 45, 0.2, kSingle, -1, 0},
        Kind{25, 25, 90, 5, 0, 0.22, kHerringbone, 1, 0}, Kind{18, 27, 90, 2, 30, 0.4, kHerringbone, 1, 0.05}));

// The convex side is one pass through the corner: it meets both offset curves, keeps its distance from the corner of
// the trace, and never leaves the tangent. The concave side ends where the curves cross.
TEST(FingerPasses, CornersOfAHerringbone) {
  for (const int hand : {1, -1}) {
    bevel_gear::BevelGearParameters p = w3();
    p.hand = hand;
    const bevel_gear::BevelGear g = made(p, pinion_mill());
    const auto passes = finger::wall_passes(g, true);
    ASSERT_EQ(passes.size(), 3u);
    for (const auto& pass : passes) {
      const bool convex = (pass.name == "wall L" ? 1 : -1) == hand;
      for (std::size_t i = 1; i < pass.pieces.size(); ++i) {
        const auto a = pass.pieces[i - 1].at(1.0), b = pass.pieces[i].at(0.0);
        EXPECT_LT(finger::crown_distance(a, b), 1e-9);
        EXPECT_NEAR(a.beta_c, b.beta_c, 1e-9) << "tangent, pieces " << i;
      }
      if (convex) {
        EXPECT_LT(pass.pieces.front().at(0.0).R_c, g.R_i());
        EXPECT_GT(pass.pieces.back().at(1.0).R_c, g.R_e());
      } else {
        const double gap_in = std::abs(pass.pieces.back().at(1.0).R_c - g.corner().R_c),
                     gap_out = std::abs(pass.pieces.front().at(0.0).R_c - g.corner().R_c);
        EXPECT_LT(std::min(gap_in, gap_out), 1e-9);
      }
    }
    bevel_gear::CutterCentre<double> corner;
    corner.R_c = g.R_ref();
    corner.theta_c = -hand * g.e_h() * g.sin_delta();
    for (const double t : {0.0, 0.3, 0.5, 0.9, 1.0})
      EXPECT_NEAR(finger::crown_distance(finger::corner_arc(g, t), corner), g.cutter().r_0, 1e-9);
  }
}

}  // namespace
}  // namespace toothpath
