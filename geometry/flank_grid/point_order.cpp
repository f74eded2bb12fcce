#include "geometry/flank_grid/point_order.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/base/angle.h"

namespace toothpath::flank_grid {
namespace {

constexpr int kLeastLines = 4, kMostLines = 400;  // rows or columns
constexpr double kSamePlace = 1e-6;               // mm
constexpr double kOffSheet = 0.1;                 // of the space's width
constexpr double kLeastGap = 2e-4;                // between columns, of the length; 400 of them leave 2.5e-3
constexpr double kClearGap = 1.5;                 // gaps between columns against those within one
constexpr double kMissing = 1.7;                  // times the steps beside it: something is missing
constexpr double kFlat = 0.1;                     // sine of a pitch angle's complement: teeth on a face
constexpr double kSquareEnds = 0.05;              // mm over the height: ends that lean by less are taken as square
constexpr double kWidens = 1.1;                   // a space, from the root to the tip
constexpr int kRounds = 30;

using Members = std::vector<std::size_t>;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
Vec2 meridian(const Vec3& p) { return {radius(p), p.z()}; }

/// Azimuth over (r, z) as a polynomial.
class Sheet {
 public:
  Sheet() = default;
  Sheet(const std::vector<Vec2>& q, const std::vector<double>& azimuth, const Members& of, int degree)
      : degree_(degree) {
    Vec2 low = q[of.front()], high = low;
    for (const std::size_t k : of) low = low.cwiseMin(q[k]), high = high.cwiseMax(q[k]);
    middle_ = 0.5 * (low + high);
    half_ = (0.5 * (high - low)).cwiseMax(1e-9);
    Eigen::MatrixXd a(Eigen::Index(of.size()), Eigen::Index((degree + 1) * (degree + 2) / 2));
    Eigen::VectorXd b(Eigen::Index(of.size()));
    for (std::size_t i = 0; i < of.size(); ++i) {
      a.row(Eigen::Index(i)) = terms(q[of[i]]);
      b[Eigen::Index(i)] = azimuth[of[i]];
    }
    c_ = a.colPivHouseholderQr().solve(b);
  }
  [[nodiscard]] double at(const Vec2& q) const { return terms(q).dot(c_); }

