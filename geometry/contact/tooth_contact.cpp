#include "geometry/contact/tooth_contact.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"
#include "geometry/contact/touch_search.h"

namespace toothpath::contact {

std::optional<TouchPlace> touch(const ContactMember& member, double phi_2) { return TouchSearch(member, phi_2).best(); }

namespace {

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

double median_of(const ContactFlank& f, const std::vector<double>& values) {
  return values[f.index(f.rows / 2, f.columns / 2)];
}

Lattice lattice_of(const std::vector<ContactMember>& members, const RollOptions& options) {
  const ContactMember& m = members.front();
  const auto& f = m.flank;
  Lattice lattice;
  lattice.step = f.surface.pitch / options.steps;
  lattice.start = f.surface.i * f.surface.flank_phi(f.side, median_of(f, f.theta), median_of(f, f.B));
  const auto reached = [&](int k) {
    const Turn turn(lattice.phi_2(k));
    return std::any_of(members.begin(), members.end(), [&](const auto& member) {
      const ContactFlank& flank = member.flank;
      for (std::size_t n = 0; n < flank.points.size(); ++n)
        if (on_involute(member.pinion, turn(flank.points[n] + flank.deviation_mm[n] * flank.normals[n]))) return true;
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

/// Extent and main axis of the marked part. `s_along`: radius; `s_across`: length along the profile from the fillet
/// line.
void describe(const ContactFlank& f, double compound, FlankPattern& pattern) {
  double area = 0, marked = 0, mr = 0, mz = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  pattern.inner_mm = pattern.low_mm = 1e300;
  pattern.outer_mm = pattern.high_mm = -1e300;
  const auto radius = [&](std::size_t k) { return std::hypot(f.points[k].x(), f.points[k].y()); };
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
      const double x = radius(k), y = across[k];
      marked += a;
      mr += a * x, mz += a * f.points[k].z(), mx += a * x, my += a * y;
      xx += a * x * x, yy += a * y * y, xy += a * x * y;
      pattern.inner_mm = std::min(pattern.inner_mm, x);
      pattern.outer_mm = std::max(pattern.outer_mm, x);
      pattern.low_mm = std::min(pattern.low_mm, f.points[k].z());
      pattern.high_mm = std::max(pattern.high_mm, f.points[k].z());
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
struct Roll {
  const std::vector<ContactMember>& members;
  const RollOptions& options;
  Lattice lattice;
  int side = 1, steps = 0;
  double pinion_pitch = 0, ratio = 0;
  std::vector<MemberRoll> rolls;
  std::vector<double> contact;

  [[nodiscard]] std::size_t at(int k) const { return static_cast<std::size_t>(k - lattice.first); }
  /// Gap of a pair whose flanks would touch at side * phi_1 = `asked` while the pinion stands at `stand`.
  [[nodiscard]] double gap(std::size_t member, double stand, double asked) const {
    return (stand - asked) * members[member].pinion.r_b * members[member].pinion.cos_bb;
  }
  /// The pairs at position k of the pitch: tooth j stands where tooth 0 stands j pitches later.
  template <typename Visit>
  void pairs(int k, Visit visit) const {
    for (int j = (lattice.first - k) / steps - 1; k + j * steps <= lattice.last; ++j)
      if (k + j * steps >= lattice.first) visit(j, k + j * steps);
  }
};

void search_touches(Roll& roll) {
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
bool position_of(Roll& roll, int k, RollPosition& position) {
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
      position.radius_mm = std::hypot(place->point.x(), place->point.y());
      position.height_mm = place->point.z();
    });
  if (best == kNever) return false;
  position.phi_1 = roll.side * best;
  position.error_rad = position.phi_2 - position.phi_1 * roll.ratio;
  roll.pairs(k, [&](int j, int place_k) {
    double gap = 1e300;
    for (std::size_t m = 0; m < roll.members.size(); ++m)
      if (const auto& place = roll.rolls[m].touches[roll.at(place_k)])
        gap = std::min(gap, roll.gap(m, best, roll.side * (place->phi_1 - j * roll.pinion_pitch)));
    position.touching += gap <= roll.options.touch_mm;
    position.marking += gap <= roll.options.compound_mm;
  });
  return true;
}

/// One pair alone at a lattice position, stopped by the member that does it first; nothing where none is in reach.
std::optional<RollPosition> pair_at(const Roll& roll, int k) {
  if (k < roll.lattice.first || k > roll.lattice.last) return std::nullopt;
  RollPosition position;
  double best = kNever;
  for (std::size_t m = 0; m < roll.rolls.size(); ++m) {
    const auto& place = roll.rolls[m].touches[roll.at(k)];
    if (!place || roll.side * place->phi_1 <= best) continue;
    best = roll.side * place->phi_1;
    position.member = static_cast<int>(m);
    position.radius_mm = std::hypot(place->point.x(), place->point.y());
    position.height_mm = place->point.z();
  }
  if (best == kNever) return std::nullopt;
  position.phi_1 = roll.side * best;
  position.phi_2 = roll.lattice.phi_2(k);
  position.error_rad = position.phi_2 - position.phi_1 * roll.ratio;
  return position;
}

/// Errors at which one pair takes over from another, between the positions.
std::vector<double> handovers(const Roll& roll, const RollResult& result) {
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

void summarise(RollResult& result, const std::vector<double>& between) {
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
FlankPattern pattern_of(const Roll& roll, std::size_t m) {
  const ContactFlank& f = roll.members[m].flank;
  const Pinion<double>& pinion = roll.members[m].pinion;
  FlankPattern pattern;
  pattern.gap_mm.assign(f.points.size(), 1e300);
  std::vector<int> moment(f.points.size(), 0);
  for (int k = roll.lattice.first; k <= roll.lattice.last; ++k) {
    const int base = ((k % roll.steps) + roll.steps) % roll.steps, j = (k - base) / roll.steps;
    const double stand = roll.contact[static_cast<std::size_t>(base)] + roll.side * j * roll.pinion_pitch;
    const auto& nodes = roll.rolls[m].nodes[roll.at(k)];
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      if (nodes[p] == kNever) continue;
      const double gap = roll.gap(m, stand, nodes[p]);
      if (gap < pattern.gap_mm[p]) pattern.gap_mm[p] = gap, moment[p] = k;
    }
    const auto& place = roll.rolls[m].touches[roll.at(k)];
    if (!place || roll.gap(m, stand, roll.side * place->phi_1) > roll.options.touch_mm) continue;
    RollPosition on_path;
    on_path.phi_2 = roll.lattice.phi_2(k);
    on_path.phi_1 = place->phi_1;
    on_path.error_rad = on_path.phi_2 - on_path.phi_1 * roll.ratio;
    on_path.member = static_cast<int>(m);
    on_path.radius_mm = std::hypot(place->point.x(), place->point.y());
    on_path.height_mm = place->point.z();
    pattern.path.push_back(on_path);
  }
  for (std::size_t p = 0; p < f.points.size(); ++p) {
    const auto place = pinion.place(Turn(roll.lattice.phi_2(moment[p]))(f.points[p]));
    pattern.pinion_radius_mm.push_back(place.radius);
    pattern.pinion_Z_mm.push_back(place.Z);
  }
  describe(f, roll.options.compound_mm, pattern);
  return pattern;
}

}  // namespace

Result<RollResult> roll(const std::vector<ContactMember>& members, const RollOptions& options) {
  if (members.empty()) return fail("no flank to roll on");
  if (options.steps < 4 || options.steps > 2000)
    return fail("{} positions a pitch: 4 to 2000 are possible", options.steps);
  const Pinion<double>& pinion = members.front().pinion;
  Roll work{members,
            options,
            lattice_of(members, options),
            members.front().flank.side,
            options.steps,
            2 * kPi / pinion.teeth,
            pinion.ratio,
            {},
            {}};
  work.contact.assign(static_cast<std::size_t>(options.steps), kNever);
  search_touches(work);
  RollResult result;
  for (int k = 0; k < options.steps; ++k) {
    RollPosition position;
    if (!position_of(work, k, position))
      return fail("flank {:+}: the pinion of {} teeth does not reach the gear", work.side, pinion.teeth);
    result.cycle.push_back(position);
  }
  for (int k = work.lattice.first; k <= work.lattice.last; ++k)
    if (const auto position = pair_at(work, k)) result.pair.push_back(*position);
  summarise(result, handovers(work, result));
  for (std::size_t m = 0; m < members.size(); ++m) result.patterns.push_back(pattern_of(work, m));
  return result;
}

}  // namespace toothpath::contact
