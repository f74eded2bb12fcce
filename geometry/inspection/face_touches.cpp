#include "geometry/inspection/face_touches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/inspection/grid.h"

namespace toothpath::inspection {
namespace {

constexpr double kBelowTop = 1;  // of a touch of the blank's rim

const InspectionPoint& point_of(const std::vector<InspectionPoint>& grid, int zone, int side, int row, int column) {
  return *std::find_if(grid.begin(), grid.end(), [&](const InspectionPoint& p) {
    return p.zone == zone && p.side == side && p.row == row && p.column == column;
  });
}

}  // namespace

PartReach TouchedFaceGear::reach() const {
  return {std::min(gear_.lowest_root(), gear_.blank_top()), gear_.blank_top(), gear_.outer_radius()};
}

/// The flank of side +1 is that of the tooth before the space, -1 of the tooth behind it.
double TouchedFaceGear::turn_of(const Touch& touch, int side) const {
  return (side > 0 ? touch.space : touch.space + 1) * gear_.pitch();
}

Result<std::vector<Touch>> TouchedFaceGear::flank_places(int spaces) const {
  const auto grid = inspection_grid(gear_, {5, 9, 0.05});
  if (!grid) return grid.error();
  const std::vector<int> columns = gear_.rings().size() > 1 ? std::vector<int>{4} : std::vector<int>{2, 6};
  std::vector<Touch> out;
  for (int k = 0; k < spaces; ++k)
    for (int zone = 0; zone < int(gear_.rings().size()); ++zone)
      for (const int column : columns)
        for (const int side : {1, -1}) {
          const InspectionPoint& p = point_of(*grid, zone, side, 2, column);
          Touch touch;
          touch.zone = zone;
          touch.side = side;
          touch.space = int(std::lround(double(k) * teeth() / spaces));
          touch.remark = fmt::format("ZONE {} TOOTH {} FLANK {:+}", zone,
                                     (side > 0 ? touch.space : touch.space + 1) % teeth(), side);
          const double turn = turn_of(touch, side);
          touch.normal = turned(p.n, turn);
          touch.surface = turned(p.p, turn);
          out.push_back(std::move(touch));
        }
  return out;
}

Result<std::vector<Touch>> TouchedFaceGear::blank_places(int spaces) const {
  if (std::abs(gear_.rings().front().surface.Cg) > 1e-12)
    return fail("shaft_angle = {:g} deg: the blank has no flat top to touch, 90 deg has",
                degrees(gear_.parameters().shaft_angle_rad));
  const double top = gear_.blank_top();
  const auto& outer = gear_.rings().back().zone;
  const double middle = 0.5 * (outer.inner_radius_mm + outer.outer_radius_mm);
  std::vector<Touch> out;
  for (int k = 0; k < spaces; ++k)
    for (const Touched what : {Touched::top, Touched::rim}) {
      const Vec3 outward = turned(Vec3::UnitX(), kTwoPi * k / spaces);
      Touch touch;
      touch.what = what;
      touch.remark = what == Touched::top ? "TOP OF THE BLANK" : "RIM OF THE BLANK";
      touch.normal = what == Touched::top ? Vec3(Vec3::UnitZ()) : outward;
      touch.surface = what == Touched::top ? Vec3(middle * outward + Vec3(0, 0, top))
                                           : Vec3(outer.outer_radius_mm * outward + Vec3(0, 0, top - kBelowTop));
      out.push_back(std::move(touch));
    }
  return out;
}

std::optional<double> TouchedFaceGear::distance(const Touch& touch, const Vec3& x) const {
  if (touch.what == Touched::top) return x.z() - gear_.blank_top();
  if (touch.what == Touched::rim) return radius(x) - gear_.outer_radius();
  const auto& f = gear_.rings()[std::size_t(touch.zone)].surface;
  const auto d = face_gear::flank_distance(f, touch.side, turned(x, -turn_of(touch, touch.side)));
  if (!d) return {};
  return d->distance;
}

double TouchedFaceGear::flank(const Touch& touch, int side, const Vec3& x) const {
  const auto& f = gear_.rings()[std::size_t(touch.zone)].surface;
  // Above the tops the flank goes on as far as its involute; from what is higher it stands farther off.
  Vec3 q = turned(x, -turn_of(touch, side));
  for (int k = 0; k < 200; ++k, q.z() -= 0.05 * f.shaper.m_t)
    if (const auto d = face_gear::flank_distance(f, side, q)) return d->distance;
  return -std::numeric_limits<double>::infinity();
}

double TouchedFaceGear::above_root(const Touch&, const Vec3& x) const { return x.z() - gear_.lowest_root(); }
double TouchedFaceGear::below_tops(const Touch&, const Vec3& x) const {
  return std::max(gear_.blank_top() - x.z(), 0.0);
}

}  // namespace toothpath::inspection
