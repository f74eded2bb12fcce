#include "geometry/flank_grid/fitted_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/base/length_unit.h"
#include "geometry/base/refusals.h"
#include "geometry/tooth_space/limits.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::flank_grid {
namespace {

using tooth_space::Chart;
using tooth_space::Piece;

constexpr int kLeastTeeth = 5, kMostTeeth = 5000, kLeastPoints = 4, kMostPoints = 400;
constexpr double kMostRatio = 3;      // of neighbouring chords
constexpr double kOnePlace = 1e-6;    // mm: two points, or the ends of root and tip
constexpr double kUnitLength = 1e-3;  // what the length of a normal may lack of 1
constexpr double kEndsOff = 0.005;    // mm: both ends of the teeth are square to one direction within it
constexpr double kMostLean = 30;      // deg, of an end to the direction in which the teeth stand
constexpr double kStraight = 1e-5;    // mm: points of a meridian that lie so close to its chord add nothing
constexpr double kMostTurn = 30;      // deg, of a meridian: in a corner, and to its chord
constexpr double kCornerOff = 1e-3;   // mm: how far a corner's rounding leaves it, where no ball asks for more
constexpr double kRollRoom = 2;       // times the ball's radius: the least radius of a hollow corner of the root
constexpr double kFarthest = 1e5;     // mm
constexpr double kLeastFace = 0.01;   // mm
constexpr double kLeastArc = 1;       // deg, of a fillet
constexpr double kNearlyFlat = 1e-9;  // sine of a chart
constexpr int kStations = 17, kHalvings = 50;

double along(const Chart& chart, const Vec2& rz) { return chart.cosine * rz.x() - chart.sine * rz.y(); }
double up(const Chart& chart, const Vec2& rz) { return chart.sine * rz.x() + chart.cosine * rz.y(); }
/// Of the normal, towards growing azimuth.
double sideways(const Vec3& p, const Vec3& n) { return (p.x() * n.y() - p.y() * n.x()) / radius(p); }
std::string place_words(const Vec3& p) { return fmt::format("r {:.4f} mm, z {:.4f} mm", radius(p), p.z()); }

/// A grid whose columns rise in s.
struct Sorted {
  const GridPoints& grid;
  bool turned = false;
  Sorted(const GridPoints& points, const Chart& chart) : grid(points) {
    double way = 0;
    for (int i = 0; i < points.rows; ++i)
      way += chart.along(points.place[points.index(i, points.columns - 1)]) -
             chart.along(points.place[points.index(i, 0)]);
    turned = way < 0;
  }
  [[nodiscard]] int column(int j) const { return turned ? grid.columns - 1 - j : j; }
  [[nodiscard]] const Vec3& at(int i, int j) const { return grid.place[grid.index(i, column(j))]; }
};

struct Knots {
  std::vector<double> u, v;
};
Knots knots_of(const Sorted& p, const Chart& chart) {
  Knots k{{0}, {0}};
  const int rows = p.grid.rows, columns = p.grid.columns;
  for (int i = 0; i + 1 < rows; ++i) {
    double sum = 0;
    for (int j = 0; j < columns; ++j) sum += (p.at(i + 1, j) - p.at(i, j)).norm();
    k.u.push_back(k.u.back() + sum / columns);
  }
  for (int j = 0; j + 1 < columns; ++j) {
    double sum = 0;
    for (int i = 0; i < rows; ++i) sum += (p.at(i, j + 1) - p.at(i, j)).norm();
    k.v.push_back(k.v.back() + sum / rows);
  }
  double from = 0, to = 0;
  for (int i = 0; i < rows; ++i) {
    from += chart.along(p.at(i, 0)) / rows;
    to += chart.along(p.at(i, columns - 1)) / rows;
  }
  const double scale = (to - from) / k.v.back();
  for (double& v : k.v) v = from + scale * v;
  return k;
}

/// The spline through some rows and columns of a grid.
Flank through(const Sorted& p, const Knots& knots, const std::vector<int>& rows, const std::vector<int>& columns,
              int side) {
  std::vector<double> u, v;
  std::vector<Vec3> points;
  for (const int i : rows) u.push_back(knots.u[std::size_t(i)]);
  for (const int j : columns) v.push_back(knots.v[std::size_t(j)]);
  for (const int i : rows)
    for (const int j : columns) points.push_back(p.at(i, j));
  Flank flank;
  flank.spline = TensorSpline(std::move(u), std::move(v), points);
  const auto& s = flank.spline;
  Vec3 place, normal;
  flank.at<double>(0.5 * (s.u().front() + s.u().back()), 0.5 * (s.v().front() + s.v().back()), place, &normal);
  flank.sign = sideways(place, normal) * side > 0 ? 1 : -1;
  return flank;
}
/// All numbers below `count`, or every second of them and the last.
std::vector<int> numbers(int count, int step) {
  std::vector<int> out;
  for (int k = 0; k < count; k += step) out.push_back(k);
  if (out.back() != count - 1) out.push_back(count - 1);
  return out;
}

/// The place of a flank at (s, h), from a start; nothing where it is not found.
std::optional<Vec3> on_flank(const Flank& flank, const Chart& chart, double s, double h, Vec2 uv) {
  constexpr int kSteps = 30;
  for (int k = 0; k < kSteps; ++k) {
    const auto f = flank.spline.partials(uv[0], uv[1], 1);
    const Vec3 &p = f.d[0][0], &pu = f.d[1][0], &pv = f.d[0][1];
    const Vec2 lack(s - chart.along(p), h - chart.up(p));
    if (lack.norm() < 1e-11 * (1 + p.norm())) return p;
    Eigen::Matrix2d J;
    J << chart.along(p, pu), chart.along(p, pv), chart.up(p, pu), chart.up(p, pv);
    const Vec2 step = J.inverse() * lack;
    if (!step.allFinite()) return {};
    uv += step / std::max({1.0, std::abs(step[0]) / flank.spline.height(), std::abs(step[1]) / flank.spline.length()});
  }
  return {};
}

/// Gathers what is wrong with a gear.
class Fitting : public Refusals {
 public:
  explicit Fitting(const FlankGridParameters& gear) : gear_(gear) {}

