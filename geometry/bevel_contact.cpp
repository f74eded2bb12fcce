#include "geometry/bevel_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kAtEdge = 1e-9;  // of the cone distance: points on an edge count as on the flank

double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }
Mat3 turn_about_z(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(); }

void change_wall(BevelWall<double>& wall, const BevelGear& gear, const PinionChange& change) {
  const auto& p = gear.parameters();
  const auto& c = gear.cutter_data();
  const std::size_t w = wall.eps() < 0 ? 0 : 1;
  if (change.pressure_angle_rad[w] != 0 || change.equivalent_radius[w] != 0)
    wall.cutter = make_finger_profile<double>(p.pressure_angle_rad + change.pressure_angle_rad[w], gear.kappa_v() / (1 + change.equivalent_radius[w]),
                                              p.dedendum_mm, c.module_mm, c.tip_radius_mm, c.rack_depth_mm, c.profile_height_mm);
  const double turn = change.spiral_angle_rad[w];
  if (turn == 0) return;
  const double outer = std::cos(p.outer_spiral_angle_rad + turn);
  wall.trace.R_0 = gear.R_e() / (outer * outer);
  wall.trace.beta_ref = wall.trace.beta(gear.R_ref());
}

}  // namespace

Result<BevelPair> BevelPair::make(const BevelGear& pinion, const BevelGear& wheel, const BevelAssembly& assembly, const PinionChange& change) {
  const auto &p = pinion.parameters(), &w = wheel.parameters();
  const double ratio = double(w.teeth) / p.teeth;
  if (std::abs(wheel.sin_delta() / pinion.sin_delta() / ratio - 1) > 1e-9)
    return fail("pitch angles {:.6f} and {:.6f} deg do not fit {} and {} teeth", degrees(pinion.delta()), degrees(wheel.delta()), p.teeth, w.teeth);
  if (p.mate_teeth > 0 && std::abs(pinion.delta() + wheel.delta() - p.shaft_angle_rad) > 1e-9)
    return fail("pitch angles {:.6f} and {:.6f} deg do not add up to the shaft angle {:.6f} deg", degrees(pinion.delta()), degrees(wheel.delta()),
                degrees(p.shaft_angle_rad));
  if (std::abs(wheel.R_0() / pinion.R_0() - 1) > 0.02)
    return fail("R_0 = {:.4f} mm of the wheel differs from {:.4f} mm of the pinion by more than 2 %", wheel.R_0(), pinion.R_0());
  if (pinion.halves().size() != wheel.halves().size()) return fail("one gear has one hand, the other is a herringbone");
  for (std::size_t k = 0; k < pinion.halves().size(); ++k)
    if (pinion.halves()[k].hand == wheel.halves()[k].hand) return fail("half {} has the same hand on both gears: a pair needs opposite hands", k);
  BevelPair pair;
  pair.pinion_ = &pinion;
  pair.wheel_ = &wheel;
  pair.pinion_halves_ = pinion.halves();
  for (BevelHalf& half : pair.pinion_halves_)
    for (BevelWall<double>& wall : half.walls) change_wall(wall, pinion, change);
  pair.ratio_ = ratio;
  // Common pitch line g, normal m from the pinion into the wheel, t = g x m; the fixed frame is the pinion's blank frame at phi_1 = 0.
  const double s1 = pinion.sin_delta(), c1 = pinion.cos_delta(), s2 = wheel.sin_delta(), c2 = wheel.cos_delta();
  const Vec3 g(s1, 0, c1), m(c1, 0, -s1), t(0, 1, 0), g2(s2, 0, c2), m2(c2, 0, -s2);
  const Mat3 nominal = g * g2.transpose() - m * m2.transpose() - t * t.transpose();
  pair.placed_ = Eigen::AngleAxisd(assembly.shaft_angle_rad, t).toRotationMatrix() * nominal;
  pair.shift_ = assembly.offset_mm * t - assembly.pinion_axial_mm * Vec3::UnitZ() + assembly.wheel_axial_mm * pair.placed_.col(2);
  return pair;
}

Vec3 BevelPair::turned_to_pinion(const Vec3& direction, double phi_2) const { return placed_ * (turn_about_z(phi_2) * direction); }
Vec3 BevelPair::to_pinion(const Vec3& point, double phi_2) const { return turned_to_pinion(point, phi_2) + shift_; }

