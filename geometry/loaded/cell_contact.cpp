#include "geometry/loaded/cell_contact.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

namespace toothpath::loaded {
namespace {

using Complex = std::complex<double>;
constexpr int kMostRounds = 2000;
constexpr double kChange = 1e-8;     // of the pressures in a round, part of the force
constexpr double kFits = 1e-6;       // overlap, and gap under pressure, part of the approach
constexpr double kRounding = 1e-12;  // what is left of the gaps of pressed cells, part of the approach

/// The next length with no other factors than 2, 3 and 5.
int quick_length(int least) {
  for (int n = least;; ++n) {
    int rest = n;
    for (const int p : {2, 3, 5})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return n;
  }
}

/// Displacements of a window under its own pressures, by a product of spectra. Fields are real: two of their rows are
/// one complex row, and half of the columns tell the spectrum. That of the influence is real, as it is even.
class WindowInfluence {
 public:
  WindowInfluence(const CellWindow& w, double compliance)
      : window_(w),
        columns_(quick_length(2 * w.columns)),
        rows_(quick_length(2 * w.rows)),
        in_(static_cast<std::size_t>(columns_)),
        out_(in_.size()) {
    std::vector<double> influence(in_.size() * static_cast<std::size_t>(rows_));
    for (int r = -(w.rows - 1); r < w.rows; ++r)
      for (int c = -(w.columns - 1); c < w.columns; ++c)
        influence[static_cast<std::size_t>((r + rows_) % rows_ * columns_ + (c + columns_) % columns_)] =
            compliance * rectangle_influence(c * w.dx, r * w.dy, w.dx / 2, w.dy / 2);
    field_.resize(static_cast<std::size_t>(columns_ / 2 + 1) * static_cast<std::size_t>(rows_));
    spectrum_ = field_;
    forward(influence.data(), columns_, rows_);
    for (const Complex& value : spectrum_) scale_.push_back(value.real());
  }

  /// u += influence of p; both of the window's cells.
  void add(const double* p, double* u) {
    forward(p, window_.columns, window_.rows);
    for (std::size_t k = 0; k < spectrum_.size(); ++k) spectrum_[k] *= scale_[k];
    for (int c = 0; c <= columns_ / 2; ++c) fft_.inv(&field_[index(c, 0)], &spectrum_[index(c, 0)], rows_);
    for (int r = 0; r < window_.rows; r += 2) {
      for (int c = 0; c <= columns_ / 2; ++c) {
        const Complex one = field_[index(c, r)], two = field_[index(c, r + 1)];
        in_[static_cast<std::size_t>((columns_ - c) % columns_)] = {one.real() + two.imag(), two.real() - one.imag()};
        in_[static_cast<std::size_t>(c)] = {one.real() - two.imag(), one.imag() + two.real()};
      }
      fft_.inv(out_.data(), in_.data(), columns_);
      for (int c = 0; c < window_.columns; ++c) {
        u[r * window_.columns + c] += out_[static_cast<std::size_t>(c)].real();
        if (r + 1 < window_.rows) u[(r + 1) * window_.columns + c] += out_[static_cast<std::size_t>(c)].imag();
      }
    }
  }

 private:
  /// Columns stand one after the other.
  [[nodiscard]] std::size_t index(int c, int r) const {
    return static_cast<std::size_t>(c) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(r);
  }
  /// The spectrum of rows of a field, the rest of it 0.
  void forward(const double* field, int columns, int rows) {
    std::fill(field_.begin(), field_.end(), Complex(0));
    for (int r = 0; r < rows; r += 2) {
      std::fill(in_.begin(), in_.end(), Complex(0));
      for (int c = 0; c < columns; ++c)
        in_[static_cast<std::size_t>(c)] = {field[r * columns + c], r + 1 < rows ? field[(r + 1) * columns + c] : 0};
      fft_.fwd(out_.data(), in_.data(), columns_);
      for (int c = 0; c <= columns_ / 2; ++c) {
        const Complex there = out_[static_cast<std::size_t>(c)],
                      mirrored = std::conj(out_[static_cast<std::size_t>((columns_ - c) % columns_)]),
                      difference = (there - mirrored) / 2.0;
        field_[index(c, r)] = (there + mirrored) / 2.0;
        if (r + 1 < rows) field_[index(c, r + 1)] = {difference.imag(), -difference.real()};
      }
    }
    for (int c = 0; c <= columns_ / 2; ++c) fft_.fwd(&spectrum_[index(c, 0)], &field_[index(c, 0)], rows_);
  }

