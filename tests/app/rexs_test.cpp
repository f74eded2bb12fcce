// REXS files become the parameters of a job, and the job reads them as they were; all that a file lacks or has in
// another unit is refused at its place, and what REXS leaves open is asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/rexs/gears.h"
#include "geometry/base/angle.h"
#include "tests/app/proposed_job.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

const std::filesystem::path kRexsSource = TOOTHPATH_SOURCE_DIR;
std::string text_of(const char* name) { return file_text(kRexsSource / "tests/rexs" / name); }

using Made = Expected<rexs::GearOfFile, rexs::Obstacles>;
Made made(const std::string& text, int component, const rexs::Said& said = {}) {
  const auto file = rexs::parse_rexs(text, "g.rexs");
  if (!file) return rexs::Obstacles{{file.error()}, {}};
  return rexs::gear_of(*file, *file->find(component), said);
}
std::string errors_of(Made result) {
  if (result) return "none";
  return to_text(result.error().errors);
}

/// What the job's reader makes of the gear.
ProposedJob read_again(const rexs::GearOfFile& gear) {
  proposal::Wishes wishes;
  if (const auto* spiral = std::get_if<spiral_bevel::SpiralBevelParameters>(&gear.gear)) {
    wishes.gear = proposal::Gear::spiral_bevel;
    wishes.spiral = std::make_shared<const spiral_bevel::SpiralBevelParameters>(*spiral);
  } else {
    wishes.gear = proposal::Gear::cylindrical;
    wishes.cylinder = std::make_shared<const cylindrical::CylindricalParameters>(
        std::get<cylindrical::CylindricalParameters>(gear.gear));
  }
  return proposed_job(wishes, "g.toml");
}

TEST(Rexs, TheNasaPairIsThatOfItsReport) {
  const std::string text = text_of("bevel_pair.rexs");
  auto pinion = made(text, 2, {true, {}, {}, {}});
  ASSERT_TRUE(pinion) << errors_of(pinion);
  const auto [draft, job] = read_again(*pinion);
  EXPECT_FALSE(draft.up);
  const auto& p = std::get<spiral_bevel::SpiralBevelParameters>(job.gear);
  EXPECT_EQ(p.teeth, 12);
  EXPECT_EQ(p.hand, -1);
  EXPECT_NEAR(degrees(p.pitch_angle_rad), 18.4333333, 1e-10);
  EXPECT_NEAR(p.outer_cone_distance_mm, 93.7514, 1e-10);
  EXPECT_NEAR(*p.mean_space_width_mm, 6.1, 1e-8);
  ASSERT_EQ(p.cuts.size(), 2u);
  EXPECT_EQ(p.cuts[0].flank, spiral_bevel::Cuts::concave);
  EXPECT_NEAR(p.cuts[0].blades[0].point_radius_mm, 75.326783003, 1e-10);
  EXPECT_NEAR(degrees(p.cuts[0].cradle_angle_rad), 63.942030463, 1e-9);
  EXPECT_NEAR(p.cuts[0].ratio_of_roll, 3.242698536, 1e-11);
  EXPECT_NEAR(p.cuts[1].machine_center_mm, 1.375229989, 1e-11);
  EXPECT_NEAR(p.cuts[1].work_offset_mm, -4.426244511, 1e-11);
  EXPECT_TRUE(p.cuts[1].modified.empty());
  auto wheel = made(text, 9);
  ASSERT_TRUE(wheel) << errors_of(wheel);
  const auto& w = std::get<spiral_bevel::SpiralBevelParameters>(wheel->gear);
  EXPECT_NEAR(w.outer_cone_distance_mm, 93.7514, 1e-10);
  ASSERT_EQ(w.cuts.size(), 1u);
  EXPECT_EQ(w.cuts[0].flank, spiral_bevel::Cuts::both);
  EXPECT_NEAR(w.cuts[0].blades[0].point_radius_mm, 77.0255, 1e-12);
  EXPECT_NEAR(w.cuts[0].blades[1].point_radius_mm, 75.3745, 1e-12);
  EXPECT_NEAR(w.cuts[0].blades[1].edge_radius_mm, 0.7, 1e-12);
}

