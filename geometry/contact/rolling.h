// Flanks rolled with their mates, whatever both are: positions of a mesh cycle, pattern, ease-off. Inside of
// tooth_contact and toothed_pair: written once for their members.
//
// A member has
//   flank                                  rows, columns, side, points, normals, deviation_mm, index, exact, u, v, at,
//                                          and meridian(point): along the teeth and up
//   pitch(), ratio(), teeth_of_mate()      of the gear, rad; turns of the gear a turn of the mate
//   near_turn(k)                           turn of the gear at which place k is in mesh, about
//   inside_by(point)                       housing: how far within the mate's flank a place lies, mm; below 0 outside
//   asked_turn(point, phi_2)               side times the turn of the mate there; kNever outside
//   lever_mm(point, normal)                how far the mate's flank moves square to itself a turn
//   on_mate(point)                         radius about the mate's axis and place along it
//   approach(point, normal, phi_2)         optional ToPinion at the exact ratio
//   kEvenLever                             the lever is the same everywhere
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"
#include "geometry/contact/ease_off.h"
#include "geometry/contact/touch_search.h"

namespace toothpath::contact::rolling {

/// All positions of the gear at which tooth 0 is in reach of the pinion, on one lattice of `steps` a pitch.
struct Lattice {
  double start = 0, step = 0;
  int first = 0, last = -1;
  [[nodiscard]] double phi_2(int k) const { return start + step * k; }
};

/// One member at every lattice position.
struct MemberRoll {
  std::vector<std::optional<TouchPlace>> touches;
  std::vector<std::vector<double>> nodes;  ///< asked turns of the grid's places; empty where none is in reach
};

template <typename Member>
Lattice lattice_of(const std::vector<Member>& members, const RollOptions& options) {
  const Member& m = members.front();
  Lattice lattice;
  lattice.step = m.pitch() / options.steps;
  lattice.start = m.near_turn(m.flank.index(m.flank.rows / 2, m.flank.columns / 2));
  const auto reached = [&](int k) {
    const Turn turn(lattice.phi_2(k));
    return std::any_of(members.begin(), members.end(), [&](const auto& member) {
      const auto& flank = member.flank;
      for (std::size_t n = 0; n < flank.points.size(); ++n)
        if (member.inside_by(turn(flank.points[n] + flank.deviation_mm[n] * flank.normals[n])) >= 0) return true;
      return false;
    });
  };
  const int widest = options.widest_pitches * options.steps, stride = std::max(1, options.steps / 8);
  int low = 0, high = 0;
  while (low > -widest && reached(low - stride)) low -= stride;
  while (high < widest && reached(high + stride)) high += stride;
  lattice.first = low - stride + 1;
  lattice.last = high + stride - 1;
  return lattice;
}

/// Extent and main axis of the marked part: along the teeth, and length along the profile from the tip line.
template <typename Flank>
void describe(const Flank& f, double compound, FlankPattern& pattern) {
  double area = 0, marked = 0, mr = 0, mz = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  pattern.inner_mm = pattern.low_mm = 1e300;
  pattern.outer_mm = pattern.high_mm = -1e300;
  std::vector<double> across(f.points.size());
  for (int c = 0; c < f.columns; ++c) {
    double sum = 0;
    for (int r = f.rows - 1; r >= 0; --r) {  // counted from the tip line, downwards negative
      const auto k = f.index(r, c);
      if (r < f.rows - 1) sum -= (f.points[k] - f.points[f.index(r + 1, c)]).norm();
      across[k] = sum;
    }
  }
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c) {
      const auto k = f.index(r, c);
      const auto left = f.index(r, std::max(0, c - 1)), right = f.index(r, std::min(f.columns - 1, c + 1));
      const auto below = f.index(std::max(0, r - 1), c), above = f.index(std::min(f.rows - 1, r + 1), c);
      const double a = (f.points[right] - f.points[left]).cross(f.points[above] - f.points[below]).norm() / 4;
      area += a;
      if (pattern.gap_mm[k] > compound) continue;
      const Vec2 at = f.meridian(f.points[k]);
      const double x = at.x(), y = across[k];
      marked += a;
      mr += a * x, mz += a * at.y(), mx += a * x, my += a * y;
      xx += a * x * x, yy += a * y * y, xy += a * x * y;
      pattern.inner_mm = std::min(pattern.inner_mm, x);
      pattern.outer_mm = std::max(pattern.outer_mm, x);
      pattern.low_mm = std::min(pattern.low_mm, at.y());
      pattern.high_mm = std::max(pattern.high_mm, at.y());
      pattern.at_inner_end |= c == 0;
      pattern.at_outer_end |= c == f.columns - 1;
      pattern.at_fillet |= r == 0;
      pattern.at_tip |= r == f.rows - 1;
    }
  pattern.marked_share = area > 0 ? marked / area : 0;
  if (!(marked > 0)) {
    pattern.inner_mm = pattern.outer_mm = pattern.low_mm = pattern.high_mm = 0;
    return;
  }
  pattern.centre_radius_mm = mr / marked;
  pattern.centre_height_mm = mz / marked;
  mx /= marked, my /= marked;
  xx = xx / marked - mx * mx, yy = yy / marked - my * my, xy = xy / marked - mx * my;
  pattern.inclination_rad = 0.5 * std::atan2(2 * xy, xx - yy);
  const double mean = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
  pattern.length_mm = 4 * std::sqrt(std::max(0.0, mean + spread));
  pattern.width_mm = 4 * std::sqrt(std::max(0.0, mean - spread));
}