  GridKernel kernel;
  GridQuality quality;

  void numbers_in_range() {
    integer_range("teeth", gear_.teeth, kLeastTeeth, kMostTeeth);
    if (!(gear_.fillet_radius_mm > 0 && gear_.fillet_radius_mm < 1e4))
      refuse("fillet_radius", "fillet_radius = {:.6g} mm is outside (0, 10000) mm: a ball of it rolls in the corner",
             gear_.fillet_radius_mm);
    not_negative("bore_diameter", gear_.bore_diameter_mm);
    not_negative("hub_diameter", gear_.hub_diameter_mm);
    not_negative("hub_length", gear_.hub_length_mm);
    for (const auto& [name, line] : {std::pair{"root", &gear_.root}, std::pair{"tip", &gear_.tip}}) {
      if (line->size() < 2) refuse(name, "{} has {} points, two or more are needed: its ends", name, line->size());
      for (const Vec2& p : *line)
        if (!(p.x() > 0 && p.norm() < kFarthest))
          refuse(name, "{}: r {:.6g} mm, z {:.6g} mm is no place beside the axis: r above 0, both within {:g} mm", name,
                 p.x(), p.y(), kFarthest);
    }
    for (const int side : {1, -1}) {
      const GridPoints& g = gear_.points(side);
      if (g.rows < kLeastPoints || g.columns < kLeastPoints || g.rows > kMostPoints || g.columns > kMostPoints)
        refuse("points", "flank {} has {} rows and {} columns of points, {} to {} of each are needed", side, g.rows,
               g.columns, kLeastPoints, kMostPoints);
    }
  }

  void meridians() {
    const Vec2 first = gear_.tip.front() - gear_.root.front(), last = gear_.tip.back() - gear_.root.back();
    if (const double least = std::min(first.norm(), last.norm()); !(least > kOnePlace))
      return refuse("tip",
                    "the tip {} in the root: the teeth are {:.3g} mm high there, limit {:g} mm; a tip beyond the root "
                    "would do",
                    first.norm() > kOnePlace ? "ends" : "begins", least, kOnePlace);
    const Vec2 sum = first.normalized() + last.normalized(), upwards = sum.normalized();
    const auto off = [&](const Vec2& end) { return std::abs(end.x() * upwards.y() - end.y() * upwards.x()); };
    const double lean = 0.5 * std::acos(std::clamp(first.normalized().dot(last.normalized()), -1.0, 1.0));
    if (!(lean <= radians(kMostLean)))
      return refuse("tip",
                    "the ends of the teeth, from the root to the tip, lean to one another by {:.4f} deg, limit {} deg: "
                    "no direction is upright for both",
                    degrees(2 * lean), 2 * kMostLean);
    if (upwards.x() < -1e-9)
      return refuse("tip",
                    "the tip lies {:.4f} mm nearer to the axis than the root, limit 0: internal gears are not there",
                    -std::min(first.x(), last.x()));
    stand(upwards);
    if (ends(2 * std::max(off(first), off(last)) > kEndsOff)) lines(upwards);
  }

