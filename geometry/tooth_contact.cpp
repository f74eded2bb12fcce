#include "geometry/tooth_contact.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/face_gear_inverse.h"

namespace toothpath {
namespace {

constexpr double kNever = -1e300;

/// Sine and cosine once for many places.
struct Turn {
  double c, s;
  explicit Turn(double angle) : c(std::cos(angle)), s(std::sin(angle)) {}
  Vec3 operator()(const Vec3& v) const { return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()}; }
};

/// The pinion's turn, times the side, that a place of the gear asks for; never where the pinion has no involute.
double asked_turn(const Pinion<double>& pinion, int side, const Vec3& point) {
  const auto place = pinion.place(point);
  if (!(place.radius >= pinion.r_b) || !(place.radius <= pinion.r_a)) return kNever;
  return side * pinion.turn_at(side, place);
}

template <typename F>
double golden_place(F&& f, double lo, double hi) {
  constexpr double kRatio = 0.6180339887498949;
  double a = lo, b = hi, c = b - kRatio * (b - a), d = a + kRatio * (b - a), fc = f(c), fd = f(d);
  for (int k = 0; k < 40; ++k) {
    if (fc > fd) {
      b = d, d = c, fd = fc;
      c = b - kRatio * (b - a), fc = f(c);
    } else {
      a = c, c = d, fc = fd;
      d = a + kRatio * (b - a), fd = f(d);
    }
  }
  const double m = (a + b) / 2, fm = f(m), flo = f(lo), fhi = f(hi);
  if (flo > fm && flo >= fhi) return lo;
  return fhi > fm ? hi : m;
}

/// The search for the first touch on one flank at one position of the gear: the highest asked turn over the grid and between its nodes.
class TouchSearch {
 public:
  TouchSearch(const ContactMember& member, double phi_2)
      : flank_(member.flank), pinion_(member.pinion), turn_(phi_2), exact_(member.flank.exact()) {
    nodes_.resize(flank_.points.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      nodes_[k] = asked_turn(pinion_, flank_.side, turn_(flank_.points[k] + flank_.deviation_mm[k] * flank_.normals[k]));
      if (nodes_[k] > kNever) any_ = true;
    }
  }

  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] const std::vector<double>& nodes() const { return nodes_; }

  /// Best place between the nodes.
  [[nodiscard]] std::optional<TouchPlace> best() const {
    if (!any_) return std::nullopt;
    int best_column = -1;
    double best_value = kNever;
    for (int c = 0; c < flank_.columns; ++c) {
      const double value = estimate(c);
      if (value > best_value) best_value = value, best_column = c;
    }
    if (best_column < 0) return std::nullopt;
    const auto along = [&](double column) { return value_at(row_of(column, true), column); };
    // The bracket moves on while the best place lies at its end: neighbouring columns differ by less than their estimates may err.
    double column = best_column;
    for (int k = 0; k < flank_.columns; ++k) {
      const double from = std::max(0.0, std::floor(column) - 1), to = std::min(flank_.columns - 1.0, std::ceil(column) + 1);
      const double next = golden_place(along, from, to);
      const bool at_end = (next == from && from > 0) || (next == to && to < flank_.columns - 1);
      column = next;
      if (!at_end) break;
    }
    TouchPlace place;
    place.column = column;
    place.row = row_of(column, true);
    place.point = point_at(place.row, column);
    place.phi_1 = flank_.side * value_at(place.row, column);
    return place;
  }