 private:
  [[nodiscard]] Eigen::RowVectorXd terms(const Vec2& q) const {
    const double x = (q.x() - middle_.x()) / half_.x(), y = (q.y() - middle_.y()) / half_.y();
    Eigen::RowVectorXd out((degree_ + 1) * (degree_ + 2) / 2);
    Eigen::Index k = 0;
    for (int i = 0; i <= degree_; ++i)
      for (int j = 0; i + j <= degree_; ++j) out[k++] = std::pow(x, i) * std::pow(y, j);
    return out;
  }
  int degree_ = 0;
  Vec2 middle_ = Vec2::Zero(), half_ = Vec2::Ones();
  Eigen::VectorXd c_;
};

/// The convex border of some places, counter-clockwise.
std::vector<Vec2> border_of(std::vector<Vec2> q) {
  std::sort(q.begin(), q.end(),
            [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Vec2> out;
  for (const bool back : {false, true}) {
    const std::size_t start = out.size();
    for (const Vec2& p : q) {
      while (out.size() >= start + 2 && cross(out.back() - out[out.size() - 2], p - out.back()) <= 0) out.pop_back();
      out.push_back(p);
    }
    out.pop_back();
    if (!back) std::reverse(q.begin(), q.end());
  }
  return out;
}

/// The four sides about a convex border: the edge whose neighbours meet with the least area beyond it goes first.
std::optional<std::array<Vec2, 4>> quadrilateral(std::vector<Vec2> v) {
  while (v.size() > 4) {
    const std::size_t n = v.size();
    std::size_t best = n;
    double least = INFINITY;
    Vec2 corner = Vec2::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 &a = v[(i + n - 1) % n], &b = v[i], &c = v[(i + 1) % n], &d = v[(i + 2) % n];
      const Vec2 in = b - a, out = c - d;
      const double turn = cross(in, -out);
      if (!(turn > 0)) continue;
      const Vec2 meets = b + in * (cross(c - b, out) / cross(in, out));
      const double area = 0.5 * std::abs(cross(meets - b, c - b));
      if (area < least) least = area, best = i, corner = meets;
    }
    if (best == n) return {};
    v[best] = corner;
    v.erase(v.begin() + std::ptrdiff_t((best + 1) % n));
  }
  if (v.size() < 4) return {};
  return std::array{v[0], v[1], v[2], v[3]};
}

/// Places in the unit square that a quadrilateral is the bilinear picture of.
Vec2 in_square(const std::array<Vec2, 4>& c, const Vec2& q) {
  Vec2 uv(0.5, 0.5);
  for (int k = 0; k < kRounds; ++k) {
    const double u = uv[0], v = uv[1];
    const Vec2 at = (1 - u) * (1 - v) * c[0] + u * (1 - v) * c[1] + u * v * c[2] + (1 - u) * v * c[3];
    Eigen::Matrix2d J;
    J.col(0) = (1 - v) * (c[1] - c[0]) + v * (c[2] - c[3]);
    J.col(1) = (1 - u) * (c[3] - c[0]) + u * (c[2] - c[1]);
    const Vec2 step = J.inverse() * (q - at);
    if (!step.allFinite() || !(step.norm() < 1e6)) return uv;
    uv += step;
    if (step.norm() < 1e-12) break;
  }
  return uv;
}

/// Numbers of the groups that values fall into, where the gaps between groups stand out; counts from 0.
struct Groups {
  std::vector<int> of;
  int count = 0;
  double clear = 0;  ///< least gap between groups against the widest within one
};
Groups groups_of(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> gaps;
  for (std::size_t k = 1; k < n; ++k) gaps.push_back(std::max(kLeastGap, values[order[k]] - values[order[k - 1]]));
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  Groups out{std::vector<int>(n), 1, 0};
  double least = INFINITY;
  for (std::size_t k = 0; k + 1 < sorted.size(); ++k)
    if (const double clear = sorted[k] / sorted[k + 1]; clear > out.clear)
      out.clear = clear, least = std::sqrt(sorted[k] * sorted[k + 1]);
  int group = 0;
  for (std::size_t k = 0; k < n; ++k) {
    group += k > 0 && gaps[k - 1] > least;
    out.of[order[k]] = group;
  }
  out.count = group + 1;
  return out;
}

/// Which point stands on each crossing; row by row.
struct Lattice {
  int rows = 0, columns = 0;
  Members at;
};

/// Ordering of the points of both flanks.
class Ordering {
 public:
  explicit Ordering(const std::vector<LoosePoint>& points) : points_(points) {}

  Result<OrderedPoints> run() {
    if (points_.size() < std::size_t(2 * kLeastLines * kLeastLines))
      return fail_at(points_.empty() ? SourcePosition{} : points_.back().at,
                     "{} points are no two flanks of at least {} x {} points", points_.size(), kLeastLines,
                     kLeastLines);
    if (auto doubled = check_doubled()) return *doubled;
    see_places();
    if (auto wrong = split()) return *wrong;
    if (auto wrong = find_sides()) return *wrong;
    OrderedPoints out;
    for (const int side : {1, -1}) {
      auto grid = grid_of(side);
      if (!grid) return grid.error();
      (side > 0 ? out.plus : out.minus) = std::move(*grid);
    }
    if (out.plus.rows != out.minus.rows || out.plus.columns != out.minus.columns) return unequal(out);
    return out;
  }

 private:
  [[nodiscard]] const Members& flank(int side) const { return side > 0 ? plus_ : minus_; }
  [[nodiscard]] const Sheet& sheet(int side) const { return side > 0 ? sheet_plus_ : sheet_minus_; }
  [[nodiscard]] std::string words(std::size_t k) const {
    return fmt::format("({:.4f}, {:.4f}, {:.4f})", points_[k].p.x(), points_[k].p.y(), points_[k].p.z());
  }

  /// Flanks of different size: which row or column of the larger one has no partner.
  [[nodiscard]] Diagnostic unequal(const OrderedPoints& out) const {
    const int less = out.plus.place.size() < out.minus.place.size() ? 1 : -1;
    const GridPoints &few = less > 0 ? out.plus : out.minus, &many = less > 0 ? out.minus : out.plus;
    const bool by_rows = few.rows < many.rows;
    const auto stations = [&](const GridPoints& g) {
      std::vector<double> at(std::size_t(by_rows ? g.rows : g.columns), 0.0);
      for (int i = 0; i < g.rows; ++i)
        for (int j = 0; j < g.columns; ++j)
          at[std::size_t(by_rows ? i : j)] +=
              meridian(g.place[g.index(i, j)]).dot(by_rows ? up_ : along_) / (by_rows ? g.columns : g.rows);
      return at;
    };
    const std::vector<double> have = stations(few), want = stations(many);
    std::size_t gone = 0;
    double least = INFINITY;
    for (std::size_t left_out = 0; left_out < want.size(); ++left_out) {
      double off = 0;
      for (std::size_t k = 0; k < std::min(have.size(), want.size() - 1); ++k)
        off += std::abs(have[k] - want[k + (k >= left_out)]);
      if (off < least) least = off, gone = left_out;
    }
    const char* kind = by_rows ? "row" : "column";
    const Vec3& there = many.place[by_rows ? many.index(int(gone), 0) : many.index(0, int(gone))];
    return fail_at(points_[flank(less).front()].at,
                   "flank 1 has {} rows x {} columns, flank -1 {} x {}: of flank {} the {} next to {} {} of the other, "
                   "at r {:.4f}, z {:.4f} mm, is missing",
                   out.plus.rows, out.plus.columns, out.minus.rows, out.minus.columns, less, kind, kind, gone,
                   radius(there), there.z());
  }

  [[nodiscard]] std::optional<Diagnostic> check_doubled() const {
    std::vector<std::size_t> order(points_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const Vec3 &p = points_[a].p, &q = points_[b].p;
      return std::tuple(p.x(), p.y(), p.z(), a) < std::tuple(q.x(), q.y(), q.z(), b);
    });
    for (std::size_t k = 1; k < order.size(); ++k) {
      const auto [first, second] = std::minmax(order[k - 1], order[k]);
      if ((points_[first].p - points_[second].p).norm() > kSamePlace) continue;
      return fail_at(points_[second].at, "the point {} stands in line {} already", words(second),
                     points_[first].at.line);
    }
    return {};
  }

  void see_places() {
    Vec3 middle = Vec3::Zero();
    for (const LoosePoint& point : points_) middle += point.p / std::max(radius(point.p), 1e-12);
    for (const LoosePoint& point : points_) {
      q_.push_back(meridian(point.p));
      azimuth_.push_back(angle_from_to(middle, point.p));
    }
  }

  void fit_sheets() {
    const auto degree = [](const Members& of) { return of.size() < 24 ? 2 : 3; };
    sheet_plus_ = Sheet(q_, azimuth_, plus_, degree(plus_));
    sheet_minus_ = Sheet(q_, azimuth_, minus_, degree(minus_));
  }

  /// By the side to which normals point.
  std::optional<Diagnostic> split_by_normals() {
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Vec3 &p = points_[k].p, &n = *points_[k].n;
      (p.x() * n.y() - p.y() * n.x() > 0 ? plus_ : minus_).push_back(k);
    }
    for (const int side : {1, -1})
      if (flank(side).size() < std::size_t(kLeastLines * kLeastLines))
        return fail_at(points_[flank(side).empty() ? 0 : flank(side).front()].at,
                       "{} of the normals i, j, k have a {} part along the azimuth: flank {} has no grid; both flanks "
                       "of one space are needed",
                       flank(side).size(), side > 0 ? "positive" : "negative", side);
    fit_sheets();
    return {};
  }