TEST(Rexs, CylindersByTheirToolWithWhatIsLeftOut) {
  const std::string text = text_of("cylinders.rexs");
  auto spur = made(text, 1);
  ASSERT_TRUE(spur) << errors_of(spur);
  const auto [draft, job] = read_again(*spur);
  EXPECT_TRUE(draft.up);
  const auto& p = std::get<cylindrical::CylindricalParameters>(job.gear);
  EXPECT_EQ(p.teeth, 24);
  EXPECT_NEAR(p.profile_shift, 0.2, 1e-12);
  EXPECT_NEAR(p.dedendum_coefficient, 1.25, 1e-12);
  EXPECT_NEAR(*p.tip_diameter_mm, 79.2, 1e-12);
  EXPECT_EQ(p.bore_diameter_mm, 25);
  EXPECT_TRUE(spur->left_out.empty());
  auto helical = made(text, 5);
  ASSERT_TRUE(helical) << errors_of(helical);
  const job::Job other = read_again(*helical).job;
  const auto& h = std::get<cylindrical::CylindricalParameters>(other.gear);
  EXPECT_NEAR(h.module_mm, 5, 1e-10);
  EXPECT_NEAR(degrees(h.zones.front().helix_angle_rad), -30, 1e-10);
  EXPECT_NEAR(h.profile_shift, 0.1, 1e-10);
  // Cut with x_E = 0.09: the root lies 0.01 modules deeper, the teeth are thinner by 2 * 0.01 m tan(20 deg).
  EXPECT_NEAR(h.dedendum_coefficient, 1.26, 1e-9);
  EXPECT_NEAR(h.thickness_allowance_mm, -0.1 * std::tan(radians(20)), 1e-9);
  EXPECT_NEAR(h.root_radius_coefficient, 0.38, 1e-10);
  EXPECT_EQ(helical->left_out, std::vector<std::string>{"helix_crowning 10 (Crowning)"});
}

TEST(Rexs, TheSenseOfTheRatioIsCheckedOrAsked) {
  const std::string text = text_of("bevel_pair.rexs");
  // Cradle per work, as other programs print it: told by R sin(delta) = 1.
  auto other = made(replaced(text, "1.051674445", "0.950864599548"), 9);
  ASSERT_TRUE(other) << errors_of(other);
  EXPECT_NEAR(std::get<spiral_bevel::SpiralBevelParameters>(other->gear).cuts[0].ratio_of_roll, 1.051674445, 1e-8);
  for (const char* ratio : {"1.6", "1.0"}) {
    const std::string open = replaced(replaced(text, "1.051674445", ratio), "71.5666666", "80");
    const auto asked = made(open, 9);
    ASSERT_FALSE(asked) << ratio;
    ASSERT_EQ(asked.error().questions.size(), 1u);
    EXPECT_EQ(asked.error().questions[0].first, rexs::Open::ratio_of_roll);
    auto said = made(open, 9, {{}, false, {}, {}});
    ASSERT_TRUE(said) << errors_of(said);
    EXPECT_NEAR(std::get<spiral_bevel::SpiralBevelParameters>(said->gear).cuts[0].ratio_of_roll, 1 / std::stod(ratio),
                1e-12);
  }
  const auto flanks = made(text, 2);
  ASSERT_FALSE(flanks);
  ASSERT_EQ(flanks.error().questions.size(), 1u);
  EXPECT_EQ(flanks.error().questions[0].first, rexs::Open::left_flank);
  auto right = made(text, 2, {false, {}, {}, {}});
  ASSERT_TRUE(right) << errors_of(right);
  EXPECT_NEAR(std::get<spiral_bevel::SpiralBevelParameters>(right->gear).cuts[0].blades[0].point_radius_mm,
              78.011176388, 1e-10);
}

