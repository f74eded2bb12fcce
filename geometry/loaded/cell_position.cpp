#include "geometry/loaded/cell_position.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "geometry/base/angle.h"
#include "geometry/loaded/carriers.h"
#include "geometry/loaded/cell_contact.h"
#include "geometry/loaded/cell_images.h"
#include "geometry/loaded/half_space.h"

namespace toothpath::loaded {
namespace {

constexpr int kColumns = 48, kRows = 64;
constexpr int kCoarse = 2;            // cells of a side that are one while windows are fitted
constexpr double kIdle = 1.2;         // approaches: flanks farther apart do not touch when others do
constexpr double kMargin = 1.3;       // windows reach so far beyond what presses
constexpr double kLoose = 2.2;        // a window so much wider than what presses is drawn together
constexpr double kSmallest = 1e-4;    // mm: windows are not drawn together around less, as at a corner of stiff teeth
constexpr int kMostFits = 24;         // rounds of fitting the windows
constexpr int kCloser = 8;            // a window is drawn together by so much at once
constexpr double kTouchKnown = 1e-8;  // mm: first touch of rigid flanks is known so far

/// The window of one tooth.
struct ToothWindow {
  CellSite site;
  CellWindow cells;
  std::vector<CellPlace> places;  ///< of the cells
  double axial = 0;               ///< by how much it nears when the pinion moves by 1 along its axis
  std::vector<double> axials;     ///< of every cell; empty: `axial`
  [[nodiscard]] double axial_of(std::size_t cell) const { return axials.empty() ? axial : axials[cell]; }
  /// Sum of the forces of all cells times their axial share. @param force  sum of the forces
  [[nodiscard]] double axial_sum(const double* pressure, double force) const {
    if (axials.empty()) return axial * force;
    double sum = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) sum += axials[k] * pressure[k] * cells.dx * cells.dy;
    return sum;
  }
};

class Cells {
 public:
  Cells(const CellFlanks& flanks, const Load& load, double phi)
      : flanks_(flanks), bodies_(flanks.bodies()), load_(load), phi_(phi) {
    for (const CellSite& site : flanks.sites())
      windows_.push_back({site, {}, {}, -site.normal.dot(bodies_.pinion_axis), {}});
  }
  [[nodiscard]] bool empty() const { return windows_.empty(); }

  /// Shares the load, fitting the windows to what presses, on coarse cells first. Teeth that stand off while others
  /// carry are left out of the fine ones, and come back where they turn out to be inside the approach.
  Result<CellPressures> share() {
    if (const auto fits = fit(kCoarse); !fits) return fits.error();
    drop_idle();
    do
      if (const auto fits = fit(1); !fits) return fits.error();
    while (bring_back());
    return last_;
  }
  [[nodiscard]] double force() const { return load_.torque_nmm / bodies_.lever; }
  [[nodiscard]] double shift() const { return shift_; }
  [[nodiscard]] const std::vector<ToothWindow>& windows() const { return windows_; }
  [[nodiscard]] int ring_of(const ToothWindow& w) const { return bodies_.rings[w.site.ring].ring; }

  /// Under another force or shift, from the pressures of `share`.
  Result<CellPressures> nearby(double force, double shift) { return at_shift(force, shift_ + shift, last_.pressure); }
  Result<CellPressures> balanced(double force) { return motions(force); }
  /// Normal force of every window.
  [[nodiscard]] std::vector<double> forces(const std::vector<double>& pressure) const {
    std::vector<double> sums;
    std::size_t at = 0;
    for (const ToothWindow& w : windows_) {
      double sum = 0;
      for (std::size_t k = 0; k < w.cells.size(); ++k) sum += pressure[at + k] * w.cells.dx * w.cells.dy;
      sums.push_back(sum);
      at += w.cells.size();
    }
    return sums;
  }