  const CellWindow& window_;
  int columns_, rows_;
  Eigen::FFT<double> fft_;
  std::vector<Complex> field_, spectrum_, in_, out_;  ///< in_, out_: a row
  std::vector<double> scale_;
};

class Search {
 public:
  explicit Search(const CellProblem& problem) : problem_(problem) {
    for (const CellWindow& w : problem.windows) {
      influence_.emplace_back(w, problem.compliance);
      gap_.insert(gap_.end(), w.gap.begin(), w.gap.end());
      area_.insert(area_.end(), w.size(), w.dx * w.dy);
      own_.insert(own_.end(), w.size(), problem.compliance * rectangle_influence(0, 0, w.dx / 2, w.dy / 2));
      for (std::size_t k = 0; k < w.size(); ++k) lever_.push_back(w.lever_of(k));
    }
    n_ = gap_.size();
    // Cells of unequal size give way unequally: steps by what each gives way alone.
    const double stiffest = *std::min_element(own_.begin(), own_.end());
    for (std::size_t k = 0; k < n_; ++k) ease_.push_back(stiffest / own_[k]), weight_.push_back(area_[k] * ease_[k]);
    p_.assign(n_, 0.0), u_.assign(n_, 0.0), t_.assign(n_, 0.0), q_.assign(n_, 0.0);
  }

  Result<CellPressures> run(const std::vector<double>& start) {
    double material = 0;
    for (std::size_t k = 0; k < n_; ++k) material += std::isfinite(gap_[k]) ? area_[k] : 0;
    if (!(material > 0)) return fail("no cell of the contact has material");
    if (!(problem_.force > 0)) return fail("the contact carries {:g} N; a force above 0 is needed", problem_.force);
    for (std::size_t k = 0; k < n_; ++k)
      p_[k] = !std::isfinite(gap_[k]) ? 0 : start.size() == n_ ? std::max(0.0, start[k]) : problem_.force / material;
    balance();
    double G_old = 1;
    bool conjugate = false;
    CellPressures found;
    for (int round = 1; round <= kMostRounds; ++round) {
      displace(p_, u_);
      const double X = mean(u_, true);
      const double G = step(G_old, conjugate);
      const double change = descend(X, conjugate);
      G_old = G;
      if (!(change < kChange)) continue;
      found = finish(round);  // small steps alone do not tell that cells fit
      if (found.residual < kFits) return found;
    }
    return fail("the pressures of {} cells do not settle within {} rounds: {:g} of the approach is left, limit {:g}",
                n_, kMostRounds, finish(kMostRounds).residual, kFits);
  }

