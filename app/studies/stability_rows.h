// The rows of the stability study: what was tried, how far double is from 50 digits, and the verdict.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace toothpath::studies {

/// Round-off of a double, and how many of it the size of a part may take: some hundred operations, no cancellation.
inline constexpr double kEps = std::numeric_limits<double>::epsilon();
inline constexpr double kRounding = 256;

enum class Expected { accept, refuse };

/// One extreme case.
struct StabilityRow {
  std::string group = {}, name = {};
  double error_mm = 0;  ///< greatest distance of double from 50 digits
  double limit_mm = 0;  ///< what rounding may do: a multiple of eps times the size of the part
  double condition =
      0;  ///< of the hardest point: relative change of the answer per relative change of the question; 0: none
  int iterations = 0;  ///< most steps of one solution; 0: closed form
  double swept_mm =
      0;  ///< greatest distance from the swept solid, which knows no equation of meshing; 0: not applicable
  int points = 0;
  bool fine = false;
  std::string verdict = {};  ///< "pass", "refused" or "FAIL"
  std::string reason = {};
};

/// Face gears: every extreme gear, near undercut, near pointing, gears that must be refused.
[[nodiscard]] std::vector<StabilityRow> face_gear_rows();
/// Equal-base-circle bevel gears.
[[nodiscard]] std::vector<StabilityRow> bevel_gear_rows();
/// Inverse kinematics at and near the pole, and the path between two blocks without tool centre control.
[[nodiscard]] std::vector<StabilityRow> kinematics_rows();

/// Sets the verdict of a row whose errors are filled in: fails on NaN, on an error beyond its limit and on points off
/// the swept solid.
void judge(StabilityRow& row, double swept_limit_mm);
/// The verdict of a case that was refused with `message`, or accepted (empty message).
void judge_refusal(StabilityRow& row, Expected expected, const std::string& message);

}  // namespace toothpath::studies