 private:
  /// @param side  cells of a side that are one
  Status fit(int side) {
    for (ToothWindow& w : windows_) fill(w, kColumns / side, kRows / side);
    for (int round = 0; round < kMostFits; ++round) {
      last_.pressure.clear();
      make_problem();
      auto found = motions(force());
      if (!found) return found.error();
      last_ = *found;
      if (const auto known = above_first_touch(); !known) return known.error();
      const auto changed = refit(*found, side == 1);
      if (!changed) return changed.error();
      if (!*changed) return Ok{};
    }
    return fail("{}", outgrown());
  }

  void fill(ToothWindow& w, int columns, int rows) const {
    CellWindow& c = w.cells;
    c = {columns, rows, 2 * w.site.half_x / columns, 2 * w.site.half_y / rows, {}, {}, {}, {}};
    w.places = flanks_.places(w.site, columns, rows);
    w.axials.clear();
    for (const CellPlace& p : w.places) {
      c.gap.push_back(p.material ? p.at.gap : kNoMaterial);
      if (bodies_.even) continue;
      c.lever.push_back(p.lever);
      w.axials.push_back(-p.at.normal.dot(bodies_.pinion_axis));
    }
    add_images(bodies_, w.site, w.places, c);
  }

  void make_problem() {
    problem_ = {};
    problem_.compliance = half_space_compliance(bodies_.gear.E, bodies_.gear.nu) +
                          half_space_compliance(bodies_.pinion.E, bodies_.pinion.nu);
    double least = kNoMaterial;
    for (const ToothWindow& w : windows_)
      least = std::min({least, first_touch(w.cells), w.site.first_gap / w.site.first_lever});
    zero_ = bodies_.from_touch ? 0 : least;
    std::vector<Eigen::Triplet<double>> weights;
    int cell = 0, stations = 0;
    std::vector<std::array<int, 2>> first;  // station of gear and pinion of every window
    for (const ToothWindow& w : windows_) {
      problem_.windows.push_back(w.cells);
      count_from(zero_, problem_.windows.back());
      const ToothBody* bodies[2] = {bodies_.rings[w.site.ring].gear, bodies_.rings[w.site.ring].pinion};
      first.push_back({stations, stations + bodies[0]->sector.columns * bodies[0]->sector.rows});
      for (std::size_t k = 0; k < w.cells.size(); ++k, ++cell) {
        if (!std::isfinite(w.cells.gap[k])) continue;
        const Segment& s = w.places[k].at;
        const ToothBody::Weights on[2] = {bodies[0]->weights(s.r, s.z), bodies[1]->weights(s.Z, s.R)};
        for (std::size_t body = 0; body < 2; ++body)
          for (std::size_t i = 0; i < 4; ++i)
            weights.emplace_back(first.back()[body] + on[body].station[i], cell, on[body].weight[i]);
      }
      stations = first.back()[1] + bodies[1]->sector.columns * bodies[1]->sector.rows;
    }
    problem_.stations.resize(stations, cell);
    problem_.stations.setFromTriplets(weights.begin(), weights.end());
    problem_.remainder = Eigen::MatrixXd::Zero(stations, stations);
    for (std::size_t i = 0; i < windows_.size(); ++i)
      for (std::size_t k = 0; k < windows_.size(); ++k) {
        if (windows_[i].site.ring != windows_[k].site.ring) continue;
        const CellRing& ring = bodies_.rings[windows_[i].site.ring];
        for (std::size_t body = 0; body < 2; ++body) {
          const ToothBody& b = body == 0 ? *ring.gear : *ring.pinion;
          const int offset = (windows_[i].site.tooth - windows_[k].site.tooth) * (body == 0 ? 1 : ring.pinion_next);
          if (std::abs(offset) > b.reach) continue;
          const Eigen::MatrixXd& R = b.remainder[static_cast<std::size_t>(offset + b.reach)];
          problem_.remainder.block(first[i][body], first[k][body], R.rows(), R.cols()) = R;
        }
      }
  }