 private:
  struct Cell {
    std::size_t k00, k01, k10, k11;
    double u, v;
  };
  [[nodiscard]] Cell cell(double row, double column) const {
    const int r = std::clamp(static_cast<int>(row), 0, flank_.rows - 2), c = std::clamp(static_cast<int>(column), 0, flank_.columns - 2);
    const std::size_t k = flank_.index(r, c), w = static_cast<std::size_t>(flank_.columns);
    return {k, k + 1, k + w, k + w + 1, row - r, column - c};
  }
  template <typename Field>
  static double blend(const Field& f, const Cell& c) {
    return (1 - c.u) * ((1 - c.v) * f[c.k00] + c.v * f[c.k01]) + c.u * ((1 - c.v) * f[c.k10] + c.v * f[c.k11]);
  }
  /// Parameters are blended, so the point lies on the exact flank; its deviation is blended too.
  [[nodiscard]] Vec3 point_at(double row, double column) const {
    const Cell c = cell(row, column);
    const auto p = flank_.surface.flank(flank_.side, blend(flank_.theta, c), blend(flank_.B, c));
    return exact_ ? p.p : Vec3(p.p + blend(flank_.deviation_mm, c) * p.n);
  }
  [[nodiscard]] double value_at(double row, double column) const {
    return row < 0 ? kNever : asked_turn(pinion_, flank_.side, turn_(point_at(row, column)));
  }
  /// Highest asked turn of a node column: the parabola through the best node and its neighbours, or the edge of the pinion's involute.
  [[nodiscard]] double estimate(int c) const {
    const double row = row_of(c, false);
    if (row < 0) return kNever;
    const double value = value_at(row, c);
    const int r = static_cast<int>(row);
    if (row != r || r == 0 || r + 1 >= flank_.rows) return value;
    const double below = nodes_[flank_.index(r - 1, c)], above = nodes_[flank_.index(r + 1, c)];
    if (below == kNever || above == kNever) return value;
    const double bend = 2 * value - below - above;
    return bend > 0 ? value + (above - below) * (above - below) / (8 * bend) : value;
  }
  /// The best row of a column; with `refine` between the nodes. -1: none is within the pinion's involute.
  [[nodiscard]] double row_of(double column, bool refine) const {
    const int c0 = std::clamp(static_cast<int>(column), 0, flank_.columns - 1);
    const bool node_column = column == c0;
    const auto at_node = [&](int r) { return node_column ? nodes_[flank_.index(r, c0)] : value_at(r, column); };
    int best = -1, first = -1, last = -1;
    double value = kNever;
    for (int r = 0; r < flank_.rows; ++r) {
      const double f = at_node(r);
      if (f == kNever) continue;
      if (first < 0) first = r;
      last = r;
      if (f > value) value = f, best = r;
    }
    if (best < 0) return -1;
    // Where the pinion's involute ends between two nodes its edge is a place of its own.
    const double low = first > 0 ? edge(column, first, first - 1) : 0;
    const double high = last + 1 < flank_.rows ? edge(column, last, last + 1) : flank_.rows - 1;
    const double from = std::max(low, double(best - 1)), to = std::min(high, double(best + 1));
    double row = best;
    if (refine) row = golden_place([&](double r) { return value_at(r, column); }, from, to);
    for (const double end : {low, high})
      if (value_at(end, column) > value_at(row, column)) row = end;
    return row;
  }
  /// Row between `inside` and `outside` where the asked turn ceases to exist, on the inside.
  [[nodiscard]] double edge(double column, double inside, double outside) const {
    for (int k = 0; k < 48; ++k) {
      const double middle = (inside + outside) / 2;
      (value_at(middle, column) > kNever ? inside : outside) = middle;
    }
    return inside;
  }

  const ContactFlank& flank_;
  const Pinion<double>& pinion_;
  Turn turn_;
  bool exact_, any_ = false;
  std::vector<double> nodes_;
};

}  // namespace

Status check_pinion(const FaceGearParameters& gear, int pinion_teeth) {
  if (pinion_teeth < 5) return fail("pinion_teeth = {} is below 5", pinion_teeth);
  if (pinion_teeth > gear.shaper_teeth)
    return fail("pinion_teeth = {} exceeds the shaper's {}: such a pinion bears on the ends of the face", pinion_teeth, gear.shaper_teeth);
  return Ok{};
}

bool ContactFlank::exact() const {
  return std::all_of(deviation_mm.begin(), deviation_mm.end(), [](double d) { return d == 0; });
}