 private:
  /// The approach that fits the pressed cells best, by weight: their mean where cells and levers are equal; with the
  /// gap added.
  [[nodiscard]] double mean(const std::vector<double>& v, bool gap) const {
    double sum = 0, area = 0;
    for (std::size_t k = 0; k < n_; ++k)
      if (p_[k] > 0)
        sum += weight_[k] * lever_[k] * (v[k] + (gap ? gap_[k] : 0)), area += weight_[k] * lever_[k] * lever_[k];
    return sum / area;
  }
  /// What is left of the gap of a cell when the bodies approach by X.
  [[nodiscard]] double open(std::size_t k, double X) const { return u_[k] + gap_[k] - lever_[k] * X; }
  void displace(const std::vector<double>& p, std::vector<double>& u) {
    std::fill(u.begin(), u.end(), 0.0);
    std::size_t at = 0;
    for (std::size_t w = 0; w < influence_.size(); ++w) {
      const auto begin = p.begin() + static_cast<std::ptrdiff_t>(at),
                 end = begin + static_cast<std::ptrdiff_t>(problem_.windows[w].size());
      if (std::all_of(begin, end, [](double v) { return v == 0; })) {  // most teeth carry nothing
        at += problem_.windows[w].size();
        continue;
      }
      influence_[w].add(p.data() + at, u.data() + at);
      if (problem_.windows[w].images.size() > 0) mirror(problem_.windows[w], p.data() + at, u.data() + at);
      at += problem_.windows[w].size();
    }
    if (problem_.stations.rows() == 0) return;
    const auto n = static_cast<Eigen::Index>(n_);
    const Eigen::VectorXd forces =
        Eigen::Map<const Eigen::VectorXd>(p.data(), n).cwiseProduct(Eigen::Map<const Eigen::VectorXd>(area_.data(), n));
    const Eigen::VectorXd of_stations = problem_.remainder * (problem_.stations * forces);
    Eigen::Map<Eigen::VectorXd>(u.data(), n) += problem_.stations.transpose() * of_stations;
  }
  /// The images of blocks; made symmetric, as the search goes down a quadratic form. Most blocks carry nothing.
  static void mirror(const CellWindow& w, const double* p, double* u) {
    const auto n = static_cast<Eigen::Index>(w.size());
    const Eigen::VectorXd forces = Eigen::Map<const Eigen::VectorXd>(p, n) * (w.dx * w.dy);
    Eigen::VectorXd block = Eigen::VectorXd::Zero(w.images.cols()), back = block, there = Eigen::VectorXd::Zero(n);
    Eigen::Index first = n, last = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (forces(k) == 0) continue;
      block(w.blocks[static_cast<std::size_t>(k)]) += forces(k);
      first = std::min(first, k), last = k + 1;
    }
    if (first >= last) return;
    for (Eigen::Index b = 0; b < block.size(); ++b) {
      const auto image = w.images.col(b);
      if (block(b) != 0) there += image * block(b);
      back(b) = image.segment(first, last - first).dot(forces.segment(first, last - first));
    }
    for (std::size_t k = 0; k < w.size(); ++k) u[k] += (there(static_cast<Eigen::Index>(k)) + back(w.blocks[k])) / 2;
  }
  void balance() {
    double sum = 0;
    for (std::size_t k = 0; k < n_; ++k) sum += p_[k] * area_[k] * lever_[k];
    for (double& p : p_) p *= problem_.force / sum;
  }
  /// The direction of the next step; the squared rest.
  double step(double G_old, bool conjugate) {
    const double X = mean(u_, true);
    double G = 0, area = 0;
    for (std::size_t k = 0; k < n_; ++k)
      if (p_[k] > 0) {
        const double r = open(k, X);
        G += weight_[k] * r * r, area += weight_[k];
      }
    still_ = !(G > area * kRounding * kRounding * X * X);
    for (std::size_t k = 0; k < n_; ++k)
      t_[k] = p_[k] > 0 ? ease_[k] * open(k, X) + (conjugate ? G / G_old * t_[k] : 0) : 0;
    return G;
  }
  /// How far along the direction the energy is least; not above 0: it does not fall that way.
  double way(double X) {
    displace(t_, q_);
    const double q_mean = mean(q_, false);
    double rt = 0, qt = 0;
    for (std::size_t k = 0; k < n_; ++k)
      if (p_[k] > 0) rt += area_[k] * open(k, X) * t_[k], qt += area_[k] * (q_[k] - lever_[k] * q_mean) * t_[k];
    return qt > 0 ? rt / qt : 0;
  }
  /// Along the direction to the least energy; lets go what would pull, presses what overlaps. The change, part of F.
  double descend(double X, bool& conjugate) {
    double tau = still_ ? 0 : way(X);
    if (!still_ && !(tau > 0)) {  // what was conjugate on other cells is none on these: straight down
      for (std::size_t k = 0; k < n_; ++k) t_[k] = p_[k] > 0 ? ease_[k] * open(k, X) : 0;
      tau = std::max(0.0, way(X));
    }
    old_ = p_;
    conjugate = true;
    for (std::size_t k = 0; k < n_; ++k) {
      if (old_[k] > 0) p_[k] = std::max(0.0, old_[k] - tau * t_[k]);
      else if (std::isfinite(gap_[k]) && open(k, X) < 0) {
        // Where pressed cells fit each other there is no step to take from: as far as the cell alone would give way.
        p_[k] = tau > 0 ? std::max(0.0, -tau * ease_[k] * open(k, X)) : -open(k, X) / own_[k];
        conjugate = false;
      }
    }
    if (std::none_of(p_.begin(), p_.end(), [](double p) { return p > 0; })) {
      p_[deepest(X)] = 1;  // the step let go all: begin again where the bodies overlap most
      conjugate = false;
    }
    balance();
    double change = 0;
    for (std::size_t k = 0; k < n_; ++k) change += area_[k] * std::abs(p_[k] - old_[k]);
    return change / problem_.force;
  }
  [[nodiscard]] std::size_t deepest(double X) const {
    std::size_t at = 0;
    double least = kNoMaterial;
    for (std::size_t k = 0; k < n_; ++k)
      if (std::isfinite(gap_[k]) && open(k, X) < least) least = open(k, X), at = k;
    return at;
  }
  CellPressures finish(int rounds) {
    displace(p_, u_);
    CellPressures out;
    out.approach = mean(u_, true);
    out.rounds = rounds;
    for (std::size_t k = 0; k < n_; ++k) {
      if (!std::isfinite(gap_[k])) continue;
      const double left = open(k, out.approach);
      out.residual = std::max(out.residual, (p_[k] > 0 ? std::abs(left) : -left) / out.approach);
    }
    out.pressure = p_;
    return out;
  }

  const CellProblem& problem_;
  std::vector<WindowInfluence> influence_;
  std::size_t n_ = 0;
  bool still_ = false;  ///< the pressed cells fit each other to rounding
  /// own_: displacement of a cell under its own pressure of 1; ease_: that of the stiffest cell over it; weight_: area
  /// times ease.
  std::vector<double> gap_, area_, own_, ease_, weight_, lever_, p_, u_, t_, q_, old_;
};

}  // namespace

double rectangle_influence(double x, double y, double a, double b) {
  const auto part = [](double u, double v) { return u == 0 ? 0.0 : u * std::asinh(v / std::abs(u)); };
  double sum = 0;
  for (const double sx : {1.0, -1.0})
    for (const double sy : {1.0, -1.0}) {
      const double u = x + sx * a, v = y + sy * b;
      sum += sx * sy * (part(u, v) + part(v, u));
    }
  return sum;
}

Result<CellPressures> press_cells(const CellProblem& problem, const std::vector<double>& start) {
  return Search(problem).run(start);
}

}  // namespace toothpath::loaded
