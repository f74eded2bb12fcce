#include "app/fit/fit.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "app/fit/least_squares.h"
#include "geometry/base/printable.h"

namespace toothpath::fit {
namespace {

constexpr int kMostSteps = 200, kRounds = 4;
constexpr double kStep =
    1e-4;  // of a reach: derivatives by numbers are differences over twice that, at a limit over once
constexpr double kAtBound = 1e-9;       // of a reach
constexpr double kRank = 1e-7;          // of the strongest combination of numbers: weaker ones are none
constexpr double kAlike = 0.5;          // of the greatest part of a combination: numbers that may be held for it
constexpr double kTold = 0.02;          // of it: what moves with them
constexpr std::size_t kLeastSpare = 1;  // points more than numbers

enum class Kind : std::uint8_t { number, turn, shift };
struct Parameter {
  Kind kind = Kind::number;
  std::size_t index = 0;  ///< of the number
  double reach = 0;
  Row row;
};

/// Residuals of the placed points; x counts in reaches from where the rows stand now.
class Problem {
 public:
  Problem(const job::Job& job, const job::LoosePoints& points, const Asked& asked, const Numbers& numbers,
          std::vector<Parameter> free)
      : job_(job), points_(points), ball_(asked.ball_radius_mm), numbers_(numbers), parameters(std::move(free)) {}

