#include "geometry/contact/bevel_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::contact {
namespace {

/// Mismatch of both walls, every wall with mean 0 over the places that all columns have.
using Field = std::vector<double>;

Result<Field> field_of(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel, const BevelAssembly& assembly, const PinionChange& change,
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

Result<std::vector<MismatchChange>> mismatch_changes(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel, const BevelContactOptions& options) {
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

}  // namespace toothpath::contact
