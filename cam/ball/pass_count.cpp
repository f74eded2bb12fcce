#include "cam/ball/pass_count.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/tooth_space/curvature.h"

namespace toothpath::ball {
namespace {

/// Nodes of a profile are divided this often before cusps are measured: the curvature may change within one step-over.
constexpr int kFiner = 4;
constexpr int kCrestSteps = 12;
constexpr double kSameHeight = 1e-3;  // of the asked cusp: both balls leave the same
// Of the asked cusp: room for what lies between the stations.
constexpr double kFlankAim = 0.99, kCornerAim = 0.98;

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto it = std::upper_bound(x.begin(), x.end(), at);
  if (it == x.begin()) return y.front();
  if (it == x.end()) return y.back();
  const auto k = std::size_t(it - x.begin());
  const double t = x[k] > x[k - 1] ? (at - x[k - 1]) / (x[k] - x[k - 1]) : 0;
  return y[k - 1] + t * (y[k] - y[k - 1]);
}

/// More nodes, count and sigma linear between the old ones; a jump over a corner stays a jump.
void divide(std::vector<double>& sigma, std::vector<double>& count) {
  std::vector<double> s{sigma.front()}, c{count.front()};
  for (std::size_t k = 1; k < sigma.size(); ++k) {
    const int parts = count[k] == count[k - 1] ? 1 : kFiner;
    for (int q = 1; q <= parts; ++q) {
      s.push_back(sigma[k - 1] + (sigma[k] - sigma[k - 1]) * q / parts);
      c.push_back(count[k - 1] + (count[k] - count[k - 1]) * q / parts);
    }
  }
  sigma = std::move(s);
  count = std::move(c);
}

}  // namespace

PassLine::PassLine(double place, const tooth_space::SheetPoint& point, const std::optional<Vec3>& before,
                   const std::optional<Vec3>& after)
    : sigma(place), at(point) {
  const Vec3 &c = at.centre, from = before.value_or(c), to = after.value_or(c);
  if (!before || !after) {
    feed = (to - from).normalized();
    return;
  }
  const double back = (c - from).norm(), on = (to - c).norm();
  const Vec3 u = (c - from) / back, v = (to - c) / on;
  bend = (v - u) / (back + on);
  feed = ((back * v + on * u) / (back + on)).normalized();
}

double PassLine::distance(const Vec3& p) const {
  const Vec3 away = p - at.centre;
  // One step of Newton from the foot on the straight line; a pass that bends within a ball radius is taken straight for
  // half of it.
  const double t = away.dot(feed) / std::max(0.5, 1 - 2 * away.dot(bend));
  return (away - t * feed - t * t * bend).norm();
}

PassCount::PassCount(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options, int cusp_rounds)
    : sheet_(sheet), o_(options) {
  count_profiles();
  for (auto& p : profiles_) divide(p.sigma, p.count);
  for (int round = 0; round < cusp_rounds; ++round) sharpen();
}

double PassCount::count_at(std::size_t j, double sigma) const {
  return interpolate(profiles_[j].sigma, profiles_[j].count, sigma);
}
double PassCount::sigma_at(std::size_t j, double count) const {
  return interpolate(profiles_[j].count, profiles_[j].sigma, count);
}

/// Centre spacing across the pass for the asked cusp at a contact point.
double PassCount::spacing(double sigma, const tooth_space::SheetPoint& s, const Vec3& feed) const {
  const Vec3 across = s.contact.n.cross(feed);
  const double k = tooth_space::normal_curvature(s.contact, across);
  const double regular = std::max(1e-6, (1 + k * sheet_.delta()) / (1 + k * o_.allowance_mm));
  return std::sqrt(8 * o_.scallop(sigma) * o_.ball_radius_mm * regular);
}

