#include "geometry/contact/pattern_place.h"

#include <algorithm>
#include <cmath>

namespace toothpath::contact {
namespace {

constexpr double kUnmet = 1e300;

unsigned bit(Edge edge) { return 1u << static_cast<unsigned>(edge); }

/// Along a line of the grid where the gap crosses the compound, beside the marked place `in`; in places.
double crossing(double in, double gap_in, double out, double gap_out, double compound) {
  if (gap_out >= 1e100 || gap_out <= gap_in) return in;
  return in + (out - in) * std::clamp((compound - gap_in) / (gap_out - gap_in), 0.0, 1.0);
}

}  // namespace

const char* to_string(Edge edge) {
  switch (edge) {
    case Edge::inner_end: return "inner end";
    case Edge::outer_end: return "outer end";
    case Edge::tip: return "tip";
    case Edge::fillet_line: return "fillet line";
    case Edge::pinion_tip: return "pinion tip";
    case Edge::pinion_root: return "end of the pinion's involute";
  }
  return "";
}

unsigned edges_at(const ContactMember& member, const EaseOffMap& map, int row, int column, double margin,
                  double pinion_radius_mm) {
  const ContactFlank& f = member.flank;
  const Pinion<double>& pinion = member.pinion;
  const double u = double(row) / (f.rows - 1), v = double(column) / (f.columns - 1),
               middle = (pinion.r_b + pinion.r_a) / 2;
  unsigned edges = 0;
  if (column == 0 || v < margin) edges |= bit(Edge::inner_end);
  if (column == f.columns - 1 || v > 1 - margin) edges |= bit(Edge::outer_end);
  if (row == 0 || u < margin) edges |= bit(Edge::fillet_line);
  if (row == f.rows - 1 || u > 1 - margin) edges |= bit(Edge::tip);
  const auto end_near = [&](double radius) { return bit(radius > middle ? Edge::pinion_tip : Edge::pinion_root); };
  const double radius = map.pinion_radius_mm[f.index(row, column)];
  if (std::isnan(radius)) return edges | end_near(pinion_radius_mm);
  if (pinion.r_a - radius < margin * 2 * (pinion.r_a - pinion.r_p)) edges |= bit(Edge::pinion_tip);
  for (const auto& [r, c] : {std::pair(row - 1, column), {row + 1, column}, {row, column - 1}, {row, column + 1}})
    if (r >= 0 && r < f.rows && c >= 0 && c < f.columns && std::isnan(map.pinion_radius_mm[f.index(r, c)]))
      edges |= end_near(radius);
  return edges;
}

PatternPlace pattern_place(const ContactMember& member, const EaseOffMap& map, const FlankPattern& pattern,
                           double compound_mm, double margin) {
  const ContactFlank& f = member.flank;
  PatternPlace place;
  place.gap_mm.fill(kUnmet);
  place.low = place.inner = kUnmet;
  place.high = place.outer = -kUnmet;
  double marked = 0;
  const auto gap_at = [&](int r, int c) { return pattern.gap_mm[f.index(r, c)]; };
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c) {
      const auto k = f.index(r, c);
      const double gap = gap_at(r, c);
      if (gap > 1e100) continue;
      const unsigned edges = edges_at(member, map, r, c, margin, pattern.pinion_radius_mm[k]);
      for (int e = 0; e < kEdges; ++e)
        if ((edges >> e & 1u) != 0) {
          double& least = place.gap_mm[static_cast<std::size_t>(e)];
          least = std::min(least, gap);
        }
      if (gap > compound_mm) continue;
      const int low = std::max(0, r - 1), high = std::min(f.rows - 1, r + 1), in = std::max(0, c - 1),
                out = std::min(f.columns - 1, c + 1);
      const double area = (f.points[f.index(r, out)] - f.points[f.index(r, in)])
                              .cross(f.points[f.index(high, c)] - f.points[f.index(low, c)])
                              .norm() /
                          ((high - low) * (out - in));
      marked += area;
      place.profile += area * r;
      place.lead += area * c;
      place.low = std::min(place.low, crossing(r, gap, low, gap_at(low, c), compound_mm));
      place.high = std::max(place.high, crossing(r, gap, high, gap_at(high, c), compound_mm));
      place.inner = std::min(place.inner, crossing(c, gap, in, gap_at(r, in), compound_mm));
      place.outer = std::max(place.outer, crossing(c, gap, out, gap_at(r, out), compound_mm));
    }
  place.any = marked > 0;
  if (!place.any) {
    place.low = place.high = place.inner = place.outer = 0;
    return place;
  }
  for (double* value : {&place.profile, &place.low, &place.high}) *value /= f.rows - 1;
  for (double* value : {&place.lead, &place.inner, &place.outer}) *value /= f.columns - 1;
  place.profile /= marked;
  place.lead /= marked;
  return place;
}

Result<MisalignedContact> misaligned_contact(const PairSide& pair, const Misalignment& moved,
                                             const RollOptions& options, double margin) {
  std::vector<ContactMember> members;
  for (const auto& flank : pair.flanks)
    members.push_back(make_member(*pair.gear, flank, pair.pinion_teeth, moved, pair.on_pinion));
  const auto rolled = roll(members, options);
  if (!rolled) return rolled.error();
  const auto map = ease_off(members);
  if (!map) return map.error();
  MisalignedContact found;
  found.moved = moved;
  found.error_mean_rad = rolled->error_mean_rad;
  found.error_range_rad = rolled->error_range_rad;
  found.margin_gap_mm = kUnmet;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto place_with = [&](double width) {
      return pattern_place(members[m], map->maps[m], rolled->patterns[m], options.compound_mm, width);
    };
    found.at_edges.push_back(place_with(0));
    found.in_margin.push_back(place_with(margin));
    for (int e = 0; e < kEdges; ++e)
      if (const double gap = found.in_margin.back().gap_mm[static_cast<std::size_t>(e)]; gap < found.margin_gap_mm) {
        found.margin_gap_mm = gap;
        found.nearest = Edge(e);
        found.nearest_zone = members[m].flank.zone;
      }
  }
  return found;
}

}  // namespace toothpath::contact
