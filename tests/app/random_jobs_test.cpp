// Jobs that nobody chose, with fixed seeds, the whole way: each is verified, with bounds that hold and the same bytes
// on any number of threads, or it is refused, and a calculation that shares nothing with the refusal says so too.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/commands/run.h"
#include "app/job/file.h"
#include "geometry/base/hash.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "tests/support/brute_force_face_gear.h"
#include "tests/support/files.h"
#include "tests/support/random_jobs.h"
#include "tests/support/threads.h"

namespace toothpath::test {
namespace {

constexpr int kFaceJobs = 24, kBevelJobs = 4;

struct Trial {
  std::string job;
  commands::CommandOutcome outcome;
};

std::string job_of(int seed) {
  Random random(std::uint64_t(1000 + seed));
  return seed < kFaceJobs ? random_face_job(random) : random_bevel_job(random);
}

Trial run_in(const TestDir& dir, const std::string& name, int seed) {
  Trial run{job_of(seed), {}};
  commands::RunRequest request;
  request.job_file = dir / "job.toml";
  request.out_dir = dir / name;
  request.quiet = true;
  write_file(request.job_file, run.job);
  run.outcome = commands::run_job(request);
  return run;
}

/// Radius of a full round tip: its centre lies on the middle of the shaper's tooth, as far from the involute as from
/// the tip circle.
double full_round_tip(const face_gear::FaceGearParameters& p) {
  const double n = p.shaper_teeth, pitch = 0.5 * p.module_mm * n, base = pitch * std::cos(p.pressure_angle_rad),
               tip = pitch + (p.addendum_coefficient + p.clearance_coefficient) * p.module_mm;
  const auto involute = [](double angle) { return std::tan(angle) - angle; };
  double low = 0, high = tip - base;
  for (int k = 0; k < 100; ++k) {
    const double rho = 0.5 * (low + high);
    const double room =
        kPi / (2 * n) + involute(p.pressure_angle_rad) - involute(std::acos(base / (tip - rho))) - rho / base;
    (room > 0 ? low : high) = rho;
  }
  return low;
}

/// The refusals of a face gear, each by another calculation: closed forms, and the solid shaper swept past points.
class FaceRefusals {
 public:
  explicit FaceRefusals(const face_gear::FaceGearParameters& p) : p_(p) {}

  /// Is what the message says true? Messages of other kinds are not.
  [[nodiscard]] bool confirm(const std::string& message) const {
    const auto number = [&](const char* pattern) {
      std::smatch found;
      return std::regex_search(message, found, std::regex(pattern)) ? std::stod(found[1]) : NAN;
    };
    if (const double limit = number("the full round tip has ([0-9.]+) mm"); !std::isnan(limit))
      return p_.shaper_tip_radius_mm > limit && std::abs(full_round_tip(p_) - limit) < 1e-4;
    const double inner = number("inner_radius = ([0-9.]+) mm"), outer = number("outer_radius = ([0-9.]+) mm");
    if (const double limit = number("the gear's base radius ([0-9.]+) mm"); !std::isnan(limit))
      return inner <= limit && std::abs(base_radius(zone_with(inner, true)) - limit) < 1e-4;
    if (message.find("lies inside the undercut limit") != std::string::npos)
      return undercut(zone_with(inner, true), int(number("flank side ([+-]1)")));
    if (message.find("exceeds the pointing limit") != std::string::npos) return pointed(zone_with(outer, false));
    return false;
  }

 private:
  [[nodiscard]] const face_gear::FaceGearZone& zone_with(double radius, bool inner) const {
    const face_gear::FaceGearZone* nearest = &p_.zones.front();
    const auto off = [&](const face_gear::FaceGearZone& z) {
      return std::abs((inner ? z.inner_radius_mm : z.outer_radius_mm) - radius);
    };
    for (const auto& zone : p_.zones)
      if (off(zone) < off(*nearest)) nearest = &zone;
    return *nearest;
  }
  /// A normal of the involute has the moment r_b cos(base helix) about the shaper's axis, and N_2 / N_s of it about the
  /// gear's; no unit vector has more than its distance.
  [[nodiscard]] double base_radius(const face_gear::FaceGearZone& zone) const {
    const double base = 0.5 * p_.module_mm * p_.shaper_teeth * std::cos(p_.pressure_angle_rad);
    return base * BruteForceFaceGear(p_, zone.helix_angle_rad).cos_base_helix() * p_.teeth / p_.shaper_teeth;
  }
  /// The fillet as it would begin at the inner radius is cut away by the shaper in another position, or there is none.
  [[nodiscard]] bool undercut(const face_gear::FaceGearZone& zone, int side) const {
    const auto surface = face_gear::make_surface<double>(p_, zone.helix_angle_rad);
    const BruteForceFaceGear sweep(p_, zone.helix_angle_rad);
    const double start = surface.shaper.A_t + 1e-9;
    for (const auto& flank : face_gear::zone_limits(surface, p_.module_mm).flanks) {
      if (flank.side != side || !flank.undercut_radius) continue;
      const double cusp = surface.flank_Z(side, surface.shaper.theta_t, *flank.undercut_B);
      const double below = zone.inner_radius_mm - *flank.undercut_radius;
      const auto z = face_gear::fillet_Z_at_radius(surface, side, start, zone.inner_radius_mm, cusp + below);
      return !z || sweep.least_clearance(surface.fillet(side, start, *z).p) < -1e-7;
    }
    return false;
  }
  /// No place of the tip surface at the outer radius is left.
  [[nodiscard]] bool pointed(const face_gear::FaceGearZone& zone) const {
    const auto surface = face_gear::make_surface<double>(p_, zone.helix_angle_rad);
    const BruteForceFaceGear sweep(p_, zone.helix_angle_rad);
    const double r = zone.outer_radius_mm;
    for (int k = 0; k < 400; ++k) {
      const double azimuth = surface.pitch * k / 400;
      if (sweep.least_clearance({r * std::cos(azimuth), r * std::sin(azimuth), surface.z_tip(r)}) > 0) return false;
    }
    return true;
  }

