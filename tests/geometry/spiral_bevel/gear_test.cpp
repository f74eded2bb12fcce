// Spiral bevel gears against printed numbers, against the sweep of their cutters, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <span>

#include "geometry/spiral_bevel/set_up.h"
#include "geometry/tooth_space/limits.h"
#include "geometry/tooth_space/tooth_size.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using spiral_bevel::Cut;
using spiral_bevel::SpiralBevelGear;
using spiral_bevel::SpiralBevelParameters;
using tooth_space::Piece;

SpiralBevelGear made(const SpiralBevelParameters& g) {
  auto gear = SpiralBevelGear::make(g);
  if (auto* refused = gear.refused()) ADD_FAILURE() << refused->front().diagnostic.message;
  return std::move(gear).value();
}

struct Sample {
  const char* name;
  SpiralBevelParameters (*gear)();
};
void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

SpiralBevelParameters left_gear() {
  auto g = nasa_gear();
  g.hand = -1;
  return g;
}

class SpiralBevelGears : public testing::TestWithParam<Sample> {
 protected:
  SpiralBevelParameters parameters_ = GetParam().gear();
  SpiralBevelGear gear_ = made(parameters_);
  const spiral_bevel::CutterKernel& kernel_ = gear_.space().kernel();

  /// A random place of a piece within the face.
  tooth_space::PatchPoint somewhere(Piece piece, Random& random) const {
    const auto& ring = gear_.space().outline();
    const double s = random(ring.s_from, ring.s_to);
    auto b = gear_.space().borders(piece);
    if (is_flank(piece)) {
      const auto tip = gear_.space().tip_edge(side_of(piece), s);
      (std::isfinite(b.from) ? b.to : b.from) = tip.value().u;
    }
    const auto q = tooth_space::place_at(gear_.space(), piece, b.from + (b.to - b.from) * random(0, 1), s);
    EXPECT_TRUE(q) << to_string(piece) << " " << s;
    return q.value_or(tooth_space::PatchPoint{});
  }
};

/// Signed distance from a place to one blade of the cutter at a roll, negative inside: a chain of elementary turns.
double to_blade(const SpiralBevelParameters& g, const spiral_bevel::CutterKernel& k, std::size_t i, const Vec3& gear,
                double t) {
  const Cut& cut = g.cuts[spiral_bevel::cut_of(g, i)];
  const spiral_bevel::Blade& blade = cut.blades[i];
  Vec3 p(gear.x(), g.hand > 0 ? -gear.y() : gear.y(), gear.z());
  double beta = 0, power = 1, factorial = 1;
  if (cut.generated) {
    beta = t;
    power = t;
    for (std::size_t n = 0; n < cut.modified.size(); ++n) {
      power *= t;
      factorial *= double(n + 2);
      beta -= cut.modified[n] * power / factorial;
    }
    beta *= cut.ratio_of_roll;
  } else {
    t = 0;
  }
  const auto about = [](const Vec3& axis, double angle, const Vec3& x) {
    return Vec3(Eigen::AngleAxisd(angle, axis) * x);
  };
  const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();
  p = about(Z, -beta - k.flanks[i].turn, p);
  const double gamma = cut.root_angle_rad;
  const Vec3 z_m(std::cos(gamma), 0, -std::sin(gamma));
  p -= Vec3(0, cut.work_offset_mm, -cut.machine_center_mm) + cut.sliding_base_mm * z_m;
  p = Vec3(p.dot(Vec3(std::sin(gamma), 0, std::cos(gamma))), -p.y(), p.dot(z_m));
  p = about(Z, -cut.cradle_angle_rad - t, p) - cut.radial_distance_mm * X;
  p = about(Z, -cut.swivel_rad, p);
  p = about(Y, -cut.tilt_rad, p);
  // In the plane of the profile, the flank at growing v.
  const double out = i == 0 ? 1 : -1, v = out * radius(p), w = out * blade.point_radius_mm, xi = p.z(),
               a = blade.pressure_angle_rad, r = blade.edge_radius_mm;
  const double x = v - (w - r * (1 - std::sin(a)) / std::cos(a)), y = xi - r;
  if (x >= 0 && -y >= x * std::tan(a)) return std::hypot(x, y) - r;
  return std::max((v - w - xi * std::tan(a)) * std::cos(a), -xi);
}