  Result<CellPressures> at_shift(double force, double shift, const std::vector<double>& start) const {
    CellProblem moved = problem_;
    moved.force = force;
    double least = kNoMaterial;  // the approach counts from where the pinion stood
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      CellWindow& cells = moved.windows[w];
      for (std::size_t k = 0; k < cells.size(); ++k) cells.gap[k] -= windows_[w].axial_of(k) * shift;
      least = std::min(least, first_touch(cells));
    }
    for (auto& w : moved.windows) count_from(least, w);
    auto found = press_cells(moved, start);
    if (found) found->approach += least;
    return found;
  }
  /// What does not balance along the pinion's axis.
  [[nodiscard]] double axial_rest(const CellPressures& found, double shift) const {
    const auto f = forces(found.pressure);
    double sum = load_.axial == PinionAxial::spring ? load_.spring_n_mm * shift : 0;
    std::size_t at = 0;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      sum += windows_[w].axial_sum(found.pressure.data() + at, f[w]);
      at += windows_[w].cells.size();
    }
    return sum;
  }

  /// The approach at which a tooth touches first, as far as cells or its site know it.
  [[nodiscard]] double nearest(const ToothWindow& w) const { return std::min(first_touch(w), first_of(w.site)); }
  /// Leaves out the teeth that stand off while others carry.
  void drop_idle() {
    double first = kNoMaterial;
    for (const ToothWindow& w : windows_) first = std::min(first, nearest(w));
    const auto idle = std::stable_partition(windows_.begin(), windows_.end(), [&](const ToothWindow& w) {
      return !(nearest(w) - first > kIdle * last_.approach + std::abs(shift_));
    });
    std::move(idle, windows_.end(), std::back_inserter(idle_));
    windows_.erase(idle, windows_.end());
  }
  /// Takes back those that lie inside the approach. False: none does.
  bool bring_back() {
    const auto inside = std::stable_partition(
        idle_.begin(), idle_.end(), [&](const ToothWindow& w) { return nearest(w) > zero_ + last_.approach; });
    const bool any = inside != idle_.end();
    std::move(inside, idle_.end(), std::back_inserter(windows_));
    idle_.erase(inside, idle_.end());
    return any;
  }

  /// Approach and, where the pinion is free, its shift: the rest grows with the shift, so its zero is closed in, from
  /// the shift that was found last. Source of the steps: the rule of false position with the Illinois correction.
  Result<CellPressures> motions(double force) {
    if (load_.axial == PinionAxial::held) return at_shift(force, shift_ = 0, last_.pressure);
    auto found = at_shift(force, shift_, last_.pressure);
    if (!found) return found;
    const double enough = 1e-7 * force;
    double low = shift_, high = shift_, rest_low = axial_rest(*found, shift_), rest_high = rest_low,
           step = shift_ == 0 ? found->approach / 4 : std::abs(shift_) / 20;
    const auto look = [&](double at) {
      shift_ = at;
      found = at_shift(force, at, found->pressure);
      return found ? axial_rest(*found, at) : 0;
    };
    for (int k = 0; rest_low > enough || rest_high < -enough; ++k, step *= 4) {  // a shift on either side
      if (k > 60) return fail("no shift of the pinion balances its axial force");
      const double next = rest_low > enough ? low - step : high + step, here = look(next);
      if (!found) return found;
      if (rest_low > enough) high = low, rest_high = rest_low, low = next, rest_low = here;
      else low = high, rest_low = rest_high, high = next, rest_high = here;
    }
    double here = std::abs(rest_low) < std::abs(rest_high) ? rest_low : rest_high;
    if (std::abs(here) <= enough) {
      look(here == rest_low ? low : high);
      return found;
    }
    for (int k = 0, side = 0; k < 60 && std::abs(here) > enough; ++k) {
      here = look(low - rest_low * (high - low) / (rest_high - rest_low));
      if (!found) return found;
      if (here > 0) {
        high = shift_, rest_high = here;
        if (side > 0) rest_low /= 2;
        side = 1;
      } else {
        low = shift_, rest_low = here;
        if (side < 0) rest_high /= 2;
        side = -1;
      }
    }
    if (std::abs(here) > enough) return fail("the shift of the pinion does not settle: {:g} N are left", here);
    return found;
  }

  /// Gaps that count from first touch: an approach that is lost in what first touch is known to.
  [[nodiscard]] Status above_first_touch() const {
    if (!bodies_.from_touch || last_.approach > kTouchKnown || load_.axial != PinionAxial::held) return Ok{};
    return fail(
        "at {:.4f} deg the load of {:g} N lets the flanks approach by {:.3g} mm; first touch of rigid flanks is known "
        "to {:g} mm: a larger torque or softer teeth are needed",
        degrees(phi_), force(), last_.approach, kTouchKnown);
  }
  /// Cells see the place where a tooth touches first from their own middles on. True: they miss more of its overlap
  /// than they see, as at a corner under stiff teeth.
  [[nodiscard]] bool misses_first(const ToothWindow& w, double approach) const {
    const double first = first_of(w.site) - zero_, seen = first_touch(w) - zero_;
    return first < approach && seen - first > approach - seen;
  }

  /// Which window no fit holds, and what would help.
  [[nodiscard]] std::string outgrown() const {
    const auto widest = std::max_element(windows_.begin(), windows_.end(),
                                         [](const auto& a, const auto& b) { return a.site.half_y < b.site.half_y; });
    return fmt::format(
        "the contact at {:.4f} deg outgrows its cells: after {} fits the windows still do not hold what presses, the "
        "longest {:.3f} x {:.3f} mm (ring {}, tooth {}). A smaller torque, or reliefs that begin less abruptly would "
        "help",
        degrees(phi_), kMostFits, 2 * widest->site.half_x, 2 * widest->site.half_y, ring_of(*widest),
        widest->site.tooth);
  }

  /// Draws the windows around what presses. False: they fit already. @param only_rim  widens only what is too narrow
  /// Refused: a corner that the smallest cells do not see.
  Result<bool> refit(const CellPressures& found, bool only_rim) {
    bool changed = false;
    std::size_t at = 0;
    for (ToothWindow& w : windows_) {
      const CellWindow& c = w.cells;
      CellSite& site = w.site;
      const double* pressure = found.pressure.data() + at;
      at += c.size();
      if (misses_first(w, found.approach)) {
        if (2 * site.half_x <= kSmallest && 2 * site.half_y <= kSmallest)
          return fail(
              "at {:.4f} deg tooth {} of {} touches on a corner without size: it overlaps by {:.3g} mm of an approach "
              "of {:.3g} mm, and cells of {:.2g} mm, the smallest, see {:.3g} mm of it: a larger torque or softer "
              "teeth are needed",
              degrees(phi_), site.tooth, bodies_.rings[site.ring].ring, found.approach + zero_ - first_of(site),
              found.approach, std::max(c.dx, c.dy), std::max(0.0, found.approach + zero_ - first_touch(w)));
        site.x = site.first.x(), site.y = site.first.y();
        site.half_x = std::max(site.half_x / kCloser, kSmallest / 2);
        site.half_y = std::max(site.half_y / kCloser, kSmallest / 2);
        fill(w, c.columns, c.rows);
        changed = true;
      } else if (drawn_together(w, pressure, only_rim)) {
        changed = true;
      }
    }
    return changed;
  }
  /// One window around what presses in it. False: it fits already, or nothing presses.
  bool drawn_together(ToothWindow& w, const double* pressure, bool only_rim) {
    const CellWindow& c = w.cells;
    CellSite& site = w.site;
    int from_x = c.columns, to_x = -1, from_y = c.rows, to_y = -1;
    bool rim = false;
    for (int row = 0; row < c.rows; ++row)
      for (int column = 0; column < c.columns; ++column) {
        if (!(pressure[row * c.columns + column] > 0)) continue;
        from_x = std::min(from_x, column), to_x = std::max(to_x, column);
        from_y = std::min(from_y, row), to_y = std::max(to_y, row);
        rim |= column == 0 || column == c.columns - 1 || row == 0 || row == c.rows - 1;
      }
    if (to_x < 0) return false;
    const double wide = std::max((to_x - from_x + 1) * c.dx, kSmallest),
                 high = std::max((to_y - from_y + 1) * c.dy, kSmallest);
    if (!rim && (only_rim || (2 * site.half_x < kLoose * wide && 2 * site.half_y < kLoose * high))) return false;
    site.x += (from_x + to_x + 1) * c.dx / 2 - site.half_x, site.y += (from_y + to_y + 1) * c.dy / 2 - site.half_y;
    const double grow = rim ? 2 * kMargin : kMargin;
    site.half_x = std::max(grow * wide / 2, site.half_x / kCloser),
    site.half_y = std::max(grow * high / 2, site.half_y / kCloser);
    fill(w, c.columns, c.rows);
    return true;
  }

  /// The approach at which the first cell of a window touches.
  static double first_touch(const CellWindow& c) {
    double least = kNoMaterial;
    for (std::size_t k = 0; k < c.size(); ++k) least = std::min(least, c.gap[k] / c.lever_of(k));
    return least;
  }
  [[nodiscard]] double first_touch(const ToothWindow& w) const {
    double least = kNoMaterial;
    for (std::size_t k = 0; k < w.cells.size(); ++k)
      least = std::min(least, (w.cells.gap[k] - w.axial_of(k) * shift_) / w.cells.lever_of(k));
    return least;
  }
  /// The approach at which its flanks touch first, as far as that is known beside the cells.
  [[nodiscard]] double first_of(const CellSite& site) const {
    return (site.first_gap + site.normal.dot(bodies_.pinion_axis) * shift_) / site.first_lever;
  }
  /// Gaps as they are when the bodies have approached by so much.
  static void count_from(double approach, CellWindow& c) {
    for (std::size_t k = 0; k < c.size(); ++k) c.gap[k] -= c.lever_of(k) * approach;
  }

  const CellFlanks& flanks_;
  const CellBodies& bodies_;
  const Load& load_;
  double phi_, shift_ = 0;
  double zero_ = 0;  ///< the approach counts from there
  std::vector<ToothWindow> windows_;
  std::vector<ToothWindow> idle_;  ///< left out
  CellProblem problem_;
  CellPressures last_;
};

