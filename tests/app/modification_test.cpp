// Modified face gears the whole way: cut, judged by what shares nothing with the program, inspected, and nothing
// changed where nothing is modified.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/bevel_grid.h"
#include "geometry/inspection/grid.h"
#include "tests/app/judged.h"
#include "tests/app/program.h"
#include "tests/support/brute_force_bevel_gear.h"
#include "tests/support/modified_flank.h"

namespace toothpath::test {
namespace {

constexpr double kSlack = 2e-4;  // mm: of the judge itself

constexpr const char* kModifications = R"(
[[gear.modification]]
kind = "tip_relief"
amount = 0.012
length = 1.2
law = "linear"
transition = 0.4

[[gear.modification]]
kind = "root_relief"
amount = 0.006
length = 0.8

[[gear.modification]]
kind = "end_relief"
amount = 0.01
length = 0.5
end = "outer"
flank = "right"

[[gear.modification]]
kind = "profile_crowning"
amount = 0.004

[[gear.modification]]
kind = "lead_crowning"
amount = 0.008

[[gear.modification]]
kind = "pressure_angle_slope"
amount = -0.005
flank = "left"

[[gear.modification]]
kind = "helix_angle_slope"
amount = 0.005

[[gear.modification]]
kind = "twist"
amount = 0.006
)";

void replace_in(std::string& text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

/// The quick spur gear with a short face, these modifications and fine passes; without its roughing.
std::string fine_job(const std::string& modifications) {
  std::string text = file_text(kSamples + "/spur_quick.toml");
  replace_in(text, "outer_radius = 65.0", "outer_radius = 62.0");
  replace_in(text, "[machine]", modifications + "\n[machine]");
  replace_in(text, "scallop = 0.02\nchord_tolerance = 0.002", "scallop = 0.0005\nchord_tolerance = 0.0003");
  const auto begin = text.find("[[operation]]"), end = text.find("[[operation]]", begin + 1);
  text.erase(begin, end - begin);
  return text;
}

/// Least and most of what stands on places of both flanks beside the first space.
struct Stands {
  double least = INFINITY, most = -INFINITY;
};
Stands stands_on(const std::vector<std::pair<Vec3, Vec3>>& way, double ball, const face_gear::FaceGear& gear,
                 bool modified) {
  Stands out;
  const auto& f = gear.rings()[0].surface;
  const auto& zone = gear.rings()[0].zone;
  auto parameters = gear.parameters();
  if (!modified) parameters.modifications.clear();
  for (const int side : {1, -1})
    for (int k = 0; k < 17; ++k) {
      const double r = zone.inner_radius_mm + (zone.outer_radius_mm - zone.inner_radius_mm) * (0.02 + 0.96 * k / 16);
      const double low = face_gear::fillet_line_height(f, side, r).value(), top = f.z_tip(r);
      for (int n = 0; n < 21; ++n) {
        const auto at = face_gear::invert_flank(f, side, r, top + (low - top) * (0.02 + 0.96 * n / 20));
        if (!at || at->theta < 0) continue;
        Vec3 p = modified_by_the_words<double>(f, parameters, 0, side, at->theta, at->B);
        if (side < 0) p = turned(p, gear.pitch());
        double least = INFINITY;
        for (const auto& [a, b] : way) {
          const Vec3 along = b - a;
          const double t = along.isZero() ? 0 : std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
          least = std::min(least, (a + t * along - p).norm() - ball);
        }
        out.least = std::min(out.least, least);
        out.most = std::max(out.most, least);
      }
    }
  return out;
}

/// Every kind at once, cut, and read with another reader on another model of the machine.
TEST(ModifiedGear, TheProgramLeavesTheFlanksOfTheWords) {
  for (const OutputForm& form : {kForms[14], kForms[2]}) {
    Random random{77};
    std::string text = fine_job(kModifications);
    replace_once(text, "\"xyzac_large.toml\"", "\"machine.toml\"\naccept_assumed = true\n#");
    const auto job = job::parse_job(text, "job.toml");
    ASSERT_TRUE(job) << to_text(job.error());
    const auto gear = process::make_face_gear(job.value());
    ASSERT_TRUE(gear.value_if());
    const JudgedRun run = run_judged(text, form, random);
    ASSERT_EQ(run.outcome.exit_code, app::ExitCode::ok) << to_text(run.outcome.errors) << run.report.dump(1);
    const JudgedPath path(run.program, run.machine_text,
                          {{3, -2, 120}, false, {{3, -2, 0}, {0, job.value().tools.front().length_mm}}});
    ASSERT_TRUE(path.faults().empty()) << path.faults().front();
    std::vector<MachineMove> cuts;
    for (const MachineMove& move : path.moves())
      if (!move.rapid) cuts.push_back(move);
    const double ball = job.value().tools.front().radius_mm();
    std::vector<std::pair<Vec3, Vec3>> way;
    const auto centre = [&](const MachineMove& cut, double t) {
      const ToolPlace place = path.at(cut, t);
      return Vec3(place.tip + ball * place.axis);
    };
    for (std::size_t k = 0; k < cuts.size() / std::size_t(gear.value_if()->parameters().teeth); ++k)
      for (int n = 0; n < 2; ++n) way.emplace_back(centre(cuts[k], n / 2.0), centre(cuts[k], (n + 1) / 2.0));
    ASSERT_GT(way.size(), 500u);
    const Stands own = stands_on(way, ball, *gear.value_if(), true),
                 plain = stands_on(way, ball, *gear.value_if(), false);
    const double bound = run.report["gouge_um"]["bound"].get<double>(),
                 most_left = run.report["excess_um"]["finished"]["bound"].get<double>();
    std::printf("  %s: gouge %.2f um, proven %.2f; left %.2f um, proven %.2f; of the plain flank %.1f um are gone\n",
                form.name().c_str(), -1e3 * own.least, bound, 1e3 * own.most, most_left, -1e3 * plain.least);
    EXPECT_GE(own.least, -(1e-3 * bound + kSlack));
    EXPECT_LE(own.most, 1e-3 * most_left + kSlack);
    EXPECT_LT(own.most, 0.0025);
    EXPECT_LT(plain.least, -0.015) << "the judge does not see the modifications";
  }
}

TEST(ModifiedGear, WithoutAmountsEveryByteIsThatOfThePlainGear) {
  const TestDir dir;
  std::string zero = kModifications;
  for (std::size_t at = 0; (at = zero.find("amount = ", at)) != std::string::npos; ++at)
    zero.replace(at, zero.find('\n', at) - at, "amount = 0");
  for (const auto& [name, text] : {std::pair("plain", fine_job("")), {"zero", fine_job(zero)}}) {
    write_file(dir / "job.toml", text);
    ASSERT_EQ(run_program({"run", dir / "job.toml", "--step", "--3mf", "--out", dir / name}).exit_code, 0);
    ASSERT_EQ(run_program({"contact", dir / "job.toml", "--torque", "20", "--positions", "2", "--out",
                           dir / (std::string(name) + "_contact")})
                  .exit_code,
              0);
  }
  for (const char* file : {"program.ngc", "cl.csv", "setup.html", "gear.stl", "gear.step", "gear.3mf", "tooth.vtp",
                           "inspection.csv", "inspection.dmi", "limits.json", "limits.html"})
    EXPECT_EQ(file_text(dir / (std::string("plain/") + file)), file_text(dir / (std::string("zero/") + file))) << file;
  for (const char* file : {"contact.csv", "transmission.csv", "contact.json", "loaded.csv", "pressure.csv"})
    EXPECT_EQ(file_text(dir / (std::string("plain_contact/") + file)),
              file_text(dir / (std::string("zero_contact/") + file)))
        << file;
}

/// The bevel pinion of the samples with a narrow face, these modifications, and coarser passes.
std::string bevel_job(const std::string& modifications) {
  std::string text = file_text(kSamples + "/bevel_pinion.toml");
  replace_in(text, "[machine]", modifications + "\n[machine]");
  replace_in(text, "chord_tolerance = 0.0005", "chord_tolerance = 0.001");
  return text;
}

TEST(ModifiedBevelGear, WithoutAmountsEveryByteIsThatOfThePlainGear) {
  const TestDir dir;
  std::string zero = kModifications;
  for (std::size_t at = 0; (at = zero.find("amount = ", at)) != std::string::npos; ++at)
    zero.replace(at, zero.find('\n', at) - at, "amount = 0");
  for (const auto& [name, text] : {std::pair("plain", bevel_job("")), {"zero", bevel_job(zero)}}) {
    write_file(dir / "job.toml", text);
    ASSERT_EQ(run_program({"run", dir / "job.toml", "--step", "--out", dir / name}).exit_code, 0);
    ASSERT_EQ(run_program({"contact", dir / "job.toml", "--mate", kSamples + "/bevel_wheel.toml", "--out",
                           dir / (std::string(name) + "_contact")})
                  .exit_code,
              0);
    ASSERT_EQ(run_program({"cutter", dir / "job.toml", "--out", dir / (std::string(name) + "_cutter")}).exit_code, 0);
  }
  for (const char* file : {"/program.ngc", "/cl.csv", "/setup.html", "/gear.stl", "/gear.step", "/tooth.vtp",
                           "/inspection.csv", "/limits.json", "_contact/contact.csv", "_contact/transmission.csv",
                           "_contact/contact.json", "_cutter/cutter.json", "_cutter/cutter.html"})
    EXPECT_EQ(file_text(dir / (std::string("plain") + file)), file_text(dir / (std::string("zero") + file))) << file;
}

/// The nominal of inspection is the modified wall: no place of the solid mill of the words is farther from its points
/// than its tables, and the plain mill leaves much.
TEST(ModifiedBevelGear, InspectionPointsLieOnTheWallsOfTheWords) {
  const auto job = job::read_job_file(kSamples + "/bevel_modified.toml");
  ASSERT_TRUE(job.value_if());
  const auto gear = process::make_bevel_gear(*job.value_if());
  ASSERT_TRUE(gear.value_if());
  auto parameters = gear.value_if()->parameters();
  const auto& c = gear.value_if()->cutter_data();
  const FingerMill mill{c.module_mm, c.tip_radius_mm, c.rack_depth_mm, c.profile_height_mm};
  const BruteForceBevelGear words(parameters, mill);
  parameters.modifications.clear();
  const BruteForceBevelGear plain(parameters, mill);
  const auto grid = inspection::bevel_inspection_grid(*gear.value_if());
  ASSERT_TRUE(grid);
  double off = 0, seen = 0;
  for (const auto& p : *grid) {
    off = std::max(off, std::abs(words.clearance(p.p)));
    seen = std::max(seen, plain.clearance(p.p));
    EXPECT_GT(words.clearance(p.p - 0.01 * p.n), 0.005);
  }
  std::printf("  %zu points: %.1e mm beside the words, up to %.1f um beside the plain walls\n", grid->size(), off,
              1e3 * seen);
  EXPECT_LT(off, 1e-7);
  EXPECT_GT(seen, 0.02);
}

/// What a mill cannot make stands in the job, and the refusal says where and what would do.
TEST(ModifiedBevelGear, RefusalsNameTheirPlace) {
  const TestDir dir;
  for (const auto& [modification, words] : {std::pair(R"([[gear.modification]]
kind = "twist"
amount = 0.01)",
                                                      "twist of 0.01 mm changes along the face with the depth"),
                                            {R"([[gear.modification]]
kind = "tip_relief"
amount = 0.01
length = 1.0
flank = "left")",
                                             "one mill cuts both flanks"}}) {
    write_file(dir / "job.toml", bevel_job(modification));
    const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("job.toml:"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  }
}

/// Crowning of the gear and a relief of the pinion take contact and load off the edges.
TEST(ModifiedGear, PatternAndLoadLeaveTheEdges) {
  const TestDir dir;
  const std::string crowned = R"(
[[gear.modification]]
kind = "lead_crowning"
amount = 0.01
)",
                    relieved = R"(
[contact]
[[contact.modification]]
kind = "tip_relief"
amount = 0.008
length = 0.8
)";
  std::vector<nlohmann::json> found;
  for (const std::string& text : {fine_job(""), fine_job(crowned + relieved)}) {
    write_file(dir / "job.toml", text);
    ASSERT_EQ(
        run_program({"contact", dir / "job.toml", "--torque", "5", "--positions", "4", "--out", dir / "out"}).exit_code,
        0);
    found.push_back(nlohmann::json::parse(file_text(dir / "out/contact.json")));
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto &plain = found[0]["flanks"][side], &modified = found[1]["flanks"][side];
    EXPECT_EQ(plain["contact"], "line");
    EXPECT_EQ(modified["contact"], "modified");
    EXPECT_GT(plain["zones"][0]["pattern"]["share"], 0.9);
    EXPECT_LT(modified["zones"][0]["pattern"]["share"], 0.9);
    const auto most = [&](std::size_t job, const char* key) {
      return found[job]["loaded"]["flanks"][side][key]["most"].get<double>();
    };
    EXPECT_GT(most(1, "pressure_MPa"), most(0, "pressure_MPa"));
    EXPECT_LT(most(1, "stiffness_N_um"), most(0, "stiffness_N_um"));
  }
}

