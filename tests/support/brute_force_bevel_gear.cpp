#include "tests/support/brute_force_bevel_gear.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/modified_flank.h"

namespace toothpath::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Least value beside the middle one of three places: parabolas, halves where they fail.
template <class F>
double least_beside(const F& f, double a, double m, double b, double fm, double* at) {
  double fa = f(a), fb = f(b);
  for (int k = 0; k < 40 && b - a > 1e-9 * (1 + std::abs(m)); ++k) {
    const double p = (m - a) * (m - a) * (fm - fb), q = (m - b) * (m - b) * (fm - fa),
                 down = (m - a) * (fm - fb) - (m - b) * (fm - fa);
    double t = down != 0 ? m - 0.5 * (p - q) / down : m;
    const double least = 0.02 * (b - a);
    if (!(t > a + least && t < b - least) || k % 4 == 3 || std::abs(t - m) < least)
      t = b - m > m - a ? m + 0.3 * (b - m) : m - 0.3 * (m - a);
    const double ft = f(t);
    if (ft < fm) {
      (t > m ? a : b) = m;
      (t > m ? fa : fb) = fm;
      m = t;
      fm = ft;
    } else {
      (t > m ? b : a) = t;
      (t > m ? fb : fa) = ft;
    }
    if (std::max(fa, fb) - fm < 1e-10) break;
  }
  if (at) *at = m;
  return fm;
}

template <class F>
double least_in(const F& f, double from, double to, int places, double enough, double* at) {
  std::array<double, 64> sampled{};
  const double step = (to - from) / (places - 1);
  int low = 0;
  for (int k = 0; k < places; ++k) {
    const double v = sampled[std::size_t(k)] = f(from + k * step);
    if (v < sampled[std::size_t(low)]) low = k;
    if (v <= enough) {
      if (at) *at = from + k * step;
      return v;
    }
  }
  double least = sampled[std::size_t(low)], where = from + low * step;
  for (int k = 0; k < places; ++k) {
    const double v = sampled[std::size_t(k)], before = k > 0 ? sampled[std::size_t(k - 1)] : v,
                 after = k + 1 < places ? sampled[std::size_t(k + 1)] : v;
    // What lies lower between places than the lowest of them by more than the slopes beside it is not there.
    if (v > before || v > after || v - std::max(before - v, after - v) > least) continue;
    double found = 0;
    const double m = std::clamp(from + k * step, from + 0.01 * step, to - 0.01 * step);
    const double refined =
        least_beside(f, std::max(from, m - step), m, std::min(to, m + step), m == from + k * step ? v : f(m), &found);
    if (refined < least) least = refined, where = found;
  }
  if (at) *at = where;
  return least;
}

}  // namespace

namespace {

/// Are these made by the path of the mill?
bool over_face(modification::Kind kind) {
  using modification::Kind;
  return kind == Kind::end_relief || kind == Kind::lead_crowning || kind == Kind::helix_angle_slope;
}

TakenAtDepth taken_by_profile(const bevel_gear::BevelGearParameters& g) {
  std::vector<modification::Modification> those;
  for (const auto& m : g.modifications)
    if (!over_face(m.kind) && m.amount_mm != 0) those.push_back(m);
  if (those.empty()) return nullptr;
  return [those, depth = 2 * g.addendum_mm](double y) {
    double taken = 0;
    for (const auto& m : those) taken += taken_by_the_words<double>(m, y, 0, depth, 0, 1);
    return taken;
  };
}

}  // namespace

double least_of(const std::function<double(double)>& f, double from, double to, int places, double* at) {
  return least_in(f, from, to, places, -1e300, at);
}

