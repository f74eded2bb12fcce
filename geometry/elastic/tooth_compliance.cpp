#include "geometry/elastic/tooth_compliance.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numeric>

namespace toothpath::elastic {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>;

FaceNodes nodes_of(const Sector& s, const StationFace& f) {
  FaceNodes x;
  for (int n = 0; n < kFaceNodes; ++n)
    x.col(n) = s.nodes[static_cast<std::size_t>(f.nodes[static_cast<std::size_t>(n)])];
  return x;
}

/// Nested dissection on the lattice: planes of brick faces part it, and come after what they part.
class Dissection {
 public:
  explicit Dissection(const Sector& sector) : lattice_(sector.lattice) {}

  void order(std::vector<int> nodes, std::vector<int>& out) const {
    if (nodes.size() <= kLeaf) {
      out.insert(out.end(), nodes.begin(), nodes.end());
      return;
    }
    std::size_t axis = 0;
    int widest = 0, low = 0, high = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax_element(nodes.begin(), nodes.end(),
                                              [&](int m, int n) { return coordinate(m, k) < coordinate(n, k); });
      const int from = coordinate(*a, k), to = coordinate(*b, k);
      if (to - from <= widest) continue;
      widest = to - from, axis = k, low = from, high = to;
    }
    if (widest < 2) {
      out.insert(out.end(), nodes.begin(), nodes.end());
      return;
    }
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
    if (below.empty() && above.empty()) {
      out.insert(out.end(), nodes.begin(), nodes.end());
      return;
    }
    order(std::move(below), out);
    order(std::move(above), out);
    out.insert(out.end(), on.begin(), on.end());
  }

 private:
  static constexpr std::size_t kLeaf = 12;
  [[nodiscard]] int coordinate(int node, std::size_t axis) const {
    return lattice_[static_cast<std::size_t>(node)][axis];
  }
  const std::vector<std::array<int, 3>>& lattice_;
};

/// Unknowns of one sector: those inside, then those of the low cut, then those of the high cut. What is held has none.
struct Numbering {
  std::vector<int> first;  ///< of a node, -1: held
  int inside = 0, cut = 0;
};

Numbering number(const Sector& s) {
  Numbering n;
  std::vector<char> kind(s.nodes.size(), 0);
  for (const int k : s.low_cut) kind[static_cast<std::size_t>(k)] = 1;
  for (const int k : s.high_cut) kind[static_cast<std::size_t>(k)] = 1;
  for (const int k : s.held) kind[static_cast<std::size_t>(k)] = 2;
  std::vector<int> free, order;
  for (std::size_t k = 0; k < s.nodes.size(); ++k)
    if (kind[k] == 0) free.push_back(static_cast<int>(k));
  Dissection(s).order(std::move(free), order);
  n.first.assign(s.nodes.size(), -1);
  int next = 0;
  const auto give = [&](int k) { n.first[static_cast<std::size_t>(k)] = next, next += 3; };
  for (const int k : order) give(k);
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

/// Every place of integration of the loaded flank, with its weight.
template <typename F>
void over_flank(const Sector& s, F&& at) {
  const GaussRule& rule = gauss_rule(4);
  for (const auto& face : s.faces)
    for (int i = 0; i < rule.n; ++i)
      for (int j = 0; j < rule.n; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        at(face, face_place(nodes_of(s, face), rule.x[a], rule.x[b]), rule.weight[a], rule.weight[b]);
      }
}

}  // namespace

std::vector<double> hat_areas(const Sector& s) {
  std::vector<double> areas(s.stations.size(), 0.0);
  over_flank(s, [&](const auto& face, const FacePlace& place, double w_a, double w_b) {
    const double area = place.area.norm() * w_a * w_b;
    for (std::size_t c = 0; c < 4; ++c) areas[static_cast<std::size_t>(face.stations[c])] += place.hat[c] * area;
  });
  return areas;
}

