// Random face gears in turn in every form of output, judged by what shares nothing with the program: own reading of the
// text, own kinematics of the machine, and the solid shaper swept past points. The ball may cut into nothing, and must
// have been wherever a flank is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/job/file.h"
#include "tests/app/judged.h"
#include "tests/app/refusals.h"
#include "tests/support/brute_force_face_gear.h"
#include "tests/support/random_jobs.h"

namespace toothpath::test {
namespace {

constexpr int kMotions = 250, kPlaces = 3, kDirections = 40, kFlankPoints = 24;
constexpr double kSlack = 2e-4;  // mm: of the judge itself

struct JudgedGear {
  face_gear::FaceGearParameters gear;
  double ball = 0, tolerance = 0, scallop = 0, chord = 0;
  std::vector<BruteForceFaceGear> swept;  // one a ring

  [[nodiscard]] double tip() const { return -gear.module_mm * (0.5 * gear.shaper_teeth - gear.addendum_coefficient); }
  /// How deep a place lies in what must remain; at most 0 outside of it, and where it is not above `most` any less.
  [[nodiscard]] double depth(const Vec3& p, double most) const {
    const double r = std::hypot(p.x(), p.y());
    if (p.z() > tip()) return 0;
    for (std::size_t n = 0; n < swept.size(); ++n)
      if (r > gear.zones[n].inner_radius_mm && r < gear.zones[n].outer_radius_mm)
        return std::min({swept[n].least_clearance(p, most / swept[n].cos_base_helix()) * swept[n].cos_base_helix(),
                         tip() - p.z(), r - gear.zones[n].inner_radius_mm, gear.zones[n].outer_radius_mm - r});
    return 0;
  }
};

/// Cutting motions of a program with its gear.
struct Judged {
  JudgedGear gear;
  JudgedPath path;
  std::vector<MachineMove> cuts;