/// Pressed cells beside missing material: an edge carries there.
bool on_edge(const CellWindow& c, int row, int column) {
  for (int dr = -1; dr <= 1; ++dr)
    for (int dc = -1; dc <= 1; ++dc) {
      const int r = row + dr, k = column + dc;
      if (r < 0 || k < 0 || r >= c.rows || k >= c.columns) continue;
      if (!std::isfinite(c.gap[static_cast<std::size_t>(r * c.columns + k)])) return true;
    }
  return false;
}

/// Rows of cells as segments.
void add_rows(const CellBodies& bodies, const ToothWindow& w, const double* pressure, LoadedPosition& out) {
  const CellWindow& c = w.cells;
  for (int row = 0; row < c.rows; ++row) {
    PressedSegment s;
    int best = -1, pressed = 0;
    bool edge = false;
    for (int column = 0; column < c.columns; ++column) {
      const double p = pressure[row * c.columns + column];
      if (!(p > 0)) continue;
      ++pressed;
      s.force += p * c.dx * c.dy;
      edge |= on_edge(c, row, column);
      if (best < 0 || p > s.pressure) best = column, s.pressure = p;
    }
    if (best < 0) continue;
    s.place = w.places[static_cast<std::size_t>(row * c.columns + best)].at;
    s.place.length = c.dy;
    s.place.curvature = w.site.curvature;
    s.place.at_end = edge;
    s.half_width = pressed * c.dx / 2;
    if (edge) {
      out.end_pressure = std::max(out.end_pressure, s.pressure);
      out.end_line_load = std::max(out.end_line_load, s.force / c.dy);
      if (bodies.edge_radius_mm > 0)
        out.edge_pressure = std::max(out.edge_pressure, pressure_along_edge(s.force / c.dy, bodies.modulus,
                                                                            bodies.edge_radius_mm, s.place.curvature));
    } else {
      out.pressure = std::max(out.pressure, s.pressure);
    }
    out.segments.push_back(std::move(s));
  }
}

