// The STEP file of a gear, read back: a closed shell, and its teeth against the exact surfaces.
#include <gtest/gtest.h>

#include "geometry/bevel_gear/part.h"
#include "geometry/cylindrical/part.h"
#include "geometry/exchange/step_gear.h"
#include "geometry/exchange/tooth_shell.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "geometry/face_gear/part.h"
#include "geometry/face_gear/space_sheet.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/exchange/step_reader.h"
#include "tests/geometry/mesh/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using exchange::kFitTolerance_mm;

constexpr double kTextRounding_mm = 2e-7;  // coordinates have seven digits
constexpr double kEdge_mm = kFitTolerance_mm + kTextRounding_mm;
constexpr int kGrid = 29;  // places across a patch: not those of the fit, which are shares of its pieces

Result<std::string> step_of(const Result<exchange::GearShell>& shell, exchange::StepCounts* counts = nullptr) {
  if (!shell) return shell.error();
  const auto fitted = exchange::fit_shell(*shell);
  if (!fitted) return fitted.error();
  EXPECT_LE(fitted->worst_mm, kFitTolerance_mm);
  auto file = exchange::step_gear(*shell, *fitted, "gear 'of' the \\ test");
  if (!file) return file.error();
  if (counts) *counts = file->counts;
  return std::move(file->text);
}

std::string step_or_fail(const Result<exchange::GearShell>& shell, exchange::StepCounts* counts = nullptr) {
  const auto text = step_of(shell, counts);
  if (!text) {
    ADD_FAILURE() << text.error().message;
    return {};
  }
  return *text;
}

void expect_solid(const StepReader& step, const std::string& what, long holes = 1) {
  const auto faults = faults_of(step, kEdge_mm, holes);
  for (std::size_t k = 0; k < std::min<std::size_t>(faults.size(), 5); ++k) ADD_FAILURE() << what << ": " << faults[k];
}

/// A patch by what its name says: "flank +1 of tooth 12, zone 0".
struct NamedPatch {
  std::string strip;
  int tooth = 0;
  std::size_t ring = 0;
  ReadSpline surface;
};

std::vector<NamedPatch> patches_of(const StepReader& step) {
  std::vector<NamedPatch> out;
  for (const int id : step.faces()) {
    const ReadFace face = step.face(id);
    const std::size_t of = face.name.find(" of tooth "), comma = face.name.find(", ");
    if (of == std::string::npos || face.name.starts_with("end")) continue;
    NamedPatch patch{face.name.substr(0, of), std::stoi(face.name.substr(of + 10)), 0, {}};
    if (comma != std::string::npos) patch.ring = std::stoul(face.name.substr(face.name.rfind(' ') + 1));
    patch.surface = step.spline(face.surface);
    out.push_back(std::move(patch));
  }
  return out;
}

/// Distance of a place to the exact surface of a strip of space 0, whose flanks are those of teeth 0 and 1; the place
/// turned there.
double face_gear_distance(const face_gear::FaceGear& gear, const NamedPatch& patch, const Vec3& p,
                          const face_gear::SpaceSheet& sheet) {
  const auto& surface = gear.rings()[patch.ring].surface;
  const double r = radius(p), miss = INFINITY;
  const int s = patch.strip.ends_with("+1") ? 1 : -1;
  const Vec3 home = turned(p, -patch.tooth * gear.pitch());
  if (patch.strip.starts_with("flank")) {
    const auto d = face_gear::flank_distance(surface, s, home);
    return d ? std::abs(d->distance) : miss;
  }
  if (patch.strip.starts_with("fillet")) {
    const auto piece = tooth_space::fillet_of(s);
    const Vec3 in_space = turned(p, (s > 0 ? -patch.tooth : 1 - patch.tooth) * gear.pitch());
    double best = miss;
    for (int k = 0; k <= 8; ++k) {  // starts all along the rounding
      const double A = surface.shaper.A_t + (surface.shaper.A_e - surface.shaper.A_t) * k / 8;
      const auto Z = face_gear::fillet_Z_at_radius(surface, s, A, r, surface.L_p);
      if (!Z) continue;
      const auto foot = sheet.foot(piece, in_space, A, *Z);
      if (foot) best = std::min(best, std::abs(foot->distance));
    }
    return best;
  }
  if (patch.strip == "root") return std::abs(p.z() - face_gear::root_height(surface, r).value_or(miss));
  return std::abs(p.z() - surface.z_tip(r));
}

