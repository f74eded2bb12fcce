// What a finished gear is said to keep at most, against a judge that shares nothing with the measurement: the solid
// shaper swept past points, and the ball on its straight ways.
#include <cstdio>
#include <functional>

#include "cam/cut/cut_surface.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_face_gear.h"
#include "tests/support/threads.h"

namespace toothpath {
namespace {

constexpr int kCuspJobs = 3, kCuspPlaces = 160, kFollowed = 6;
constexpr double kJudgeSlack = 2e-5;  // mm: of the judge itself

/// A short ring that one ball finishes with high cusps; a ball that fits everywhere.
struct CuspJob {
  face_gear::FaceGearParameters gear;
  double ball = 0, scallop = 0, chord = 0;
};

CuspJob random_cusp_job(test::Random& random) {
  CuspJob a;
  auto& g = a.gear;
  g.teeth = 30 + int(random.index(60));
  g.shaper_teeth = std::max(17, int(g.teeth * random(0.2, 0.4)));
  g.module_mm = random(1, 3);
  g.module_plane = face_gear::ModulePlane::transverse;
  g.pressure_angle_rad = radians(random(19, 25));
  g.shaft_angle_rad = random(0, 1) < 0.5 ? radians(90) : radians(random(80, 100));
  g.offset_mm = random(0, 1) < 0.5 ? 0 : random(-1, 1) * g.module_mm;
  g.shaper_tip_radius_mm = random(0.2, 0.28) * g.module_mm;
  const double helix = random(0, 1) < 0.5 ? 0 : radians(random(-20, 20));
  const double middle = 0.5 * g.module_mm * g.teeth *
                        (1 + double(g.shaper_teeth) / g.teeth * std::cos(g.shaft_angle_rad)) /
                        std::sin(g.shaft_angle_rad);
  const double inner = middle + random(0, 0.5) * g.module_mm;
  g.zones = {{helix, inner, inner + random(0.4, 0.8) * g.module_mm}};
  a.ball = random(0.5, 0.8) * g.shaper_tip_radius_mm;
  a.scallop = std::min(random(0.01, 0.04), 0.15 * a.ball);
  a.chord = random(5e-4, 3e-3);
  return a;
}

class CuspJudge {
 public:
  /// @param z_tip  of the blank, at a radius
  CuspJudge(const CuspJob& asked, const std::vector<path::ToolMotion>& motions, std::function<double(double)> z_tip)
      : gear_(asked.gear),
        ball_(asked.ball),
        z_tip_(std::move(z_tip)),
        solid_(asked.gear, asked.gear.zones.front().helix_angle_rad) {
    for (const auto& m : motions)
      if (!m.rapid) ways_.emplace_back(m.tip_from + ball_ * m.axis_from, m.tip_to + ball_ * m.axis_to);
  }

  /// Most that stands above the surface along its normal, of places between two azimuths: random ones first, then
  /// uphill from the highest.
  [[nodiscard]] double highest(test::Random& random) const {
    struct Place {
      double azimuth, radius, height;
    };
    const auto& zone = gear_.zones.front();
    const auto at = [&](double azimuth, double radius) {
      return Place{azimuth, radius,
                   radius < zone.inner_radius_mm || radius > zone.outer_radius_mm ? -1 : stands(azimuth, radius)};
    };
    std::vector<Place> places;
    for (int k = 0; k < kCuspPlaces; ++k) {
      const auto& way = ways_[random.index(ways_.size())];
      const Vec3& near = way.first;
      const double radius = random(zone.inner_radius_mm, zone.outer_radius_mm);
      places.push_back(at(std::atan2(near.y(), near.x()) + random(-1, 1) * ball_ / radius, radius));
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.height > b.height; });
    double most = 0;
    for (int k = 0; k < kFollowed; ++k) {
      Place here = places[std::size_t(k)];
      for (double step = 0.1 * ball_; step > 2e-4;) {
        const Place before = here;
        for (const auto& [across, along] : {std::pair(step, 0.0), {-step, 0.0}, {0.0, step}, {0.0, -step}})
          if (const Place next = at(before.azimuth + across / before.radius, before.radius + along);
              next.height > here.height)
            here = next;
        if (here.height == before.height) step *= 0.5;
      }
      most = std::max(most, here.height);
    }
    return most;
  }