  /// By the two sheets that the points lie on: first on either side of the one in the middle.
  std::optional<Diagnostic> split_by_sheets() {
    Members all(points_.size());
    std::iota(all.begin(), all.end(), 0);
    const Sheet middle(q_, azimuth_, all, all.size() < 60 ? 2 : 3);
    for (const std::size_t k : all) (azimuth_[k] < middle.at(q_[k]) ? plus_ : minus_).push_back(k);
    for (int round = 0; round < kRounds; ++round) {
      if (std::min(plus_.size(), minus_.size()) < std::size_t(kLeastLines * kLeastLines)) return one_flank();
      fit_sheets();
      Members plus, minus;
      for (const std::size_t k : all) {
        const double to_plus = std::abs(azimuth_[k] - sheet_plus_.at(q_[k])),
                     to_minus = std::abs(azimuth_[k] - sheet_minus_.at(q_[k]));
        (to_plus <= to_minus ? plus : minus).push_back(k);
      }
      const bool same = plus == plus_;
      plus_ = std::move(plus);
      minus_ = std::move(minus);
      if (same) break;
    }
    if (std::min(plus_.size(), minus_.size()) < std::size_t(kLeastLines * kLeastLines)) return one_flank();
    return {};
  }
  [[nodiscard]] Diagnostic one_flank() const {
    return fail_at(points_.front().at,
                   "the points do not lie on two flanks, a space between them: both flanks of one space are needed");
  }

