#include "geometry/loaded/cell_position.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/loaded/carriers.h"
#include "geometry/loaded/cell_contact.h"
#include "geometry/loaded/half_space.h"
#include "geometry/loaded/line_of_tooth.h"

namespace toothpath::loaded {
namespace {

constexpr int kColumns = 48, kRows = 64;
constexpr int kCoarse = 2;           // cells of a side that are one while windows are fitted
constexpr double kIdle = 1.2;        // approaches: flanks farther apart do not touch when others do
constexpr double kMargin = 1.3;      // windows reach so far beyond what presses
constexpr double kLoose = 2.2;       // a window so much wider than what presses is drawn together
constexpr int kMostFits = 8;         // rounds of fitting the windows
constexpr int kBlock = 4;            // cells of a side of a block whose image is counted as one
constexpr double kImageReach = 2.0;  // windows: farther ends have no image

/// The window of one tooth: a rectangle in the tangent plane at the place of least gap.
struct ToothWindow {
  const PairRing* ring = nullptr;
  int tooth = 0;
  LinePlace middle;
  Vec3 across = Vec3::Zero(), along = Vec3::Zero();
  double x = 0, y = 0, half_x = 0, half_y = 0;
  CellWindow cells;
  std::vector<LinePlace> places;  ///< of the cells; `inside` < 0 where there is no material
  std::vector<Segment> segments;
};

/// Half axes of the ellipse that a force presses, within some per cent. Source: Brewe and Hamrock 1977.
std::array<double, 2> ellipse_sides(double force, double modulus, double k1, double k2) {
  const double ratio = std::max(1.0, k1 / std::max(k2, 1e-9 * k1)), round = std::pow(ratio, 2 / kPi);
  const double integral = 1 + (kPi / 2 - 1) / ratio, size = 3 * force * integral / (kPi * modulus * (k1 + k2));
  return {std::cbrt(size / round), std::cbrt(size * round * round)};
}

class Cells {
 public:
  Cells(const LoadedPair& pair, const Load& load, double phi) : pair_(pair), load_(load), phi_(phi) {}

  Status list() {
    for (const PairRing& ring : pair_.rings) {
      LineOptions options;
      options.segment_mm = pair_.options.segment_mm;
      options.pinion = &ring.moved;
      for (const auto& line : contact_lines(ring.surface, ring.ring, pair_.side, phi_, ring.bounds, options)) {
        line_mm_ += line.length;
        add(ring, line);
      }
    }
    if (windows_.empty()) return fail("no pair touches while the pinion stands at {:.4f} deg", degrees(phi_));
    return Ok{};
  }

  /// Shares the load, fitting the windows to what presses, on coarse cells first.
  Result<CellPressures> share() {
    for (const int side : {kCoarse, 1}) {
      for (ToothWindow& w : windows_) fill(w, kColumns / side, kRows / side);
      int fit = 0;
      for (; fit < kMostFits; ++fit) {
        last_.pressure.clear();
        make_problem();
        auto found = motions(force());
        if (!found) return found.error();
        last_ = *found;
        if (!refit(*found, side == 1)) break;
      }
      if (fit == kMostFits) return fail("the contact at {:.4f} deg outgrows its cells", degrees(phi_));
      if (side > 1) drop_idle();
    }
    return last_;
  }
  [[nodiscard]] double force() const { return load_.torque_nmm / pair_.lever; }
  [[nodiscard]] double shift() const { return shift_; }
  [[nodiscard]] double line_mm() const { return line_mm_; }
  [[nodiscard]] const std::vector<ToothWindow>& windows() const { return windows_; }

