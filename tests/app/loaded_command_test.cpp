// `contact` under load, run as a user would.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/contact_run.h"

namespace toothpath::test {
namespace {

/// A torque loads the elastic pair: numbers, files, charts; keys of [contact.load] and options above them.
TEST(LoadedCommand, UnderLoad) {
  const TestDir dir;
  const std::string out = dir / "out";
  const Json report =
      contact_of({"contact", kSamples + "/dhfg_paper.toml", "--torque", "532", "--positions", "4", "--out", out});
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"contact.csv", "contact.html", "contact.json", "ease_off.csv",
                                                     "loaded.csv", "pressure.csv", "transmission.csv"}));
  const Json& loaded = report.at("loaded");
  EXPECT_EQ(loaded.at("pinion_axial"), "floating");
  ASSERT_EQ(loaded.at("flanks").size(), 2u);
  for (const Json& flank : loaded.at("flanks")) {
    // Axial forces are equal; edges of teeth whose line has left the flank have another lever for the same axial force.
    EXPECT_NEAR(flank.at("outer_share").at("mean").get<double>(), 0.5, 1e-5);
    EXPECT_NEAR(flank.at("axial_N").at("most").get<double>(), 0, 1e-6);
    EXPECT_GT(flank.at("stiffness_N_um").at("least").get<double>(), 300);
    EXPECT_GT(flank.at("transmission_error_urad").at("range").get<double>(), 0.01);
    EXPECT_GT(flank.at("pressure_MPa").at("most").get<double>(), 50);
  }
  const std::string page = file_text(out + "/contact.html");
  for (const char* words : {"Under load", "Loaded transmission error", "Mesh stiffness", "Pressure along the lines"})
    EXPECT_NE(page.find(words), std::string::npos) << words;

  const std::string job =
      changed_sample(dir, "dhfg_paper.toml", "[machine]",
                     "[contact.load]\ntorque = 100\ntorque_on = \"pinion\"\npositions = 1\npinion_axial = "
                     "\"held\"\nrow_teeth = 3\n\n[machine]");
  const Json held = contact_of({"contact", job, "--out", dir / "b"}).at("loaded");
  EXPECT_EQ(held.at("pinion_axial"), "held");
  EXPECT_NEAR(held.at("torque_gear_Nm").get<double>(), 600, 1e-9);
  EXPECT_GT(std::abs(held.at("flanks")[0].at("axial_N").at("most").get<double>()), 0.1);
}