void expect_exact(const face_gear::FaceGear& gear, const StepReader& step, const std::string& what) {
  std::vector<face_gear::SpaceSheet> sheets;
  for (const auto& ring : gear.rings()) sheets.emplace_back(gear.parameters(), ring);
  const int teeth = gear.parameters().teeth;
  std::size_t seen = 0;
  for (const NamedPatch& patch : patches_of(step)) {
    if (patch.tooth != 0 && patch.tooth != 1 && patch.tooth != teeth / 3) continue;
    ++seen;
    double worst = 0;
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const Vec3 p = spline_at(patch.surface, double(i) / (kGrid - 1), double(j) / (kGrid - 1));
        worst = std::max(worst, face_gear_distance(gear, patch, p, sheets[patch.ring]));
      }
    EXPECT_LE(worst, kFitTolerance_mm + kTextRounding_mm) << what << ": " << patch.strip << " of tooth " << patch.tooth;
  }
  EXPECT_GE(seen, 15 * gear.rings().size()) << what;
}

TEST(StepOfFaceGears, ClosedShellsOfExactTeeth) {
  for (const MeshSample& sample : mesh_samples()) {
    const face_gear::FaceGear gear = made(sample.gear);
    const StepReader step(step_or_fail(exchange::tooth_shell(drawn_solid(gear))));
    expect_solid(step, sample.name);
    expect_exact(gear, step, sample.name);
  }
}

TEST(StepOfFaceGears, SamplesOfTheJobs) {
  for (const auto& parameters : {small_spur(), quarter_dhfg(), offset_gear(), steep_gear(70, 76, 86)}) {
    const face_gear::FaceGear gear = made(parameters);
    exchange::StepCounts counts;
    const StepReader step(step_or_fail(exchange::tooth_shell(drawn_solid(gear)), &counts));
    const std::string what = fmt::format("{} teeth", parameters.teeth);
    expect_solid(step, what);
    expect_exact(gear, step, what);
    EXPECT_EQ(counts.faces, step.faces().size());
    EXPECT_EQ(counts.edges, step.named("EDGE_CURVE").size());
    EXPECT_EQ(counts.vertices, step.named("VERTEX_POINT").size());
  }
}

TEST(StepOfFaceGears, TopLandsLookUp) {
  const StepReader step(step_or_fail(exchange::tooth_shell(drawn_solid(made(small_spur())))));
  std::size_t lands = 0;
  for (const int id : step.faces()) {
    const ReadFace face = step.face(id);
    if (!face.name.starts_with("top land")) continue;
    ++lands;
    EXPECT_GT(normal_of(step, face, Vec3::Zero()).z(), 0.999) << face.name;
  }
  EXPECT_EQ(lands, 60u);
}

TEST(StepOfFaceGears, RandomGears) {
  Random random(20261123);
  int solids = 0;
  for (int k = 0; k < 60 && solids < 12; ++k) {
    face_gear::FaceGearParameters p;
    p.shaper_teeth = 16 + int(random.index(16));
    p.teeth = p.shaper_teeth + int(random.index(60));
    p.module_mm = random(0.5, 8);
    p.pressure_angle_rad = radians(random(18, 27));
    p.offset_mm = random(-8, 8) * p.module_mm / 3;
    p.shaft_angle_rad = radians(random(70, 110));
    p.shaper_tip_radius_mm = random(0.1, 0.3) * p.module_mm;
    const double beta = radians(random(-25, 25));
    const auto surface = face_gear::make_surface<double>(p, beta);
    const auto limits = face_gear::zone_limits(surface, p.module_mm);
    const double outer = limits.land_radius.value_or(limits.inner_limit + 5 * p.module_mm);
    if (!(outer > limits.inner_limit * 1.002)) continue;
    const double from = limits.inner_limit + random(0.02, 0.4) * (outer - limits.inner_limit);
    p.zones = {{beta, from, from + random(0.3, 0.95) * (outer - from)}};
    const auto gear = face_gear::FaceGear::make(p);
    if (!gear) continue;
    const auto text = step_of(exchange::tooth_shell(drawn_solid(*gear)));
    if (!text) {
      ADD_FAILURE() << k << ": " << text.error().message;
      continue;
    }
    ++solids;
    const StepReader step(*text);
    expect_solid(step, std::to_string(k));
    expect_exact(*gear, step, std::to_string(k));
  }
  EXPECT_EQ(solids, 12);
}