PlainFingerMill::PlainFingerMill(const FingerMill& mill, double alpha, double r_v, double dedendum, TakenAtDepth taken,
                                 double bent_to, double addendum)
    : taken_(std::move(taken)),
      addendum_(addendum),
      r_v_(r_v),
      r_b_(r_v * std::cos(alpha)),
      r_0_(kPi * mill.module / 4),
      dedendum_(dedendum),
      r_t_(mill.tip_radius) {
  // The tooth space of the equivalent gear: on the pitch circle half of it is r_0, on the base circle less by
  // inv(alpha).
  start_ = r_0_ / r_v - (std::tan(alpha) - alpha);
  // Where a rack of that depth ends on the line of action; not below the base circle.
  t_C_ = std::max(0.0, r_v * std::sin(alpha) - mill.rack_depth / std::sin(alpha));
  C_ = involute(t_C_);
  S_ = C_;
  if (taken_) {
    to_S_ = std::max(0.0, (C_.x - (addendum - bent_to)) / C_.normal_rho);
    S_ = to_S_ > 0 ? modified([&](double back) { return plain_line(back); }, to_S_, 1e-5)
                   : modified([&](double t) { return involute(t); }, t_C_, 1e-5 * r_b_ / std::max(t_C_, 1e-3));
  }
  const double sin_phi = S_.normal_x * -1, cos_phi = S_.normal_rho;
  x_o_ = r_t_ - dedendum;
  rho_o_ = S_.rho + (x_o_ - S_.x) * sin_phi / cos_phi - r_t_ / cos_phi;
  to_B_ = (x_o_ - r_t_ * sin_phi - S_.x) * cos_phi + (rho_o_ + r_t_ * cos_phi - S_.rho) * sin_phi;
  x_D_ = mill.profile_height;
  double low = t_C_, high = t_C_ + 40 * mill.module;
  const auto place = [&](double t) {
    return taken_ ? modified([&](double at) { return involute(at); }, t, 1e-5) : involute(t);
  };
  for (int k = 0; k < 100; ++k) (place(0.5 * (low + high)).x < x_D_ ? low : high) = 0.5 * (low + high);
  t_D_ = low;
  rho_D_ = place(t_D_).rho;
}

PlainFingerMill::Place PlainFingerMill::plain_line(double back) const {
  return {C_.x - back * C_.normal_rho, C_.rho + back * C_.normal_x, C_.normal_x, C_.normal_rho};
}

PlainFingerMill::Place PlainFingerMill::modified(const std::function<Place(double)>& plain, double at,
                                                 double step) const {
  const auto moved = [&](double t) {
    const Place q = plain(t);
    const double c = taken_(addendum_ - q.x);
    return Place{q.x + c * q.normal_x, q.rho + c * q.normal_rho, q.normal_x, q.normal_rho};
  };
  Place here = moved(at);
  const Place a = moved(at - step), b = moved(at + step);
  const double dx = b.x - a.x, dr = b.rho - a.rho, length = std::hypot(dx, dr), sign = dx > 0 ? 1 : -1;
  here.normal_x = -sign * dr / length;
  here.normal_rho = sign * dx / length;
  return here;
}

/// The point of the involute whose tangent to the base circle is so long.
PlainFingerMill::Place PlainFingerMill::involute(double t) const {
  const double turn = start_ + t / r_b_;
  return {r_b_ * std::cos(turn) + t * std::sin(turn) - r_v_, r_b_ * std::sin(turn) - t * std::cos(turn),
          -std::sin(turn), std::cos(turn)};
}

double PlainFingerMill::clearance(double x, double rho) const {
  const double to_flat = -dedendum_ - x;
  if (x >= x_D_) return rho - rho_D_;
  const double from_C = (x - C_.x) * C_.normal_rho - (rho - C_.rho) * C_.normal_x;  // on the line, towards the shank
  if (from_C >= 0) {
    const double R = std::hypot(x + r_v_, rho), t = std::sqrt(std::max(0.0, R * R - r_b_ * r_b_));
    const double foot = r_b_ * (std::atan2(rho, x + r_v_) + std::atan2(t, r_b_) - start_);
    // Of a modified flank the zero is exact, what is beside it by the cosine of its lean.
    const double more = taken_ ? taken_(addendum_ - involute(foot).x) : 0;
    return std::max(foot - t - more, to_flat);
  }
  const double sin_phi = -S_.normal_x, cos_phi = S_.normal_rho;
  const double along = (x - S_.x) * cos_phi + (rho - S_.rho) * sin_phi;
  if (taken_ && along >= 0)
    return std::max(
        (x - C_.x) * C_.normal_x + (rho - C_.rho) * C_.normal_rho - taken_(addendum_ - plain_line(-from_C).x), to_flat);
  const double to_line = (x - S_.x) * S_.normal_x + (rho - S_.rho) * S_.normal_rho;
  if (along >= to_B_) return std::max(to_line, to_flat);
  const double u = x - x_o_, v = rho - rho_o_;
  if (v <= 0 || (u > 0 && to_line < 0)) return std::max(to_line, to_flat);
  return std::hypot(u, v) - r_t_;
}