  /// One minimisation over these parameters, from where the rows stand; they stand at its end then.
  /// Refused: a place with nothing to begin from.
  [[nodiscard]] Status solve(const std::vector<std::size_t>& over) {
    if (auto done = run(over); !done) return done;
    // A number that comes to its bound cuts the steps of all short: the others go on without it.
    std::vector<std::size_t> inside;
    for (const std::size_t k : over)
      if (!at_bound(parameters[k])) inside.push_back(k);
    if (!inside.empty() && inside.size() < over.size())
      if (auto done = run(inside); !done) return done;
    over_ = over;
    from_ = values();
    const std::vector<double> here(over.size(), 0);
    jacobian.resize(residuals.size(), Eigen::Index(over.size()));
    if (!over.empty() && !evaluate(here.data(), residuals.data(), jacobian.data()))
      return fail("the flanks go where the fit ends");
    return Ok{};
  }
  static bool at_bound(const Parameter& p) {
    return std::min(p.row.value - p.row.low, p.row.high - p.row.value) < kAtBound * p.reach;
  }

  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> out;
    for (const Parameter& p : parameters) out.push_back(p.row.value);
    return out;
  }
  [[nodiscard]] Gear gear_of(const std::vector<double>& values) const {
    Gear gear = job_.gear;
    for (std::size_t k = 0; k < parameters.size(); ++k)
      if (parameters[k].kind == Kind::number) numbers_.free[parameters[k].index].set(gear, values[k]);
    numbers_.settle(gear);
    return gear;
  }
  [[nodiscard]] Pose pose_of(const std::vector<double>& values) const {
    Pose pose;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].kind == Kind::turn) pose.turn_rad = radians(values[k]);
      if (parameters[k].kind == Kind::shift) pose.shift_mm = values[k];
    }
    return pose;
  }
  [[nodiscard]] Expected<Spaces, Refusal> spaces_at(const std::vector<double>& values) const {
    return spaces_of(gear_of(values), job_);
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] Status run(const std::vector<std::size_t>& over) {
    over_ = over;
    std::vector<double> x(over.size(), 0), low, high;
    from_ = values();
    for (const std::size_t k : over) {
      const Parameter& p = parameters[k];
      low.push_back(std::min(0.0, (p.row.low - from_[k]) / p.reach));
      high.push_back(std::max(0.0, (p.row.high - from_[k]) / p.reach));
    }
    residuals.resize(Eigen::Index(placing.points.size()));
    if (!evaluate(x.data(), residuals.data(), nullptr)) return fail("no flank passes by all of these points");
    if (over.empty()) return Ok{};
    LeastSquares least{
        int(over.size()), int(placing.points.size()), x.data(), low.data(), high.data(), &Problem::asked, this,
        kMostSteps};
    if (auto done = minimise(least); !done) return done;
    steps += least.steps;
    if (!least.settled)
      return fail("no least sum of squares is found in {} steps: fewer free numbers, or closer bounds", kMostSteps);
    for (std::size_t k = 0; k < over.size(); ++k) {
      Parameter& p = parameters[over[k]];
      p.row.value = std::clamp(from_[over[k]] + x[k] * p.reach, p.row.low, p.row.high);
    }
    return Ok{};
  }

  static bool asked(void* who, const double* x, double* residuals, double* jacobian) {
    return static_cast<Problem*>(who)->evaluate(x, residuals, jacobian);
  }

  /// @param derivatives  null: not asked
  bool evaluate(const double* x, double* to, double* derivatives) {
    std::vector<double> values = from_;
    for (std::size_t k = 0; k < over_.size(); ++k) values[over_[k]] += x[k] * parameters[over_[k]].reach;
    const auto spaces = spaces_at(values);
    if (!spaces) return false;
    const Pose pose = pose_of(values);
    const double pitch = spaces->front()->outline().pitch;
    std::vector<Seen> seen;
    seen.reserve(placing.points.size());
    for (std::size_t i = 0; i < placing.points.size(); ++i) {
      const PlacedPoint& at = placing.points[i];
      const Vec3 q = pose.in_space(points_.points[at.point].p, at.space * pitch);
      const auto foot = (*spaces)[std::size_t(at.zone)]->foot(tooth_space::flank_of(at.side), q, at.u, at.v);
      if (!foot) return false;
      to[i] = foot->distance - ball_;
      seen.push_back({q, foot->at.n, foot->u, foot->v});
    }
    if (derivatives == nullptr) return true;
    for (std::size_t i = 0; i < seen.size(); ++i) placing.points[i].u = seen[i].u, placing.points[i].v = seen[i].v;
    Eigen::Map<Rows> rows(derivatives, Eigen::Index(seen.size()), Eigen::Index(over_.size()));
    for (std::size_t k = 0; k < over_.size(); ++k)
      if (!differentiate(over_[k], values, seen, rows.col(Eigen::Index(k)))) return false;
    return true;
  }

  /// A point in its space, and its foot.
  struct Seen {
    Vec3 q, n;
    double u = 0, v = 0;
  };
  /// Derivatives of the residuals by one parameter. A flank moves by its normal part alone, whatever its u and v do.
  [[nodiscard]] bool differentiate(std::size_t parameter, const std::vector<double>& values,
                                   const std::vector<Seen>& seen,
                                   Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>> to) const {
    const Parameter& p = parameters[parameter];
    if (p.kind != Kind::number) {
      for (std::size_t i = 0; i < seen.size(); ++i)
        to[Eigen::Index(i)] = p.kind == Kind::shift
                                  ? -p.reach * seen[i].n.z()
                                  : -p.reach * kDegree * seen[i].n.dot(Vec3::UnitZ().cross(seen[i].q));
      return true;
    }
    const Number& number = numbers_.free[p.index];
    std::vector<double> low = values, high = values;
    low[parameter] = std::max(values[parameter] - kStep * p.reach, std::min(number.least, values[parameter]));
    high[parameter] = std::min(values[parameter] + kStep * p.reach, std::max(number.most, values[parameter]));
    const double step = (high[parameter] - low[parameter]) / p.reach;
    const auto below = spaces_at(low), above = spaces_at(high);
    if (!below || !above) return false;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const PlacedPoint& at = placing.points[i];
      const auto piece = tooth_space::flank_of(at.side);
      const auto a = (*below)[std::size_t(at.zone)]->point(piece, seen[i].u, seen[i].v),
                 b = (*above)[std::size_t(at.zone)]->point(piece, seen[i].u, seen[i].v);
      if (!a || !b) return false;
      to[Eigen::Index(i)] = -seen[i].n.dot(b->p - a->p) / step;
    }
    return true;
  }

  const job::Job& job_;
  const job::LoosePoints& points_;
  double ball_ = 0;
  const Numbers& numbers_;
  std::vector<std::size_t> over_;
  std::vector<double> from_;

 public:
  std::vector<Parameter> parameters;
  Placing placing;
  Eigen::VectorXd residuals;
  Rows jacobian;  ///< by the parameters of the last solve, in reaches
  int steps = 0;
};