std::optional<double> BevelPair::turn_at(int half, int sigma, const Vec3& point, double phi_2, BevelInverse& start) const {
  const BevelHalf& own = pinion_halves_[static_cast<std::size_t>(half)];
  const ConePoint q = cone_point(to_pinion(point, phi_2), pinion_->sin_delta(), pinion_->cos_delta());
  const double edge = kAtEdge * pinion_->R_0();
  if (q.ell < own.ell_from - edge || q.ell > own.ell_to + edge || q.height > pinion_->parameters().addendum_mm + edge) return std::nullopt;
  const BevelWall<double>& wall = own.wall(sigma);
  auto found = start.iterations > 0 ? bevel_inverse(wall, q.ell, q.height, start) : bevel_inverse(wall, q.ell, q.height);
  if (!found && start.iterations > 0) found = bevel_inverse(wall, q.ell, q.height);
  if (!found || found->p < wall.cutter.p_A) return std::nullopt;
  start = *found;
  // Pinion tooth between its spaces -1 and 0, turned by half a pitch to azimuth 0: wall L of space 0, wall U of space -1.
  return wrapped(q.azimuth - found->azimuth - sigma * pinion_->pitch() / 2);
}

std::optional<BevelPlace> BevelPair::wheel_place(int half, int sigma, double ell, double height) const {
  const BevelWall<double>& wall = wheel_->halves()[static_cast<std::size_t>(half)].wall(sigma);
  const auto found = bevel_inverse(wall, ell, height);
  if (!found) return std::nullopt;
  const auto f = wall.point(found->beta, found->p);
  return BevelPlace{ell, height, f.p, f.n};
}

double BevelPair::lever(const BevelPlace& place, double phi_2) const {
  const Vec3 r = to_pinion(place.point, phi_2), n = turned_to_pinion(place.normal, phi_2);
  return std::abs(r.x() * n.y() - r.y() * n.x());
}

double BevelPair::lowest(int half) const {
  const auto& c = wheel_->halves()[static_cast<std::size_t>(half)].walls[0].cutter;
  return c.x_B + 0.02 * (c.x_C - c.x_B);
}

namespace {

/// One wall of the pair on a grid of the wheel.
class Roll {
 public:
  Roll(const BevelPair& pair, int sigma, const BevelContactOptions& options) : pair_(pair), sigma_(sigma), options_(options) {
    tau_ = pair.wheel().pitch();
    step_ = tau_ / options.steps;
    for (std::size_t h = 0; h < pair.wheel().halves().size(); ++h) patterns_.push_back(grid(static_cast<int>(h)));
  }

  Result<BevelContact> run() {
    meet();
    if (first_ > last_) return fail("the walls of sigma = {:+d} never meet", sigma_);
    BevelContact out;
    out.sigma = sigma_;
    pair_error();
    cycle(out);
    gaps(out);
    mismatch(out);
    out.patterns = std::move(patterns_);
    return out;
  }

 private:
  struct Meeting {
    int first = 0;               ///< index of the first position [steps from 0]
    std::vector<double> error;   ///< sigma (phi_1 - nominal) at every position; NaN: not on the pinion's flank
    double least = kNothing;     ///< over all turns of the wheel, between the positions too
    double at = 0;               ///< turn of the wheel there
  };
  struct Least {
    double error = std::numeric_limits<double>::infinity();
    int half = 0;
    double ell = 0, height = 0;
  };

  BevelPattern grid(int half) const {
    BevelPattern g;
    g.half = half;
    g.rows = options_.rows;
    g.columns = options_.columns;
    const auto& h = pair_.wheel().halves()[static_cast<std::size_t>(half)];
    for (int i = 0; i < g.rows; ++i)
      for (int j = 0; j < g.columns; ++j) {
        const double height = pair_.lowest(half) + (pair_.highest() - pair_.lowest(half)) * i / (g.rows - 1);
        const double ell = h.ell_from + (h.ell_to - h.ell_from) * j / (g.columns - 1);
        const auto place = pair_.wheel_place(half, sigma_, ell, height);
        g.places.push_back(place ? *place : BevelPlace{ell, height, Vec3::Constant(kNothing), Vec3::Constant(kNothing)});
      }
    return g;
  }

  std::optional<double> error(int half, const Vec3& point, double phi_2, BevelInverse& start) const {
    const auto turn = pair_.turn_at(half, sigma_, point, phi_2, start);
    if (!turn) return std::nullopt;
    return sigma_ * wrapped(*turn - pair_.nominal_turn(phi_2));
  }

