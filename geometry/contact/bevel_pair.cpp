#include "geometry/contact/bevel_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/angle.h"

namespace toothpath::contact {
namespace {

constexpr double kAtEdge = 1e-9;             // of the cone distance: points on an edge count as on the flank
constexpr double kOnEdge = 1e-9;             // mm: places that slide along an edge lie on it
constexpr double kTurn = 1e-6, kWay = 1e-4;  // rad, mm: steps of the derivatives with which they come back to it
constexpr int kMostRounds = 10;              // of Newton
constexpr double kBelow =
    2;  // a place between those of a grid lies at most so many differences to its neighbours below
constexpr int kFirstHalvings = 4;   // before low places are compared with each other
constexpr double kEarlier = 1e-11;  // rad: a place that is met less earlier is no better
constexpr double kLedOn = 0.25;     // of a step: a place that edges bring back to less has not led on

/// From a place near by where one is known; updated by who asks.
std::optional<bevel_gear::BevelInverse> inverse_from(const bevel_gear::BevelWall<double>& wall, double ell,
                                                     double height, const bevel_gear::BevelInverse& start) {
  if (start.iterations > 0)
    if (auto found = bevel_gear::bevel_inverse(wall, ell, height, start)) return found;
  return bevel_gear::bevel_inverse(wall, ell, height);
}

void change_wall(bevel_gear::BevelWall<double>& wall, const bevel_gear::BevelGear& gear, const PinionChange& change) {
  const auto& p = gear.parameters();
  const auto& c = gear.cutter_data();
  const std::size_t w = wall.eps() < 0 ? 0 : 1;
  if (change.pressure_angle_rad[w] != 0 || change.equivalent_radius[w] != 0)
    wall.cutter = bevel_gear::make_finger_profile<double>(
        {p.pressure_angle_rad + change.pressure_angle_rad[w], gear.kappa_v() / (1 + change.equivalent_radius[w]),
         p.dedendum_mm, c.module_mm, c.tip_radius_mm, c.rack_depth_mm, c.profile_height_mm},
        gear.cutter().law);
  const double turn = change.spiral_angle_rad[w];
  if (turn == 0) return;
  const double outer = std::cos(p.outer_spiral_angle_rad + turn);
  wall.trace.R_0 = gear.R_e() / (outer * outer);
  wall.trace.beta_ref = wall.trace.beta(gear.R_ref());
}

}  // namespace

Result<BevelPair> BevelPair::make(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
                                  const BevelAssembly& assembly, const PinionChange& change, BevelLeft left) {
  const auto &p = pinion.parameters(), &w = wheel.parameters();
  const double ratio = double(w.teeth) / p.teeth;
  if (std::abs(wheel.sin_delta() / pinion.sin_delta() / ratio - 1) > 1e-9)
    return fail("pitch angles {:.6f} and {:.6f} deg do not fit {} and {} teeth", degrees(pinion.delta()),
                degrees(wheel.delta()), p.teeth, w.teeth);
  if (p.mate_teeth > 0 && std::abs(pinion.delta() + wheel.delta() - p.shaft_angle_rad) > 1e-9)
    return fail("pitch angles {:.6f} and {:.6f} deg do not add up to the shaft angle {:.6f} deg",
                degrees(pinion.delta()), degrees(wheel.delta()), degrees(p.shaft_angle_rad));
  if (std::abs(wheel.R_0() / pinion.R_0() - 1) > 0.02)
    return fail("R_0 = {:.4f} mm of the wheel differs from {:.4f} mm of the pinion by more than 2 %", wheel.R_0(),
                pinion.R_0());
  if (pinion.halves().size() != wheel.halves().size()) return fail("one gear has one hand, the other is a herringbone");
  for (std::size_t k = 0; k < pinion.halves().size(); ++k)
    if (pinion.halves()[k].hand == wheel.halves()[k].hand)
      return fail("half {} has the same hand on both gears: a pair needs opposite hands", k);
  BevelPair pair;
  pair.pinion_ = &pinion;
  pair.wheel_ = &wheel;
  pair.pinion_halves_ = pinion.halves();
  for (bevel_gear::BevelHalf& half : pair.pinion_halves_)
    for (bevel_gear::BevelWall<double>& wall : half.walls) change_wall(wall, pinion, change);
  pair.ratio_ = ratio;
  pair.left_ = std::move(left);
  // Common pitch line g, normal m from the pinion into the wheel, t = g x m; the fixed frame is the pinion's blank
  // frame at phi_1 = 0.
  const double s1 = pinion.sin_delta(), c1 = pinion.cos_delta(), s2 = wheel.sin_delta(), c2 = wheel.cos_delta();
  const Vec3 g(s1, 0, c1), m(c1, 0, -s1), t(0, 1, 0), g2(s2, 0, c2), m2(c2, 0, -s2);
  const Mat3 nominal = g * g2.transpose() - m * m2.transpose() - t * t.transpose();
  pair.placed_ = Eigen::AngleAxisd(assembly.shaft_angle_rad, t).toRotationMatrix() * nominal;
  pair.shift_ =
      assembly.offset_mm * t - assembly.pinion_axial_mm * Vec3::UnitZ() + assembly.wheel_axial_mm * pair.placed_.col(2);
  return pair;
}

Vec3 BevelPair::turned_to_pinion(const Vec3& direction, double phi_2) const {
  const double c = std::cos(phi_2), s = std::sin(phi_2), x = direction.x(), y = direction.y();
  return placed_ * Vec3(c * x - s * y, s * x + c * y, direction.z());
}
Vec3 BevelPair::to_pinion(const Vec3& point, double phi_2) const { return turned_to_pinion(point, phi_2) + shift_; }

bevel_gear::ConePoint BevelPair::on_pinion(const Vec3& point, double phi_2) const {
  return bevel_gear::cone_point(to_pinion(point, phi_2), pinion_->sin_delta(), pinion_->cos_delta());
}

bool BevelPair::within_edges(const bevel_gear::BevelHalf& half, const bevel_gear::ConePoint& q) const {
  const double edge = kAtEdge * pinion_->R_0();
  return !(q.ell < half.ell_from - edge || q.ell > half.ell_to + edge ||
           q.height > pinion_->parameters().addendum_mm + edge);
}

std::optional<BevelTouch> BevelPair::touch_of(int half, int sigma, const Vec3& point, const bevel_gear::ConePoint& q,
                                              bool on_flank, bevel_gear::BevelInverse& start) const {
  const bevel_gear::BevelWall<double>& wall = pinion_halves_[static_cast<std::size_t>(half)].wall(sigma);
  const auto found = inverse_from(wall, q.ell, q.height, start);
  if (!found || found->p < wall.cutter.p_A) return std::nullopt;
  start = *found;
  // Pinion tooth between its spaces -1 and 0, turned by half a pitch to azimuth 0: wall L of space 0, wall U of space
  // -1.
  double turn = q.azimuth - found->azimuth - sigma * pinion_->pitch() / 2;
  // What stands on the walls is met earlier.
  if (left_)
    turn -= sigma * left_(half, sigma, bevel_gear::cone_point(point, wheel_->sin_delta(), wheel_->cos_delta()), q) /
            pinion_lever(half, sigma, *found);
  return BevelTouch{wrapped(turn), q.ell, q.height, on_flank};
}

std::optional<double> BevelPair::turn_at(int half, int sigma, const Vec3& point, double phi_2,
                                         bevel_gear::BevelInverse& start) const {
  const bevel_gear::BevelHalf& own = pinion_halves_[static_cast<std::size_t>(half)];
  const bevel_gear::ConePoint q = on_pinion(point, phi_2);
  if (!within_edges(own, q)) return std::nullopt;
  const auto found = touch_of(half, sigma, point, q, true, start);
  if (!found) return std::nullopt;
  return found->turn;
}

std::optional<BevelTouch> BevelPair::touch(int half, int sigma, const Vec3& point, double phi_2,
                                           bevel_gear::BevelInverse& start) const {
  const bevel_gear::BevelHalf& own = pinion_halves_[static_cast<std::size_t>(half)];
  const bevel_gear::ConePoint q = on_pinion(point, phi_2);
  return touch_of(half, sigma, point, q, within_edges(own, q), start);
}

std::optional<double> BevelPair::error_at(int half, int sigma, const Vec3& point, double phi_2,
                                          bevel_gear::BevelInverse& start) const {
  const auto turn = turn_at(half, sigma, point, phi_2, start);
  if (!turn) return std::nullopt;
  return sigma * wrapped(*turn - nominal_turn(phi_2));
}

std::optional<double> BevelPair::error_within(int half, int sigma, double phi_2, Vec2& place, Starts& starts) const {
  const bevel_gear::BevelHalf &own = wheel_->halves()[static_cast<std::size_t>(half)],
                              &mate = pinion_->halves()[static_cast<std::size_t>(half)];
  const bevel_gear::BevelWall<double>& wall = own.wall(sigma);
  const auto met_at = [&](const Vec3& point) {
    const auto q = on_pinion(point, phi_2);
    return Vec2(q.ell, q.height);
  };
  // By what both places, on the wheel and on the pinion, change where a coordinate of the wall does.
  const auto change = [&](const bevel_gear::BevelInverse& at, double turn, double way, Eigen::Matrix2d& on_wheel,
                          Eigen::Matrix2d& on_mate, int column, const Vec2& q) {
    const Vec3 point = wall.point(at.beta + turn, at.p + way).p;
    const auto there = bevel_gear::cone_point(point, wheel_->sin_delta(), wheel_->cos_delta());
    on_wheel.col(column) = Vec2(there.ell, there.height) - place;
    on_mate.col(column) = met_at(point) - q;
  };
  for (int round = 0; round < kMostRounds; ++round) {
    place = Vec2(std::clamp(place.x(), own.ell_from, own.ell_to), std::min(place.y(), highest()));
    const auto found = inverse_from(wall, place.x(), place.y(), starts.wheel);
    if (!found || found->p < wall.cutter.p_B) return std::nullopt;
    starts.wheel = *found;
    const Vec3 point = wall.point(found->beta, found->p).p;
    const Vec2 q = met_at(point);
    const Vec2 back(std::clamp(q.x(), mate.ell_from, mate.ell_to) - q.x(),
                    std::min(q.y(), pinion_->parameters().addendum_mm) - q.y());
    if (back.norm() < kOnEdge) {
      const auto met = touch(half, sigma, point, phi_2, starts.pinion);
      if (!met) return std::nullopt;
      return sigma * wrapped(met->turn - nominal_turn(phi_2));
    }
    Eigen::Matrix2d on_wheel, on_mate;
    change(*found, kTurn, 0, on_wheel, on_mate, 0, q);
    change(*found, 0, -kWay, on_wheel, on_mate, 1, q);
    const Vec2 step = on_wheel * (on_mate.inverse() * back);
    if (!step.allFinite() || step.norm() > wheel_->parameters().outer_transverse_module_mm) return std::nullopt;
    place += step;
  }
  return std::nullopt;
}

void BevelPair::downhill(int half, int sigma, double phi_2, Descent& from, int halvings) const {
  const auto earlier = [&](const Vec2& centre, const Vec2& way) {
    Vec2 place = centre + way.cwiseProduct(from.step);
    const auto e = error_within(half, sigma, phi_2, place, from.starts);
    if (e) from.rise = std::max(from.rise, *e - from.at.error);
    if (!e || !(*e < from.at.error - kEarlier)) return false;
    from.at = {*e, place.x(), place.y()};
    return (place - centre).cwiseQuotient(from.step).lpNorm<Eigen::Infinity>() >= kLedOn;
  };
  Vec2 last = Vec2::Zero();  // way that led on: it is tried first
  while (from.halved < halvings) {
    const Vec2 centre(from.at.ell, from.at.height);
    from.rise = 0;
    bool moved = !last.isZero() && earlier(centre, last);
    if (!moved)
      for (int k = 0; k < 9; ++k)
        if (const Vec2 way(k / 3 - 1, k % 3 - 1); !way.isZero() && earlier(centre, way)) moved = true, last = way;
    // On along what is found, by steps as long as at the beginning again. Steps that go square to an edge slide along
    // it by next to nothing: what they find is kept, but shorter ones are needed.
    if (!moved) from.step /= 2, ++from.halved;
    else if (from.halved > 0) from.step *= 2, --from.halved;
  }
}

BevelNear BevelPair::first_met(int half, int sigma, double phi_2, const std::vector<BevelNear>& grid, int columns,
                               int halvings) const {
  const bevel_gear::BevelHalf& own = wheel_->halves()[static_cast<std::size_t>(half)];
  const int rows = static_cast<int>(grid.size()) / columns;
  const Vec2 step((own.ell_to - own.ell_from) / (columns - 1), (highest() - lowest(half)) / (rows - 1));
  const auto at = [&](int row, int column) -> const BevelNear& {
    return grid[static_cast<std::size_t>(row * columns + column)];
  };
  std::vector<Descent> low;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double here = at(row, column).error;
      double most = 0;
      bool lowest_of_all = std::isfinite(here);
      for (int i = std::max(0, row - 1); i <= std::min(rows - 1, row + 1); ++i)
        for (int j = std::max(0, column - 1); j <= std::min(columns - 1, column + 1); ++j) {
          lowest_of_all = lowest_of_all && at(i, j).error >= here;
          if (std::isfinite(at(i, j).error)) most = std::max(most, at(i, j).error - here);
        }
      if (lowest_of_all) low.push_back({at(row, column), step, 0, most, {}});
    }
  // All some way down, then those to the end that can still come lowest.
  BevelNear first{std::numeric_limits<double>::infinity(), 0, 0};
  for (const int so_far : {std::min(kFirstHalvings, halvings), halvings}) {
    std::stable_sort(low.begin(), low.end(), [](const auto& a, const auto& b) { return a.at.error < b.at.error; });
    for (Descent& from : low) {
      if (from.at.error - kBelow * from.rise > first.error) continue;
      downhill(half, sigma, phi_2, from, so_far);
      if (from.at.error < first.error) first = from.at;
    }
  }
  return first;
}

