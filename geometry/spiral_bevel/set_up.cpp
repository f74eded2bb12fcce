#include "geometry/spiral_bevel/set_up.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/followed.h"

namespace toothpath::spiral_bevel {
namespace {

using tooth_space::Chart;
using tooth_space::Piece;

constexpr double kWidestRoll = 1.3;  // rad from the middle of the face; what is rolled is less than half of it
constexpr int kPlaces = 520, kHalvings = 60;
constexpr double kSameRoot = 1e-9;  // mm and rad: two cuts leave one root cone
constexpr double kUneven = 8;       // s by v or v by s: a flank that is followed worse asks for the other way

Chart chart_of(const SpiralBevelParameters& gear) {
  return {-std::sin(gear.pitch_angle_rad), std::cos(gear.pitch_angle_rad)};
}

Piece piece_of(const CutterKernel& k, std::size_t flank) {
  return tooth_space::flank_of((flank == 0 ? 1 : -1) * k.hand);
}

CutFlank settings_of(const SpiralBevelParameters& gear, std::size_t flank) {
  const Cut& cut = gear.cuts[cut_of(gear, flank)];
  const Blade& blade = cut.blades[flank];
  CutFlank f;
  f.out = flank == 0 ? 1 : -1;
  f.rho_0 = blade.point_radius_mm;
  f.alpha = blade.pressure_angle_rad;
  f.sin_a = std::sin(f.alpha);
  f.cos_a = std::cos(f.alpha);
  f.edge = blade.edge_radius_mm;
  f.u_F = f.edge * (1 - f.sin_a) / f.cos_a;
  f.rho_c = f.rho_0 - f.out * f.u_F;
  f.generated = cut.generated;
  f.tilted = cut.tilt_rad != 0;
  f.S = cut.radial_distance_mm;
  f.q = cut.cradle_angle_rad;
  f.sin_g = std::sin(cut.root_angle_rad);
  f.cos_g = std::cos(cut.root_angle_rad);
  const Vec3 z_m(f.cos_g, 0, -f.sin_g);
  f.centre = Vec3(0, 0, -cut.machine_center_mm) + cut.sliding_base_mm * z_m + Vec3(0, cut.work_offset_mm, 0);
  const Vec3 housing = Vec3::UnitZ().cross(f.centre);
  f.moment = {f.sin_g * housing.x() + f.cos_g * housing.z(), -housing.y(), z_m.dot(housing)};
  double factor = cut.ratio_of_roll;
  f.roll[0] = factor;
  for (const double coefficient : cut.modified) {
    const std::size_t power = f.rolls + 1;
    factor /= double(power);
    f.roll[f.rolls++] = -factor * coefficient;
  }
  const auto about_z = [](double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()); };
  if (f.tilted)
    f.tilt = (about_z(cut.swivel_rad) * Eigen::AngleAxisd(cut.tilt_rad, Vec3::UnitY()) * about_z(-cut.swivel_rad))
                 .toRotationMatrix();
  return f;
}

/// The edge between fillet and root, by what grows with v: s, and how far that is from the middle of the roll (Formate:
/// where it stands about the axis). Nothing: there is no such place, or it lies behind the axis.
std::optional<Vec2> edge_at(const CutFlank& f, const Chart& chart, double t) {
  CutFlank plain = f;
  plain.at_mean = t;
  Vec3 p, n;
  if (!plain.place<double>(true, kPi / 2, 0.0, p, n)) return {};
  if (!f.generated) return p.x() > 0 ? std::optional(Vec2(chart.along(p), azimuth(p))) : std::nullopt;
  const double roll =
      f.by_circle ? *plain.roll_of_place<double>(plain.profile<double>(true, kPi / 2), {std::cos(t), std::sin(t)}) : t;
  if (!(Turn(plain.work(roll).angle).back(p).x() > 0)) return {};
  return Vec2(chart.along(p), roll);
}

/// Finds where the edge passes the middle of the face: nearest to roll 0, or to the root line without a roll.
bool find_middle(CutFlank& f, const Chart& chart, double s_mean) {
  double best = INFINITY;
  const bool circle = !f.generated || f.by_circle;
  const double from = circle ? 0 : -kWidestRoll, to = circle ? kTwoPi : kWidestRoll;
  CutFlank tried = f;
  for (const double branch : {1.0, -1.0}) {
    if (!f.generated && branch < 0) continue;
    tried.branch = branch;
    std::optional<Vec2> before;
    for (int k = 0; k <= kPlaces; ++k) {
      double t = from + (to - from) * k / kPlaces, low = t - (to - from) / kPlaces, high = t;
      const auto here = edge_at(tried, chart, t);
      if (here && before && (here->x() - s_mean) * (before->x() - s_mean) <= 0) {
        const bool rises = here->x() > before->x();
        for (int h = 0; h < kHalvings; ++h) {
          t = 0.5 * (low + high);
          const auto middle = edge_at(tried, chart, t);
          if (!middle) break;
          ((middle->x() < s_mean) == rises ? low : high) = t;
        }
        const auto at = edge_at(tried, chart, t);
        const double away = at ? std::abs(at->y()) : INFINITY;
        if (away < best && std::abs(at->x() - s_mean) < 1e-6) {
          best = away;
          f.branch = branch;
          f.at_mean = t;
        }
      }
      before = here;
    }
  }
  if (!std::isfinite(best)) return false;
  constexpr double kStep = 1e-5;
  const auto a = edge_at(f, chart, f.at_mean - kStep), b = edge_at(f, chart, f.at_mean + kStep);
  if (!a || !b || a->x() == b->x()) return false;
  f.v_mean = s_mean;
  f.per_s = 2 * kStep / (b->x() - a->x());
  return true;
}

/// Up or down a flank at s, from one height to another near it.
std::optional<Vec2> climbed(const CutterKernel& k, Piece piece, double s, double h_from, double h_to, const Vec2& at) {
  const auto solve = [&](const Vec2& from, double h) { return k.solve(piece, s, h, from); };
  return followed<Vec2>(at, h_from, h_to, Vec2(0, 0), solve);
}

/// v of the edge between fillet and flank at s, from the root over the fillet.
std::optional<double> over_fillet(const CutterKernel& k, std::size_t flank, double s) {
  constexpr int kSteps = 12;
  const Piece fillet = tooth_space::fillet_of(tooth_space::side_of(piece_of(k, flank)));
  const double way = k.flanks[flank].alpha - kPi / 2;
  std::optional<double> v = s;
  for (int n = 1; n <= kSteps && v; ++n)
    v = followed<double>(*v, kPi / 2 + way * (n - 1) / kSteps, kPi / 2 + way * n / kSteps, 0.0,
                         [&](double near, double u) { return k.solve_v(fillet, u, s, near); });
  return v;
}

/// Along the face from its middle; not a number from where the flank ends.
void lay_rails(CutterKernel& k, std::size_t flank) {
  constexpr std::size_t kMiddle = CutterKernel::kRails / 2;
  constexpr int kSteps = 8;
  const Piece piece = piece_of(k, flank);
  auto& rails = k.rails[flank];
  const double s_mean = -0.5 * (k.R_e + k.R_i), step = (k.R_e - k.R_i) / double(CutterKernel::kRails - 1),
               h_mean = k.tip<double>(s_mean);
  const Vec2 none(NAN, NAN);
  Vec2 tip = k.middle[flank];
  for (int n = 1; n <= kSteps; ++n)
    tip = climbed(k, piece, s_mean, h_mean * (n - 1) / kSteps, h_mean * n / kSteps, tip).value_or(none);
  // From places near the fillet, half way and at the tip; in halves of the way where v turns quickly.
  const auto lay = [&](std::size_t n, double s_near, const std::array<double, 3>& near, const Vec2& edge) {
    const double s = -k.R_e + step * double(n), u_F = k.flanks[flank].u_F;
    const auto on_tip = [&](const Vec2& from, double to) { return k.solve(piece, to, k.tip<double>(to), from); };
    const Vec2 at = followed<Vec2>(edge, s_near, s, Vec2(0, 1), on_tip).value_or(none);
    const auto at_u = [&](double u, double from) {
      const auto solve = [&](double v, double to) { return k.solve_v(piece, u, to, v); };
      return followed<double>(from, s_near, s, 1.0, solve).value_or(NAN);
    };
    CutterKernel::Rail& rail = rails[n];
    rail.u_tip = at.x();
    rail.v = {at_u(u_F, near[0]), at_u(0.5 * (u_F + at.x()), near[1]), at.y()};
  };
  lay(kMiddle, s_mean, {over_fillet(k, flank, s_mean).value_or(s_mean), k.middle[flank].y(), 0}, tip);
  for (const int way : {-1, 1})
    for (std::size_t n = kMiddle; n != (way < 0 ? 0 : CutterKernel::kRails - 1);) {
      const CutterKernel::Rail& from = rails[n];
      const double s = -k.R_e + step * double(n);
      n = way < 0 ? n - 1 : n + 1;
      lay(n, s, {from.v[0], from.v[1], 0}, {from.u_tip, from.v[2]});
    }
}

/// Where a flank meets the pitch cone in the middle of the face, as it is cut.
std::optional<Refusal> meet_pitch_cone(const SpiralBevelParameters& gear, CutterKernel& k, std::size_t flank) {
  const Piece piece = piece_of(k, flank);
  const double R_m = gear.mean_cone_distance();
  const char* name = flank == 0 ? "concave" : "convex";
  const double u_F = k.flanks[flank].u_F;
  const auto height = [&](double v) {
    Vec3 p, n;
    return k.place<double>(piece, u_F, v, p, n) ? chart_of(gear).up(p) : NAN;
  };
  if (const double h_F = height(-R_m); !(h_F < 0))
    return Refusal{cut_key(gear, flank, "sliding_base"),
                   fail("sliding_base = {:.4f} mm: the {} flank begins {:.4f} mm above the pitch cone at cone distance "
                        "{:.4f} mm, limit 0",
                        gear.cuts[cut_of(gear, flank)].sliding_base_mm, name, h_F, R_m)};
  // Upwards along the blade in steps: the pitch cone may lie far above the fillet. Beside an undercut, where v runs
  // quickly over the fillet, from where that leads.
  const auto up_from = [&](double v_F) {
    constexpr int kSteps = 8;
    const double h_F = height(v_F);
    std::optional<Vec2> at = Vec2(u_F, v_F);
    for (int step = kSteps; step > 0 && at; --step)
      at = climbed(k, piece, -R_m, h_F * step / kSteps, h_F * (step - 1) / kSteps, *at);
    return at;
  };
  auto at = up_from(-R_m);
  if (!at)
    if (const auto v_F = over_fillet(k, flank, -R_m); v_F && height(*v_F) < 0) at = up_from(*v_F);
  if (!at)
    return Refusal{
        cut_key(gear, flank, "blade_pressure_angle"),
        fail("blade_pressure_angle = {:.4f} deg: the cutter undercuts the {} flank, which does not reach the "
             "pitch cone at cone distance {:.4f} mm; more pressure angle or less depth is needed",
             degrees(k.flanks[flank].alpha), name, R_m)};
  k.middle[flank] = *at;
  return {};
}

/// How unevenly a flank and its fillet are followed, over the face and a little beyond it: the most that s changes by
/// v, or v by s. Infinite where they turn back, or are not found, within the face; beyond it that is no more than bad.
double unevenness(const CutterKernel& k, std::size_t flank) {
  constexpr int kAlong = 7, kFillet = 12, kFlank = 12;
  constexpr double kBeyond = 0.1;  // of the face
  constexpr double kBad = 1e3;
  using D = Dual<double, 2>;
  const tooth_space::Chart chart = k.outline().chart;
  const CutFlank& f = k.flanks[flank];
  const Piece wall = piece_of(k, flank), fillet = tooth_space::fillet_of(tooth_space::side_of(wall));
  const double face = k.R_e - k.R_i;
  double worst = 1;
  for (int n = 0; n < kAlong; ++n) {
    const double share = n == 0            ? -kBeyond
                         : n == kAlong - 1 ? 1 + kBeyond
                                           : double(n - 1) / (kAlong - 3),
                 s = -k.R_e + share * face;
    const double u_tip = k.about_tip(tooth_space::side_of(wall), std::clamp(s, -k.R_e, -k.R_i)).x();
    double v = s;
    // From the root through the fillet up the flank.
    const auto follow = [&](Piece piece, double from, double to, int steps) {
      const auto at_u = [&](double near, double u) { return k.solve_v(piece, u, s, near); };
      for (int step = 0; step <= steps; ++step) {
        const double before = from + (to - from) * std::max(0, step - 1) / steps, u = from + (to - from) * step / steps;
        v = followed<double>(v, before, u, 0.0, at_u).value_or(NAN);
        Vec3T<D> p, normal;
        if (!k.place<D>(piece, D(u), D::variable(v, 1), p, normal)) return false;
        const double by_v = chart.along(value(p), derivative(p, 1));
        if (!(by_v > 0)) return false;
        worst = std::max({worst, by_v, 1 / by_v});
      }
      return true;
    };
    if (follow(fillet, kPi / 2, f.alpha, kFillet) && follow(wall, f.u_F, u_tip, kFlank)) continue;
    if (n > 0 && n < kAlong - 1) return INFINITY;
    worst = std::max(worst, kBad);
  }
  return worst;
}

/// The work turns with the cradle over the whole face.
std::optional<Refusal> turns_back(const SpiralBevelParameters& gear, const CutterKernel& k, std::size_t flank) {
  const CutFlank& f = k.flanks[flank];
  for (const double s : {-k.R_e, -k.R_i})
    if (const double roll = f.parameter(s); f.generated && !f.by_circle && !(f.work(roll).ratio > 0))
      return stands_still(gear, flank, f, roll, -s);
  return {};
}

/// A flank along the face, by what grows with v.
std::optional<Refusal> lay_flank(const SpiralBevelParameters& gear, CutterKernel& k, std::size_t flank) {
  const double R_m = gear.mean_cone_distance();
  if (!find_middle(k.flanks[flank], chart_of(gear), -R_m))
    return Refusal{cut_key(gear, flank, "radial_distance"),
                   fail("radial_distance = {:.4f} mm: the {} blade does not pass the middle of the face, cone "
                        "distance {:.4f} mm, at any roll",
                        k.flanks[flank].S, flank == 0 ? "outside" : "inside", R_m)};
  if (auto refusal = turns_back(gear, k, flank)) return refusal;
  if (auto refusal = meet_pitch_cone(gear, k, flank)) return refusal;
  lay_rails(k, flank);
  return {};
}

/// By its roll where that grows evenly enough, else by the place on the circles of its blade if that grows more evenly.
/// What is told is of the roll.
std::optional<Refusal> follow_flank(const SpiralBevelParameters& gear, CutterKernel& k, std::size_t flank,
                                    bool by_rolls) {
  const Cut& cut = gear.cuts[cut_of(gear, flank)];
  auto refusal = lay_flank(gear, k, flank);
  if (by_rolls || !cut.generated || cut.tilt_rad != 0 || !cut.modified.empty()) return refusal;
  const double by_roll = refusal ? INFINITY : unevenness(k, flank);
  if (by_roll <= kUneven) return refusal;
  CutterKernel other = k;
  other.flanks[flank] = settings_of(gear, flank);
  other.flanks[flank].by_circle = true;
  if (lay_flank(gear, other, flank) || !(unevenness(other, flank) < by_roll)) return refusal;
  k = other;
  return {};
}
}  // namespace