std::vector<PlainFingerMill::Place> PlainFingerMill::places(double to_x, int count) const {
  const double phi = std::atan2(-S_.normal_x, S_.normal_rho), arc = r_t_ * (kPi / 2 - phi), line = to_S_ - to_B_;
  double t_end = t_C_, high = t_D_;
  for (int k = 0; k < 60; ++k) {
    const double t = 0.5 * (t_end + high);
    (involute(t).x < to_x ? t_end : high) = t;
  }
  // Along arc, line and involute; the last grows with the square of its tangent.
  const double involute_length = (t_end * t_end - t_C_ * t_C_) / (2 * r_b_), all = arc + line + involute_length;
  std::vector<Place> out;
  for (int k = 0; k < count; ++k) {
    const double s = all * (k + 0.5) / count;
    if (s < arc) {
      const double a = kPi - s / r_t_;  // direction in (x, rho): from -x to the normal of the line
      out.push_back({x_o_ + r_t_ * std::cos(a), rho_o_ + r_t_ * std::sin(a), std::cos(a), std::sin(a)});
    } else if (s < arc + line - to_S_) {
      const double back = arc + line - to_S_ - s;
      out.push_back({S_.x - back * S_.normal_rho, S_.rho + back * S_.normal_x, S_.normal_x, S_.normal_rho});
    } else if (s < arc + line) {
      out.push_back(modified([&](double back) { return plain_line(back); }, arc + line - s, 1e-5));
    } else {
      const double t = std::sqrt(t_C_ * t_C_ + 2 * r_b_ * (s - arc - line));
      out.push_back(taken_ ? modified([&](double at) { return involute(at); }, t, 1e-5) : involute(t));
    }
  }
  return out;
}