std::string keys_text(const Numbers& numbers) {
  std::string text;
  for (const Number& n : numbers.free) text += (text.empty() ? "" : ", ") + n.key;
  return text;
}

Status take_bounds(const Asked& asked, std::vector<Parameter>& parameters) {
  for (const Bound& bound : asked.bounds) {
    const auto found =
        std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.row.key == bound.key; });
    if (found == parameters.end())
      return fail_as(DiagnosticKind::usage, "--bounds {}: no free number has this key", printable(bound.key));
    Row& row = found->row;
    if (!(bound.low < bound.high && row.start >= bound.low && row.start <= bound.high))
      return fail_as(DiagnosticKind::usage, "--bounds {}={:g}:{:g}: the start, {:.10g}{}{}, must lie between them",
                     bound.key, bound.low, bound.high, row.start, *row.unit ? " " : "", row.unit);
    row.low = bound.low;
    row.high = bound.high;
  }
  return Ok{};
}

/// Free numbers in their order, the turn ahead of them and the shift behind: what stands last is held first.
Result<std::vector<Parameter>> parameters_of(const job::Job& job, const Numbers& numbers, const Asked& asked) {
  std::vector<Parameter> out;
  const double half_pitch = 180.0 / numbers.teeth;
  if (asked.turns) out.push_back({Kind::turn, 0, 0.5 * half_pitch, {"rotation", "deg"}});
  for (const std::string& key : asked.free)
    if (std::none_of(numbers.free.begin(), numbers.free.end(), [&](const Number& n) { return n.key == key; }))
      return fail_as(DiagnosticKind::usage, "--free {}: no number of this {} that can be fitted; they are {}",
                     printable(key), job.gear_type(), keys_text(numbers));
  for (std::size_t i = 0; i < numbers.free.size(); ++i) {
    const Number& n = numbers.free[i];
    const bool named = std::find(asked.free.begin(), asked.free.end(), n.key) != asked.free.end();
    if (asked.free.empty() ? !n.usual : !named) continue;
    const double start = n.get(job.gear);
    out.push_back(
        {Kind::number,
         i,
         n.reach,
         {n.key, n.unit, start, std::max(n.least, start - n.reach), std::min(n.most, start + n.reach), start}});
  }
  if (asked.shifts)
    out.push_back(
        {Kind::shift, 0, numbers.module_mm, {"axial_position", "mm", 0, -numbers.module_mm, numbers.module_mm, 0}});
  if (out.empty()) return fail_as(DiagnosticKind::usage, "nothing is free: name numbers with --free");
  if (auto taken = take_bounds(asked, out); !taken) return taken.error();
  return out;
}

Size size_of(const Eigen::VectorXd& residuals) {
  Size out;
  out.rms_mm = std::sqrt(residuals.squaredNorm() / double(residuals.size()));
  Eigen::Index worst = 0;
  out.worst_mm = residuals.cwiseAbs().maxCoeff(&worst);
  out.worst = std::size_t(worst);
  return out;
}

