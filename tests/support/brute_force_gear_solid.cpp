#include "tests/support/brute_force_gear_solid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/face_gear/inverse.h"

namespace toothpath::test {
namespace {

constexpr int kPatches = 9;

double lookup(const std::vector<double>& y, double share) {
  const double t = std::clamp(share, 0.0, 1.0) * double(y.size() - 1);
  const auto k = std::min(std::size_t(t), y.size() - 2);
  return y[k] + (t - double(k)) * (y[k + 1] - y[k]);
}

Vec3 about_z(const Vec3& p, double angle) { return turned(p, angle); }
double azimuth(const Vec3& p) { return std::atan2(p.y(), p.x()); }

/// Section Z whose root circle has radius r.
double root_section(const face_gear::FaceGearSurface<double>& f, double r) {
  double lo = 1e-3, hi = 4 * r;
  for (int k = 0; k < 200 && hi - lo > 1e-14 * r; ++k) {
    const double m = 0.5 * (lo + hi);
    (f.root_meridian(m).p.head<2>().norm() < r ? lo : hi) = m;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

const char* BruteForceGearSolid::name(int patch) {
  static const char* names[kPatches] = {"flank +1", "fillet +1", "root",      "fillet -1", "flank -1",
                                        "tip",      "inner end", "outer end", "groove"};
  return names[patch];
}

BruteForceGearSolid::BruteForceGearSolid(const face_gear::FaceGear& gear, int rows, int columns)
    : gear_(gear), rows_(rows), columns_(columns), pitch_(gear.pitch()) {
  for (const auto& source : gear.rings()) {
    Ring ring{source, source.zone.inner_radius_mm, source.zone.outer_radius_mm, {}, {}, {}, {}, {}, {}};
    const auto& f = source.surface;
    std::optional<face_gear::FlankCoordinates> last[2];
    for (int k = 0; k < kTable; ++k) {
      const double r = ring.r_in + (ring.r_out - ring.r_in) * k / (kTable - 1);
      for (int n = 0; n < 2; ++n) {
        const int side = n == 0 ? 1 : -1;
        last[n] = face_gear::invert_flank(f, side, r, f.z_tip(r), last[n]);
        if (!last[n]) throw std::runtime_error("the flank does not reach the tip");
        ring.theta_tip[n].push_back(last[n]->theta);
        ring.B_mid[n].push_back(last[n]->B);
        ring.az_tip[n].push_back(face_gear::flank_azimuth(f, side, *last[n]) + (n == 0 ? 0 : pitch_));
      }
      ring.Z_root.push_back(root_section(f, r));
    }
    rings_.push_back(std::move(ring));
  }
  for (auto& ring : rings_) {
    ring.profile[0] = profile_at(ring, ring.r_in, 10000);
    ring.profile[1] = profile_at(ring, ring.r_out, 10000);
    for (int patch = 0; patch < kPatches; ++patch) {
      std::vector<Vec3> s;
      if (patch != 8 || &ring != &rings_.back())
        for (int i = 0; i <= rows_; ++i)
          for (int j = 0; j <= columns_; ++j) s.push_back(at(ring, patch, double(i) / rows_, double(j) / columns_));
      ring.samples.push_back(std::move(s));
    }
  }
}

std::vector<Vec2> BruteForceGearSolid::profile_at(const Ring& ring, double r, int count) const {
  std::vector<Vec2> out;
  const double y = (r - ring.r_in) / (ring.r_out - ring.r_in);
  for (int patch = 0; patch < 5; ++patch)
    for (int k = 0; k <= count / 5; ++k) {
      const Vec3 p = at(ring, patch, 5.0 * k / count, y);
      double a = azimuth(p);
      if (!out.empty()) a = out.back().x() + std::remainder(a - out.back().x(), 6.283185307179586);
      out.push_back({a, p.z()});
    }
  return out;
}

Vec3 BruteForceGearSolid::at(const Ring& ring, int patch, double x, double y) const {
  const auto& f = ring.ring.surface;
  const auto& w = f.shaper;
  const double r = ring.r_in + y * (ring.r_out - ring.r_in);
  switch (patch) {
    case 0:
    case 4: {
      const int n = patch == 0 ? 0 : 1, side = n == 0 ? 1 : -1;
      const double share = patch == 0 ? x : 1 - x;  // from the tip to the fillet
      const double tip = lookup(ring.theta_tip[n], y), theta = tip + share * (w.theta_t - tip);
      const auto B = face_gear::flank_B_at_radius(f, side, theta, r, lookup(ring.B_mid[n], y));
      if (!B) throw std::runtime_error("the flank ends inside the ring");
      return about_z(f.flank(side, theta, *B).p, n == 0 ? 0.0 : pitch_);
    }
    case 1:
    case 3: {
      const int side = patch == 1 ? 1 : -1;
      const double share = patch == 1 ? x : 1 - x;
      const double A = w.A_t + share * (w.A_e - w.A_t);
      const auto Z = face_gear::fillet_Z_at_radius(f, side, A, r, lookup(ring.Z_root, y));
      if (!Z) throw std::runtime_error("the fillet ends inside the ring");
      return about_z(f.fillet(side, A, *Z).p, patch == 1 ? 0.0 : pitch_);
    }
    case 2: {
      const double Z = root_section(f, r), a = f.root_edge_azimuth(1, Z), b = f.root_edge_azimuth(-1, Z);
      const Vec3 m = f.root_meridian(Z).p;
      const double to = a + x * (b - a);
      return {r * std::cos(to), r * std::sin(to), m.z()};
    }
    case 5: {
      const double a = lookup(ring.az_tip[1], y) - pitch_, b = lookup(ring.az_tip[0], y), to = a + x * (b - a);
      return {r * std::cos(to), r * std::sin(to), f.z_tip(r)};
    }
    case 6:
    case 7: {
      // x: azimuth over one pitch from the land of tooth 0; y: depth below the surface.
      const double r_end = patch == 6 ? ring.r_in : ring.r_out;
      const auto& profile = ring.profile[patch == 6 ? 0 : 1];
      const double land = profile.back().x() - pitch_, a = land + x * pitch_;
      double z = f.z_tip(r_end);
      if (a > profile.front().x()) {
        const auto it = std::lower_bound(profile.begin() + 1, profile.end() - 1, a,
                                         [](const Vec2& q, double v) { return q.x() < v; });
        const Vec2 &p0 = *(it - 1), &p1 = *it;
        z = p1.x() > p0.x() ? p0.y() + (a - p0.x()) / (p1.x() - p0.x()) * (p1.y() - p0.y()) : p1.y();
      }
      return {r_end * std::cos(a), r_end * std::sin(a), z - 3 * y * w.h_f};
    }
    default: {
      const auto& next = rings_[std::size_t(&ring - rings_.data()) + 1];
      const double rr = ring.r_out + y * (next.r_in - ring.r_out), a = (x - 0.5) * 2 * pitch_;
      return {rr * std::cos(a), rr * std::sin(a), gear_.groove_floor()};
    }
  }
}

Vec3 BruteForceGearSolid::point(int zone, int patch, double x, double y) const {
  return at(rings_[std::size_t(zone)], patch, x, y);
}

Vec3 BruteForceGearSolid::normal(int zone, int patch, double x, double y) const {
  const double h = 1e-5;
  const double x0 = std::max(x - h, 0.0), x1 = std::min(x + h, 1.0), y0 = std::max(y - h, 0.0),
               y1 = std::min(y + h, 1.0);
  const Vec3 dx = point(zone, patch, x1, y) - point(zone, patch, x0, y),
             dy = point(zone, patch, x, y1) - point(zone, patch, x, y0);
  Vec3 n = dx.cross(dy).normalized();
  if (patch == 6 || patch == 7) {
    const Vec3 p = point(zone, patch, x, y);
    const Vec3 out(p.x(), p.y(), 0);
    return patch == 6 ? Vec3(-out.normalized()) : out.normalized();
  }
  if (n.z() < 0) n = -n;  // every working surface, the lands and the floor look upwards
  return n;
}

bool BruteForceGearSolid::inside(const Vec3& c) const {
  const double r = c.head<2>().norm();
  for (std::size_t k = 0; k < rings_.size(); ++k) {
    const auto& ring = rings_[k];
    if (k + 1 < rings_.size() && r > ring.r_out && r < rings_[k + 1].r_in) return c.z() < gear_.groove_floor();
    if (r < ring.r_in || r > ring.r_out) continue;
    if (c.z() >= ring.ring.surface.z_tip(r)) return false;
    const auto profile = profile_at(ring, r, 1500);
    const double mid = 0.5 * (profile.front().x() + profile.back().x());
    const double a = mid + std::remainder(azimuth(c) - mid, pitch_);
    if (a <= profile.front().x() || a >= profile.back().x()) return true;
    const auto it =
        std::lower_bound(profile.begin() + 1, profile.end() - 1, a, [](const Vec2& q, double v) { return q.x() < v; });
    const Vec2 &p0 = *(it - 1), &p1 = *it;
    const double t = p1.x() > p0.x() ? (a - p0.x()) / (p1.x() - p0.x()) : 0.5;
    return c.z() < p0.y() + t * (p1.y() - p0.y());
  }
  return false;
}

BruteNearest BruteForceGearSolid::nearest(const Vec3& asked) const {
  struct Seed {
    double d;
    std::size_t zone;
    int patch, i, j, turn;
  };
  std::vector<Seed> seeds;
  double best_sample = INFINITY;
  const double about = azimuth(rings_[0].samples[2][std::size_t(columns_ / 2)]);
  const int nearest_pitch = int(std::lround(std::remainder(azimuth(asked) - about, 6.283185307179586) / pitch_));
  for (int turn = nearest_pitch - 1; turn <= nearest_pitch + 1; ++turn) {
    const Vec3 c = about_z(asked, -turn * pitch_);
    for (std::size_t zone = 0; zone < rings_.size(); ++zone) {
      for (int patch = 0; patch < kPatches; ++patch) {
        const auto& s = rings_[zone].samples[std::size_t(patch)];
        if (s.empty()) continue;
        const auto d2 = [&](int i, int j) { return (s[std::size_t(i * (columns_ + 1) + j)] - c).squaredNorm(); };
        for (int i = 0; i <= rows_; ++i)
          for (int j = 0; j <= columns_; ++j) {
            const double d = d2(i, j);
            if (d > 4 * best_sample + 0.5) continue;
            const bool least = (i == 0 || d <= d2(i - 1, j)) && (i == rows_ || d <= d2(i + 1, j)) &&
                               (j == 0 || d <= d2(i, j - 1)) && (j == columns_ || d <= d2(i, j + 1));
            if (!least) continue;
            best_sample = std::min(best_sample, d);
            seeds.push_back({d, zone, patch, i, j, turn});
          }
      }
    }
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) { return a.d < b.d; });
  BruteNearest best;
  const double slack = 0.2;  // the step between samples
  for (const auto& seed : seeds) {
    if (std::sqrt(seed.d) > best.distance + slack) break;
    const auto& ring = rings_[seed.zone];
    const Vec3 c = about_z(asked, -seed.turn * pitch_);
    // Coordinate search with a step of its own in each direction: a root land may be a thousand times longer than wide.
    double at_xy[2] = {double(seed.i) / rows_, double(seed.j) / columns_}, step[2] = {0.5 / rows_, 0.5 / columns_};
    Vec3 foot = at(ring, seed.patch, at_xy[0], at_xy[1]);
    double d = (foot - c).norm();
    for (int round = 0; round < 300 && std::max(step[0], step[1]) > 1e-9; ++round) {
      for (int axis = 0; axis < 2; ++axis) {
        bool moved = false;
        for (const double sense : {1.0, -1.0}) {
          double to[2] = {at_xy[0], at_xy[1]};
          to[axis] = std::clamp(to[axis] + sense * step[axis], 0.0, 1.0);
          const Vec3 q = at(ring, seed.patch, to[0], to[1]);
          const double e = (q - c).norm();
          if (e >= d) continue;
          d = e;
          foot = q;
          at_xy[axis] = to[axis];
          moved = true;
          break;
        }
        step[axis] = moved ? std::min(2 * step[axis], 0.1) : 0.5 * step[axis];
        step[axis] = std::max(step[axis], 2e-10);
      }
    }
    if (d < best.distance) best = {d, name(seed.patch), about_z(foot, seed.turn * pitch_)};
  }
  return best;
}

}  // namespace toothpath::test
