// The engine on a gear whose teeth stand out of a cylinder: distances against samples of the surface, tool paths
// against the solid that a polygon of the transverse profile tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cam/analytic/gouge_check.h"
#include "cam/plan/milling.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/support/random.h"
#include "tests/support/sample_tools.h"

namespace toothpath::test {
namespace {

using tooth_space::Piece;

cylindrical::CylindricalParameters narrow_spur() {
  auto g = shifted_spur();
  g.zones = {{0, -3, 3}};
  return g;
}
cylindrical::CylindricalParameters narrow_pinion() {
  auto g = double_helical_pinion();
  g.zones = {{radians(-30), -7, -3.3}, {radians(30), 3.3, 7}};
  return g;
}
/// Far from z = 0: the first space stands turned by more than a turn.
cylindrical::CylindricalParameters far_helical() {
  auto g = left_helical();
  g.zones = {{radians(-18), 1204, 1210}};
  return g;
}

/// The transverse profile of space 0 at z = 0 from tip to tip, by the kernel alone.
struct Transverse {
  cylindrical::InvoluteKernel<double> w;
  std::vector<Vec2> line;  // azimuth, radius

  Transverse(const cylindrical::CylindricalParameters& gear, std::size_t zone) : w(gear, gear.zones[zone]) {
    constexpr int kPoints = 500;
    const auto add = [&](Piece piece, double from, double to) {
      for (int k = 0; k <= kPoints; ++k) {
        Vec3 p, n;
        if (w.place<double>(piece, from + (to - from) * k / kPoints, 0.0, p, n)) line.emplace_back(azimuth(p), radius(p));
      }
    };
    const double fillet_from = w.alpha_n, fillet_to = kPi / 2;
    add(Piece::flank_plus, w.theta_a, w.theta_f);
    add(Piece::fillet_plus, fillet_from, fillet_to);
    add(Piece::root, 0, 1);
    add(Piece::fillet_minus, fillet_to, fillet_from);
    add(Piece::flank_minus, w.theta_f, w.theta_a);
  }
  /// Azimuth and radius of a place in the frame of the profile, turned to space 0.
  [[nodiscard]] Vec2 seen(const Vec3& p) const {
    const double pitch = kTwoPi / w.teeth;
    return {std::remainder(azimuth(p) - w.kappa * p.z(), pitch), radius(p)};
  }
  [[nodiscard]] bool in_material(const Vec3& p) const {
    const Vec2 q = seen(p);
    if (q.y() >= w.r_a) return false;
    if (q.x() <= line.front().x() || q.x() >= line.back().x()) return true;
    bool inside = false;
    for (std::size_t k = 1; k < line.size(); ++k) {
      const Vec2 &a = line[k - 1], &b = line[k];
      if ((a.x() <= q.x()) != (b.x() <= q.x()) && q.y() < a.y() + (q.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y()))
        inside = !inside;
    }
    return inside;
  }
};

struct Solid {
  cylindrical::CylindricalParameters gear;
  std::vector<Transverse> zones;