/// What a roll works on; `contact` is what it finds first: side * phi_1 of the pinion at each position of one pitch.
template <typename Member>
struct Roll {
  const std::vector<Member>& members;
  const RollOptions& options;
  Lattice lattice;
  int side = 1, steps = 0;
  double pinion_pitch = 0, ratio = 0;
  std::vector<MemberRoll> rolls;
  std::vector<double> contact;

  [[nodiscard]] std::size_t at(int k) const { return static_cast<std::size_t>(k - lattice.first); }
  /// Gap of a pair that would touch at side * (phi_1 - turned) while the pinion stands at side * phi_1 = `stand`.
  [[nodiscard]] double gap(const TouchPlace& place, double stand, double turned = 0) const {
    return (stand - side * (place.phi_1 - turned)) * place.lever_mm;
  }
  /// The pairs at position k of the pitch: tooth j stands where tooth 0 stands j pitches later.
  template <typename Visit>
  void pairs(int k, Visit visit) const {
    for (int j = (lattice.first - k) / steps - 1; k + j * steps <= lattice.last; ++j)
      if (k + j * steps >= lattice.first) visit(j, k + j * steps);
  }
};

template <typename Member>
void search_touches(Roll<Member>& roll) {
  roll.rolls.resize(roll.members.size());
  WorkShare share(double(roll.members.size()) * (roll.lattice.last - roll.lattice.first + 1));
  for (std::size_t m = 0; m < roll.members.size(); ++m)
    for (int k = roll.lattice.first; k <= roll.lattice.last; ++k) {
      const TouchSearch search(roll.members[m], roll.lattice.phi_2(k));
      roll.rolls[m].touches.push_back(search.best());
      roll.rolls[m].nodes.push_back(search.any() ? search.nodes() : std::vector<double>{});
      share.add();
    }
}

/// Which flank stops the pinion at position k, and how many others are near. False: none is in reach.
template <typename Member>
bool position_of(Roll<Member>& roll, int k, RollPosition& position) {
  double& best = roll.contact[static_cast<std::size_t>(k)];
  position.phi_2 = roll.lattice.phi_2(k);
  for (std::size_t m = 0; m < roll.members.size(); ++m)
    roll.pairs(k, [&](int j, int place_k) {
      const auto& place = roll.rolls[m].touches[roll.at(place_k)];
      if (!place) return;
      const double value = roll.side * (place->phi_1 - j * roll.pinion_pitch);
      if (value <= best) return;
      best = value;
      position.member = static_cast<int>(m);
      position.tooth = j;
      position.stand_at(roll.members[m].flank.meridian(place->point));
    });
  if (best == kNever) return false;
  position.phi_1 = roll.side * best;
  position.error_rad = position.phi_2 - position.phi_1 * roll.ratio;
  roll.pairs(k, [&](int j, int place_k) {
    double gap = 1e300;
    for (std::size_t m = 0; m < roll.members.size(); ++m)
      if (const auto& place = roll.rolls[m].touches[roll.at(place_k)])
        gap = std::min(gap, roll.gap(*place, best, j * roll.pinion_pitch));
    position.touching += gap <= roll.options.touch_mm;
    position.marking += gap <= roll.options.compound_mm;
  });
  return true;
}

