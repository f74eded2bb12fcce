// Golden section: one extreme between two places, where one is expected; no smoothness is needed.
#pragma once

#include <cmath>
#include <utility>

namespace toothpath {

/// @tparam Better  std::less_equal<> seeks the least, std::greater<> the greatest
template <typename F, typename Better>
class GoldenSection {
 public:
  /// The first two values are asked for.
  GoldenSection(double from, double to, F f, Better better = {})
      : f_(std::move(f)), better_(better), a_(from), b_(to), p_(left()), q_(right()), fp_(f_(p_)), fq_(f_(q_)) {}

  /// One more value: the interval becomes 0.618 of what it was.
  void step() {
    if (better_(fp_, fq_)) {
      b_ = q_, q_ = p_, fq_ = fp_;
      p_ = left(), fp_ = f_(p_);
    } else {
      a_ = p_, p_ = q_, fp_ = fq_;
      q_ = right(), fq_ = f_(q_);
    }
  }
  [[nodiscard]] double width() const { return b_ - a_; }
  [[nodiscard]] double middle() const { return 0.5 * (a_ + b_); }
  /// The better of the two places inside, and its value.
  [[nodiscard]] std::pair<double, double> best() const {
    return better_(fp_, fq_) ? std::pair{p_, fp_} : std::pair{q_, fq_};
  }

 private:
  [[nodiscard]] double left() const { return b_ - share() * (b_ - a_); }
  [[nodiscard]] double right() const { return a_ + share() * (b_ - a_); }
  [[nodiscard]] static double share() { return 0.5 * (std::sqrt(5.0) - 1); }

  F f_;
  Better better_;
  double a_, b_, p_, q_, fp_, fq_;
};

template <typename Better, typename F>
[[nodiscard]] GoldenSection<F, Better> golden_section(double from, double to, F f) {
  return GoldenSection<F, Better>(from, to, std::move(f));
}

}  // namespace toothpath
