// Gears by points: the spline against polynomials and against the closed forms that the points were taken from, the
// rolled ball by brute force, and what is refused.
#include <gtest/gtest.h>

#include <functional>

#include "geometry/cylindrical/part.h"
#include "geometry/tooth_space/curvature.h"
#include "tests/geometry/flank_grid/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using flank_grid::FlankGridGear;
using flank_grid::FlankGridParameters;
using flank_grid::TensorSpline;
using tooth_space::Piece;

/// A spline through a bicubic polynomial is that polynomial, a tenth beyond the grid, too; then it goes on straight.
TEST(TensorSpline, TakesBicubicsAsTheyAre) {
  const std::vector<double> u{0, 0.7, 1.9, 2.5, 4}, v{-3, -1, 0.5, 3, 4, 6.5};
  const auto f = [](double x, double y) {
    return Vec3(1 + x - 0.3 * y + 0.02 * x * x * x * y * y, x * y * y * y - y, 0.1 * x * x * x * y * y * y - x * x);
  };
  std::vector<Vec3> points;
  for (const double x : u)
    for (const double y : v) points.push_back(f(x, y));
  const TensorSpline spline(u, v, points);
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t j = 0; j < v.size(); ++j)
      EXPECT_LT((spline.at(u[i], v[j]) - points[i * v.size() + j]).norm(), 1e-12 * 200);
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const double x = random(-0.399, 4.399), y = random(-3.949, 7.449);
    EXPECT_LT((spline.at(x, y) - f(x, y)).norm(), 1e-9) << x << " " << y;
    const auto d = spline.partials(x, y, 3);
    EXPECT_NEAR(d.d[2][1].z(), 0.1 * 6 * x * 3 * y * y - 0, 1e-7);
    EXPECT_NEAR(d.d[1][0].y(), y * y * y, 1e-8);
  }
  const Vec3 end = spline.at(4.4, 1), slope = spline.partials(4.4, 1.0, 1).d[1][0];
  EXPECT_LT((spline.at(5, 1) - end - 0.6 * slope).norm(), 1e-10);
}

TEST(TensorSpline, BendsOnWithoutAJump) {
  Random random(2);
  const std::vector<double> u{0, 1, 2.2, 3, 4.1}, v{0, 0.8, 2, 3.3, 4};
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < 25; ++k) points.emplace_back(random(0, 1), random(0, 1), random(0, 1));
  const TensorSpline spline(u, v, points);
  for (const double x : {1.0, 2.2, 3.0}) {
    const auto a = spline.partials(std::nextafter(x, 0.0), 1.3, 2), b = spline.partials(x, 1.3, 2);
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}})
      EXPECT_LT((a.d[std::size_t(i)][std::size_t(j)] - b.d[std::size_t(i)][std::size_t(j)]).norm(), 1e-11);
  }
  // Not-a-knot: the third derivative goes on through the knots next to the ends.
  for (const double x : {1.0, 3.0})
    EXPECT_LT((spline.partials(std::nextafter(x, 0.0), 1.3, 3).d[3][0] - spline.partials(x, 1.3, 3).d[3][0]).norm(),
              1e-9);
  EXPECT_GT((spline.partials(std::nextafter(2.2, 0.0), 1.3, 3).d[3][0] - spline.partials(2.2, 1.3, 3).d[3][0]).norm(),
            1e-3);
}

/// With fewer than six rows or columns nothing can be left out.
TEST(FlankGridSpacing, IsNotKnownOfTooFewPoints) {
  for (const auto& [rows, columns, known] :
       {std::tuple{6, 6, true}, std::tuple{5, 9, false}, std::tuple{9, 5, false}}) {
    const auto gear = FlankGridGear::make(sampled(shifted_spur(), {rows, columns, 1.2}));
    ASSERT_TRUE(gear);
    EXPECT_EQ(gear->quality().spacing_mm.has_value(), known) << rows << " " << columns;
  }
}

