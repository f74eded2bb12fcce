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
    case Edge::pinion_root: return "end of the pinion's flank";
  }
  return "";
}

BeyondMargins beyond_own_margins(int rows, int columns, int row, int column, double margin) {
  BeyondMargins out;
  out.fill(1);
  const auto set = [&](Edge edge, double from_edge) { out[static_cast<std::size_t>(edge)] = from_edge - margin; };
  set(Edge::inner_end, double(column) / (columns - 1));
  set(Edge::outer_end, double(columns - 1 - column) / (columns - 1));
  set(Edge::fillet_line, double(row) / (rows - 1));
  set(Edge::tip, double(rows - 1 - row) / (rows - 1));
  return out;
}

std::vector<MarginBound> margin_bounds(int across, int along, const std::vector<BeyondMargins>& places) {
  std::vector<MarginBound> out;
  const auto between = [&](std::size_t a, std::size_t b) {
    for (std::size_t e = 0; e < kEdges; ++e) {
      const double here = places[a][e], there = places[b][e];
      if ((here <= 0) == (there <= 0)) continue;
      const bool a_within = here <= 0;
      const double in = a_within ? here : there, out_by = a_within ? there : here;
      out.push_back({a_within ? a : b, a_within ? b : a, -in / (out_by - in), Edge(e)});
    }
  };
  for (int line = 0; line < along; ++line)
    for (int n = 0; n < across; ++n) {
      const auto k = static_cast<std::size_t>(line) * static_cast<std::size_t>(across) + static_cast<std::size_t>(n);
      if (n + 1 < across) between(k, k + 1);
      if (line + 1 < along) between(k, k + static_cast<std::size_t>(across));
    }
  return out;
}

bool beside_the_end(const EaseOffMap& map, int rows, int columns, int row, int column) {
  for (const auto& [r, c] : {std::pair(row - 1, column), {row + 1, column}, {row, column - 1}, {row, column + 1}})
    if (r >= 0 && r < rows && c >= 0 && c < columns &&
        std::isnan(
            map.gap_mm[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)]))
      return true;
  return false;
}

BeyondMargins beyond_margins(const ContactMember& member, const EaseOffMap& map, int row, int column, double margin,
                             double pinion_radius_mm) {
  const ContactFlank& f = member.flank;
  const Pinion<double>& pinion = member.pinion;
  const double middle = (pinion.r_b + pinion.r_a) / 2, depth = 2 * (pinion.r_a - pinion.r_p);
  BeyondMargins out = beyond_own_margins(f.rows, f.columns, row, column, margin);
  const auto of = [&](Edge edge) -> double& { return out[static_cast<std::size_t>(edge)]; };
  const auto end_near = [&](double radius) -> double& {
    return of(radius > middle ? Edge::pinion_tip : Edge::pinion_root);
  };
  const double radius = map.pinion_across_mm[f.index(row, column)];
  if (std::isnan(radius)) {
    end_near(pinion_radius_mm) = 0;
    return out;
  }
  of(Edge::pinion_tip) = (pinion.r_a - radius) / depth - margin;
  of(Edge::pinion_root) = (radius - pinion.r_b) / depth - margin;
  if (beside_the_end(map, f.rows, f.columns, row, column)) end_near(radius) = std::min(end_near(radius), 0.0);
  return out;
}

PatternPlace pattern_place(const ContactMember& member, const EaseOffMap& map, const FlankPattern& pattern,
                           double compound_mm, double margin) {
  const ContactFlank& f = member.flank;
  RolledGrid rolled{f.rows, f.columns, f.points, pattern.gap_mm, {}};
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c)
      rolled.margins.push_back(beyond_margins(member, map, r, c, margin, pattern.pinion_radius_mm[f.index(r, c)]));
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
      for (std::size_t e = 0; e < kEdges; ++e)
        if (f.margins[index(r, c)][e] <= 0) place.gap_mm[e] = std::min(place.gap_mm[e], gap);
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
  for (const MarginBound& bound : margin_bounds(f.columns, f.rows, f.margins)) {
    const double in = f.gap_mm[bound.within], beyond = f.gap_mm[bound.beyond];
    if (in > 1e100 || beyond > 1e100) continue;
    double& least = place.gap_mm[static_cast<std::size_t>(bound.edge)];
    least = std::min(least, in + bound.share * (beyond - in));
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