/// Friction and root stress stand beside the rest where the job asks for them, and nowhere else.
TEST(LoadedCommand, FrictionAndRootStressOnRequest) {
  const TestDir dir;
  const std::string asked = changed_sample(
      dir, "spur_quick.toml", "[machine]",
      "[contact]\npinion_teeth = 20\n\n[contact.load]\ntorque = 50\npositions = 2\nrow_teeth = 3\nfriction = 0.1\n"
      "root_stress = true\n\n[machine]");
  const auto run = run_program({"contact", asked, "--out", dir / "a"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* words : {"friction 0.1 could add +-", "root stress of the gear", "root stress of the pinion"})
    EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
  const Json report = Json::parse(file_text(dir / "a/contact.json"));
  for (const Json& flank : report.at("loaded").at("flanks")) {
    const Json& friction = flank.at("friction");
    EXPECT_EQ(friction.at("coefficient"), 0.1);
    EXPECT_GE(friction.at("axial_bound_N").get<double>(), friction.at("axial_N").get<double>());
    EXPECT_LE(friction.at("axial_bound_N").get<double>(), 0.1 * flank.at("normal_N").get<double>());
    for (const char* body : {"gear", "pinion"}) {
      const Json& root = flank.at("root_stress").at(body);
      EXPECT_GT(root.at("stress_MPa").get<double>(), 20) << body;
      EXPECT_LT(root.at("error_MPa").get<double>(), 0.1 * root.at("stress_MPa").get<double>()) << body;
    }
    const double radius = flank.at("root_stress").at("gear").at("radius_mm").get<double>();
    EXPECT_TRUE(radius > 60 - 1e-6 && radius < 65 + 1e-6) << radius;
  }
  EXPECT_NE(file_text(dir / "a/loaded.csv").find("friction_axial_N,friction_torque_percent"), std::string::npos);
  EXPECT_NE(file_text(dir / "a/root_stress.csv").find("exact,1,pinion,0,"), std::string::npos);
  for (const char* words : {"What friction of 0.1 could add", "Stress at the root"})
    EXPECT_NE(file_text(dir / "a/contact.html").find(words), std::string::npos) << words;
}

/// A pinion of fewer teeth than the shaper touches in slender ellipses; decks of CalculiX beside the results.
TEST(LoadedCommand, UnderLoadInPointsAndAsDecks) {
  const TestDir dir;
  const Json points = contact_of({"contact", kSamples + "/offset_shaped.toml", "--pinion-teeth", "23", "--torque", "50",
                                  "--positions", "2", "--out", dir / "a"})
                          .at("loaded");
  EXPECT_EQ(points.at("pinion_axial"), "held");
  for (const Json& flank : points.at("flanks")) {
    EXPECT_GT(flank.at("pressure_MPa").at("most").get<double>(), 50);
    EXPECT_GE(flank.at("pairs").at("least").get<double>(), 1);
  }
  const auto decks = run_program({"contact", kSamples + "/offset_shaped.toml", "--pinion-teeth", "25", "--torque", "50",
                                  "--positions", "1", "--ccx", dir / "decks", "--out", dir / "b"});
  ASSERT_EQ(decks.exit_code, 0) << decks.err;
  EXPECT_EQ(names_in(dir / "decks"), (std::vector<std::string>{"ring_0_flank_minus.inp", "ring_0_flank_plus.inp"}));
  EXPECT_NE(file_text(dir / "decks/ring_0_flank_plus.inp").find("*CONTACT PAIR"), std::string::npos);
}

/// A herringbone bevel pair: both walls, axial forces of both gears, edges with and without a radius, a floating
/// pinion.
TEST(LoadedCommand, BevelPairUnderLoad) {
  const TestDir dir;
  const std::string wheel = kSamples + "/bevel_wheel.toml", out = dir / "out";
  const auto job = [&](const std::string& load) {
    return changed_sample(
        dir, "bevel_pinion.toml", "[machine]",
        "[contact]\noffset_error = 0.01\n[contact.load]\ntorque = 200\npositions = 1\nrow_teeth = 3\n" + load +
            "\n\n[machine]");
  };
  const auto run =
      run_program({"contact", job("edge_radius = 0.3"), "--mate", wheel, "--ccx", dir / "decks", "--out", out});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"contact.csv", "contact.html", "contact.json", "ease_off.csv",
                                                     "loaded.csv", "pressure.csv", "transmission.csv"}));
  EXPECT_EQ(names_in(dir / "decks"), (std::vector<std::string>{"half_0_wall_L.inp", "half_0_wall_U.inp",
                                                               "half_1_wall_L.inp", "half_1_wall_U.inp"}));
  EXPECT_NE(file_text(dir / "decks/half_1_wall_U.inp").find("*CONTACT PAIR"), std::string::npos);
  EXPECT_NE(run.out.find("under 200 N m on the wheel, pinion held"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("edges rounded by 0.3 mm"), std::string::npos) << run.out;
  const Json report = Json::parse(file_text(out + "/contact.json"));
  EXPECT_NEAR(report.at("assembly").at("offset_mm").get<double>(), 0.01, 1e-12) << "the key of [contact]";
  const Json& loaded = report.at("loaded");
  ASSERT_EQ(loaded.at("flanks").size(), 2u);
  EXPECT_EQ(loaded.at("flanks")[0].at("name"), "wall L");
  for (const Json& flank : loaded.at("flanks")) {
    EXPECT_EQ(flank.at("model"), "cells");
    EXPECT_NEAR(flank.at("gear_torque_Nm").at("mean").get<double>(), 200, 1e-7);
    EXPECT_NEAR(flank.at("pinion_torque_Nm").at("mean").get<double>(), 200 * 18.0 / 37, 5);
    EXPECT_GT(flank.at("stiffness_N_um").at("least").get<double>(), 20);
    EXPECT_GT(flank.at("gear_axial_N").at("mean").get<double>(), 100) << "away from the apex";
    const double line_load = flank.at("end_line_load_N_mm").at("most").get<double>(),
                 pressure = flank.at("edge_pressure_MPa").at("most").get<double>();
    EXPECT_EQ(line_load > 0, pressure > 0);
  }
  for (const char* words : {"Under load", "Loaded transmission error", "Share of the outer half", "wheel lags"})
    EXPECT_NE(file_text(out + "/contact.html").find(words), std::string::npos) << words;
  const auto floating =
      run_program({"contact", job("pinion_axial = \"floating\""), "--mate", wheel, "--out", dir / "floating"});
  ASSERT_EQ(floating.exit_code, 0) << floating.err;
  EXPECT_NE(floating.out.find("edge contact: pressure undefined without edge_radius"), std::string::npos)
      << floating.out;
  const Json balanced = Json::parse(file_text(dir / "floating/contact.json")).at("loaded");
  for (const Json& flank : balanced.at("flanks")) EXPECT_NEAR(flank.at("axial_N").at("most").get<double>(), 0, 1e-2);
}

/// What loaded contact does not compute is refused where it was asked for.
TEST(LoadedCommand, RefusesLoadsThatItDoesNotCompute) {
  const TestDir dir;
  const auto refused = [&](const std::string& job, const std::string& words, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"contact", job, "--torque", "100", "--out", dir / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 3) << words;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  const std::vector<std::string> mated = {"--mate", kSamples + "/bevel_wheel.toml"};
  const auto bevel = [&](const std::string& load) {
    return changed_sample(dir, "bevel_pinion.toml", "[machine]",
                          "[contact.load]\ntorque = 1\n" + load + "\n\n[machine]");
  };
  refused(bevel("friction = 1.5"), "friction = 1.5", mated);
  refused(bevel("rim = 150"), "rim = 150 mm is not between half the module", mated);
  refused(kSamples + "/offset_shaped.toml", "--ccx is for a pinion of as many teeth as the shaper",
          {"--pinion-teeth", "23", "--positions", "1", "--ccx", dir / "decks"});
  const std::string floating = changed_sample(dir, "offset_shaped.toml", "[machine]",
                                              "[contact.load]\ntorque = 1\npinion_axial = \"floating\"\n\n[machine]");
  refused(floating, "needs two rings of opposite hand", {});
  const std::string rim =
      changed_sample(dir, "spur_quick.toml", "[machine]", "[contact.load]\ntorque = 1\nrim = 0.1\n\n[machine]");
  refused(rim, "rim = 0.1 mm is not between", {});
}

}  // namespace
}  // namespace toothpath::test