/// The nominal of inspection, meshes and contact is the modified flank.
TEST(ModifiedGear, InspectionPointsLieOnTheFlanksOfTheWords) {
  const auto job = job::parse_job(fine_job(kModifications), "job.toml");
  ASSERT_TRUE(job);
  const auto gear = process::make_face_gear(job.value());
  ASSERT_TRUE(gear.value_if());
  const auto& f = gear.value_if()->rings()[0].surface;
  const auto grid = inspection::inspection_grid(drawn_solid(*gear.value_if()));
  ASSERT_TRUE(grid);
  double off = 0, moved = 0;
  for (const auto& p : *grid) {
    const double h = 1e-6;
    const auto at = [&](double theta, double B) {
      return modified_by_the_words<double>(f, gear.value_if()->parameters(), 0, p.side, theta, B);
    };
    off = std::max(off, (at(p.theta, p.B) - p.p).norm());
    moved = std::max(moved, (f.flank(p.side, p.theta, p.B).p - p.p).norm());
    Vec3 n =
        (at(p.theta + h, p.B) - at(p.theta - h, p.B)).cross(at(p.theta, p.B + h) - at(p.theta, p.B - h)).normalized();
    if (n.dot(p.n) < 0) n = -n;
    EXPECT_LT((n - p.n).norm(), 1e-7);
  }
  EXPECT_LE(off, 1e-9);
  EXPECT_GT(moved, 0.01);
}

