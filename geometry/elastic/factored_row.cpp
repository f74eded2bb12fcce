#include "geometry/elastic/factored_row.h"

#include <algorithm>

namespace toothpath::elastic {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Nested dissection on the lattice: planes of brick faces part it, and come after what they part.
class Dissection {
 public:
  explicit Dissection(const Sector& sector) : lattice_(sector.lattice) {}
  std::vector<int> ordered;
  std::vector<int> parts;  ///< how many nodes each has

  void order(std::vector<int> nodes) {
    if (nodes.size() <= kLeaf) return take(nodes);
    std::size_t axis = 0;
    int widest = 0, low = 0, high = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax_element(nodes.begin(), nodes.end(),
                                              [&](int m, int n) { return coordinate(m, k) < coordinate(n, k); });
      const int from = coordinate(*a, k), to = coordinate(*b, k);
      if (to - from <= widest) continue;
      widest = to - from, axis = k, low = from, high = to;
    }
    if (widest < 2) return take(nodes);
    // The plane nearest to the median of the nodes.
    std::vector<int> places;
    for (const int n : nodes) places.push_back(coordinate(n, axis));
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2), places.end());
    int plane = places[places.size() / 2] / 2 * 2;
    if (plane <= low) plane += 2;
    if (plane >= high) plane -= 2;
    if (plane <= low || plane >= high) plane = (low + 1) / 2 * 2;
    std::vector<int> below, above, on;
    for (const int n : nodes) {
      const int x = coordinate(n, axis);
      (x < plane ? below : x > plane ? above : on).push_back(n);
    }
    if (below.empty() && above.empty()) return take(nodes);
    order(std::move(below));
    order(std::move(above));
    take(on);
  }

 private:
  static constexpr std::size_t kLeaf = 24;
  void take(const std::vector<int>& part) {
    if (part.empty()) return;
    ordered.insert(ordered.end(), part.begin(), part.end());
    parts.push_back(static_cast<int>(part.size()));
  }
  [[nodiscard]] int coordinate(int node, std::size_t axis) const {
    return lattice_[static_cast<std::size_t>(node)][axis];
  }
  const std::vector<std::array<int, 3>>& lattice_;
};

/// Unknowns of one sector: those inside, then those of the low cut, then those of the high cut. What is held has none.
struct Numbering {
  std::vector<int> first;  ///< of a node, -1: held
  std::vector<int> parts;  ///< of the inside: how many each has
  int inside = 0, cut = 0;
};

Numbering number(const Sector& s) {
  Numbering n;
  std::vector<char> kind(s.nodes.size(), 0);
  for (const int k : s.low_cut) kind[static_cast<std::size_t>(k)] = 1;
  for (const int k : s.high_cut) kind[static_cast<std::size_t>(k)] = 1;
  for (const int k : s.held) kind[static_cast<std::size_t>(k)] = 2;
  std::vector<int> free;
  for (std::size_t k = 0; k < s.nodes.size(); ++k)
    if (kind[k] == 0) free.push_back(static_cast<int>(k));
  Dissection dissection(s);
  dissection.order(std::move(free));
  for (const int nodes : dissection.parts) n.parts.push_back(3 * nodes);
  n.first.assign(s.nodes.size(), -1);
  int next = 0;
  const auto give = [&](int k) { n.first[static_cast<std::size_t>(k)] = next, next += 3; };
  for (const int k : dissection.ordered) give(k);
  n.inside = next;
  for (const auto* cut : {&s.low_cut, &s.high_cut})
    for (const int k : *cut)
      if (kind[static_cast<std::size_t>(k)] == 1) give(k);
  n.cut = (next - n.inside) / 2;
  return n;
}