  std::optional<Diagnostic> split() {
    auto wrong = points_.front().n ? split_by_normals() : split_by_sheets();
    if (wrong) return wrong;
    double worst = 0;
    std::size_t at = 0;
    for (const int side : {1, -1})
      for (const std::size_t k : flank(side)) {
        const double gap = std::abs(sheet(1).at(q_[k]) - sheet(-1).at(q_[k])),
                     off = std::abs(azimuth_[k] - sheet(side).at(q_[k])) / gap;
        if (!(off <= worst)) worst = off, at = k;
      }
    if (worst <= kOffSheet) return {};
    return fail_at(points_[at].at,
                   "{} lies {:.1f} % of the space's width beside both flanks that the points make, limit {:.0f} %: "
                   "the points of one space on its two flanks are needed, smooth and without others",
                   words(at), 100 * worst, 100 * kOffSheet);
  }

  /// Arc from flank 1 to flank -1; positive: towards growing azimuth.
  [[nodiscard]] double width(const Vec2& q) const { return q.x() * (sheet(-1).at(q) - sheet(1).at(q)); }

  /// Of the space: which way is up, and which along.
  std::optional<Diagnostic> find_sides() {
    const auto sides = quadrilateral(border_of(q_));
    if (!sides) return fail_at(points_.front().at, "the points lie on one line of the meridian (r, z): no flank");
    const auto& c = *sides;
    std::array<double, 4> wide{};
    for (std::size_t k = 0; k < 4; ++k) wide[k] = width(0.5 * (c[k] + c[(k + 1) % 4]));
    const bool turned = wide[0] < 0;
    for (const double w : wide)
      if ((w < 0) != turned || w == 0) return fail_at(points_.front().at, "the flanks cross");
    const double first = std::abs(std::log(wide[0] / wide[2])), second = std::abs(std::log(wide[1] / wide[3]));
    std::size_t low = first > second ? 0 : 1;  // a side that is the root or the tip
    if (std::max(first, second) < std::log(kWidens))
      low = (c[1] - c[0]).norm() + (c[2] - c[3]).norm() > (c[2] - c[1]).norm() + (c[3] - c[0]).norm() ? 0 : 1;
    const auto middle = [&](std::size_t k) { return Vec2(0.5 * (c[k % 4] + c[(k + 1) % 4])); };
    up_ = (middle(low + 2) - middle(low)).normalized();
    bool widens = std::abs(wide[low + 2 < 4 ? low + 2 : low - 2]) > std::abs(wide[low]);
    const bool normals = points_.front().n.has_value(), flat = std::abs(up_.x()) < kFlat;
    if (flat ? up_.y() > 0 : up_.x() < 0) up_ = -up_, widens = !widens;
    if (flat && normals && !turned && !widens) up_ = -up_, widens = true;  // they say what a flat face does not
    along_ = middle(low + 1) - middle(low + 3);
    if (along_.x() + along_.y() < 0) along_ = -along_;
    const SourcePosition& at = points_.front().at;
    if (!widens && !(normals && turned))
      return fail_at(at,
                     "what lies between the flanks is narrower at the tip than at the root: they bound a tooth, not a "
                     "space{}{}. Turn one of them by a pitch about z",
                     flat ? ", or z points the other way" : "",
                     normals ? ", or the normals i, j, k point into the material" : "");
    if (!widens)
      return fail_at(at,
                     "the flanks bound a tooth, not a space: the flank whose normals have a positive part along the "
                     "azimuth must stand on the side of negative azimuth. Turn one of them by a pitch about z");
    if (turned)
      return fail_at(at,
                     "the normals i, j, k point into the material: those of the flank at {:.3f} deg, on the side of "
                     "negative azimuth of its space, must have a positive part along the azimuth{}",
                     degrees(azimuth(points_[minus_.front()].p)),
                     flat ? "; or the flanks bound a tooth whose tip lies towards growing z, and one of them must be "
                            "turned by a pitch about z"
                          : "");
    for (const int side : {1, -1})
      for (const std::size_t k : flank(side))
        if (points_[k].flank != 0 && points_[k].flank != side)
          return fail_at(points_[k].at,
                         "flank = {}, but the point lies on flank {}: flank 1 bounds the space on the side of negative "
                         "azimuth; the two are swapped",
                         points_[k].flank, side);
    return {};
  }

