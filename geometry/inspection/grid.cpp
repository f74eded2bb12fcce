#include "geometry/inspection/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "geometry/face_gear/space_sheet.h"

namespace toothpath::inspection {
namespace {

constexpr int kLeastInspectedRows = 5, kLeastInspectedColumns = 9, kMost = 1000;
constexpr double kMostMargin = 0.4;

/// k of n values spread over [from, to], both ends moved in by a part of the span.
double inside(double from, double to, double margin, int k, int n) {
  return from + (to - from) * (margin + (1 - 2 * margin) * double(k) / double(n - 1));
}

/// The points of one column, from the fillet to the tip.
Result<std::vector<InspectionPoint>> column_points(const face_gear::SpaceSheet& sheet, int side, double r,
                                                   const InspectionOptions& options) {
  const auto& f = sheet.surface();
  const double z_tip = f.z_tip(r), theta_t = f.shaper.theta_t;
  const auto tip = sheet.invert(side, r, z_tip);
  if (!tip)
    return fail("flank {:+d} does not reach the tip surface at radius {:.4f} mm (height {:.4f} mm)", side, r, z_tip);
  const double theta_top = std::max(tip->theta, 0.0);
  if (theta_top >= theta_t) return fail("flank {:+d} has no involute at radius {:.4f} mm", side, r);
  std::vector<InspectionPoint> points(std::size_t(options.rows));
  double theta = tip->theta, B = tip->B;
  for (int row = options.rows - 1; row >= 0; --row) {  // from the tip down, each solution starts the next
    const double goal = inside(theta_t, theta_top, options.margin, row, options.rows), from = theta;
    const int steps = std::max(1, int(std::ceil(std::abs(goal - from) / 0.05)));
    for (int k = 1; k <= steps; ++k) {
      theta = k == steps ? goal : from + (goal - from) * double(k) / double(steps);
      const auto next = sheet.B_at_radius(side, theta, r, B);
      if (!next) return fail("flank {:+d} does not reach its fillet at radius {:.4f} mm: undercut", side, r);
      B = *next;
    }
    const auto at = sheet.flank(side, theta, B);
    InspectionPoint& point = points[std::size_t(row)];
    point.side = side;
    point.row = row;
    point.theta = theta;
    point.B = B;
    point.p = at.p;
    point.n = at.n;
  }
  return points;
}

}  // namespace

Result<std::vector<InspectionPoint>> inspection_grid(const face_gear::FaceGear& gear,
                                                     const InspectionOptions& options) {
  if (options.rows < kLeastInspectedRows || options.rows > kMost)
    return fail("inspection rows = {} is outside {} .. {}", options.rows, kLeastInspectedRows, kMost);
  if (options.columns < kLeastInspectedColumns || options.columns > kMost)
    return fail("inspection columns = {} is outside {} .. {}", options.columns, kLeastInspectedColumns, kMost);
  if (!(options.margin >= 0 && options.margin <= kMostMargin))
    return fail("inspection margin = {:g} is outside 0 .. {:g}", options.margin, kMostMargin);
  std::vector<InspectionPoint> grid;
  for (std::size_t zone = 0; zone < gear.rings().size(); ++zone) {
    const face_gear::FaceGearRing& ring = gear.rings()[zone];
    for (const int side : {1, -1}) {
      const auto first = grid.size();
      for (int column = 0; column < options.columns; ++column) {
        const double r =
            inside(ring.zone.inner_radius_mm, ring.zone.outer_radius_mm, options.margin, column, options.columns);
        auto points = column_points(gear.drawn(zone), side, r, options);
        if (!points) return points.error();
        for (InspectionPoint& point : *points) {
          point.zone = int(zone);
          point.column = column;
          grid.push_back(point);
        }
      }
      std::stable_sort(grid.begin() + std::ptrdiff_t(first), grid.end(),
                       [](const InspectionPoint& a, const InspectionPoint& b) { return a.row < b.row; });
    }
  }
  return grid;
}

std::string inspection_csv(const std::vector<InspectionPoint>& points) {
  std::string text = "zone,flank,row,column,x,y,z,i,j,k\n";
  const auto number = [&](double v) { fmt::format_to(std::back_inserter(text), ",{:.13g}", v + 0.0); };  // -0 becomes 0
  for (const InspectionPoint& point : points) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}", point.zone, point.side, point.row, point.column);
    for (int k = 0; k < 3; ++k) number(point.p[k]);
    for (int k = 0; k < 3; ++k) number(point.n[k]);
    text += '\n';
  }
  return text;
}

}  // namespace toothpath::inspection
