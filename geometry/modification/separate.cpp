#include "geometry/modification/separate.h"

#include <algorithm>
#include <cmath>

namespace toothpath::modification {
namespace {

constexpr double kNothing = 1e-12;  // mm: rounding of the means of a grid

bool nothing(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::abs(v) <= kNothing; });
}

Separate separate_grid(const Grid& g, double factor) {
  const std::size_t rows = g.depth_mm.size(), columns = g.along_mm.size();
  std::vector<double> row(rows, 0.0), column(columns, 0.0);
  double mean = 0;
  const auto at = [&](std::size_t k, std::size_t n) { return factor * g.removal_mm[k * columns + n]; };
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t n = 0; n < columns; ++n) {
      row[k] += at(k, n) / double(columns);
      column[n] += at(k, n) / double(rows);
      mean += at(k, n) / double(rows * columns);
    }
  const double least = *std::min_element(row.begin(), row.end());
  for (double& v : row) v -= least;
  for (double& v : column) v += least - mean;
  Separate out;
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t n = 0; n < columns; ++n)
      if (const double mixed = std::abs(at(k, n) - row[k] - column[n]); mixed > std::max(out.mixed_mm, kNothing))
        out.mixed_mm = mixed, out.depth_mm = g.depth_mm[k], out.along_mm = g.along_mm[n];
  if (!nothing(row)) out.over_depth.push_back(SmoothCurve::spline(g.depth_mm, row));
  if (!nothing(column)) out.over_face.push_back(SmoothCurve::spline(g.along_mm, column));
  return out;
}

}  // namespace

Separate separate(const Modification& m, const Rectangle& on) {
  if (m.grid) return separate_grid(*m.grid, m.amount_mm);
  Separate out;
  if (m.kind == Kind::twist) {  // nothing in its middle, C/2 about it at the corners
    out.mixed_mm = 0.5 * std::abs(m.amount_mm);
    out.along_mm = on.to_mm;
    return out;
  }
  const bool over_face =
      m.kind == Kind::end_relief || m.kind == Kind::lead_crowning || m.kind == Kind::helix_angle_slope;
  Modification everywhere = m;
  everywhere.flanks = Flanks::both;
  everywhere.zone.reset();
  const Field field({everywhere}, 1, 0, on);
  for (const Field::Term& term : field.terms())
    (over_face ? out.over_face : out.over_depth).push_back(over_face ? term.over_face : term.over_depth);
  return out;
}

}  // namespace toothpath::modification
