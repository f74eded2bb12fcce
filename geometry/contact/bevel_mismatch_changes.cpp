#include "geometry/contact/bevel_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::contact {
namespace {

/// Mismatch of both walls, every wall with mean 0 over the places that all columns have.
using Field = std::vector<double>;

Result<Field> field_of(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
                       const BevelAssembly& assembly, const PinionChange& change, const BevelContactOptions& options) {
  const auto pair = BevelPair::make(pinion, wheel, assembly, change);
  if (!pair) return pair.error();
  Field field;
  for (const int sigma : {1, -1}) {
    const auto of_wall = bevel_mismatch(*pair, sigma, options);
    if (!of_wall) return of_wall.error();
    field.insert(field.end(), of_wall->begin(), of_wall->end());
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
      {"pressure angle of the pinion's mill", "deg", 0.02 * degree, degree,
       [](double a, PinionChange& c, BevelAssembly&) {
         c.pressure_angle_rad = {a, a};
       }},
      {"equivalent radius of the pinion's mill", "%", 0.01, 0.01,
       [](double a, PinionChange& c, BevelAssembly&) {
         c.equivalent_radius = {a, a};
       }},
      {"pressure angle of the mill for convex walls", "deg", 0.02 * degree, degree,
       [](double a, PinionChange& c, BevelAssembly&) { c.pressure_angle_rad[0] = a; }},
      {"pressure angle of the mill for concave walls", "deg", 0.02 * degree, degree,
       [](double a, PinionChange& c, BevelAssembly&) { c.pressure_angle_rad[1] = a; }},
      {"equivalent radius of the mill for convex walls", "%", 0.01, 0.01,
       [](double a, PinionChange& c, BevelAssembly&) { c.equivalent_radius[0] = a; }},
      {"equivalent radius of the mill for concave walls", "%", 0.01, 0.01,
       [](double a, PinionChange& c, BevelAssembly&) { c.equivalent_radius[1] = a; }},
      {"spiral angle of the trace for convex walls", "deg", 0.02 * degree, degree,
       [](double a, PinionChange& c, BevelAssembly&) { c.spiral_angle_rad[0] = a; }},
      {"spiral angle of the trace for concave walls", "deg", 0.02 * degree, degree,
       [](double a, PinionChange& c, BevelAssembly&) { c.spiral_angle_rad[1] = a; }},
      {"shaft angle", "deg", 0.01 * degree, degree,
       [](double a, PinionChange&, BevelAssembly& m) { m.shaft_angle_rad = a; }},
      {"offset of the axes", "mm", 0.01, 1, [](double a, PinionChange&, BevelAssembly& m) { m.offset_mm = a; }},
      {"pinion along its axis", "mm", 0.01, 1,
       [](double a, PinionChange&, BevelAssembly& m) { m.pinion_axial_mm = a; }},
      {"wheel along its axis", "mm", 0.01, 1, [](double a, PinionChange&, BevelAssembly& m) { m.wheel_axial_mm = a; }},
  };
  return trials;
}

/// What every trial does to the mismatch of a pair, linear in its amount: mismatch = base + sum of amount * column.
class LinearModel {
 public:
  static Result<LinearModel> of(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
                                const BevelContactOptions& options) {
    LinearModel model(pinion, wheel, options);
    auto base = field_of(pinion, wheel, {}, {}, options);
    if (!base) return base.error();
    model.base_ = std::move(*base);
    std::vector<Field> columns;
    WorkShare share(double(trials_of_pair().size()));
    for (const Trial& t : trials_of_pair()) {
      auto column = model.difference(t);
      if (!column) return column.error();
      columns.push_back(std::move(*column));
      share.add();
    }
    model.kept_.resize(model.base_.size());
    for (std::size_t k = 0; k < model.base_.size(); ++k)
      model.kept_[k] = !std::isnan(model.base_[k]) &&
                       std::none_of(columns.begin(), columns.end(), [&](const Field& c) { return std::isnan(c[k]); });
    if (std::count(model.kept_.begin(), model.kept_.end(), true) < 12)
      return fail("the flanks share too few places to compare changes");
    model.b_ = vector_of(model.base_, model.kept_);
    model.A_.resize(model.b_.size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k)
      model.A_.col(static_cast<Eigen::Index>(k)) = vector_of(columns[k], model.kept_);
    return model;
  }