void expect_exact(const bevel_gear::BevelGear& gear, const StepReader& step, const std::string& what) {
  std::size_t seen = 0;
  for (const NamedPatch& patch : patches_of(step)) {
    if (patch.tooth > 1) continue;
    ++seen;
    double worst = 0;
    const bool L = patch.strip.ends_with("+1"), wall = L || patch.strip.ends_with("-1");
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const Vec3 p = spline_at(patch.surface, double(i) / (kGrid - 1), double(j) / (kGrid - 1));
        const auto at = bevel_gear::cone_point(p, gear.sin_delta(), gear.cos_delta());
        if (!wall) {
          const double height = patch.strip == "root" ? -gear.parameters().dedendum_mm : gear.parameters().addendum_mm;
          worst = std::max(worst, std::abs(at.height - height));
          continue;
        }
        // The exact wall at this place of the meridian plane: how far it is turned away is no less than its distance.
        const auto& w = gear.halves()[patch.ring].wall(L ? 1 : -1);
        const double least = -gear.parameters().dedendum_mm;
        const auto exact = bevel_gear::bevel_inverse(w, at.ell, std::max(at.height, least));
        if (!exact) {
          worst = INFINITY;
          continue;
        }
        // Where the wall runs out into the root it is flat: the place is near it, whatever the turn.
        const double turn =
            std::remainder(exact->azimuth + (patch.tooth - (L ? 0 : 1)) * gear.pitch() - at.azimuth, 2 * kPi);
        const auto q = w.point(exact->beta, exact->p);
        const Vec3 there = turned(q.p, (patch.tooth - (L ? 0 : 1)) * gear.pitch()),
                   normal = turned(q.n, (patch.tooth - (L ? 0 : 1)) * gear.pitch());
        EXPECT_LT(std::abs(turn), 0.1);
        worst = std::max(worst, std::abs((p - there).dot(normal)));
      }
    EXPECT_LE(worst, kFitTolerance_mm + kTextRounding_mm) << what << ": " << patch.strip << " of tooth " << patch.tooth;
  }
  EXPECT_GE(seen, 12 * gear.halves().size()) << what;
}

TEST(StepOfBevelGears, ClosedShellsOfExactTeeth) {
  using namespace bevel_test;
  const std::vector<std::pair<std::string, bevel_gear::BevelGear>> gears = {
      {"single pinion", bevel_test::made(w1(), pinion_mill())},
      {"single wheel", bevel_test::made(w2(), wheel_mill())},
      {"herringbone pinion", bevel_test::made(w3(), pinion_mill())},
      {"herringbone wheel", bevel_test::made(w4(), wheel_mill())}};
  for (const auto& [name, gear] : gears) {
    const bevel_gear::BevelPart part(gear);
    const StepReader step(step_or_fail(exchange::tooth_shell(drawn_solid(part))));
    expect_solid(step, name);
    expect_exact(gear, step, name);
    for (const int id : step.faces()) {
      const ReadFace face = step.face(id);
      if (!face.name.starts_with("top land of tooth 0")) continue;
      const Vec3 middle = spline_at(step.spline(face.surface), 0.5, 0.5);
      const Vec3 up =
          (gear.cos_delta() * Vec3(middle.x(), middle.y(), 0).normalized() - gear.sin_delta() * Vec3::UnitZ());
      EXPECT_GT(normal_of(step, face, middle).dot(up), 0.999) << name;
    }
  }
}

