// Meshes of gears that stand on the tooth space alone, judged by their kernels: cylindrical and straight bevel gears.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/cylindrical/part.h"
#include "geometry/face_gear/part.h"
#include "geometry/mesh/cgal_check.h"
#include "geometry/mesh/tooth_mesh.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/flank_grid/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

using tooth_space::Piece;

struct CylindricalSample {
  std::string name;
  cylindrical::CylindricalParameters gear;
};
void PrintTo(const CylindricalSample& sample, std::ostream* out) { *out << sample.name; }

std::vector<CylindricalSample> meshed_cylinders() {
  std::vector<CylindricalSample> out{
      {"spur", shifted_spur()}, {"double_helical", double_helical_pinion()}, {"helical_without_bore", left_helical()}};
  auto g = double_helical_pinion();
  g.bore_diameter_mm = 0;
  g.groove_diameter_mm = {};
  out.push_back({"double_helical_without_bore", g});
  g = left_helical();
  g.zones = {{radians(-35), 0, 90}};  // turns far along its bore
  g.bore_diameter_mm = 60;
  out.push_back({"long_helical", g});
  g.zones = {{radians(-35), 0, 12}, {radians(-35), 30, 40}};  // one hand: the groove turns, too
  g.groove_diameter_mm = 2 * 0.5 * made(g).root_diameter();
  out.push_back({"two_zones_of_one_hand_level_groove", g});
  return out;
}

/// Of half a pitch of the transverse section, out to the tip, by the exact outline at z = 0.
double section_area(const cylindrical::CylindricalGear& gear) {
  constexpr int kPieces = 4000;
  const auto& space = gear.space(0);
  const auto& k = space.kernel();
  double area = 0;
  const auto add = [&](Piece piece, double from, double to) {
    Vec3 before = space.point(piece, from, 0)->p;
    for (int n = 1; n <= kPieces; ++n) {
      const Vec3 p = space.point(piece, from + (to - from) * n / kPieces, 0)->p;
      area += 0.5 * (before.x() * p.y() - before.y() * p.x());
      before = p;
    }
  };
  add(Piece::root, 0.5, 1);
  add(Piece::fillet_minus, space.borders(Piece::fillet_minus).from, space.borders(Piece::fillet_minus).to);
  add(Piece::flank_minus, k.theta_f, k.theta_a);
  const Vec3 tip = space.point(Piece::flank_minus, k.theta_a, 0)->p;
  return area + 0.5 * k.r_a * k.r_a * (kPi / k.teeth - azimuth(tip));
}

class AnyGearMesh : public testing::TestWithParam<CylindricalSample> {
 protected:
  cylindrical::CylindricalGear gear_ = made(GetParam().gear);
  tooth_space::ToothedSolid solid_ = drawn_solid(gear_);
  mesh::ToothMesh pitch_ = mesh::mesh_tooth_space(solid_, 0.02).value();
};

TEST_P(AnyGearMesh, IsOneClosedBodyOfTheVolumeOfTheGear) {
  const mesh::TriangleMesh whole = mesh::join_copies(pitch_);
  const auto check = mesh::check_mesh(whole);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_TRUE(check->is_solid()) << check->self_intersections << " crossings";
  EXPECT_EQ(check->components, 1u);
  const auto& p = gear_.parameters();
  const double bore = 0.25 * kPi * p.bore_diameter_mm * p.bore_diameter_mm;
  double expected = 0, face = 0;
  for (const auto& zone : p.zones) face += zone.to_mm - zone.from_mm;
  expected = face * (2 * p.teeth * section_area(gear_) - bore);
  for (std::size_t k = 0; k + 1 < p.zones.size(); ++k)
    expected += (p.zones[k + 1].from_mm - p.zones[k].to_mm) *
                (0.25 * kPi * gear_.groove_diameter() * gear_.groove_diameter() - bore);
  // The facets sag by 0.02 mm at most, here in, there out of the material.
  const double skin = kPi * gear_.tip_diameter() * 2.5 * face;
  EXPECT_NEAR(check->volume_mm3, expected, 0.01 * skin);
  EXPECT_NEAR(check->volume_mm3, expected, 1e-3 * expected);
}