/// What the cutter of a flank leaves at a place: the least distance over the roll, the spec's G.
double left_by(const SpiralBevelParameters& g, const spiral_bevel::CutterKernel& k, std::size_t i, const Vec3& p,
               double middle) {
  if (!g.cuts.front().generated) return to_blade(g, k, i, p, 0);
  constexpr int kSteps = 120;
  const double step = 1.0 / kSteps;
  double best = INFINITY, at = middle;
  for (int n = -kSteps / 2; n <= kSteps / 2; ++n)
    if (const double d = to_blade(g, k, i, p, middle + n * step); d < best) best = d, at = middle + n * step;
  double low = at - step, high = at + step;
  for (int h = 0; h < 90; ++h) {
    const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
    (to_blade(g, k, i, p, a) < to_blade(g, k, i, p, b) ? high : low) =
        to_blade(g, k, i, p, a) < to_blade(g, k, i, p, b) ? b : a;
  }
  return std::min(best, to_blade(g, k, i, p, 0.5 * (low + high)));
}

/// The finished surface is what the cutter leaves, and a place off it lies as far from the sweep as from the surface.
TEST_P(SpiralBevelGears, AreWhatTheirCuttersLeave) {
  Random random(7);
  for (const Piece piece : {Piece::flank_plus, Piece::flank_minus, Piece::fillet_plus, Piece::fillet_minus})
    for (int n = 0; n < 12; ++n) {
      const std::size_t i = kernel_.index(side_of(piece));
      const auto q = somewhere(piece, random);
      const double middle = kernel_.flanks[i].by_circle ? 0 : kernel_.flanks[i].at_mean;
      for (const double away : {0.0, 0.05, -0.05})
        EXPECT_NEAR(left_by(parameters_, kernel_, i, q.p - away * q.n, middle), away, 1e-9)
            << to_string(piece) << " at " << q.p.transpose();
    }
}

TEST_P(SpiralBevelGears, NormalsAreSquareAndPiecesJoinSmoothly) {
  Random random(3);
  for (const Piece piece :
       {Piece::flank_plus, Piece::flank_minus, Piece::fillet_plus, Piece::fillet_minus, Piece::root})
    for (int n = 0; n < 8; ++n) {
      const auto q = somewhere(piece, random);
      EXPECT_NEAR(q.n.norm(), 1, 1e-13);
      EXPECT_LT(std::abs(q.n.dot(q.pu)) / q.pu.norm() + std::abs(q.n.dot(q.pv)) / q.pv.norm(), 1e-10)
          << to_string(piece);
    }
  for (const double v : {-90.0, -80.0, -70.0})
    for (const int side : {1, -1}) {
      const auto& f = kernel_.flank(side);
      const auto flank = gear_.space().point(tooth_space::flank_of(side), f.u_F, v),
                 top = gear_.space().point(tooth_space::fillet_of(side), f.alpha, v),
                 bottom = gear_.space().point(tooth_space::fillet_of(side), kPi / 2, v),
                 root = gear_.space().point(Piece::root, side > 0 ? 0 : 1, v);
      ASSERT_TRUE(flank && top && bottom && root);
      EXPECT_LT((flank->p - top->p).norm() + (bottom->p - root->p).norm(), 1e-10);
      EXPECT_LT((flank->n - top->n).norm() + (bottom->n - root->n).norm(), 1e-10);
    }
}

/// The root is the cone, or without a roll the tip plane, that the cutter's tip leaves.
TEST_P(SpiralBevelGears, RootIsWhereTheTipPasses) {
  Random random(5);
  for (int n = 0; n < 8; ++n) {
    const auto q = somewhere(Piece::root, random);
    const Cut& cut = parameters_.cuts.front();
    if (kernel_.root == spiral_bevel::RootForm::cone)
      EXPECT_NEAR(std::atan2(radius(q.p), q.p.z() - spiral_bevel::root_apex_z(cut)), cut.root_angle_rad, 2e-10);
    else if (kernel_.root == spiral_bevel::RootForm::plane)
      EXPECT_NEAR(to_blade(parameters_, kernel_, 0, q.p, 0), 0, 1e-11);
    else EXPECT_NEAR(left_by(parameters_, kernel_, 0, q.p, kernel_.flanks[0].at_mean), 0, 2e-3);
  }
}

