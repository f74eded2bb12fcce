#include "geometry/exchange/shell_fit.h"

#include <algorithm>
#include <cmath>

namespace toothpath::exchange {
namespace {

constexpr double kAlongShare = 0.35;  ///< of the tolerance, for the knots of one direction alone
constexpr double kTighter = 0.6;      ///< of that share, when both together miss
constexpr int kTries = 8;
constexpr std::size_t kLines = 9;  ///< lines of the other direction that the knots of one are chosen by
constexpr std::size_t kFirstPieces = 2;

using Shares = std::vector<std::vector<double>>;
using Rows = std::vector<std::vector<std::vector<Vec3>>>;  // [u][strip][v]

/// Inner places of every piece, and with `ends` its ends, too.
std::vector<double> check_points(const Breaks& breaks, bool ends) {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    if (ends) out.push_back(breaks[k]);
    for (std::size_t j = 0; j < kChecksPerPiece; ++j)
      out.push_back(breaks[k] + (breaks[k + 1] - breaks[k]) * (double(j) + 0.5) / double(kChecksPerPiece));
  }
  if (ends) out.push_back(breaks.back());
  return out;
}

/// Halves the pieces that are marked; no piece stays more than twice as long as its neighbour.
Breaks halved(const Breaks& breaks, std::vector<bool> bad) {
  const std::size_t n = bad.size();
  for (bool more = true; more;) {
    more = false;
    const auto length = [&](std::size_t k) { return (breaks[k + 1] - breaks[k]) * (bad[k] ? 0.5 : 1); };
    for (std::size_t k = 0; k < n; ++k)
      for (const std::size_t other : {k - 1, k + 1})
        if (!bad[k] && other < n && length(k) > 2.5 * length(other)) bad[k] = more = true;
  }
  Breaks out;
  for (std::size_t k = 0; k < n; ++k) {
    out.push_back(breaks[k]);
    if (bad[k]) out.push_back(0.5 * (breaks[k] + breaks[k + 1]));
  }
  out.push_back(breaks.back());
  return out;
}

class RingFit {
 public:
  RingFit(const ToothRing& ring, double tolerance) : ring_(ring), tolerance_(tolerance) {}

  Result<FittedRing> run(std::size_t& checked) {
    double aim = kAlongShare * tolerance_;
    for (int k = 0; k < kTries; ++k, aim *= kTighter) {
      if (const auto s = choose_u(aim); !s) return s.error();
      if (const auto s = choose_v(aim); !s) return s.error();
      auto fitted = fit();
      if (!fitted) return fitted.error();
      const auto count = measure(*fitted);
      if (!count) return count.error();
      const auto worst = std::max_element(fitted->worst_mm.begin(), fitted->worst_mm.end());
      worst_ = *worst;
      worst_strip_ = std::size_t(worst - fitted->worst_mm.begin());
      if (!(worst_ <= tolerance_)) continue;
      checked += *count;
      return fitted;
    }
    return fail("{} of {} is {:.3g} mm from its B-spline surface, {:g} mm is the most", ring_.strips[worst_strip_].name,
                ring_.place, worst_, tolerance_);
  }

 private:
  Result<Rows> rows(const std::vector<double>& u, const Shares& v) const {
    Rows out;
    for (const double at : u) {
      auto row = ring_.row(at, v);
      if (!row) return row.error();
      out.push_back(std::move(*row));
    }
    return out;
  }
  [[nodiscard]] Shares everywhere(const std::vector<double>& v) const { return Shares(ring_.strips.size(), v); }

  Diagnostic bends_too_much(std::size_t strip, const std::string& where, double off, double aim) const {
    return fail(
        "{} of {}, {}: the surface bends too much for {} pieces of a B-spline ({:.3g} mm off, {:.3g} mm is "
        "asked): a sharp corner or an undercut is near; a larger shaper_tip_radius or another radius helps",
        ring_.strips[strip].name, ring_.place, where, kMostPieces, off, aim);
  }