  void flank(int side) {
    const GridPoints& g = gear_.points(side);
    const Chart& chart = kernel.ring.chart;
    const Sorted p(g, chart);
    const std::size_t before = refusals.size();
    between_the_meridians(side);
    if (refusals.size() != before) return;
    if (p.turned == rises_)
      return refuse("points",
                    "flank {}: column 0, at {}, lies at the end of the root, its columns must run as root does, from r "
                    "{:.4f} mm, z {:.4f} mm: number them the other way round, or give root and tip from their ends",
                    side, place_words(g.place[0]), gear_.root.front().x(), gear_.root.front().y());
    for (int j = 0; j < g.columns && refusals.size() == before; ++j)
      if (!(chart.up(g.place[g.index(g.rows - 1, j)]) > chart.up(g.place[g.index(0, j)])))
        refuse_point(side, g.rows - 1, j,
                     "the last row lies {:.4f} mm below row 0, limit 0: rows run from the root to the tip",
                     chart.up(g.place[g.index(0, j)]) - chart.up(g.place[g.index(g.rows - 1, j)]));
    for (int i = 0; i < g.rows && refusals.size() == before; ++i)
      line(side, "row", i, g.columns, [&](int k) { return std::pair{i, k}; });
    for (int j = 0; j < g.columns && refusals.size() == before; ++j)
      line(side, "column", j, g.rows, [&](int k) { return std::pair{k, j}; });
    if (refusals.size() != before) return;
    Flank& out = side > 0 ? kernel.plus : kernel.minus;
    out = flank_through(g, side, chart);
    // The spline turns its back nowhere, between the points neither.
    const auto &u = out.spline.u(), &v = out.spline.v();
    for (int i = 0; i < 2 * g.rows - 1; ++i)
      for (int j = 0; j < 2 * g.columns - 1; ++j) {
        const auto between = [](const std::vector<double>& x, int k) {
          return 0.5 * (x[std::size_t(k / 2)] + x[std::size_t((k + 1) / 2)]);
        };
        Vec3 place, normal;
        out.at<double>(between(u, i), between(v, j), place, &normal);
        if (sideways(place, normal) * side > 0) continue;
        return refuse_point(side, i / 2, p.column(j / 2),
                            "the surface through the points folds next to this one: its normal has {:.4f} along the "
                            "azimuth towards the space, limit 0: rows and columns must not cross",
                            sideways(place, normal) * side);
      }
    if (!g.normal.empty()) compare_normals(side, p, out);
  }

  /// Whether the two bound one space.
  void opposite() {
    constexpr int kPlaces = 9;
    const Chart& chart = kernel.ring.chart;
    const TensorSpline &a = kernel.plus.spline, &b = kernel.minus.spline;
    int swapped = 0, found = 0;
    std::optional<Vec3> crossing;
    double worst = 0, swapped_at = 0;  // rad
    for (int i = 0; i < kPlaces; ++i)
      for (int j = 0; j < kPlaces; ++j) {
        const auto share = [](const std::vector<double>& x, int k) {
          return x.front() + (x.back() - x.front()) * k / (kPlaces - 1);
        };
        const Vec3 p = a.at(share(a.u(), i), share(a.v(), j));
        const auto q = on_flank(kernel.minus, chart, chart.along(p), chart.up(p), {share(b.u(), i), share(b.v(), j)});
        if (!q) continue;
        ++found;
        const double space = angle_from_to(p, *q);
        if (space > 0 && space < kernel.ring.pitch) continue;
        ++swapped;
        if (crossing && wrapped(space) >= worst) continue;
        crossing = p;
        worst = wrapped(space);
        swapped_at = space;
      }
    if (found == 0)
      return refuse("points", "the flanks lie nowhere side by side: at no height and place along the teeth");
    if (!crossing) return;
    if (swapped == found)
      return refuse("points",
                    "flank 1 does not lie on the side of negative azimuth of flank -1, less than a pitch ({:.4f} deg) "
                    "from it, but {:.4f} deg: the two must bound one space; are flanks 1 and -1 swapped, or is one of "
                    "them that of another tooth?",
                    degrees(kernel.ring.pitch), degrees(swapped_at));
    refuse("points", "the flanks cross at {}: the space is {:.4f} mm wide there, limit 0", place_words(*crossing),
           radius(*crossing) * worst);
  }

  void ball() {
    const auto& ring = kernel.ring;
    const double width = ring.s_to - ring.s_from, beyond = 0.4 * width + 2 * kernel.radius_mm + 3,
                 middle = 0.5 * (ring.s_from + ring.s_to);
    for (const int side : {1, -1})
      for (int k = 0; k < kStations; ++k) {
        const double v = ring.s_from + width * k / (kStations - 1);
        if (const auto why = misfit(side, v, kernel.radius_mm)) return refuse_ball(*why);
      }
    for (const int side : {1, -1}) {
      auto rolled = RolledBall::roll(kernel.flank(side), kernel.root, kernel.radius_mm, ring.s_from - beyond, middle,
                                     ring.s_to + beyond);
      if (!rolled || rolled->from() > ring.s_from || rolled->to() < ring.s_to)
        return refuse_ball(fmt::format("the ball does not roll along the whole flank {}", side));
      (side > 0 ? kernel.ball_plus : kernel.ball_minus) = std::move(*rolled);
    }
    Vec3 a, b, unused;
    kernel.ball_plus.at(middle, a, unused);
    kernel.ball_minus.at(middle, b, unused);
    kernel.middle = azimuth(Vec3(a / radius(a) + b / radius(b)));
  }