  /// When and how far from the pinion every place is: about the turn at which it passes the pitch plane.
  void meet() {
    const int window = static_cast<int>(std::ceil(1.4 * options_.steps));
    for (const BevelPattern& g : patterns_) {
      std::vector<Meeting> of_places;
      for (const BevelPlace& place : g.places) {
        Meeting m;
        if (place.point.allFinite()) {
          const int middle = static_cast<int>(std::lround(-std::atan2(place.point.y(), place.point.x()) / step_));
          m.first = middle - window;
          BevelInverse start;
          for (int k = m.first; k <= middle + window; ++k) m.error.push_back(error(g.half, place.point, k * step_, start).value_or(kNothing));
          refine(g, place, m);
          first_ = std::min(first_, m.first);
          last_ = std::max(last_, middle + window);
        }
        of_places.push_back(std::move(m));
      }
      meetings_.push_back(std::move(of_places));
    }
  }

  /// Least error over all turns: golden section about the best position. Nothing where the pinion's flank ends before.
  void refine(const BevelPattern& g, const BevelPlace& place, Meeting& m) const {
    std::size_t best = m.error.size();
    for (std::size_t k = 0; k < m.error.size(); ++k)
      if (!std::isnan(m.error[k]) && (best == m.error.size() || m.error[k] < m.error[best])) best = k;
    if (best == m.error.size()) return;
    m.at = (m.first + static_cast<int>(best)) * step_;
    if (best == 0 || best + 1 == m.error.size() || std::isnan(m.error[best - 1]) || std::isnan(m.error[best + 1])) return;
    constexpr double kGolden = 0.6180339887498949;
    double low = m.at - step_, high = m.at + step_;
    BevelInverse start;
    const auto ask = [&](double s) { return error(g.half, place.point, s, start).value_or(std::numeric_limits<double>::infinity()); };
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low), at_a = ask(a), at_b = ask(b);
    while (high - low > 1e-7 * step_) {
      if (at_a < at_b) {
        high = b, b = a, at_b = at_a;
        a = high - kGolden * (high - low), at_a = ask(a);
      } else {
        low = a, a = b, at_a = at_b;
        b = low + kGolden * (high - low), at_b = ask(b);
      }
    }
    m.least = std::min(at_a, at_b);
    m.at = at_a < at_b ? a : b;
  }

  /// Least error of one pair at every position: grid, then downhill between the grid's places.
  void pair_error() {
    for (int k = first_; k <= last_; ++k) {
      Least best;
      for (std::size_t h = 0; h < meetings_.size(); ++h)
        for (std::size_t p = 0; p < meetings_[h].size(); ++p) {
          const Meeting& m = meetings_[h][p];
          const int at = k - m.first;
          if (at < 0 || at >= static_cast<int>(m.error.size())) continue;
          const double e = m.error[static_cast<std::size_t>(at)];
          if (!(e < best.error)) continue;
          best = {e, static_cast<int>(h), patterns_[h].places[p].ell, patterns_[h].places[p].height};
        }
      pair_least_.push_back(std::isinf(best.error) ? best : downhill(best, k * step_));
    }
  }

  Least downhill(Least at, double phi_2) const {
    const auto& h = pair_.wheel().halves()[static_cast<std::size_t>(at.half)];
    const double low = pair_.lowest(at.half), high = pair_.highest();
    double along = (h.ell_to - h.ell_from) / (options_.columns - 1), up = (high - low) / (options_.rows - 1);
    BevelInverse start;
    for (int n = 0; n < 14; ++n, along *= 0.5, up *= 0.5)
      for (bool moved = true; moved;) {
        moved = false;
        const Least centre = at;
        for (int i = -1; i <= 1; ++i)
          for (int j = -1; j <= 1; ++j) {
            if (i == 0 && j == 0) continue;
            const double ell = std::clamp(centre.ell + j * along, h.ell_from, h.ell_to), height = std::clamp(centre.height + i * up, low, high);
            const auto place = pair_.wheel_place(at.half, sigma_, ell, height);
            if (!place) continue;
            const auto e = error(at.half, place->point, phi_2, start);
            if (e && *e < at.error - 1e-14) {
              at.error = *e, at.ell = ell, at.height = height;
              moved = true;
            }
          }
      }
    return at;
  }

  [[nodiscard]] const Least* pair_at(int k) const {
    if (k < first_ || k > last_) return nullptr;
    const Least& l = pair_least_[static_cast<std::size_t>(k - first_)];
    return std::isinf(l.error) ? nullptr : &l;
  }