/// One pair alone at a lattice position, stopped by the member that does it first; nothing where none is in reach.
template <typename Member>
std::optional<RollPosition> pair_at(const Roll<Member>& roll, int k) {
  if (k < roll.lattice.first || k > roll.lattice.last) return std::nullopt;
  RollPosition position;
  double best = kNever;
  for (std::size_t m = 0; m < roll.rolls.size(); ++m) {
    const auto& place = roll.rolls[m].touches[roll.at(k)];
    if (!place || roll.side * place->phi_1 <= best) continue;
    best = roll.side * place->phi_1;
    position.member = static_cast<int>(m);
    position.stand_at(roll.members[m].flank.meridian(place->point));
  }
  if (best == kNever) return std::nullopt;
  position.phi_1 = roll.side * best;
  position.phi_2 = roll.lattice.phi_2(k);
  position.error_rad = position.phi_2 - position.phi_1 * roll.ratio;
  return position;
}

/// Errors at which one pair takes over from another, between the positions.
template <typename Member>
std::vector<double> handovers(const Roll<Member>& roll, const RollResult& result) {
  std::vector<double> errors;
  for (int n = 0; n < roll.steps; ++n) {
    const auto bearing = [&](int k) { return k + result.cycle[static_cast<std::size_t>(k)].tooth * roll.steps; };
    const int a = bearing(n), b = bearing((n + 1) % roll.steps);
    if (a + 1 == b) continue;
    const auto a_0 = pair_at(roll, a), a_1 = pair_at(roll, a + 1), b_0 = pair_at(roll, b - 1), b_1 = pair_at(roll, b);
    if (!a_0 || !a_1 || !b_0 || !b_1) continue;
    if (const auto error = handover(a_0->error_rad, a_1->error_rad, b_0->error_rad, b_1->error_rad))
      errors.push_back(*error);
  }
  return errors;
}

inline void summarise(RollResult& result, const std::vector<double>& between) {
  double low = 1e300, high = -1e300, sum = 0, touching = 0, marking = 0;
  result.least_touching = result.least_marking = 1 << 20;
  for (const auto& p : result.cycle) {
    low = std::min(low, p.error_rad);
    high = std::max(high, p.error_rad);
    sum += p.error_rad;
    touching += p.touching;
    marking += p.marking;
    result.least_touching = std::min(result.least_touching, p.touching);
    result.most_touching = std::max(result.most_touching, p.touching);
    result.least_marking = std::min(result.least_marking, p.marking);
    result.most_marking = std::max(result.most_marking, p.marking);
  }
  for (const double error : between) {
    low = std::min(low, error);
    high = std::max(high, error);
  }
  const auto n = static_cast<double>(result.cycle.size());
  result.error_range_rad = high - low;
  result.error_mean_rad = sum / n;
  result.contact_ratio = touching / n;
  result.marking_ratio = marking / n;
}

