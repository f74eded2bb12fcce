// A half of a bevel gear as a tooth space: the walls that the mill leaves, pieces that join, enclosures that hold.
#include "geometry/bevel_gear/part.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/support/random.h"

namespace toothpath {
namespace {

using namespace bevel_test;
using bevel_gear::BevelPart;
using bevel_gear::WallKernel;
using bevel_gear::WallSpace;
using test::Random;
using tooth_space::Piece;

/// Single hands, a herringbone, few teeth, a crown wheel, modified walls, a path that ends straight.
std::vector<bevel_gear::BevelGear> gears() {
  std::vector<bevel_gear::BevelGear> out{made(w1(), pinion_mill()), made(w2(), wheel_mill()),
                                         made(w3(), pinion_mill())};
  out.push_back(gear_of(design(25, 30, 5, 6, 0.25)));
  auto modified = w3();
  modification::Modification crown, relief;
  crown.kind = modification::Kind::lead_crowning;
  crown.amount_mm = 0.02;
  relief.amount_mm = 0.03;
  relief.length_mm = 2;
  modified.modifications = {crown, relief};
  out.push_back(made(modified, pinion_mill()));
  return out;
}

/// A place of a piece between its borders; v within the half.
Vec2 place_in(const WallSpace& space, Piece piece, Random& random) {
  const WallKernel& kernel = space.kernel();
  const auto& ring = space.outline();
  auto b = space.borders(piece);
  const int side = piece == Piece::flank_plus ? 1 : -1;
  if (is_flank(piece))
    (std::isinf(b.from) ? b.from : b.to) = kernel.about_tip(side, 0.5 * (ring.s_from + ring.s_to))[0];
  return {b.from + random(0, 1) * (b.to - b.from), kernel.v_at(piece, 0, random(ring.s_from, ring.s_to))};
}

TEST(WallKernel, FlanksAndFilletsAreThoseOfTheMill) {
  Random random(3);
  for (const auto& gear : gears()) {
    const BevelPart part(gear);
    for (int zone = 0; zone < part.zones(); ++zone)
      for (const Piece piece : {Piece::flank_plus, Piece::fillet_plus, Piece::fillet_minus, Piece::flank_minus})
        for (int n = 0; n < 20; ++n) {
          const WallSpace& space = part.space(zone);
          const int side = piece == Piece::flank_plus || piece == Piece::fillet_plus ? 1 : -1;
          const auto& wall = space.kernel().wall(side);
          const Vec2 at = place_in(space, piece, random);
          const auto q = space.at(piece, at[0], at[1]);
          ASSERT_TRUE(q);
          const double beta = space.kernel().beta_at(at[1]);
          if (wall.trace.straight(wall.sigma, beta)) continue;
          if (is_flank(piece)) {
            const auto f = wall.point(beta, at[0]);
            EXPECT_LT((f.p - q->p).norm(), 1e-13 * gear.R_e());
            EXPECT_LT((f.n - q->n).norm(), 1e-12);
          } else {
            // The place is on the mill at its centre, which nothing else of the arc's normal allows.
            const auto c = wall.trace.centre(wall.sigma, beta);
            const Vec3 in = bevel_gear::cutter_from_blank<double>(q->p, c.R_c, c.e, gear.sin_delta(), gear.cos_delta());
            const double rho = std::hypot(in.y(), in.z());
            EXPECT_NEAR(std::hypot(rho - wall.cutter.rho_o, in.x() - wall.cutter.x_o), wall.cutter.r_t, 1e-11);
          }
          EXPECT_NEAR(q->n.norm(), 1, 1e-14);
          EXPECT_LT(std::abs(q->n.dot(q->pu)), 1e-9 * (1 + q->pu.norm()));
          EXPECT_LT(std::abs(q->n.dot(q->pv)), 1e-9 * (1 + q->pv.norm()));
        }
  }
}

TEST(WallKernel, PiecesJoinWithOneNormal) {
  for (const auto& gear : gears()) {
    const BevelPart part(gear);
    for (int zone = 0; zone < part.zones(); ++zone) {
      const WallSpace& space = part.space(zone);
      const auto& ring = space.outline();
      for (int k = 0; k <= 10; ++k) {
        const double v = space.kernel().v_at(Piece::root, 0, ring.s_from + 0.1 * k * (ring.s_to - ring.s_from));
        for (const auto& [a, b] : {std::pair(Piece::flank_plus, Piece::fillet_plus),
                                   {Piece::fillet_plus, Piece::root},
                                   {Piece::root, Piece::fillet_minus},
                                   {Piece::fillet_minus, Piece::flank_minus}}) {
          const auto before = space.at(a, space.borders(a).to, v), after = space.at(b, space.borders(b).from, v);
          ASSERT_TRUE(before && after);
          // Where the mill's path runs along the generatrix fillets end a little above the root.
          const bool flat =
              space.kernel().least_turn() < WallKernel::kLeastTurn && (a == Piece::root || b == Piece::root);
          EXPECT_LT((before->p - after->p).norm(), flat ? 1e-3 : 1e-10) << to_string(a);
          EXPECT_LT((before->n - after->n).norm(), flat ? 0.02 : 1e-11) << to_string(a);
        }
      }
    }
  }
}

TEST(WallKernel, EnclosuresHoldSecondDerivatives) {
  Random random(8);
  for (const auto& gear : gears()) {
    const BevelPart part(gear);
    for (int zone = 0; zone < part.zones(); ++zone)
      for (int piece = 0; piece < tooth_space::kPieces; ++piece)
        for (int n = 0; n < 15; ++n) {
          const WallSpace& space = part.space(zone);
          const Vec2 at = place_in(space, Piece(piece), random);
          const auto b = space.borders(Piece(piece));
          const double du = is_flank(Piece(piece)) ? 0.3 : 0.02 * std::abs(b.to - b.from), dv = 0.3;
          const tooth_space::PatchFrame frame{at, {1, 0}, {0, 1}};
          const auto jet = space.enclosure(Piece(piece), frame, du, dv);
          ASSERT_TRUE(jet);
          for (int k = 0; k < 8; ++k) {
            const double u = at[0] + random(-du, du), v = at[1] + random(-dv, dv), h = 1e-5;
            const auto q = space.at(Piece(piece), u, v), up = space.at(Piece(piece), u + h, v),
                       down = space.at(Piece(piece), u - h, v);
            if (!q || !up || !down) continue;
            for (int c = 0; c < 3; ++c) {
              const auto i = std::size_t(c);
              EXPECT_TRUE(jet->place[i].holds(q->p[c]));
              EXPECT_TRUE(jet->first[0][i].holds(q->pu[c]));
              EXPECT_TRUE(jet->first[1][i].holds(q->pv[c]));
              const double uu = (up->pu[c] - down->pu[c]) / (2 * h), uv = (up->pv[c] - down->pv[c]) / (2 * h);
              const double slack = 1e-6 * (1 + q->pu.norm() + q->pv.norm());
              EXPECT_GE(uu, jet->second[0][i].low - slack);
              EXPECT_LE(uu, jet->second[0][i].high + slack);
              EXPECT_GE(uv, jet->second[1][i].low - slack);
              EXPECT_LE(uv, jet->second[1][i].high + slack);
            }
          }
          EXPECT_LT(jet->second[1][0].high - jet->second[1][0].low, 2e3) << to_string(Piece(piece));
        }
  }
}

}  // namespace
}  // namespace toothpath
