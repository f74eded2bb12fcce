// What is said of surface that the finishing ball does not reach: beside the verdict, in warnings and reasons.
#pragma once

#include <string>

#include "cam/proof/verification.h"

namespace toothpath::report {

/// "27.3 % of the finished surface is out of reach of the ball of 2 mm and stays up to 0.275 mm high; the largest ball that reaches all of it has
/// 1.204 mm". Empty where nothing was left.
[[nodiscard]] std::string unreached_text(const proof::UnreachedResult& unreached);

/// "27.3 %"; what is more than nothing is never told as 0.0.
[[nodiscard]] std::string unreached_share_text(const proof::UnreachedResult& unreached);

/// "the largest ball that reaches all of it has 1.204 mm", rounded down: a ball of the diameter told does reach; or that none does.
[[nodiscard]] std::string largest_ball_text(const proof::UnreachedResult& unreached);

}  // namespace toothpath::report
