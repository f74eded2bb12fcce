#include "geometry/inspection/tooth_touches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/inspection/grid.h"
#include "geometry/mesh/tooth_section.h"

namespace toothpath::inspection {
namespace {

constexpr double kBelowTop = 1;  // mm: of a touch of the blank's end
constexpr double kAlongAxis = 1e-9, kNoLean = 1e-9;
constexpr int kStarts = 7;  // of searches, along and up a flank
constexpr int kLooks = 33;  // along a ring, for its highest place

const InspectionPoint& point_of(const std::vector<InspectionPoint>& grid, int zone, int side, int row, int column) {
  return *std::find_if(grid.begin(), grid.end(), [&](const InspectionPoint& p) {
    return p.zone == zone && p.side == side && p.row == row && p.column == column;
  });
}

double part_of(double from, double to, int k, int n) { return from + (to - from) * double(k) / double(n - 1); }

}  // namespace

TouchedTeeth::TouchedTeeth(tooth_space::ToothedSolid gear, double above_mm)
    : gear_(std::move(gear)), above_(above_mm), top_(-INFINITY), starts_(gear_.rings.size()) {
  for (std::size_t ring = 0; ring < gear_.rings.size(); ++ring) {
    const auto& space = *gear_.rings[ring].space;
    const auto& outline = space.outline();
    for (int k = 0; k < kLooks; ++k)
      top_ = std::max(top_, top_at(ring, part_of(outline.s_from, outline.s_to, k, kLooks)));
    std::optional<mesh::ToothSection> near;
    for (int k = 0; k < kStarts; ++k) {
      auto section =
          mesh::ToothSection::at(space, part_of(outline.s_from, outline.s_to, k, kStarts), near ? &*near : nullptr);
      if (!section) continue;  // told where places are asked for
      near = std::move(*section);
      for (const int side : {1, -1}) {
        const auto [low, high] = near->flank_ends(side);
        for (int i = 0; i < kStarts; ++i)
          if (const auto at = near->flank_at(side, part_of(low, high, i, kStarts)))
            starts_[ring][side > 0 ? 0 : 1].push_back({at->uv.x(), at->uv.y(), at->p});
      }
    }
  }
}

std::size_t TouchedTeeth::ring_of(int zone) const {
  std::size_t ring = 0;
  while (gear_.rings[ring].zone != zone) ++ring;
  return ring;
}

Vec3 TouchedTeeth::up_at(const Vec3& outwards) const {
  return gear_.chart().r(0, 1) * outwards + gear_.chart().z(0, 1) * Vec3::UnitZ();
}
Vec3 TouchedTeeth::placed(double s, double h, const Vec3& outwards) const {
  return gear_.chart().r(s, h) * outwards + gear_.chart().z(s, h) * Vec3::UnitZ();
}

PartReach TouchedTeeth::reach() const {
  PartReach out{INFINITY, -INFINITY, 0};
  for (std::size_t ring = 0; ring < gear_.rings.size(); ++ring) {
    const auto& outline = gear_.rings[ring].space->outline();
    for (const double station : {outline.s_from, outline.s_to})
      for (const double h : {gear_.lowest_root, top_at(ring, gear_.rings[ring].space->tip_s(station))}) {
        const double s = outline.s_at(station, h);
        out.low_mm = std::min(out.low_mm, outline.chart.z(s, h));
        out.high_mm = std::max(out.high_mm, outline.chart.z(s, h));
        out.radius_mm = std::max(out.radius_mm, outline.chart.r(s, h));
      }
  }
  return out;
}

Result<std::vector<Touch>> TouchedTeeth::flank_places(int spaces) const {
  const auto grid = inspection_grid(gear_, {5, 9, 0.05});
  if (!grid) return grid.error();
  const std::vector<int> columns = gear_.rings.size() > 1 ? std::vector<int>{4} : std::vector<int>{2, 6};
  std::vector<Touch> out;
  for (int k = 0; k < spaces; ++k)
    for (int zone = 0; zone < int(gear_.rings.size()); ++zone)
      for (const int column : columns) {
        const int space = int(std::lround(double(k) * teeth() / spaces));
        std::array<Touch, 2> pair;
        for (const int side : {1, -1}) {
          const InspectionPoint& p = point_of(*grid, zone, side, 2, column);
          Touch& touch = pair[side > 0 ? 0 : 1];
          touch.zone = zone;
          touch.side = side;
          touch.space = space;
          touch.remark =
              fmt::format("ZONE {} TOOTH {} FLANK {:+}", zone, (side > 0 ? space : space + 1) % teeth(), side);
          const double turn = (space + (side < 0 && gear_.measured_on_one_tooth ? 1 : 0)) * gear_.pitch();
          touch.normal = turned(p.n, turn);
          touch.surface = turned(p.p, turn);
        }
        Vec3 middle = pair[0].surface + pair[1].surface;
        middle.z() = 0;
        for (Touch& touch : pair) {
          touch.up = up_at(middle.normalized());
          out.push_back(std::move(touch));
        }
      }
  // Cylindrical teeth move along themselves: their ends show the place along the axis.
  if (std::abs(gear_.chart().cosine) > kAlongAxis) return out;
  const std::size_t ring = gear_.rings.size() - 1;
  const auto& outline = gear_.rings[ring].space->outline();
  const auto section = mesh::ToothSection::at(*gear_.rings[ring].space, outline.s_to);
  if (!section) return section.error();
  const double h = 0.5 * (gear_.lowest_root + gear_.rings[ring].space->tip(outline.s_to));
  const tooth_space::EndLine end = outline.end(true);
  for (int k = 0; k < spaces; ++k) {
    Touch touch;
    touch.what = Touched::end;
    touch.zone = gear_.rings[ring].zone;
    touch.space = int(std::lround(double(k) * teeth() / spaces));
    touch.remark = fmt::format("ZONE {} TOOTH {} END", touch.zone, touch.space % teeth());
    Vec3 outwards = turned(section->point(std::size_t(mesh::Segment::land_left), 0)->p, touch.space * gear_.pitch());
    outwards.z() = 0;
    outwards.normalize();
    touch.up = up_at(outwards);
    touch.normal = placed(1, -end.lean, outwards).normalized();
    touch.surface = placed(end.at(h), h, outwards);
    out.push_back(std::move(touch));
  }
  return out;
}

Result<std::vector<Touch>> TouchedTeeth::blank_places(int spaces) const {
  const std::size_t ring = gear_.rings.size() - 1;
  const auto& outline = gear_.rings[ring].space->outline();
  const double middle = 0.5 * (outline.s_from + outline.s_to),
               lean = std::atan(gear_.rings[ring].space->tip_bend(outline.s_from, outline.s_to).slope.magnitude());
  if (lean > kNoLean) return fail("the top of the blank leans by {:g} deg: it has no flat top to touch", degrees(lean));
  std::vector<Touch> out;
  const tooth_space::EndLine end = outline.end(true);
  for (int k = 0; k < spaces; ++k)
    for (const Touched what : {Touched::top, Touched::rim}) {
      const Vec3 outwards = turned(Vec3::UnitX(), kTwoPi * k / spaces);
      const bool top = what == Touched::top;
      const bool radial = outline.chart.cosine > 0.5;
      Touch touch;
      touch.what = what;
      touch.zone = gear_.rings[ring].zone;
      touch.remark = top ? "TOP OF THE BLANK" : radial ? "RIM OF THE BLANK" : "END OF THE BLANK";
      touch.up = up_at(outwards);
      const double below = top_at(ring, outline.s_to) - kBelowTop;
      touch.normal = top ? touch.up : placed(1, -end.lean, outwards).normalized();
      touch.surface = top ? placed(middle, top_at(ring, middle), outwards) : placed(end.at(below), below, outwards);
      out.push_back(std::move(touch));
    }
  return out;
}

std::optional<double> TouchedTeeth::flank_distance(std::size_t ring, int side, const Vec3& in_space) const {
  const auto& starts = starts_[ring][side > 0 ? 0 : 1];
  const Start* nearest = nullptr;
  double least = INFINITY;
  for (const Start& start : starts)
    if (const double far = (start.p - in_space).squaredNorm(); far < least) least = far, nearest = &start;
  if (!nearest) return {};
  const auto foot = gear_.rings[ring].space->foot(tooth_space::flank_of(side), in_space, nearest->u, nearest->v);
  // A foot is nearer than where its search began.
  if (!foot || foot->distance * foot->distance > least * (1 + 1e-9)) return {};
  return foot->distance;
}

std::optional<double> TouchedTeeth::distance(const Touch& touch, const Vec3& x) const {
  const std::size_t ring = ring_of(touch.zone);
  if (touch.what == Touched::top) return gear_.chart().up(x) - top_at(ring, gear_.rings[ring].space->outline().s_to);
  if (touch.what != Touched::flank) {
    const tooth_space::EndLine end = gear_.rings[ring].space->outline().end(true);
    return (gear_.chart().along(x) - end.at(gear_.chart().up(x))) / std::hypot(1, end.lean);
  }
  return flank_distance(ring, touch.side, turned(x, -touch.space * gear_.pitch()));
}

double TouchedTeeth::flank(const Touch& touch, int side, const Vec3& x) const {
  // Above the tops the flank goes on as far as it can; from what is higher it stands farther off.
  const std::size_t ring = ring_of(touch.zone);
  Vec3 q = turned(x, -touch.space * gear_.pitch());
  for (int k = 0; k < 200; ++k) {
    if (const auto d = flank_distance(ring, side, q)) return *d;
    q -= 0.05 * gear_.module_mm * up_at(Vec3(q.x(), q.y(), 0).normalized());
  }
  return -std::numeric_limits<double>::infinity();
}

double TouchedTeeth::above_root(const Touch&, const Vec3& x) const { return gear_.chart().up(x) - gear_.lowest_root; }
double TouchedTeeth::below_tops(const Touch& touch, const Vec3& x) const {
  constexpr int kSteps = 4;  // h grows less than the way where x stands beside the direction of the stem
  double way = 0;
  for (int k = 0; k < kSteps; ++k) way = std::max(way + top_ - gear_.chart().up(x + way * touch.up), 0.0);
  return way;
}

}  // namespace toothpath::inspection
