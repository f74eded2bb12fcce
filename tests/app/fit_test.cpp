// Points made on an exact gear bring its numbers back from another start: to the digits that double numbers hold where
// the points are exact, within what the fit says of itself where they scatter; and what the points do not determine is
// held and named.
#include "app/fit/fit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "app/fit/job_text.h"
#include "app/job/file.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/space_sheet.h"
#include "geometry/face_gear/swept_solid.h"
#include "geometry/inspection/grid.h"
#include "geometry/tooth_space/limits.h"
#include "tests/app/program.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

const std::filesystem::path kFitTree = TOOTHPATH_SOURCE_DIR;

std::string sample(const char* name) { return file_text(kFitTree / "samples" / name); }
job::Job job_of(const std::string& text) {
  auto read = job::parse_job(text, (kFitTree / "samples/fit.toml").string());
  if (!read) ADD_FAILURE() << to_text(read.error());
  return read ? *read : job::Job{};
}

struct Made {
  double turn_rad = 0, shift_mm = 0, scatter_mm = 0;
  bool normals = true;
  int rows = 5, columns = 9;
};
/// Points of both flanks of the gear of a job, each pair of flanks on another tooth.
job::LoosePoints points_of(const job::Job& job, const Made& made = {}) {
  const auto spaces = fit::spaces_of(job.gear, job);
  if (!spaces) ADD_FAILURE() << spaces.error().diagnostic.message;
  job::LoosePoints out{"points.csv", true, {}};
  std::mt19937 random(7);
  std::normal_distribution<double> scatter(0, 1);
  for (std::size_t zone = 0; zone < spaces->size(); ++zone) {
    tooth_space::ToothedSolid solid;
    solid.teeth = int(std::lround(kTwoPi / (*spaces)[zone]->outline().pitch));
    solid.rings = {{(*spaces)[zone].get(), int(zone)}};
    const auto grid = inspection::inspection_grid(solid, {made.rows, made.columns});
    if (!grid) ADD_FAILURE() << grid.error().message;
    for (const auto& at : *grid) {
      const double turn = made.turn_rad + kTwoPi / solid.teeth * (at.column % 3);
      Vec3 p = turned(at.p + made.scatter_mm * scatter(random) * at.n, turn);
      p.z() += made.shift_mm;
      out.points.push_back({p, {}, {"points.csv", int(out.points.size()) + 2, 1}, 0});
      if (made.normals) out.points.back().n = turned(at.n, turn);
    }
  }
  return out;
}

const fit::Row& row(const fit::Fitted& fitted, const std::string& key) {
  for (const fit::Row& r : fitted.rows)
    if (r.key == key) return r;
  ADD_FAILURE() << key;
  return fitted.rows.front();
}
double number_of(const job::Job& job, const fit::Fitted& fitted, const std::string& key) {
  for (const auto* list : {&fitted.numbers.free, &fitted.numbers.follow})
    for (const fit::Number& n : *list)
      if (n.key == key) return n.get(job.gear);
  ADD_FAILURE() << key;
  return NAN;
}
std::string told(const fit::Fitted& fitted) {
  std::string text = fmt::format("before {:.6f}, after {:.9f} um rms, {} steps\n", 1e3 * fitted.before.rms_mm,
                                 1e3 * fitted.after.rms_mm, fitted.steps);
  for (const fit::Row& r : fitted.rows)
    text += fmt::format("{} {:.9g} -> {:.12g} +- {:.3g} {}\n", r.key, r.start, r.value, r.deviation, to_string(r.end));
  return text;
}

/// The spur gear of the samples with a helix.
std::string helical() {
  return replaced(replaced(sample("cylindrical_spur.toml"), "helix_angle = 0.0", "helix_angle = 15.0"),
                  "profile_shift = 0.2", "profile_shift = 0.2   # of the rack");
}