/// The checks above find what they are there to find.
TEST(StepOfCylindricalGears, ClosedShellsOfExactTeeth) {
  auto without_bore = double_helical_pinion();
  without_bore.bore_diameter_mm = 0;
  auto level_groove = double_helical_pinion();
  level_groove.groove_diameter_mm = made(level_groove).root_diameter();
  for (const auto& parameters : {shifted_spur(), double_helical_pinion(), without_bore, level_groove}) {
    const cylindrical::CylindricalGear gear = made(parameters);
    const tooth_space::ToothedSolid solid = drawn_solid(gear);
    exchange::StepCounts counts;
    const StepReader step(step_or_fail(exchange::tooth_shell(solid), &counts));
    const std::string what = fmt::format("{} teeth, bore {}", parameters.teeth, parameters.bore_diameter_mm);
    expect_solid(step, what, parameters.bore_diameter_mm > 0 ? 1 : 0);
    EXPECT_EQ(counts.faces, step.faces().size());
    std::size_t seen = 0;
    for (const NamedPatch& patch : patches_of(step)) {
      if (patch.tooth > 1) continue;
      ++seen;
      const auto& space = gear.space(int(patch.ring));
      double worst = 0;
      for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j) {
          const Vec3 p = spline_at(patch.surface, double(i) / (kGrid - 1), double(j) / (kGrid - 1));
          if (patch.strip == "top land") {
            worst = std::max(worst, std::abs(radius(p) - 0.5 * gear.tip_diameter()));
          } else if (patch.strip == "root") {
            worst = std::max(worst, std::abs(radius(p) - 0.5 * gear.root_diameter()));
          } else {
            // Pieces of side -1 are named after the tooth behind their space.
            const bool plus = patch.strip.ends_with("+1"), flank = patch.strip.starts_with("flank");
            const auto piece = flank ? tooth_space::flank_of(plus ? 1 : -1) : tooth_space::fillet_of(plus ? 1 : -1);
            const Vec3 home = turned(p, -(patch.tooth - (plus ? 0 : 1)) * space.outline().pitch);
            const auto& k = space.kernel();
            const double u = flank ? k.theta_at(std::max(radius(p), k.r_b)) : 0.5 * (k.alpha_n + k.quarter);
            const auto foot = space.foot(piece, home, u, p.z());
            worst = std::max(worst, foot ? std::abs(foot->distance) : INFINITY);
          }
        }
      EXPECT_LE(worst, kEdge_mm) << what << ": " << patch.strip << " of tooth " << patch.tooth;
    }
    EXPECT_GE(seen, 11 * parameters.zones.size()) << what;
  }
}

TEST(StepFaults, AreFound) {
  const std::string good = step_or_fail(exchange::tooth_shell(drawn_solid(made(small_spur()))));
  ASSERT_TRUE(faults_of(StepReader(good), kEdge_mm).empty());
  std::string turned_round = good;
  const std::size_t oriented = turned_round.find(",.T.);", turned_round.find("ORIENTED_EDGE('',*,*,"));
  turned_round.replace(oriented, 4, ",.F.");
  const std::size_t shell = good.find("CLOSED_SHELL('',("), first_comma = good.find(',', shell + 17);
  std::string without_face = good;
  without_face.erase(shell + 17, first_comma + 1 - (shell + 17));
  std::string moved = good;
  const std::size_t curve = moved.find("B_SPLINE_CURVE_WITH_KNOTS('',3,(#"), second = moved.find(",#", curve),
                    end = moved.find_first_of(",)", second + 1);
  const std::string point = "\n" + moved.substr(second + 1, end - second - 1) + "=CARTESIAN_POINT('',(";
  const std::size_t x = moved.find(point) + point.size();
  moved.replace(x, 1, moved[x] == '9' ? "8" : "9");
  std::string flipped = good;
  flipped.replace(flipped.find(".T.", flipped.find("ADVANCED_FACE('top land of tooth 7'")), 3, ".F.");
  for (const auto& [what, text] :
       std::vector<std::pair<std::string, std::string>>{{"an edge turned round", turned_round},
                                                        {"a face left out", without_face},
                                                        {"a control point of an edge moved", moved},
                                                        {"a normal turned round", flipped}})
    EXPECT_FALSE(faults_of(StepReader(text), kEdge_mm).empty()) << what;
}

