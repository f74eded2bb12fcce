// The body of a face gear by [stock]: thickness, bore and hub are what the mesh has, and what cannot be is refused with
// its limit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "geometry/base/angle.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

struct Seen {
  double volume = 0, lowest = INFINITY, narrowest = INFINITY;
};

/// Of a binary STL.
Seen seen_in(const std::string& stl) {
  Seen seen;
  for (std::size_t at = 84; at + 50 <= stl.size(); at += 50) {
    float v[12];
    std::memcpy(v, stl.data() + at, sizeof v);
    const auto corner = [&](int k) { return Vec3(v[3 * k], v[3 * k + 1], v[3 * k + 2]); };
    seen.volume += corner(1).dot(corner(2).cross(corner(3))) / 6;
    for (int k = 1; k <= 3; ++k) {
      seen.lowest = std::min(seen.lowest, corner(k).z());
      seen.narrowest = std::min(seen.narrowest, corner(k).head<2>().norm());
    }
  }
  return seen;
}

Finished surface_of(const TestDir& dir, const std::string& name, const std::string& stock) {
  const std::string job = dir / (name + ".toml");
  write_file(job, file_text(kQuick) + (stock.empty() ? "" : "\n[stock]\n" + stock));
  return run_program({"surface", job, "--out", dir / name});
}
Seen gear_of(const TestDir& dir, const std::string& name, const std::string& stock) {
  const Finished run = surface_of(dir, name, stock);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return seen_in(file_text(dir / (name + "/gear.stl")));
}

double ring(double outer, double inner, double height) { return kPi * (outer * outer - inner * inner) * height; }

TEST(FaceBody, HasThicknessBoreAndHubOfTheDrawing) {
  const TestDir dir;
  const Seen plain = gear_of(dir, "plain", "");
  EXPECT_NEAR(plain.narrowest, 60, 1e-3);
  // The tips stand at z = -18: 20 teeth of the shaper, module 2, less the addendum. Back at -38.
  const Seen thick = gear_of(dir, "thick", "thickness = 20.0\n");
  EXPECT_NEAR(thick.lowest, -38, 1e-3);
  const double more = plain.lowest + 38;
  EXPECT_GT(more, 1);
  EXPECT_NEAR(thick.volume - plain.volume, ring(65, 60, more), 0.003 * ring(65, 60, more));
  const Seen hub =
      gear_of(dir, "hub", "thickness = 20.0\nbore_diameter = 40.0\nhub_diameter = 70.0\nhub_length = 12.0\n");
  EXPECT_NEAR(hub.lowest, -50, 1e-3);
  EXPECT_NEAR(hub.narrowest, 20, 0.01);
  const double web_top = -22.5 - 0.5 * 2,  // half a module below the roots, 2.25 m below the tips
      added = ring(60, 20, web_top + 38) + ring(35, 20, 12);
  EXPECT_NEAR(hub.volume - thick.volume, added, 0.003 * added);
  const Seen solid = gear_of(dir, "solid", "bore_diameter = 0\n");
  EXPECT_NEAR(solid.narrowest, 0, 1e-6);
  EXPECT_NEAR(solid.lowest, plain.lowest, 1e-6);
}

TEST(FaceBody, WhatCannotBeIsRefusedWithItsLimit) {
  const TestDir dir;
  const std::pair<const char*, const char*> cases[] = {
      {"thickness = 5.0\n",
       "thickness = 5.0000 mm is below 6.5000 mm, from the tips to 1 module below roots and groove"},
      {"bore_diameter = 121.0\n", "bore_diameter = 121.0000 mm exceeds 120.0000 mm, where the teeth begin"},
      {"hub_diameter = 100.0\nhub_length = 5.0\n",
       "hub_diameter = 100.0000 mm is not between the bore, 120.0000 mm, and"},
      {"bore_diameter = 20.0\nhub_diameter = 131.0\nhub_length = 5.0\n", "and 130.0000 mm, the teeth"},
      {"hub_diameter = 100.0\n", "hub_diameter = 100 mm needs hub_length as well"}};
  for (const auto& [stock, said] : cases) {
    const Finished run = surface_of(dir, "bad", stock);
    EXPECT_EQ(run.exit_code, 3) << stock;
    EXPECT_NE(run.err.find(said), std::string::npos) << stock << run.err;
    EXPECT_NE(run.err.find("bad.toml:6"), std::string::npos) << "the line of the key\n" << run.err;
  }
}

/// The web is no part of the tooth spaces: a text in which the tool comes down on it inside of the ring.
TEST(FaceBody, NoToolComesDownToTheWeb) {
  const TestDir dir;
  for (const bool web : {true, false}) {
    const std::string name = web ? "web" : "open", job = dir / (name + ".toml");
    write_file(job, file_text(kQuick) + "\n[stock]\nthickness = 20.0\n" + (web ? "bore_diameter = 40.0\n" : ""));
    const Finished run = run_program({"run", job, "--out", dir / name});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::string text = file_text(dir / (name + "/program.ngc"));
    const std::string inside = "X59.4495 Y3.282\n";  // the ball is free of the ring 1.5 mm farther in
    const std::size_t at = text.find(inside);
    ASSERT_NE(at, std::string::npos);
    text.insert(at + inside.size(), "X57.9\nZ96.4\nZ101.2\nX59.4495\n");
    write_file(dir / (name + ".ngc"), text);
    const Finished check = run_program({"check", job, dir / (name + ".ngc"), "--out", dir / (name + "_check")});
    const bool told =
        check.err.find("of tool 1 comes 0.1") != std::string::npos &&
        check.err.find("below z -23.5000 mm, where the web between the bore and the teeth stands") != std::string::npos;
    EXPECT_EQ(told, web) << check.err;
    EXPECT_TRUE(!web || check.exit_code == 1);
  }
}

}  // namespace
}  // namespace toothpath::test
