// The spiral bevel pair of NASA CR-191009 as an independent program rolls it: flanks as envelopes written out from the
// machine's settings, gears put on their shafts by hand, contact as the greatest turn that any place of the pinion
// asks for. It shares the table of settings with the library and nothing else.
#include <gtest/gtest.h>

#include "geometry/contact/toothed_pair.h"
#include "tests/geometry/spiral_bevel/samples.h"

namespace toothpath::test {
namespace {

/// One flank of a left-hand gear by one blade; a right-hand gear is its mirror image.
struct Blade {
  double point_radius, angle, edge_radius, lean;  // lean +1: outside blade
  double S, q, E, X_B, X_D, ratio, root;
};
struct EnvelopePoint {
  Vec3 place;
  double up_blade;
};
struct Turns {
  double cradle, cutter;
};

EnvelopePoint on_envelope(const Blade& b, const Turns& at) {
  const Vec3 x(std::sin(b.root), 0, std::cos(b.root)), y(0, -1, 0), z(std::cos(b.root), 0, -std::sin(b.root));
  const Vec3 centre = b.X_B * z + Vec3(0, b.E, -b.X_D);
  const double cq = std::cos(b.q + at.cradle), sq = std::sin(b.q + at.cradle);
  const auto housing = [&](double X, double Y, double Z) -> Vec3 {
    return (cq * X - sq * Y) * x + (sq * X + cq * Y) * y + Z * z;
  };
  const double c = std::cos(at.cutter), s = std::sin(at.cutter), sa = std::sin(b.angle), ca = std::cos(b.angle);
  const Vec3 foot = centre + housing(b.S + b.point_radius * c, b.point_radius * s, 0);
  const Vec3 line = housing(b.lean * sa * c, b.lean * sa * s, ca),
             normal = housing(b.lean * ca * c, b.lean * ca * s, -sa);
  const Vec3 spin = z + b.ratio * Vec3::UnitZ();
  const double up = -normal.dot(spin.cross(foot) - z.cross(centre)) / normal.dot(spin.cross(line));
  const Vec3 p = foot + up * line;
  const double beta = b.ratio * at.cradle, cb = std::cos(beta), sb = std::sin(beta);
  return {{cb * p.x() - sb * p.y(), sb * p.x() + cb * p.y(), p.z()}, up};
}

/// Newton for the place at (r, z), from `start`; false where none is near.
bool reach(const Blade& b, double r, double z, Turns& at) {
  constexpr double kStep = 1e-6, kLongest = 0.15;
  const auto off = [&](const Turns& t) {
    const Vec3 p = on_envelope(b, t).place;
    return Vec2(std::hypot(p.x(), p.y()) - r, p.z() - z);
  };
  for (int k = 0; k < 40; ++k) {
    const Vec2 f = off(at);
    if (f.norm() < 1e-10) return true;
    Eigen::Matrix2d J;
    J << (off({at.cradle + kStep, at.cutter}) - f) / kStep, (off({at.cradle, at.cutter + kStep}) - f) / kStep;
    const Vec2 d = J.inverse() * f;
    if (!d.allFinite()) return false;
    const double least = std::min(1.0, kLongest / d.cwiseAbs().maxCoeff());
    at = {at.cradle - least * d.x(), at.cutter - least * d.y()};
  }
  return false;
}

/// A flank inside its blank, in its gear's frame with the middle of space 0 at azimuth 0.
struct Flank {
  Blade blade;
  double pitch_angle, tip_angle, outer = 93.7514, width = 25.4;
  int mirror = 1;
  double turned = 0;  // of the cut flank, so that the space has its width
  Turns start{};

