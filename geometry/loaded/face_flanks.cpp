#include "geometry/loaded/face_flanks.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/loaded/cell_contact.h"
#include "geometry/loaded/half_space.h"

namespace toothpath::loaded {
namespace {

constexpr double kCorner = 1.5;    // half widths of a line's strip: the first rectangle of a corner
constexpr double kEllipses = 1.3;  // the first rectangle is so much wider than the ellipse of Hertz

}  // namespace

FaceFlanks::FaceFlanks(const LoadedPair& pair, double force, double phi, double approach_mm) : pair_(pair), phi_(phi) {
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
  std::vector<std::vector<ContactLine>> lines(pair.rings.size());
  double least = kNoMaterial;
  const auto options_of = [&](const PairRing& ring) {
    LineOptions options;
    options.segment_mm = pair.options.segment_mm;
    options.pinion = &ring.moved;
    options.removal = &ring.removal;
    return options;
  };
  for (std::size_t r = 0; r < pair.rings.size(); ++r) {
    const PairRing& ring = pair.rings[r];
    lines[r] = contact_lines(ring.surface, ring.ring, pair.side, phi, ring.bounds, options_of(ring));
    for (const ContactLine& line : lines[r]) {
      line_mm_ += line.length;
      add(r, line, force);
      least = std::min(least, line.least_gap);
    }
  }
  for (std::size_t r = 0; r < pair.rings.size(); ++r) {
    const PairRing& ring = pair.rings[r];
    LineOptions options = options_of(ring);
    options.edges = {least + approach_mm, &ring.moved, &pair.options.gap};
    for (const auto& edge : edges_near(ring.surface, ring.ring, pair.side, phi, ring.bounds, options, lines[r]))
      add_edge(r, edge, force);
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
  const auto sides =
      ellipse_sides(force, pair_.modulus, middle.curvature, middle.curvature * std::max(middle.roundness, 0.0));
  CellSite& added = add_site(site, std::move(middle));
  added.half_x = kEllipses * sides[0], added.half_y = kEllipses * std::min(sides[1], line.length);
}

CellSite& FaceFlanks::add_site(CellSite site, LinePlace middle) {
  site.point = middle.point, site.normal = middle.normal, site.curvature = middle.curvature;
  site.across = middle.steepest;
  site.along = middle.normal.cross(site.across).normalized();
  middles_.push_back(std::move(middle));
  return sites_.emplace_back(site);
}

void FaceFlanks::add_edge(std::size_t ring, const ContactLine& edge, double force) {
  CellSite site;
  site.ring = ring, site.tooth = edge.tooth, site.id = sites_.size();
  const LineOfTooth places = line_of(site);
  double theta = edge.segments.front().theta;
  const auto found = places.nearest(edge.from_B, theta);
  if (!found) return;
  LinePlace middle = *found;
  places.bend(middle);
  const ContactBounds& bounds = pair_.rings[ring].bounds;
  const double wide =
      hertz_line(force / (bounds.outer_mm - bounds.inner_mm), pair_.modulus, middle.curvature).half_width;
  site.first = Vec2::Zero(), site.first_gap = segment(site, places, middle).gap;
  CellSite& added = add_site(site, std::move(middle));
  // A corner presses about as wide as a line would, and a little longer; the windows are fitted.
  added.half_x = kCorner * wide, added.half_y = 2 * kCorner * wide;
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