  void lands(const GridSpace& space) {
    const auto& ring = kernel.ring;
    for (int k = 0; k < kStations; ++k) {
      const double s = ring.s_from + (ring.s_to - ring.s_from) * k / (kStations - 1);
      const std::string where = station(s, kernel.tip<double>(s));
      if (const double land = root_land_mm(space, s); !(land > 0))
        return refuse_ball(
            fmt::format("the ball is wider than the space at {}: the fillets overlap by {:.4f} mm", where, -land));
      for (const int side : {1, -1})
        if (!space.tip_edge(side, s))
          return refuse(
              "tip",
              "flank {} does not reach the tip surface at {}: it ends {:.4f} mm below it, limit 0; a tip that "
              "lies lower by so much would do, or more rows of points",
              side, where, space.tip(s) - top_of(space, side, s));
      if (const double land = tooth_space::top_land_mm(space, s); !(land > 0))
        return refuse("tip", "the tooth is pointed: its top land at {} is {:.4f} mm, limit 0{}", where, land,
                      lower_tip(s));
    }
  }

  /// What of the flanks lies beyond their points.
  void going_on(const GridSpace& space) {
    const auto& ring = kernel.ring;
    for (const int side : {1, -1}) {
      const Piece piece = tooth_space::flank_of(side);
      for (int k = 0; k < kStations; ++k) {
        const double station = ring.s_from + (ring.s_to - ring.s_from) * k / (kStations - 1);
        const auto edge = space.tip_edge(side, space.tip_s(station));
        constexpr int kHeights = 5;
        for (int i = 0; i < kHeights && edge; ++i) see(space, side, piece, edge->u * i / (kHeights - 1), station);
        see(space, side, tooth_space::fillet_of(side), 0, station);
      }
    }
    if (quality.going_on > kMostBeyond * (1 + 1e-9))
      refuse("points",
             "the flanks go on beyond their points by {:.1f} % ({:.4f} mm) at {}, limit {:.0f} %: more points are "
             "needed there, or a larger fillet_radius where it is below them",
             100 * quality.going_on, quality.going_on_mm, quality.going_on_at, 100 * kMostBeyond);
  }

  void spacing() {
    for (const int side : {1, -1})
      if (const auto error = spacing_error(gear_.points(side), side, kernel.ring.chart))
        quality.spacing_mm = std::max(quality.spacing_mm.value_or(0), *error);
  }

