#include "geometry/inspection/grid.h"
#include "geometry/face_gear/part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "geometry/face_gear/inverse.h"
#include "tests/geometry/mesh/samples.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath::test {
namespace {

class InspectionGrid : public testing::TestWithParam<MeshSample> {
 protected:
  face_gear::FaceGear gear_ = made(GetParam().gear);
};

TEST_P(InspectionGrid, PointsLieOnTheirFlankClearOfItsEdges) {
  const auto grid = inspection::inspection_grid(drawn_solid(gear_));
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid->size(), gear_.rings().size() * 2 * 5 * 9);
  for (const inspection::InspectionPoint& point : *grid) {
    const face_gear::FaceGearRing& ring = gear_.rings()[std::size_t(point.zone)];
    const double r = std::hypot(point.p.x(), point.p.y());
    const double margin = 0.049 * (ring.zone.outer_radius_mm - ring.zone.inner_radius_mm);
    EXPECT_GT(r, ring.zone.inner_radius_mm + margin);
    EXPECT_LT(r, ring.zone.outer_radius_mm - margin);
    EXPECT_LT(point.p.z(), ring.surface.z_tip(r));
    EXPECT_GT(point.p.z(), *face_gear::fillet_line_height(ring.surface, point.side, r));
    EXPECT_NEAR(point.n.norm(), 1, 1e-14);
    EXPECT_GT(point.side * (point.p.x() * point.n.y() - point.p.y() * point.n.x()), 0) << "the normal leaves tooth 0";
    const auto distance = face_gear::flank_distance(ring.surface, point.side, point.p);
    ASSERT_TRUE(distance);
    EXPECT_NEAR(distance->distance, 0, 1e-9);
    const auto off = face_gear::flank_distance(ring.surface, point.side, point.p + 0.01 * point.n);
    ASSERT_TRUE(off);
    EXPECT_NEAR(off->distance, 0.01, 1e-9) << "the normal is the direction of growing distance";
  }
}

TEST_P(InspectionGrid, SweptShaperTouchesEveryPoint) {
  const auto grid = inspection::inspection_grid(drawn_solid(gear_));
  ASSERT_TRUE(grid);
  for (const inspection::InspectionPoint& point : *grid) {
    const BruteForceFaceGear oracle(gear_.parameters(), gear_.rings()[std::size_t(point.zone)].zone.helix_angle_rad);
    ASSERT_NEAR(oracle.least_clearance(point.p), 0, 1e-8) << point.p.transpose();
  }
}

TEST_P(InspectionGrid, CsvReadsBackInOrder) {
  const auto grid = inspection::inspection_grid(drawn_solid(gear_), {7, 11, 0.1});
  ASSERT_TRUE(grid);
  std::istringstream text(inspection::inspection_csv(*grid));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "zone,flank,row,column,x,y,z,i,j,k");
  std::size_t k = 0;
  for (std::size_t zone = 0; zone < gear_.rings().size(); ++zone)
    for (const int side : {1, -1})
      for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 11; ++column, ++k) {
          ASSERT_TRUE(std::getline(text, line));
          std::istringstream fields(line);
          std::array<double, 10> v{};
          for (double& x : v) {
            std::string field;
            std::getline(fields, field, ',');
            x = std::stod(field);
          }
          EXPECT_EQ(v[0], double(zone));
          EXPECT_EQ(v[1], side);
          EXPECT_EQ(v[2], row);
          EXPECT_EQ(v[3], column);
          for (std::size_t c = 0; c < 3; ++c) {
            const auto e = Eigen::Index(c);
            EXPECT_NEAR(v[4 + c], (*grid)[k].p[e], 1e-12 * std::abs((*grid)[k].p[e]));
            EXPECT_NEAR(v[7 + c], (*grid)[k].n[e], 1e-12);
          }
        }
  EXPECT_FALSE(std::getline(text, line));
}

INSTANTIATE_TEST_SUITE_P(Samples, InspectionGrid, testing::ValuesIn(mesh_samples()), sample_name);

TEST(InspectionGridRefuses, OptionsOutsideTheirRange) {
  const face_gear::FaceGear gear = made(spur_parameters());
  EXPECT_EQ(inspection::inspection_grid(drawn_solid(gear), {4, 9, 0.05}).error().message,
            "inspection rows = 4 is outside 5 .. 1000");
  EXPECT_EQ(inspection::inspection_grid(drawn_solid(gear), {5, 8, 0.05}).error().message,
            "inspection columns = 8 is outside 9 .. 1000");
  EXPECT_EQ(inspection::inspection_grid(drawn_solid(gear), {5, 9, 0.5}).error().message,
            "inspection margin = 0.5 is outside 0 .. 0.4");
  EXPECT_FALSE(inspection::inspection_grid(drawn_solid(gear), {5, 9, NAN}));
}

}  // namespace
}  // namespace toothpath::test