void PassCount::count_profiles() {
  const auto& stations = sheet_.stations();
  const std::size_t n = stations.size();
  // Direction of the passes: first along constant sigma, then along constant share of the count.
  for (int round = 0; round < 2; ++round) {
    std::vector<Profile> profiles(n);
    std::vector<double> totals(n);
    for (std::size_t j = 0; j < n; ++j) {
      const auto& st = stations[j];
      Profile p;
      double count = 0;
      const tooth_space::OffsetSheet::Node* previous = nullptr;
      double previous_w = 0;
      Vec3 previous_feed = Vec3::Zero();
      for (std::size_t k = 0; k < st.nodes.size(); ++k) {
        const auto& node = st.nodes[k];
        const bool hidden = std::any_of(st.gaps.begin(), st.gaps.end(), [&](const tooth_space::SheetGap& g) {
          return node.sigma > g.from && node.sigma < g.to;
        });
        if (hidden) continue;
        const Vec3 feed = feed_direction(j, k, round);
        const double w = spacing(node.sigma, node.at, feed);
        if (previous) {
          const Vec3 mean_feed = (feed + previous_feed).normalized();
          Vec3 from = previous->at.centre;
          // A corner between the two: both of its ends have one count.
          for (const auto& g : st.gaps)
            if (g.from >= previous->sigma && g.to <= node.sigma)
              if (const auto corner = sheet_.raw(g.from, st.r)) {
                count += (corner->centre - from).cross(mean_feed).norm() / previous_w;
                p.sigma.insert(p.sigma.end(), {g.from, g.to});
                p.count.insert(p.count.end(), {count, count});
                from = corner->centre;
                previous_w = w;
              }
          count += (node.at.centre - from).cross(mean_feed).norm() / (0.5 * (w + previous_w));
        }
        p.sigma.push_back(node.sigma);
        p.count.push_back(count);
        previous = &node;
        previous_w = w;
        previous_feed = feed;
      }
      totals[j] = count;
      profiles[j] = std::move(p);
    }
    profiles_ = std::move(profiles);
    totals_ = std::move(totals);
  }
}

/// The count comes from curvatures at single points; here every cusp is measured between its two passes, and where it
/// is higher than asked the passes are drawn together.
void PassCount::sharpen() {
  std::vector<std::vector<double>> grow(profiles_.size());
  tbb::parallel_for(std::size_t(0), profiles_.size(), [&](std::size_t j) { grow[j] = growth(j); });
  for (std::size_t j = 0; j < profiles_.size(); ++j) apply(j, grow[j]);
}

void PassCount::draw_together(std::span<const HighCusp> cusps) {
  const auto& stations = sheet_.stations();
  std::vector<std::vector<double>> grow(profiles_.size());
  for (std::size_t j = 0; j < profiles_.size(); ++j) grow[j].assign(profiles_[j].sigma.size(), 1.0);
  const double step = (sheet_.r_to() - sheet_.r_from()) / double(stations.size() - 1);
  for (const auto& c : cusps) {
    const auto before =
        std::size_t(std::clamp(std::floor((c.r - sheet_.r_from()) / step), 0.0, double(stations.size() - 2)));
    const double factor =
        std::sqrt(std::clamp(c.crest.height_mm / (kCornerAim * o_.scallop(c.sigma_a, c.sigma_b)), 1.0, 4.0));
    for (const std::size_t j : {before, before + 1})
      for (std::size_t k = 1; k < grow[j].size(); ++k)
        if (profiles_[j].sigma[k] > c.sigma_a && profiles_[j].sigma[k - 1] < c.sigma_b)
          grow[j][k] = std::max(grow[j][k], factor);
  }
  for (std::size_t j = 0; j < profiles_.size(); ++j) apply(j, grow[j]);
}

/// Stretches every interval of station j by its factor.
void PassCount::apply(std::size_t j, const std::vector<double>& grow) {
  auto& old = profiles_[j].count;
  std::vector<double> count{old.front()};
  for (std::size_t k = 1; k < old.size(); ++k) count.push_back(count.back() + (old[k] - old[k - 1]) * grow[k]);
  old = std::move(count);
  totals_[j] = old.back();
}

/// Factor of every interval of station j. Where the curvature jumps (around the corners) pairs of passes are tried at
/// four phases, since the final passes of a station fall anywhere; on the flanks one phase is enough.
std::vector<double> PassCount::growth(std::size_t j) const {
  const auto& p = profiles_[j];
  const double r = sheet_.stations()[j].r, total = totals_[j];
  const auto gaps = sheet_.gaps(r);
  const auto on_flank = [](double sigma) { return sigma < 0.96 || sigma > 4.04; };
  std::vector<double> grow(p.sigma.size(), 1.0);
  const auto try_pairs = [&](double begin, double end, double step, std::size_t apart) {
    std::vector<PassLine> lines;
    for (double c = begin; c <= end; c += step) {
      const auto line = line_at(j, c);
      if (!line) return;
      lines.push_back(*line);
    }
    for (std::size_t i = 0; i + apart < lines.size(); ++i) {
      const auto &a = lines[i], &b = lines[i + apart];
      const auto between = [&](const tooth_space::SheetGap& g) { return a.sigma <= g.from && b.sigma >= g.to; };
      if (std::any_of(gaps.begin(), gaps.end(), between)) continue;  // a pass will run along the corner between them
      const double height = cusp(a, b, r, gaps).height_mm;
      const double ratio = std::clamp(
          height / ((on_flank(a.sigma) && on_flank(b.sigma) ? kFlankAim : kCornerAim) * o_.scallop(a.sigma, b.sigma)),
          1.0, 4.0);
      if (ratio == 1.0) continue;
      for (std::size_t k = 1; k < p.sigma.size(); ++k)
        if (p.sigma[k] > a.sigma && p.sigma[k - 1] < b.sigma) grow[k] = std::max(grow[k], std::sqrt(ratio));
    }
  };
  const double corner_begin = count_at(j, 0.85), corner_end = count_at(j, 4.15);
  try_pairs(0.5, corner_begin, 1.0, 1);
  try_pairs(std::max(corner_begin - 1.0, 0.0), std::min(corner_end + 1.0, total), 0.25, 4);
  try_pairs(corner_end, total, 1.0, 1);
  return grow;
}