  /// Under another force or shift, from the pressures of `share`.
  Result<CellPressures> nearby(double force, double shift) { return at_shift(force, shift_ + shift, last_.pressure); }
  Result<CellPressures> balanced(double force) { return motions(force); }
  [[nodiscard]] double axial_share(const ToothWindow& w) const { return -w.middle.normal.dot(w.ring->surface.a()); }
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
  [[nodiscard]] LineOfTooth line_of(const ToothWindow& w) const {
    return {w.ring->surface, pair_.side, phi_ + w.tooth * 2 * kPi / pair_.shaper_teeth, w.ring->bounds, &w.ring->moved};
  }
  [[nodiscard]] Segment segment(const ToothWindow& w, const LineOfTooth& line, const LinePlace& p) const {
    Segment s = segment_of(line, p);
    s.ring = w.ring->ring, s.tooth = w.tooth;
    s.along = w.along;
    if (pair_.options.gap) s.gap += pair_.options.gap(s);
    return s;
  }

  void add(const PairRing& ring, const ContactLine& line) {
    ToothWindow w;
    w.ring = &ring, w.tooth = line.tooth;
    const LineOfTooth places = line_of(w);
    const auto gap = [&](double B) { return segment(w, places, places.at(B)).gap; };
    constexpr int kStations = 40;
    const double step = (line.to_B - line.from_B) / kStations;
    int best = 0;
    for (int k = 1; k <= kStations; ++k)
      if (gap(line.from_B + step * k) < gap(line.from_B + step * best)) best = k;
    w.middle = places.at(line.from_B + step * best);
    places.bend(w.middle);
    w.across = w.middle.steepest;
    w.along = w.middle.normal.cross(w.across).normalized();
    const auto sides = ellipse_sides(force(), pair_.modulus, w.middle.curvature,
                                     w.middle.curvature * std::max(w.middle.roundness, 0.0));
    w.half_x = kMargin * sides[0], w.half_y = kMargin * std::min(sides[1], line.length);
    windows_.push_back(std::move(w));
  }

  /// The place of the flank above a point of the tangent plane, by Newton.
  [[nodiscard]] LinePlace place(const ToothWindow& w, const LineOfTooth& line, double x, double y,
                                const LinePlace& near) const {
    LinePlace p = near;
    for (int round = 0; round < 12; ++round) {
      const Vec3 off = p.point - w.middle.point;
      const Vec2 miss(x - off.dot(w.across), y - off.dot(w.along));
      if (miss.norm() < 1e-7) return p;
      const auto d = line.moves(p);
      Eigen::Matrix2d J;
      J << d.theta.dot(w.across), d.B.dot(w.across), d.theta.dot(w.along), d.B.dot(w.along);
      const Vec2 step = J.inverse() * miss;
      if (!step.allFinite() || !(p.theta + step.x() > 1e-4)) break;
      p = line.at(p.theta + step.x(), p.B + step.y());
    }
    p.inside = -1;
    return p;
  }

  void fill(ToothWindow& w, int columns, int rows) const {
    const LineOfTooth line = line_of(w);
    CellWindow& c = w.cells;
    c = {columns, rows, 2 * w.half_x / columns, 2 * w.half_y / rows, {}, {}, {}};
    w.places.clear(), w.segments.clear();
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double x = w.x - w.half_x + (column + 0.5) * c.dx, y = w.y - w.half_y + (row + 0.5) * c.dy;
        const LinePlace* near = &w.middle;
        if (column > 0 && w.places.back().inside > -0.5) near = &w.places.back();
        else if (row > 0 && w.places[w.places.size() - static_cast<std::size_t>(columns)].inside > -0.5)
          near = &w.places[w.places.size() - static_cast<std::size_t>(columns)];
        LinePlace p = place(w, line, x, y, *near);
        if (!(p.inside >= 0)) p.inside = std::min(p.inside, -1e-9);
        w.segments.push_back(segment(w, line, p));
        c.gap.push_back(p.inside >= 0 ? w.segments.back().gap : kNoMaterial);
        w.places.push_back(std::move(p));
      }
    add_images(w);
  }