Result<ContactFlank> exact_flank(const FaceGear& gear, int zone, int side, int rows, int columns) {
  if (rows < 3 || columns < 3) return fail("a flank needs at least 3 x 3 places, not {} x {}", rows, columns);
  const FaceGearRing& ring = gear.rings().at(static_cast<std::size_t>(zone));
  ContactFlank flank;
  flank.surface = ring.surface;
  flank.zone = zone;
  flank.side = side;
  flank.rows = rows;
  flank.columns = columns;
  const auto size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  flank.theta.resize(size);
  flank.B.resize(size);
  flank.points.resize(size);
  flank.normals.resize(size);
  flank.deviation_mm.assign(size, 0.0);
  std::optional<FlankCoordinates> near;
  for (int c = 0; c < columns; ++c) {
    const double r = ring.zone.inner_radius_mm + (ring.zone.outer_radius_mm - ring.zone.inner_radius_mm) * c / (columns - 1);
    const auto low = fillet_line_height(ring.surface, side, r);
    auto top = low ? invert_flank(ring.surface, side, r, ring.surface.z_tip(r), near) : std::nullopt;
    if (!top) return fail("the flank of side {:+} does not reach from tip to fillet at radius {:.4f} mm", side, r);
    double z_top = ring.surface.z_tip(r);
    if (top->theta < 0) {  // the tip lies inside the base circle: the involute starts lower
      const auto B = flank_B_at_radius(ring.surface, side, 0, r, top->B);
      if (!B) return fail("no start of the involute of side {:+} at radius {:.4f} mm", side, r);
      top->theta = 0;
      top->B = *B;
      z_top = ring.surface.flank_housing(side, 0.0, *B).z();
    }
    near = top;
    for (int k = 0; k < rows; ++k) {
      const int row = rows - 1 - k;
      const double z = z_top + (*low - z_top) * k / (rows - 1);
      const auto at = k == 0 ? top : invert_flank(ring.surface, side, r, z, near);
      if (!at) return fail("no point of the flank of side {:+} at radius {:.4f} mm, height {:.4f} mm", side, r, z);
      if (k > 0) near = at;
      const std::size_t n = flank.index(row, c);
      flank.theta[n] = at->theta;
      flank.B[n] = at->B;
      const auto p = ring.surface.flank(side, at->theta, at->B);
      flank.points[n] = p.p;
      flank.normals[n] = p.n;
    }
    near = top;
  }
  return flank;
}

Result<ContactFlank> measured_flank(const FaceGear& gear, int zone, int side, int rows, int columns, const std::vector<Vec3>& nominal,
                                    const std::vector<double>& deviation_mm) {
  const auto size = static_cast<std::size_t>(std::max(0, rows)) * static_cast<std::size_t>(std::max(0, columns));
  if (rows < 3 || columns < 3) return fail("a flank needs at least 3 x 3 places, not {} x {}", rows, columns);
  if (nominal.size() != size || deviation_mm.size() != size)
    return fail("{} x {} places, but {} points and {} deviations", rows, columns, nominal.size(), deviation_mm.size());
  ContactFlank flank;
  flank.surface = gear.rings().at(static_cast<std::size_t>(zone)).surface;
  flank.zone = zone;
  flank.side = side;
  flank.rows = rows;
  flank.columns = columns;
  flank.theta.resize(size);
  flank.B.resize(size);
  flank.points.resize(size);
  flank.normals.resize(size);
  flank.deviation_mm.resize(size);
  const auto last = static_cast<std::size_t>((rows - 1) * columns);
  const bool flip_rows = nominal[0].z() > nominal[last].z();
  const auto radius = [](const Vec3& p) { return std::hypot(p.x(), p.y()); };
  const bool flip_columns = radius(nominal[0]) > radius(nominal[static_cast<std::size_t>(columns - 1)]);
  std::optional<FlankCoordinates> near;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto from = static_cast<std::size_t>((flip_rows ? rows - 1 - r : r) * columns + (flip_columns ? columns - 1 - c : c));
      const Vec3& p = nominal[from];
      const auto at = invert_flank(flank.surface, side, radius(p), p.z(), near);
      if (!at) return fail("the point at radius {:.4f} mm, height {:.4f} mm is not on the flank of side {:+}", radius(p), p.z(), side);
      near = at;
      const std::size_t n = flank.index(r, c);
      flank.theta[n] = at->theta;
      flank.B[n] = at->B;
      const auto exact = flank.surface.flank(side, at->theta, at->B);
      flank.points[n] = exact.p;
      flank.normals[n] = exact.n;
      flank.deviation_mm[n] = deviation_mm[from];
      if (c == columns - 1) near.reset();
    }
  return flank;
}