  /// Each point of a flank in the unit square: along the tooth, up.
  [[nodiscard]] Result<std::vector<Vec2>> squared(int side) const {
    std::vector<Vec2> q;
    for (const std::size_t k : flank(side)) q.push_back(q_[k]);
    auto c = quadrilateral(border_of(q));
    if (!c)
      return fail_at(points_[flank(side).front()].at,
                     "flank {}: its points lie on one line of the meridian (r, z): no grid", side);
    // The corner from which it goes along and then up.
    std::size_t start = 0;
    double least = INFINITY;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 way = (*c)[(k + 1) % 4] - (*c)[k], rise = (*c)[(k + 3) % 4] - (*c)[k];
      const double fits = -std::abs(way.dot(along_)) / way.norm() - std::abs(rise.dot(up_)) / rise.norm();
      const bool right =
          cross(along_, up_) > 0 ? way.dot(along_) > 0 && rise.dot(up_) > 0 : way.dot(along_) < 0 && rise.dot(up_) > 0;
      if (right && fits < least) least = fits, start = k;
    }
    std::rotate(c->begin(), c->begin() + std::ptrdiff_t(start), c->end());
    const bool back = cross(along_, up_) < 0;
    for (Vec2& p : q) {
      p = in_square(*c, p);
      if (back) p[0] = 1 - p[0];
    }
    return q;
  }

  /// Whether every four neighbours go round once.
  [[nodiscard]] static std::optional<std::array<int, 2>> folded(const Lattice& l, const std::vector<Vec2>& uv) {
    for (int i = 0; i + 1 < l.rows; ++i)
      for (int j = 0; j + 1 < l.columns; ++j) {
        const auto at = [&](int a, int b) { return uv[l.at[std::size_t((i + a) * l.columns + j + b)]]; };
        const std::array<Vec2, 4> c{at(0, 0), at(0, 1), at(1, 1), at(1, 0)};
        for (std::size_t k = 0; k < 4; ++k)
          if (!(cross(c[(k + 1) % 4] - c[k], c[(k + 2) % 4] - c[(k + 1) % 4]) > 0)) return std::array{i, j};
      }
    return {};
  }