TEST(StepFaults, APatchOffByTwiceTheToleranceIsFound) {
  const face_gear::FaceGear gear = made(small_spur());
  const auto shell = exchange::tooth_shell(drawn_solid(gear));
  auto fitted = exchange::fit_shell(*shell);
  ASSERT_TRUE(fitted);
  for (Vec3& p : fitted->rings[0].strips[0].control) p = turned(p, 2 * kFitTolerance_mm / 60);
  const auto file = exchange::step_gear(*shell, *fitted, "off");
  const StepReader step(file->text);
  const face_gear::SpaceSheet sheet(gear.parameters(), gear.rings()[0]);
  double worst = 0;
  for (const NamedPatch& patch : patches_of(step))
    if (patch.strip == "flank +1" && patch.tooth == 3)
      worst = face_gear_distance(gear, patch, spline_at(patch.surface, 0.3, 0.4), sheet);
  EXPECT_GT(worst, 1.5 * kFitTolerance_mm);
}

TEST(StepRefusals, SayWhatAndWhere) {
  face_gear::FaceGearParameters p = double_helical_parameters();
  p.groove_depth_mm = 11.25 + 1e-5;  // a hair below the root
  auto shell = exchange::tooth_shell(drawn_solid(made(p)));
  ASSERT_FALSE(shell);
  EXPECT_NE(shell.error().message.find("0.000010 mm below the root"), std::string::npos) << shell.error().message;
  EXPECT_NE(shell.error().message.find("stock.groove_depth"), std::string::npos) << shell.error().message;

  p = small_spur();
  p.shaper_tip_radius_mm = largest_tip_radius(p, 0) - 1e-4;
  shell = exchange::tooth_shell(drawn_solid(made(p)));
  ASSERT_FALSE(shell);
  EXPECT_NE(shell.error().message.find("root land = "), std::string::npos) << shell.error().message;
}

/// A step in a strip has no bicubic within 0.1 um: the refusal names strip, place and what is left.
TEST(StepRefusals, ASurfaceWithAStepIsNoPatch) {
  exchange::GearShell shell;
  shell.teeth = 10;
  exchange::ToothRing ring;
  ring.strips = {{"flank +1", 0}};
  ring.place = "zone 0";
  ring.station = [](double u) { return fmt::format("radius {:.1f} mm", 50 + u); };
  ring.row = [](double u, const std::vector<std::vector<double>>& v) -> Result<std::vector<std::vector<Vec3>>> {
    std::vector<std::vector<Vec3>> out(1);
    for (const double share : v[0]) out[0].emplace_back(u, share, u < 0.3 ? 0 : 0.01);
    return out;
  };
  shell.rings = {ring};
  const auto fitted = exchange::fit_shell(shell);
  ASSERT_FALSE(fitted);
  EXPECT_NE(fitted.error().message.find("flank +1 of zone 0, radius 50.3 mm"), std::string::npos)
      << fitted.error().message;
}

TEST(BSpline, MeetsItsPlacesAndReproducesCubics) {
  const exchange::Breaks breaks{0, 0.1, 0.15, 0.4, 1};
  const auto cubic = [](double t) { return Vec3(1 + t, t * t - 2 * t, 3 * t * t * t - t); };
  std::vector<Vec3> places;
  for (const double t : exchange::greville_points(breaks)) places.push_back(cubic(t));
  const auto curve = exchange::curve_through(breaks, places);
  EXPECT_EQ(curve.control.front(), places.front());
  EXPECT_EQ(curve.control.back(), places.back());
  for (int k = 0; k <= 100; ++k) EXPECT_LT((curve.at(k / 100.0) - cubic(k / 100.0)).norm(), 1e-13);
  const auto knots = exchange::clamped_knots(breaks);
  ReadSpline read{knots, {}, {}};
  for (const Vec3& p : curve.control) read.control.push_back({p});
  for (int k = 0; k <= 100; ++k) EXPECT_LT((curve.at(k / 100.0) - spline_at(read, k / 100.0)).norm(), 1e-14);
}

}  // namespace
}  // namespace toothpath::test