std::optional<BevelPlace> BevelPair::wheel_place(int half, int sigma, double ell, double height) const {
  const bevel_gear::BevelWall<double>& wall = wheel_->halves()[static_cast<std::size_t>(half)].wall(sigma);
  const auto found = bevel_gear::bevel_inverse(wall, ell, height);
  if (!found) return std::nullopt;
  const auto f = wall.point(found->beta, found->p);
  return BevelPlace{ell, height, f.p, f.n, found->beta, found->p};
}

double BevelPair::lever(const BevelPlace& place, double phi_2) const {
  const Vec3 r = to_pinion(place.point, phi_2), n = turned_to_pinion(place.normal, phi_2);
  return std::abs(r.x() * n.y() - r.y() * n.x());
}

double BevelPair::pinion_lever(int half, int sigma, const bevel_gear::BevelInverse& at) const {
  const auto f = pinion_halves_[static_cast<std::size_t>(half)].wall(sigma).point(at.beta, at.p);
  return std::abs(f.p.x() * f.n.y() - f.p.y() * f.n.x());
}

double BevelPair::lowest(int half) const {
  const auto& c = wheel_->halves()[static_cast<std::size_t>(half)].walls[0].cutter;
  return c.x_B + 0.02 * (c.x_C - c.x_B);
}

Result<bevel_gear::BevelGear> bevel_mate(const bevel_gear::BevelGear& gear) {
  bevel_gear::BevelGearParameters p = gear.parameters();
  if (p.mate_teeth <= 0) return fail("the gear names no mate: gear.mate_teeth is missing");
  std::swap(p.teeth, p.mate_teeth);
  p.hand = -p.hand;
  p.pitch_angle_rad = 0;
  p.modifications.clear();  // what the mate's drawing takes is not known
  bevel_gear::FingerCutterData cutter = gear.cutter_data();
  auto made = bevel_gear::BevelGear::make(p, cutter);
  if (auto* refused = made.refused()) {
    Diagnostic error = refused->front().diagnostic;
    error.message = "mate with " + std::to_string(p.teeth) + " teeth: " + error.message;
    return error;
  }
  return std::move(made).value();
}

}  // namespace toothpath::contact