  /// The best amount of one trial, and what it leaves.
  [[nodiscard]] MismatchChange alone(std::size_t trial) const {
    const Trial& t = trials_of_pair()[trial];
    const auto column = A_.col(static_cast<Eigen::Index>(trial));
    const double amount = -column.dot(b_) / column.squaredNorm();
    return {t.name, t.unit, amount / t.per_unit, rms(b_), rms(b_ + amount * column), false};
  }

  /// Several at once, then rolled again with the changed pinion.
  [[nodiscard]] Result<std::vector<MismatchChange>> together(std::span<const std::size_t> chosen,
                                                             const std::string& title) const {
    const std::vector<Trial>& trials = trials_of_pair();
    Eigen::MatrixXd own(b_.size(), static_cast<Eigen::Index>(chosen.size()));
    for (std::size_t k = 0; k < chosen.size(); ++k)
      own.col(static_cast<Eigen::Index>(k)) = A_.col(static_cast<Eigen::Index>(chosen[k]));
    const Eigen::VectorXd best = -own.colPivHouseholderQr().solve(b_);
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
    const auto after = field_of(pinion_, wheel_, {}, change, options_);
    if (!after) return after.error();
    std::vector<bool> both = kept_;
    for (std::size_t k = 0; k < both.size(); ++k) both[k] = both[k] && !std::isnan((*after)[k]);
    const double left = rms(vector_of(*after, both)), before = rms(vector_of(base_, both));
    std::vector<MismatchChange> out;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const Trial& t = trials[chosen[k]];
      out.push_back(
          {title + ": " + t.name, t.unit, best[static_cast<Eigen::Index>(k)] / t.per_unit, before, left, true});
    }
    return out;
  }

 private:
  LinearModel(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
              const BevelContactOptions& options)
      : pinion_(pinion), wheel_(wheel), options_(options) {}

  /// Change of the mismatch by one trial, per step.
  [[nodiscard]] Result<Field> difference(const Trial& t) const {
    BevelAssembly assembly;
    PinionChange change;
    t.move(t.step, change, assembly);
    auto moved = field_of(pinion_, wheel_, assembly, change, options_);
    if (!moved) return moved;
    for (std::size_t k = 0; k < moved->size(); ++k) (*moved)[k] = ((*moved)[k] - base_[k]) / t.step;
    return moved;
  }

  /// The places kept; the mean of each wall is taken off.
  static Eigen::VectorXd vector_of(const Field& f, const std::vector<bool>& kept) {
    const std::size_t half = f.size() / 2;
    std::vector<double> v;
    for (std::size_t wall = 0; wall < 2; ++wall) {
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t k = 0; k < half; ++k)
        if (kept[wall * half + k]) sum += f[wall * half + k], ++count;
      for (std::size_t k = 0; k < half; ++k)
        if (kept[wall * half + k]) v.push_back(f[wall * half + k] - sum / static_cast<double>(count));
    }
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  }
  static double rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

  const bevel_gear::BevelGear &pinion_, &wheel_;
  const BevelContactOptions& options_;
  Field base_;
  std::vector<bool> kept_;  ///< places that every trial knows
  Eigen::VectorXd b_;
  Eigen::MatrixXd A_;
};

}  // namespace

Result<std::vector<MismatchChange>> mismatch_changes(const bevel_gear::BevelGear& pinion,
                                                     const bevel_gear::BevelGear& wheel,
                                                     const BevelContactOptions& options) {
  const auto model = LinearModel::of(pinion, wheel, options);
  if (!model) return model.error();
  std::vector<MismatchChange> out;
  for (std::size_t k = 0; k < trials_of_pair().size(); ++k) out.push_back(model->alone(k));
  const auto one = model->together(kOneMill, "one mill");
  if (!one) return one.error();
  const auto two = model->together(kTwoMills, "two mills");
  if (!two) return two.error();
  out.insert(out.end(), one->begin(), one->end());
  out.insert(out.end(), two->begin(), two->end());
  return out;
}

}  // namespace toothpath::contact