/// A column in the middle of the face, beside it by rounding, makes no piece of the ball's curve without length.
TEST(FlankGridMiddle, EnclosuresAreNarrowThere) {
  auto helical = left_helical();
  for (const auto& [from, to] : {std::pair{-4.0, 4.0}, {3.1, 8.7}, {0.3, 7.9}, {-5.7, 2.2}}) {
    helical.zones = {{radians(-18), from, to}};
    const auto gear = FlankGridGear::make(sampled(helical, {9, 9, 0.7}));
    ASSERT_TRUE(gear) << gear.error().front().diagnostic.message;
    for (int piece = 0; piece < tooth_space::kPieces; ++piece) {
      tooth_space::PatchFrame frame;
      frame.origin = {0.5, -0.5 * (from + to)};
      const auto jet = gear->space().enclosure(Piece(piece), frame, 0.01, 0.01);
      ASSERT_TRUE(jet);
      for (const auto& second : jet->second)
        for (const Interval& x : second) EXPECT_LT(x.magnitude(), 100) << piece << " " << from;
    }
  }
}

struct Case {
  const char* name;
  FlankGridParameters grid;
  std::shared_ptr<const tooth_space::ToothedPart> part;  ///< that the points are of
  double turn = 0, normals_rad = 4e-3;                   ///< what they are turned by; worst normal that is given
};

class FlankGrid : public testing::Test {
 protected:
  struct Fitted {
    Case of;
    FlankGridGear gear;
  };
  static std::vector<Fitted>& all() {
    static std::vector<Fitted> gears;
    return gears;
  }
  static void SetUpTestSuite() {
    const auto bevel = khk_pinion();
    const auto bevel_part = straight_bevel::part_of(straight_bevel::StraightBevelGear::make(bevel).value());
    const auto helical_part = cylindrical::part_of(made(left_helical()));
    Case cases[] = {
        {"spur", sampled(shifted_spur(), {9, 9, 1.2}), cylindrical::part_of(made(shifted_spur()))},
        {"helical", sampled(left_helical(), {8, 11, 0.7}), cylindrical::part_of(made(left_helical()))},
        {"bevel", sampled(bevel, {9, 9, 0.75, true, 2.9}), bevel_part, 2.9},
        // Ends that are no parallels, rows and columns that bend, a ridge in the root, a crowned tip.
        {"bent bevel", sampled(bevel_part->space(0), bevel.teeth, {9, 11, 0.75}, {0.1, -0.15, 0.03, 0.2, 0.3}),
         bevel_part, 0, 8e-3},
        // A hollow root and a hollow tip between parallel ends.
        {"bent helical", sampled(helical_part->space(0), left_helical().teeth, {8, 11, 0.7}, {0, 0, 0, -0.25, -0.3}),
         helical_part, 0, 8e-3},
    };
    for (const Case& one : cases) {
      auto made = FlankGridGear::make(one.grid);
      for (const auto& refusal : made ? std::vector<Refusal>{} : made.error())
        ADD_FAILURE() << one.name << ": " << refusal.key << ": " << refusal.diagnostic.message;
      if (made) all().push_back({one, std::move(*made)});
    }
  }
  static void TearDownTestSuite() { all().clear(); }
};

TEST_F(FlankGrid, PointsLieOnIt) {
  ASSERT_EQ(all().size(), 5u);
  for (const auto& [of, gear] : all())
    for (const int side : {1, -1}) {
      const auto& g = of.grid.points(side);
      const auto& s = gear.space().kernel().flank(side).spline;
      for (int i = 0; i < g.rows; ++i)
        for (int j = 0; j < g.columns; ++j) {
          const double v = s.v()[std::size_t(of.grid.plus.columns - 1 - j)], w = s.v()[std::size_t(j)];
          const Vec3& p = g.place[g.index(i, j)];
          const double u = s.u()[std::size_t(i)];
          EXPECT_LT(std::min((s.at(u, v) - p).norm(), (s.at(u, w) - p).norm()), 1e-12 * (1 + p.norm()));
        }
    }
}