  /// All pairs: pair j stands where pair 0 stands j pitches later.
  void cycle(BevelContact& out) {
    const double lever = mean_lever();
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0, marking = 0;
    out.least_marking = std::numeric_limits<int>::max();
    for (int k = 0; k < options_.steps; ++k) {
      BevelPosition at;
      at.error_rad = std::numeric_limits<double>::infinity();
      const int most = (last_ - first_) / options_.steps + 2;
      for (int j = -most; j <= most; ++j)
        if (const Least* l = pair_at(k + j * options_.steps); l && l->error < at.error_rad) {
          at.error_rad = l->error, at.half = l->half, at.tooth = j, at.ell = l->ell, at.height = l->height;
        }
      for (int j = -most; j <= most; ++j)
        if (const Least* l = pair_at(k + j * options_.steps); l && (l->error - at.error_rad) * lever <= options_.compound_mm) ++at.marking;
      at.phi_2 = k * step_;
      at.phi_1 = pair_.nominal_turn(at.phi_2) + sigma_ * at.error_rad;
      low = std::min(low, at.error_rad), high = std::max(high, at.error_rad);
      sum += at.error_rad, marking += at.marking;
      out.least_marking = std::min(out.least_marking, at.marking);
      out.most_marking = std::max(out.most_marking, at.marking);
      out.cycle.push_back(at);
    }
    out.error_range_rad = high - low;
    out.error_mean_rad = sum / options_.steps;
    out.error_range_mm = out.error_range_rad * pair_.pinion().R_m() * pair_.pinion().sin_delta();
    out.marking_ratio = marking / options_.steps;
  }

  double mean_lever() const {
    const auto& g = patterns_.front();
    const auto& place = g.places[g.places.size() / 2];
    return pair_.lever(place, -std::atan2(place.point.y(), place.point.x()));
  }

  void gaps(const BevelContact& out) {
    for (std::size_t h = 0; h < patterns_.size(); ++h) {
      BevelPattern& g = patterns_[h];
      std::size_t marked = 0;
      for (std::size_t p = 0; p < g.places.size(); ++p) {
        const Meeting& m = meetings_[h][p];
        double least = kNothing;
        for (std::size_t k = 0; k < m.error.size(); ++k) {
          if (std::isnan(m.error[k])) continue;
          const int at = (((m.first + static_cast<int>(k)) % options_.steps) + options_.steps) % options_.steps;
          const double gap = m.error[k] - out.cycle[static_cast<std::size_t>(at)].error_rad;
          if (!(gap > least)) least = gap;
        }
        if (!std::isnan(least)) least = std::max(0.0, least) * pair_.lever(g.places[p], m.at);
        g.gap_mm.push_back(least);
        if (least <= options_.compound_mm) ++marked;
      }
      g.marked_share = static_cast<double>(marked) / static_cast<double>(g.places.size());
    }
  }

  void mismatch(BevelContact& out) {
    double sum = 0, square = 0;
    std::size_t count = 0;
    for (std::size_t h = 0; h < patterns_.size(); ++h)
      for (std::size_t p = 0; p < patterns_[h].places.size(); ++p) {
        const Meeting& m = meetings_[h][p];
        const double value = std::isnan(m.least) ? kNothing : m.least * pair_.lever(patterns_[h].places[p], m.at);
        patterns_[h].mismatch_mm.push_back(value);
        if (!std::isnan(value)) sum += value, ++count;
      }
    const double mean = sum / static_cast<double>(std::max<std::size_t>(count, 1));
    out.mismatch_min_mm = std::numeric_limits<double>::infinity();
    out.mismatch_max_mm = -out.mismatch_min_mm;
    for (auto& g : patterns_)
      for (double& value : g.mismatch_mm) {
        value -= mean;
        if (std::isnan(value)) continue;
        out.mismatch_min_mm = std::min(out.mismatch_min_mm, value);
        out.mismatch_max_mm = std::max(out.mismatch_max_mm, value);
        square += value * value;
      }
    out.mismatch_rms_mm = std::sqrt(square / static_cast<double>(std::max<std::size_t>(count, 1)));
  }

  const BevelPair& pair_;
  int sigma_;
  BevelContactOptions options_;
  double tau_ = 0, step_ = 0;
  std::vector<BevelPattern> patterns_;
  std::vector<std::vector<Meeting>> meetings_;
  int first_ = std::numeric_limits<int>::max(), last_ = std::numeric_limits<int>::min();
  std::vector<Least> pair_least_;
};

}  // namespace