std::optional<TouchPlace> touch(const ContactMember& member, double phi_2) { return TouchSearch(member, phi_2).best(); }

std::optional<PathRange> path_on_flanks(const ContactPath<double>& path, const ContactMember& member) {
  const auto& f = member.flank;
  const Pinion<double>& pinion = member.pinion;
  const auto first = static_cast<std::size_t>(f.columns - 1);
  const double r_in = std::hypot(f.points[0].x(), f.points[0].y()), r_out = std::hypot(f.points[first].x(), f.points[first].y());
  const auto inside = [&](double theta_1) {
    const double theta = path.theta(theta_1);
    if (theta < 0 || theta > f.surface.shaper.theta_t) return false;
    const Vec3 p = path.point(theta_1);
    const double r = std::hypot(p.x(), p.y());
    return r >= r_in && r <= r_out && p.z() <= f.surface.z_tip(r) && f.surface.flank_J(f.side, theta, path.B) > 0;
  };
  const int n = 400;
  double from = -1, to = -1;
  for (int k = 0; k <= n; ++k) {
    const double x = pinion.theta_a * k / n;
    if (!inside(x)) {
      if (from >= 0) break;
      continue;
    }
    if (from < 0) from = x;
    to = x;
  }
  if (from < 0) return std::nullopt;
  const auto end = [&](double in, double out) {
    for (int k = 0; k < 60; ++k) {
      const double middle = (in + out) / 2;
      (inside(middle) ? in : out) = middle;
    }
    return in;
  };
  PathRange range;
  range.theta_1_from = from > 0 ? end(from, from - pinion.theta_a / n) : 0;
  range.theta_1_to = to < pinion.theta_a ? end(to, std::min(pinion.theta_a, to + pinion.theta_a / n)) : to;
  range.ratio = (range.theta_1_to - range.theta_1_from) * std::abs(path.per_theta) * pinion.teeth / (2 * kPi);
  return range;
}

namespace {

/// All positions of the gear at which tooth 0 is in reach of the pinion, on one lattice of `steps` a pitch.
struct Lattice {
  double start = 0, step = 0;
  int first = 0, last = -1;
  [[nodiscard]] double phi_2(int k) const { return start + step * k; }
};

struct MemberRoll {
  std::vector<std::optional<TouchPlace>> touches;  ///< by lattice position
  std::vector<std::vector<double>> nodes;
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
    return std::any_of(members.begin(), members.end(), [&](const auto& member) { return TouchSearch(member, lattice.phi_2(k)).any(); });
  };
  const int widest = options.widest_pitches * options.steps, stride = std::max(1, options.steps / 8);
  int low = 0, high = 0;
  while (low > -widest && reached(low - stride)) low -= stride;
  while (high < widest && reached(high + stride)) high += stride;
  lattice.first = low - stride + 1;
  lattice.last = high + stride - 1;
  return lattice;
}

/// Extent and main axis of the marked part. `s_along`: radius; `s_across`: length along the profile from the fillet line.
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

}  // namespace

