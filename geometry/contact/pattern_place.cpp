#include "geometry/contact/pattern_place.h"

#include <algorithm>
#include <cmath>

namespace toothpath::contact {
namespace {

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

Edges own_edges(int rows, int columns, int row, int column, double margin) {
  const double u = double(row) / (rows - 1), v = double(column) / (columns - 1);
  unsigned edges = 0;
  if (column == 0 || v < margin) edges |= bit(Edge::inner_end);
  if (column == columns - 1 || v > 1 - margin) edges |= bit(Edge::outer_end);
  if (row == 0 || u < margin) edges |= bit(Edge::fillet_line);
  if (row == rows - 1 || u > 1 - margin) edges |= bit(Edge::tip);
  return static_cast<Edges>(edges);
}

bool beside_the_end(const EaseOffMap& map, int rows, int columns, int row, int column) {
  for (const auto& [r, c] : {std::pair(row - 1, column), {row + 1, column}, {row, column - 1}, {row, column + 1}})
    if (r >= 0 && r < rows && c >= 0 && c < columns &&
        std::isnan(
            map.gap_mm[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)]))
      return true;
  return false;
}

Edges edges_at(const ContactMember& member, const EaseOffMap& map, int row, int column, double margin,
               double pinion_radius_mm) {
  const ContactFlank& f = member.flank;
  const Pinion<double>& pinion = member.pinion;
  const double middle = (pinion.r_b + pinion.r_a) / 2;
  unsigned edges = own_edges(f.rows, f.columns, row, column, margin);
  const auto end_near = [&](double radius) { return bit(radius > middle ? Edge::pinion_tip : Edge::pinion_root); };
  const double radius = map.pinion_across_mm[f.index(row, column)];
  if (std::isnan(radius)) return static_cast<Edges>(edges | end_near(pinion_radius_mm));
  if (pinion.r_a - radius < margin * 2 * (pinion.r_a - pinion.r_p)) edges |= bit(Edge::pinion_tip);
  if (beside_the_end(map, f.rows, f.columns, row, column)) edges |= end_near(radius);
  return static_cast<Edges>(edges);
}

PatternPlace pattern_place(const ContactMember& member, const EaseOffMap& map, const FlankPattern& pattern,
                           double compound_mm, double margin) {
  const ContactFlank& f = member.flank;
  RolledGrid rolled{f.rows, f.columns, f.points, pattern.gap_mm, {}};
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c)
      rolled.edges.push_back(edges_at(member, map, r, c, margin, pattern.pinion_radius_mm[f.index(r, c)]));
  return pattern_place(rolled, compound_mm);
}

PatternPlace pattern_place(const RolledGrid& f, double compound_mm) {
  PatternPlace place;
  place.gap_mm.fill(kUnmet);
  place.low = place.inner = kUnmet;
  place.high = place.outer = -kUnmet;
  double marked = 0;
  const auto index = [&](int r, int c) {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(f.columns) + static_cast<std::size_t>(c);
  };
  const auto gap_at = [&](int r, int c) { return f.gap_mm[index(r, c)]; };
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c) {
      const double gap = gap_at(r, c);
      if (gap > 1e100) continue;
      for (int e = 0; e < kEdges; ++e)
        if ((f.edges[index(r, c)] >> e & 1u) != 0) {
          double& least = place.gap_mm[static_cast<std::size_t>(e)];
          least = std::min(least, gap);
        }
      if (gap > compound_mm) continue;
      const int low = std::max(0, r - 1), high = std::min(f.rows - 1, r + 1), in = std::max(0, c - 1),
                out = std::min(f.columns - 1, c + 1);
      const double area = (f.points[index(r, out)] - f.points[index(r, in)])
                              .cross(f.points[index(high, c)] - f.points[index(low, c)])
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

MisalignedContact MisalignedContact::at(const Misalignment& moved) {
  MisalignedContact contact;
  contact.moved = moved;
  contact.margin_gap_mm = kUnmet;
  return contact;
}

void MisalignedContact::add_ring(int zone, PatternPlace edges, PatternPlace margin) {
  at_edges.push_back(edges);
  in_margin.push_back(margin);
  for (int e = 0; e < kEdges; ++e)
    if (const double gap = margin.gap_mm[static_cast<std::size_t>(e)]; gap < margin_gap_mm) {
      margin_gap_mm = gap;
      nearest = Edge(e);
      nearest_zone = zone;
    }
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
  MisalignedContact found = MisalignedContact::at(moved);
  found.error_mean_rad = rolled->error_mean_rad;
  found.error_range_rad = rolled->error_range_rad;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto place_with = [&](double width) {
      return pattern_place(members[m], map->maps[m], rolled->patterns[m], options.compound_mm, width);
    };
    found.add_ring(members[m].flank.zone, place_with(0), place_with(margin));
  }
  return found;
}

}  // namespace toothpath::contact
