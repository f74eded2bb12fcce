#include "geometry/loaded/face_flanks.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/loaded/half_space.h"

namespace toothpath::loaded {
namespace {

constexpr double kEllipses = 1.3;  // the first rectangle is so much wider than the ellipse of Hertz

}  // namespace

FaceFlanks::FaceFlanks(const LoadedPair& pair, double force, double phi) : pair_(pair), phi_(phi) {
  bodies_ = {pair.options.gear,
             pair.options.pinion,
             pair.modulus,
             pair.lever,
             pair.lever,
             pair.options.edge_radius_mm,
             true,
             false,
             -Vec3::UnitZ(),
             pair.rings.front().surface.a(),
             Vec3::Zero(),
             pair.rings.front().moved.foot,
             {}};
  for (const PairRing& ring : pair.rings)
    bodies_.rings.push_back({ring.ring, &ring.gear, &ring.pinion, &ring.gear_ends, &ring.pinion_ends, 1});
  for (std::size_t r = 0; r < pair.rings.size(); ++r) {
    const PairRing& ring = pair.rings[r];
    LineOptions options;
    options.segment_mm = pair.options.segment_mm;
    options.pinion = &ring.moved;
    options.removal = &ring.removal;
    for (const auto& line : contact_lines(ring.surface, ring.ring, pair.side, phi, ring.bounds, options)) {
      line_mm_ += line.length;
      add(r, line, force);
    }
  }
}

LineOfTooth FaceFlanks::line_of(const CellSite& site) const {
  const PairRing& ring = pair_.rings[site.ring];
  return {ring.surface, pair_.side,  phi_ + site.tooth * 2 * kPi / pair_.shaper_teeth,
          ring.bounds,  &ring.moved, {&ring.removal, 0}};
}

Segment FaceFlanks::segment(const CellSite& site, const LineOfTooth& line, const LinePlace& p) const {
  Segment s = segment_of(line, p);
  s.ring = bodies_.rings[site.ring].ring, s.tooth = site.tooth;
  s.along = site.along;
  if (pair_.options.gap) s.gap += pair_.options.gap(s);
  return s;
}

void FaceFlanks::add(std::size_t ring, const ContactLine& line, double force) {
  CellSite site;
  site.ring = ring, site.tooth = line.tooth, site.id = sites_.size();
  const LineOfTooth places = line_of(site);
  const auto gap = [&](double B) { return segment(site, places, places.at(B)).gap; };
  constexpr int kStations = 40;
  const double step = (line.to_B - line.from_B) / kStations;
  int best = 0;
  for (int k = 1; k <= kStations; ++k)
    if (gap(line.from_B + step * k) < gap(line.from_B + step * best)) best = k;
  LinePlace middle = places.at(line.from_B + step * best);
  places.bend(middle);
  site.point = middle.point, site.normal = middle.normal, site.curvature = middle.curvature;
  site.across = middle.steepest;
  site.along = middle.normal.cross(site.across).normalized();
  const auto sides =
      ellipse_sides(force, pair_.modulus, middle.curvature, middle.curvature * std::max(middle.roundness, 0.0));
  site.half_x = kEllipses * sides[0], site.half_y = kEllipses * std::min(sides[1], line.length);
  sites_.push_back(site);
  middles_.push_back(std::move(middle));
}

LinePlace FaceFlanks::place(const CellSite& site, const LineOfTooth& line, double x, double y,
                            const LinePlace& near) const {
  LinePlace p = near;
  for (int round = 0; round < 12; ++round) {
    const Vec3 off = p.point - site.point;
    const Vec2 miss(x - off.dot(site.across), y - off.dot(site.along));
    if (miss.norm() < 1e-7) return p;
    const auto d = line.moves(p);
    Eigen::Matrix2d J;
    J << d.theta.dot(site.across), d.B.dot(site.across), d.theta.dot(site.along), d.B.dot(site.along);
    const Vec2 step = J.inverse() * miss;
    if (!step.allFinite() || !(p.theta + step.x() > 1e-4)) break;
    p = line.at(p.theta + step.x(), p.B + step.y());
  }
  p.inside = -1;
  return p;
}

std::vector<CellPlace> FaceFlanks::places(const CellSite& site, int columns, int rows) const {
  const LineOfTooth line = line_of(site);
  const double dx = 2 * site.half_x / columns, dy = 2 * site.half_y / rows;
  std::vector<LinePlace> found;
  std::vector<CellPlace> out;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = site.x - site.half_x + (column + 0.5) * dx, y = site.y - site.half_y + (row + 0.5) * dy;
      const LinePlace* near = &middles_[site.id];
      if (column > 0 && found.back().inside > -0.5) near = &found.back();
      else if (row > 0 && found[found.size() - static_cast<std::size_t>(columns)].inside > -0.5)
        near = &found[found.size() - static_cast<std::size_t>(columns)];
      LinePlace p = place(site, line, x, y, *near);
      if (!(p.inside >= 0)) p.inside = std::min(p.inside, -1e-9);
      out.push_back({segment(site, line, p), p.inside >= 0, 1});
      found.push_back(std::move(p));
    }
  return out;
}

}  // namespace toothpath::loaded
