// With G641 ADIS every axis may leave the path within a way s ahead of and behind a corner; nothing is known of the
// curve but that each axis stays between its least and its greatest position there. The way is measured over the axes
// of the path group, a rotary at the radius R. If a piece of the way moves X Y Z by d and the n rotaries by w_k, then
// d^2 + sum (R w_k)^2 <= s^2; the larger of both pieces, axis by axis, has twice that at most. With R at least the
// distance of the tip from every rotary axis the tip leaves the corner by
//   |d| + w (R + |d| + w R) <= s sqrt(2 (1 + n)) (1 + w),   w = sum w_k <= s sqrt(2 n) / R,
// since a turn by w moves a point by no more than w times its distance, which the steps before have made larger.
#include "postproc/text/corners.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::text {
namespace {

constexpr double kLeastRadius = 1;    // mm
constexpr double kBlendDigits = 1e6;  // {blend} is printed with six digits
constexpr double kAxisDigits = 1e4;   // {blend_axis} with four

double rounded_down(double value, double digits) { return std::floor(value * digits + 1e-6) / digits; }

double rotaries_of(const joints::AxisProgram& program) {
  return (program.letters[3] != 0 ? 1 : 0) + (program.letters[4] != 0 ? 1 : 0);
}

/// Where the way is measured over the tip, or over X Y Z while the rotaries stand, n = 0.
CornerWords way_words(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  CornerWords out;
  out.group = program.turns_in_cuts && program.tcp == machines::TcpMode::none && !dialect.path_group.empty();
  out.radius_mm = std::max(kLeastRadius, std::ceil(program.tip_reach_mm));
  const double n = out.group ? rotaries_of(program) : 0;
  const double factor = std::sqrt(2 * (1 + n));
  const double largest_turn = out.group ? header.blend_mm * std::sqrt(2 * n) / out.radius_mm : 0;
  out.blend_mm = rounded_down(header.blend_mm / (factor * (1 + largest_turn)), kBlendDigits);
  out.granted_mm = out.blend_mm * factor * (1 + largest_turn);
  return out;
}

}  // namespace

CornerWords corner_words(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header,
                         const joints::AxisOperation* op) {
  CornerWords out;
  out.blend_mm = header.blend_mm;
  out.axis_deg = rounded_down(header.blend_axis_deg, kAxisDigits);
  if (!dialect.blend) {
    out.granted_mm = std::max({dialect.exact_path_mm, dialect.corner_mm, dialect.smoothing_mm});
    out.granted_rad = dialect.smoothing_axis_rad.value_or(0);
    return out;
  }
  const bool tcp = program.tcp != machines::TcpMode::none;
  // Without TCP no word bounds a rotary that turns in a cut.
  out.contour = header.contour_granted && !dialect.contour_on.empty() && (tcp || !program.turns_in_cuts);
  if (dialect.blend_is_way && !out.contour) return way_words(program, dialect, header);
  if (op != nullptr && op->wide_corners) {
    out.wide = true;
    out.blend_mm = op->wide_corners->mm;
    out.axis_deg = rounded_down(op->wide_corners->axis_deg, kAxisDigits);
  }
  if (out.contour || out.wide) out.blend_mm = rounded_down(out.blend_mm, kBlendDigits);
  if ((dialect.blend_axis || out.contour) && tcp) out.granted_rad = rotaries_of(program) * radians(out.axis_deg);
  out.granted_mm = out.blend_mm;
  return out;
}

void note_corners(joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  if (!dialect.blend) return;
  const CornerWords words = corner_words(program, dialect, header);
  program.corners = dialect.blend_is_way && !words.contour ? timing::Corners::way : timing::Corners::round;
  program.corner_tolerance_mm = words.blend_mm;
  for (joints::AxisOperation& op : program.operations)
    op.corner_tolerance_mm = op.wide_corners ? corner_words(program, dialect, header, &op).blend_mm : 0;
}

double granted_blend_mm(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  return corner_words(program, dialect, header).granted_mm;
}

double granted_blend_rad(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  return corner_words(program, dialect, header).granted_rad;
}

}  // namespace toothpath::text