TEST_P(AnyGearMesh, EveryFacetLiesWithinItsSagOfTheExactSurface) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const double bore = 0.5 * gear_.parameters().bore_diameter_mm, groove = 0.5 * gear_.groove_diameter();
  std::array<std::size_t, tooth_space::kSurfaces> seen{};
  EXPECT_LE(pitch_.max_sag(), 0.02);
  for (std::size_t t = 0; t < pitch_.tags.size(); ++t) {
    const mesh::TriangleTag& tag = pitch_.tags[t];
    const auto& ring = solid_.rings[tag.zone];
    const auto& zone = gear_.parameters().zones[std::size_t(ring.zone)];
    const double sag = pitch_.max_sag_mm[std::size_t(tag.patch)];
    ++seen[std::size_t(tag.patch)];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto exact = mesh::exact_patch_point(solid_, tag.zone, tag.patch, tag.uv[k]);
      if (int(tag.patch) > int(Piece::tip)) continue;
      ASSERT_TRUE(exact) << to_string(tag.patch);
      ASSERT_LE((exact->p - pitch_.mesh.corner(t, k)).norm(), 1e-9) << to_string(tag.patch);
    }
    const Vec3 normal = pitch_.mesh.area_normal(t).normalized();
    for (int n = 0; n < 4; ++n) {
      double a = unit(random), b = unit(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const auto at = [&](const auto& of) { return (of(0) + a * (of(1) - of(0)) + b * (of(2) - of(0))).eval(); };
      const Vec3 p = at([&](std::size_t k) -> const Vec3& { return pitch_.mesh.corner(t, k); });
      const Vec2 uv = at([&](std::size_t k) -> const Vec2& { return tag.uv[k]; });
      if (int(tag.patch) < tooth_space::kPieces) {
        const auto foot = ring.space->foot(tag.patch, p, uv.x(), uv.y());
        ASSERT_TRUE(foot) << to_string(tag.patch);
        ASSERT_LE(std::abs(foot->distance), sag + 1e-12) << to_string(tag.patch);
        ASSERT_GT(foot->at.n.dot(normal), 0.7) << to_string(tag.patch);
      } else if (tag.patch == Piece::tip) {
        ASSERT_NEAR(radius(p), 0.5 * gear_.tip_diameter(), sag);
        ASSERT_GT(normal.dot(p), 0.9 * radius(p));
      } else if (tag.patch == Piece::end) {
        const bool upper = std::abs(p.z() - zone.to_mm) < std::abs(p.z() - zone.from_mm);
        ASSERT_NEAR(p.z(), upper ? zone.to_mm : zone.from_mm, 1e-12);
        ASSERT_NEAR(normal.z(), upper ? 1 : -1, 1e-9);
      } else if (tag.patch == Piece::groove) {
        ASSERT_NEAR(radius(p), groove, sag);
      } else if (std::abs(normal.z()) < 0.5) {  // the bore
        ASSERT_NEAR(radius(p), bore, sag);
        ASSERT_LT(normal.dot(p), 0);
      }
    }
  }
  for (const Piece piece : {Piece::flank_plus, Piece::fillet_plus, Piece::root, Piece::fillet_minus, Piece::flank_minus,
                            Piece::tip, Piece::end})
    EXPECT_GT(seen[std::size_t(piece)], 0u) << to_string(piece);
}

INSTANTIATE_TEST_SUITE_P(Samples, AnyGearMesh, testing::ValuesIn(meshed_cylinders()),
                         [](const auto& at) { return at.param.name; });