/// Derivatives by some numbers as combinations of them, the strongest first.
struct Combinations {
  Eigen::VectorXd strength;
  Eigen::MatrixXd parts;  ///< a column each
  double scatter = 0;     ///< of one residual, as the fit leaves it
};
Combinations combinations_of(const Problem& problem, const std::vector<Eigen::Index>& columns) {
  const auto m = Eigen::Index(columns.size());
  Eigen::MatrixXd J(problem.jacobian.rows(), m);
  for (Eigen::Index n = 0; n < m; ++n) J.col(n) = problem.jacobian.col(columns[std::size_t(n)]);
  const Eigen::MatrixXd R =
      Eigen::HouseholderQR<Eigen::MatrixXd>(J).matrixQR().topRows(m).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(R, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV(), std::sqrt(problem.residuals.squaredNorm() / double(J.rows() - m))};
}

/// Holds a number that the last solve leaves undetermined. False: all are determined.
bool hold_one(Problem& problem, const std::vector<std::size_t>& over) {
  std::vector<Eigen::Index> all(over.size());
  std::iota(all.begin(), all.end(), 0);
  const Combinations c = combinations_of(problem, all);
  const auto m = Eigen::Index(over.size());
  if (c.strength[m - 1] > kRank * c.strength[0] && c.strength[m - 1] > c.scatter) return false;
  // The weakest combination: moved by a whole reach the points hardly tell.
  const Eigen::VectorXd part = c.parts.col(m - 1);
  const double most = part.cwiseAbs().maxCoeff();
  Eigen::Index held = m - 1;
  while (std::abs(part[held]) < kAlike * most) --held;
  Row& row = problem.parameters[over[std::size_t(held)]].row;
  row.end = End::held;
  for (Eigen::Index n = 0; n < m; ++n)
    if (std::abs(part[n]) > kTold * most) {
      const Parameter& p = problem.parameters[over[std::size_t(n)]];
      row.moves_with.emplace_back(p.row.key, part[n] / most * p.reach);
    }
  return true;
}

/// How well the numbers of the last solve are determined that are not at their bounds.
void note_deviations(Problem& problem, const std::vector<std::size_t>& over) {
  std::vector<Eigen::Index> inside;
  for (std::size_t k = 0; k < over.size(); ++k) {
    const Parameter& p = problem.parameters[over[k]];
    Row& row = problem.parameters[over[k]].row;
    const bool bound = Problem::at_bound(p);
    row.end = bound ? End::at_bound : End::determined;
    if (!bound) inside.push_back(Eigen::Index(k));
  }
  if (inside.empty()) return;
  const Combinations c = combinations_of(problem, inside);
  for (std::size_t n = 0; n < inside.size(); ++n) {
    Parameter& p = problem.parameters[over[std::size_t(inside[n])]];
    p.row.deviation = c.scatter * p.reach * c.parts.row(Eigen::Index(n)).transpose().cwiseQuotient(c.strength).norm();
  }
}

/// Minimises over what is not held, and holds number by number what the points leave open.
Status solve_determined(Problem& problem) {
  const std::vector<double> start = problem.values();
  while (true) {
    std::vector<std::size_t> over;
    for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
      Row& row = problem.parameters[k].row;
      row.value = start[k];
      if (row.end != End::held) over.push_back(k);
    }
    if (problem.placing.points.size() < over.size() + kLeastSpare)
      return fail("{} points lie on flanks, {} or more are needed for {} free numbers", problem.placing.points.size(),
                  over.size() + kLeastSpare, over.size());
    if (auto done = problem.solve(over); !done) return done;
    if (over.empty()) return Ok{};
    if (hold_one(problem, over)) continue;
    note_deviations(problem, over);
    return Ok{};
  }
}

using Places = std::vector<std::tuple<std::size_t, int, int, int>>;
Places places_of(const Placing& placing) {
  Places out;
  for (const PlacedPoint& p : placing.points) out.emplace_back(p.point, p.zone, p.side, p.space);
  return out;
}

