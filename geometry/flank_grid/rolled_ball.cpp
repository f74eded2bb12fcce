#include "geometry/flank_grid/rolled_ball.h"

#include <cmath>

namespace toothpath::flank_grid {
namespace {

using D = Dual<double, 2>;

constexpr int kScan = 48;          // places on the way down a flank
constexpr double kDeepest = 0.5;   // of the height below the first row, as far as a contact is sought
constexpr double kClose = 2e-13;   // of a length: cubics leave the curve by no more
constexpr int kMostHalvings = 16;  // of a piece
constexpr double kPiece = 0.5;     // mm, the longest

/// How far the ball that touches the flank here stays above the root, its centre and normal, and where it stands
/// square above the root's meridian.
struct Above {
  D gap, foot;
  Vec3T<D> centre, normal;
};
Above above(const Flank& flank, const Meridian& root, double radius_mm, double u, double v) {
  Above out;
  Vec3T<D> p;
  flank.at<D>(D::variable(u, 0), D::variable(v, 1), p, &out.normal);
  out.centre = p + out.normal * D(radius_mm);
  const D r = sqrt(D(out.centre[0] * out.centre[0] + out.centre[1] * out.centre[1]));
  const D& z = out.centre[2];
  const double x = root.foot({r.v, z.v});
  const auto q = root.place(x), n = root.outwards(x);
  const D height = D(n[0]) * (r - D(q[0])) + D(n[1]) * (z - D(q[1])),
          way = D(n[1]) * (r - D(q[0])) - D(n[0]) * (z - D(q[1]));
  out.gap = height - D(radius_mm);
  // Where the meridian bends, its place moves on by less or more than the centre does, and x by its part along x.
  const double sense = n[1] * root.along[0] - n[0] * root.along[1];
  out.foot = D(x) + way * D(sense / (1 - height.v * root.curvature(x)));
  return out;
}

}  // namespace

std::optional<double> RolledBall::contact(const Flank& flank, const Meridian& root, double radius_mm, double v) {
  constexpr int kHalvings = 60;
  const double height = flank.spline.height(), top = flank.spline.u().back(), step = (1 + kDeepest) * height / kScan;
  const auto gap = [&](double u) { return above(flank, root, radius_mm, u, v).gap.v; };
  if (!(gap(top) > 0)) return {};
  for (int k = 1; k <= kScan; ++k) {
    double high = top - (k - 1) * step, low = top - k * step;
    if (gap(low) > 0) continue;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (low + high);
      (gap(middle) > 0 ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }
  return {};
}

std::optional<RolledBall::Sample> RolledBall::sample(const Flank& flank, const Meridian& root, double radius_mm,
                                                     double v, const Sample* near) {
  constexpr int kSteps = 20;
  std::optional<double> u;
  if (near) {
    // Newton from the neighbour, and only if it stays there.
    double x = near->value[kContact] + (v - near->v) * near->slope[kContact];
    const double begun = x;
    for (int k = 0; k < kSteps && !u; ++k) {
      const Above at = above(flank, root, radius_mm, x, v);
      const double step = at.gap.v / at.gap.d[0];
      if (!(std::abs(x - step - begun) < 0.05 * flank.spline.height())) break;
      x -= step;
      if (std::abs(step) < 1e-14 * (1 + std::abs(x)) + 1e-15 * flank.spline.height()) u = x;
    }
  }
  if (!u) u = contact(flank, root, radius_mm, v);
  if (!u) return {};
  const Above at = above(flank, root, radius_mm, *u, v);
  const double slope = -at.gap.d[1] / at.gap.d[0];
  Sample out;
  out.v = v;
  const auto set = [&](std::size_t k, const D& x) {
    out.value[Eigen::Index(k)] = x.v;
    out.slope[Eigen::Index(k)] = x.d[0] * slope + x.d[1];
  };
  set(kContact, D::variable(*u, 0));
  out.slope[kContact] = slope;
  set(kFoot, at.foot);
  for (std::size_t k = 0; k < 3; ++k) {
    set(kCentre + k, at.centre[int(k)]);
    set(kNormal + k, at.normal[int(k)]);
  }
  if (!out.value.allFinite() || !out.slope.allFinite()) return {};
  return out;
}

bool RolledBall::add(const Flank& flank, const Meridian& root, double radius_mm, const Sample& a, const Sample& b,
                     int halvings) {
  const double h = b.v - a.v;
  const auto middle = sample(flank, root, radius_mm, 0.5 * (a.v + b.v), &a);
  if (!middle) return false;
  const Numbers found = 0.5 * (a.value + b.value) + 0.125 * h * (a.slope - b.slope), off = found - middle->value;
  const double size = middle->value.segment<3>(kCentre).norm();
  if (h > kPiece ||
      (halvings > 0 && !(off.head<kNormal>().norm() < kClose * size && off.tail<3>().norm() < kClose * 100)))
    return add(flank, root, radius_mm, a, *middle, halvings - 1) &&
           add(flank, root, radius_mm, *middle, b, halvings - 1);
  auto& cubics = curve_.add(b.v);
  for (std::size_t k = 0; k < kNumbers; ++k) {
    const auto n = Eigen::Index(k);
    const double d = (b.value[n] - a.value[n]) / h;
    cubics[k] = {a.value[n], a.slope[n], (3 * d - 2 * a.slope[n] - b.slope[n]) / h,
                 (a.slope[n] + b.slope[n] - 2 * d) / (h * h)};
  }
  return true;
}

std::optional<RolledBall> RolledBall::roll(const Flank& flank, const Meridian& root, double radius_mm, double v_from,
                                           double middle, double v_to) {
  // Pieces begin and end where those of the spline do.
  std::vector<double> stations{v_from, v_to, middle};
  // Beside one of these places, which rounding may part from it, none begins: it would have no length.
  const double least = 1e-6 * (v_to - v_from);
  for (const double v : flank.spline.breaks_v())
    if (v > v_from + least && v < v_to - least && std::abs(v - middle) > least) stations.push_back(v);
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  const auto at = std::find(stations.begin(), stations.end(), middle);
  const auto first = sample(flank, root, radius_mm, middle, nullptr);
  if (!first) return {};
  const auto begin = std::size_t(at - stations.begin());
  std::vector<Sample> samples{*first};
  std::size_t low = begin, high = begin;
  while (low > 0) {
    const auto next = sample(flank, root, radius_mm, stations[low - 1], &samples.front());
    if (!next) break;
    samples.insert(samples.begin(), *next);
    --low;
  }
  while (high + 1 < stations.size()) {
    const auto next = sample(flank, root, radius_mm, stations[high + 1], &samples.back());
    if (!next) break;
    samples.push_back(*next);
    ++high;
  }
  if (samples.size() < 2) return {};
  RolledBall out;
  out.curve_.begin(samples.front().v);
  for (std::size_t k = 0; k + 1 < samples.size(); ++k)
    if (!out.add(flank, root, radius_mm, samples[k], samples[k + 1], kMostHalvings)) return {};
  return out;
}

}  // namespace toothpath::flank_grid