 private:
  /// The chart halves the angle between the ends.
  void stand(const Vec2& upwards) {
    auto& ring = kernel.ring;
    ring.chart.sine = std::abs(upwards.x()) < 1e-9 ? 0 : upwards.x();
    ring.chart.cosine = std::abs(upwards.y()) < 1e-9 ? 0 : upwards.y();
    if (ring.chart.sine == 0) {
      // Teeth that look down stand on a cone that is nearly flat: a chart without sine is one of teeth that look up.
      if (ring.chart.cosine < 0) ring.chart.sine = kNearlyFlat;
      ring.chart.cosine = ring.chart.cosine > 0 ? 1 : -1;
    }
    if (ring.chart.cosine == 0) ring.chart.sine = 1;
  }
  /// Where the teeth end. False: refused.
  bool ends(bool lean) {
    auto& ring = kernel.ring;
    const Chart& chart = ring.chart;
    ring.pitch = kTwoPi / gear_.teeth;
    kernel.radius_mm = gear_.fillet_radius_mm;
    const auto in_chart = [&](const Vec2& rz) { return Vec2(along(chart, rz), up(chart, rz)); };
    const Vec2 low[] = {in_chart(gear_.root.front()), in_chart(gear_.root.back())},
               high[] = {in_chart(gear_.tip.front()), in_chart(gear_.tip.back())};
    rises_ = low[1].x() + high[1].x() > low[0].x() + high[0].x();
    std::array<tooth_space::EndLine, 2> made;
    for (const std::size_t k : {0U, 1U}) {
      const std::size_t n = rises_ ? k : 1 - k;
      const Vec2 middle = 0.5 * (low[n] + high[n]), way = high[n] - low[n];
      made[k] = {middle.x(), middle.y(), way.x() / way.y()};
    }
    ring.s_from = made[0].s;
    ring.s_to = made[1].s;
    if (lean) {
      // The engine's ends lie farther out than either end at any height, down to where the body's front begins.
      ring.leaning = made;
      const double module = 2 * std::max(gear_.tip.front().x(), gear_.tip.back().x()) / gear_.teeth,
                   deepest = std::min(low[0].y(), low[1].y()) - module, highest = std::max(high[0].y(), high[1].y());
      for (const double h : {deepest, highest}) {
        if (!(made[1].at(h) - made[0].at(h) > kLeastFace)) {
          refuse(
              "tip",
              "the ends of the teeth lean to one another so much that they meet before {}: longer teeth, or ends that "
              "lean less",
              h == deepest ? "a module below the root" : "the tip");
          return false;
        }
        ring.s_from = std::min(ring.s_from, made[0].at(h));
        ring.s_to = std::max(ring.s_to, made[1].at(h));
      }
    }
    if (!(ring.s_to - ring.s_from > kLeastFace)) {
      refuse("root", "the teeth are {:.6g} mm long, {} mm at least are needed", ring.s_to - ring.s_from, kLeastFace);
      return false;
    }
    ring.from = rises_ ? "first" : "last";
    ring.to = rises_ ? "last" : "first";
    name_stations(ring);
    return true;
  }
  /// Root and tip.
  void lines(const Vec2& upwards) {
    const Vec2 way = (gear_.root.back() - gear_.root.front()).normalized();
    kernel.root.start = gear_.root.front();
    kernel.root.along = way;
    kernel.root.normal = Vec2(-way.y(), way.x());
    if (kernel.root.normal.dot(upwards) < 0) kernel.root.normal = -kernel.root.normal;
    const Chart& chart = kernel.ring.chart;
    const auto in_chart = [&](const Vec2& rz) { return Vec2(along(chart, rz), up(chart, rz)); };
    const auto on_root = [&](const Vec2& rz) { return kernel.root.local(rz); };
    if (auto line = rounded("root", gear_.root, on_root, kRollRoom * kernel.radius_mm)) kernel.root.bent = *line;
    std::vector<Vec2> tip = gear_.tip;
    if (!rises_) std::reverse(tip.begin(), tip.end());
    if (auto line = rounded("tip", tip, in_chart, 0)) kernel.tip_line = *line;
  }
  template <typename... Args>
  void refuse_point(int side, int row, int column, fmt::format_string<Args...> text, Args&&... args) {
    Diagnostic d =
        fail("flank {}, row {}, column {}: {}", side, row, column, fmt::format(text, std::forward<Args>(args)...));
    const GridPoints& g = gear_.points(side);
    if (!g.line.empty()) d.position = {gear_.file, g.line[g.index(row, column)], 1};
    add({"points", std::move(d)});
  }
  /// A station in words, and by how much it lies beyond an end that leans, at a height: teeth are planned longer.
  [[nodiscard]] std::string station(double s, double h) const {
    const auto& ring = kernel.ring;
    const double beyond = std::max(ring.end(false).at(h) - s, s - ring.end(true).at(h));
    return tooth_space::station(ring, s) +
           (ring.leaning && beyond > 0
                ? fmt::format(", {:.4f} mm beyond an end that leans: teeth are planned with square ends", beyond)
                : std::string());
  }
  /// Highest place of a flank at s, as far as its points and what may go on beyond them reach; their top where it has
  /// none.
  [[nodiscard]] double top_of(const GridSpace& space, int side, double s) const {
    constexpr int kSteps = 40;
    const Flank& f = kernel.flank(side);
    const Chart& chart = kernel.ring.chart;
    const double v = std::clamp(s, kernel.ball(side).from(), kernel.ball(side).to()),
                 most = f.spline.u().back() + kMostBeyond * f.spline.height() - kernel.ball(side).contact(v);
    double top = -INFINITY;
    for (int k = 0; k <= kSteps; ++k)
      if (const auto q = tooth_space::place_at(space, tooth_space::flank_of(side), most * k / kSteps, s))
        top = std::max(top, chart.up(q->p));
    return std::isfinite(top) ? top : chart.up(f.spline.at(f.spline.u().back(), v));
  }
  /// By how much the tip would have to lie lower at s for a land, in words.
  [[nodiscard]] std::string lower_tip(double s) const {
    const double height = kernel.tip<double>(s) - up(kernel.ring.chart, gear_.root.front());
    const auto less = that_does(0, height, [&](double lower) {
      GridKernel other = kernel;
      other.tip_line.raise(-lower);
      const GridSpace space(std::move(other));
      return space.tip_edge(1, s) && space.tip_edge(-1, s) && tooth_space::top_land_mm(space, s) > 0;
    });
    return less ? fmt::format("; a tip that lies {:.4f} mm lower would do", std::ceil(1e4 * *less) / 1e4) : "";
  }
  /// With the largest ball that would do.
  void refuse_ball(const std::string& why) {
    double fits = 0, high = kernel.radius_mm;
    const auto& ring = kernel.ring;
    const auto does = [&](double radius) {
      for (const int side : {1, -1})
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
          if (misfit(side, ring.s_from + share * (ring.s_to - ring.s_from), radius)) return false;
      return !overlaps(radius);
    };
    for (int k = 0; k < 20; ++k) {
      const double middle = 0.5 * (fits + high);
      (does(middle) ? fits : high) = middle;
    }
    refuse("fillet_radius", "fillet_radius = {:.4f} mm: {}; {}", kernel.radius_mm, why,
           fits > 1e-3 * kernel.radius_mm ? fmt::format("{:.4f} mm or less would do", std::floor(1e3 * fits) / 1e3)
                                          : std::string("no ball fits there"));
  }
  /// Whether balls of a radius, side by side at the same v, touch the root in the wrong order.
  [[nodiscard]] bool overlaps(double radius) const {
    const auto& ring = kernel.ring;
    for (const double share : {0.0, 0.5, 1.0}) {
      const double v = ring.s_from + share * (ring.s_to - ring.s_from);
      std::array<Vec3, 2> centre;
      for (const int side : {1, -1}) {
        const auto u = RolledBall::contact(kernel.flank(side), kernel.root, radius, v);
        if (!u) return true;
        Vec3 p, n;
        kernel.flank(side).at<double>(*u, v, p, &n);
        centre[side > 0 ? 0 : 1] = p + radius * n;
      }
      if (!(angle_from_to(centre[0], centre[1]) > 0)) return true;
    }
    return false;
  }
  /// Why a ball does not stand between flank and root at v.
  [[nodiscard]] std::optional<std::string> misfit(int side, double v, double radius) const {
    const Flank& f = kernel.flank(side);
    const auto u = RolledBall::contact(f, kernel.root, radius, v);
    if (!u) {
      Vec3 p, n;
      f.at<double>(f.spline.u().back(), v, p, &n);
      const Vec3 c = p + radius * n;
      if (kernel.root.height({toothpath::radius(c), c.z()}) < radius)
        return fmt::format("on flank {} at {} it touches the root before it touches the flank", side,
                           station(v, up(kernel.ring.chart, gear_.root.front())));
      return fmt::format("on flank {} at {} it does not reach the root down to half a height below the points", side,
                         station(v, up(kernel.ring.chart, gear_.root.front())));
    }
    using D = Dual<double, 2>;
    Vec3T<D> p, n;
    f.at<D>(D::variable(*u, 0), D::variable(v, 1), p, &n);
    const Vec3 parallel =
                   (derivative(p, 0) + radius * derivative(n, 0)).cross(derivative(p, 1) + radius * derivative(n, 1)),
               normal = value(n), c = value(p) + radius * normal;
    if (!(parallel.dot(normal) * f.sign > 0))
      return fmt::format("it does not fit the hollow of flank {} at {}", side, place_words(value(p)));
    const auto square = kernel.root.outwards(kernel.root.foot({toothpath::radius(c), c.z()}));
    const double out = square[0] / toothpath::radius(c),
                 arc = std::acos(std::clamp(normal.dot(Vec3(c.x() * out, c.y() * out, square[1])), -1.0, 1.0));
    if (!(arc > radians(kLeastArc) && arc < radians(180 - kLeastArc)))
      return fmt::format("flank {} meets the root at {:.3f} deg at {}, a fillet needs {} to {} deg", side, degrees(arc),
                         place_words(value(p)), kLeastArc, 180 - kLeastArc);
    return {};
  }
  static void name_stations(tooth_space::Outline& ring) {
    const Chart& chart = ring.chart;
    if (chart.sine <= kNearlyFlat) {
      ring.sign = chart.cosine;
    } else if (chart.cosine == 0) {
      ring.along = "z";
      ring.sign = -1;
    } else {
      ring.along = "place along the teeth";
    }
  }