TEST(Rexs, RefusalsNameLineColumnAndWhatIsNeeded) {
  struct Case {
    const char *file, *what, *by;
    int component;
    const char* error;
  };
  constexpr const char *kPair = "bevel_pair.rexs", *kCylinders = "cylinders.rexs";
  const Case cases[] = {
      {kPair, "version=\"1.7\"", "version=\"1.3\"", 9, "g.rexs:3:1: error: REXS version \"1.3\": 1.4 to 1.7 are read"},
      {kPair, "</components>", "</component>", 9, "error: no XML: "},
      {kPair, "<model ", "<modell ", 9, "error: no XML: "},
      {kPair, "<component id=\"14\"", "<component id=\"13\"", 9, "component 13 stands in line "},
      {kPair, "<component id=\"14\"", "<component id=\"x\"", 9, "id = \"x\" of <component> is no whole number"},
      {kPair, "<ref id=\"14\"", "<ref id=\"99\"", 9, "there is no component 99 in this file"},
      {kPair, "unit=\"mm\">72.642731192", "unit=\"inch\">2.8599", 9,
       "radial_distance of bevel_gear_manufacturing_settings 12 (Gear) is in \"inch\"; its unit in REXS is mm"},
      {kPair, "unit=\"deg\">59.2342023", "unit=\"rad\">1.03", 9, "is in \"rad\"; its unit in REXS is deg"},
      {kPair, ">59.2342023<", ">59,23<", 9, "is \"59,23\", no finite number"},
      {kPair, ">59.2342023<", "><", 9, "is \"\", no finite number"},
      {kPair, "id=\"work_offset\" unit=\"mm\">0<", "id=\"vertical_offset\" unit=\"mm\">0<", 9,
       "bevel_gear_manufacturing_settings 12 (Gear) lacks work_offset"},
      {kPair, "<attribute id=\"face_angle\" unit=\"\xC2\xB0\">73.1333332</attribute>", "", 9,
       "bevel_gear 9 (Gear) lacks face_angle"},
      {kPair, ">right<", ">none<", 9, "spiral_angle_pitch_direction = \"none\" of bevel_gear 9 (Gear) is neither"},
      {kPair, "id=\"tool_edge_radius\" unit=\"mm\">0.7", "id=\"other\" unit=\"mm\">0.7", 9,
       "lacks tool_edge_radius_bevel_gear_tool"},
      {kPair,
       "<c>0</c>\n          <c>0</c>\n        </array>\n      </attribute>\n    </component>\n    <component id=\"13\"",
       "<c>0</c><c>a</c></array></attribute></component><component id=\"13\"", 9, "is \"a\", no finite number"},
      {kPair,
       "<attribute id=\"cutter_tilt\" unit=\"deg\">0</attribute>\n      <attribute id=\"cutter_swivel\" unit=\"deg\">0",
       "<attribute id=\"helical_motion_coefficients\" unit=\"mm\"><array><c>0.1</c></array></attribute><attribute "
       "id=\"cutter_swivel\" unit=\"deg\">0",
       2, "helical_motion_coefficients = 0.1 of bevel_gear_manufacturing_settings 5 (Pinion concave) must be 0"},
      {kPair, "id=\"side_rake_angle\" unit=\"deg\">0", "id=\"side_rake_angle\" unit=\"deg\">4", 2,
       "side_rake_angle = 4 of bevel_gear_tool 7 (Pinion outside) must be 0"},
      {kPair, "77.0255", "75.3745", 9, "the outside one must be larger"},
      {kPair, "<ref id=\"13\" role=\"tool\"", "<ref id=\"13\" role=\"toll\"", 9,
       "bevel_gear_flank 10 (Gear left) has no bevel_gear_tool"},
      {kPair, "<ref id=\"9\" role=\"gear\"", "<ref id=\"9\" role=\"geer\"", 9, "bevel_gear 9 (Gear) has no flanks"},
      {kPair, "<c>0</c>", "<c>1001</c>", 2,
       "modified_roll_coefficients = 1001 of bevel_gear_manufacturing_settings 5 (Pinion concave) is outside -1000 to"},
      {kCylinders, ">65.7<", ">65.8<", 1,
       "root_diameter = 65.8 mm of cylindrical_gear 1 (Spur) is not what its tool makes, "
       "65.7 mm"},
      {kCylinders, ">79.2<", ">1<", 1, "tip_diameter = 1 mm of cylindrical_gear 1 (Spur) is below its teeth"},
      {kCylinders, "<ref id=\"4\" role=\"tool\"", "<ref id=\"4\" role=\"other\"", 1, "one tool must make both flanks"},
      {kCylinders, "id=\"tip_radius_factor\"", "id=\"tip_radius_fact\"", 1,
       "rack_shaped_tool 4 (Hob) lacks tip_radius_factor"},
      {kCylinders, "unit=\"\">0.2<", "unit=\"\">0.3<", 1, "both flanks must be alike"},
      {kCylinders, "unit=\"mm\">0<", "unit=\"mm\">0.1<", 1,
       "protuberance_amount = 0.1 of rack_shaped_tool 4 (Hob) must be 0"},
      {kCylinders, ">24<", ">24.5<", 1, "number_of_teeth = 24.5 of cylindrical_gear 1 (Spur) is no whole number"},
      {kCylinders, ">24<", ">-24<", 1, "number_of_teeth = -24 of cylindrical_gear 1 (Spur) is outside 3 to 5000"},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.by);
    const std::string errors = errors_of(made(replaced(text_of(one.file), one.what, one.by), one.component));
    EXPECT_NE(errors.find(one.error), std::string::npos) << errors;
    EXPECT_TRUE(errors.starts_with("g.rexs:")) << errors;
    EXPECT_FALSE(errors.starts_with("g.rexs:0")) << errors;
  }
  const std::string cylinders = text_of("cylinders.rexs"),
                    tool = replaced_all(cylinders, "<ref id=\"4\" role=\"tool\"", "<ref id=\"4\" role=\"other\"");
  EXPECT_EQ(errors_of(made(tool, 1, {{}, {}, 1.25, 0.38})), "none");
  EXPECT_NE(errors_of(made(tool, 1)).find("say --dedendum-coefficient and"), std::string::npos);
  EXPECT_NE(errors_of(made(cylinders, 1, {{}, {}, 1.25, 0.38})).find("are for gears without a tool"),
            std::string::npos);
  EXPECT_NE(errors_of(made(cylinders, 1, {true, {}, {}, {}})).find("are for bevel gears"), std::string::npos);
  EXPECT_NE(errors_of(made(text_of("bevel_pair.rexs"), 9, {{}, {}, 1.25, {}})).find("are for cylindrical gears"),
            std::string::npos);
  EXPECT_NE(errors_of(made("PK\x03\x04", 1)).find("zipped"), std::string::npos);
  EXPECT_NE(errors_of(made(" {\"model\": 1}", 1)).find("JSON"), std::string::npos);
  EXPECT_NE(errors_of(made("", 1)).find("no XML"), std::string::npos);
}

