// Where a gear stands by the touches of its flanks.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "geometry/inspection/touches.h"

namespace toothpath::inspection {
namespace {

constexpr int kSteps = 30;
constexpr double kStill = 1e-13;

/// A rigid motion of the gear: first the turn by the vector, then the way.
struct Motion {
  Vec3 way = Vec3::Zero(), turn = Vec3::Zero();
  [[nodiscard]] Vec3 back(const Vec3& x) const {
    const double angle = turn.norm();
    if (angle == 0) return x - way;
    return Eigen::AngleAxisd(-angle, turn / angle) * (x - way);
  }
};

struct Solved {
  Motion motion;
  Eigen::VectorXd rest;        ///< of every touch, mm
  Eigen::MatrixXd covariance;  ///< for a scatter of 1 mm
  double worst = INFINITY, rms = 0;
};

class Solver {
 public:
  Solver(const TouchedPart& part, const TouchPlan& plan, const TouchOptions& options,
         const std::vector<TouchResult>& results)
      : part_(part),
        plan_(plan),
        ball_(0.5 * options.ball_diameter_mm),
        allowance_(options.allowance_mm),
        results_(results),
        clocks_(std::any_of(plan.touches.begin(), plan.touches.end(),
                            [](const Touch& t) { return t.what == Touched::flank; })) {}

  /// @param leans  the axis is free to lean;  @param without  a touch that is left out, -1: none
  [[nodiscard]] std::optional<Solved> solve(bool leans, int without) const {
    const Eigen::Index turns = clocks_ ? 1 : 0, unknowns = 3 + turns + (leans ? 2 : 0),
                       n = Eigen::Index(results_.size());
    Solved out;
    Eigen::MatrixXd J(n, unknowns);
    Eigen::VectorXd d(n);
    for (int step = 0; step < kSteps; ++step) {
      for (Eigen::Index k = 0; k < n; ++k) {
        const Touch& touch = plan_.touches[std::size_t(results_[std::size_t(k)].number - 1)];
        const Vec3 q = out.motion.back(results_[std::size_t(k)].centre);
        const auto off = distance(touch, q);
        if (!off) return {};
        // The gear moved by a small way and turn comes nearer by n.way + (q x n).turn.
        const Vec3 moment = q.cross(touch.normal);
        d[k] = *off;
        J.row(k).head(3) = touch.normal.transpose();
        if (clocks_) J(k, 3) = moment.z();
        if (leans) J.row(k).tail(2) = moment.head<2>().transpose();
        if (int(k) == without) {
          J.row(k).setZero();
          d[k] = 0;
        }
      }
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J);
      const Eigen::VectorXd x = qr.solve(d);
      if (!x.allFinite() || x.head(3).norm() > 10 * kFarthestMoved) return {};
      out.motion.way += x.head(3);
      if (clocks_) out.motion.turn.z() += x[3];
      if (leans) out.motion.turn.head<2>() += x.tail(2);
      if (x.head(3).norm() < kStill * 1e3 && x.tail(unknowns - 3).norm() < kStill * 10) break;
    }
    out.rest.resize(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Touch& touch = plan_.touches[std::size_t(results_[std::size_t(k)].number - 1)];
      const auto off = distance(touch, out.motion.back(results_[std::size_t(k)].centre));
      if (!off) return {};
      out.rest[k] = *off;
    }
    out.worst = 0;
    double squares = 0;
    for (Eigen::Index k = 0; k < n; ++k)
      if (int(k) != without) {
        out.worst = std::max(out.worst, std::abs(out.rest[k]));
        squares += out.rest[k] * out.rest[k];
      }
    out.rms = std::sqrt(squares / double(n - (without >= 0)));
    out.covariance = (J.transpose() * J).inverse();
    return out;
  }

 private:
  /// By which the ball stands off its surface.
  [[nodiscard]] std::optional<double> distance(const Touch& touch, const Vec3& q) const {
    const auto off = part_.distance(touch, q);
    if (!off) return {};
    return *off - ball_ - (touch.what == Touched::end ? 0 : allowance_);
  }

