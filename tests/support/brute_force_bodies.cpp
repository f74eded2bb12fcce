#include "tests/support/brute_force_bodies.h"

#include <algorithm>
#include <cmath>

namespace toothpath::test {
namespace {

Vec3 turned(const Vec3& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
}
Vec3 tip_of(const path::ToolMotion& m, double t) { return (1 - t) * m.tip_from + t * m.tip_to; }
Vec3 axis_of(const path::ToolMotion& m, double t) { return ((1 - t) * m.axis_from + t * m.axis_to).normalized(); }

double to_segment(const Vec2& q, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double t = d.squaredNorm() > 0 ? std::clamp((q - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (q - a - t * d).norm();
}

/// q = (radius, height). Places farther than half a millimetre are told as that.
double depth_below_meridian(const Vec2& q, const BruteBody& b) {
  constexpr double kFar = 0.5;
  const auto& m = b.meridian;
  if (q.y() < b.from - kFar || q.y() > b.to + kFar || q.x() > std::max(b.radius_from, b.radius_to) + kFar) return -kFar;
  double least = to_segment(q, Vec2(0, m.back()[0]), Vec2(m.back()[1], m.back()[0])), wide = -1;
  for (std::size_t k = 1; k < m.size(); ++k) {
    const Vec2 low(m[k - 1][1], m[k - 1][0]), high(m[k][1], m[k][0]);
    least = std::min(least, to_segment(q, low, high));
    if (q.y() > low.y() && q.y() <= high.y())
      wide = low.x() + (high.x() - low.x()) * (q.y() - low.y()) / (high.y() - low.y());
  }
  return q.x() < wide ? least : -least;
}

}  // namespace

BruteBody brute_body(std::vector<Vec2> meridian) {
  double widest = 0;
  for (const Vec2& p : meridian) widest = std::max(widest, p[1]);
  const double low = meridian.front()[0], high = meridian.back()[0];
  return {low, high, widest, widest, false, std::move(meridian)};
}

double depth_in_body(const Vec3& p, const BruteBody& b, const Vec3& tip, const Vec3& axis) {
  const double h = (p - tip).dot(axis);
  const Vec2 q((p - tip - h * axis).norm(), h);
  if (!b.meridian.empty()) return depth_below_meridian(q, b);
  if (b.round) return b.radius_from - to_segment(q, Vec2(0, b.from), Vec2(0, b.to));
  const Vec2 lower(b.radius_from, b.from), upper(b.radius_to, b.to);
  const double border = std::min(
      {to_segment(q, Vec2(0, b.from), lower), to_segment(q, lower, upper), to_segment(q, upper, Vec2(0, b.to))});
  const double wide = b.radius_from + (b.radius_to - b.radius_from) * (h - b.from) / (b.to - b.from);
  const bool inside = h > b.from && h < b.to && q.x() < wide;
  return inside ? border : -border;
}

BruteForceBodies::BruteForceBodies(const face_gear::FaceGear& gear, int rows, int columns)
    : gear_(gear), solid_(gear, 20, 20) {
  const int zones = int(gear.rings().size());
  for (int zone = 0; zone < zones; ++zone)
    for (int patch = 0; patch < 9; ++patch) {
      if (patch == 8 && zone + 1 == zones) continue;
      for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
          const double x = double(i) / rows, y = double(j) / columns;
          samples_.push_back({solid_.point(zone, patch, x, y), zone, patch, x, y});
        }
    }
}

std::vector<BruteDepth> BruteForceBodies::seeds(const BruteBody& body, const path::ToolMotion& m, int moments) const {
  // The teeth near the lower part of the tool; a body that leans reaches farther.
  const double pitch = gear_.pitch();
  const Vec3 low = tip_of(m, 0.5) + body.from * axis_of(m, 0.5);
  const double r = low.head<2>().norm(),
               reach = std::max(body.radius_from, body.radius_to) + 4 + (m.tip_to - m.tip_from).norm();
  const int middle = int(std::lround(std::atan2(low.y(), low.x()) / pitch)),
            wide = 2 + int(std::ceil(reach / (pitch * std::max(r, 1.0))));
  std::vector<BruteDepth> seeds;
  for (int tooth = middle - wide; tooth <= middle + wide; ++tooth)
    for (int k = 0; k <= moments; ++k) {
      const double t = double(k) / moments;
      const Vec3 tip = turned(tip_of(m, t), -tooth * pitch), axis = turned(axis_of(m, t), -tooth * pitch);
      std::array<BruteDepth, 18> best{};  // of every zone and patch: one start each
      for (const Sample& s : samples_) {
        const double d = depth_in_body(s.p, body, tip, axis);
        auto& b = best[std::size_t(s.zone * 9 + s.patch)];
        if (d > b.depth) b = {d, Vec3::Zero(), tooth, s.zone, s.patch, s.x, s.y, t};
      }
      for (const auto& b : best)
        if (b.depth > -0.5) seeds.push_back(b);
    }
  std::sort(seeds.begin(), seeds.end(), [](const BruteDepth& a, const BruteDepth& b) { return a.depth > b.depth; });
  return seeds;
}

BruteDepth BruteForceBodies::sampled(const BruteBody& body, const path::ToolMotion& m, int moments) const {
  const auto all = seeds(body, m, moments);
  return all.empty() ? BruteDepth{} : all.front();
}

BruteDepth BruteForceBodies::deepest(const BruteBody& body, const path::ToolMotion& m, int moments,
                                     std::size_t most_starts) const {
  const auto all = seeds(body, m, moments);
  if (all.empty()) return {};
  // The best few, of different patches and teeth first.
  std::vector<BruteDepth> starts;
  for (const auto& s : all) {
    if (starts.size() >= most_starts || s.depth < all.front().depth - 0.1) break;
    const auto same = [&](const BruteDepth& o) {
      return o.tooth == s.tooth && o.zone == s.zone && o.patch == s.patch &&
             std::abs(o.x - s.x) + std::abs(o.y - s.y) < 0.3;
    };
    if (std::none_of(starts.begin(), starts.end(), same)) starts.push_back(s);
  }
  BruteDepth out;
  for (const auto& s : starts)
    if (const auto better = improved(body, m, s); better.depth > out.depth) out = better;
  return out;
}

BruteDepth BruteForceBodies::improved(const BruteBody& body, const path::ToolMotion& m, BruteDepth best,
                                      double first_step) const {
  const double pitch = gear_.pitch();
  const auto at = [&](double x, double y, double t) {
    BruteDepth d = best;
    d.x = std::clamp(x, 0.0, 1.0);
    d.y = std::clamp(y, 0.0, 1.0);
    d.t = std::clamp(t, 0.0, 1.0);
    d.place = turned(solid_.point(best.zone, best.patch, d.x, d.y), best.tooth * pitch);
    d.depth = depth_in_body(d.place, body, tip_of(m, d.t), axis_of(m, d.t));
    return d;
  };
  best = at(best.x, best.y, best.t);
  for (double step = first_step; step > 2e-6;) {
    BruteDepth next = best;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          if (i == 0 && j == 0 && k == 0) continue;
          const auto d = at(best.x + i * step, best.y + j * step, best.t + k * step);
          if (d.depth > next.depth) next = d;
        }
    if (next.depth > best.depth + 1e-9) best = next;
    else step *= 0.5;
  }
  return best;
}

}  // namespace toothpath::test