  /// The line through the points of a meridian, given in another frame in which it rises. Hollow corners get at least
  /// a radius. Refused: what turns back or bends too sharply.
  template <typename Frame>
  std::optional<RoundedLine> rounded(const char* name, const std::vector<Vec2>& points, const Frame& frame,
                                     double hollow_mm) {
    const auto number = [&](std::size_t k) {  // in the job
      return points.data() == gear_.root.data() || rises_ ? k : points.size() - 1 - k;
    };
    const auto words = [&](std::size_t k) {
      return fmt::format("point {}, r {:.4f} mm, z {:.4f} mm", number(k), points[k].x(), points[k].y());
    };
    const Vec2 chord = frame(points.back()) - frame(points.front());
    std::vector<Vec2> line{frame(points.front())};
    std::vector<std::size_t> from{0};  // points of the job, without those on a straight line with their neighbours
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Vec2 p = frame(points[k]), step = p - frame(points[k - 1]);
      if (!(step.dot(chord) > 0)) {
        refuse(name, "{}: {} does not lie behind the point before it", name, words(k));
        return {};
      }
      if (const double turn = std::abs(std::atan2(step.y() * chord.x() - step.x() * chord.y(), step.dot(chord)));
          !(turn <= radians(kMostTurn))) {
        refuse(name, "{}: the line to {} leans by {:.4f} deg to that from the first point to the last, limit {} deg",
               name, words(k), degrees(turn), kMostTurn);
        return {};
      }
      bool straight = from.back() + 1 < k;
      for (std::size_t n = from.back() + 1; straight && n < k; ++n)
        straight = beside(line.back(), frame(points[n]), p) <= kStraight;
      if (!straight && from.back() + 1 < k) line.push_back(frame(points[k - 1])), from.push_back(k - 1);
    }
    line.push_back(frame(points.back()));
    from.push_back(points.size() - 1);
    std::vector<double> half(line.size(), 0.0);
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
      const Vec2 a = line[k] - line[k - 1], b = line[k + 1] - line[k];
      const double turn = b.y() / b.x() - a.y() / a.x(), room = 0.5 * std::min(a.x(), b.x());
      const double wanted = turn > 0 ? hollow_mm * turn : 0;
      if (wanted > room) {
        refuse(name,
               "{}: at {} it turns by {:.4f} deg within {:.4f} mm: too hollow for a ball of {:.4f} mm to roll through; "
               "fillet_radius = {:.4f} mm or less would do",
               name, words(from[k]), degrees(turn), 2 * room, kernel.radius_mm,
               std::floor(1e3 * room / turn / kRollRoom) / 1e3);
        return {};
      }
      half[k] = std::min(room, std::max(wanted, 6 * kCornerOff / std::abs(turn)));
    }
    RoundedLine out(line, half);
    for (std::size_t k = 0; k < out.corners().size(); ++k)
      if (const double off = out.corners()[k].off(); off > quality.corners_mm) {
        quality.corners_mm = off;
        quality.corners_at = fmt::format("{}, {}", name, words(from[k + 1]));
      }
    return out;
  }
  /// Of a point between two others, from the line through them.
  static double beside(const Vec2& a, const Vec2& p, const Vec2& b) {
    const Vec2 way = (b - a).normalized(), d = p - a;
    return std::abs(d.x() * way.y() - d.y() * way.x());
  }

  /// Chords of one row or column.
  template <typename At>
  void line(int side, const char* kind, int number, int count, const At& at) {
    const GridPoints& g = gear_.points(side);
    const auto place = [&](int k) {
      const auto [row, column] = at(k);
      return g.place[g.index(row, column)];
    };
    Vec3 before = Vec3::Zero();
    for (int k = 1; k < count; ++k) {
      const Vec3 chord = place(k) - place(k - 1);
      const auto [row, column] = at(k);
      const double length = chord.norm(), last = before.norm();
      if (!(length > kOnePlace))
        return refuse_point(side, row, column,
                            "the point lies {:.3g} mm from the one before it on {} {}, limit {:g} mm: is it doubled?",
                            length, kind, number, kOnePlace);
      if (k > 1 && !(chord.dot(before) > 0))
        return refuse_point(side, row, column,
                            "{} {} folds: it turns back behind the point before this one, by {:.2f} deg, limit 90 deg",
                            kind, number, degrees(angle_between(chord, before)));
      if (const double ratio = std::max(length, last) / std::min(length, last); k > 1 && ratio > kMostRatio)
        return refuse_point(side, row, column,
                            "the chords on either side of the point before this one on {} {} are {:.4f} and {:.4f} "
                            "mm, their ratio {:.3f} exceeds {:g}: space the points more evenly",
                            kind, number, last, length, ratio, kMostRatio);
      before = chord;
    }
  }

  /// Another unit or frame shows in places far from root and tip.
  void between_the_meridians(int side) {
    const GridPoints& g = gear_.points(side);
    Vec2 low(INFINITY, INFINITY), high = -low;
    for (const auto* line : {&gear_.root, &gear_.tip})
      for (const Vec2& p : *line) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double room = (high - low).norm();
    for (int i = 0; i < g.rows; ++i)
      for (int j = 0; j < g.columns; ++j) {
        const Vec3& p = g.place[g.index(i, j)];
        if (!(p.norm() < kFarthest))
          return refuse_point(side, i, j, "({:g}, {:g}, {:g}) mm is no place beside the axis, within {:g} mm", p.x(),
                              p.y(), p.z(), kFarthest);
        const auto beside = [&](double unit_mm) {
          const Vec2 rz = unit_mm * Vec2(radius(p), p.z());
          return (rz - rz.cwiseMax(low).cwiseMin(high)).norm();
        };
        if (beside(1) < room) continue;
        std::string unit = "are its axes another frame?";
        for (const auto& [unit_mm, name] : {std::pair{kInchMm, "inches"}, std::pair{1e3, "m"}, std::pair{1e-3, "um"}})
          if (beside(unit_mm) < room) unit = fmt::format("are x, y, z in {}?", name);
        return refuse_point(
            side, i, j,
            "the point, at {}, lies {:.4f} mm beside the teeth between root and tip, limit {:.4f} mm: {} "
            "They are read in mm, about the axis of root and tip",
            place_words(p), beside(1), room, unit);
      }
  }

  void compare_normals(int side, const Sorted& p, const Flank& flank) {
    const GridPoints& g = p.grid;
    for (int i = 0; i < g.rows; ++i)
      for (int j = 0; j < g.columns; ++j) {
        Vec3 place, normal;
        flank.at<double>(flank.spline.u()[std::size_t(i)], flank.spline.v()[std::size_t(j)], place, &normal);
        const int column = p.column(j);
        const Vec3& given = g.normal[g.index(i, column)];
        if (!(std::abs(given.norm() - 1) < kUnitLength))
          return refuse_point(side, i, column, "i, j, k have the length {:.6g}, limit 1 within {:g}", given.norm(),
                              kUnitLength);
        const double angle = angle_between(normal, given);
        if (angle > radians(90))
          return refuse_point(
              side, i, column,
              "the normal i, j, k points into the material: it stands at {:.2f} deg to that of the "
              "surface, limit 90 deg; that of flank {} has a {} part along the azimuth; are flanks 1 and -1 swapped?",
              degrees(angle), side, side > 0 ? "positive" : "negative");
        if (quality.normals_rad && angle <= *quality.normals_rad) continue;
        quality.normals_rad = angle;
        quality.normals_at = fmt::format("flank {}, row {}, column {}", side, i, column);
      }
  }

  void see(const GridSpace& space, int side, Piece piece, double u, double station) {
    const auto v = tooth_space::v_at_station(space, piece, u, station);
    if (!v) return refuse_lost(side, station);
    const TensorSpline& spline = kernel.flank(side).spline;
    const double at = kernel.ball(side).contact(*v) + (tooth_space::is_flank(piece) ? u : 0);
    for (const auto& [low, high, x, length] :
         {std::array{spline.u().front(), spline.u().back(), at, spline.height()},
          std::array{spline.v().front(), spline.v().back(), *v, spline.length()}}) {
      const double way = std::max(low - x, x - high);
      if (!(way / length > quality.going_on)) continue;
      quality.going_on = way / length;
      // v is s in the middle of the grid: its ways are longer by as much as the teeth lean.
      quality.going_on_mm = way;
      quality.going_on_at = fmt::format("flank {}, {}", side, place_words(spline.at(at, *v)));
    }
  }
  void refuse_lost(int side, double s) {
    const auto& ring = kernel.ring;
    const auto [from, to] = ring.told(std::max(kernel.ball_plus.from(), kernel.ball_minus.from()),
                                      std::min(kernel.ball_plus.to(), kernel.ball_minus.to()));
    if (refusals.empty())
      refuse("points",
             "flank {} is not found over its whole height at {}: both balls roll along the teeth from {} {:.4f} to "
             "{:.4f} mm only, limits of where flanks go on; columns that run farther along the teeth would help, or "
             "a smaller fillet_radius",
             side, tooth_space::station(ring, s), ring.along, from, to);
  }
  const FlankGridParameters& gear_;
  bool rises_ = true;  // root and tip run towards growing s
};

}  // namespace