std::size_t cut_of(const SpiralBevelParameters& gear, std::size_t flank) {
  return gear.cuts.front().makes(flank == 0 ? Cuts::concave : Cuts::convex) ? 0 : 1;
}
std::string cut_key(const SpiralBevelParameters& gear, std::size_t flank, const char* name) {
  return fmt::format("cut[{}].{}", cut_of(gear, flank), name);
}

Refusal stands_still(const SpiralBevelParameters& gear, std::size_t flank, const CutFlank& f, double roll_rad,
                     double cone_distance_mm) {
  const std::vector<double>& modified = gear.cuts[cut_of(gear, flank)].modified;
  return {cut_key(gear, flank, "modified_roll_coefficients"),
          fail("modified_roll_coefficients = [{:g}]: work per cradle is {:.4f} at a roll of {:.4f} deg, which cone "
               "distance {:.4f} mm needs, limit 0: the work stands still or turns back",
               fmt::join(modified, ", "), f.work(roll_rad).ratio, degrees(roll_rad), cone_distance_mm)};
}

double root_apex_z(const Cut& cut) {
  return -(cut.machine_center_mm + cut.sliding_base_mm / std::sin(cut.root_angle_rad));
}

double cone_height(const SpiralBevelParameters& gear, double angle_rad, double apex_z, double s) {
  const Chart chart = chart_of(gear);
  const double s_0 = -chart.sine * apex_z, h_0 = chart.cosine * apex_z;
  return h_0 - std::tan(angle_rad - gear.pitch_angle_rad) * (s - s_0);
}