  /// Images of blocks of cells at the free ends of both bodies, where an end is near.
  void add_images(ToothWindow& w) const {
    const PairRing& ring = *w.ring;
    const Vec3 centre = w.middle.point + w.across * w.x + w.along * w.y;
    const double reach = kImageReach * 2 * std::max(w.half_x, w.half_y);
    CellWindow& c = w.cells;
    for (const bool on_gear : {true, false}) {
      const FreeEnds& ends = on_gear ? ring.gear_ends : ring.pinion_ends;
      const BodyPlan& plan = on_gear ? pair_.options.gear : pair_.options.pinion;
      for (std::size_t end = 0; end < 2; ++end) {
        if ((ends.mirrored(centre, end) - centre).norm() / 2 > reach) continue;
        if (c.images.size() == 0) start_blocks(c);
        mirror(w, ends, end, half_space_compliance(plan.E, plan.nu));
      }
    }
  }
  static void start_blocks(CellWindow& c) {
    const int across = (c.columns + kBlock - 1) / kBlock, along = (c.rows + kBlock - 1) / kBlock;
    c.images = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(c.size()), across * along);
    for (int row = 0; row < c.rows; ++row)
      for (int column = 0; column < c.columns; ++column) c.blocks.push_back(row / kBlock * across + column / kBlock);
  }
  static void mirror(ToothWindow& w, const FreeEnds& ends, std::size_t end, double compliance) {
    CellWindow& c = w.cells;
    const double a = kBlock * c.dx / 2, b = kBlock * c.dy / 2;
    const int across = (c.columns + kBlock - 1) / kBlock;
    for (Eigen::Index block = 0; block < c.images.cols(); ++block) {
      const int bx = static_cast<int>(block) % across, by = static_cast<int>(block) / across;
      const Vec3 centre = w.middle.point + w.across * (w.x - w.half_x + (2 * bx + 1) * a) +
                          w.along * (w.y - w.half_y + (2 * by + 1) * b);
      const Vec3 image = ends.mirrored(centre, end);
      const Vec3 ex = (ends.mirrored(centre + w.across * a, end) - image).normalized(),
                 ey = (ends.mirrored(centre + w.along * b, end) - image).normalized();
      for (std::size_t k = 0; k < c.size(); ++k) {
        if (!std::isfinite(c.gap[k])) continue;
        const Vec3 v = w.places[k].point - image;
        const double far = v.norm();
        c.images(static_cast<Eigen::Index>(k), block) +=
            compliance *
            (far > 4 * std::max(a, b) ? 1 / far : rectangle_influence(v.dot(ex), v.dot(ey), a, b) / (4 * a * b));
      }
    }
  }