/// The lower half; components of the high cut in the frame of the next sector.
Sparse stiffness_of(const Sector& s, const Numbering& number, double nu) {
  std::vector<char> turned(s.nodes.size(), 0);
  for (const int k : s.high_cut) turned[static_cast<std::size_t>(k)] = 1;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(s.bricks.size() * 60 * 30);
  for (const auto& brick : s.bricks) {
    BrickNodes x;
    for (int n = 0; n < kBrickNodes; ++n)
      x.col(n) = s.nodes[static_cast<std::size_t>(brick[static_cast<std::size_t>(n)])];
    double jacobian = 0;
    const BrickMatrix K = brick_stiffness(x, nu, jacobian);
    for (int m = 0; m < kBrickNodes; ++m)
      for (int n = 0; n < kBrickNodes; ++n) {
        const auto node_m = static_cast<std::size_t>(brick[static_cast<std::size_t>(m)]),
                   node_n = static_cast<std::size_t>(brick[static_cast<std::size_t>(n)]);
        const int row = number.first[node_m], column = number.first[node_n];
        if (row < 0 || column < 0 || row < column) continue;
        Mat3 block = K.block<3, 3>(3 * m, 3 * n);
        if (turned[node_m] != 0) block = s.pitch.transpose() * block;
        if (turned[node_n] != 0) block = block * s.pitch;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            if (row + i >= column + j) entries.emplace_back(row + i, column + j, block(i, j));
      }
  }
  const int size = number.inside + 2 * number.cut;
  Sparse K(size, size);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

/// The chain of cuts between `teeth` sectors, its ends held; S is what a sector leaves at its two cuts.
Eigen::MatrixXd chain_of(const Eigen::MatrixXd& S, int teeth) {
  const auto cut = S.rows() / 2;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(cut * (teeth - 1), cut * (teeth - 1));
  for (int t = 0; t < teeth; ++t)  // between cuts t - 1 and t of the unknown ones
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const int row = t - 1 + a, column = t - 1 + b;
        if (row < 0 || column < 0 || row >= teeth - 1 || column >= teeth - 1) continue;
        K.block(row * cut, column * cut, cut, cut) += S.block(a * cut, b * cut, cut, cut);
      }
  return K;
}

}  // namespace

Result<FactoredRow> FactoredRow::make(const Sector& s, double nu, int teeth) {
  FactoredRow row;
  const Numbering numbers = number(s);
  auto factor = FrontalFactor::make(stiffness_of(s, numbers, nu), numbers.parts);
  if (!factor) return fail("the stiffness of a tooth is not positive definite");
  row.first_ = numbers.first;
  row.high_cut_ = s.high_cut;
  row.pitch_ = s.pitch;
  row.inside_ = numbers.inside, row.cut_ = numbers.cut, row.teeth_ = teeth;
  row.reach_ = std::min(2, teeth / 2);
  row.chain_.compute(chain_of(factor->rest(), teeth));
  row.sector_ = std::move(*factor);
  if (row.chain_.info() != Eigen::Success) return fail("the stiffness of a row of teeth is not positive definite");
  return row;
}

FactoredRow::Forward FactoredRow::forward(const Eigen::MatrixXd& at_nodes) const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(inside_ + 2 * cut_, at_nodes.cols());
  for (std::size_t n = 0; n < first_.size(); ++n)
    if (first_[n] >= 0) all.middleRows<3>(first_[n]) = at_nodes.middleRows<3>(static_cast<Eigen::Index>(3 * n));
  sector_->forward(all);
  return {all.topRows(inside_), all.bottomRows(2 * cut_)};
}

Eigen::MatrixXd FactoredRow::motions(const Eigen::MatrixXd& pushed) const {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(cut_ * (teeth_ - 1), pushed.cols());
  u.middleRows((teeth_ / 2 - 1) * cut_, 2 * cut_) = pushed;
  chain_.solveInPlace(u);
  return u;
}

Eigen::MatrixXd FactoredRow::cuts_of(const Eigen::MatrixXd& motions, int offset) const {
  Eigen::MatrixXd at_cuts = Eigen::MatrixXd::Zero(2 * cut_, motions.cols());
  for (int side = 0; side < 2; ++side) {
    const int at = teeth_ / 2 + offset - 1 + side;
    if (at >= 0 && at < teeth_ - 1) at_cuts.middleRows(side * cut_, cut_) = motions.middleRows(at * cut_, cut_);
  }
  return at_cuts;
}

Eigen::MatrixXd FactoredRow::nodes_of(const Eigen::MatrixXd& at_cuts, const Eigen::MatrixXd* inside) const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(inside_ + 2 * cut_, at_cuts.cols());
  if (inside != nullptr) all.topRows(inside_) = *inside;
  all.bottomRows(2 * cut_) = at_cuts;
  sector_->backward(all);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * first_.size()), at_cuts.cols());
  for (std::size_t n = 0; n < first_.size(); ++n)
    if (first_[n] >= 0) out.middleRows<3>(static_cast<Eigen::Index>(3 * n)) = all.middleRows<3>(first_[n]);
  for (const int n : high_cut_) out.middleRows<3>(3 * n) = pitch_ * Eigen::MatrixXd(out.middleRows<3>(3 * n));
  return out;
}

}  // namespace toothpath::elastic