/// What a window's forces make about both axes, and along the gear's.
void add_statics(const CellBodies& bodies, const ToothWindow& w, const double* pressure, LoadedPosition& out) {
  for (std::size_t k = 0; k < w.cells.size(); ++k) {
    if (!(pressure[k] > 0)) continue;
    const Segment& s = w.places[k].at;
    const Vec3 force = s.normal * (pressure[k] * w.cells.dx * w.cells.dy);
    out.gear_axial_n -= force.dot(bodies.gear_axis);
    out.gear_torque_nmm -= (s.point - bodies.gear_origin).cross(force).dot(bodies.gear_axis);
    out.pinion_torque_nmm += (s.point - bodies.pinion_origin).cross(force).dot(bodies.pinion_axis);
  }
}

std::vector<int> rings_of(const CellBodies& bodies) {
  std::vector<int> rings;
  for (const CellRing& r : bodies.rings) rings.push_back(r.ring);
  return rings;
}

}  // namespace

Result<LoadedPosition> cell_position(const CellFlanks& flanks, const Load& load, double phi) {
  const CellBodies& bodies = flanks.bodies();
  Cells cells(flanks, load, phi);
  if (cells.empty()) return fail("no pair touches while the pinion stands at {:.4f} deg", degrees(phi));
  const auto found = cells.share();
  if (!found) return found.error();
  const double F = cells.force();
  LoadedPosition out;
  out.phi = phi;
  out.cells = true;
  out.approach_mm = found->approach;
  out.error_rad = out.approach_mm / bodies.gear_lever;
  out.shift_mm = cells.shift();
  out.stiffness = F / out.approach_mm;
  out.line_mm = flanks.line_mm();
  out.residual = found->residual;
  Carriers carriers(rings_of(bodies), out);
  const auto forces = cells.forces(found->pressure);
  std::size_t at = 0;
  for (std::size_t w = 0; w < cells.windows().size(); ++w) {
    const ToothWindow& window = cells.windows()[w];
    const double* pressure = found->pressure.data() + at;
    add_rows(bodies, window, pressure, out);
    at += window.cells.size();
    if (!(forces[w] > 0)) continue;
    carriers.add(cells.ring_of(window), window.site.tooth, forces[w], window.site.curvature);
    out.axial_n -= window.axial_sum(pressure, forces[w]);
    add_statics(bodies, window, pressure, out);
  }
  carriers.finish(F);
  out.gear_torque_nmm = std::abs(out.gear_torque_nmm), out.pinion_torque_nmm = std::abs(out.pinion_torque_nmm);
  constexpr double kMore = 0.01;  // of the load, for the tangent
  const auto more = cells.balanced(F * (1 + kMore));
  if (!more) return more.error();
  out.tangent = kMore * F / (more->approach - found->approach);
  if (load.axial == PinionAxial::held && bodies.rings.size() > 1) {
    constexpr double step = 1e-4;  // mm
    if (const auto shifted = cells.nearby(F, step)) {
      const auto moved = cells.forces(shifted->pressure);
      double outer = 0;
      for (std::size_t w = 0; w < moved.size(); ++w)
        if (cells.windows()[w].site.ring + 1 == bodies.rings.size()) outer += moved[w];
      out.share_per_mm = (outer - out.ring_force.back()) / F / step;
    }
  }
  return out;
}

}  // namespace toothpath::loaded
