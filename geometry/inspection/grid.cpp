#include "geometry/inspection/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "geometry/mesh/tooth_section.h"

namespace toothpath::inspection {
namespace {

constexpr int kLeastInspectedRows = 5, kLeastInspectedColumns = 9, kMost = 1000;
constexpr double kMostMargin = 0.4;

/// k of n values spread over [from, to], both ends moved in by a part of the span.
double inside(double from, double to, double margin, int k, int n) {
  return from + (to - from) * (margin + (1 - 2 * margin) * double(k) / double(n - 1));
}

/// The points of one column, from the fillet to the tip.
Result<std::vector<InspectionPoint>> column_points(const tooth_space::ToothedSolid& gear,
                                                   const tooth_space::ToothSpace& space,
                                                   const mesh::ToothSection& section, int side,
                                                   const InspectionOptions& options) {
  const auto [at_fillet, at_tip] = section.flank_ends(side);
  double top = at_tip;
  if (gear.flanks_begin)
    top = at_fillet > at_tip ? std::max(top, *gear.flanks_begin) : std::min(top, *gear.flanks_begin);
  if ((top - at_fillet) * (at_tip - at_fillet) <= 0)
    return fail("flank {:+d} has no involute at {}", side, section.station());
  // The minus flank of the space is that of tooth 1.
  const double turn = side < 0 && gear.measured_on_one_tooth ? -gear.pitch() : 0;
  std::vector<InspectionPoint> points(std::size_t(options.rows));
  for (int row = 0; row < options.rows; ++row) {
    const auto at = section.flank_at(side, inside(at_fillet, top, options.margin, row, options.rows));
    const auto on_flank = at ? space.point(tooth_space::flank_of(side), at->uv.x(), at->uv.y()) : std::nullopt;
    if (!on_flank) return fail("flank {:+d} does not reach its fillet at {}: undercut", side, section.station());
    InspectionPoint& point = points[std::size_t(row)];
    point.side = side;
    point.row = row;
    point.theta = at->uv.x();
    point.B = at->uv.y();
    point.p = turned(on_flank->p, turn);
    point.n = turned(on_flank->n, turn);
  }
  return points;
}

}  // namespace

Result<std::vector<InspectionPoint>> inspection_grid(const tooth_space::ToothedSolid& gear,
                                                     const InspectionOptions& options) {
  if (options.rows < kLeastInspectedRows || options.rows > kMost)
    return fail("inspection rows = {} is outside {} .. {}", options.rows, kLeastInspectedRows, kMost);
  if (options.columns < kLeastInspectedColumns || options.columns > kMost)
    return fail("inspection columns = {} is outside {} .. {}", options.columns, kLeastInspectedColumns, kMost);
  if (!(options.margin >= 0 && options.margin <= kMostMargin))
    return fail("inspection margin = {:g} is outside 0 .. {:g}", options.margin, kMostMargin);
  std::vector<InspectionPoint> grid;
  for (const auto& ring : gear.rings) {
    const auto& outline = ring.space->outline();
    std::vector<mesh::ToothSection> sections;
    for (int column = 0; column < options.columns; ++column) {
      const double s = inside(outline.s_from, outline.s_to, options.margin, column, options.columns);
      auto section = mesh::ToothSection::at(*ring.space, s, sections.empty() ? nullptr : &sections.back());
      if (!section) return section.error();
      sections.push_back(std::move(*section));
    }
    for (const int side : {1, -1})
      for (int column = 0; column < options.columns; ++column) {
        auto points = column_points(gear, *ring.space, sections[std::size_t(column)], side, options);
        if (!points) return points.error();
        for (InspectionPoint& point : *points) {
          point.zone = ring.zone;
          point.column = column;
          grid.push_back(point);
        }
      }
  }
  std::stable_sort(grid.begin(), grid.end(), [](const InspectionPoint& a, const InspectionPoint& b) {
    return std::tuple(a.zone, -a.side, a.row) < std::tuple(b.zone, -b.side, b.row);
  });
  return grid;
}

std::string inspection_csv(const std::vector<InspectionPoint>& points, const FlankNames& names) {
  std::string text = "zone,flank,row,column,x,y,z,i,j,k\n";
  const auto number = [&](double v) { fmt::format_to(std::back_inserter(text), ",{:.13g}", v + 0.0); };  // -0 becomes 0
  for (const InspectionPoint& point : points) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}", point.zone, point.side > 0 ? names.plus : names.minus,
                   point.row, point.column);
    for (int k = 0; k < 3; ++k) number(point.p[k]);
    for (int k = 0; k < 3; ++k) number(point.n[k]);
    text += '\n';
  }
  return text;
}

}  // namespace toothpath::inspection