Result<BevelContact> bevel_contact(const BevelPair& pair, int sigma, const BevelContactOptions& options) {
  if (options.rows < 3 || options.columns < 3 || options.steps < 4)
    return fail("grid of {} x {} places and {} positions: at least 3 x 3 and 4 are needed", options.rows, options.columns, options.steps);
  return Roll(pair, sigma, options).run();
}

namespace {

/// Mismatch of both walls, every wall with mean 0 over the places that all columns have.
using Field = std::vector<double>;

Result<Field> field_of(const BevelGear& pinion, const BevelGear& wheel, const BevelAssembly& assembly, const PinionChange& change,
                       const BevelContactOptions& options) {
  const auto pair = BevelPair::make(pinion, wheel, assembly, change);
  if (!pair) return pair.error();
  Field field;
  for (const int sigma : {1, -1}) {
    const auto contact = bevel_contact(*pair, sigma, options);
    if (!contact) return contact.error();
    for (const auto& g : contact->patterns) field.insert(field.end(), g.mismatch_mm.begin(), g.mismatch_mm.end());
  }
  return field;
}

/// One way to change the pair, and how far it is moved for the difference.
struct Trial {
  const char *name, *unit;
  double step, per_unit;  ///< step in rad, mm or 1; step = per_unit * (value in `unit`)
  void (*move)(double amount, PinionChange&, BevelAssembly&);
};

/// Sets of trials that are tried together.
constexpr std::array<std::size_t, 4> kOneMill = {0, 1, 6, 7};
constexpr std::array<std::size_t, 6> kTwoMills = {2, 3, 4, 5, 6, 7};

const std::vector<Trial>& trials_of_pair() {
  constexpr double degree = kPi / 180;
  static const std::vector<Trial> trials = {
      {"pressure angle of the pinion's mill", "deg", 0.02 * degree, degree, [](double a, PinionChange& c, BevelAssembly&) { c.pressure_angle_rad = {a, a}; }},
      {"equivalent radius of the pinion's mill", "%", 0.01, 0.01, [](double a, PinionChange& c, BevelAssembly&) { c.equivalent_radius = {a, a}; }},
      {"pressure angle of the mill for convex walls", "deg", 0.02 * degree, degree, [](double a, PinionChange& c, BevelAssembly&) { c.pressure_angle_rad[0] = a; }},
      {"pressure angle of the mill for concave walls", "deg", 0.02 * degree, degree, [](double a, PinionChange& c, BevelAssembly&) { c.pressure_angle_rad[1] = a; }},
      {"equivalent radius of the mill for convex walls", "%", 0.01, 0.01, [](double a, PinionChange& c, BevelAssembly&) { c.equivalent_radius[0] = a; }},
      {"equivalent radius of the mill for concave walls", "%", 0.01, 0.01, [](double a, PinionChange& c, BevelAssembly&) { c.equivalent_radius[1] = a; }},
      {"spiral angle of the trace for convex walls", "deg", 0.02 * degree, degree, [](double a, PinionChange& c, BevelAssembly&) { c.spiral_angle_rad[0] = a; }},
      {"spiral angle of the trace for concave walls", "deg", 0.02 * degree, degree, [](double a, PinionChange& c, BevelAssembly&) { c.spiral_angle_rad[1] = a; }},
      {"shaft angle", "deg", 0.01 * degree, degree, [](double a, PinionChange&, BevelAssembly& m) { m.shaft_angle_rad = a; }},
      {"offset of the axes", "mm", 0.01, 1, [](double a, PinionChange&, BevelAssembly& m) { m.offset_mm = a; }},
      {"pinion along its axis", "mm", 0.01, 1, [](double a, PinionChange&, BevelAssembly& m) { m.pinion_axial_mm = a; }},
      {"wheel along its axis", "mm", 0.01, 1, [](double a, PinionChange&, BevelAssembly& m) { m.wheel_axial_mm = a; }},
  };
  return trials;
}

}  // namespace