double PlainFingerMill::radius_at(double x) const {
  double low = 0, high = 4 * rho_D_;
  for (int k = 0; k < 80; ++k) (clearance(x, 0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
  return low;
}

std::array<double, 2> PlainFingerMill::largest_tip_radii() const {
  const double sin_phi = -S_.normal_x, cos_phi = S_.normal_rho;
  const double line_at_flat = S_.rho - (S_.x + dedendum_) * sin_phi / cos_phi;
  return {line_at_flat * cos_phi / (1 - sin_phi), (S_.x + dedendum_) / (1 - sin_phi)};
}

double BruteForceBevelGear::pitch_angle_of(const bevel_gear::BevelGearParameters& g) {
  if (g.mate_teeth == 0) return g.pitch_angle_rad;
  return std::atan2(std::sin(g.shaft_angle_rad), double(g.mate_teeth) / g.teeth + std::cos(g.shaft_angle_rad));
}

BruteForceBevelGear::BruteForceBevelGear(const bevel_gear::BevelGearParameters& g, const FingerMill& mill)
    : gear_(g),
      delta_(pitch_angle_of(g)),
      sin_d_(std::sin(delta_)),
      cos_d_(std::cos(delta_)),
      R_e_(g.teeth * g.outer_transverse_module_mm / (2 * sin_d_)),
      R_i_(R_e_ - g.face_width_mm),
      R_0_(R_e_ / std::pow(std::cos(g.outer_spiral_angle_rad), 2)),
      R_ref_(g.apex_cone_distance_mm > 0 ? g.apex_cone_distance_mm : R_e_ - g.face_width_mm / 2),
      half_space_(kPi / (2 * g.teeth) + g.backlash_mm / (4 * R_e_ * sin_d_)),
      pitch_(2 * kPi / g.teeth),
      herringbone_(g.form == bevel_gear::BevelForm::herringbone),
      inner_hand_(g.hand),
      lean_(g.pressure_angle_rad + kPi * mill.module / 4 / (R_0_ * sin_d_ / cos_d_)),
      mill_(mill, g.pressure_angle_rad, R_0_ * sin_d_ / cos_d_, g.dedendum_mm, taken_by_profile(g), 2 * g.addendum_mm,
            g.addendum_mm),
      paths_{path_of(1), path_of(-1)} {
  for (Path& path : paths_) tabulate(path);
}

double BruteForceBevelGear::beta(double R) const { return std::acos(std::sqrt(std::min(1.0, R / R_0_))); }

/// The trace: d theta / dR = h tan(beta) / R and cos^2(beta) = R / R_0, integrated.
double BruteForceBevelGear::trace(double R, int hand) const {
  const double at_ref = beta(R_ref_), here = beta(R);
  return 2 * hand * ((std::tan(at_ref) - at_ref) - (std::tan(here) - here));
}

double BruteForceBevelGear::width_at(double R, int sigma, bool outer) const {
  const double groove = herringbone_ ? gear_.relief_half_width_mm : 0;
  const double from = outer ? R_ref_ + groove : R_i_, to = herringbone_ && !outer ? R_ref_ - groove : R_e_;
  double taken = 0;
  for (const auto& m : gear_.modifications)
    if (over_face(m.kind) && m.amount_mm != 0 && m.meets(-sigma, outer ? 1 : 0))
      taken += taken_by_the_words<double>(m, 0, R, 2 * gear_.addendum_mm, from, to);
  return mill_.half_width() - taken / std::cos(lean_);
}

/// Cone distance of the foot of the path's point at R_c.
double BruteForceBevelGear::foot_of(double R_c, int sigma, int hand) const {
  const int eps = -sigma * hand;
  double R = std::min(R_c, R_0_);
  for (int k = 0; k < 60; ++k) {  // R^2 + r^2 + 2 eps R r sin(beta) = R_c^2
    const double r = width_at(R, sigma, is_outer(hand));
    const double side = eps * r * std::sin(beta(R));
    const double next = std::min(R_0_, std::sqrt(std::max(0.0, R_c * R_c - r * r + side * side)) - side);
    if (std::abs(next - R) < 1e-14 * R_c) return next;
    R = next;
  }
  return R;
}

double BruteForceBevelGear::on_equidistant(double R_c, int sigma, int hand) const {
  const int eps = -sigma * hand;
  const double R = foot_of(R_c, sigma, hand), b = beta(R), r = width_at(R, sigma, is_outer(hand));
  return trace(R, hand) + sigma * (std::atan2(r * std::cos(b), R + eps * r * std::sin(b)) - half_space_ * sin_d_);
}

BruteForceBevelGear::Path BruteForceBevelGear::path_of(int sigma) const {
  Path path;
  path.sigma = sigma;
  const auto centre = [&](double R, int eps) {
    const double r = width_at(R, sigma, is_outer(-sigma * eps));
    return std::sqrt(R * R + r * r + 2 * eps * R * r * std::sin(beta(R)));
  };
  const double r = mill_.half_width();
  const auto overrun = [&](double R) {
    return 1.25 * mill_.largest_radius() * std::sin(beta(R)) + 0.1 * gear_.outer_transverse_module_mm;
  };
  const int outer_hand = herringbone_ ? hand_of(true) : inner_hand_;
  const int inner_eps = -sigma * inner_hand_, outer_eps = -sigma * outer_hand;
  path.from = inner_eps < 0 ? R_i_ - overrun(R_i_) : R_i_;
  path.straight =
      outer_eps < 0 ? R_e_ : std::min(R_e_ + overrun(R_e_), centre(R_0_ * (1 - 0.36 * r * r / (R_0_ * R_0_)), 1));
  path.to = path.straight + 4 * mill_.largest_radius();
  if (!herringbone_) {
    path.corner_from = path.corner_to = path.from;
  } else if (inner_eps < 0) {  // convex: an arc between the ends of both equidistants
    path.corner_from = centre(R_ref_, -1);
    path.corner_to = centre(R_ref_, 1);
  } else {  // concave: where they cross
    double low = centre(R_ref_, -1), high = centre(R_ref_, 1);
    const auto apart = [&](double R_c) {
      return sigma * (on_equidistant(R_c, sigma, inner_hand_) - on_equidistant(R_c, sigma, outer_hand));
    };
    const bool rising = apart(high) > apart(low);
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      ((apart(middle) > 0) == rising ? high : low) = middle;
    }
    path.corner_from = path.corner_to = low;
  }
  // The run-out: the tangent of the equidistant, by a difference.
  const double step = 1e-5 * R_e_, a = path.straight - step, b = path.straight;
  const double theta = on_equidistant(b, sigma, outer_hand), before = on_equidistant(a, sigma, outer_hand),
               further = on_equidistant(a - step, sigma, outer_hand);
  const double slope = (3 * theta - 4 * before + further) / (2 * step), lean = std::atan(b * slope);
  path.straight_angle = theta + lean;
  path.straight_foot = b * std::sin(lean);
  return path;
}

double BruteForceBevelGear::polar(const Path& path, double R_c) const {
  if (R_c > path.straight) return path.straight_angle - std::asin(path.straight_foot / R_c);
  if (herringbone_ && R_c > path.corner_from && R_c < path.corner_to) {
    // About the corner of the trace, evenly from one distance to the other with the direction.
    const double inner = width_at(R_ref_, path.sigma, false), outer = width_at(R_ref_, path.sigma, true);
    double r = inner, low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double t = 0.5 * (low + high), turn = kPi / 2 + beta(R_ref_) * (1 - 2 * t);
      r = inner + (outer - inner) * t;
      (std::hypot(R_ref_ + r * std::cos(turn), r * std::sin(turn)) < R_c ? low : high) = t;
    }
    const double c = (R_c * R_c + R_ref_ * R_ref_ - r * r) / (2 * R_c * R_ref_);
    return path.sigma * (std::acos(std::min(1.0, c)) - half_space_ * sin_d_);
  }
  const bool outer = herringbone_ && R_c >= path.corner_to;
  return on_equidistant(R_c, path.sigma, outer ? hand_of(true) : inner_hand_);
}