/// Between the points the flank is that of the gear they were taken from, within what leaving out every second shows.
TEST_F(FlankGrid, IsTheGearThatThePointsAreOf) {
  Random random(5);
  for (const auto& [of, gear] : all()) {
    ASSERT_TRUE(gear.quality().spacing_mm);
    EXPECT_LT(*gear.quality().spacing_mm, 0.006) << of.name;
    EXPECT_GT(*gear.quality().spacing_mm, 1e-6) << of.name;
    EXPECT_LT(*gear.quality().normals_rad, of.normals_rad) << of.name;
    for (int k = 0; k < 60; ++k) {
      const int side = k % 2 == 0 ? 1 : -1;
      const auto& spline = gear.space().kernel().flank(side).spline;
      const double share = random(0, 1);
      const Vec3 p =
          turned(spline.at(share * spline.height(), random(spline.v().front(), spline.v().back())), -of.turn);
      const auto& space = of.part->space(0);
      const Piece piece = tooth_space::flank_of(side);
      const tooth_space::Borders b = space.borders(piece);
      const double s = space.outline().chart.along(p), foot = std::isfinite(b.from) ? b.from : b.to,
                   u = foot + share * (space.tip_edge(side, s)->u - foot);
      const auto near = tooth_space::place_at(space, piece, u, s);
      ASSERT_TRUE(near);
      const auto at = space.foot(piece, p, u, *space.start_v(piece, u, s, 0, {}, 1));
      ASSERT_TRUE(at);
      EXPECT_LT(std::abs(at->distance), *gear.quality().spacing_mm) << of.name;
    }
  }
}

/// Ball and surfaces by brute force: the centre stands the radius above the root and above no place of the flank by
/// less; no other place of the ball reaches into the fillet.
TEST_F(FlankGrid, TheBallTouchesFlankAndRoot) {
  Random random(6);
  for (const auto& [of, gear] : all()) {
    const auto& w = gear.space().kernel();
    for (int k = 0; k < 16; ++k) {
      const int side = k % 2 == 0 ? 1 : -1;
      const double v = random(w.ring.s_from, w.ring.s_to), R = of.grid.fillet_radius_mm;
      const auto q = gear.space().at(tooth_space::fillet_of(side), random(0.05, 0.95), v);
      ASSERT_TRUE(q);
      const Vec3 c = q->p + R * q->n;
      EXPECT_NEAR(w.root.height({radius(c), c.z()}), R, 1e-10);
      double least = INFINITY;
      Vec2 at = Vec2::Zero();
      const auto& s = w.flank(side).spline;
      const auto seek = [&](const Vec2& middle, double du, double dv) {
        for (int i = -30; i <= 30; ++i)
          for (int j = -30; j <= 30; ++j) {
            const Vec2 x = middle + Vec2(du * i / 30, dv * j / 30);
            const double d = (s.at(x[0], x[1]) - c).norm();
            if (d < least) least = d, at = x;
          }
      };
      seek({0.3 * s.height(), v}, s.height(), 3 * R);
      for (double size = 0.1; size > 1e-7; size *= 0.1) seek(at, size * s.height(), size * 3 * R);
      EXPECT_NEAR(least, R, 1e-9) << of.name;
      double nearest = INFINITY;
      for (int i = -400; i <= 400; ++i) {
        Vec3 centre, normal;
        w.ball(side).at(v + 0.5 * R * i / 400, centre, normal);
        nearest = std::min(nearest, (centre - q->p).norm());
      }
      EXPECT_NEAR(nearest, R, 1e-10) << of.name;
      const auto curve = tooth_space::principal_curvatures(*q);
      EXPECT_NEAR(curve.least, -1 / R, 1e-6);
    }
  }
}

TEST_F(FlankGrid, PiecesJoinSmoothly) {
  for (const auto& [of, gear] : all())
    for (const int side : {1, -1})
      for (const double t : {0.02, 0.4, 0.97}) {
        const auto& ring = gear.space().outline();
        const double v = ring.s_from + t * (ring.s_to - ring.s_from);
        const auto fillet = tooth_space::fillet_of(side);
        const auto flank = gear.space().at(tooth_space::flank_of(side), 0, v), join = gear.space().at(fillet, 1, v),
                   end = gear.space().at(fillet, 0, v), root = gear.space().at(Piece::root, side > 0 ? 0 : 1, v);
        ASSERT_TRUE(flank && join && end && root);
        EXPECT_LT((flank->p - join->p).norm() + (flank->n - join->n).norm(), 1e-10) << of.name;
        EXPECT_LT((end->p - root->p).norm() + (end->n - root->n).norm(), 1e-10) << of.name;
        for (const auto& q : {*flank, *join, *end, *root}) {
          EXPECT_NEAR(q.n.norm(), 1, 1e-10);
          EXPECT_LT(std::abs(q.n.dot(q.pu.normalized())) + std::abs(q.n.dot(q.pv.normalized())), 1e-8) << of.name;
        }
      }
}

