#include "app/report/unreached_text.h"

#include <fmt/format.h>

#include <cmath>

namespace toothpath::report {

std::string unreached_share_text(const proof::UnreachedResult& unreached) {
  const double percent = 100 * unreached.share;
  return percent < 0.1 ? "< 0.1 %" : fmt::format("{:.1f} %", percent);
}

std::string largest_ball_text(const proof::UnreachedResult& unreached) {
  if (unreached.largest_ball_mm <= 0) return "no ball reaches all of it: the fillet has a sharp corner";
  return fmt::format("the largest ball that reaches all of it has {:.3f} mm", std::floor(unreached.largest_ball_mm * 1000) / 1000);
}

std::string unreached_text(const proof::UnreachedResult& unreached) {
  if (!unreached.left()) return {};
  return fmt::format("{} of the finished surface is out of reach of the ball of {:g} mm and stays up to {:.3f} mm high; {}", unreached_share_text(unreached),
                     unreached.ball_mm, unreached.height_mm, largest_ball_text(unreached));
}

}  // namespace toothpath::report