  /// Lattices of every number of rows and columns, by columns whose points are ordered upwards or rows ordered along;
  /// for lines that bend. The one whose cells are nearest to parallelograms.
  [[nodiscard]] static std::optional<Lattice> bent(const std::vector<Vec2>& uv) {
    const int n = int(uv.size());
    std::optional<Lattice> best;
    double least = INFINITY;
    for (int columns = kLeastLines; columns <= n / kLeastLines; ++columns) {
      if (n % columns != 0) continue;
      for (const int first : {0, 1}) {
        const int rows = n / columns, group = first == 0 ? rows : columns;
        Members order(uv.size());
        std::iota(order.begin(), order.end(), 0);
        const auto by = [&](int axis) {
          return [&uv, axis](std::size_t a, std::size_t b) { return uv[a][axis] < uv[b][axis]; };
        };
        std::sort(order.begin(), order.end(), by(first));
        for (auto it = order.begin(); it != order.end(); it += group) std::sort(it, it + group, by(1 - first));
        Lattice l{rows, columns, Members(uv.size())};
        for (int k = 0; k < n; ++k)
          l.at[std::size_t(first == 0 ? k % rows * columns + k / rows : k)] = order[std::size_t(k)];
        if (folded(l, uv)) continue;
        double off = 0;
        for (int i = 0; i + 1 < rows; ++i)
          for (int j = 0; j + 1 < columns; ++j) {
            const auto at = [&](int a, int b) { return uv[l.at[std::size_t((i + a) * columns + j + b)]]; };
            off += (at(0, 0) + at(1, 1) - at(0, 1) - at(1, 0)).norm() * n / ((at(1, 1) - at(0, 0)).norm() + 1e-12) /
                   ((rows - 1) * (columns - 1));
          }
        if (off < least) least = off, best = std::move(l);
      }
    }
    return best;
  }

  /// By rows and columns that stand apart; refused with what is doubled or missing among them.
  [[nodiscard]] Result<Lattice> plain(int side, const std::vector<Vec2>& uv) const {
    std::vector<double> u, v;
    for (const Vec2& p : uv) u.push_back(p[0]), v.push_back(p[1]);
    const Groups columns = groups_of(u), rows = groups_of(v);
    const Members& of = flank(side);
    const auto cells = std::size_t(rows.count) * std::size_t(columns.count);
    if (columns.clear < kClearGap || rows.clear < kClearGap || rows.count < 2 || columns.count < 2 ||
        cells > 2 * uv.size() || 2 * cells < uv.size())
      return fail_at(points_[of.front()].at,
                     "flank {}: its {} points stand in no rows and columns; a grid has one point on every crossing",
                     side, of.size());
    Lattice l{rows.count, columns.count, Members(cells, uv.size())};
    for (std::size_t k = 0; k < uv.size(); ++k) {
      std::size_t& cell = l.at[std::size_t(rows.of[k] * l.columns + columns.of[k])];
      if (cell < uv.size())
        return fail_at(
            points_[of[k]].at,
            "flank {}: {} stands on row {}, column {} of the grid, as the point in line {} does: doubled, or "
            "off its row",
            side, words(of[k]), rows.of[k], columns.of[k], points_[of[cell]].at.line);
      cell = k;
    }
    for (std::size_t cell = 0; cell < cells; ++cell)
      if (l.at[cell] == uv.size()) return missing(side, l, cell);
    return l;
  }

  [[nodiscard]] Diagnostic missing(int side, const Lattice& l, std::size_t cell) const {
    const int row = int(cell) / l.columns, column = int(cell) % l.columns;
    const Members& of = flank(side);
    const auto empty = std::size_t(std::count(l.at.begin(), l.at.end(), of.size()));
    // The next one that is there, for the place.
    std::size_t next = of.size();
    double least = INFINITY;
    for (int i = 0; i < l.rows; ++i)
      for (int j = 0; j < l.columns; ++j) {
        const std::size_t k = l.at[std::size_t(i * l.columns + j)];
        if (k < of.size() && std::hypot(i - row, j - column) < least) least = std::hypot(i - row, j - column), next = k;
      }
    return fail_at(points_[of[next]].at,
                   "flank {}: row {}, column {} of {} rows x {} columns, which count from 0, is missing, next to {}{}",
                   side, row, column, l.rows, l.columns, words(of[next]),
                   empty > 1 ? fmt::format("; {} are missing in all", empty) : "");
  }