 private:
  [[nodiscard]] double material(const Vec3& p) const { return solid_.least_clearance(p) * solid_.cos_base_helix(); }

  /// Height of the ball's envelope above the surface at this azimuth and radius, along the normal; -1 where there is
  /// no space below the tip.
  [[nodiscard]] double stands(double azimuth, double radius) const {
    const auto place = [&](double z) { return Vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), z); };
    double free = z_tip_(radius), full = free - 2.4 * gear_.module_mm;
    double at_free = material(place(free)), at_full = material(place(full));
    if (at_free >= 0 || at_full <= 0) return -1;
    double z = free;
    for (int k = 0, kept = 0; k < 60 && free - full > 1e-8; ++k) {  // false position, the end that stays halved
      z = (free * at_full - full * at_free) / (at_full - at_free);
      const double m = material(place(z));
      if (std::abs(m) < 1e-9) break;
      const int side = m < 0 ? 1 : -1;
      (m < 0 ? free : full) = z;
      (m < 0 ? at_free : at_full) = m;
      if (side == kept) (m < 0 ? at_full : at_free) *= 0.5;
      kept = side;
    }
    const Vec3 p = place(z);
    constexpr double kAside = 1e-4;
    Vec3 out;
    for (int k = 0; k < 3; ++k) out[k] = material(p - kAside * Vec3::Unit(k)) - material(p + kAside * Vec3::Unit(k));
    out.normalize();
    double height = 0;
    for (double step = INFINITY; step > 1e-7 && height < 1; height += std::max(0.0, step))
      step = to_ball(p + height * out);
    return height;
  }
  [[nodiscard]] double to_ball(const Vec3& p) const {
    double least = INFINITY;
    for (const auto& [from, to] : ways_) {
      const Vec3 way = to - from;
      const double t = way.isZero() ? 0 : std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (from + t * way - p).squaredNorm());
    }
    return std::sqrt(least) - ball_;
  }

  face_gear::FaceGearParameters gear_;
  double ball_;
  std::function<double(double)> z_tip_;
  test::BruteForceFaceGear solid_;
  std::vector<std::pair<Vec3, Vec3>> ways_;
};

TEST(LeftBound, HoldsAtHighCuspsOfRandomGears) {
  int done = 0;
  for (std::uint64_t seed = 1; seed < 40 && done < kCuspJobs; ++seed) {
    test::Random random(seed);
    const CuspJob asked = random_cusp_job(random);
    if (auto made = face_gear::FaceGear::make(asked.gear); made.refused()) continue;
    const auto tool =
        test::ball_mill(2 * asked.ball, 3 * asked.gear.module_mm, 1.9 * asked.ball, 5 * asked.gear.module_mm, 10);
    const auto job = test::planned(asked.gear, {tool}, {test::finishing(0, asked.scallop, asked.chord)});
    const auto motions = job.motions();
    const auto cut =
        test::on_threads(4, [&] { return cut::measure_cut_surface(*job.part, motions, job.operations, job.tools); });
    const auto& surface = job.gear.rings().front().surface;
    const double highest = CuspJudge(asked, motions, [&](double r) { return surface.z_tip(r); }).highest(random);
    std::printf("seed %2d: ball %.3f mm, scallop %.2f um: left %.2f um measured, %.2f um bound, the judge sees %.2f\n",
                int(seed), asked.ball, 1e3 * asked.scallop, 1e3 * cut.finished.max_mm, 1e3 * cut.finished.bound_mm,
                1e3 * highest);
    EXPECT_LE(highest, cut.finished.bound_mm + kJudgeSlack) << seed;
    EXPECT_GT(highest, 0.9 * asked.scallop) << "the judge does not find the cusps, seed " << seed;
    ++done;
  }
  EXPECT_EQ(done, kCuspJobs);
}

}  // namespace
}  // namespace toothpath
