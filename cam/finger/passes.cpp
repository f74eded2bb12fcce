#include "cam/finger/passes.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "cam/finger/reference.h"
#include "geometry/base/angle.h"
#include "geometry/bevel_gear/convex_corner.h"

namespace toothpath::finger {
namespace {

constexpr double kRidgeShare = 0.85;  // of the allowed ridge that the planner uses
constexpr double kClearAir = 1.0;     // mm, between cutter and blank beyond the large end
constexpr int kGapStations = 32;      // intervals along a half on which the gap between passes is looked at

using Centre = bevel_gear::CutterCentre<double>;
using Trace = bevel_gear::BevelTrace<double>;

const Trace& trace_of(const bevel_gear::BevelGear& gear, std::size_t half) {
  return gear.halves()[half].walls[0].trace;
}

/// Cone distance at which the cutter has left the blank at the large end.
double clear_end(const bevel_gear::BevelGear& gear) { return gear.R_e() + gear.cutter().rho_D + kClearAir; }

/// Straight run-out at the large end until the cutter has left the blank.
void run_out(const bevel_gear::BevelGear& gear, std::size_t half, CentrePass& pass) {
  if (half + 1 != gear.halves().size()) return;
  const Trace t = trace_of(gear, half);
  const Centre end = pass.pieces.back().at(1.0);
  const double want = clear_end(gear);
  if (end.R_c >= want) return;
  double length = want - end.R_c;
  for (int k = 0; k < 60; ++k) {
    const Centre c = t.run_straight(end, length);
    if (std::abs(c.R_c - want) < 1e-9) break;
    length += (want - c.R_c) / std::max(0.2, std::cos(c.beta_c));
  }
  pass.pieces.push_back(
      {static_cast<int>(half), [t, end, length](double s) { return t.run_straight(end, s * length); }});
}

/// The pieces of one wall in one half, run-out included.
void add_wall(const bevel_gear::BevelGear& gear, std::size_t i, int sigma, CentrePass& pass) {
  const bevel_gear::BevelHalf& half = gear.halves()[i];
  const int k = sigma > 0 ? 0 : 1;
  const Trace t = half.walls[k].trace;
  const auto add = [&](double from, double to) {
    pass.pieces.push_back(
        {static_cast<int>(i), [t, sigma, from, to](double s) { return t.centre(sigma, from + (to - from) * s); }});
  };
  const double from = half.beta_from[k], to = half.beta_to[k];
  // The path changes from curve to tangent at beta_end: a joint between pieces.
  if (-sigma * half.hand > 0 && to < t.beta_end && from > t.beta_end) {
    add(from, t.beta_end);
    add(t.beta_end, to);
  } else {
    add(from, to);
  }
  run_out(gear, i, pass);
}

CentrePass wall_pass(int sigma, bool climb) {
  CentrePass pass;
  pass.name = sigma > 0 ? "wall L" : "wall U";
  // Material lies at lower azimuth of wall L: on the left of an outward feed, seen from the shank.
  pass.outward = (sigma < 0) == climb;
  return pass;
}

/// The space between both wall paths, by cone distance: a centre in it cuts neither wall.
class Space {
 public:
  explicit Space(const bevel_gear::BevelGear& gear) : gear_(gear), L_(gear, 1), U_(gear, -1) {}

  /// At the share mu of the room at one cone distance, from -1, wall L, to 1, wall U.
  [[nodiscard]] Centre at(double R_c, double mu) const {
    const Centre L = L_.place_at(R_c), U = U_.place_at(R_c);
    const double a = 0.5 * (1 - mu), b = 0.5 * (1 + mu);
    Centre c;
    c.R_c = R_c;
    c.theta_c = a * L.theta_c + b * U.theta_c;
    c.e = c.theta_c / gear_.sin_delta();
    c.beta_c = std::atan(a * std::tan(L.beta_c) + b * std::tan(U.beta_c));
    return c;
  }
  /// Distance of the wall paths across the space, mm; negative where they have crossed.
  [[nodiscard]] double width(double R_c) const {
    return (U_.place_at(R_c).theta_c - L_.place_at(R_c).theta_c) * R_c * std::cos(at(R_c, 0).beta_c);
  }
  /// Where the space begins: as far before the small end as a wall pass runs out of it, or where the wall paths cross.
  [[nodiscard]] double begin() const {
    const double first = std::min(L_.R_c_from(0), U_.R_c_from(0)), last = std::max(L_.R_c_to(0), U_.R_c_to(0));
    // From the small end outwards to the first place with room, or inwards to the last.
    const bool room = width(gear_.R_i()) >= 0;
    double outside = gear_.R_i(), inside = gear_.R_i();
    for (int k = 1; k <= kLooks; ++k) {
      const double next = gear_.R_i() + ((room ? first : last) - gear_.R_i()) * k / kLooks;
      if ((width(next) >= 0) != room) {
        (room ? outside : inside) = next;
        break;
      }
      (room ? inside : outside) = next;
    }
    if ((room && inside == first) || (!room && outside == last)) return room ? first : last;
    for (int n = 0; n < 40; ++n) {
      const double mid = 0.5 * (inside + outside);
      (width(mid) >= 0 ? inside : outside) = mid;
    }
    return inside;
  }
  /// Cone distances between which the room is smooth, of one half: from its begin or the corner to the corner or clear
  /// of the large end.
  [[nodiscard]] std::vector<double> smooth(std::size_t half) const {
    const double from = half == 0 ? begin() : gear_.corner().R_c,
                 to = half + 1 < gear_.halves().size() ? gear_.corner().R_c : clear_end(gear_);
    std::vector<double> ends{from, to};
    for (const WallReference* wall : {&L_, &U_})
      for (const double R : wall->joints())
        if (R > from && R < to) ends.push_back(R);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end(), [](double a, double b) { return b - a < kShortest; }), ends.end());
    ends.back() = to;
    return ends;
  }