Result<RollResult> roll(const std::vector<ContactMember>& members, const RollOptions& options) {
  if (members.empty()) return fail("no flank to roll on");
  if (options.steps < 4 || options.steps > 2000) return fail("{} positions a pitch: 4 to 2000 are possible", options.steps);
  const Lattice lattice = lattice_of(members, options);
  const int side = members.front().flank.side, n = options.steps;
  const auto at = [&](int k) { return static_cast<std::size_t>(k - lattice.first); };
  const double pinion_pitch = 2 * kPi / members.front().pinion.teeth, ratio = members.front().pinion.ratio;

  std::vector<MemberRoll> rolls(members.size());
  for (std::size_t m = 0; m < members.size(); ++m)
    for (int k = lattice.first; k <= lattice.last; ++k) {
      const TouchSearch search(members[m], lattice.phi_2(k));
      rolls[m].touches.push_back(search.best());
      rolls[m].nodes.push_back(search.any() ? search.nodes() : std::vector<double>{});
    }

  // One pitch of positions; the pair of tooth j stands where tooth 0 stands j pitches later.
  RollResult result;
  std::vector<double> contact(static_cast<std::size_t>(n), kNever);  // side * phi_1 of the pinion
  const auto pairs = [&](int k, auto&& visit) {
    int j = (lattice.first - k) / n - 1;
    for (; k + j * n <= lattice.last; ++j)
      if (k + j * n >= lattice.first) visit(j, k + j * n);
  };
  for (int k = 0; k < n; ++k) {
    RollPosition position;
    position.phi_2 = lattice.phi_2(k);
    double& best = contact[static_cast<std::size_t>(k)];
    for (std::size_t m = 0; m < members.size(); ++m)
      pairs(k, [&](int j, int position_k) {
        const auto& place = rolls[m].touches[at(position_k)];
        if (!place) return;
        const double value = side * (place->phi_1 - j * pinion_pitch);
        if (value <= best) return;
        best = value;
        position.member = static_cast<int>(m);
        position.tooth = j;
        position.radius_mm = std::hypot(place->point.x(), place->point.y());
        position.height_mm = place->point.z();
      });
    if (best == kNever) return fail("flank {:+}: the pinion of {} teeth does not reach the gear", side, members.front().pinion.teeth);
    position.phi_1 = side * best;
    position.error_rad = position.phi_2 - position.phi_1 * ratio;
    // Which teeth are close: over all members, tooth by tooth.
    pairs(k, [&](int j, int position_k) {
      double gap = 1e300;
      for (std::size_t m = 0; m < members.size(); ++m)
        if (const auto& place = rolls[m].touches[at(position_k)])
          gap = std::min(gap, (best - side * (place->phi_1 - j * pinion_pitch)) * members[m].pinion.r_b * members[m].pinion.cos_bb);
      position.touching += gap <= options.touch_mm;
      position.marking += gap <= options.compound_mm;
    });
    result.cycle.push_back(position);
  }

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
  result.error_range_rad = high - low;
  result.error_mean_rad = sum / n;
  result.contact_ratio = touching / n;
  result.marking_ratio = marking / n;

  // The pattern: least gap of every place while its tooth goes through the mesh.
  for (std::size_t m = 0; m < members.size(); ++m) {
    const ContactFlank& f = members[m].flank;
    const Pinion<double>& pinion = members[m].pinion;
    const double lever = pinion.r_b * pinion.cos_bb;
    FlankPattern pattern;
    pattern.gap_mm.assign(f.points.size(), 1e300);
    std::vector<int> moment(f.points.size(), 0);
    for (int k = lattice.first; k <= lattice.last; ++k) {
      const int base = ((k % n) + n) % n, j = (k - base) / n;
      const double stand = contact[static_cast<std::size_t>(base)] + side * j * pinion_pitch;
      const auto& nodes = rolls[m].nodes[at(k)];
      for (std::size_t p = 0; p < nodes.size(); ++p) {
        if (nodes[p] == kNever) continue;
        const double gap = lever * (stand - nodes[p]);
        if (gap < pattern.gap_mm[p]) pattern.gap_mm[p] = gap, moment[p] = k;
      }
      const auto& place = rolls[m].touches[at(k)];
      if (place && lever * (stand - side * place->phi_1) <= options.touch_mm) {
        RollPosition on_path;
        on_path.phi_2 = lattice.phi_2(k);
        on_path.phi_1 = place->phi_1;
        on_path.error_rad = on_path.phi_2 - on_path.phi_1 * ratio;
        on_path.member = static_cast<int>(m);
        on_path.radius_mm = std::hypot(place->point.x(), place->point.y());
        on_path.height_mm = place->point.z();
        pattern.path.push_back(on_path);
      }
    }
    pattern.pinion_radius_mm.resize(f.points.size());
    pattern.pinion_Z_mm.resize(f.points.size());
    for (std::size_t p = 0; p < f.points.size(); ++p) {
      const auto place = pinion.place(Turn(lattice.phi_2(moment[p]))(f.points[p]));
      pattern.pinion_radius_mm[p] = place.radius;
      pattern.pinion_Z_mm[p] = place.Z;
    }
    describe(f, options.compound_mm, pattern);
    result.patterns.push_back(std::move(pattern));
  }
  return result;
}

}  // namespace toothpath