void BruteForceBevelGear::tabulate(Path& path) const {
  constexpr int kSteps = 1500;
  std::vector<double> ends = {path.from, path.corner_from, path.corner_to, path.straight, path.to};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (!(ends[k + 1] > ends[k])) continue;
    Path::Piece piece{ends[k], (ends[k + 1] - ends[k]) / kSteps, {}};
    // Not on the ends themselves, where the formula of the neighbour holds.
    for (int n = 0; n <= kSteps; ++n)
      piece.polar.push_back(polar(path, std::clamp(ends[k] + n * piece.step, ends[k] + 1e-12, ends[k + 1] - 1e-12)));
    path.pieces.push_back(piece);
  }
}

/// Cubic between four nodes.
double BruteForceBevelGear::tabulated(const Path& path, double R_c) {
  std::size_t k = path.pieces.size() - 1;
  while (k > 0 && R_c < path.pieces[k].from) --k;
  const Path::Piece& piece = path.pieces[k];
  const double s = (R_c - piece.from) / piece.step;
  const auto n = std::size_t(std::clamp(std::floor(s), 1.0, double(piece.polar.size()) - 3));
  const double t = s - double(n), *v = &piece.polar[n - 1];
  return -t * (t - 1) * (t - 2) / 6 * v[0] + (t + 1) * (t - 1) * (t - 2) / 2 * v[1] - (t + 1) * t * (t - 2) / 2 * v[2] +
         (t + 1) * t * (t - 1) / 6 * v[3];
}

std::array<double, 2> BruteForceBevelGear::room(double R_c) const {
  std::array<double, 2> out{};
  for (std::size_t k = 0; k < 2; ++k)
    out[k] = tabulated(paths_[k], std::clamp(R_c, paths_[k].from, paths_[k].to)) / sin_d_;
  return out;
}

Vec3 BruteForceBevelGear::place(double ell, double azimuth, double height) const {
  const double r = ell * sin_d_ + height * cos_d_;
  return {r * std::cos(azimuth), r * std::sin(azimuth), ell * cos_d_ - height * sin_d_};
}

/// A place against the mill whose axis meets the pitch cone at R_c and stands square to it there.
double BruteForceBevelGear::to_mill(const Vec3& p, double R_c, double theta) const {
  const double e = theta / sin_d_, c = std::cos(e), s = std::sin(e);
  const double qx = c * p.x() + s * p.y(), qy = c * p.y() - s * p.x();
  return mill_.clearance(qx * cos_d_ - p.z() * sin_d_, std::hypot(qy, qx * sin_d_ + p.z() * cos_d_ - R_c));
}

double BruteForceBevelGear::clearance(const Vec3& p) const { return clearance(p, -1e9); }

double BruteForceBevelGear::clearance(const Vec3& p, double enough) const {
  const double ell = ell_of(p), theta = std::atan2(p.y(), p.x()) * sin_d_;
  const double from = std::max(paths_[0].from, paths_[1].from);
  if (ell >= from && theta >= tabulated(paths_[0], ell) && theta <= tabulated(paths_[1], ell))
    return -gear_.dedendum_mm - height_of(p);  // below the middle of some pass between the walls
  double least = 1e9;
  const double reach = 1.3 * mill_.largest_radius();
  for (const Path& path : paths_) {
    const double a = std::max(path.from, ell - reach), b = std::min(path.to, ell + reach);
    // Paths lean by less than 60 deg: one that is farther away in azimuth does not reach.
    if (a >= b || 0.5 * ell * std::abs(theta - tabulated(path, std::clamp(ell, path.from, path.to))) > reach) continue;
    const auto f = [&](double R_c) { return to_mill(p, R_c, tabulated(path, R_c)); };
    least = std::min(least, least_in(f, a, b, 15, std::min(enough, 1e8), nullptr));
    if (least <= enough) break;
  }
  return least;
}