Eigen::MatrixXd hat_loads(const Sector& s) {
  const std::vector<double> areas = hat_areas(s);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * s.nodes.size()),
                                                static_cast<Eigen::Index>(s.stations.size()));
  over_flank(s, [&](const auto& face, const FacePlace& place, double w_a, double w_b) {
    const Vec3 force = -place.area * (w_a * w_b);
    for (std::size_t c = 0; c < 4; ++c) {
      const int station = face.stations[c];
      for (int n = 0; n < kFaceNodes; ++n)
        loads.block<3, 1>(3 * face.nodes[static_cast<std::size_t>(n)], station) +=
            force * (place.shape(n) * place.hat[c] / areas[static_cast<std::size_t>(station)]);
    }
  });
  return loads;
}

Result<ToothCompliance> tooth_compliance(const Sector& s, double nu, int teeth) {
  const Numbering numbers = number(s);
  const int size = numbers.inside + 2 * numbers.cut, cut = numbers.cut;
  Factor factor;
  factor.compute(stiffness_of(s, numbers, nu));
  if (factor.info() != Eigen::Success) return fail("the stiffness of a tooth is not positive definite");
  const auto stations = static_cast<Eigen::Index>(s.stations.size());
  const Eigen::MatrixXd at_nodes = hat_loads(s);
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(size, stations), read = load;
  for (std::size_t n = 0; n < s.nodes.size(); ++n)
    if (numbers.first[n] >= 0)
      load.middleRows<3>(numbers.first[n]) = at_nodes.middleRows<3>(static_cast<Eigen::Index>(3 * n));
  for (Eigen::Index k = 0; k < stations; ++k) {
    const int node = s.stations[static_cast<std::size_t>(k)];
    read.block<3, 1>(numbers.first[static_cast<std::size_t>(node)], k) = -s.normals[static_cast<std::size_t>(k)];
  }
  // Forward through the inside; what arrives at the cuts is left as it is.
  const Sparse L = factor.matrixL();
  const auto inside = L.topLeftCorner(numbers.inside, numbers.inside);
  const Sparse to_cuts = L.bottomLeftCorner(2 * cut, numbers.inside);
  const Eigen::MatrixXd L_cuts =
      Eigen::MatrixXd(L.bottomRightCorner(2 * cut, 2 * cut)).triangularView<Eigen::Lower>().toDenseMatrix();
  Eigen::MatrixXd Y = load.topRows(numbers.inside), Z = read.topRows(numbers.inside);
  inside.triangularView<Eigen::Lower>().solveInPlace(Y);
  inside.triangularView<Eigen::Lower>().solveInPlace(Z);
  const Eigen::MatrixXd pushed = load.bottomRows(2 * cut) - to_cuts * Y, felt = read.bottomRows(2 * cut) - to_cuts * Z;

  const Eigen::MatrixXd chain = chain_of(L_cuts * L_cuts.transpose(), teeth);
  const Eigen::LLT<Eigen::MatrixXd> chained(chain);
  if (chained.info() != Eigen::Success) return fail("the stiffness of a row of teeth is not positive definite");
  const int middle = teeth / 2;
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(chain.rows(), stations);
  u.middleRows((middle - 1) * cut, 2 * cut) = pushed;
  chained.solveInPlace(u);

  ToothCompliance out;
  out.reach = std::min(2, middle);
  for (int o = -out.reach; o <= out.reach; ++o) {
    Eigen::MatrixXd at_cuts = Eigen::MatrixXd::Zero(2 * cut, stations);
    for (int side = 0; side < 2; ++side) {
      const int at = middle + o - 1 + side;
      if (at >= 0 && at < teeth - 1) at_cuts.middleRows(side * cut, cut) = u.middleRows(at * cut, cut);
    }
    Eigen::MatrixXd C = felt.transpose() * at_cuts;
    if (o == 0) C += Z.transpose() * Y;
    out.at_offset.push_back(std::move(C));
  }
  const Eigen::MatrixXd& own = out.at_offset[static_cast<std::size_t>(out.reach)];
  out.reciprocity = (own - own.transpose()).cwiseAbs().maxCoeff() / own.cwiseAbs().maxCoeff();
  return out;
}

}  // namespace toothpath::elastic