/// A pass where station j has a count: it goes on through the same share of the counts of the neighbours.
std::optional<PassLine> PassCount::line_at(std::size_t j, double count) const {
  const auto& stations = sheet_.stations();
  const auto centre = [&](std::size_t s) -> std::optional<Vec3> {
    if (s >= stations.size()) return {};  // before the first one, too
    const auto q = sheet_.at(sigma_at(s, count / totals_[j] * totals_[s]), stations[s].r);
    if (!q) return {};
    return q->centre;
  };
  const double sigma = sigma_at(j, count);
  const auto here = sheet_.at(sigma, stations[j].r);
  const auto before = centre(j - 1), after = centre(j + 1);
  if (!here || (!before && !after)) return {};
  return PassLine(sigma, *here, before, after);
}

/// The crest stands where both balls leave the same: from one pass to the other the distance to the first grows and
/// that to the second falls, so that the place between them is enclosed. Allowance left out.
Crest PassCount::cusp(const PassLine& a, const PassLine& b, double r,
                      const std::vector<tooth_space::SheetGap>& gaps) const {
  // What both balls leave at a place.
  const auto over = [&](const tooth_space::SheetPoint& s) {
    const Vec3 p = s.contact.p + o_.allowance_mm * s.contact.n;
    return std::pair{a.distance(p) - o_.ball_radius_mm, b.distance(p) - o_.ball_radius_mm};
  };
  const auto crest = [&](const tooth_space::SheetPoint& s, double height) {
    const auto lean = [&](const PassLine& pass) {
      return (s.contact.p - pass.at.centre).normalized().cross(pass.at.contact.n).norm();
    };
    return Crest{std::max(0.0, height), std::max(lean(a), lean(b))};
  };
  // Beside a corner that the ball cannot reach, which has its own pass, the surface ends: the higher of the two ends.
  for (const auto& g : gaps)
    if (a.sigma < g.from && b.sigma > g.to) {
      Crest most;
      for (const double end : {g.from, g.to})
        if (const auto s = sheet_.raw(end, r))
          if (const double height = std::min(over(*s).first, over(*s).second); height > most.height_mm)
            most = crest(*s, height);
      return most;
    }
  const auto slope = [](const std::pair<double, double>& h) { return h.first - h.second; };
  double low = a.sigma, high = b.sigma, f_low = slope(over(a.at)), f_high = slope(over(b.at));
  for (int k = 1; k <= kCrestSteps; ++k) {
    // Where the line through both ends is zero; every third time the middle, so that the bracket shrinks from both
    // sides.
    const bool line = k % 3 != 0 && f_low < 0 && f_high > 0;
    const double sigma = line ? low - f_low * (high - low) / (f_high - f_low) : 0.5 * (low + high);
    const auto s = sheet_.raw(sigma, r);
    if (!s) return {};
    const auto h = over(*s);
    if (std::abs(slope(h)) < kSameHeight * o_.scallop(a.sigma, b.sigma) || k == kCrestSteps)
      return crest(*s, 0.5 * (h.first + h.second));
    (slope(h) < 0 ? low : high) = sigma;
    (slope(h) < 0 ? f_low : f_high) = slope(h);
  }
  return {};
}

Vec3 PassCount::feed_direction(std::size_t j, std::size_t k, int round) const {
  const auto& stations = sheet_.stations();
  const std::size_t a = j > 0 ? j - 1 : j, b = j + 1 < stations.size() ? j + 1 : j;
  const auto place = [&](std::size_t s) -> Vec3 {
    if (round == 0 || profiles_.empty()) return stations[s].nodes[k].at.centre;
    const double share = count_at(j, stations[j].nodes[k].sigma) / totals_[j];
    const double sigma = sigma_at(s, share * totals_[s]);
    const auto q = sheet_.at(sigma, stations[s].r);
    return q ? q->centre : stations[s].nodes[k].at.centre;
  };
  return (place(b) - place(a)).normalized();
}

}  // namespace toothpath::ball