/// Second derivatives at random places lie in the enclosures of boxes around them.
TEST_F(FlankGrid, EnclosuresHold) {
  Random random(3);
  for (const auto& [of, gear] : all())
    for (int k = 0; k < 60; ++k) {
      const Piece piece = Piece(k % 5);
      const auto& ring = gear.space().outline();
      const double ha = tooth_space::is_flank(piece) ? 0.2 : 0.02, hb = 0.3, step = 1e-4;
      const double u = tooth_space::is_flank(piece) ? random(0, 3) : random(0, 1);
      tooth_space::PatchFrame frame;
      frame.origin = {u, random(ring.s_from, ring.s_to)};
      const auto jet = gear.space().enclosure(piece, frame, ha, hb);
      ASSERT_TRUE(jet);
      const Vec2 at = frame.origin + Vec2(random(-0.9, 0.9) * ha, random(-0.9, 0.9) * hb);
      const auto a = gear.space().at(piece, at.x(), at.y() - step), b = gear.space().at(piece, at.x(), at.y() + step),
                 q = gear.space().at(piece, at.x(), at.y());
      const Vec3 puv = (b->pu - a->pu) / (2 * step), pvv = (b->pv - a->pv) / (2 * step),
                 pv = (b->p - a->p) / (2 * step);
      EXPECT_LT((pv - q->pv).norm(), 1e-6 * (1 + pv.norm()));
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(jet->second[1][i].finite());
        EXPECT_GT(q->p[int(i)], jet->place[i].low);
        EXPECT_LT(q->p[int(i)], jet->place[i].high);
        const double slack = 1e-4 * (1 + std::abs(pvv[int(i)]) + std::abs(puv[int(i)]));
        EXPECT_GT(puv[int(i)], jet->second[1][i].low - slack) << of.name << " " << int(piece);
        EXPECT_LT(puv[int(i)], jet->second[1][i].high + slack);
        EXPECT_GT(pvv[int(i)], jet->second[2][i].low - slack);
        EXPECT_LT(pvv[int(i)], jet->second[2][i].high + slack);
      }
    }
}