/// Least gap of every place of a flank while its tooth goes through the mesh, and the path on which it touches.
template <typename Member>
FlankPattern pattern_of(const Roll<Member>& roll, std::size_t m) {
  const Member& member = roll.members[m];
  const auto& f = member.flank;
  FlankPattern pattern;
  pattern.gap_mm.assign(f.points.size(), 1e300);
  std::vector<int> moment(f.points.size(), 0);
  for (int k = roll.lattice.first; k <= roll.lattice.last; ++k) {
    const int base = ((k % roll.steps) + roll.steps) % roll.steps, j = (k - base) / roll.steps;
    const double stand = roll.contact[static_cast<std::size_t>(base)] + roll.side * j * roll.pinion_pitch;
    const auto& nodes = roll.rolls[m].nodes[roll.at(k)];
    const Turn turn(roll.lattice.phi_2(k));
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      if (nodes[p] == kNever) continue;
      const double gap = (stand - nodes[p]) * member.lever_mm(turn(f.points[p]), turn(f.normals[p]));
      if (gap < pattern.gap_mm[p]) pattern.gap_mm[p] = gap, moment[p] = k;
    }
    const auto& place = roll.rolls[m].touches[roll.at(k)];
    if (!place || roll.gap(*place, stand) > roll.options.touch_mm) continue;
    RollPosition on_path;
    on_path.phi_2 = roll.lattice.phi_2(k);
    on_path.phi_1 = place->phi_1;
    on_path.error_rad = on_path.phi_2 - on_path.phi_1 * roll.ratio;
    on_path.member = static_cast<int>(m);
    on_path.stand_at(f.meridian(place->point));
    pattern.path.push_back(on_path);
  }
  for (std::size_t p = 0; p < f.points.size(); ++p) {
    const Vec2 place = member.on_mate(Turn(roll.lattice.phi_2(moment[p]))(f.points[p]));
    pattern.pinion_radius_mm.push_back(place.x());
    pattern.pinion_Z_mm.push_back(place.y());
  }
  describe(f, roll.options.compound_mm, pattern);
  return pattern;
}

/// Rolls members of one side through one pitch.
template <typename Member>
Result<RollResult> rolled(const std::vector<Member>& members, const RollOptions& options) {
  if (members.empty()) return fail("no flank to roll on");
  if (options.steps < 4 || options.steps > 2000)
    return fail("{} positions a pitch: 4 to 2000 are possible", options.steps);
  const Member& first = members.front();
  Roll<Member> work{members,
                    options,
                    lattice_of(members, options),
                    first.flank.side,
                    options.steps,
                    2 * kPi / first.teeth_of_mate(),
                    first.ratio(),
                    {},
                    {}};
  work.contact.assign(static_cast<std::size_t>(options.steps), kNever);
  search_touches(work);
  RollResult result;
  for (int k = 0; k < options.steps; ++k) {
    RollPosition position;
    if (!position_of(work, k, position))
      return fail("flank {:+}: the pinion of {} teeth does not reach the gear", work.side, first.teeth_of_mate());
    result.cycle.push_back(position);
  }
  for (int k = work.lattice.first; k <= work.lattice.last; ++k)
    if (const auto position = pair_at(work, k)) result.pair.push_back(*position);
  summarise(result, handovers(work, result));
  for (std::size_t m = 0; m < members.size(); ++m) result.patterns.push_back(pattern_of(work, m));
  return result;
}

/// Ease-off of one member. docs/ease_off.md 1.
template <typename Member>
EaseOffMap map_of(const Member& member) {
  const auto& flank = member.flank;
  const std::size_t size = flank.points.size();
  EaseOffMap map(size);
  if (!Member::kEvenLever) map.lever_mm.assign(size, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < size; ++k) {
    const Vec3 point = flank.points[k] + flank.deviation_mm[k] * flank.normals[k];
    const auto at = [&](double phi_2) {
      const Turn turn(phi_2);
      return member.approach(turn(point), turn(flank.normals[k]), phi_2);
    };
    // How near the mate is, mm: greatest where it is nearest; never where its flank does not come.
    const auto nearness = [&](double phi_2) {
      const auto found = at(phi_2);
      return found ? -found->distance_mm : kNever;
    };
    const auto top = nearest_turn(nearness, member.near_turn(k), member.pitch());
    if (!top) continue;
    const ToPinion nearest = at(top->phi_2).value();
    map.gap_mm[k] = nearest.distance_mm;
    map.phi_2[k] = top->phi_2;
    map.bend_mm[k] = top->bend;
    map.pinion_across_mm[k] = nearest.radius_mm;
    map.pinion_along_mm[k] = nearest.Z_mm;
    if (!Member::kEvenLever) {
      const Turn turn(top->phi_2);
      map.lever_mm[k] = member.lever_mm(turn(point), turn(flank.normals[k]));
    }
  }
  return map;
}
template <typename Member>
Result<EaseOff> ease_off_of(const std::vector<Member>& members) {
  std::vector<EaseOffMap> maps;
  for (const auto& member : members) maps.push_back(map_of(member));
  return brought_to_touch(std::move(maps));
}

}  // namespace toothpath::contact::rolling