TEST(Fit, AHelicalGearComesBackTurnedAndMoved) {
  const job::Job truth = job_of(helical());
  const std::string start_text =
      replaced(replaced(replaced(helical(), "shift = 0.2", "shift = 0.05"), "angle = 20.0", "angle = 21.2"),
               "angle = 15.0", "angle = 14.1");
  const job::Job start = job_of(start_text);
  for (const bool normals : {true, false}) {
    const auto points = points_of(truth, {0.4, 1.5, 0, normals});
    const auto fitted = fit::fit_gear(start, points, {{}, {}, true, false, 0});
    ASSERT_TRUE(fitted) << fitted.error().text();
    SCOPED_TRACE(told(*fitted));
    EXPECT_LT(fitted->after.worst_mm, 1e-9);
    EXPECT_GT(fitted->before.worst_mm, 0.05);
    for (const char* key : {"profile_shift", "pressure_angle", "zone[0].helix_angle"})
      EXPECT_NEAR(row(*fitted, key).value, number_of(truth, *fitted, key), 1e-8) << key;
    // The thickness of the teeth is one number of the flanks, and two of the job.
    EXPECT_EQ(row(*fitted, "thickness_allowance").end, fit::End::held);
    EXPECT_EQ(row(*fitted, "thickness_allowance").moves_with.size(), 2u);
    // As a job: its comments stand, and it says these numbers.
    const auto text = fit::job_with_numbers(start, start_text, *fitted, start.file);
    ASSERT_TRUE(text) << to_text(text.error());
    EXPECT_NE(text->find("# of the rack"), std::string::npos);
    EXPECT_NEAR(number_of(job_of(*text), *fitted, "pressure_angle"), 20, 1e-8);
  }
}

TEST(Fit, APlaceAlongTheAxisIsNoNumberOfASpurGear) {
  const job::Job truth = job_of(sample("cylindrical_spur.toml"));
  const auto fitted = fit::fit_gear(truth, points_of(truth), {{"profile_shift"}, {}, true, true, 0});
  ASSERT_TRUE(fitted) << fitted.error().text();
  EXPECT_EQ(row(*fitted, "axial_position").end, fit::End::held) << told(*fitted);
  EXPECT_EQ(row(*fitted, "profile_shift").end, fit::End::determined) << told(*fitted);
}