  [[nodiscard]] double start_up() const {  // where the rounding of the blade ends
    return blade.edge_radius * (1 - std::sin(blade.angle)) / std::cos(blade.angle);
  }
  /// Seeds of Newton: the mean point, from the cutter's angle nearest to the pitch line.
  void seed() {
    const double d = outer - width / 2, r = d * std::sin(pitch_angle), z = d * std::cos(pitch_angle);
    for (int k = -72; k <= 72; ++k) {
      Turns t{0, k * kPi / 72};
      if (!reach(blade, r, z, t) || std::abs(t.cradle) > 0.7) continue;
      const auto p = on_envelope(blade, t);
      if (p.up_blade < 0 || p.up_blade > 20 || std::abs(azimuth(p.place)) > 0.6) continue;
      start = t;
      return;
    }
    FAIL() << "no mean point";
  }
  /// Azimuth of the flank at (r, z); nothing outside of flank and blank.
  [[nodiscard]] std::optional<double> azimuth_at(double r, double z) const {
    const double along = r * std::sin(pitch_angle) + z * std::cos(pitch_angle);
    if (along > outer || along < outer - width || std::atan2(r, z) > tip_angle) return std::nullopt;
    Turns t = start;
    if (!reach(blade, r, z, t)) return std::nullopt;
    const auto p = on_envelope(blade, t);
    if (p.up_blade < start_up()) return std::nullopt;
    return mirror * azimuth(p.place) + turned;
  }
};

/// The turn of the wheel that the pinion's flank asks for, with the pinion at `turn` about its own axis.
double asked_turn(const Flank& wheel, const Flank& pinion, int side, double turn, double moved_mm, double root_angle) {
  // Housing: the wheel's frame; the pinion's axis along x, its azimuth 0 along z.
  const auto of = [&](double share, double height) {
    const double polar = root_angle + height * (pinion.tip_angle - root_angle);
    const double d = (pinion.outer - pinion.width * (1 - share)) / std::cos(polar - pinion.pitch_angle);
    const double r = d * std::sin(polar), z = d * std::cos(polar);
    const auto phi = pinion.azimuth_at(r, z);
    if (!phi) return -1e9;
    const Vec3 q(z + moved_mm, -r * std::sin(*phi + turn), r * std::cos(*phi + turn));
    const auto flank = wheel.azimuth_at(std::hypot(q.x(), q.y()), q.z());
    return flank ? -side * (azimuth(q) - *flank) : -1e9;
  };
  double best = -1e9, share = 0.5, height = 0.5;
  const auto try_at = [&](double s, double h) {
    if (s < 0 || s > 1 || h < 0 || h > 1) return;
    const double value = of(s, h);
    if (value > best) best = value, share = s, height = h;
  };
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) try_at(i / 40.0, j / 40.0);
  for (double step = 1 / 80.0; step > 1e-6; step /= 2) {
    const double s = share, h = height;
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) try_at(s + i * step, h + j * step);
  }
  return best;
}

TEST(PublishedPair, RollsAsAnIndependentProgramRollsIt) {
  const double root_w = radians(67.683333267), root_p = radians(16.86666664);
  const Blade pinion_concave{75.326783003, radians(18.045669752), 0.8,         1,
                             74.874171554, radians(63.942030463), 3.926227758, 0.296487394,
                             -1.021857659, 3.242698536,           root_p};
  const Blade pinion_convex{78.011176388, radians(24.337423854), 0.8,          -1,
                            71.146656284, radians(53.925994547), -4.426244511, -0.399016782,
                            1.375229989,  3.105176807,           root_p};
  Blade wheel_concave{77.0255, radians(22), 0.7, 1, 72.642731192, radians(59.2342023), 0, 0, 0, 1.051674445, root_w};
  Blade wheel_convex = wheel_concave;
  wheel_convex.point_radius = 75.3745, wheel_convex.lean = -1;
  const double delta_w = radians(71.5666666), delta_p = radians(18.4333333), mean = 93.7514 - 12.7;

  const auto wheel_part = spiral_bevel::part_of(spiral_bevel::SpiralBevelGear::make(nasa_gear()).value());
  const auto pinion_part = spiral_bevel::part_of(spiral_bevel::SpiralBevelGear::make(nasa_pinion()).value());
  for (const auto& [side, moved] : {std::pair(-1, 0.0), {-1, 0.55}, {1, 0.5}}) {
    Flank wheel{side < 0 ? wheel_convex : wheel_concave, delta_w, radians(73.1333332)};
    wheel.mirror = -1, wheel.turned = 0.000305690;
    Flank pinion{side < 0 ? pinion_concave : pinion_convex, delta_p, radians(22.3166667)};
    wheel.seed(), pinion.seed();
    const double raw = pinion.azimuth_at(mean * std::sin(delta_p), mean * std::cos(delta_p)).value();
    pinion.turned = -side * 6.1 / (2 * mean * std::sin(delta_p)) - raw;

    contact::OutsideShafts shafts;
    shafts.angle_rad = radians(90), shafts.mate_axial_mm = moved;
    const contact::ToothedPair pair{wheel_part.get(), pinion_part.get(), contact::outside_place(shafts)};
    const auto of = contact::toothed_members(pair, side, {13, 17, 17, 33}).value();
    contact::RollOptions options;
    options.steps = 4;
    const contact::RollResult rolled = contact::roll(of, options).value();
    for (const auto& at : rolled.cycle) {
      double most = -1e9;
      for (int tooth = -1; tooth <= 1; ++tooth)
        most = std::max(
            most, asked_turn(wheel, pinion, side, -(at.phi_1 + of[0].turned_rad + kTwoPi * tooth / 12), moved, root_p) +
                      side * kTwoPi * tooth / 36);
      EXPECT_NEAR(-side * most, at.phi_2, 5e-8) << side << " " << moved;
    }
  }
}

}  // namespace
}  // namespace toothpath::test
