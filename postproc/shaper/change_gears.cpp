#include "postproc/shaper/change_gears.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace toothpath::shaper {
namespace {

/// The set as sorted numbers and how often each is there.
struct Shelf {
  std::vector<int> teeth;
  std::vector<int> count;
};

Shelf shelf_of(const WheelSet& set) {
  std::vector<int> sorted = set.teeth;
  std::sort(sorted.begin(), sorted.end());
  Shelf shelf;
  for (const int z : sorted) {
    if (shelf.teeth.empty() || shelf.teeth.back() != z) {
      shelf.teeth.push_back(z);
      shelf.count.push_back(0);
    }
    ++shelf.count.back();
  }
  return shelf;
}

/// Order of preference among trains of equal merit.
bool preferred(const std::vector<int>& p, const std::vector<int>& q) {
  const auto sum = [](const std::vector<int>& w) { return std::accumulate(w.begin(), w.end(), 0); };
  return std::tuple(p.size(), sum(p), p) < std::tuple(q.size(), sum(q), q);
}

/// Calls `visit(a, b)` for every pair, then `visit(a, b, c, position)` where `position` tells the start of the search
/// for d.
template <typename Pair, typename Triple>
void for_each_start(const Shelf& shelf, Pair&& on_pair, Triple&& on_triple) {
  const std::size_t n = shelf.teeth.size();
  std::vector<int> left = shelf.count;
  for (std::size_t a = 0; a < n; ++a) {
    --left[a];
    for (std::size_t b = 0; b < n; ++b) {
      if (left[b] == 0) continue;
      --left[b];
      on_pair(shelf.teeth[a], shelf.teeth[b]);
      for (std::size_t c = 0; c < n; ++c) {
        if (left[c] == 0) continue;
        --left[c];
        on_triple(shelf.teeth[a], shelf.teeth[b], shelf.teeth[c], left);
        ++left[c];
      }
      ++left[b];
    }
    ++left[a];
  }
}

}  // namespace

machines::Ratio reduced(machines::Ratio ratio) {
  const std::int64_t g = std::gcd(ratio.numerator, ratio.denominator);
  return g > 1 ? machines::Ratio{ratio.numerator / g, ratio.denominator / g} : ratio;
}

machines::Ratio GearTrain::ratio() const {
  machines::Ratio r{1, 1};
  for (std::size_t k = 0; k < wheels.size(); ++k) (k % 2 == 0 ? r.numerator : r.denominator) *= wheels[k];
  return reduced(r);
}

std::string GearTrain::text() const {
  if (wheels.size() == 2) return fmt::format("{}/{}", wheels[0], wheels[1]);
  if (wheels.size() == 4) return fmt::format("{}/{} * {}/{}", wheels[0], wheels[1], wheels[2], wheels[3]);
  return "none";
}

bool train_fits(const WheelSet& set, const GearTrain& train) {
  const auto& w = train.wheels;
  if (w.size() != 2 && w.size() != 4) return false;
  for (const int z : w)
    if (std::count(w.begin(), w.end(), z) > std::count(set.teeth.begin(), set.teeth.end(), z)) return false;
  return w.size() == 2 || (w[0] + w[1] >= w[2] + set.mesh_margin && w[2] + w[3] >= w[1] + set.mesh_margin);
}

std::optional<GearTrain> exact_train(const WheelSet& set, machines::Ratio target) {
  const Shelf shelf = shelf_of(set);
  const machines::Ratio t = reduced(target);
  std::vector<int> best;
  const auto offer = [&](std::vector<int> wheels) {
    if (best.empty() || preferred(wheels, best)) best = std::move(wheels);
  };
  for_each_start(
      shelf,
      [&](int a, int b) {
        if (a * t.denominator == b * t.numerator) offer({a, b});
      },
      [&](int a, int b, int c, const std::vector<int>& left) {
        if (a + b < c + set.mesh_margin) return;
        const std::int64_t over = std::int64_t{a} * c * t.denominator, under = b * t.numerator;
        if (under == 0 || over % under != 0) return;
        const std::int64_t d = over / under;
        const auto at = std::lower_bound(shelf.teeth.begin(), shelf.teeth.end(), d);
        if (at == shelf.teeth.end() || *at != d || left[std::size_t(at - shelf.teeth.begin())] == 0) return;
        if (c + d >= b + set.mesh_margin) offer({a, b, c, int(d)});
      });
  if (best.empty()) return std::nullopt;
  return GearTrain{best};
}

std::optional<GearTrain> nearest_train(const WheelSet& set, double target) {
  const Shelf shelf = shelf_of(set);
  std::vector<int> best;
  double best_error = 0;
  const auto offer = [&](std::vector<int> wheels) {
    const double error = std::abs(GearTrain{wheels}.ratio().value() - target);
    if (best.empty() || error < best_error || (error == best_error && preferred(wheels, best))) {
      best = std::move(wheels);
      best_error = error;
    }
  };
  for_each_start(
      shelf,
      [&](int a, int b) {
        offer({a, b});
      },
      [&](int a, int b, int c, const std::vector<int>& left) {
        if (a + b < c + set.mesh_margin) return;
        const double ideal = double(a) * c / (double(b) * target);
        const auto split = std::lower_bound(shelf.teeth.begin(), shelf.teeth.end(), ideal) - shelf.teeth.begin();
        const auto usable = [&](std::ptrdiff_t k) {
          return left[std::size_t(k)] > 0 && c + shelf.teeth[std::size_t(k)] >= b + set.mesh_margin;
        };
        for (std::ptrdiff_t k = split; k < std::ptrdiff_t(shelf.teeth.size()); ++k)
          if (usable(k)) {
            offer({a, b, c, shelf.teeth[std::size_t(k)]});
            break;
          }
        for (std::ptrdiff_t k = split - 1; k >= 0; --k)
          if (usable(k)) {
            offer({a, b, c, shelf.teeth[std::size_t(k)]});
            break;
          }
      });
  if (best.empty()) return std::nullopt;
  return GearTrain{best};
}

WheelSet without(const WheelSet& set, const GearTrain& train) {
  WheelSet rest = set;
  for (const int z : train.wheels) {
    const auto at = std::find(rest.teeth.begin(), rest.teeth.end(), z);
    if (at != rest.teeth.end()) rest.teeth.erase(at);
  }
  return rest;
}

}  // namespace toothpath::shaper