Result<std::vector<MismatchChange>> mismatch_changes(const BevelGear& pinion, const BevelGear& wheel, const BevelContactOptions& options) {
  const std::vector<Trial>& trials = trials_of_pair();
  const auto base = field_of(pinion, wheel, {}, {}, options);
  if (!base) return base.error();
  std::vector<Field> columns;
  for (const Trial& t : trials) {
    BevelAssembly assembly;
    PinionChange change;
    t.move(t.step, change, assembly);
    auto moved = field_of(pinion, wheel, assembly, change, options);
    if (!moved) return moved.error();
    for (std::size_t k = 0; k < moved->size(); ++k) (*moved)[k] = ((*moved)[k] - (*base)[k]) / t.step;
    columns.push_back(std::move(*moved));
  }
  // Places that every trial knows; the mean of each wall is taken off.
  const std::size_t half = base->size() / 2;
  const auto vector_of = [&](const Field& f, const std::vector<bool>& kept) {
    std::vector<double> v;
    for (int wall = 0; wall < 2; ++wall) {
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t k = 0; k < half; ++k)
        if (kept[wall * half + k]) sum += f[wall * half + k], ++count;
      for (std::size_t k = 0; k < half; ++k)
        if (kept[wall * half + k]) v.push_back(f[wall * half + k] - sum / static_cast<double>(count));
    }
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  std::vector<bool> kept(base->size());
  for (std::size_t k = 0; k < base->size(); ++k)
    kept[k] = !std::isnan((*base)[k]) && std::none_of(columns.begin(), columns.end(), [&](const Field& c) { return std::isnan(c[k]); });
  if (std::count(kept.begin(), kept.end(), true) < 12) return fail("the flanks share too few places to compare changes");
  const Eigen::VectorXd b = vector_of(*base, kept);
  const auto rms = [](const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); };
  std::vector<MismatchChange> out;
  Eigen::MatrixXd A(b.size(), static_cast<Eigen::Index>(trials.size()));
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    A.col(column) = vector_of(columns[k], kept);
    const double amount = -A.col(column).dot(b) / A.col(column).squaredNorm();
    out.push_back({trials[k].name, trials[k].unit, amount / trials[k].per_unit, rms(b), rms(b + amount * A.col(column)), false});
  }
  // Several at once, then rolled again with the changed pinion.
  const auto together = [&](const auto& chosen, const std::string& title) -> Status {
    Eigen::MatrixXd own(b.size(), static_cast<Eigen::Index>(chosen.size()));
    for (std::size_t k = 0; k < chosen.size(); ++k) own.col(static_cast<Eigen::Index>(k)) = A.col(static_cast<Eigen::Index>(chosen[k]));
    const Eigen::VectorXd best = -own.colPivHouseholderQr().solve(b);
    PinionChange change;
    BevelAssembly assembly;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      PinionChange one;
      trials[chosen[k]].move(best[static_cast<Eigen::Index>(k)], one, assembly);
      for (std::size_t w = 0; w < 2; ++w) {
        change.pressure_angle_rad[w] += one.pressure_angle_rad[w];
        change.equivalent_radius[w] += one.equivalent_radius[w];
        change.spiral_angle_rad[w] += one.spiral_angle_rad[w];
      }
    }
    const auto after = field_of(pinion, wheel, {}, change, options);
    if (!after) return after.error();
    std::vector<bool> both = kept;
    for (std::size_t k = 0; k < both.size(); ++k) both[k] = both[k] && !std::isnan((*after)[k]);
    const double left = rms(vector_of(*after, both)), before = rms(vector_of(*base, both));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const Trial& t = trials[chosen[k]];
      out.push_back({title + ": " + t.name, t.unit, best[static_cast<Eigen::Index>(k)] / t.per_unit, before, left, true});
    }
    return Ok{};
  };
  if (const auto s = together(kOneMill, "one mill"); !s) return s.error();
  if (const auto s = together(kTwoMills, "two mills"); !s) return s.error();
  return out;
}

Result<BevelGear> bevel_mate(const BevelGear& gear) {
  BevelGearParameters p = gear.parameters();
  if (p.mate_teeth <= 0) return fail("the gear names no mate: gear.mate_teeth is missing");
  std::swap(p.teeth, p.mate_teeth);
  p.hand = -p.hand;
  p.pitch_angle_rad = 0;
  FingerCutterData cutter = gear.cutter_data();
  auto made = BevelGear::make(p, cutter);
  if (auto* refused = std::get_if<1>(&made)) {
    Diagnostic error = refused->front().diagnostic;
    error.message = "mate with " + std::to_string(p.teeth) + " teeth: " + error.message;
    return error;
  }
  return std::get<0>(std::move(made));
}

}  // namespace toothpath