  [[nodiscard]] Vec3 centre(const MachineMove& cut, double t) const {
    const ToolPlace place = path.at(cut, t);
    return place.tip + gear.ball * place.axis;
  }
};

/// Deepest that a ball of this radius was found in the gear, over random cuts.
double deepest(const Judged& judged, double ball, std::uint64_t seed) {
  Random random(seed);
  double most = 0;
  for (int k = 0; k < kMotions; ++k) {
    const MachineMove& cut = judged.cuts[random.index(judged.cuts.size())];
    for (int n = 0; n < kPlaces; ++n) {
      const Vec3 centre = judged.centre(cut, random(0, 1));
      for (int d = 0; d < kDirections; ++d) {
        Vec3 out = random.vector(1);
        out.z() = -std::abs(out.z());
        most = std::max(most, judged.gear.depth(centre + ball * out.normalized(), most));
      }
    }
  }
  return most;
}

/// Most that stands on flanks of the first space: places where the swept shaper ends, and the nearest ball centre.
double standing(const Judged& judged, std::uint64_t seed) {
  const JudgedGear& g = judged.gear;
  const auto& cuts = judged.cuts;
  Random random(seed);
  std::vector<std::pair<Vec3, Vec3>> way;                                    // straight pieces of the way of the ball
  for (std::size_t k = 0; k < cuts.size() / std::size_t(g.gear.teeth); ++k)  // every space has as many
    for (int n = 0; n < 4; ++n)
      way.emplace_back(judged.centre(cuts[k], n / 4.0), judged.centre(cuts[k], (n + 1) / 4.0));
  double most = 0;
  int found = 0;
  for (int trial = 0; trial < 40 * kFlankPoints && found < kFlankPoints; ++trial) {
    const std::size_t n = random.index(g.swept.size());
    const auto& zone = g.gear.zones[n];
    const double r = random(zone.inner_radius_mm + 0.02, zone.outer_radius_mm - 0.02),
                 z = g.tip() - random(0.1, 0.9) * g.gear.module_mm;
    // From the middle of the way, which is in a space, to a place in the tooth beside it.
    const Vec3& start = way[random.index(way.size())].first;
    const double middle = std::atan2(start.y(), start.x()), side = random(0, 1) < 0.5 ? 1 : -1;
    const auto clearance = [&](double azimuth) {
      return g.swept[n].least_clearance({r * std::cos(azimuth), r * std::sin(azimuth), z}, 0);  // its sign alone
    };
    double in = middle, out = middle + side * kPi / g.gear.teeth;
    if (clearance(in) >= 0 || clearance(out) <= 0) continue;
    for (int k = 0; k < 40; ++k) (clearance(0.5 * (in + out)) <= 0 ? in : out) = 0.5 * (in + out);
    const Vec3 p(r * std::cos(in), r * std::sin(in), z);
    double least = INFINITY;
    for (const auto& [a, b] : way) {
      const Vec3 along = b - a;
      const double t = along.isZero() ? 0 : std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (a + t * along - p).norm() - g.ball);
    }
    most = std::max(most, least);
    ++found;
  }
  EXPECT_GE(found, kFlankPoints / 2);
  return most;
}

JudgedGear gear_of(const job::Job& job) {
  JudgedGear g;
  g.gear = *job.face_gear();
  g.ball = job.tools.front().radius_mm();
  g.tolerance = job.verify.gouge_tolerance_mm;
  g.scallop = job.operations.front().scallop_mm;
  g.chord = job.operations.front().chord_tolerance_mm;
  for (const auto& zone : g.gear.zones) g.swept.emplace_back(g.gear, zone.helix_angle_rad);
  return g;
}

TEST(JudgedJobs, CutTheGearAndNothingElseInEveryForm) {
  const int jobs = jobs_asked(10);
  int done = 0;
  for (int seed = 0; seed < 8 * jobs && done < jobs; ++seed) {
    Random random{std::uint64_t(5000 + seed)};
    const OutputForm& form = kForms[std::size_t(done) % std::size(kForms)];
    const std::string text = on_its_machine(random_face_job(random));
    const auto job = job::parse_job(text, "job.toml");
    if (!job || !job.value().face_gear() || job.value().face_gear()->shaft_angle_rad != 0.5 * kPi) continue;
    const JudgedRun run = run_judged(text, form, random);
    SCOPED_TRACE(form.name() + "\n" + text + run.machine_text);
    if (run.outcome.exit_code == app::ExitCode::refused && run.report.is_null()) {
      for (const Diagnostic& error : run.outcome.errors)
        EXPECT_TRUE(refused_for_a_reason(error.message, job.value())) << error.text();
      continue;
    }
    ASSERT_EQ(run.outcome.exit_code, app::ExitCode::ok) << to_text(run.outcome.errors);
    JudgedSetup setup{{3, -2, 120}, false, {{3, -2, 0}, {0, job.value().tools.front().length_mm}}};
    Judged judged{gear_of(job.value()), {run.program, run.machine_text, setup}, {}};
    ASSERT_TRUE(judged.path.faults().empty()) << judged.path.faults().front();
    for (const MachineMove& move : judged.path.moves())
      if (!move.rapid) judged.cuts.push_back(move);
    ASSERT_GT(judged.cuts.size(), 100u);
    const JudgedGear& g = judged.gear;
    const double gouge = deepest(judged, g.ball, 1), planted = deepest(judged, g.ball + 0.02, 1),
                 left = standing(judged, 2), bound = run.report["gouge_um"]["bound"].get<double>(),
                 most_left = run.report["excess_um"]["finished"]["bound"].get<double>();
    std::printf(
        "%2d %-19s z %3d, %6zu cuts: gouge %.2f um, proven %.2f (of a ball 20 um larger %.2f), left %.2f um, proven "
        "%.2f\n",
        seed, form.name().c_str(), g.gear.teeth, judged.cuts.size(), 1e3 * gouge, bound, 1e3 * planted, 1e3 * left,
        most_left);
    EXPECT_LE(gouge, std::min(g.tolerance, 1e-3 * bound) + kSlack);
    EXPECT_GT(planted, 0.01) << "the judge does not see a ball that is too large";
    EXPECT_LE(left, std::min(g.scallop + g.chord + 2e-3, 1e-3 * most_left + kSlack));
    ++done;
  }
  EXPECT_EQ(done, jobs);
}

}  // namespace
}  // namespace toothpath::test