  Result<GridPoints> grid_of(int side) {
    const Members& of = flank(side);
    const auto uv = squared(side);
    if (!uv) return uv.error();
    auto found = plain(side, *uv);
    if (!found || folded(*found, *uv))
      if (auto other = bent(*uv)) found = std::move(*other);
    if (!found) return found.error();
    const Lattice& l = *found;
    if (std::min(l.rows, l.columns) < kLeastLines || std::max(l.rows, l.columns) > kMostLines)
      return fail_at(points_[of.front()].at,
                     "flank {} has {} rows and {} columns of points, {} to {} of each are needed", side, l.rows,
                     l.columns, kLeastLines, kMostLines);
    if (const auto at = folded(l, *uv)) {
      const std::size_t k = of[l.at[std::size_t((*at)[0] * l.columns + (*at)[1])]];
      return fail_at(points_[k].at, "flank {}: the grid folds between {} and its neighbours, row {}, column {}", side,
                     words(k), (*at)[0], (*at)[1]);
    }
    GridPoints grid;
    grid.rows = l.rows;
    grid.columns = l.columns;
    for (const std::size_t k : l.at) {
      const LoosePoint& point = points_[of[k]];
      grid.place.push_back(point.p);
      if (point.n) grid.normal.push_back(*point.n);
      grid.line.push_back(point.at.line);
    }
    if (auto gap = missing_line(side, grid, l)) return *gap;
    return grid;
  }

  /// A step between rows or columns that is nearly twice those beside it.
  [[nodiscard]] std::optional<Diagnostic> missing_line(int side, const GridPoints& grid, const Lattice& l) const {
    for (const bool by_rows : {true, false}) {
      const int count = by_rows ? grid.rows : grid.columns, across = by_rows ? grid.columns : grid.rows;
      const auto index = [&](int k, int m) { return by_rows ? grid.index(k, m) : grid.index(m, k); };
      std::vector<double> step;
      for (int k = 0; k + 1 < count; ++k) {
        double sum = 0;
        for (int m = 0; m < across; ++m) sum += (grid.place[index(k + 1, m)] - grid.place[index(k, m)]).norm();
        step.push_back(sum / across);
      }
      for (std::size_t k = 0; k < step.size(); ++k) {
        const double beside = std::max(k > 0 ? step[k - 1] : 0, k + 1 < step.size() ? step[k + 1] : 0);
        if (step[k] < kMissing * beside) continue;
        const std::size_t at = flank(side)[l.at[index(int(k) + 1, 0)]];
        return fail_at(
            points_[at].at,
            "flank {}: {} {} and {} are {:.4f} mm apart, {:.2f} times those beside them, limit {:g}: a {} is "
            "missing between them",
            side, by_rows ? "rows" : "columns", k, k + 1, step[k], step[k] / beside, kMissing,
            by_rows ? "row" : "column");
      }
    }
    return {};
  }

  const std::vector<LoosePoint>& points_;
  std::vector<Vec2> q_;
  std::vector<double> azimuth_;
  Members plus_, minus_;
  Sheet sheet_plus_, sheet_minus_;
  Vec2 up_ = Vec2::Zero(), along_ = Vec2::Zero();
};

/// Slope and height of the line through (x, y).
std::array<double, 2> line_through(const std::vector<Vec2>& places) {
  Vec2 middle = Vec2::Zero();
  for (const Vec2& p : places) middle += p / double(places.size());
  double xx = 0, xy = 0;
  for (const Vec2& p : places)
    xx += (p.x() - middle.x()) * (p.x() - middle.x()), xy += (p.x() - middle.x()) * (p.y() - middle.y());
  const double slope = xy / xx;
  return {slope, middle.y() - slope * middle.x()};
}

/// Where none is given, by its neighbours.
Vec3 normal_at(const GridPoints& g, int side, int row, int column) {
  if (!g.normal.empty()) return g.normal[g.index(row, column)];
  const int left = std::max(column - 1, 0), right = std::min(column + 1, g.columns - 1);
  const Vec3 p = g.place[g.index(row, column)], up = g.place[g.index(row + 1, column)] - p,
             way = g.place[g.index(row, right)] - g.place[g.index(row, left)], n = up.cross(way).normalized();
  return (p.x() * n.y() - p.y() * n.x()) * side > 0 ? n : Vec3(-n);
}

}  // namespace

Result<OrderedPoints> order_points(const std::vector<LoosePoint>& points) { return Ordering(points).run(); }