  const face_gear::FaceGearParameters& p_;
};

void expect_refused_for_a_reason(const Trial& run) {
  const auto job = job::parse_job(run.job, "job.toml");
  ASSERT_TRUE(job) << to_text(job.error());
  ASSERT_NE(job.value().face_gear(), nullptr) << to_text(run.outcome.errors) << run.job;
  const FaceRefusals refusals(*job.value().face_gear());
  ASSERT_FALSE(run.outcome.errors.empty());
  for (const Diagnostic& error : run.outcome.errors) {
    EXPECT_EQ(error.kind, DiagnosticKind::refused_input);
    EXPECT_TRUE(refusals.confirm(error.message)) << error.text() << "\n" << run.job;
  }
}

void expect_verified(const Trial& run, const std::string& out) {
  const auto report = nlohmann::json::parse(run.outcome.report_json);
  EXPECT_EQ(report["verified"], true) << report["reasons"] << "\n" << run.job;
  const auto& gouge = report["gouge_um"];
  EXPECT_LE(gouge["measured"].get<double>(), gouge["bound"].get<double>()) << run.job;
  EXPECT_LE(gouge["bound"].get<double>(), gouge["tolerance"].get<double>()) << run.job;
  const auto& clearance = report["clearance"];
  EXPECT_GE(clearance["least"].get<double>(), clearance["required"].get<double>()) << run.job;
  if (!clearance["measured"].is_null()) {
    EXPECT_GE(clearance["measured"].get<double>(), clearance["least"].get<double>()) << run.job;
  }
  for (const auto& [source, entry] : report["ledger"].items())
    if (source != "deflection") {  // a model: nothing measures it
      EXPECT_LE(entry["measured"].get<double>(), entry["predicted"].get<double>()) << source << "\n" << run.job;
    }
  EXPECT_EQ(report["program"]["sha256"], sha256_hex(file_text(out + "/program.ngc")));
}

class RandomJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomJobs, AreVerifiedOrRefusedForAReason) {
  const TestDir dir;
  const Trial run = run_in(dir, "out", GetParam());
  EXPECT_EQ(std::filesystem::exists(dir / "out/program.ngc"), run.outcome.exit_code == app::ExitCode::ok);
  if (run.outcome.exit_code == app::ExitCode::refused) expect_refused_for_a_reason(run);
  else expect_verified(run, dir / "out");
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomJobs, ::testing::Range(0, kFaceJobs + kBevelJobs));

// What confirms a refusal denies a wrong one: those of a gear that can be made.
TEST(RandomJobsJudge, DeniesRefusalsOfAGoodGear) {
  const auto job = job::parse_job(file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml"), "job.toml");
  ASSERT_TRUE(job);
  const FaceRefusals refusals(*job.value().face_gear());
  for (const char* message :
       {"shaper tip rounding 0.6000 mm is too large: the full round tip has 0.5000 mm",
        "inner_radius = 60.0000 mm lies inside the undercut limit R1c = 61.0000 mm of flank side +1",
        "inner_radius = 60.0000 mm is not above the gear's base radius 61.0000 mm: no flank",
        "outer_radius = 65.0000 mm exceeds the pointing limit R2 = 64.0000 mm", "no"})
    EXPECT_FALSE(refusals.confirm(message)) << message;
}

class RandomThreads : public ::testing::TestWithParam<int> {};

TEST_P(RandomThreads, OneAndEightGiveTheSameBytes) {
  const TestDir dir;
  for (const int threads : {1, 8}) {
    const Trial run = on_threads(threads, [&] { return run_in(dir, std::to_string(threads), GetParam()); });
    ASSERT_EQ(run.outcome.exit_code, app::ExitCode::ok) << to_text(run.outcome.errors) << run.job;
  }
  for (const char* name : {"program.ngc", "cl.csv", "gear.stl", "inspection.csv", "setup.html", "tooth.vtp"})
    EXPECT_EQ(file_text(dir / (std::string("1/") + name)), file_text(dir / (std::string("8/") + name))) << name;
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomThreads, ::testing::Values(0, 1, kFaceJobs));

}  // namespace
}  // namespace toothpath::test
