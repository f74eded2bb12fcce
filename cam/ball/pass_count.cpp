#include "cam/ball/pass_count.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace toothpath::ball {
namespace {

/// Nodes of a profile are divided this often before cusps are measured: the curvature may change within one step-over.
constexpr int kFiner = 4;
constexpr int kCuspRounds = 4;
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

PassCount::PassCount(const face_gear::OffsetSheet& sheet, const FinishingOptions& options) : sheet_(sheet), o_(options) {
  count_profiles();
  for (auto& p : profiles_) divide(p.sigma, p.count);
  for (int round = 0; round < kCuspRounds; ++round) sharpen();
}

double PassCount::count_at(std::size_t j, double sigma) const { return interpolate(profiles_[j].sigma, profiles_[j].count, sigma); }
double PassCount::sigma_at(std::size_t j, double count) const { return interpolate(profiles_[j].count, profiles_[j].sigma, count); }

/// Centre spacing across the pass for the asked cusp at a contact point.
double PassCount::spacing(const face_gear::SheetPoint& s, const Vec3& feed) const {
  const Vec3 across = s.contact.n.cross(feed);
  const double k = face_gear::SpaceSheet::normal_curvature(s.contact, across);
  const double regular = std::max(1e-6, (1 + k * sheet_.delta()) / (1 + k * o_.allowance_mm));
  return std::sqrt(8 * o_.scallop_mm * o_.ball_radius_mm * regular);
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
      const face_gear::OffsetSheet::Node* previous = nullptr;
      double previous_w = 0;
      Vec3 previous_feed = Vec3::Zero();
      for (std::size_t k = 0; k < st.nodes.size(); ++k) {
        const auto& node = st.nodes[k];
        const bool hidden = std::any_of(st.gaps.begin(), st.gaps.end(), [&](const face_gear::SheetGap& g) {
          return node.sigma > g.from && node.sigma < g.to;
        });
        if (hidden) continue;
        const Vec3 feed = feed_direction(j, k, round);
        const double w = spacing(node.at, feed);
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

/// The count comes from curvatures at single points; here every cusp is measured between its two passes, and where it is
/// higher than asked the passes are drawn together.
void PassCount::sharpen() {
  std::vector<std::vector<double>> counts(profiles_.size());
  tbb::parallel_for(std::size_t(0), profiles_.size(), [&](std::size_t j) { counts[j] = sharpened(j); });
  for (std::size_t j = 0; j < profiles_.size(); ++j) {
    profiles_[j].count = std::move(counts[j]);
    totals_[j] = profiles_[j].count.back();
  }
}

/// New count of station j. Where the curvature jumps (around the corners) pairs of passes are tried at four phases, since the
/// final passes of a station fall anywhere; on the flanks one phase is enough.
std::vector<double> PassCount::sharpened(std::size_t j) const {
  const auto& p = profiles_[j];
  const double r = sheet_.stations()[j].r, total = totals_[j];
  const auto gaps = sheet_.gaps(r);
  const auto on_flank = [](double sigma) { return sigma < 0.96 || sigma > 4.04; };
  std::vector<double> grow(p.sigma.size(), 1.0);
  const auto try_pairs = [&](double begin, double end, double step, std::size_t apart) {
    std::vector<PassPlace> lines;
    for (double c = begin; c <= end; c += step) {
      const double sigma = sigma_at(j, c);
      const auto s = sheet_.at(sigma, r);
      if (!s) return;
      lines.push_back({sigma, *s, direction_at(j, sigma, c / total)});
    }
    for (std::size_t i = 0; i + apart < lines.size(); ++i) {
      const auto &a = lines[i], &b = lines[i + apart];
      const auto between = [&](const face_gear::SheetGap& g) { return a.sigma <= g.from && b.sigma >= g.to; };
      if (std::any_of(gaps.begin(), gaps.end(), between)) continue;  // a pass will run along the corner between them
      const double height = cusp(a, b, r, gaps);
      const double ratio = std::clamp(height / ((on_flank(a.sigma) && on_flank(b.sigma) ? kFlankAim : kCornerAim) * o_.scallop_mm), 1.0, 4.0);
      if (ratio == 1.0) continue;
      for (std::size_t k = 1; k < p.sigma.size(); ++k)
        if (p.sigma[k] > a.sigma && p.sigma[k - 1] < b.sigma) grow[k] = std::max(grow[k], std::sqrt(ratio));
    }
  };
  const double corner_begin = count_at(j, 0.85), corner_end = count_at(j, 4.15);
  try_pairs(0.5, corner_begin, 1.0, 1);
  try_pairs(std::max(corner_begin - 1.0, 0.0), std::min(corner_end + 1.0, total), 0.25, 4);
  try_pairs(corner_end, total, 1.0, 1);
  std::vector<double> count{p.count.front()};
  for (std::size_t k = 1; k < p.count.size(); ++k) count.push_back(count.back() + (p.count[k] - p.count[k - 1]) * grow[k]);
  return count;
}

/// Direction of a pass at a place of station j: towards the same share of the count at the neighbours.
Vec3 PassCount::direction_at(std::size_t j, double sigma, double share) const {
  const auto& stations = sheet_.stations();
  const std::size_t a = j > 0 ? j - 1 : j, b = j + 1 < stations.size() ? j + 1 : j;
  const auto place = [&](std::size_t s) {
    const double there = s == j ? sigma : sigma_at(s, share * totals_[s]);
    const auto q = sheet_.at(there, stations[s].r);
    return q ? q->centre : Vec3(Vec3::Zero());
  };
  return (place(b) - place(a)).normalized();
}

/// Highest place of the surface between two passes, above what both balls leave. Allowance left out.
double PassCount::cusp(const PassPlace& a, const PassPlace& b, double r, const std::vector<face_gear::SheetGap>& gaps) const {
  const auto from_line = [](const Vec3& p, const Vec3& q, const Vec3& feed) { return (p - q).cross(feed).norm(); };
  double worst = 0;
  constexpr int kSamples = 8;
  for (int k = 1; k < kSamples; ++k) {
    const double sigma = a.sigma + (b.sigma - a.sigma) * k / kSamples;
    bool hidden = false;
    for (const auto& g : gaps) hidden = hidden || (sigma > g.from && sigma < g.to);
    if (hidden) continue;  // a corner that the ball cannot reach has its own pass
    const auto s = sheet_.raw(sigma, r);
    if (!s) continue;
    const Vec3 p = s->contact.p + o_.allowance_mm * s->contact.n;
    worst = std::max(worst, std::min(from_line(p, a.at.centre, a.feed), from_line(p, b.at.centre, b.feed)) - o_.ball_radius_mm);
  }
  return worst;
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