MeridianProposal::MeridianProposal(const OrderedPoints& points) {
  Vec2 up = Vec2::Zero();
  for (const GridPoints* g : {&points.plus, &points.minus})
    for (const int j : {0, g->columns - 1})
      up += (meridian(g->place[g->index(g->rows - 1, j)]) - meridian(g->place[g->index(0, j)])).normalized();
  up_ = up.normalized();
  along_ = Vec2(-up_.y(), up_.x());
  if (along_.x() + along_.y() < 0) along_ = -along_;
  from_.s = INFINITY;
  to_.s = -INFINITY;
  width_ = INFINITY;
  std::vector<Vec2> first, last;
  std::array<std::vector<Vec2>, 2> end;  // (h, s) of the outermost columns
  for (const int side : {1, -1}) {
    const GridPoints& g = side > 0 ? points.plus : points.minus;
    for (int j = 0; j < g.columns; ++j) {
      const Vec3 &foot = g.place[g.index(0, j)], &top = g.place[g.index(g.rows - 1, j)];
      const Vec3 n = normal_at(g, side, 0, j);
      feet_.push_back({meridian(foot), {(n.x() * foot.x() + n.y() * foot.y()) / radius(foot), n.z()}});
      first.emplace_back(meridian(foot).dot(along_), meridian(foot).dot(up_));
      last.emplace_back(meridian(top).dot(along_), meridian(top).dot(up_));
      if (side < 0 && j < points.plus.columns)
        width_ =
            std::min(width_, radius(foot) * std::abs(angle_from_to(points.plus.place[points.plus.index(0, j)], foot)));
    }
    for (const Vec3& p : g.place) {
      const double s = meridian(p).dot(along_);
      from_.s = std::min(from_.s, s);
      to_.s = std::max(to_.s, s);
      outer_ = std::max(outer_, radius(p));
    }
  }
  for (const GridPoints* g : {&points.plus, &points.minus}) {
    const auto at = [&](int row, int column) {
      const Vec2 p = meridian(g->place[g->index(row, column)]);
      return Vec2(p.dot(up_), p.dot(along_));
    };
    const bool rises = at(0, g->columns - 1).y() > at(0, 0).y();
    for (int i = 0; i < g->rows; ++i)
      for (const bool high : {false, true}) end[high].push_back(at(i, high == rises ? g->columns - 1 : 0));
  }
  for (const bool high : {false, true}) {
    const double lean = line_through(end[high])[0];
    double low_h = INFINITY, high_h = -INFINITY, outermost = high ? -INFINITY : INFINITY;
    for (const Vec2& p : end[high]) {
      low_h = std::min(low_h, p.x());
      high_h = std::max(high_h, p.x());
      const double s = p.y() - lean * p.x();
      outermost = high ? std::max(outermost, s) : std::min(outermost, s);
    }
    if (std::abs(lean) * (high_h - low_h) > kSquareEnds) (high ? to_ : from_) = {outermost, lean};
  }
  foot_slope_ = line_through(first)[0];
  const auto [slope, height] = line_through(last);
  tip_slope_ = slope;
  tip_ = height;
  for (const Vec2& p : last) tip_ = std::max(tip_, p.y() - slope * p.x());
}

std::vector<Vec2> MeridianProposal::ends(double height, double slope) const {
  std::vector<Vec2> out;
  for (const End& end : {from_, to_}) {
    const double s = (end.s + end.lean * height) / (1 - end.lean * slope);
    out.push_back(s * along_ + (height + slope * s) * up_);
  }
  return out;
}

std::vector<Vec2> MeridianProposal::root(double fillet_radius_mm) const {
  const double steep = std::hypot(1, foot_slope_);
  double sum = 0;
  for (const Foot& foot : feet_) {
    const Vec2 centre = foot.q + fillet_radius_mm * foot.n;
    sum += centre.dot(up_) - foot_slope_ * centre.dot(along_) - fillet_radius_mm * steep;
  }
  return ends(sum / double(feet_.size()), foot_slope_);
}

double MeridianProposal::fillet_radius_mm(const std::vector<Vec2>& root) const {
  const Vec2 way = (root.back() - root.front()).normalized();
  Vec2 out(-way.y(), way.x());
  if (out.dot(up_) < 0) out = -out;
  double sum = 0;
  for (const Foot& foot : feet_) sum += (foot.q - root.front()).dot(out) / (1 - foot.n.dot(out));
  return sum / double(feet_.size());
}

}  // namespace toothpath::flank_grid
