#include "cam/line/minimax.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace toothpath::line {
namespace {

constexpr int kExchanges = 500;
constexpr double kSlack = 1e-13;

using Square = Eigen::Matrix<double, kUnknowns, kUnknowns>;

}  // namespace

std::optional<Unknowns> least_last(const std::vector<LinearRow>& asked, const Unknowns& box) {
  // The box first: its lower sides are active at the start, with the price 1 on the last unknown and 0 on the others.
  std::vector<LinearRow> rows;
  rows.reserve(asked.size() + 2 * kUnknowns);
  for (int k = 0; k < kUnknowns; ++k) rows.push_back({Unknowns::Unit(k), -box[k]});
  for (int k = 0; k < kUnknowns; ++k) rows.push_back({-Unknowns::Unit(k), -box[k]});
  rows.insert(rows.end(), asked.begin(), asked.end());
  std::array<std::size_t, kUnknowns> active = {0, 1, 2, 3};
  for (int exchange = 0; exchange < kExchanges; ++exchange) {
    Square A;
    Unknowns b;
    for (int k = 0; k < kUnknowns; ++k) {
      A.row(k) = rows[active[std::size_t(k)]].a.transpose();
      b[k] = rows[active[std::size_t(k)]].b;
    }
    const auto lu = A.partialPivLu();
    const Unknowns x = lu.solve(b);
    const auto transposed = Square(A.transpose()).partialPivLu();
    const Unknowns price = transposed.solve(Unknowns::Unit(kUnknowns - 1));
    std::size_t worst = rows.size();
    double lack = kSlack;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (const double d = rows[k].b - rows[k].a.dot(x); d > lack) {
        lack = d;
        worst = k;
      }
    if (worst == rows.size()) return x;
    const Unknowns weight = transposed.solve(rows[worst].a);
    int leaves = -1;
    double least = INFINITY;
    for (int k = 0; k < kUnknowns; ++k)
      if (weight[k] > 1e-12 && price[k] / weight[k] < least) {
        least = price[k] / weight[k];
        leaves = k;
      }
    if (leaves < 0) return {};
    active[std::size_t(leaves)] = worst;
  }
  return {};
}

}  // namespace toothpath::line
