// `run --stock`: blank.stl and roughed.stl are closed solids that hold the part, `check --stock` takes them and says
// the right thing of them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cam/clearance/distance.h"
#include "geometry/mesh/file.h"
#include "tests/app/program.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

/// With every check that `check --stock` makes of a mesh.
mesh::TriangleMesh solid(const std::string& file) {
  auto mesh = mesh::load_mesh(file);
  if (!mesh) throw std::runtime_error(mesh.error().message);
  return *std::move(mesh);
}

nlohmann::json checked(const TestDir& dir, const std::string& job, const std::string& program, const std::string& stock,
                       int expected_code) {
  const Finished check = run_program({"check", job, program, "--stock", stock, "--out", dir / "check", "--json"});
  EXPECT_EQ(check.exit_code, expected_code) << stock << check.out.substr(0, 400);
  return nlohmann::json::parse(check.out);
}

TEST(StockFiles, OfAFaceGearAreClosedHoldTheGearAndPassTheCheck) {
  const TestDir dir;
  const std::string job = kSamples + "/spur_quick.toml";
  ASSERT_EQ(run_program({"run", job, "--stock", "--out", dir / "out", "--quiet"}).exit_code, 0);
  const double gear = mesh::signed_volume(solid(dir / "out/gear.stl")),
               blank = mesh::signed_volume(solid(dir / "out/blank.stl")),
               roughed = mesh::signed_volume(solid(dir / "out/roughed.stl"));
  EXPECT_LT(gear, roughed);
  // Most of what the teeth lack is gone; what a cell of the grid hides is not.
  EXPECT_LT(roughed - gear, 0.6 * (blank - gear)) << gear << " " << roughed << " " << blank;
  for (const char* stock : {"blank.stl", "roughed.stl"}) {
    const auto report = checked(dir, job, dir / "out/program.ngc", dir / (std::string("out/") + stock), 0)["report"];
    EXPECT_EQ(report["verified"], true) << stock;
    EXPECT_EQ(report["stock"]["clear"], true) << stock;
  }
}

