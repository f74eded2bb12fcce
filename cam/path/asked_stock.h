// How much of its allowance an operation must leave.
#pragma once

namespace toothpath::path {

/// Shares of the allowance: what must stand everywhere after the operation, and what is planned, so that roundings have
/// room.
inline constexpr double kAskedStock = 0.8, kPlannedStock = 0.85;

}  // namespace toothpath::path