TEST_F(FlankGrid, EveryLimitIsRefusedByItsKey) {
  const FlankGridParameters good = all()[0].of.grid;
  using Change = std::function<void(FlankGridParameters&)>;
  const auto swapped = [](auto& g) {
    std::swap(g.plus, g.minus);
    g.plus.normal.clear();
    g.minus.normal.clear();
  };
  const auto each = [](FlankGridParameters& g, auto&& change) {
    for (auto* flank : {&g.plus, &g.minus}) change(*flank);
  };
  const struct {
    const char *key, *words;
    Change change;
  } cases[] = {
      {"teeth", "outside", [](auto& g) { g.teeth = 3; }},
      {"teeth", "", {}},
      {"fillet_radius", "outside", [](auto& g) { g.fillet_radius_mm = 0; }},
      {"fillet_radius", "would do", [](auto& g) { g.fillet_radius_mm = 2.2; }},
      {"fillet_radius", "would do", [](auto& g) { g.fillet_radius_mm = 30; }},
      {"points", "bound one space", swapped},
      {"points", "bound one space", [](auto& g) { g.teeth = 300; }},
      {"points", "rows and",
       [&](auto& g) { each(g, [](auto& f) { f.rows = 3, f.place.resize(27), f.normal.clear(); }); }},
      {"points", "into the material", [](auto& g) { g.minus.normal[13] *= -1; }},
      {"points", "have the length", [](auto& g) { g.minus.normal[13] *= 2; }},
      {"points", "folds", [](auto& g) { std::swap(g.plus.place[20], g.plus.place[21]); }},
      {"points", "from the one before", [](auto& g) { g.plus.place[20] = g.plus.place[21]; }},
      {"points", "in inches? They are read in mm",
       [](auto& g) {
         for (auto& p : g.plus.place) p /= 25.4;
       }},
      {"points", "(1e+308, 0, 0) mm is no place", [](auto& g) { g.plus.place[20] = Vec3(1e308, 0, 0); }},
      {"points", "ratio", [](auto& g) { g.plus.place[20] = 0.05 * g.plus.place[19] + 0.95 * g.plus.place[21]; }},
      {"points", "from the root to the tip",
       [&](auto& g) {
         each(g, [](auto& f) { std::reverse(f.place.begin(), f.place.end()); });
         std::swap(g.plus, g.minus);
         std::reverse(g.root.begin(), g.root.end());
         std::reverse(g.tip.begin(), g.tip.end());
       }},
      {"points", "must run as root does",
       [](auto& g) {
         std::reverse(g.root.begin(), g.root.end());
         std::reverse(g.tip.begin(), g.tip.end());
       }},
      {"points", "go on beyond",
       [](auto& g) {
         for (auto* m : {&g.root, &g.tip}) m->front().y() += 5;
       }},
      {"points", "go on beyond",
       [](auto& g) {
         for (auto& p : g.root) p.x() -= 1;
         g.fillet_radius_mm = 0.5;
       }},
      {"tip", "no direction is upright",
       [](auto& g) {
         const Vec2 more = 6 * (g.tip.front() - g.tip.back()).normalized();
         g.tip.front() += more;
         g.tip.back() -= more;
       }},
      {"tip", "does not lie behind", [](auto& g) { g.tip.insert(g.tip.begin() + 1, g.tip.front()); }},
      {"tip", "pointed",
       [](auto& g) {
         for (auto& p : g.tip) p.x() += 8;
       }},
      {"tip", "internal", [](auto& g) { std::swap(g.root, g.tip); }},
      {"root", "leans by",
       [](auto& g) {
         g.root.insert(g.root.begin() + 1,
                       Vec2(g.root[0].x() + 3, g.root[0].y() + 0.2 * (g.root[1].y() - g.root[0].y())));
       }},
      {"root", "too hollow for a ball",
       [](auto& g) {
         for (const double share : {0.52, 0.48})
           g.root.insert(g.root.begin() + 1, g.root.front() + share * (g.root.back() - g.root.front()) - Vec2(1.8, 0));
       }},
      {"bore_diameter", "is not below", [](auto& g) { g.bore_diameter_mm = 70; }},
      {"hub_diameter", "is not between", [](auto& g) { g.hub_diameter_mm = 90, g.hub_length_mm = 5; }},
  };
  for (const auto& one : cases) {
    FlankGridParameters g = good;
    if (one.change) one.change(g);
    const auto made = FlankGridGear::make(g);
    ASSERT_EQ(bool(made), !one.change) << one.key << " " << one.words;
    if (made) continue;
    EXPECT_EQ(made.error().front().key, one.key) << made.error().front().diagnostic.message;
    EXPECT_NE(made.error().front().diagnostic.message.find(one.words), std::string::npos)
        << made.error().front().diagnostic.message;
  }
}

