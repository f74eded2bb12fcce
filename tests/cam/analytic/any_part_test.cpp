// The engine on gears whose teeth stand out of a cylinder or a cone: distances and tool paths against the solid that a
// polygon of the profile tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "cam/analytic/gear_ring.h"
#include "cam/analytic/gouge_check.h"
#include "cam/plan/milling.h"
#include "geometry/base/angle.h"
#include "geometry/bevel_gear/part.h"
#include "geometry/cylindrical/part.h"
#include "geometry/tooth_space/exact_space.h"
#include "geometry/tooth_space/limits.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/flank_grid/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/brute_force_bevel_gear.h"
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

/// Does a profile of (azimuth, height) from tip to tip have this place in the material?
bool under(const std::vector<Vec2>& line, const Vec2& q) {
  if (q.x() <= line.front().x() || q.x() >= line.back().x()) return true;
  bool inside = false;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec2 &a = line[k - 1], &b = line[k];
    if ((a.x() <= q.x()) != (b.x() <= q.x()) && q.y() < a.y() + (q.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
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
        if (w.place<double>(piece, from + (to - from) * k / kPoints, 0.0, p, n))
          line.emplace_back(azimuth(p), radius(p));
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
    return q.y() < w.r_a && under(line, q);
  }
};

/// A gear as a question about places, and a box about its teeth.
struct Solid {
  std::shared_ptr<const tooth_space::ToothedPart> part;
  std::function<bool(const Vec3&)> holds;

  /// Distance from a place outside, by directions: the least way to the solid, never less than the truth.
  [[nodiscard]] double distance(const Vec3& c, double within, int rings) const {
    double least = within;
    for (int i = 0; i <= rings; ++i)
      for (int k = 0; k < std::max(1, 2 * i); ++k)
        for (const double sign : {1.0, -1.0}) {
          const double polar = 0.5 * kPi * i / rings, around = kTwoPi * k / std::max(1, 2 * i);
          const Vec3 d =
              sign * Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
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

Solid solid_of(const cylindrical::CylindricalParameters& gear) {
  std::vector<Transverse> zones;
  for (std::size_t k = 0; k < gear.zones.size(); ++k) zones.emplace_back(gear, k);
  return {cylindrical::part_of(made(gear)), [gear, zones](const Vec3& p) {
            for (std::size_t k = 0; k < zones.size(); ++k)
              if (p.z() >= gear.zones[k].from_mm && p.z() <= gear.zones[k].to_mm && zones[k].in_material(p))
                return true;
            return zones.size() > 1 && p.z() > gear.zones[0].to_mm && p.z() < gear.zones[1].from_mm &&
                   radius(p) < 0.5 * *gear.groove_diameter_mm;
          }};
}

/// The profile on the unit sphere: azimuth and polar angle from tip to tip.
Solid solid_of(const straight_bevel::StraightBevelParameters& parameters) {
  constexpr int kPoints = 500;
  const auto gear = straight_bevel::StraightBevelGear::make(parameters).value();
  const auto& w = gear.space().kernel();
  const bool octoid = w.form == straight_bevel::Form::octoid;
  const double tip = w.u_F + (octoid ? -0.5 : 0.4);  // beyond the face cone
  std::vector<Vec2> line;
  const auto add = [&](Piece piece, double from, double to) {
    for (int k = 0; k <= kPoints; ++k) {
      const Vec3 p = gear.space().point(piece, from + (to - from) * k / kPoints, -1.0)->p;
      line.emplace_back(azimuth(p), std::atan2(radius(p), p.z()));
    }
  };
  add(Piece::flank_plus, tip, w.u_F);
  add(Piece::fillet_plus, w.b_F, 0);
  add(Piece::root, 0, 1);
  add(Piece::fillet_minus, 0, w.b_F);
  add(Piece::flank_minus, w.u_F, tip);
  return {straight_bevel::part_of(gear), [gear, line](const Vec3& p) {
            const auto& ring = gear.space().outline();
            const double s = ring.chart.along(p);
            if (s < ring.s_from || s > ring.s_to || ring.chart.up(p) > gear.space().tip(s)) return false;
            return under(line, {std::remainder(azimuth(p), ring.pitch), std::atan2(radius(p), p.z())});
          }};
}

/// Profiles of azimuth and height at stations along the face, straight lines between them.
Solid solid_of(const spiral_bevel::SpiralBevelParameters& parameters) {
  constexpr int kPoints = 120, kStations = 50;
  const auto gear = spiral_bevel::SpiralBevelGear::make(parameters).value();
  const auto& space = gear.space();
  const auto& ring = space.outline();
  std::vector<std::vector<Vec2>> lines;
  for (int n = 0; n <= kStations; ++n) {
    const double s = ring.s_from + (ring.s_to - ring.s_from) * n / kStations;
    auto& line = lines.emplace_back();
    for (int piece = 0; piece < tooth_space::kPieces; ++piece) {
      auto b = space.borders(Piece(piece));
      // A little beyond the face cone.
      if (is_flank(Piece(piece))) (piece == 0 ? b.from : b.to) = space.tip_edge(piece == 0 ? 1 : -1, s)->u + 0.2;
      for (int k = 0; k <= kPoints; ++k) {
        const auto q = tooth_space::place_at(space, Piece(piece), b.from + (b.to - b.from) * k / kPoints, s);
        line.emplace_back(azimuth(q.value().p), ring.chart.up(q->p));
      }
    }
  }
  return {spiral_bevel::part_of(gear), [gear, lines](const Vec3& p) {
            const auto& outline = gear.space().outline();
            const double s = outline.chart.along(p), h = outline.chart.up(p);
            if (s < outline.s_from || s > outline.s_to || h > gear.space().tip(s)) return false;
            if (h < gear.body().lowest_root) return true;
            const double x = (s - outline.s_from) / (outline.s_to - outline.s_from) * kStations;
            const auto n = std::min(std::size_t(x), std::size_t(kStations) - 1);
            std::vector<Vec2> line = lines[n];
            for (std::size_t k = 0; k < line.size(); ++k) line[k] += (x - double(n)) * (lines[n + 1][k] - line[k]);
            const double middle = 0.5 * (line.front().x() + line.back().x());
            return under(line, {middle + std::remainder(azimuth(p) - middle, outline.pitch), h});
          }};
}
/// The small end of the pair's pinion, and of its wheel.
spiral_bevel::SpiralBevelParameters narrow_spiral(spiral_bevel::SpiralBevelParameters g) {
  const double before = g.mean_cone_distance();
  g.outer_cone_distance_mm -= 20;
  g.face_width_mm -= 20;
  if (g.mean_space_width_mm) *g.mean_space_width_mm *= g.mean_cone_distance() / before;
  return g;
}

straight_bevel::StraightBevelParameters narrow_bevel(straight_bevel::Form form) {
  auto g = khk_pinion(form);
  g.face_width_mm = 5;
  return g;
}

/// Profiles at stations along the face, taken straight between them.
Solid solid_of(const std::shared_ptr<const bevel_gear::BevelPart>& part) {
  constexpr int kStations = 81;
  std::vector<std::vector<std::vector<Vec2>>> zones;  // zone, station: azimuth and height from tip to tip
  for (int zone = 0; zone < part->zones(); ++zone) {
    const auto& ring = part->space(zone).outline();
    const tooth_space::OffsetSheet sheet(part->space(zone), 0, ring.s_from, ring.s_to, kStations);
    auto& lines = zones.emplace_back();
    for (const auto& station : sheet.stations())
      for (auto& line = lines.emplace_back(); const auto& node : station.nodes)
        line.emplace_back(node.azimuth, ring.chart.up(node.at.centre));
  }
  return {part, [part, zones](const Vec3& p) {
            const double s = part->chart().along(p), h = part->chart().up(p);
            if (h > part->blank_top()) return false;
            for (std::size_t zone = 0; zone < zones.size(); ++zone) {
              const auto& ring = part->space(int(zone)).outline();
              if (s < ring.s_from || s > ring.s_to) continue;
              const double at = (s - ring.s_from) / (ring.s_to - ring.s_from) * (kStations - 1);
              const auto k = std::min(std::size_t(at), std::size_t(kStations - 2));
              std::vector<Vec2> line;
              for (std::size_t n = 0; n < zones[zone][k].size(); ++n)
                line.push_back(zones[zone][k][n] + (at - double(k)) * (zones[zone][k + 1][n] - zones[zone][k][n]));
              const double middle = line[line.size() / 2].x();
              return under(line, {middle + std::remainder(azimuth(p) - middle, ring.pitch), h});
            }
            const auto groove = part->groove();
            return groove && s > groove->from && s < groove->to && h < *part->groove_floor();
          }};
}

std::shared_ptr<const bevel_gear::BevelPart> narrow_curved(double face, double groove) {
  auto g = groove > 0 ? bevel_test::w3() : bevel_test::w1();
  g.face_width_mm = face;
  g.relief_half_width_mm = groove;
  if (groove > 0) g.apex_cone_distance_mm = 123.438243669 - 0.5 * face;
  return std::make_shared<bevel_gear::BevelPart>(bevel_test::made(g, bevel_test::pinion_mill()));
}

struct Case {
  const char* name;
  Solid (*solid)();
};

class AnyPart : public testing::TestWithParam<Case> {};

TEST_P(AnyPart, DistancesAreThoseOfTheSolid) {
  const Solid solid = GetParam().solid();
  const analytic::GearDistance part(solid.part, 2.0);
  ASSERT_FALSE(part.refusal()) << part.refusal()->diagnostic.message;
  EXPECT_EQ(part.unproven(), 0u);
  Random random(11);
  int outside = 0, inside = 0, near = 0;
  const tooth_space::Chart& chart = solid.part->chart();
  for (int n = 0; n < 250; ++n) {
    const auto& ring = solid.part->space(int(random.index(std::size_t(solid.part->zones())))).outline();
    const Vec3 c = chart.place(random(ring.s_from - 1, ring.s_to + 1), random(-kPi, kPi),
                               random(solid.part->lowest_root() - 0.8, solid.part->blank_top() + 1.2));
    const auto q = part.nearest(c, 1.2);
    if (solid.holds(c)) {
      EXPECT_LE(q.distance, 1e-9) << "inside, at " << c.transpose();
      ++inside;
      continue;
    }
    ++outside;
    EXPECT_GE(q.distance, -1e-9) << "outside, at " << c.transpose();
    const double shown = solid.distance(c, 1.2, 14);
    EXPECT_LE(q.distance, shown + 2e-5) << c.transpose() << " " << q.patch;  // the profile is a polygon
    // The directions are 6 deg apart: the way to a curved surface is longer by a few percent, to an edge and its
    // corners by more.
    if (q.distance < 1.19) {
      EXPECT_GE(q.distance, 0.8 * shown - 0.01) << c.transpose() << " " << q.patch;
      ++near;
    }
    EXPECT_LE(part.surface_keeps(c, 1.2), std::max(q.distance, 0.0) + 1e-9);
  }
  EXPECT_GT(outside, 60);
  EXPECT_GT(inside, 40);
  EXPECT_GT(near, 40);
}

INSTANTIATE_TEST_SUITE_P(
    Gears, AnyPart,
    testing::Values(Case{"spur", [] { return solid_of(narrow_spur()); }},
                    Case{"pinion", [] { return solid_of(narrow_pinion()); }},
                    Case{"far", [] { return solid_of(far_helical()); }},
                    Case{"octoid", [] { return solid_of(narrow_bevel(straight_bevel::Form::octoid)); }},
                    Case{"spiral_pinion", [] { return solid_of(narrow_spiral(nasa_pinion())); }},
                    Case{"spiral_wheel", [] { return solid_of(narrow_spiral(formate_wheel())); }},
                    Case{"spiral_steep", [] { return solid_of(narrow_spiral(steep_gear(12))); }},
                    Case{"curved", [] { return solid_of(narrow_curved(6, 0)); }},
                    Case{"herringbone", [] { return solid_of(narrow_curved(22, 3.3)); }},
                    Case{"involute", [] { return solid_of(narrow_bevel(straight_bevel::Form::spherical_involute)); }}),
    [](const testing::TestParamInfo<Case>& c) { return std::string(c.param.name); });

/// A gear by points stands where the gear stands that they were taken from, besides its fillets; nothing rests on
/// sampling.
TEST(PartByPoints, DistancesAreThoseOfTheGearThatThePointsAreOf) {
  const auto octoid = narrow_bevel(straight_bevel::Form::octoid);
  auto helical = left_helical();
  helical.zones = {{radians(-18), 4, 9}};
  const struct {
    flank_grid::FlankGridParameters grid;
    std::shared_ptr<const tooth_space::ToothedPart> plain;
  } cases[] = {
      {sampled(octoid, {9, 7, 0.75}), straight_bevel::part_of(straight_bevel::StraightBevelGear::make(octoid).value())},
      {sampled(helical, {9, 7, 0.7}), cylindrical::part_of(made(helical))}};
  for (const auto& one : cases) {
    const auto gear = flank_grid::FlankGridGear::make(one.grid);
    ASSERT_TRUE(gear) << gear.error().front().diagnostic.message;
    const analytic::GearDistance grid(flank_grid::part_of(*gear), 1.5), plain(one.plain, 1.5);
    ASSERT_FALSE(grid.refusal()) << grid.refusal()->diagnostic.message;
    EXPECT_EQ(grid.unproven(), 0u);
    const double allowed = *gear->quality().spacing_mm + 1e-6;
    Random random(13);
    int compared = 0;
    const auto& ring = one.plain->space(0).outline();
    for (int n = 0; n < 400; ++n) {
      const Vec3 c = ring.chart.place(random(ring.s_from - 1, ring.s_to + 1), random(-kPi, kPi),
                                      random(one.plain->lowest_root(), one.plain->blank_top() + 1));
      const auto a = grid.nearest(c, 1), b = plain.nearest(c, 1);
      const auto known = [](const analytic::NearestPlace& q) {  // the others meet fillets
        const std::string patch = q.patch;
        return q.distance < 0.99 && (patch.starts_with("flank") || patch.starts_with("tip"));
      };
      if (!known(a) || !known(b)) continue;
      EXPECT_NEAR(std::max(a.distance, 0.0), std::max(b.distance, 0.0), allowed) << c.transpose() << " " << a.patch;
      ++compared;
    }
    EXPECT_GT(compared, 80);
  }
}

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
void tool_paths_cut_the_space_and_nothing_else(const Solid& solid, double ball) {
  const double R = 0.5 * ball;
  std::vector<tool::ToolAssembly> tools{ball_mill(ball, 9, ball, 22, 10)};
  auto rough = operation(path::OperationType::roughing, 0), finish = operation(path::OperationType::finishing, 0);
  rough.step_down_mm = 0.8 * R;
  rough.step_over_mm = R;
  rough.allowance_mm = 0.15;
  finish.scallop_mm = 0.01;
  finish.chord_tolerance_mm = 0.002;
  const analytic::GearDistance part(solid.part, ball::reach_of(tools));
  auto planned = plan::plan_milling(part, tools, {rough, finish}, {});
  ASSERT_FALSE(planned.refused()) << planned.refused()->key << ": " << planned.refused()->diagnostic.message;
  const auto plan = std::move(planned).value();
  analytic::GougeCheckOptions options;
  options.rapid_height_mm = solid.part->blank_top();
  const analytic::GougeCheck check(part, tools, options);
  for (const auto& path : plan.paths) {
    const auto checked = check.check_path(path);
    EXPECT_TRUE(checked) << checked.error().message;
  }
  Random random(5);
  int in = 0;
  const auto& records = plan.paths[1].records;
  for (const auto& record : records)
    for (int k = 0; k < 20; ++k)
      in += solid.holds(record.tip + R * record.axis + (R - 0.003) * random.vector(1).normalized()) ? 1 : 0;
  EXPECT_EQ(in, 0) << "of " << 20 * records.size();
  // The nearest ball of the finishing path leaves no more than the scallop that was asked for.
  const tooth_space::OffsetSheet surface(solid.part->space(0), 0, solid.part->space(0).outline().s_from,
                                         solid.part->space(0).outline().s_to, 9);
  const auto& ring = solid.part->space(0).outline();
  double highest = 0;
  for (int i = 1; i < 60; ++i)
    for (int j = 1; j < 8; ++j) {
      const auto q = surface.raw(5.0 * i / 60, ring.s_from + (ring.s_to - ring.s_from) * (0.02 + 0.96 * j / 8));
      if (!q || ring.chart.up(q->contact.p) > solid.part->space(0).tip(ring.chart.along(q->contact.p))) continue;
      double left = INFINITY;
      for (std::size_t k = 1; k < records.size(); ++k)
        if (records[k].kind == path::MoveKind::feed)
          left = std::min(left, distance_to_segment(q->contact.p, records[k - 1].tip + R * records[k - 1].axis,
                                                    records[k].tip + R * records[k].axis) -
                                    R);
      highest = std::max(highest, left);
    }
  EXPECT_LT(highest, 0.0102);
  EXPECT_GT(highest, 0.001);
}

TEST(ToolPathsOnACylinder, CutTheSpaceAndNothingElse) {
  tool_paths_cut_the_space_and_nothing_else(solid_of(narrow_spur()), 2);
}
TEST(ToolPathsOnASpiral, CutTheSpaceAndNothingElse) {
  tool_paths_cut_the_space_and_nothing_else(solid_of(narrow_spiral(nasa_pinion())), 1.6);
}
TEST(ToolPathsOnACone, CutTheSpaceAndNothingElse) {
  tool_paths_cut_the_space_and_nothing_else(solid_of(narrow_bevel(straight_bevel::Form::octoid)), 1.2);
}
TEST(ToolPathsOnACone, CutCurvedSpacesAndNothingElse) {
  tool_paths_cut_the_space_and_nothing_else(solid_of(narrow_curved(6, 0)), 1.6);
}

/// A bevel gear by points between ends that lean, over a ridge in the root and under a crowned tip. The solid is told
/// by the straight lines of its meridian and the flanks that the points were taken from; its fillets are left out.
TEST(ToolPathsOnACone, CutABentGearByPointsAndNothingElse) {
  const auto octoid = narrow_bevel(straight_bevel::Form::octoid);
  const auto exact = straight_bevel::part_of(straight_bevel::StraightBevelGear::make(octoid).value());
  const auto made = flank_grid::FlankGridGear::make(
      sampled(exact->space(0), octoid.teeth, {9, 9, 0.75}, {0.12, -0.1, 0.02, 0.1, 0.15}));
  ASSERT_TRUE(made) << made.error().front().diagnostic.message;
  const auto gear = std::make_shared<const flank_grid::FlankGridGear>(made.value());
  const auto& ring = gear->space().outline();
  ASSERT_TRUE(ring.leaning);
  const auto height = [&ring](const std::vector<Vec2>& line, double s) {
    std::vector<Vec2> at;
    for (const Vec2& p : line)
      at.emplace_back(ring.chart.along(Vec3(p.x(), 0, p.y())), ring.chart.up(Vec3(p.x(), 0, p.y())));
    if (at.front().x() > at.back().x()) std::reverse(at.begin(), at.end());
    const std::size_t k = s < at[1].x() ? 0 : 1;
    return at[k].y() + (s - at[k].x()) / (at[k + 1].x() - at[k].x()) * (at[k + 1].y() - at[k].y());
  };
  const auto holds = [&](const Vec3& p) {
    const double s = ring.chart.along(p), h = ring.chart.up(p), station = ring.station(p);
    if (station < ring.s_from || station > ring.s_to || h > height(gear->parameters().tip, s)) return false;
    if (h < height(gear->parameters().root, s)) return true;
    std::array<double, 2> wall{};
    for (const int side : {1, -1}) {
      const Piece piece = tooth_space::flank_of(side);
      const auto& of = exact->space(0);
      const tooth_space::Borders b = of.borders(piece);
      const double foot = std::isfinite(b.from) ? b.from : b.to;
      const double s_exact = of.outline().chart.along(p), h_exact = of.outline().chart.up(p);
      const auto low = tooth_space::place_at(of, piece, foot, s_exact);
      if (!low || of.outline().chart.up(low->p) > h_exact) return false;
      const double u = 0.5 * (foot + of.tip_edge(side, s_exact)->u);
      const auto at =
          tooth_space::search_place(of, piece, s_exact, h_exact, {u, tooth_space::v_at(of, piece, u, s_exact).value()});
      wall[side > 0 ? 0 : 1] = azimuth(at.value().at.p);
    }
    const double turn = std::remainder(azimuth(p), ring.pitch);
    return turn < wall[0] || turn > wall[1];
  };
  tool_paths_cut_the_space_and_nothing_else({flank_grid::part_of(*gear), holds}, 1.2);
  const analytic::GearDistance part(flank_grid::part_of(*gear), 1.5);
  EXPECT_EQ(part.unproven(), 0u);
}

// Teeth that taper: what stands above the first layer is no thicker at the large end than a layer.
TEST(ToolPathsOnACone, NoLayerIsThickerThanAsked) {
  constexpr double kStep = 0.5, kBall = 1.2;
  const auto gear = straight_bevel::StraightBevelGear::make(khk_pinion(straight_bevel::Form::octoid)).value();
  const auto part = straight_bevel::part_of(gear);
  std::vector<tool::ToolAssembly> tools{ball_mill(kBall, 9, kBall, 22, 10)};
  auto rough = operation(path::OperationType::roughing, 0);
  rough.step_down_mm = rough.step_over_mm = kStep;
  rough.allowance_mm = 0.15;
  auto planned = plan::plan_milling({part, ball::reach_of(tools)}, tools, {rough}, {});
  ASSERT_FALSE(planned.refused()) << planned.refused()->diagnostic.message;
  const auto& records = planned.value().paths[0].records;
  const auto& ring = part->space(0).outline();
  constexpr int kPlaces = 20;
  std::array<double, kPlaces + 1> highest;  // bottom of the ball that cuts there, below the tips
  highest.fill(-INFINITY);
  for (std::size_t k = 1; k < records.size(); ++k)
    for (int i = 0; i <= 50 && records[k].kind == path::MoveKind::feed; ++i) {
      const auto centre = [&](const path::ClRecord& r) { return Vec3(r.tip + 0.5 * kBall * r.axis); };
      const Vec3 c = centre(records[k - 1]) + i / 50.0 * (centre(records[k]) - centre(records[k - 1]));
      const double share = (ring.chart.along(c) - ring.s_from) / (ring.s_to - ring.s_from);
      if (share < 0 || share > 1) continue;
      double& found = highest[std::size_t(std::lround(share * kPlaces))];
      found = std::max(found, ring.chart.up(c) - 0.5 * kBall - part->space(0).tip(ring.chart.along(c)));
    }
  for (const double h : highest) EXPECT_GT(h, -1.05 * kStep);
}

/// A space that bounds no bends of its fillets.
class WithoutBounds final : public tooth_space::ToothSpace {
 public:
  explicit WithoutBounds(const tooth_space::ToothSpace& of) : of_(of) {}
  [[nodiscard]] const tooth_space::Outline& outline() const override { return of_.outline(); }
  [[nodiscard]] double tip(double s) const override { return of_.tip(s); }
  [[nodiscard]] tooth_space::CurveBend tip_bend(double a, double b) const override { return of_.tip_bend(a, b); }
  [[nodiscard]] tooth_space::Borders borders(Piece p) const override { return of_.borders(p); }
  [[nodiscard]] tooth_space::Borders active(Piece p) const override { return of_.active(p); }
  [[nodiscard]] std::optional<tooth_space::PatchPoint> at(Piece p, double u, double v) const override {
    return of_.at(p, u, v);
  }
  [[nodiscard]] std::optional<tooth_space::PatchFoot> foot(Piece p, const Vec3& c, double u, double v) const override {
    return of_.foot(p, c, u, v);
  }
  [[nodiscard]] std::optional<tooth_space::EdgePlace> tip_edge(
      int side, double s, const std::optional<tooth_space::EdgePlace>& near) const override {
    return of_.tip_edge(side, s, near);
  }
  [[nodiscard]] std::optional<double> start_v(Piece p, double u, double s, double d,
                                              const std::optional<tooth_space::Near>& near, int k) const override {
    return of_.start_v(p, u, s, d, near, k);
  }
  [[nodiscard]] double longest_step(Piece p, double s) const override { return of_.longest_step(p, s); }
  [[nodiscard]] std::optional<tooth_space::Jet> enclosure(Piece p, const tooth_space::PatchFrame& f, double a,
                                                          double b) const override {
    return is_fillet(p) ? std::nullopt : of_.enclosure(p, f, a, b);
  }

 private:
  const tooth_space::ToothSpace& of_;
};
class PartWithoutBounds final : public tooth_space::ToothedPart {
 public:
  explicit PartWithoutBounds(std::shared_ptr<const tooth_space::ToothedPart> of)
      : of_(std::move(of)), space_(of_->space(0)) {}
  [[nodiscard]] int teeth() const override { return of_->teeth(); }
  [[nodiscard]] int zones() const override { return 1; }
  [[nodiscard]] const tooth_space::ToothSpace& space(int) const override { return space_; }
  [[nodiscard]] double module_mm() const override { return of_->module_mm(); }
  [[nodiscard]] double lowest_root() const override { return of_->lowest_root(); }
  [[nodiscard]] std::optional<double> groove_floor() const override { return {}; }
  [[nodiscard]] double blank_top() const override { return of_->blank_top(); }
  [[nodiscard]] bool in_blank(const Vec3& p) const override { return of_->in_blank(p); }

 private:
  std::shared_ptr<const tooth_space::ToothedPart> of_;
  WithoutBounds space_;
};

/// Flank and fillet of steep blades bend quickly at the ends of the face, too: their edges there are proven closely.
TEST(RingsOfSteepBlades, AreProvenClosely) {
  const Solid solid = solid_of(narrow_spiral(steep_gear(12)));
  const auto ring = analytic::GearRing::make(*solid.part, 0, 1.0);
  ASSERT_FALSE(ring.refused()) << ring.refused()->diagnostic.message;
  EXPECT_LT((*ring)->edge_sag, 2.5e-4);
  EXPECT_EQ((*ring)->unproven_edges, 0u);
  EXPECT_EQ((*ring)->patches->sampled_blocks(), 0u);
}

/// What only samples bound is counted.
TEST(PatchesBySampling, AreCounted) {
  const std::vector<tool::ToolAssembly> tools{ball_mill(1.5, 9, 1.5, 22, 10)};
  const auto proven = solid_of(narrow_spur()).part;
  const auto sampled = std::make_shared<PartWithoutBounds>(proven);
  for (const auto& part : {proven, std::static_pointer_cast<const tooth_space::ToothedPart>(sampled)}) {
    const analytic::GearDistance distance(part, ball::reach_of(tools));
    const analytic::GougeCheck check(distance, tools, {});
    const auto r = check.check({}, {0});
    EXPECT_EQ(r.sampled_patches > 0, part == sampled);
    EXPECT_EQ(r.sampled_patches, distance.unproven());
    EXPECT_GT(r.patches, 4 * r.sampled_patches / 3);
  }
}

/// Where the ball is, the finger mill that defines the flanks has been.
TEST(ToolPathsOnACone, StayWhereTheFingerMillHasBeen) {
  constexpr double kBall = 1.6, kFace = 5;
  const auto part = narrow_curved(kFace, 0);
  const auto data = bevel_test::pinion_mill();
  const BruteForceBevelGear brute(part->gear().parameters(),
                                  {data.module_mm, data.tip_radius_mm, data.rack_depth_mm, data.profile_height_mm});
  const std::vector<tool::ToolAssembly> tools{ball_mill(kBall, 9, kBall, 22, 10)};
  auto finish = operation(path::OperationType::finishing, 0);
  finish.scallop_mm = 0.02;
  finish.chord_tolerance_mm = 0.002;
  const analytic::GearDistance distance(part, ball::reach_of(tools));
  auto planned = plan::plan_milling(distance, tools, {finish}, {});
  ASSERT_FALSE(planned.refused()) << planned.refused()->diagnostic.message;
  Random random(9);
  int looked = 0, deep = 0;
  double nearest = INFINITY;
  const auto& records = planned.value_if()->paths[0].records;
  for (std::size_t k = 0; k < records.size(); k += 7)
    for (int n = 0; n < 6; ++n) {
      const auto& record = records[k];
      const Vec3 p = record.tip + 0.5 * kBall * (record.axis + random.vector(1).normalized());
      const double ell = -part->chart().along(p);
      if (ell < part->gear().R_i() || ell > part->gear().R_e() || part->chart().up(p) > part->blank_top()) continue;
      const double left = brute.clearance(p);
      ++looked;
      deep += left > 0.003 ? 1 : 0;
      nearest = std::min(nearest, std::abs(left));
    }
  EXPECT_GT(looked, 300);
  EXPECT_EQ(deep, 0) << "of " << looked;
  EXPECT_LT(nearest, 0.005);
}

}  // namespace
}  // namespace toothpath::test
