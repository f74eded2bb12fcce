#include "geometry/elastic/frontal_factor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

namespace toothpath::elastic {
namespace {

/// What an eliminated part adds to the rows that it touches: a lower half.
struct Update {
  std::vector<int> rows;
  Eigen::MatrixXd values;
};

/// Adds the lower half of `update` where `place` says its rows stand; their order is kept.
void add(const Update& update, const std::vector<Eigen::Index>& place, Eigen::MatrixXd& to) {
  for (std::size_t c = 0; c < update.rows.size(); ++c) {
    const Eigen::Index column = place[static_cast<std::size_t>(update.rows[c])];
    for (std::size_t r = c; r < update.rows.size(); ++r)
      to(place[static_cast<std::size_t>(update.rows[r])], column) +=
          update.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
  }
}

}  // namespace

std::optional<FrontalFactor> FrontalFactor::make(const Eigen::SparseMatrix<double>& K, const std::vector<int>& parts) {
  using It = Eigen::SparseMatrix<double>::InnerIterator;
  const Eigen::Index all = K.rows(), leading = std::accumulate(parts.begin(), parts.end(), Eigen::Index(0));
  std::vector<std::size_t> part_of(static_cast<std::size_t>(all), parts.size());
  std::vector<std::vector<Update>> waiting(parts.size() + 1);  // of a part: updates whose first row is in it
  std::vector<Eigen::Index> place(static_cast<std::size_t>(all));
  for (std::size_t k = 0, row = 0; k < parts.size(); ++k)
    for (int n = 0; n < parts[k]; ++n) part_of[row++] = k;

  FrontalFactor out;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Front front{first, parts[k], {}, {}};
    const Eigen::Index next = first + front.size;
    for (Eigen::Index column = first; column < next; ++column)
      for (It entry(K, column); entry; ++entry)
        if (entry.row() >= next) front.behind.push_back(static_cast<int>(entry.row()));
    for (const Update& update : waiting[k])
      std::copy_if(update.rows.begin(), update.rows.end(), std::back_inserter(front.behind),
                   [&](int row) { return row >= next; });
    std::sort(front.behind.begin(), front.behind.end());
    front.behind.erase(std::unique(front.behind.begin(), front.behind.end()), front.behind.end());

    const auto behind = static_cast<Eigen::Index>(front.behind.size());
    for (Eigen::Index n = 0; n < front.size; ++n) place[static_cast<std::size_t>(first + n)] = n;
    for (Eigen::Index n = 0; n < behind; ++n)
      place[static_cast<std::size_t>(front.behind[static_cast<std::size_t>(n)])] = front.size + n;
    Eigen::MatrixXd F = Eigen::MatrixXd::Zero(front.size + behind, front.size + behind);
    for (Eigen::Index column = first; column < next; ++column)
      for (It entry(K, column); entry; ++entry)
        F(place[static_cast<std::size_t>(entry.row())], column - first) += entry.value();
    for (const Update& update : waiting[k]) add(update, place, F);
    waiting[k].clear();

    Eigen::Ref<Eigen::MatrixXd> own = F.topLeftCorner(front.size, front.size);
    if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(own).info() != Eigen::Success) return std::nullopt;
    if (behind > 0) {
      auto below = F.bottomLeftCorner(behind, front.size);
      own.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
      Eigen::MatrixXd left = F.bottomRightCorner(behind, behind);
      left.selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
      waiting[part_of[static_cast<std::size_t>(front.behind.front())]].push_back({front.behind, std::move(left)});
    }
    front.L = F.leftCols(front.size);
    out.fronts_.push_back(std::move(front));
    first = next;
  }

  const Eigen::Index rest = all - leading;
  out.rest_ = Eigen::MatrixXd::Zero(rest, rest);
  for (Eigen::Index n = 0; n < rest; ++n) place[static_cast<std::size_t>(leading + n)] = n;
  for (Eigen::Index column = leading; column < all; ++column)
    for (It entry(K, column); entry; ++entry) out.rest_(entry.row() - leading, column - leading) += entry.value();
  for (const Update& update : waiting.back()) add(update, place, out.rest_);
  out.rest_ = Eigen::MatrixXd(out.rest_.selfadjointView<Eigen::Lower>());
  return out;
}

void FrontalFactor::forward(Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd driven;
  for (const Front& front : fronts_) {
    auto own = columns.middleRows(front.first, front.size);
    if (own.isZero(0)) continue;  // no load has come here
    front.L.topRows(front.size).triangularView<Eigen::Lower>().solveInPlace(own);
    driven.noalias() = front.L.bottomRows(front.L.rows() - front.size) * own;
    for (Eigen::Index c = 0; c < columns.cols(); ++c)
      for (std::size_t r = 0; r < front.behind.size(); ++r)
        columns(front.behind[r], c) -= driven(static_cast<Eigen::Index>(r), c);
  }
}

void FrontalFactor::backward(Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd known;
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    known.resize(static_cast<Eigen::Index>(front->behind.size()), columns.cols());
    for (Eigen::Index c = 0; c < columns.cols(); ++c)
      for (std::size_t r = 0; r < front->behind.size(); ++r)
        known(static_cast<Eigen::Index>(r), c) = columns(front->behind[r], c);
    auto own = columns.middleRows(front->first, front->size);
    own.noalias() -= front->L.bottomRows(front->L.rows() - front->size).transpose() * known;
    front->L.topRows(front->size).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

}  // namespace toothpath::elastic