Flank flank_through(const GridPoints& grid, int side, const Chart& chart) {
  const Sorted p(grid, chart);
  return through(p, knots_of(p, chart), numbers(grid.rows, 1), numbers(grid.columns, 1), side);
}

std::optional<double> spacing_error(const GridPoints& grid, int side, const Chart& chart) {
  const Sorted p(grid, chart);
  const Knots knots = knots_of(p, chart);
  const std::vector<int> rows = numbers(grid.rows, 2), columns = numbers(grid.columns, 2);
  if (int(std::min(rows.size(), columns.size())) < kLeastPoints) return {};
  const Flank coarse = through(p, knots, rows, columns, side);
  double worst = 0;
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      Vec3 place, normal;
      coarse.at<double>(knots.u[std::size_t(i)], knots.v[std::size_t(j)], place, &normal);
      worst = std::max(worst, std::abs((p.at(i, j) - place).dot(normal)));
    }
  return worst;
}

double root_land_mm(const GridSpace& space, double s) {
  const auto a = place_at(space, Piece::root, 0, s), b = place_at(space, Piece::root, 1, s);
  return a && b ? radius(a->p) * angle_from_to(a->p, b->p) : 0;
}

Expected<FittedGrid, std::vector<Refusal>> fit_grid(const FlankGridParameters& parameters) {
  Fitting fitting(parameters);
  const auto stop = [&] { return !fitting.refusals.empty(); };
  fitting.numbers_in_range();
  if (!stop()) fitting.meridians();
  for (const int side : {1, -1})
    if (!stop()) fitting.flank(side);
  if (!stop()) fitting.opposite();
  if (!stop()) fitting.ball();
  if (stop()) return std::move(fitting.refusals);
  FittedGrid out;
  out.space = std::make_shared<const GridSpace>(fitting.kernel);
  fitting.lands(*out.space);
  if (!stop()) fitting.going_on(*out.space);
  if (stop()) return std::move(fitting.refusals);
  fitting.spacing();
  out.quality = std::move(fitting.quality);
  return out;
}

}  // namespace toothpath::flank_grid