/// The other hand is the mirror image.
TEST_P(SpiralBevelGears, OtherHandIsTheMirrorImage) {
  auto other = parameters_;
  other.hand = -other.hand;
  const auto mirrored = made(other);
  Random random(9);
  for (int n = 0; n < 5; ++n)
    for (const int side : {1, -1}) {
      const double u = random(1, 4), v = random(-92, -70);
      const auto a = gear_.space().point(tooth_space::flank_of(side), u, v),
                 b = mirrored.space().point(tooth_space::flank_of(-side), u, v);
      ASSERT_TRUE(a && b);
      EXPECT_LT((Vec3(a->p.x(), -a->p.y(), a->p.z()) - b->p).norm(), 1e-12 * 100);
      EXPECT_LT((Vec3(a->n.x(), -a->n.y(), a->n.z()) - b->n).norm(), 1e-12);
    }
}

/// Second derivatives at random places lie in the enclosures of boxes around them.
TEST_P(SpiralBevelGears, EnclosuresHold) {
  Random random(3);
  for (const Piece piece :
       {Piece::flank_plus, Piece::flank_minus, Piece::fillet_plus, Piece::fillet_minus, Piece::root})
    for (int k = 0; k < 8; ++k) {
      const bool flank = is_flank(piece);
      const auto b = gear_.space().borders(piece);
      const double s = random(-93, -69), high = flank ? gear_.space().tip_edge(side_of(piece), s)->u : 0,
                   u = flank ? kernel_.flank(side_of(piece)).u_F * random(1, 2) + random(0, 0.8) * high
                             : b.from + (b.to - b.from) * random(0, 1);
      tooth_space::PatchFrame frame;
      frame.origin = {u, kernel_.solve_v(piece, u, s, kernel_.v_at(piece, u, s)).value()};
      const double ha = flank ? 0.2 : 0.01, hb = 0.3, step = 1e-4;
      const auto jet = gear_.space().enclosure(piece, frame, ha, hb);
      ASSERT_TRUE(jet);
      const Vec2 at = frame.origin + Vec2(random(-0.9, 0.9) * ha, random(-0.9, 0.9) * hb);
      const auto a = gear_.space().at(piece, at.x() - step, at.y()), c = gear_.space().at(piece, at.x() + step, at.y());
      const auto d = gear_.space().at(piece, at.x(), at.y() - step), e = gear_.space().at(piece, at.x(), at.y() + step);
      const std::array<Vec3, 3> second{(c->pu - a->pu) / (2 * step), (c->pv - a->pv) / (2 * step),
                                       (e->pv - d->pv) / (2 * step)};
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
          const double x = second[j][int(i)], slack = 1e-4 * (1 + std::abs(x));
          EXPECT_GT(x, jet->second[j][i].low - slack);
          EXPECT_LT(x, jet->second[j][i].high + slack);
          EXPECT_TRUE(jet->second[j][i].finite()) << to_string(piece) << " " << j;
        }
    }
}

/// Bounds of the tip edge lie so close that what they allow it to leave its chord by is no matter to a proof of 3 um.
TEST_P(SpiralBevelGears, TipEdgesAreBoundedClosely) {
  const auto& ring = gear_.space().outline();
  const double step = (ring.s_to - ring.s_from) / 256;
  for (const int side : {1, -1})
    for (const double share : {0.0, 0.3, 0.6, 0.99}) {
      const double s = ring.s_from + share * (ring.s_to - ring.s_from), r = ring.chart.r(s, gear_.space().tip(s));
      const auto from = gear_.space().tip_edge(side, s), to = gear_.space().tip_edge(side, s + step, from);
      ASSERT_TRUE(from && to);
      const auto edge = gear_.space().tip_azimuth(side, *from, s, *to, s + step);
      ASSERT_TRUE(edge) << side << " at " << s;
      const double slope = (to->azimuth - from->azimuth) / step;
      EXPECT_GT(slope, edge->slope.low);
      EXPECT_LT(slope, edge->slope.high);
      EXPECT_LT(0.125 * step * step * r * (edge->bend.high - edge->bend.low), 3e-4) << side << " at " << s;
    }
}