  /// Knots along the teeth, for all strips.
  Status choose_u(double aim) {
    Breaks breaks = u_.empty() ? even_breaks(kFirstPieces) : u_;
    const Shares lines = everywhere(even_breaks(kLines - 1));
    for (;;) {
      const auto nodes = greville_points(breaks), between = check_points(breaks, false);
      const auto known = rows(nodes, lines), asked = rows(between, lines);
      if (!known) return known.error();
      if (!asked) return asked.error();
      std::vector<bool> bad(breaks.size() - 1);
      double off = 0;
      std::size_t strip = 0, place = 0;
      for (std::size_t s = 0; s < ring_.strips.size(); ++s)
        for (std::size_t line = 0; line < kLines; ++line) {
          std::vector<Vec3> places;
          for (const auto& row : *known) places.push_back(row[s][line]);
          const SplineCurve curve = curve_through(breaks, places);
          for (std::size_t k = 0; k < between.size(); ++k) {
            const double d = (curve.at(between[k]) - (*asked)[k][s][line]).norm();
            if (!(d <= aim)) bad[k / kChecksPerPiece] = true;
            if (!(d <= off)) off = d, strip = s, place = k;
          }
        }
      u_ = breaks;
      if (std::none_of(bad.begin(), bad.end(), [](bool b) { return b; })) return Ok{};
      breaks = halved(breaks, bad);
      if (breaks.size() > kMostPieces) return bends_too_much(strip, ring_.station(between[place]), off, aim);
    }
  }

  /// Knots across, one list a strip.
  Status choose_v(double aim) {
    v_.resize(ring_.strips.size(), even_breaks(kFirstPieces));
    const auto lines = even_breaks(kLines - 1);
    for (;;) {
      Shares nodes, between;
      for (const Breaks& b : v_) nodes.push_back(greville_points(b)), between.push_back(check_points(b, false));
      const auto known = rows(lines, nodes), asked = rows(lines, between);
      if (!known) return known.error();
      if (!asked) return asked.error();
      bool done = true;
      for (std::size_t s = 0; s < v_.size(); ++s) {
        std::vector<bool> bad(v_[s].size() - 1);
        double off = 0;
        std::size_t at_line = 0;
        for (std::size_t line = 0; line < kLines; ++line) {
          const SplineCurve curve = curve_through(v_[s], (*known)[line][s]);
          for (std::size_t k = 0; k < between[s].size(); ++k) {
            const double d = (curve.at(between[s][k]) - (*asked)[line][s][k]).norm();
            if (!(d <= aim)) bad[k / kChecksPerPiece] = true;
            if (!(d <= off)) off = d, at_line = line;
          }
        }
        if (std::none_of(bad.begin(), bad.end(), [](bool b) { return b; })) continue;
        done = false;
        v_[s] = halved(v_[s], bad);
        if (v_[s].size() > kMostPieces) return bends_too_much(s, ring_.station(lines[at_line]), off, aim);
      }
      if (done) return Ok{};
    }
  }

  Result<FittedRing> fit() const {
    Shares nodes;
    for (const Breaks& b : v_) nodes.push_back(greville_points(b));
    const auto known = rows(greville_points(u_), nodes);
    if (!known) return known.error();
    FittedRing out;
    for (std::size_t s = 0; s < v_.size(); ++s) {
      std::vector<Vec3> places;
      for (const auto& row : *known) places.insert(places.end(), row[s].begin(), row[s].end());
      out.strips.push_back(surface_through(u_, v_[s], places));
    }
    return out;
  }

  Result<std::size_t> measure(FittedRing& fitted) const {
    fitted.worst_mm.assign(v_.size(), 0);
    Shares places;
    for (const Breaks& b : v_) places.push_back(check_points(b, true));
    std::size_t count = 0;
    for (const double u : check_points(u_, true)) {
      const auto exact = ring_.row(u, places);
      if (!exact) return exact.error();
      for (std::size_t s = 0; s < v_.size(); ++s)
        for (std::size_t k = 0; k < places[s].size(); ++k, ++count) {
          const double d = (fitted.strips[s].at(u, places[s][k]) - (*exact)[s][k]).norm();
          if (!(d <= fitted.worst_mm[s])) fitted.worst_mm[s] = d;
        }
    }
    return count;
  }

  const ToothRing& ring_;
  double tolerance_;
  Breaks u_;
  std::vector<Breaks> v_;
  double worst_ = 0;
  std::size_t worst_strip_ = 0;
};

}  // namespace

Result<FittedShell> fit_shell(const GearShell& shell, double tolerance_mm) {
  FittedShell out;
  for (const ToothRing& ring : shell.rings) {
    auto fitted = RingFit(ring, tolerance_mm).run(out.checked);
    if (!fitted) return fitted.error();
    out.patches += fitted->strips.size() * std::size_t(shell.teeth);
    for (std::size_t s = 0; s < fitted->strips.size(); ++s)
      if (fitted->worst_mm[s] >= out.worst_mm) {
        out.worst_mm = fitted->worst_mm[s];
        out.worst_at = fmt::format("{} of {}", ring.strips[s].name, ring.place);
      }
    out.rings.push_back(std::move(*fitted));
  }
  return out;
}

}  // namespace toothpath::exchange