  const TouchedPart& part_;
  const TouchPlan& plan_;
  double ball_, allowance_;
  const std::vector<TouchResult>& results_;
  bool clocks_;  ///< teeth were touched: the turn about z is asked, too
};

std::optional<Diagnostic> check_numbers(const TouchPlan& plan, const std::vector<TouchResult>& results,
                                        const std::string& file) {
  std::vector<int> line(plan.touches.size(), 0);
  for (const auto& r : results) {
    if (r.number < 1 || r.number > int(plan.touches.size()))
      return fail_at(r.at, "touch {} is none of the plan, which has 1 .. {}: results of another gear or program?",
                     r.number, plan.touches.size());
    int& seen = line[std::size_t(r.number - 1)];
    if (seen) return fail_at(r.at, "touch {} stands in line {} already", r.number, seen);
    seen = r.at.line;
  }
  for (std::size_t k = 0; k < line.size(); ++k)
    if (!line[k]) return fail_at({file, 1, 1}, "touch {} of {} is missing", k + 1, line.size());
  return {};
}

/// Which touch does not agree with the others, where it is one alone.
Diagnostic disagreement(const Solver& solver, const Solved& all, const std::vector<TouchResult>& results,
                        const std::string& file) {
  std::vector<int> without;
  double left = 0;
  for (int k = 0; k < int(results.size()); ++k)
    if (const auto others = solver.solve(true, k); others && others->worst <= kWorstTouch) {
      without.push_back(k);
      left = others->worst;
    }
  if (without.size() != 1)
    return fail_at({file, 1, 1}, "the touches do not agree: {:.4f} mm are left, at most {:g} mm{}", all.worst,
                   kWorstTouch, without.empty() ? "" : "; too few touches to say which is wrong: touch more spaces");
  const TouchResult& r = results[std::size_t(without.front())];
  return fail_at(r.at,
                 "touch {} does not agree with the others: without it they agree within {:.4f} mm, with it {:.4f} mm "
                 "are left, at most {:g} mm; touch it again",
                 r.number, left, all.worst, kWorstTouch);
}

}  // namespace

Result<Placement> place_of_part(const TouchedPart& part, const TouchPlan& plan, const TouchOptions& options,
                                const std::vector<TouchResult>& results, const std::string& file) {
  if (auto wrong = check_numbers(plan, results, file)) return *wrong;
  for (const auto& r : results)
    if (const double off = (r.centre - plan.touches[std::size_t(r.number - 1)].centre).norm(); off > 2 * kFarthestMoved)
      return fail_at(r.at,
                     "touch {} lies {:.3f} mm from where the plan has it, at most {:g} mm: another part, frame or "
                     "unit",
                     r.number, off, 2 * kFarthestMoved);
  const Solver solver(part, plan, options, results);
  const auto upright = solver.solve(false, -1), leaning = solver.solve(true, -1);
  if (!upright || !leaning)
    return fail_at({file, 1, 1}, "no place of the gear answers the touches: another part, frame or unit");
  if (leaning->worst > kWorstTouch) return disagreement(solver, *leaning, results, file);
  Placement out;
  out.tilt_rad = leaning->motion.turn.head<2>();
  if (const double lean = out.tilt_rad.norm() * part.reach().radius_mm; lean > kMostLean)
    return fail_at({file, 1, 1},
                   "the axis of the gear leans: {:.4f} mm at radius {:.3f} mm, at most {:g} mm: true up the part", lean,
                   part.reach().radius_mm, kMostLean);
  out.moved_mm = upright->motion.way;
  out.clocking_rad = upright->motion.turn.z();
  out.residual_mm = upright->worst;
  out.rms_mm = upright->rms;
  if (out.moved_mm.norm() > kFarthestMoved)
    return fail_at({file, 1, 1}, "the gear stands {:.3f} mm off its place, at most {:g} mm", out.moved_mm.norm(),
                   kFarthestMoved);
  const bool clocks = upright->covariance.rows() > 3;
  const double n = double(results.size()), scatter = upright->rms * std::sqrt(n / (n - (clocks ? 4 : 3)));
  out.moved_sigma_mm = scatter * upright->covariance.diagonal().head(3).cwiseSqrt();
  if (clocks) out.clocking_sigma_rad = scatter * std::sqrt(upright->covariance(3, 3));
  return out;
}

}  // namespace toothpath::inspection