void is_one_closed_body(const tooth_space::ToothedSolid& solid, const std::string& name) {
  const auto pitch = mesh::mesh_tooth_space(solid, 0.02);
  ASSERT_TRUE(pitch) << name << ": " << pitch.error().message;
  const auto check = mesh::check_mesh(mesh::join_copies(*pitch));
  ASSERT_TRUE(check) << name << ": " << check.error().message;
  EXPECT_TRUE(check->is_solid()) << name << ": " << check->self_intersections << " crossings";
  EXPECT_EQ(check->components, 1u) << name;
  EXPECT_GT(check->volume_mm3, 0) << name;
  EXPECT_LE(pitch->max_sag(), 0.02) << name;
  for (std::size_t t = 0; t < pitch->tags.size(); t += 7) {
    const mesh::TriangleTag& tag = pitch->tags[t];
    if (int(tag.patch) >= tooth_space::kPieces) continue;
    const Vec3 middle = (pitch->mesh.corner(t, 0) + pitch->mesh.corner(t, 1) + pitch->mesh.corner(t, 2)) / 3;
    const Vec2 uv = (tag.uv[0] + tag.uv[1] + tag.uv[2]) / 3;
    const auto foot = solid.rings[0].space->foot(tag.patch, middle, uv.x(), uv.y());
    ASSERT_TRUE(foot) << name;
    EXPECT_LE(std::abs(foot->distance), pitch->max_sag_mm[std::size_t(tag.patch)] + 1e-12) << name;
  }
}

/// Teeth on a cone, with bore, with hub, and without either.
TEST(StraightBevelMesh, IsOneClosedBodyOnItsExactSurface) {
  for (const int kind : {0, 1, 2}) {
    auto g = khk_pinion();
    if (kind == 1) g.hub_diameter_mm = 36, g.hub_length_mm = 8;
    if (kind == 2) g.bore_diameter_mm = 0;
    const auto gear = straight_bevel::StraightBevelGear::make(g).value();
    is_one_closed_body(drawn_solid(gear), fmt::format("{}", kind));
  }
}

/// Curved teeth, nearly undercut: parameters run quickly along their fillets.
TEST(SpiralBevelMesh, IsOneClosedBodyOnItsExactSurface) {
  const auto gear = spiral_bevel::SpiralBevelGear::make(steep_gear(8.3)).value();
  is_one_closed_body(drawn_solid(gear), "steep");
}

/// Gears by points on a cylinder, a cone and a plane, which looks up and down.
TEST(FlankGridMesh, IsOneClosedBodyOnItsExactSurface) {
  const auto small = face_gear::part_of(face_gear::FaceGear::make(small_spur()).value());
  const auto face = sampled(small->space(0), small->teeth(), {7, 7, 0.6, false, 0, 0.1});
  auto down = face;
  std::swap(down.plus, down.minus);
  for (auto* flank : {&down.plus, &down.minus})
    for (auto* list : {&flank->place, &flank->normal})
      for (Vec3& p : *list) p = {p.x(), -p.y(), -p.z()};
  for (auto* line : {&down.root, &down.tip})
    for (Vec2& p : *line) p.y() = -p.y();
  const auto bevel = sampled(khk_pinion(), {7, 7, 0.75, true});
  const std::tuple<const char*, flank_grid::FlankGridParameters, bool> all[] = {
      {"spur", sampled(shifted_spur(), {7, 7, 1.2}), true},
      {"bevel", bevel, false},
      {"face", face, false},
      {"down", down, true}};
  for (const auto& [name, grid, hub] : all) {
    auto g = grid;
    g.bore_diameter_mm = 16;
    if (hub) g.hub_diameter_mm = 36, g.hub_length_mm = 8;
    const auto gear = flank_grid::FlankGridGear::make(g);
    ASSERT_TRUE(gear) << name << ": " << gear.error().front().diagnostic.message;
    is_one_closed_body(drawn_solid(*gear), name);
  }
}

}  // namespace
}  // namespace toothpath::test