TEST(StockFiles, OfABevelGearAreTheBlankAlone) {
  const TestDir dir;
  const std::string job = kSamples + "/bevel_pinion.toml";
  const Finished run = run_program({"run", job, "--stock", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("roughed.stl is not written"), std::string::npos) << run.out;
  EXPECT_FALSE(std::filesystem::exists(dir / "out/roughed.stl"));
  EXPECT_LT(mesh::signed_volume(solid(dir / "out/gear.stl")), mesh::signed_volume(solid(dir / "out/blank.stl")));
  const auto report = checked(dir, job, dir / "out/program.ngc", dir / "out/blank.stl", 0)["report"];
  EXPECT_EQ(report["stock"]["clear"], true);
}

/// What a ball of the roughing path of cl.csv comes to, by the file alone.
struct BallPath {
  double radius_mm = 0.5;
  std::vector<std::pair<Vec3, Vec3>> moves;  ///< of the ball's centre, in tooth space 0

  explicit BallPath(const std::string& csv) {
    std::istringstream in(csv);
    std::string line;
    std::getline(in, line);
    Vec3 last = Vec3::Zero();
    while (std::getline(in, line)) {
      std::vector<std::string> cell(1);
      for (const char c : line) {
        if (c == ',') cell.emplace_back();
        else cell.back() += c;
      }
      if (cell[0] != "0") break;
      const Vec3 tip(std::stod(cell[4]), std::stod(cell[5]), std::stod(cell[6])),
          axis(std::stod(cell[7]), std::stod(cell[8]), std::stod(cell[9]));
      const Vec3 centre = tip + radius_mm * axis;
      if (cell[11] != "rapid") moves.emplace_back(last, centre);
      last = centre;
    }
  }
  [[nodiscard]] bool removes(const Vec3& p, int teeth) const {
    const int near = int(std::lround(azimuth(p) / (2 * M_PI) * teeth));
    for (int k = near - 2; k <= near + 2; ++k)
      for (const auto& [a, b] : moves)
        if (distance_to_segment(turned(p, -2 * M_PI * k / teeth), a, b) <= radius_mm) return true;
    return false;
  }
};

/// Places of the blank that the mesh lacks though no ball was there.
int wrongly_missing(const mesh::TriangleMesh& mesh, const BallPath& path, int& missing) {
  const clearance::MeshDistance solid(mesh);
  Random random(1123);
  int wrong = 0;
  for (int k = 0; k < 6000; ++k) {
    const double r = random(60.001, 64.999), angle = random(0, 2 * M_PI), z = random(-22.6, -18.001);
    const Vec3 p(r * std::cos(angle), r * std::sin(angle), z);
    if (solid.inside(p)) continue;
    ++missing;
    wrong += !path.removes(p, 60);
  }
  return wrong;
}

TEST(RoughedPart, IsNeverSmallerThanWhatRoughingLeaves) {
  const TestDir dir;
  ASSERT_EQ(run_program({"run", kSamples + "/spur_quick.toml", "--stock", "--out", dir / "out", "--quiet"}).exit_code,
            0);
  const BallPath path(file_text(dir / "out/cl.csv"));
  ASSERT_GT(path.moves.size(), 50u);
  mesh::TriangleMesh mesh = solid(dir / "out/roughed.stl");
  int missing = 0;
  EXPECT_EQ(wrongly_missing(mesh, path, missing), 0);
  EXPECT_GT(missing, 500) << "of 6000 places";
  // A mesh that lies 0.6 mm too deep is found by the same look.
  for (Vec3& v : mesh.vertices) v.z() -= 0.6;
  EXPECT_GT(wrongly_missing(mesh, path, missing), 20);
}

TEST(RoughedPart, TakesAFinishingProgramAlone) {
  const TestDir dir;
  const std::string job = kSamples + "/spur_quick.toml";
  ASSERT_EQ(run_program({"run", job, "--stock", "--restart", "1:0", "--out", dir / "out", "--quiet"}).exit_code, 0);
  const auto report = checked(dir, job, dir / "out/program.ngc", dir / "out/roughed.stl", 0)["report"];
  EXPECT_EQ(report["stock"]["clear"], true);
}

/// A shank that begins 3 mm above the tip enters the blank, where nothing is cut yet.
TEST(BlankPart, AShankThatEntersItIsNamed) {
  const TestDir dir;
  const std::string job = file_text(kSamples + "/spur_quick.toml");
  ASSERT_EQ(run_program({"run", kSamples + "/spur_quick.toml", "--stock", "--out", dir / "out", "--quiet"}).exit_code,
            0);
  write_file(dir / "short.toml", replaced_all(job, "flute_length = 6.0", "flute_length = 3.0"));
  const auto found = checked(dir, dir / "short.toml", dir / "out/program.ngc", dir / "out/blank.stl", 1);
  EXPECT_EQ(found["report"]["stock"]["clear"], false);
  EXPECT_EQ(found["report"]["stock"]["worst"][0]["body"], "shank");
}

TEST(StockOfAnotherGear, IsRefused) {
  const TestDir dir;
  ASSERT_EQ(run_program({"surface", kSamples + "/offset_milled.toml", "--stock", "--out", dir / "other", "--quiet"})
                .exit_code,
            0);
  EXPECT_FALSE(std::filesystem::exists(dir / "other/roughed.stl")) << "surface plans nothing";
  const std::string job = kSamples + "/spur_quick.toml";
  ASSERT_EQ(run_program({"run", job, "--out", dir / "out", "--quiet"}).exit_code, 0);
  const Finished check =
      run_program({"check", job, dir / "out/program.ngc", "--stock", dir / "other/blank.stl", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 3);
  EXPECT_NE(check.err.find("out of the stock"), std::string::npos) << check.err;
}

}  // namespace
}  // namespace toothpath::test