/// Grids of growing size over lines that bend, between ends that lean: within what leaving out every second point
/// shows, nearer with every size.
TEST(FlankGridSizes, ComeBackWithinTheLedgerOverBentLines) {
  const auto part = straight_bevel::part_of(straight_bevel::StraightBevelGear::make(khk_pinion()).value());
  const auto& exact = part->space(0);
  double before = INFINITY;
  for (const auto& [rows, columns] : {std::pair{5, 9}, {9, 17}, {17, 33}, {33, 65}}) {
    const auto grid = sampled(exact, khk_pinion().teeth, {rows, columns, 0.75}, {0.12, -0.1, 0.04, 0.2, 0.25});
    const auto gear = FlankGridGear::make(grid);
    ASSERT_TRUE(gear) << gear.error().front().diagnostic.message;
    Random random(rows);
    double worst = 0;
    for (int k = 0; k < 200; ++k) {
      const int side = k % 2 == 0 ? 1 : -1;
      const Piece piece = tooth_space::flank_of(side);
      const auto& spline = gear->space().kernel().flank(side).spline;
      const double share = random(0, 1);
      const Vec3 p = spline.at(share * spline.height(), random(spline.v().front(), spline.v().back()));
      const double s = exact.outline().chart.along(p), foot = exact.borders(piece).from,
                   other = exact.borders(piece).to, low = std::isfinite(foot) ? foot : other,
                   u = low + share * (exact.tip_edge(side, s)->u - low);
      const auto at = exact.foot(piece, p, u, *exact.start_v(piece, u, s, 0, {}, 1));
      ASSERT_TRUE(at);
      worst = std::max(worst, std::abs(at->distance));
    }
    EXPECT_LT(worst, gear->quality().spacing_mm.value_or(INFINITY)) << rows;
    EXPECT_LT(worst, before) << rows;
    before = worst;
    RecordProperty(fmt::format("worst_{}x{}_um", rows, columns), fmt::format("{:.4f}", 1e3 * worst));
  }
  EXPECT_LT(before, 2e-5);
}

/// The drawn gear ends at the lines from root to tip, the teeth that are planned and proven go on beyond them at every
/// height.
TEST_F(FlankGrid, EndsLeanInsideTheTeethThatAreProven) {
  const Fitted& bent = all()[3];
  const auto& ring = bent.gear.space().outline();
  ASSERT_TRUE(ring.leaning);
  const auto& g = bent.of.grid;
  for (const bool last : {false, true})
    for (const auto* line : {&g.root, &g.tip}) {
      const Vec3 first(line->front().x(), 0, line->front().y()), other(line->back().x(), 0, line->back().y());
      const bool rises = ring.chart.along(other) > ring.chart.along(first);
      const Vec3& p = last == rises ? other : first;
      EXPECT_NEAR(ring.chart.along(p), ring.end(last).at(ring.chart.up(p)), 1e-12);
      EXPECT_NEAR(ring.station(p), last ? ring.s_to : ring.s_from, 1e-12);
      EXPECT_GT(ring.chart.along(p), ring.s_from - 1e-12);
      EXPECT_LT(ring.chart.along(p), ring.s_to + 1e-12);
    }
  EXPECT_GT(bent.gear.quality().corners_mm, 0);
  EXPECT_FALSE(all()[4].gear.space().outline().leaning);
}

/// Root and tip pass their points but for the rounding that the ledger tells, and bend as the ball asks.
TEST_F(FlankGrid, RootAndTipPassTheirPoints) {
  for (const auto& [of, gear] : all()) {
    const auto& w = gear.space().kernel();
    for (const Vec2& p : of.grid.root)
      EXPECT_LE(std::abs(w.root.height(p)), gear.quality().corners_mm + 1e-12) << of.name;
    for (const Vec2& p : of.grid.tip) {
      const Vec3 q(p.x(), 0, p.y());
      EXPECT_LE(std::abs(gear.space().tip(w.ring.chart.along(q)) - w.ring.chart.up(q)),
                gear.quality().corners_mm + 1e-12)
          << of.name;
    }
    for (const auto& corner : w.root.bent.corners())
      EXPECT_LE(corner.turn / corner.half * of.grid.fillet_radius_mm, 0.5 + 1e-12) << of.name;
  }
}

/// The radius that a refusal names does fit, and a little more does not.
TEST_F(FlankGrid, ARefusedBallNamesTheLargest) {
  FlankGridParameters g = all()[0].of.grid;
  g.fillet_radius_mm = 5;
  const auto refused = FlankGridGear::make(g);
  ASSERT_FALSE(refused);
  const std::string& text = refused.error().front().diagnostic.message;
  const double most = std::stod(text.substr(text.find("; ") + 2));
  g.fillet_radius_mm = most;
  EXPECT_TRUE(FlankGridGear::make(g)) << text;
  g.fillet_radius_mm = most + 0.01;
  EXPECT_FALSE(FlankGridGear::make(g)) << text;
}

}  // namespace
}  // namespace toothpath::test