  void make_problem() {
    problem_ = {};
    problem_.compliance = half_space_compliance(pair_.options.gear.E, pair_.options.gear.nu) +
                          half_space_compliance(pair_.options.pinion.E, pair_.options.pinion.nu);
    double least = kNoMaterial;
    for (const ToothWindow& w : windows_)
      for (const double gap : w.cells.gap) least = std::min(least, gap);
    std::vector<Eigen::Triplet<double>> weights;
    int cell = 0, stations = 0;
    std::vector<std::array<int, 2>> first;  // station of gear and pinion of every window
    for (const ToothWindow& w : windows_) {
      problem_.windows.push_back(w.cells);
      for (double& gap : problem_.windows.back().gap) gap -= least;
      const ToothBody* bodies[2] = {&w.ring->gear, &w.ring->pinion};
      first.push_back({stations, stations + bodies[0]->sector.columns * bodies[0]->sector.rows});
      for (std::size_t k = 0; k < w.cells.size(); ++k, ++cell) {
        if (!std::isfinite(w.cells.gap[k])) continue;
        const Segment& s = w.segments[k];
        const ToothBody::Weights on[2] = {bodies[0]->weights(s.r, s.nearest.z()), bodies[1]->weights(s.Z, s.R)};
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
        if (windows_[i].ring != windows_[k].ring) continue;
        const int offset = windows_[i].tooth - windows_[k].tooth;
        for (std::size_t body = 0; body < 2; ++body) {
          const ToothBody& b = body == 0 ? windows_[i].ring->gear : windows_[i].ring->pinion;
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
    for (std::size_t w = 0; w < windows_.size(); ++w)
      for (double& gap : moved.windows[w].gap) {
        gap -= axial_share(windows_[w]) * shift;
        least = std::min(least, gap);
      }
    for (auto& w : moved.windows)
      for (double& gap : w.gap) gap -= least;
    auto found = press_cells(moved, start);
    if (found) found->approach += least;
    return found;
  }
  /// What does not balance along the pinion's axis.
  [[nodiscard]] double axial_rest(const CellPressures& found, double shift) const {
    const auto f = forces(found.pressure);
    double sum = load_.axial == PinionAxial::spring ? load_.spring_n_mm * shift : 0;
    for (std::size_t w = 0; w < windows_.size(); ++w) sum += axial_share(windows_[w]) * f[w];
    return sum;
  }

  /// Leaves out the teeth that stand off while others carry.
  void drop_idle() {
    double first = kNoMaterial;
    for (const ToothWindow& w : windows_)
      for (const double gap : w.cells.gap) first = std::min(first, gap - axial_share(w) * shift_);
    std::erase_if(windows_, [&](const ToothWindow& w) {
      double least = kNoMaterial;
      for (const double gap : w.cells.gap) least = std::min(least, gap - axial_share(w) * shift_);
      return least - first > kIdle * last_.approach + std::abs(shift_);
    });
  }

  /// Approach and, where the pinion is free, its shift: the rest grows with the shift, so its zero is closed in.
  Result<CellPressures> motions(double force) {
    if (load_.axial == PinionAxial::held) return at_shift(force, shift_ = 0, last_.pressure);
    auto found = at_shift(force, 0, last_.pressure);
    if (!found) return found;
    double rest = axial_rest(*found, 0);
    const double enough = 1e-7 * force;
    double low = 0, high = 0, rest_low = rest, rest_high = rest, step = found->approach / 4;
    for (int k = 0; std::abs(rest) > enough; ++k) {  // a shift on either side
      if (k > 60) return fail("no shift of the pinion balances its axial force");
      const double next = rest > 0 ? low - step : high + step;
      step *= 2;
      found = at_shift(force, next, found->pressure);
      if (!found) return found;
      const double here = axial_rest(*found, next);
      if (here > 0) high = next, rest_high = here;
      else low = next, rest_low = here;
      if (rest > 0 ? here <= 0 : here >= 0) break;
      (rest > 0 ? low : high) = next;
      (rest > 0 ? rest_low : rest_high) = here;
      rest = here;
    }
    shift_ = low;
    for (int k = 0; k < 60 && std::min(std::abs(rest_low), std::abs(rest_high)) > enough; ++k) {
      const double share = rest_high > rest_low ? -rest_low / (rest_high - rest_low) : 0.5;
      shift_ = low + (high - low) * (k % 3 == 2 ? 0.5 : std::clamp(share, 0.02, 0.98));
      found = at_shift(force, shift_, found->pressure);
      if (!found) return found;
      const double here = axial_rest(*found, shift_);
      (here > 0 ? high : low) = shift_;
      (here > 0 ? rest_high : rest_low) = here;
      if (std::abs(here) <= enough) break;
    }
    return found;
  }

  /// Draws the windows around what presses. False: they fit already. @param only_rim  widens only what is too narrow
  bool refit(const CellPressures& found, bool only_rim) {
    bool changed = false;
    std::size_t at = 0;
    for (ToothWindow& w : windows_) {
      const CellWindow& c = w.cells;
      int from_x = c.columns, to_x = -1, from_y = c.rows, to_y = -1;
      bool rim = false;
      for (int row = 0; row < c.rows; ++row)
        for (int column = 0; column < c.columns; ++column) {
          if (!(found.pressure[at + static_cast<std::size_t>(row * c.columns + column)] > 0)) continue;
          from_x = std::min(from_x, column), to_x = std::max(to_x, column);
          from_y = std::min(from_y, row), to_y = std::max(to_y, row);
          rim |= column == 0 || column == c.columns - 1 || row == 0 || row == c.rows - 1;
        }
      at += c.size();
      if (to_x < 0) continue;  // nothing presses here
      const double wide = (to_x - from_x + 1) * c.dx, high = (to_y - from_y + 1) * c.dy;
      if (!rim && (only_rim || (2 * w.half_x < kLoose * wide && 2 * w.half_y < kLoose * high))) continue;
      w.x += (from_x + to_x + 1) * c.dx / 2 - w.half_x, w.y += (from_y + to_y + 1) * c.dy / 2 - w.half_y;
      const double grow = rim ? 2 * kMargin : kMargin;
      w.half_x = std::max(grow * wide / 2, w.half_x / 8), w.half_y = std::max(grow * high / 2, w.half_y / 8);
      fill(w, c.columns, c.rows);
      changed = true;
    }
    return changed;
  }

  const LoadedPair& pair_;
  const Load& load_;
  double phi_, line_mm_ = 0, shift_ = 0;
  std::vector<ToothWindow> windows_;
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
void add_rows(const ToothWindow& w, const double* pressure, LoadedPosition& out) {
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
    s.place = w.segments[static_cast<std::size_t>(row * c.columns + best)];
    s.place.length = c.dy;
    s.place.curvature = w.middle.curvature;
    s.place.at_end = edge;
    s.half_width = pressed * c.dx / 2;
    if (edge) {
      out.end_pressure = std::max(out.end_pressure, s.pressure);
      out.end_line_load = std::max(out.end_line_load, s.force / c.dy);
    } else {
      out.pressure = std::max(out.pressure, s.pressure);
    }
    out.segments.push_back(std::move(s));
  }
}

}  // namespace

Result<LoadedPosition> cell_position(const LoadedPair& pair, const Load& load, double phi) {
  Cells cells(pair, load, phi);
  if (const auto listed = cells.list(); !listed) return listed.error();
  const auto found = cells.share();
  if (!found) return found.error();
  const double F = cells.force();
  LoadedPosition out;
  out.phi = phi;
  out.cells = true;
  out.approach_mm = found->approach;
  out.error_rad = out.approach_mm / pair.lever;
  out.shift_mm = cells.shift();
  out.stiffness = F / out.approach_mm;
  out.line_mm = cells.line_mm();
  out.residual = found->residual;
  Carriers carriers(pair, out);
  const auto forces = cells.forces(found->pressure);
  std::size_t at = 0;
  for (std::size_t w = 0; w < cells.windows().size(); ++w) {
    const ToothWindow& window = cells.windows()[w];
    add_rows(window, found->pressure.data() + at, out);
    at += window.cells.size();
    if (forces[w] > 0)
      carriers.add(window.ring->ring, window.tooth, forces[w], cells.axial_share(window), window.middle.curvature);
  }
  carriers.finish(F);
  constexpr double kMore = 0.01;  // of the load, for the tangent
  const auto more = cells.balanced(F * (1 + kMore));
  if (!more) return more.error();
  out.tangent = kMore * F / (more->approach - found->approach);
  if (load.axial == PinionAxial::held && pair.rings.size() > 1) {
    constexpr double step = 1e-4;  // mm
    if (const auto shifted = cells.nearby(F, step)) {
      const auto moved = cells.forces(shifted->pressure);
      double outer = 0;
      for (std::size_t w = 0; w < moved.size(); ++w)
        if (cells.windows()[w].ring->ring == pair.rings.back().ring) outer += moved[w];
      out.share_per_mm = (outer - out.ring_force.back()) / F / step;
    }
  }
  return out;
}

}  // namespace toothpath::loaded
