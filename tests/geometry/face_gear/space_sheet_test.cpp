// The working surface as one sheet: derivatives, curvature, nearest points.
#include "geometry/face_gear/space_sheet.h"

#include "geometry/tooth_space/curvature.h"
#include "geometry/tooth_space/offset_sheet.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

class Sheet : public testing::TestWithParam<std::string> {
 protected:
  face_gear::FaceGear gear = test::made(test::gear_named(GetParam()));

  /// A place of a piece well on the ring.
  struct Place {
    tooth_space::Piece piece;
    double u, v;
  };
  static std::vector<Place> places(const tooth_space::OffsetSheet& sheet, unsigned seed, int count) {
    test::Random random(seed);
    std::vector<Place> out;
    for (int k = 0; k < count; ++k) {
      const auto s = sheet.raw(random(0.02, 4.98), random(sheet.r_from(), sheet.r_to()));
      if (s) out.push_back({s->piece, s->u, s->v});
    }
    return out;
  }
  static tooth_space::OffsetSheet surface_of(const face_gear::SpaceSheet& space) {
    return {space, 0.0, space.ring().zone.inner_radius_mm, space.ring().zone.outer_radius_mm, 17};
  }
};

TEST_P(Sheet, DerivativesAgainstDifferences) {
  for (const auto& ring : gear.rings()) {
    const face_gear::SpaceSheet space(gear.parameters(), ring);
    for (const auto& at : places(surface_of(space), 3, 120)) {
      const auto q = space.at(at.piece, at.u, at.v);
      ASSERT_TRUE(q);
      const bool angle_v = is_flank(at.piece);
      const double hu = 1e-5, hv = angle_v ? 1e-5 : 1e-4;
      const auto u1 = space.point(at.piece, at.u + hu, at.v), u0 = space.point(at.piece, at.u - hu, at.v);
      const auto v1 = space.point(at.piece, at.u, at.v + hv), v0 = space.point(at.piece, at.u, at.v - hv);
      ASSERT_TRUE(u1 && u0 && v1 && v0);
      const auto near = [&](const Vec3& exact, const Vec3& difference, const char* what) {
        EXPECT_LE((exact - difference).norm(), 3e-5 * (1 + exact.norm())) << to_string(at.piece) << " " << what;
      };
      near(q->pu, (u1->p - u0->p) / (2 * hu), "dp/du");
      near(q->pv, (v1->p - v0->p) / (2 * hv), "dp/dv");
      near(q->nu, (u1->n - u0->n) / (2 * hu), "dn/du");
      near(q->nv, (v1->n - v0->n) / (2 * hv), "dn/dv");
      EXPECT_NEAR(q->n.norm(), 1, 1e-13);
      EXPECT_NEAR(q->n.dot(q->pu), 0, 1e-9 * q->pu.norm());
      EXPECT_NEAR(q->n.dot(q->pv), 0, 1e-9 * q->pv.norm());
      EXPECT_GT(q->n.z(), 0);  // a space is open upwards
    }
  }
}

TEST_P(Sheet, FootReturnsToTheSurfacePoint) {
  test::Random random(5);
  for (const auto& ring : gear.rings()) {
    const face_gear::SpaceSheet space(gear.parameters(), ring);
    const double m = gear.parameters().module_mm;
    for (const auto& at : places(surface_of(space), 9, 200)) {
      const auto q = space.at(at.piece, at.u, at.v);
      ASSERT_TRUE(q);
      // Below the smallest hollow radius of curvature the foot is unique.
      const double k_u = tooth_space::normal_curvature(*q, q->pu),
                   k_v = tooth_space::normal_curvature(*q, q->n.cross(q->pu));
      const double hollow = std::max({-k_u, -k_v, 1e-9}) * 1.5;
      const double d = random(-0.2, 1) * std::min(0.5 * m, 0.5 / hollow);
      const bool angle_v = is_flank(at.piece);
      const double u = at.u + random(-0.02, 0.02), v = at.v + random(-1, 1) * (angle_v ? 0.002 : 0.1);
      const auto foot = space.foot(at.piece, q->p + d * q->n, u, v);
      ASSERT_TRUE(foot) << to_string(at.piece);
      EXPECT_NEAR(foot->distance, d, 1e-10);
      EXPECT_LE((foot->at.p - q->p).norm(), 1e-9);
      EXPECT_NEAR(foot->u, at.u, 1e-8);
      EXPECT_NEAR(foot->v, at.v, 1e-8);
    }
  }
}

TEST_P(Sheet, CurvatureOfFlanksAndFillets) {
  for (const auto& ring : gear.rings()) {
    const face_gear::SpaceSheet space(gear.parameters(), ring);
    const auto& f = ring.surface;
    for (const auto& at : places(surface_of(space), 21, 120)) {
      if (at.piece == tooth_space::Piece::root) continue;
      const bool flank = is_flank(at.piece);
      const int side = side_of(at.piece);
      const auto q = space.at(at.piece, at.u, at.v);
      const auto H = flank ? f.flank_shape(side, at.u, at.v) : f.fillet_shape(side, at.u, at.v);
      const auto basis = flank ? f.flank_basis(side, at.u, at.v) : f.fillet_basis(side, at.u, at.v);
      const double turn = side > 0 ? 0 : f.pitch;
      const Vec3 e = turned(basis.e, turn), l = turned(basis.l, turn);
      for (const double angle : {0.0, 0.7, 1.6, 2.5}) {
        const double c = std::cos(angle), s = std::sin(angle);
        const double expected = c * c * H.ee + 2 * c * s * H.el + s * s * H.ll;
        EXPECT_NEAR(tooth_space::normal_curvature(*q, e * c + l * s), expected, 1e-8 * (1 + std::abs(expected)))
            << to_string(at.piece);
      }
    }
  }
}

TEST_P(Sheet, PiecesJoinSmoothly) {
  for (const auto& ring : gear.rings()) {
    const face_gear::SpaceSheet space(gear.parameters(), ring);
    const tooth_space::OffsetSheet sheet = surface_of(space);
    for (double y = 0.05; y < 1; y += 0.1) {
      const double r = sheet.r_from() + y * (sheet.r_to() - sheet.r_from());
      for (int joint = 1; joint < tooth_space::kPieces; ++joint) {
        const auto a = sheet.raw(joint - 1e-12, r), b = sheet.raw(joint, r);
        ASSERT_TRUE(a && b);
        EXPECT_NE(a->piece, b->piece);
        EXPECT_LE((a->contact.p - b->contact.p).norm(), 1e-8) << joint;
        EXPECT_LE((a->contact.n - b->contact.n).norm(), 1e-7) << joint;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gears, Sheet, testing::ValuesIn(test::gear_names()),
                         [](const auto& gear_case) { return gear_case.param; });

}  // namespace
}  // namespace toothpath