/// Written and read again.
template <typename Gear>
Gear there_and_back(const Gear& gear, const rexs::Said& said = {}) {
  auto written = rexs::rexs_of(gear, "a <gear> & its \"mate\"");
  if (!written) ADD_FAILURE() << written.error().diagnostic.message;
  if (!written) return {};
  rexs::add_flank_grid(written->file,
                       {{0, 1, 0, 0, 0, 0, {1.5, 2, 3}, {1, 0, 0}}, {0, -1, 0, 0, 0, 0, {1.5, -2, 3}, {1, 0, 0}}});
  const std::string text = rexs::rexs_text(written->file);
  const auto file = rexs::parse_rexs(text, "g.rexs");
  if (!file) ADD_FAILURE() << file.error().text() << text;
  if (!file) return {};
  EXPECT_EQ(rexs::rexs_text(*file), text);
  const auto gears = rexs::gears_of(*file);
  EXPECT_EQ(gears.size(), 1u);
  EXPECT_EQ(gears[0]->name, "a <gear> & its \"mate\"");
  auto read = rexs::gear_of(*file, *gears[0], said);
  EXPECT_TRUE(read) << errors_of(read);
  return read ? std::get<Gear>(read->gear) : Gear{};
}

void near(double a, double b) { EXPECT_NEAR(a, b, 1e-13 * std::max(1.0, std::abs(b))); }