  explicit Solid(const cylindrical::CylindricalParameters& g) : gear(g) {
    for (std::size_t k = 0; k < g.zones.size(); ++k) zones.emplace_back(g, k);
  }
  [[nodiscard]] bool holds(const Vec3& p) const {
    for (std::size_t k = 0; k < zones.size(); ++k)
      if (p.z() >= gear.zones[k].from_mm && p.z() <= gear.zones[k].to_mm && zones[k].in_material(p)) return true;
    return zones.size() > 1 && p.z() > gear.zones[0].to_mm && p.z() < gear.zones[1].from_mm &&
           radius(p) < 0.5 * *gear.groove_diameter_mm;
  }
  /// Distance from a place outside, by directions: the least way to the solid, never less than the truth.
  [[nodiscard]] double distance(const Vec3& c, double within, int rings) const {
    double least = within;
    for (int i = 0; i <= rings; ++i)
      for (int k = 0; k < std::max(1, 2 * i); ++k)
        for (const double sign : {1.0, -1.0}) {
          const double polar = 0.5 * kPi * i / rings, around = kTwoPi * k / std::max(1, 2 * i);
          const Vec3 d = sign * Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                                     std::cos(polar));
          const int steps = 40;
          for (int n = 1; n <= steps; ++n) {
            const double way = least * n / steps;
            if (!holds(c + way * d)) continue;
            double out = least * (n - 1) / steps, in = way;
            for (int h = 0; h < 30; ++h) {
              const double m = 0.5 * (out + in);
              (holds(c + m * d) ? in : out) = m;
            }
            least = in;
            break;
          }
        }
    return least;
  }
};

struct Case {
  const char* name;
  cylindrical::CylindricalParameters (*gear)();
};

class CylindricalPart : public testing::TestWithParam<Case> {};

TEST_P(CylindricalPart, DistancesAreThoseOfTheSolid) {
  const auto gear = GetParam().gear();
  const Solid solid(gear);
  const auto part_of = cylindrical::part_of(made(gear));
  const analytic::GearDistance part(part_of, 2.0);
  ASSERT_FALSE(part.refusal()) << part.refusal()->diagnostic.message;
  EXPECT_EQ(part.unproven(), 0u);
  Random random(11);
  int outside = 0, inside = 0, near = 0;
  const double r_f = part_of->lowest_root(), r_a = part_of->blank_top();
  for (int n = 0; n < 250; ++n) {
    const auto& zone = gear.zones[random.index(gear.zones.size())];
    const double r = random(r_f - 0.8, r_a + 1.2), z = random(zone.from_mm - 1, zone.to_mm + 1), a = random(-kPi, kPi);
    const Vec3 c(r * std::cos(a), r * std::sin(a), z);
    const auto q = part.nearest(c, 1.2);
    if (solid.holds(c)) {
      EXPECT_LE(q.distance, 1e-9) << "inside, at " << c.transpose();
      ++inside;
      continue;
    }
    ++outside;
    EXPECT_GE(q.distance, -1e-9) << "outside, at " << c.transpose();
    const double shown = solid.distance(c, 1.2, 14);
    EXPECT_LE(q.distance, shown + 1e-6) << c.transpose() << " " << q.patch;
    // The directions are 6 deg apart: the way to a curved surface is longer by a few percent, to an edge by more.
    if (q.distance < 1.19) {
      EXPECT_GE(q.distance, 0.85 * shown - 0.01) << c.transpose() << " " << q.patch;
      ++near;
    }
    const double keeps = part.surface_keeps(c, 1.2);
    EXPECT_LE(keeps, std::max(q.distance, 0.0) + 1e-9);
  }
  EXPECT_GT(outside, 60);
  EXPECT_GT(inside, 40);
  EXPECT_GT(near, 40);
}

INSTANTIATE_TEST_SUITE_P(Gears, CylindricalPart,
                         testing::Values(Case{"spur", narrow_spur}, Case{"pinion", narrow_pinion},
                                         Case{"far", far_helical}),
                         [](const testing::TestParamInfo<Case>& c) { return std::string(c.param.name); });

path::MillingOperation operation(path::OperationType type, int tool) {
  path::MillingOperation o;
  o.type = type;
  o.tool = tool;
  o.speed_rpm = 16000;
  o.feed_mm_min = 900;
  return o;
}

/// Roughing and finishing of one space: proven free of gouges, no place of the tool lies in the solid, and what is left
/// is what was asked for.
TEST(CylindricalPart, ToolPathsCutTheSpaceAndNothingElse) {
  const auto gear = narrow_spur();
  const Solid solid(gear);
  const auto part_of = cylindrical::part_of(made(gear));
  std::vector<tool::ToolAssembly> tools{ball_mill(2, 9, 2, 22, 10)};
  auto rough = operation(path::OperationType::roughing, 0), finish = operation(path::OperationType::finishing, 0);
  rough.step_down_mm = 0.8;
  rough.step_over_mm = 1;
  rough.allowance_mm = 0.15;
  finish.scallop_mm = 0.01;
  finish.chord_tolerance_mm = 0.002;
  const analytic::GearDistance part(part_of, ball::reach_of(tools));
  auto planned = plan::plan_milling(part, tools, {rough, finish}, {});
  ASSERT_FALSE(planned.refused()) << planned.refused()->key << ": " << planned.refused()->diagnostic.message;
  const auto plan = std::move(planned).value();
  analytic::GougeCheckOptions options;
  options.rapid_height_mm = part_of->blank_top();
  const analytic::GougeCheck check(part, tools, options);
  for (const auto& path : plan.paths) {
    const auto checked = check.check_path(path);
    EXPECT_TRUE(checked) << checked.error().message;
  }
  Random random(5);
  int in = 0, places = 0;
  double deepest_left = 0;
  for (const auto& record : plan.paths[1].records) {
    const Vec3 centre = record.tip + record.axis;  // the ball's, 1 mm above its tip
    for (int k = 0; k < 20; ++k) {
      const Vec3 d = random.vector(1).normalized();
      in += solid.holds(centre + (1 - 0.003) * d) ? 1 : 0;
      ++places;
    }
  }
  EXPECT_EQ(in, 0) << "of " << places;
  // Places of the flanks: the nearest ball of the finishing path leaves no more than the scallop that was asked for.
  const auto& space = part_of->space(0);
  for (const Piece piece : {Piece::flank_plus, Piece::fillet_plus, Piece::root, Piece::fillet_minus, Piece::flank_minus}) {
    auto b = space.borders(piece);
    const double top = cylindrical::InvoluteKernel<double>(gear, gear.zones[0]).theta_a;
    if (!std::isfinite(b.from)) b.from = top;
    if (!std::isfinite(b.to)) b.to = top;
    for (int i = 1; i < 12; ++i)
      for (int j = 1; j < 8; ++j) {
        const auto q = space.point(piece, b.from + (b.to - b.from) * i / 12, -2.9 + 5.8 * j / 8);
        double left = INFINITY;
        const auto& records = plan.paths[1].records;
        for (std::size_t k = 1; k < records.size(); ++k)
          if (records[k].kind == path::MoveKind::feed)
            left = std::min(left, distance_to_segment(q->p, records[k - 1].tip + records[k - 1].axis,
                                                      records[k].tip + records[k].axis) - 1);
        deepest_left = std::max(deepest_left, left);
      }
  }
  EXPECT_LT(deepest_left, 0.0102);
  EXPECT_GT(deepest_left, 0.001);
}

}  // namespace
}  // namespace toothpath::test