/// The start, turned as well as that is free: what it leaves of every point.
Status note_before(Problem& problem, Fitted& out, std::map<std::size_t, double>& left) {
  std::vector<std::size_t> pose;
  for (std::size_t k = 0; k < problem.parameters.size(); ++k)
    if (problem.parameters[k].kind == Kind::turn) pose.push_back(k);
  if (auto done = problem.solve(pose); !done) return done;
  out.before = size_of(problem.residuals);
  for (std::size_t i = 0; i < problem.placing.points.size(); ++i)
    left[problem.placing.points[i].point] = problem.residuals[Eigen::Index(i)];
  return Ok{};
}

}  // namespace

const char* to_string(End end) {
  switch (end) {
    case End::determined: return "determined";
    case End::at_bound: return "at its bound";
    case End::held: return "held";
  }
  return "";
}

Result<Fitted> fit_gear(const job::Job& job, const job::LoosePoints& points, const Asked& asked) {
  auto numbers = numbers_of(job);
  if (!numbers) return numbers.error();
  auto parameters = parameters_of(job, *numbers, asked);
  if (!parameters) return parameters.error();
  auto spaces = spaces_of(job.gear, job);
  if (auto* refusal = spaces.refused()) {
    refusal->diagnostic.position = job.where("gear." + refusal->key);
    return std::move(refusal->diagnostic);
  }
  Fitted out;
  Problem problem(job, points, asked, *numbers, std::move(*parameters));
  const auto in_file = [&](Diagnostic error) {
    if (error.position.file.empty()) error.position = {points.file, 1, 1};
    return error;
  };
  problem.placing = placed_on(*spaces, points, {}, asked.turns);
  if (problem.placing.points.empty())
    return in_file(fail("no point lies beside a flank of {}: another gear, frame or unit", job.file));
  if (problem.placing.beside > problem.placing.points.size() + problem.placing.below_flanks)
    return in_file(
        fail("{} of {} points lie where the gear of {} has no flank, {} on flanks: another gear, frame or unit",
             problem.placing.beside, points.points.size(), job.file, problem.placing.points.size()));
  if (asked.turns) {
    Row& turn = problem.parameters.front().row;
    turn.start = turn.value = degrees(problem.placing.turn_rad);
    const double half_pitch = 180.0 / numbers->teeth;
    const bool bound =
        std::any_of(asked.bounds.begin(), asked.bounds.end(), [&](const Bound& b) { return b.key == turn.key; });
    if (!bound) turn.low = turn.start - half_pitch, turn.high = turn.start + half_pitch;
  }
  std::map<std::size_t, double> before;
  if (auto done = note_before(problem, out, before); !done) return in_file(done.error());
  if (asked.turns) problem.parameters.front().row.start = problem.parameters.front().row.value;
  for (int round = 0; round < kRounds; ++round) {
    if (auto done = solve_determined(problem); !done) return in_file(done.error());
    const auto values = problem.values();
    auto fitted = problem.spaces_at(values);
    if (!fitted) return in_file(fitted.error().diagnostic);
    Placing again = placed_on(*fitted, points, problem.pose_of(values), false);
    if (round + 1 == kRounds || places_of(again) == places_of(problem.placing)) break;
    problem.placing = std::move(again);
  }
  out.after = size_of(problem.residuals);
  for (std::size_t i = 0; i < problem.placing.points.size(); ++i) {
    const auto found = before.find(problem.placing.points[i].point);
    out.before_mm.push_back(found != before.end() ? found->second : NAN);
    out.after_mm.push_back(problem.residuals[Eigen::Index(i)]);
  }
  const auto values = problem.values();
  out.gear = problem.gear_of(values);
  out.pose = problem.pose_of(values);
  out.spaces = problem.spaces_at(values).value();
  out.placing = std::move(problem.placing);
  out.steps = problem.steps;
  for (Parameter& p : problem.parameters) out.rows.push_back(std::move(p.row));
  out.numbers = std::move(*numbers);
  return out;
}

}  // namespace toothpath::fit