TEST(Fit, ScatterIsWhatTheDeviationsSay) {
  const job::Job truth = job_of(helical()), start = job_of(replaced(replaced(helical(), "shift = 0.2", "shift = 0.1"),
                                                                    "angle = 20.0", "angle = 20.5"));
  Made made{-0.3, 0, 0.001};
  made.rows = 9;
  made.columns = 17;
  const auto fitted = fit::fit_gear(start, points_of(truth, made), {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_NEAR(fitted->after.rms_mm, 0.001, 0.0001);
  for (const char* key : {"profile_shift", "pressure_angle", "zone[0].helix_angle"}) {
    const fit::Row& r = row(*fitted, key);
    EXPECT_GT(r.deviation, 0) << key;
    EXPECT_LT(std::abs(r.value - number_of(truth, *fitted, key)), 4 * r.deviation) << key;
  }
}

TEST(Fit, AStraightBevelGearComesBack) {
  const std::string text = sample("straight_bevel.toml");
  const job::Job truth = job_of(text),
                 start = job_of(replaced(replaced(text, "pressure_angle = 20.0", "pressure_angle = 22.0"),
                                         "thickness_shift = 0.1256", "thickness_shift = 0.02"));
  const auto fitted = fit::fit_gear(start, points_of(truth, {0.1, -0.2}), {{}, {}, true, true, 0});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_LT(fitted->after.worst_mm, 1e-9);
  EXPECT_NEAR(row(*fitted, "pressure_angle").value, 20, 1e-8);
  EXPECT_NEAR(row(*fitted, "thickness_shift").value, 0.1256, 1e-9);
  EXPECT_NEAR(row(*fitted, "axial_position").value, -0.2, 1e-8);
}

TEST(Fit, TheSettingsOfASpiralBevelPinionComeBack) {
  const std::string text = sample("spiral_bevel.toml");
  const job::Job truth = job_of(text);
  std::string other = text;
  for (const auto& [from, to] : {std::pair("radial_distance = 74.874171554", "radial_distance = 74.6"),
                                 {"center_roll_position = 53.925994547", "center_roll_position = 54.3"},
                                 {"ratio_of_roll = 3.242698536", "ratio_of_roll = 3.25"},
                                 {"work_offset = -4.426244511", "work_offset = -4.2"},
                                 {"blade_pressure_angle = 18.045669752", "blade_pressure_angle = 18.4"},
                                 {"mean_space_width = 6.1", "mean_space_width = 6.3"}})
    other = replaced(other, from, to);
  const job::Job start = job_of(other);
  const auto fitted = fit::fit_gear(start, points_of(truth, {0.05}), {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_GT(fitted->before.worst_mm, 0.05);
  EXPECT_LT(fitted->after.worst_mm, 1e-7);
  EXPECT_EQ(fitted->placing.points.size(), 90U);
  EXPECT_NEAR(row(*fitted, "mean_space_width").value, 6.1, 1e-6);
  for (const char* key : {"cut[0].radial_distance", "cut[0].ratio_of_roll", "cut[0].blade_pressure_angle",
                          "cut[1].sliding_base", "cut[1].work_offset"})
    EXPECT_NEAR(row(*fitted, key).value, number_of(truth, *fitted, key), 1e-6) << key;
  // With a constant ratio another cradle angle turns the flank about the axis, no more.
  EXPECT_EQ(row(*fitted, "cut[0].center_roll_position").end, fit::End::held);
  EXPECT_EQ(row(*fitted, "cut[1].center_roll_position").end, fit::End::held);
  const auto changed = fit::job_with_numbers(start, other, *fitted, start.file);
  ASSERT_TRUE(changed) << to_text(changed.error());
  // Points that scatter by a micrometre: within what the fit says of itself.
  const auto scattered = fit::fit_gear(truth, points_of(truth, {-0.1, 0, 0.001}), {});
  ASSERT_TRUE(scattered) << scattered.error().text();
  SCOPED_TRACE(told(*scattered));
  EXPECT_NEAR(scattered->after.rms_mm, 0.001, 0.0002);
  int determined = 0;
  for (const fit::Row& r : scattered->rows) {
    if (r.end != fit::End::determined || r.key == "rotation") continue;
    ++determined;
    EXPECT_LT(std::abs(r.value - number_of(truth, *scattered, r.key)), 4 * r.deviation) << r.key;
  }
  EXPECT_GE(determined, 8);
}

TEST(Fit, TheWheelOfOneCutComesBack) {
  job::Job truth = job_of(sample("spiral_bevel.toml"));
  auto wheel = nasa_gear();
  wheel.root_angle_rad = wheel.cuts[0].root_angle_rad;
  truth.gear = wheel;
  job::Job start = truth;
  auto& other = std::get<spiral_bevel::SpiralBevelParameters>(start.gear).cuts[0];
  other.radial_distance_mm = 72.4;
  other.ratio_of_roll = 1.055;
  other.work_offset_mm = 0.3;
  other.blades[0].pressure_angle_rad = radians(22.4);
  const auto fitted = fit::fit_gear(start, points_of(truth, {0.02}), {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_LT(fitted->after.worst_mm, 1e-7);
  for (const char* key : {"cut[0].blade_pressure_angle[0]", "cut[0].blade_point_radius[1]", "cut[0].radial_distance",
                          "cut[0].ratio_of_roll", "cut[0].work_offset"})
    EXPECT_NEAR(row(*fitted, key).value, number_of(truth, *fitted, key), 1e-6) << key;
}

struct Changed {
  const char *from, *to;
};
std::string with(std::string text, const std::vector<Changed>& changes) {
  for (const auto& [from, to] : changes) text = replaced(std::move(text), from, to);
  return text;
}

/// A gear whose numbers come back from its own points, exact ones and scattered ones.
struct Returning {
  const char* name;
  const char* sample;
  std::vector<Changed> truth, start;  ///< changes of the sample, and of the truth
  std::vector<const char*> determined;
  std::vector<const char*> held = {};
  bool axial = false;
};
void PrintTo(const Returning& r, std::ostream* out) { *out << r.name; }

const Returning kReturning[] = {
    // Offset, 86 deg between its shafts, helical: no symmetry of its flanks is left.
    {"face",
     "offset_milled.toml",
     {{"shaft_angle = 90.0", "shaft_angle = 86.0"},
      {"helix_angle = 0.0", "helix_angle = 8.0"},
      {"shaper_teeth = 25", "shaper_teeth = 25\nbacklash = 0.1"}},
     {{"shaft_angle = 86.0", "shaft_angle = 86.02"},
      {"helix_angle = 8.0", "helix_angle = 8.03"},
      {"offset = 15.0", "offset = 14.97"},
      {"pressure_angle = 20.0", "pressure_angle = 20.05"},
      {"backlash = 0.1", "backlash = 0.14"}},
     {"backlash", "zone[0].helix_angle", "pressure_angle", "shaft_angle", "offset"},
     {},
     true},
    {"double_helical_face",
     "dhfg_ball.toml",
     {{"offset = 0.0", "offset = 0.0\nbacklash = 0.05"}},
     {{"reference_radius = 118.0", "reference_radius = 117.98"},
      {"offset = 0.0\nbacklash = 0.05", "offset = 0.03\nbacklash = 0.02"},
      {"helix_angle = -30.0", "helix_angle = -30.04"},
      {"helix_angle = 30.0", "helix_angle = 30.04"},
      {"pressure_angle = 20.0", "pressure_angle = 20.1"}},
     {"backlash", "zone[0].helix_angle", "pressure_angle", "reference_radius", "shaft_angle", "offset"}},
    {"herringbone_bevel",
     "bevel_wheel.toml",
     {{"backlash = 0.0", "backlash = 0.06"}},
     {{"backlash = 0.06", "backlash = 0.0"},
      {"pressure_angle = 20.0", "pressure_angle = 20.1"},
      {"outer_spiral_angle = 30.0", "outer_spiral_angle = 30.1"},
      {"apex_cone_distance = 104.0", "apex_cone_distance = 104.05"}},
     {"backlash", "pressure_angle", "outer_spiral_angle", "apex_cone_distance"}},
    {"single_bevel",
     "bevel_ball.toml",
     {},
     {{"backlash = 0.1", "backlash = 0.03"},
      {"pressure_angle = 20.0", "pressure_angle = 19.9"},
      {"outer_spiral_angle = 30.0", "outer_spiral_angle = 29.9"}},
     {"backlash", "pressure_angle", "outer_spiral_angle"}},
};

class FitReturns : public testing::TestWithParam<Returning> {};

TEST_P(FitReturns, FromItsOwnPoints) {
  const Returning& gear = GetParam();
  const std::string text = with(sample(gear.sample), gear.truth), start_text = with(text, gear.start);
  const job::Job truth = job_of(text), start = job_of(start_text);
  for (const bool normals : {true, false}) {
    const auto fitted =
        fit::fit_gear(start, points_of(truth, {0.3, gear.axial ? 0.4 : 0, 0, normals}), {{}, {}, true, gear.axial, 0});
    ASSERT_TRUE(fitted) << fitted.error().text();
    SCOPED_TRACE(told(*fitted));
    EXPECT_GT(fitted->before.worst_mm, 0.005);
    EXPECT_LT(fitted->after.worst_mm, 1e-8);
    EXPECT_EQ(fitted->placing.beside + fitted->placing.below_flanks, 0U);
    for (const char* key : gear.determined) {
      EXPECT_EQ(row(*fitted, key).end, fit::End::determined) << key;
      EXPECT_NEAR(row(*fitted, key).value, number_of(truth, *fitted, key), 1e-6) << key;
    }
    if (gear.axial) { EXPECT_NEAR(row(*fitted, "axial_position").value, 0.4, 1e-6); }
    const auto changed = fit::job_with_numbers(start, start_text, *fitted, start.file);
    ASSERT_TRUE(changed) << to_text(changed.error());
    EXPECT_NEAR(number_of(job_of(*changed), *fitted, "pressure_angle"), 20, 1e-6);
  }
}

TEST_P(FitReturns, WithinItsDeviationsFromPointsThatScatter) {
  const Returning& gear = GetParam();
  const job::Job truth = job_of(with(sample(gear.sample), gear.truth));
  Made made{-0.2, 0, 0.001};
  made.rows = 9;
  made.columns = 17;
  const auto fitted = fit::fit_gear(truth, points_of(truth, made), {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_NEAR(fitted->after.rms_mm, 0.001, 0.0001);
  for (const fit::Row& r : fitted->rows) {
    if (r.end != fit::End::determined || r.key == "rotation") continue;
    EXPECT_LT(std::abs(r.value - number_of(truth, *fitted, r.key)), 4 * r.deviation) << r.key;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FitReturns, testing::ValuesIn(kReturning),
                         [](const testing::TestParamInfo<Returning>& s) { return std::string(s.param.name); });

/// Flanks and fillets of the face gear of a job as the solid shaper leaves them: what it cuts away is no place of them.
struct Shaped {
  job::LoosePoints points{"points.csv", true, {}};
  std::size_t of_fillets = 0;
  int high = 0;  ///< of fillets, higher than where the flank should end
};
Shaped shaped_points(const job::Job& job) {
  constexpr int kStations = 9, kHeights = 8;
  const auto spaces = fit::spaces_of(job.gear, job);
  const auto& space = *spaces->front();
  const auto& surface = dynamic_cast<const face_gear::SpaceSheet&>(space).surface();
  Shaped out;
  const auto add = [&](tooth_space::Piece piece, double u, double r) -> std::optional<double> {
    const auto q = tooth_space::place_at(space, piece, u, r);
    if (!q || face_gear::swept_clearance(surface, q->p) < -1e-7) return {};
    out.points.points.push_back({q->p, q->n, {"points.csv", int(out.points.points.size()) + 2, 1}, 0});
    return q->p.z();
  };
  const auto& outline = space.outline();
  for (const int side : {1, -1})
    for (int k = 0; k < kStations; ++k) {
      const double r = outline.s_from + (outline.s_to - outline.s_from) * (k + 0.5) / kStations;
      const auto tip = space.tip_edge(side, r);
      const auto end = tooth_space::place_at(space, tooth_space::flank_of(side), surface.shaper.theta_t, r);
      for (int n = 1; tip && n < kHeights; ++n)
        add(tooth_space::flank_of(side), surface.shaper.theta_t + (tip->u - surface.shaper.theta_t) * n / kHeights, r);
      for (int n = 1; n < kHeights; ++n) {
        const auto z = add(tooth_space::fillet_of(side),
                           surface.shaper.A_t + (surface.shaper.A_e - surface.shaper.A_t) * n / kHeights, r);
        if (!z) continue;
        ++out.of_fillets;
        if (!end || *z > end->p.z()) ++out.high;
      }
    }
  return out;
}

TEST(Fit, PointsOfAnUndercutAreNoFlank) {
  const std::string text = with(sample("offset_milled.toml"), {{"inner_radius = 130.5", "inner_radius = 118.0"},
                                                               {"offset = 15.0", "offset = 15.0\nbacklash = 0.1"}});
  const job::Job truth = job_of(text),
                 start = job_of(with(text, {{"backlash = 0.1", "backlash = 0.13"},
                                            {"offset = 15.0", "offset = 14.98"},
                                            {"pressure_angle = 20.0", "pressure_angle = 20.03"}}));
  const Shaped shaped = shaped_points(truth);
  EXPECT_GT(shaped.high, 3);
  const auto fitted = fit::fit_gear(start, shaped.points, {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_GE(fitted->placing.below_flanks, shaped.of_fillets);
  EXPECT_GT(fitted->placing.points.size(), 60U);
  EXPECT_EQ(fitted->placing.beside, 0U);
  EXPECT_LT(fitted->after.worst_mm, 1e-8);
  for (const char* key : {"backlash", "pressure_angle", "offset", "shaft_angle"})
    EXPECT_NEAR(row(*fitted, key).value, number_of(truth, *fitted, key), 1e-6) << key;
}

TEST(Fit, PointsOfAnotherFaceOrBevelGearAreRefused) {
  const job::Job face = job_of(sample("offset_milled.toml")), bevel = job_of(sample("bevel_ball.toml"));
  const auto refused = [&](const job::Job& job, const job::LoosePoints& p) {
    const auto fitted = fit::fit_gear(job, p, {});
    return fitted ? std::string("none") : fitted.error().text();
  };
  for (const auto& [job, other] : {std::pair(&face, &bevel), {&bevel, &face}}) {
    EXPECT_NE(refused(*job, points_of(*other)).find("points.csv:1:1: error: no point lies beside a flank"),
              std::string::npos);
    job::LoosePoints few = points_of(*job);
    few.points.resize(4);
    EXPECT_NE(refused(*job, few).find("4 points lie on flanks, "), std::string::npos) << refused(*job, few);
    // Two parts of three beyond the large end: a flank that is not there.
    job::LoosePoints beyond = points_of(*job);
    for (std::size_t i = 0; i < beyond.points.size(); ++i)
      if (i % 3 != 0) beyond.points[i].p *= 1.6;
    EXPECT_NE(refused(*job, beyond).find("of 90 points lie where the gear of "), std::string::npos)
        << refused(*job, beyond);
  }
}

TEST(Fit, WhatIsNoneIsRefused) {
  const job::Job spur = job_of(sample("cylindrical_spur.toml")), grid = job_of(sample("flank_grid_spur.toml"));
  const auto points = points_of(spur);
  const auto refused = [&](const job::Job& job, const job::LoosePoints& p, const fit::Asked& asked) {
    const auto fitted = fit::fit_gear(job, p, asked);
    return fitted ? std::string("none") : fitted.error().text();
  };
  EXPECT_NE(refused(grid, points, {}).find("type = \"flank_grid\" is not fitted"), std::string::npos);
  EXPECT_NE(refused(spur, points, {{"teeth"}, {}, true, false, 0}).find("--free teeth: no number of this"),
            std::string::npos);
  EXPECT_NE(refused(spur, points, {{}, {{"profile_shift", 0.3, 0.5}}, true, false, 0}).find("the start, 0.2, must lie"),
            std::string::npos);
  job::LoosePoints few = points;
  few.points.resize(3);
  EXPECT_NE(refused(spur, few, {}).find("3 points lie on flanks"), std::string::npos);
  job::LoosePoints far = points;
  for (auto& point : far.points) point.p *= 25.4;
  EXPECT_NE(refused(spur, far, {}).find("points.csv:1:1: error: no point lies beside a flank"), std::string::npos);
}

TEST(Fit, ABoundThatStopsTheFitIsNamed) {
  const job::Job truth = job_of(helical()), start = job_of(replaced(helical(), "shift = 0.2", "shift = 0.1"));
  const auto fitted =
      fit::fit_gear(start, points_of(truth), {{"profile_shift"}, {{"profile_shift", 0, 0.15}}, true, false, 0});
  ASSERT_TRUE(fitted) << fitted.error().text();
  EXPECT_EQ(row(*fitted, "profile_shift").end, fit::End::at_bound) << told(*fitted);
  EXPECT_EQ(row(*fitted, "profile_shift").value, 0.15);
}

/// A face gear without backlash, which begins and ends at the least there is.
TEST(Fit, ANumberAtItsBoundHoldsNoOtherBack) {
  const std::string text = sample("offset_milled.toml");
  const job::Job truth = job_of(text),
                 start = job_of(with(
                     text, {{"offset = 15.0", "offset = 14.97"}, {"pressure_angle = 20.0", "pressure_angle = 20.05"}}));
  const auto fitted = fit::fit_gear(start, points_of(truth), {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  SCOPED_TRACE(told(*fitted));
  EXPECT_LT(fitted->after.worst_mm, 1e-8);
  EXPECT_NEAR(row(*fitted, "offset").value, 15, 1e-5);
}

/// Lines `x y z i j k`.
std::string listed(const job::LoosePoints& points) {
  std::string text;
  for (const auto& at : points.points)
    text += fmt::format("{} {} {} {} {} {}\n", at.p.x(), at.p.y(), at.p.z(), at.n->x(), at.n->y(), at.n->z());
  return text;
}

TEST(FitCommand, WritesTheJobAndWhatRemains) {
  const TestDir dir;
  const job::Job truth = job_of(helical());
  // One point stands up by 30 um: the fit must find it.
  auto points = points_of(truth, {0.2, 0, 0, true, 9, 17});
  points.points[40].p += 0.03 * *points.points[40].n;
  write_file(dir / "points.txt", listed(points));
  write_file(dir / "job.toml", replaced(helical(), "shift = 0.2", "shift = 0.1"));
  const std::vector<std::string> words{
      "fit",   dir / "job.toml", "--points", dir / "points.txt", "--free", "profile_shift,pressure_angle",
      "--out", dir / "out",      "--write",  dir / "new.toml",   "--json"};
  const Finished done = run_program(words);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out)["report"];
  EXPECT_EQ(json["numbers"].size(), 3U);
  EXPECT_NEAR(json["numbers"][1]["value"].get<double>(), 0.2, 1e-3);
  EXPECT_EQ(json["after"]["worst_line"], 41);
  EXPECT_NEAR(json["after"]["worst_um"].get<double>(), 30, 1);
  const std::string written = file_text(dir / "new.toml");
  EXPECT_NE(written.find("# of the rack"), std::string::npos);
  EXPECT_EQ(written, json["text"].get<std::string>());
  EXPECT_NE(file_text(dir / "out/fit.html").find("<svg"), std::string::npos);
  EXPECT_EQ(times_in(file_text(dir / "out/fit.csv"), "\n"), points.points.size() + 1);
  // What is there is not replaced.
  const Finished again = run_program(words);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("new.toml exists already"), std::string::npos) << again.err;
}

}  // namespace
}  // namespace toothpath::test