/// Nominal points of both flanks as inspection.csv has them: zone, flank, row, column, then place and normal.
std::vector<std::array<double, 10>> inspected(const std::string& job) {
  const TestDir dir;
  write_file(dir / "job.toml", job);
  write_file(dir / "flank_grid_spur.csv", file_text(kSamples + "/flank_grid_spur.csv"));
  EXPECT_EQ(run_program({"surface", dir / "job.toml", "--out", dir / "out", "--quiet"}).exit_code, 0);
  std::vector<std::array<double, 10>> out;
  std::istringstream in(file_text(dir / "out/inspection.csv"));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    auto& point = out.emplace_back();
    for (double& x : point) cells >> x;
  }
  return out;
}

/// Gears that stand on their tooth spaces alone: at 5 to 95 % of the face, column by column, a crowning along the tooth
/// takes what its words say off the plain points. They hold at the foot on the plain flank, which lies beside the point
/// of the grid by what is gone at most: where teeth run aslant it lies along the tooth.
TEST(ModifiedGear, PointsOfGearsOnTheirToothSpacesAreThoseOfTheWords) {
  for (const auto& [sample, face] : {std::pair("cylindrical_spur.toml", 20.0),
                                     {"straight_bevel.toml", 22.0},
                                     {"spiral_bevel.toml", 25.4},
                                     {"flank_grid_spur.toml", 6.0}}) {
    const std::string plain = file_text(kSamples + "/" + sample);
    std::string job = plain;
    job.insert(job.find("\n[machine]"), R"(
[[gear.modification]]
kind = "lead_crowning"
amount = 0.02
flank = "left"
)");
    const auto before = inspected(plain), after = inspected(job);
    ASSERT_EQ(before.size(), 90u);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      const auto &a = before[k], &b = after[k];
      double gone = 0;
      for (std::size_t n = 4; n < 7; ++n) gone += (a[n] - b[n]) * a[n + 3];
      const double x = 0.05 + 0.9 * a[3] / 8, words = a[1] < 0 ? 0.02 * (2 * x - 1) * (2 * x - 1) : 0,
                   slope = 0.08 * std::abs(2 * x - 1) / face;
      EXPECT_NEAR(gone, words, 1e-6 + slope * words) << sample << " " << a[1] << " " << a[2] << " " << a[3];
    }
  }
}

}  // namespace
}  // namespace toothpath::test