TEST(Rexs, ASpiralBevelGearIsReadBackAsItWasWritten) {
  const std::string text = text_of("bevel_pair.rexs");
  for (const int component : {2, 9}) {
    const rexs::Said said{component == 2 ? std::optional(true) : std::nullopt, {}, {}, {}};
    auto p = std::get<spiral_bevel::SpiralBevelParameters>(made(text, component, said)->gear);
    p.shaft_angle_rad = radians(85);
    p.tip_apex_mm = 0.3;
    p.cuts.back().modified = {0.01, -0.2};
    p.cuts.front().tilt_rad = radians(2);
    p.cuts.front().swivel_rad = radians(-30);
    const auto q = there_and_back(p, said);
    EXPECT_EQ(q.teeth, p.teeth);
    EXPECT_EQ(q.hand, p.hand);
    EXPECT_EQ(q.mean_space_width_mm.has_value(), p.mean_space_width_mm.has_value());
    near(q.shaft_angle_rad, p.shaft_angle_rad);
    near(q.pitch_angle_rad, p.pitch_angle_rad);
    near(q.outer_cone_distance_mm, p.outer_cone_distance_mm);
    near(q.face_width_mm, p.face_width_mm);
    near(q.tip_angle_rad, p.tip_angle_rad);
    near(q.tip_apex_mm, p.tip_apex_mm);
    near(q.root_angle_rad.value_or(0), p.root_angle_rad.value_or(0));
    near(q.mean_space_width_mm.value_or(0), p.mean_space_width_mm.value_or(0));
    ASSERT_EQ(q.cuts.size(), p.cuts.size());
    for (std::size_t c = 0; c < p.cuts.size(); ++c) {
      const auto &a = q.cuts[c], &b = p.cuts[c];
      EXPECT_EQ(a.flank, b.flank);
      EXPECT_EQ(a.generated, b.generated);
      EXPECT_EQ(a.modified, b.modified);
      for (std::size_t k = 0; k < 2; ++k) {
        near(a.blades[k].point_radius_mm, b.blades[k].point_radius_mm);
        near(a.blades[k].pressure_angle_rad, b.blades[k].pressure_angle_rad);
        near(a.blades[k].edge_radius_mm, b.blades[k].edge_radius_mm);
      }
      near(a.radial_distance_mm, b.radial_distance_mm);
      near(a.cradle_angle_rad, b.cradle_angle_rad);
      near(a.root_angle_rad, b.root_angle_rad);
      near(a.work_offset_mm, b.work_offset_mm);
      near(a.sliding_base_mm, b.sliding_base_mm);
      near(a.machine_center_mm, b.machine_center_mm);
      near(a.ratio_of_roll, b.ratio_of_roll);
      near(a.tilt_rad, b.tilt_rad);
      near(a.swivel_rad, b.swivel_rad);
    }
  }
}

TEST(Rexs, ACylindricalGearIsReadBackAsItWasWritten) {
  cylindrical::CylindricalParameters p;
  p.teeth = 31;
  p.module_mm = 3;
  p.pressure_angle_rad = radians(21);
  p.profile_shift = 0.17;
  p.dedendum_coefficient = 1.31;
  p.root_radius_coefficient = 0.33;
  p.tip_diameter_mm = 107.5;
  p.thickness_allowance_mm = -0.08;
  p.bore_diameter_mm = 30;
  p.zones = {{radians(-18), -11, 11}};
  for (const ModulePlane plane : {ModulePlane::normal, ModulePlane::transverse}) {
    p.module_plane = plane;
    const auto q = there_and_back(p);
    // The rack of a transverse reading, in its normal plane.
    const double k = plane == ModulePlane::normal ? 1 : std::cos(radians(18));
    EXPECT_EQ(q.teeth, p.teeth);
    near(q.module_mm, p.module_mm * k);
    near(std::tan(q.pressure_angle_rad), std::tan(p.pressure_angle_rad) * k);
    near(q.profile_shift, p.profile_shift / k);
    near(q.dedendum_coefficient, p.dedendum_coefficient / k);
    near(q.root_radius_coefficient, p.root_radius_coefficient / k);
    near(*q.tip_diameter_mm, *p.tip_diameter_mm);
    near(q.thickness_allowance_mm, p.thickness_allowance_mm);
    near(q.bore_diameter_mm, p.bore_diameter_mm);
    ASSERT_EQ(q.zones.size(), 1u);
    near(q.zones[0].helix_angle_rad, p.zones[0].helix_angle_rad);
    near(q.zones[0].from_mm, -11);
    near(q.zones[0].to_mm, 11);
  }
  p.zones.push_back({radians(18), 12, 20});
  const auto two = rexs::rexs_of(p, "two");
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().key, "zone");
}

}  // namespace
}  // namespace toothpath::test