bool BruteForceBevelGear::in_groove(double ell, double margin) const {
  return herringbone_ && std::abs(ell - R_ref_) < gear_.relief_half_width_mm + margin;
}

double BruteForceBevelGear::depth(const Vec3& p, double enough) const {
  const double ell = ell_of(p), height = height_of(p);
  double within = std::min({ell - R_i_, R_e_ - ell, gear_.addendum_mm - height});
  if (herringbone_)
    within =
        std::min(within, std::max(std::abs(ell - R_ref_) - gear_.relief_half_width_mm, -gear_.dedendum_mm - height));
  if (within <= enough || within < -0.2) return within;
  // Turned into the space whose middle is nearest; the next ones end where the lands do.
  const auto middle = room(ell);
  const double azimuth = std::atan2(p.y(), p.x()),
               turns = std::round((azimuth - 0.5 * (middle[0] + middle[1])) / pitch_);
  const double c = std::cos(turns * pitch_), s = std::sin(turns * pitch_);
  const double cut = clearance({c * p.x() + s * p.y(), c * p.y() - s * p.x(), p.z()}, enough);
  return std::min(within, cut);
}

double BruteForceBevelGear::wall(int sigma, double ell, double height) const {
  const auto between = room(ell);
  double in = 0.5 * (between[0] + between[1]), out = in - sigma * 0.5 * pitch_;
  for (int k = 0; k < 60; ++k) {
    const double azimuth = 0.5 * (in + out);
    (clearance(place(ell, azimuth, height), 0) <= 0 ? in : out) = azimuth;
  }
  return in;
}

double BruteForceBevelGear::normal_module(double R) const { return 2 * sin_d_ / gear_.teeth * R * std::sqrt(R / R_0_); }

double BruteForceBevelGear::corner_reach() const {
  const Path& concave = paths_[inner_hand_ > 0 ? 1 : 0];
  const double X = concave.corner_from, h = gear_.addendum_mm, rho = mill_.radius_at(h), step = 1e-4;
  double reach = 0;
  for (const bool outer : {false, true}) {
    const auto along = [&](double R_c) { return on_equidistant(R_c, concave.sigma, hand_of(outer)); };
    const double e = along(X) / sin_d_;
    // Where the circle neither enters nor leaves the mill that moves on.
    const auto leaves = [&](double turn) {
      const double y = -concave.sigma * rho * std::cos(turn), z = rho * std::sin(turn);
      const Vec3 q(h * cos_d_ + (z + X) * sin_d_, y, -h * sin_d_ + (z + X) * cos_d_);
      const Vec3 p(std::cos(e) * q.x() - std::sin(e) * q.y(), std::sin(e) * q.x() + std::cos(e) * q.y(), q.z());
      return to_mill(p, X + step, along(X + step)) > to_mill(p, X - step, along(X - step));
    };
    double low = -kPi / 2, high = kPi / 2;
    const bool below = leaves(low);
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (leaves(middle) == below ? low : high) = middle;
    }
    reach = std::max(reach, rho * std::abs(std::sin(low)));
  }
  return reach;
}

double BruteForceBevelGear::fillet_reach() const {
  const Path& concave = paths_[inner_hand_ > 0 ? 1 : 0];
  const double X = concave.corner_from, h = gear_.addendum_mm;
  // Is the wall at the tip of the teeth there made by the mill as it stands in the corner?
  const auto made_in_corner = [&](double ell) {
    const Vec3 p = place(ell, wall(concave.sigma, ell, h), h);
    const auto off = [&](double R_c) { return to_mill(p, R_c, tabulated(concave, R_c)); };
    const double there = off(X), step = 1e-3;
    return off(X - step) > there && off(X + step) > there;
  };
  double reach = 0;
  for (const double side : {-1.0, 1.0}) {
    double in = 0, out = 2 * mill_.largest_radius();
    for (int k = 0; k < 25; ++k) {
      const double middle = 0.5 * (in + out);
      (made_in_corner(X + side * middle) ? in : out) = middle;
    }
    reach = std::max(reach, std::abs(X + side * in - R_ref_));
  }
  return reach;
}

double BruteForceBevelGear::top_land(double ell) const {
  const double r = ell * sin_d_ + gear_.addendum_mm * cos_d_;
  return r * (wall(1, ell, gear_.addendum_mm) + pitch_ - wall(-1, ell, gear_.addendum_mm));
}

}  // namespace toothpath::test