 private:
  static constexpr int kLooks = 64;
  static constexpr double kShortest = 1e-6;  // mm of a piece
  bevel_gear::BevelGear gear_;
  WallReference L_, U_;
};

/// One roughing pass of a half at the share mu of the room.
CentrePass space_pass(const std::shared_ptr<const Space>& space, std::size_t half, double mu, std::string name) {
  CentrePass pass;
  pass.name = std::move(name);
  const auto ends = space->smooth(half);
  for (std::size_t k = 1; k < ends.size(); ++k)
    pass.pieces.push_back({static_cast<int>(half), [space, mu, from = ends[k - 1], to = ends[k]](double s) {
                             return space->at(from + (to - from) * s, mu);
                           }});
  return pass;
}

/// Height above the root cone of the lower surface of the cutter at lateral distance y.
double surface_height(const bevel_gear::BevelGear& gear, const bevel_gear::FingerSolid& solid, double R_c, double y) {
  const double x = solid.lower_surface(y), a = x * gear.cos_delta() + R_c * gear.sin_delta();
  return x + y * y / (std::hypot(a, y) + a) * gear.cos_delta() + gear.parameters().dedendum_mm;
}

}  // namespace

double crown_distance(const Centre& a, const Centre& b) {
  const double d = b.theta_c - a.theta_c, s = std::sin(0.5 * d);
  return std::sqrt((b.R_c - a.R_c) * (b.R_c - a.R_c) + 4 * a.R_c * b.R_c * s * s);
}

bevel_gear::CutterCentre<double> corner_arc(const bevel_gear::BevelGear& gear, double t) {
  return bevel_gear::ConvexCorner(gear).at(t);
}

std::vector<CentrePass> roughing_passes(const bevel_gear::BevelGear& gear, double ridge_mm, double& predicted_mm) {
  std::vector<CentrePass> passes;
  predicted_mm = 0;
  const auto space = std::make_shared<const Space>(gear);
  for (std::size_t n = gear.halves().size(); n-- > 0;) {
    // Ridges stand square to the passes: those at the end of the face belong to centres a little beyond it.
    const double from = space->smooth(n).front(), end = n + 1 < gear.halves().size() ? gear.corner().R_c : gear.R_e();
    const double to = end + 0.5 * std::max(0.0, space->width(end)) * std::sin(std::abs(space->at(end, 0).beta_c));
    int most = 1;
    for (int k = 0; k <= kGapStations; ++k) {
      const double R = from + (to - from) * k / kGapStations;
      most = std::max(most,
                      static_cast<int>(std::ceil(0.5 * space->width(R) / finger_gap(gear, R, kRidgeShare * ridge_mm))));
    }
    passes.push_back(space_pass(space, n, 0, "middle"));
    for (int k = 1; k < most; ++k)
      for (const int side : {-1, 1}) {
        const double mu = side * static_cast<double>(k) / most;
        passes.push_back(space_pass(space, n, mu, fmt::format("fill {:.2f}", mu)));
      }
    for (int k = 0; k <= kGapStations; ++k) {
      const double R = from + (to - from) * k / kGapStations;
      predicted_mm = std::max(predicted_mm, finger_ridge(gear, R, 0.5 * space->width(R) / most));
    }
  }
  return passes;
}

std::vector<CentrePass> wall_passes(const bevel_gear::BevelGear& gear, bool climb) {
  std::vector<CentrePass> passes;
  for (const int sigma : {1, -1}) {
    CentrePass pass = wall_pass(sigma, climb);
    if (gear.herringbone() && sigma == gear.corner().sigma) {
      // Concave: the crossing is the end of both.
      CentrePass outer = pass;
      add_wall(gear, 1, sigma, outer);
      add_wall(gear, 0, sigma, pass);
      passes.push_back(std::move(outer));
    } else if (gear.herringbone()) {
      add_wall(gear, 0, sigma, pass);
      pass.pieces.push_back({1, [corner = bevel_gear::ConvexCorner(gear)](double t) { return corner.at(t); }});
      add_wall(gear, 1, sigma, pass);
    } else {
      add_wall(gear, 0, sigma, pass);
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

double finger_ridge(const bevel_gear::BevelGear& gear, double R_c, double gap) {
  return surface_height(gear, bevel_gear::FingerSolid(gear.cutter()), R_c, 0.5 * gap);
}

double finger_gap(const bevel_gear::BevelGear& gear, double R_c, double ridge) {
  const bevel_gear::FingerSolid solid(gear.cutter());
  double lo = 0, hi = gear.cutter().rho_D;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (lo + hi);
    (surface_height(gear, solid, R_c, mid) < ridge ? lo : hi) = mid;
  }
  return 2 * lo;
}

}  // namespace toothpath::finger