double asked_space_width(const SpiralBevelParameters& gear) {
  if (gear.mean_space_width_mm) return *gear.mean_space_width_mm;
  const double R_m = gear.mean_cone_distance();
  return kPi * R_m * std::sin(gear.pitch_angle_rad) / gear.teeth +
         0.5 * gear.backlash_mm.value_or(0) * R_m / gear.outer_cone_distance_mm;
}

Expected<SetUp, Refusal> set_up(const SpiralBevelParameters& gear, bool by_rolls) {
  SetUp out;
  CutterKernel& k = out.kernel;
  k.teeth = gear.teeth;
  k.hand = gear.hand;
  k.sin_d = std::sin(gear.pitch_angle_rad);
  k.cos_d = std::cos(gear.pitch_angle_rad);
  k.R_e = gear.outer_cone_distance_mm;
  k.R_i = k.R_e - gear.face_width_mm;
  k.tip_0 = cone_height(gear, gear.tip_angle_rad, -gear.tip_apex_mm, 0);
  k.tip_slope = -std::tan(gear.tip_angle_rad - gear.pitch_angle_rad);
  const double r_m = gear.mean_cone_distance() * k.sin_d;
  const Cut &concave = gear.cuts[cut_of(gear, 0)], &convex = gear.cuts[cut_of(gear, 1)];
  for (std::size_t i = 0; i < 2; ++i) k.flanks[i] = settings_of(gear, i);
  for (std::size_t i = 0; i < 2; ++i)
    if (auto refusal = follow_flank(gear, k, i, by_rolls)) return std::move(*refusal);
  const bool one_cone = std::abs(concave.root_angle_rad - convex.root_angle_rad) < kSameRoot &&
                        std::abs(root_apex_z(concave) - root_apex_z(convex)) < kSameRoot;
  const bool tilted = concave.tilt_rad != 0 || convex.tilt_rad != 0;
  k.root = !concave.generated && &concave == &convex  ? RootForm::plane
           : concave.generated && one_cone && !tilted ? RootForm::cone
                                                      : RootForm::woven;
  std::array<double, 2> azimuths{};
  for (std::size_t i = 0; i < 2; ++i) {
    Vec3 p, n;
    (void)k.place<double>(piece_of(k, i), k.middle[i].x(), k.middle[i].y(), p, n);
    azimuths[i] = -gear.hand * azimuth(p);  // of the left hand
  }
  if (&concave == &convex) {
    out.space_width_mm = std::remainder(azimuths[0] - azimuths[1], kTwoPi) * r_m;
    const double middle = azimuths[1] + 0.5 * std::remainder(azimuths[0] - azimuths[1], kTwoPi);
    for (CutFlank& f : k.flanks) f.turn = -middle;
  } else {
    out.space_width_mm = asked_space_width(gear);
    for (std::size_t i = 0; i < 2; ++i)
      k.flanks[i].turn = (i == 0 ? 0.5 : -0.5) * out.space_width_mm / r_m - azimuths[i];
  }
  return out;
}

}  // namespace toothpath::spiral_bevel
