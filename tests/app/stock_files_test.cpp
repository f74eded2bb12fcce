// `run --stock`: blank.stl and roughed.stl are closed solids that hold the part, `check --stock` takes them and says
// the right thing of them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cam/clearance/distance.h"
#include "geometry/mesh/file.h"
#include "tests/app/program.h"
#include "tests/support/brute_force_bevel_gear.h"
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

/// `run --stock` of this sample, once for all tests: its outputs and what it printed.
struct StockRun {
  TestDir dir;
  std::string printed;

  explicit StockRun(const std::string& job) {
    const Finished run = run_program({"run", job, "--stock", "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    printed = run.out;
  }
};
const StockRun& spur_quick() {
  static const StockRun run(kSamples + "/spur_quick.toml");
  return run;
}
const StockRun& bevel_pinion() {
  static const StockRun run(kSamples + "/bevel_pinion.toml");
  return run;
}

TEST(StockFiles, OfAFaceGearAreClosedHoldTheGearAndPassTheCheck) {
  const std::string job = kSamples + "/spur_quick.toml";
  const TestDir& dir = spur_quick().dir;
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

TEST(StockFiles, OfABevelGearAreClosedAndHoldTheGear) {
  const std::string job = kSamples + "/bevel_pinion.toml";
  const TestDir& dir = bevel_pinion().dir;
  EXPECT_NE(bevel_pinion().printed.find("roughed.stl: "), std::string::npos) << bevel_pinion().printed;
  const double gear = mesh::signed_volume(solid(dir / "out/gear.stl")),
               blank = mesh::signed_volume(solid(dir / "out/blank.stl")),
               roughed = mesh::signed_volume(solid(dir / "out/roughed.stl"));
  EXPECT_LT(gear, roughed);
  EXPECT_LT(roughed - gear, 0.5 * (blank - gear)) << gear << " " << roughed << " " << blank;
  for (const char* stock : {"blank.stl", "roughed.stl"})
    EXPECT_EQ(
        checked(dir, job, dir / "out/program.ngc", dir / (std::string("out/") + stock), 0)["report"]["stock"]["clear"],
        true);
}

/// A job whose first operation is gone: nothing roughs.
void expect_told(const std::string& sample, const std::string& first, const std::string& roughs) {
  const TestDir dir;
  std::string job = file_text(kSamples + "/" + sample);
  const auto at = job.find("[[operation]]");
  job.erase(at, job.find("[[operation]]", at + 1) - at);
  write_file(dir / "job.toml", job);
  const long line = 1 + std::count(job.begin(), job.begin() + std::ptrdiff_t(at), '\n');
  const Finished run = run_program({"run", dir / "job.toml", "--stock", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const std::string told = dir / "job.toml" + ":" + std::to_string(line) +
                           ":1: warning: roughed.stl is not written: no operation roughs, and the first one (" + first +
                           ") cuts from the blank; an [[operation]] with type = \"" + roughs + "\"";
  EXPECT_NE(run.out.find(told), std::string::npos) << told << "\n" << run.out;
  EXPECT_FALSE(std::filesystem::exists(dir / "out/roughed.stl"));
  EXPECT_TRUE(std::filesystem::exists(dir / "out/blank.stl"));
}
TEST(StockFiles, OfAJobThatDoesNotRoughAreTheBlankAndTheReason) {
  expect_told("spur_quick.toml", "finishing", "roughing");
  expect_told("bevel_pinion.toml", "finger_finishing", "finger_roughing");
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

TEST(StockFiles, RoughedPartIsNeverSmallerThanWhatRoughingLeaves) {
  const TestDir& dir = spur_quick().dir;
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

TEST(StockFiles, RoughedPartTakesAFinishingProgramAlone) {
  const TestDir dir;
  const std::string job = kSamples + "/spur_quick.toml";
  ASSERT_EQ(run_program({"run", job, "--stock", "--restart", "1:0", "--out", dir / "out", "--quiet"}).exit_code, 0);
  const auto report = checked(dir, job, dir / "out/program.ngc", dir / "out/roughed.stl", 0)["report"];
  EXPECT_EQ(report["stock"]["clear"], true);
}

/// The finger mill at the roughing poses of cl.csv, by the file and a mill of the tests' own.
struct MillPath {
  struct Move {
    Vec3 from, to, axis_from, axis_to;
  };
  static constexpr double kDedendum = 5.1;
  double delta = std::atan2(18.0, 37.0), R_e = 54 / std::sin(delta);
  PlainFingerMill mill{{3.0, 0.9, 4.1, 4.8}, M_PI / 9, R_e / 0.75 * std::tan(delta), kDedendum};
  std::vector<Move> moves;

  explicit MillPath(const std::string& csv) {
    std::istringstream in(csv);
    std::string line;
    std::getline(in, line);
    Vec3 tip = Vec3::Zero(), axis = Vec3::Zero();
    while (std::getline(in, line) && line.rfind("0,", 0) == 0) {
      std::vector<std::string> cell;
      std::istringstream cells(line);
      for (std::string c; std::getline(cells, c, ',');) cell.push_back(c);
      const Vec3 to(std::stod(cell[4]), std::stod(cell[5]), std::stod(cell[6])),
          axis_to(std::stod(cell[7]), std::stod(cell[8]), std::stod(cell[9]));
      if (cell[11] != "rapid") moves.push_back({tip, to, axis, axis_to});
      tip = to;
      axis = axis_to;
    }
  }
  [[nodiscard]] bool in_mill(double height, double radius, double deep) const {
    for (int k = 0; k < (deep > 0 ? 24 : 1); ++k) {
      const double x = height - kDedendum + deep * std::cos(k * M_PI / 12),
                   rho = std::abs(radius + deep * std::sin(k * M_PI / 12));
      if (mill.clearance(x, rho) > 0) return false;
    }
    return true;
  }
  /// Is the place inside of the mill somewhere, by more than `deep`?
  [[nodiscard]] bool removes(const Vec3& p, double deep) const {
    for (int k = 0; k < 18; ++k) {
      const Vec3 q = turned(p, -2 * M_PI * k / 18);
      for (const Move& m : moves) {
        const auto pose = [&](double t, double& height) {
          const Vec3 axis = ((1 - t) * m.axis_from + t * m.axis_to).normalized(), d = q - (1 - t) * m.from - t * m.to;
          height = d.dot(axis);
          return (d - height * axis).norm();
        };
        double height = 0, best = 0, least = INFINITY;
        if (pose(0.5, height) > 6 + (m.to - m.from).norm()) continue;
        for (int i = 0; i <= 20; ++i)
          if (const double radius = pose(i / 20.0, height); radius < least) least = radius, best = i / 20.0;
        for (double step = 0.025; step > 1e-5; step /= 2)
          for (const double t : {std::max(0.0, best - step), std::min(1.0, best + step)})
            if (const double radius = pose(t, height); radius < least) least = radius, best = t;
        for (const double t : {best, 0.0, 1.0}) {
          const double radius = pose(t, height);
          if (in_mill(height, radius, deep)) return true;
        }
      }
    }
    return false;
  }
  [[nodiscard]] Vec3 place(double ell, double height, double angle) const {
    const double r = ell * std::sin(delta) + height * std::cos(delta);
    return {r * std::cos(angle), r * std::sin(angle), ell * std::cos(delta) - height * std::sin(delta)};
  }
};

struct WrongPlaces {
  int missing = 0, wrongly_missing = 0, removed_deep = 0, wrongly_there = 0;
};
WrongPlaces ask(const mesh::TriangleMesh& mesh, const MillPath& path, double thick_mm, int places) {
  const clearance::MeshDistance solid(mesh);
  Random random(77);
  WrongPlaces out;
  for (int k = 0; k < places; ++k) {
    const Vec3 p = path.place(random(path.R_e - 35.99, path.R_e - 0.01), random(-5.0, 4.09), random(0, 2 * M_PI));
    const double ell = p.head<2>().norm() * std::sin(path.delta) + p.z() * std::cos(path.delta);
    if (std::abs(ell - 104) < 3.3) continue;  // the groove is turned
    const bool inside = solid.inside(p), deep = path.removes(p, thick_mm);
    out.missing += !inside;
    out.wrongly_missing += !inside && !path.removes(p, 0);
    out.removed_deep += deep;
    out.wrongly_there += inside && deep;
  }
  return out;
}

TEST(StockFiles, RoughedPartOfABevelGearIsWhatTheMillLeaves) {
  const TestDir& dir = bevel_pinion().dir;
  const MillPath path(file_text(dir / "out/cl.csv"));
  ASSERT_GT(path.moves.size(), 100u);
  const auto told = nlohmann::json::parse(file_text(dir / "out/report.json"))["roughed"];
  const double thick = told["too_thick_mm"];
  EXPECT_LT(thick, 0.35);
  mesh::TriangleMesh mesh = solid(dir / "out/roughed.stl");
  EXPECT_EQ(told["triangles"], mesh.triangles.size());
  const WrongPlaces found = ask(mesh, path, thick, 3000);
  EXPECT_GT(found.missing, 600);
  EXPECT_EQ(found.wrongly_missing, 0) << "of " << found.missing;
  EXPECT_GT(found.removed_deep, 400);
  EXPECT_EQ(found.wrongly_there, 0) << "of " << found.removed_deep;
  // Turned by 2 deg it is wrong, and seen to be.
  for (Vec3& v : mesh.vertices) v = turned(v, 0.035);
  const WrongPlaces planted = ask(mesh, path, thick, 1000);
  EXPECT_GT(planted.wrongly_missing, 10);
  EXPECT_GT(planted.wrongly_there, 10);
}

TEST(StockFiles, RoughedPartOfABevelGearTakesAFinishingProgramAndIsRefusedTurnedByHalfAPitch) {
  const TestDir dir;
  const std::string job = kSamples + "/bevel_pinion.toml";
  ASSERT_EQ(run_program({"run", job, "--stock", "--restart", "1:0", "--out", dir / "out", "--quiet"}).exit_code, 0);
  // The check finds no roughing in it, and says so of the root; nothing of the stock is in the way.
  EXPECT_EQ(checked(dir, job, dir / "out/program.ngc", dir / "out/roughed.stl", 1)["report"]["stock"]["clear"], true);
  // Turned by half a pitch its spaces are where the teeth must be.
  mesh::TriangleMesh turned_by_half = solid(dir / "out/roughed.stl");
  for (Vec3& v : turned_by_half.vertices) v = turned(v, M_PI / 18);
  std::ostringstream stl;
  ASSERT_TRUE(mesh::write_stl(stl, turned_by_half, "planted"));
  write_file(dir / "planted.stl", stl.str());
  const Finished check =
      run_program({"check", job, dir / "out/program.ngc", "--stock", dir / "planted.stl", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 3) << check.out;
  EXPECT_NE(check.err.find("out of the stock"), std::string::npos) << check.err;
}

/// A shank that begins 3 mm above the tip enters the blank, where nothing is cut yet.
TEST(StockFiles, BlankPartAShankThatEntersItIsNamed) {
  const TestDir dir;
  const std::string job = file_text(kSamples + "/spur_quick.toml");
  write_file(dir / "short.toml", replaced_all(job, "flute_length = 6.0", "flute_length = 3.0"));
  const TestDir& whole = spur_quick().dir;
  const auto found = checked(dir, dir / "short.toml", whole / "out/program.ngc", whole / "out/blank.stl", 1);
  EXPECT_EQ(found["report"]["stock"]["clear"], false);
  EXPECT_EQ(found["report"]["stock"]["worst"][0]["body"], "shank");
}

TEST(StockFiles, OfAnotherGearAreRefused) {
  const TestDir dir;
  ASSERT_EQ(run_program({"surface", kSamples + "/offset_milled.toml", "--stock", "--out", dir / "other", "--quiet"})
                .exit_code,
            0);
  EXPECT_FALSE(std::filesystem::exists(dir / "other/roughed.stl")) << "surface plans nothing";
  const std::string job = kSamples + "/spur_quick.toml";
  const Finished check = run_program(
      {"check", job, spur_quick().dir / "out/program.ngc", "--stock", dir / "other/blank.stl", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 3);
  EXPECT_NE(check.err.find("out of the stock"), std::string::npos) << check.err;
}

}  // namespace
}  // namespace toothpath::test