/// Followed by the place on the circles of the blades a flank is the same as followed by its roll.
TEST_P(SpiralBevelGears, PlacesOfTheCircleAndRollsMakeOneFlank) {
  Random random(13);
  for (const int side : {1, -1}) {
    const spiral_bevel::CutFlank& by_roll = kernel_.flank(side);
    if (!by_roll.generated || by_roll.tilted || by_roll.rolls != 1 || by_roll.by_circle) continue;
    for (const bool fillet : {false, true})
      for (int n = 0; n < 20; ++n) {
        const double u = fillet ? random(by_roll.alpha, kPi / 2) : by_roll.u_F + random(0, 5), v = random(-93, -69),
                     t = by_roll.parameter(v);
        Vec3 p, normal, q, other;
        if (!by_roll.place<double>(fillet, u, v, p, normal)) continue;
        const auto on = by_roll.touching<double>(by_roll.profile<double>(fillet, u), by_roll.cradled(by_roll.q + t),
                                                 by_roll.work(t).ratio);
        ASSERT_TRUE(on);
        spiral_bevel::CutFlank by_circle = by_roll;
        by_circle.by_circle = true;
        by_circle.at_mean = std::atan2((*on)[1], (*on)[0]);
        double off = INFINITY;  // two rolls touch there; one of them is that of the flank
        for (const double branch : {1.0, -1.0}) {
          by_circle.branch = branch;
          ASSERT_TRUE(by_circle.place<double>(fillet, u, by_circle.v_mean, q, other));
          off = std::min(off, (p - q).norm() + 100 * (normal - other).norm());
        }
        EXPECT_LT(off, 1e-10) << side << " " << fillet << " " << u << " " << v;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SpiralBevelGears,
                         testing::Values(Sample{"pinion", nasa_pinion}, Sample{"gear", nasa_gear},
                                         Sample{"left_gear", left_gear}, Sample{"formate", formate_wheel},
                                         Sample{"tilted", tilted_gear}, Sample{"zerol", zerol_gear},
                                         Sample{"steep", [] { return steep_gear(10); }}),
                         [](const testing::TestParamInfo<Sample>& s) { return std::string(s.param.name); });

struct PrintedRoll {
  int side;
  bool fillet;
  double r, z, azimuth;
  Vec3 n;
  double roll;
};

void expect_printed(const SpiralBevelParameters& parameters, std::span<const PrintedRoll> all) {
  const auto gear = made(parameters);
  const auto& k = gear.space().kernel();
  const auto& chart = gear.space().outline().chart;
  for (const PrintedRoll& q : all) {
    const Piece piece = q.fillet ? tooth_space::fillet_of(q.side) : tooth_space::flank_of(q.side);
    const auto& f = k.flank(q.side);
    const Vec3 target(q.r, 0, q.z);
    const Vec2 start = q.fillet ? Vec2(0.5 * (f.alpha + kPi / 2), chart.along(target)) : k.middle[k.index(q.side)];
    const auto at = k.solve(piece, chart.along(target), chart.up(target), start);
    ASSERT_TRUE(at);
    const auto place = gear.space().point(piece, at->x(), at->y());
    EXPECT_NEAR(azimuth(place->p), q.azimuth, 2e-9);
    EXPECT_LT((place->n - q.n).norm(), 1e-9);
    EXPECT_NEAR(f.parameter(at->y()), q.roll, 1e-9);
  }
}

TEST(SpiralBevel, PlacesAndNormalsAreThePrintedOnes) {
  const PrintedRoll pinion[] = {
      {1,
       false,
       27.919052077,
       76.129398215,
       -0.175895302,
       {0.751608867830, 0.571569123787, 0.329230688929},
       -0.020058680812},
      {-1,
       false,
       27.919052077,
       76.129398215,
       0.166823837,
       {0.355868603003, -0.656659155110, -0.664948337397},
       0.022320370756},
      {1,
       false,
       26.340735455,
       65.945974617,
       0.034291630,
       {0.669596579887, 0.704529581107, 0.235113780006},
       0.014322619359},
      {-1,
       false,
       33.890928348,
       84.848439574,
       -0.059378158,
       {0.224046657369, -0.633605613139, -0.740504572788},
       -0.021060395440},
      {1,
       true,
       23.964848392,
       77.447342229,
       -0.086009397,
       {0.657888468598, 0.684979285953, 0.313027380114},
       0.086267389863},
      {-1,
       true,
       23.964848392,
       77.447342229,
       0.093116877,
       {0.382352062880, -0.698843474734, -0.604503678924},
       -0.079532822604},
  };
  const PrintedRoll gear[] = {
      {1,
       false,
       76.617525577,
       26.454532340,
       -0.042174152,
       {-0.331192595537, 0.768500187837, -0.547465913054},
       0.020230940555},
      {-1,
       false,
       76.617525577,
       26.454532340,
       0.043390821,
       {0.653909075023, -0.743128235097, -0.141997703518},
       -0.016632170501},
      {1,
       false,
       67.653732141,
       21.216981327,
       -0.148927155,
       {-0.196629592326, 0.814823403341, -0.545343584165},
       0.174840535988},
      {-1,
       false,
       87.045701225,
       27.298523807,
       0.152798893,
       {0.782847462894, -0.606817074898, -0.137560486523},
       -0.183904260163},
      {1,
       true,
       75.299581587,
       30.408735930,
       -0.014027988,
       {-0.264421611150, 0.719468386995, -0.642219940263},
       -0.074566724093},
      {-1,
       true,
       75.299581587,
       30.408735930,
       0.020807377,
       {0.653603312190, -0.706347845699, -0.271800351674},
       0.069442287059},
  };
  expect_printed(nasa_pinion(), pinion);
  expect_printed(nasa_gear(), gear);
  EXPECT_NEAR(made(nasa_gear()).space_width_mm(), 7.431745786, 2e-9);
}

/// The report's own points of root and toe, each flank as its settings leave it.
TEST(SpiralBevel, PointsOfTheReportLieOnTheFlanks) {
  const struct {
    bool pinion;
    std::size_t flank;
    Vec3 p;
  } all[] = {{true, 0, {20.188392169, 3.857680566, 65.165554435}},
             {true, 1, {18.017396473, 9.890717975, 65.165554435}},
             {false, 0, {62.850622772, -8.624959452, 25.035151348}},
             {false, 1, {63.178156521, -5.754237313, 25.035151348}}};
  for (const auto& q : all) {
    const auto parameters = q.pinion ? nasa_pinion() : nasa_gear();
    const auto gear = made(parameters);
    auto kernel = gear.space().kernel();
    for (auto& flank : kernel.flanks) flank.turn = 0;
    EXPECT_NEAR(left_by(parameters, kernel, q.flank, q.p, 0), 0, 2.6e-6);
    for (auto& flank : kernel.flanks) flank.tilted = true;  // through the matrices of a tilt of 0
    const spiral_bevel::CutterSpace space(kernel);
    const int side = (q.flank == 0 ? 1 : -1) * kernel.hand;
    const auto& chart = space.outline().chart;
    const auto at = kernel.solve(tooth_space::flank_of(side), chart.along(q.p), chart.up(q.p), kernel.middle[q.flank]);
    ASSERT_TRUE(at);
    EXPECT_LT((space.point(tooth_space::flank_of(side), at->x(), at->y())->p - q.p).norm(), 5e-6);
  }
}

/// Without a roll every place lies on the cutter's cone, and the rolled flank tends to it as the root angle grows to 90
/// degrees.
TEST(SpiralBevel, FormateIsTheLimitOfTheRoll) {
  auto parameters = formate_wheel();
  const auto distance = [](double root_angle) {
    auto g = nasa_gear();
    g.pitch_angle_rad = radians(90);
    g.tip_angle_rad = radians(91);
    auto& cut = g.cuts[0];
    cut.root_angle_rad = root_angle;
    cut.ratio_of_roll = 1 / std::sin(root_angle);
    cut.sliding_base_mm = -4.5;
    auto plunged = g;
    plunged.cuts[0].generated = false;
    const auto kernel = spiral_bevel::set_up(g).value().kernel;
    double most = 0;
    for (const double v : {-90.0, -80.0, -70.0}) {
      Vec3 p, n;
      EXPECT_TRUE(kernel.place<double>(Piece::flank_plus, 5.0, v, p, n));
      auto still = kernel;
      for (auto& f : still.flanks) f.turn = 0;
      most = std::max(most, std::abs(to_blade(plunged, kernel, 0, p, 0)));
    }
    return most;
  };
  EXPECT_LT(distance(radians(90)), 1e-12 * 100);
  EXPECT_LT(distance(radians(89.9)), 0.2 * distance(radians(89)));
  EXPECT_GT(distance(radians(89)), 1e-4);
}

/// Least fillet radius and lands as they are printed; the ball on the root as a dense sample of the walls finds it.
TEST(SpiralBevel, LimitsAreThePrintedOnes) {
  const auto pinion = made(nasa_pinion());
  const auto& space = pinion.space();
  const auto& ring = space.outline();
  EXPECT_NEAR(tooth_space::fillet_radius_min_mm(space, ring.s_to, -1), 0.8277, 2e-4);
  EXPECT_NEAR(tooth_space::top_land_mm(space, ring.s_to), 0.446, 1e-3);
  EXPECT_NEAR(tooth_space::top_land_mm(space, ring.s_from), 0.248, 1e-3);
  EXPECT_NEAR(tooth_space::root_ball_radius_mm(space, ring.s_to), 2.358, 2e-3);
}

/// Tip edges over the whole face are enclosed, also where the roll hardly moves the place along the tooth.
TEST(SpiralBevel, TipEdgesAreEnclosed) {
  constexpr int kStretches = 64;
  for (const auto& parameters : {nasa_pinion(), nasa_gear(), formate_wheel()}) {
    const auto gear = made(parameters);
    const auto& space = gear.space();
    const auto& ring = space.outline();
    for (const int side : {1, -1}) {
      auto from = space.tip_edge(side, ring.s_from).value();
      for (int n = 1; n <= kStretches; ++n) {
        const double s_from = ring.s_from + (ring.s_to - ring.s_from) * (n - 1) / kStretches,
                     s_to = ring.s_from + (ring.s_to - ring.s_from) * n / kStretches;
        const auto to = space.tip_edge(side, s_to, from).value();
        const auto bend = space.tip_azimuth(side, from, s_from, to, s_to);
        ASSERT_TRUE(bend) << side << " " << n;
        const double slope = (to.azimuth - from.azimuth) / (s_to - s_from);
        EXPECT_TRUE(bend->slope.low <= slope && slope <= bend->slope.high);
        from = to;
      }
    }
  }
}

/// Whatever the blades, v grows about as s does along flank and fillet, over the face and a little beyond its ends.
TEST(SpiralBevel, FlanksAreFollowedEvenly) {
  constexpr int kStations = 7, kHeights = 16;
  int by_circle = 0;
  for (const double blade : {8.3, 8.5, 10.0, 11.45, 12.0, 14.0, 22.0}) {
    const auto gear = made(steep_gear(blade));
    const auto& space = gear.space();
    const auto& ring = space.outline();
    for (const int side : {1, -1}) {
      by_circle += space.kernel().flank(side).by_circle ? 1 : 0;
      for (const Piece piece : {tooth_space::fillet_of(side), tooth_space::flank_of(side)})
        for (int k = 0; k < kStations; ++k)
          for (int n = 0; n <= kHeights; ++n) {
            const double s = ring.s_from - 2.5 + (ring.s_to - ring.s_from + 5) * k / (kStations - 1);
            auto b = space.borders(piece);
            if (is_flank(piece)) (side > 0 ? b.from : b.to) = space.kernel().about_tip(side, s).x();
            const auto q = tooth_space::place_at(space, piece, b.from + (b.to - b.from) * n / kHeights, s);
            ASSERT_TRUE(q) << blade << " " << to_string(piece) << " " << s;
            const double by_v = ring.chart.along(q->p, q->pv);
            EXPECT_GT(by_v, 0.125) << blade << " " << to_string(piece) << " " << s;
            EXPECT_LT(by_v, 8) << blade << " " << to_string(piece) << " " << s;
          }
    }
  }
  EXPECT_EQ(by_circle, 5);
}

/// The same cutters on a blank whose face ends elsewhere leave the same flanks: a narrow face is a piece of a wide one,
/// turned about the axis.
TEST(SpiralBevel, ANarrowFaceIsAPieceOfAWideOne) {
  constexpr int kAlong = 3, kHeights = 5;
  for (const double blade : {8.5, 10.0, 12.0, 22.0})
    for (const double outer : {73.75, 93.7514}) {
      const auto wide = made(steep_gear(blade));
      auto parameters = steep_gear(blade);
      parameters.outer_cone_distance_mm = outer;
      parameters.face_width_mm = 5.4;
      const auto narrow = made(parameters);
      const auto& ring = narrow.space().outline();
      std::vector<double> turns;
      for (const int side : {1, -1})
        for (int k = 0; k <= kAlong; ++k)
          for (int n = 0; n <= kHeights; ++n) {
            const double s = ring.s_from + (ring.s_to - ring.s_from) * k / kAlong, tip = narrow.space().tip(s),
                         h = tip - 2.0 * n / kHeights;
            const auto a = tooth_space::flank_at(narrow.space(), side, s, h),
                       b = tooth_space::flank_at(wide.space(), side, s, h);
            ASSERT_TRUE(a && b) << blade << ", outer " << outer << ", side " << side << ", s " << s << ", h " << h;
            turns.push_back(wrapped(azimuth(a->at.p) - azimuth(b->at.p)));
          }
      const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
      EXPECT_LE((*most - *least) * outer, 1e-8) << blade << ", outer " << outer;
    }
}

TEST(SpiralBevel, EveryLimitIsRefusedByItsKey) {
  using P = SpiralBevelParameters;
  const std::tuple<const char*, P (*)(), std::function<void(P&)>> all[] = {
      {"teeth", nasa_gear, [](P& g) { g.teeth = 3; }},
      {"pitch_angle", nasa_gear, [](P& g) { g.pitch_angle_rad = radians(95); }},
      {"face_width", nasa_gear, [](P& g) { g.face_width_mm = 90; }},
      {"outer_cone_distance", nasa_gear, [](P& g) { g.outer_cone_distance_mm = NAN; }},
      {"tip_angle", nasa_gear, [](P& g) { g.tip_angle_rad = radians(67); }},
      {"tip_angle", nasa_pinion, [](P& g) { g.tip_angle_rad = radians(25); }},
      {"root_angle", nasa_gear, [](P& g) { g.root_angle_rad = radians(67.7); }},
      {"root_apex", nasa_gear, [](P& g) { g.root_apex_mm = 0.006; }},
      {"mean_space_width", nasa_gear, [](P& g) { g.mean_space_width_mm = 7; }},
      {"backlash", nasa_gear, [](P& g) { g.backlash_mm = 0.1; }},
      {"backlash", nasa_pinion, [](P& g) { g.backlash_mm = 0.1; }},
      {"mean_space_width", nasa_pinion, [](P& g) { g.mean_space_width_mm = 3; }},
      {"mean_space_width", nasa_pinion, [](P& g) { g.mean_space_width_mm = 14; }},
      {"cut[0].flank", nasa_gear, [](P& g) { g.cuts[0].flank = spiral_bevel::Cuts::concave; }},
      {"cut[1].flank", nasa_pinion, [](P& g) { g.cuts[1] = g.cuts[0]; }},
      {"cut[1].machine_root_angle", nasa_pinion, [](P& g) { g.cuts[1].root_angle_rad += radians(0.02); }},
      {"cut[1].sliding_base", nasa_pinion, [](P& g) { g.cuts[1].sliding_base_mm += 0.01; }},
      {"cut[1].generated", nasa_pinion, [](P& g) { g.cuts[1].generated = false; }},
      {"cut[0].blade_point_radius", nasa_gear, [](P& g) { g.cuts[0].blades[0].point_radius_mm = 75; }},
      {"cut[0].tool_edge_radius", nasa_gear, [](P& g) { g.cuts[0].blades[0].edge_radius_mm = 2; }},
      {"cut[0].blade_pressure_angle", nasa_gear, [](P& g) { g.cuts[0].blades[0].pressure_angle_rad = 0; }},
      {"cut[0].ratio_of_roll", nasa_gear, [](P& g) { g.cuts[0].ratio_of_roll = 0; }},
      {"cut[1].ratio_of_roll", nasa_pinion, [](P& g) { g.cuts[1].ratio_of_roll = 1 / 3.105176807; }},
      {"cut[0].center_roll_position", nasa_gear, [](P& g) { g.cuts[0].cradle_angle_rad *= -1; }},
      {"cut[0].radial_distance", nasa_gear, [](P& g) { g.cuts[0].radial_distance_mm = 1; }},
      {"cut[0].modified_roll_coefficients", nasa_gear, [](P& g) { g.cuts[0].modified = {15}; }},
      {"cut[0].blade_pressure_angle", nasa_pinion, [](P& g) { g.cuts[0].blades[0].pressure_angle_rad = radians(6); }},
      {"bore_diameter", nasa_gear, [](P& g) { g.bore_diameter_mm = 140; }},
      {"hub_diameter", nasa_gear, [](P& g) { g.hub_diameter_mm = 20, g.hub_length_mm = 5; }},
  };
  for (const auto& [key, start, change] : all) {
    auto g = start();
    change(g);
    const auto gear = SpiralBevelGear::make(g);
    ASSERT_TRUE(gear.refused()) << key;
    EXPECT_EQ(gear.refused()->front().key, key) << gear.refused()->front().diagnostic.message;
  }
}

}  // namespace
}  // namespace toothpath::test
