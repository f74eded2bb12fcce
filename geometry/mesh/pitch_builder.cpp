#include "geometry/mesh/pitch_builder.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/base/angle.h"

namespace toothpath::mesh {
namespace {

constexpr double kSame_mm = 1e-9;      ///< vertices of one row that are closer are one vertex
constexpr double kMargin = 1.15;       ///< on the measured sag
constexpr double kFootModules = 0.25;  ///< how far below the root an end face ends and the body begins
constexpr double kLeastFoot = 1e-3;    ///< of the mean step of a row: between the feet of an end face
constexpr double kClear = 1.01;        ///< of the turn that leads a line of an end face out of the space
constexpr double kTurnShare = 0.25;    ///< of the tolerance: sag of a facet by the turn between two rows of the body

using Index = std::int32_t;

/// Distance of p to the triangle a, b, c.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, n = ab.cross(ac), ap = p - a;
  const double n2 = n.squaredNorm();
  if (n2 > 0) {
    const double v = ap.cross(ac).dot(n), w = ab.cross(ap).dot(n);  // barycentric times n2
    if (v >= 0 && w >= 0 && v + w <= n2) return std::abs(ap.dot(n)) / std::sqrt(n2);
  }
  const auto to_edge = [&](const Vec3& q, const Vec3& e) {
    const Vec3 d = p - q;
    const double e2 = e.squaredNorm(), t = e2 > 0 ? std::clamp(d.dot(e) / e2, 0.0, 1.0) : 0.0;
    return (d - t * e).norm();
  };
  return std::min({to_edge(a, ab), to_edge(a, ac), to_edge(b, c - b)});
}

}  // namespace

/// Exact points on every line of the section, or (shift in (0, 1)) that far into every cell; in column order.
Result<std::vector<SectionPoint>> PitchBuilder::exact_row(const ToothSection& section, double shift) const {
  std::vector<SectionPoint> points;
  points.reserve(columns_.size());
  for (const GridColumn& c : columns_) {
    const auto p = section.point(c.segment, shift == 0 ? c.from : c.from + shift * (c.to - c.from));
    if (!p) return fail("{} is not defined at {}", to_string(segment_patch(c.segment)), section.station());
    points.push_back(*p);
  }
  return points;
}

/// Adds the vertices of one row. The last column is the first one turned by a pitch; coincident neighbours are one
/// vertex; where the row meets `shared` at height `shared_h`, that row's vertices are taken. On the axis all are one.
PitchBuilder::Row PitchBuilder::add_row(std::vector<Vec3> points, const Row* shared, double shared_h) {
  Row row;
  const std::size_t n = points.size();
  row.index.assign(n, -1);
  const auto same = [&](std::size_t a, std::size_t b) { return (points[a] - points[b]).norm() <= kSame_mm; };
  if (shared)
    for (std::size_t j = 0; j < n; ++j)
      if (std::abs(h_of(*shared, j) - shared_h) <= kSame_mm) row.index[j] = shared->index[j];
  const auto add = [&](const Vec3& p, Index from) {
    out_.mesh.vertices.push_back(p);
    out_.turned_from.push_back(from);
    return Index(out_.mesh.vertices.size() - 1);
  };
  if (radius(points[0]) == 0) {
    row.index.assign(n, Index(out_.mesh.vertices.size()));
    add(points[0], row.index[0]);
    return row;
  }
  if (row.index[0] < 0) row.index[0] = add(points[0], -1);
  if (row.index[n - 1] < 0) row.index[n - 1] = add(turned_by_pitches(points[0], 1, out_.teeth), row.index[0]);
  for (std::size_t j = n - 1; j-- > 1 && row.index[j] < 0 && same(j, j + 1);) row.index[j] = row.index[j + 1];
  for (std::size_t j = 1; j + 1 < n; ++j)
    if (row.index[j] < 0) row.index[j] = same(j, j - 1) ? row.index[j - 1] : add(points[j], -1);
  return row;
}

/// The azimuths of a profile row at a corner (s, h) of the meridian, turned column by column.
PitchBuilder::Row PitchBuilder::row_at(const Row& profile, const Vec2& corner, const std::vector<double>& turns) {
  const double r = chart_.r(corner.x(), corner.y()), z = chart_.z(corner.x(), corner.y());
  std::vector<Vec3> points;
  for (std::size_t j = 0; j < profile.index.size(); ++j) {
    const Vec3& p = at(profile, j);
    const double own = radius(p), scale = std::abs(own - r) <= kSame_mm ? 1 : r / own;
    const Vec3 placed(scale * p.x(), scale * p.y(), z);
    const double foot = profile.feet.empty() ? 0 : profile.feet[j];
    points.push_back(turns.empty() && foot == 0 ? placed : turned(placed, (turns.empty() ? 0 : turns[j]) + foot));
  }
  const bool below = std::abs(corner.x() - s_of(profile)) <= kSame_mm;
  return add_row(std::move(points), below ? &profile : nullptr, corner.y());
}

/// The row straight below a profile row.
PitchBuilder::Row PitchBuilder::row_below(const Row& profile, double h) { return row_at(profile, {s_of(profile), h}); }

Result<PitchBuilder::RingRows> PitchBuilder::add_ring(std::size_t ring, const std::vector<double>& stations) {
  RingRows rows;
  std::optional<ToothSection> near;
  const auto section_at = [&](double s) {
    return ToothSection::at(*gear_.rings[ring].space, s, near ? &*near : nullptr);
  };
  for (std::size_t i = 0; i < stations.size(); ++i) {
    auto section = section_at(stations[i]);
    if (!section) return section.error();
    near = *section;
    const auto points = exact_row(*near, 0);
    if (!points) return points.error();
    std::vector<Vec3> places;
    std::vector<Vec2> uv;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      places.push_back((*points)[j].p);
      uv.push_back((*points)[j].uv);
      if (j + 1 == columns_.size() || columns_[j + 1].segment != columns_[j].segment)
        uv.push_back(near->point(columns_[j].segment, 1)->uv);
    }
    places.push_back(turned_by_pitches(places.front(), 1, out_.teeth));
    rows.rows.push_back(add_row(std::move(places)));
    rows.rows.back().uv = std::move(uv);
  }
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    auto middle = section_at(0.5 * (stations[i] + stations[i + 1]));
    if (!middle) return middle.error();
    near = *middle;
    const auto centres = exact_row(*near, 0.5);
    if (!centres) return centres.error();
    std::vector<char> falling;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const Vec3 &p00 = at(rows.rows[i], j), &p01 = at(rows.rows[i], j + 1);
      const Vec3 &p10 = at(rows.rows[i + 1], j), &p11 = at(rows.rows[i + 1], j + 1), q = (*centres)[j].p;
      const Vec3 n = (p11 - p00).cross(p01 - p10);
      const double rise = std::abs(n.dot(q - 0.5 * (p00 + p11))), fall = std::abs(n.dot(q - 0.5 * (p10 + p01)));
      falling.push_back(fall < rise);
    }
    rows.falling.push_back(std::move(falling));
  }
  return rows;
}

void PitchBuilder::add_triangle(Index a, Index b, Index c, const TriangleTag& tag) {
  if (a == b || b == c || c == a) return;  // a segment of no width
  out_.mesh.triangles.push_back({a, b, c});
  out_.tags.push_back(tag);
}

void PitchBuilder::add_surface_strip(const RingRows& ring, std::size_t strip, std::uint8_t zone) {
  const Row &in = ring.rows[strip], &out = ring.rows[strip + 1];
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Piece patch = segment_patch(columns_[j].segment);
    const std::size_t u = columns_[j].slot;
    const Index i00 = in.index[j], i01 = in.index[j + 1], i10 = out.index[j], i11 = out.index[j + 1];
    if (ring.falling[strip][j]) {
      add_triangle(i00, i10, i01, {patch, zone, {in.uv[u], out.uv[u], in.uv[u + 1]}});
      add_triangle(i10, i11, i01, {patch, zone, {out.uv[u], out.uv[u + 1], in.uv[u + 1]}});
    } else {
      add_triangle(i00, i10, i11, {patch, zone, {in.uv[u], out.uv[u], out.uv[u + 1]}});
      add_triangle(i00, i11, i01, {patch, zone, {in.uv[u], out.uv[u + 1], in.uv[u + 1]}});
    }
  }
}

/// A strip of a surface of revolution between two rows; the azimuth runs on from column to column.
void PitchBuilder::add_plain_strip(const Row& from, const Row& to, Piece patch, std::uint8_t zone) {
  const Vec3 way = at(to, 0) - at(from, 0);
  const bool v_is_z = std::abs(way.z()) > std::abs(radius(at(to, 0)) - radius(at(from, 0)));
  const auto sags = [&](double r, double turn) {
    turned_sag_ = std::max(turned_sag_, 2 * r * std::pow(std::sin(turn / 4), 2));
  };
  const auto coordinates = [&](const Row& row) {
    std::vector<Vec2> uv;
    double azimuth = std::atan2(at(row, 0).y(), at(row, 0).x());
    for (std::size_t j = 0; j < row.index.size(); ++j) {
      const double turn = j > 0 ? angle_from_to(at(row, j - 1), at(row, j)) : 0.0;
      const double r = std::hypot(at(row, j).x(), at(row, j).y());
      azimuth += turn;
      sags(r, turn);
      uv.emplace_back(azimuth, v_is_z ? at(row, j).z() : r);
    }
    return uv;
  };
  std::vector<Vec2> u0 = coordinates(from), u1 = coordinates(to);
  const double turns = 2 * kPi * std::round((u0[0].x() - u1[0].x()) / (2 * kPi));
  for (Vec2& u : u1) u.x() += turns;
  const bool plane = std::abs(way.z()) <= kSame_mm;
  const auto edge = [&](const Vec3& a, const Vec3& b) {
    if (!plane) sags(std::max(radius(a), radius(b)), angle_from_to(a, b));
  };
  for (std::size_t j = 0; j + 1 < from.index.size(); ++j) {
    const Index i00 = from.index[j], i01 = from.index[j + 1], i10 = to.index[j], i11 = to.index[j + 1];
    const bool falling = (at(to, j) - at(from, j + 1)).squaredNorm() < (at(to, j + 1) - at(from, j)).squaredNorm();
    edge(at(from, j), at(to, j));
    if (falling) {
      edge(at(to, j), at(from, j + 1));
      add_triangle(i00, i10, i01, {patch, zone, {u0[j], u1[j], u0[j + 1]}});
      add_triangle(i10, i11, i01, {patch, zone, {u1[j], u1[j + 1], u0[j + 1]}});
    } else {
      edge(at(from, j), at(to, j + 1));
      add_triangle(i00, i10, i11, {patch, zone, {u0[j], u1[j], u1[j + 1]}});
      add_triangle(i00, i11, i01, {patch, zone, {u0[j], u1[j + 1], u0[j + 1]}});
    }
  }
}

/// Where a flank overhangs at the end of the teeth, the lines of the end face from the row down to what is turned below
/// it would cross the space: they are led away from it, from the root to both sides, no farther than each needs.
/// @param lowest  h of what is turned
Status PitchBuilder::stand(Row& end, double lowest) const {
  const std::size_t n = end.index.size();
  std::vector<double> azimuth{0}, h;
  bool overhangs = false;
  for (std::size_t j = 0; j < n; ++j) {
    h.push_back(h_of(end, j));
    if (j == 0) continue;
    const double step = angle_from_to(at(end, j - 1), at(end, j));
    azimuth.push_back(azimuth.back() + step);
    overhangs = overhangs || (end.index[j - 1] != end.index[j] && !(step > 0));
  }
  if (!overhangs) return Ok{};
  const auto root = std::size_t(std::min_element(h.begin(), h.end()) - h.begin());
  end.feet.assign(n, 0);
  const double gap = kLeastFoot * azimuth.back() / double(n);
  for (const int side : {1, -1}) {  // towards the plus flank azimuths fall, towards the minus flank they grow
    double last = azimuth[root];
    const std::size_t count = side > 0 ? root : n - 1 - root;
    for (std::size_t k = 1; k <= count; ++k) {
      const std::size_t j = side > 0 ? root - k : root + k;
      double foot = side * azimuth[j];
      for (std::size_t i = 1; i < k; ++i) {
        const std::size_t below = side > 0 ? root - i : root + i;
        const double over = side * (azimuth[j] - azimuth[below]), fall = h[j] - h[below];
        if (over > 0 && fall > 0) foot = std::min(foot, side * azimuth[j] - kClear * over * (h[j] - lowest) / fall);
      }
      if (end.index[j] != end.index[side > 0 ? j + 1 : j - 1]) foot = std::min(foot, side * last - gap);
      else foot = side * last;
      end.feet[j] = side * foot - azimuth[j];
      last = side * foot;
    }
    if (end.feet[side > 0 ? 0 : n - 1] != 0)
      return fail("the flank overhangs too far at the end of the teeth, radius {:.4f} mm: the tooth has no foot there",
                  radius(at(end, root)));
  }
  return Ok{};
}

/// What is turned must lie below the tooth spaces at the end of a ring.
Status PitchBuilder::below_the_teeth(const Row& end, double h, const char* what) const {
  for (std::size_t j = 0; j < end.index.size(); ++j)
    if (h_of(end, j) < h - kSame_mm)
      return fail("{} at height {:.4f} mm lies above the tooth space beside it ({:.4f} mm)", what, h, h_of(end, j));
  return Ok{};
}

/// Where the end face of a ring goes over into the body: below the roots, where there is room.
std::optional<PitchBuilder::Row> PitchBuilder::foot_of(const Row& profile, double corner_h) {
  double lowest = INFINITY;
  for (std::size_t j = 0; j < profile.index.size(); ++j) lowest = std::min(lowest, h_of(profile, j));
  const double h = lowest - kFootModules * gear_.module_mm;
  if (h <= corner_h + kSame_mm) return {};
  return row_below(profile, h);
}

/// Rows from `from`, at the first of the corners, to that of the next ring's `profile` at the last one: they turn from
/// the azimuths of the one to those of the other on the first stretch, where facets between the two would leave the
/// surface in steps.
std::vector<PitchBuilder::Row> PitchBuilder::turned_rows(const Row& from, const Row& profile,
                                                         const std::vector<Vec2>& corners) {
  const double first = angle_from_to(at(from, 0), at(profile, 0));
  std::vector<double> turns(from.index.size());
  double most = 0;
  for (std::size_t j = 0; j < turns.size(); ++j) {
    const double foot = profile.feet.empty() ? 0 : profile.feet[j];
    turns[j] = first + wrapped(angle_from_to(at(from, j), at(profile, j)) + foot - first);
    most = std::max(most, std::abs(turns[j]));
  }
  const Vec2 &a = corners[0], &b = corners[1];
  const double r_a = chart_.r(a.x(), a.y()), r_b = chart_.r(b.x(), b.y()), r = std::max(r_a, r_b);
  double allowed = 4 * std::asin(std::sqrt(std::min(1.0, kTurnShare * out_.tolerance_mm / (2 * r))));
  // In a plane facets must only keep out of the circle inside.
  if (std::abs(chart_.z(a.x(), a.y()) - chart_.z(b.x(), b.y())) <= kSame_mm)
    allowed = std::max(allowed, 0.5 * std::acos(std::min(r_a, r_b) / r));
  const auto steps = r > 0 ? std::max<std::size_t>(1, std::size_t(std::ceil(most / allowed))) : 1;
  std::vector<Row> rows;
  for (std::size_t k = 1; k < steps; ++k) {
    const double t = double(k) / double(steps);
    std::vector<double> part = turns;
    for (double& turn : part) turn *= t;
    rows.push_back(row_at(from, a + t * (b - a), part));
  }
  for (std::size_t k = 1; k < corners.size(); ++k) rows.push_back(row_at(profile, corners[k]));
  return rows;
}

/// From the end of a ring to the next one.
Status PitchBuilder::add_groove(std::size_t ring) {
  const Row &end = rings_[ring].rows.back(), &next = rings_[ring + 1].rows.front();
  const auto& corners = gear_.corners[ring];
  if (const auto s = below_the_teeth(end, corners.front().y(), "the groove's floor"); !s) return s;
  if (const auto s = below_the_teeth(next, corners.back().y(), "the groove's floor"); !s) return s;
  if (!(s_of(next) - s_of(end) > kSame_mm))
    return fail("groove width = 0 between ring {} and ring {}: a solid needs a gap", ring, ring + 1);
  const auto zone = std::uint8_t(ring);
  std::vector<Row> rows{row_at(end, corners.front())};
  for (Row& row : turned_rows(rows.front(), next, corners)) rows.push_back(std::move(row));
  add_plain_strip(end, rows.front(), Piece::end, zone);
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) add_plain_strip(rows[k], rows[k + 1], Piece::groove, zone);
  add_plain_strip(rows.back(), next, Piece::end, std::uint8_t(ring + 1));
  return Ok{};
}

/// From the end of the last ring along the body to the begin of the first.
Status PitchBuilder::add_body() {
  const Row &end = rings_.back().rows.back(), &next = rings_.front().rows.front();
  const auto& corners = gear_.corners.back();
  if (const auto s = below_the_teeth(end, corners.front().y(), "the body"); !s) return s;
  if (const auto s = below_the_teeth(next, corners.back().y(), "the body"); !s) return s;
  const auto last = std::uint8_t(rings_.size() - 1);
  const auto foot = foot_of(end, corners.front().y());
  std::vector<Row> rows{row_at(end, corners.front())};
  for (Row& row : turned_rows(rows.front(), next, corners)) rows.push_back(std::move(row));
  const auto next_foot = foot_of(next, corners.back().y());
  add_plain_strip(end, foot ? *foot : rows.front(), Piece::end, last);
  if (foot) add_plain_strip(*foot, rows.front(), Piece::body, last);
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) add_plain_strip(rows[k], rows[k + 1], Piece::body, 0);
  if (next_foot) add_plain_strip(rows.back(), *next_foot, Piece::body, 0);
  add_plain_strip(next_foot ? *next_foot : rows.back(), next, Piece::end, 0);
  return Ok{};
}

Status PitchBuilder::build() {
  for (std::size_t k = 0; k < gear_.rings.size(); ++k) {
    auto rows = add_ring(k, grid_.stations[k]);
    if (!rows) return rows.error();
    rings_.push_back(std::move(*rows));
    const double module = kFootModules * gear_.module_mm;
    const auto& before = gear_.corners[k == 0 ? gear_.rings.size() - 1 : k - 1];
    const auto& after = gear_.corners[k];
    auto& own = rings_.back().rows;
    for (auto [end, corner, body] : {std::tuple(&own.front(), before.back().y(), k == 0),
                                     {&own.back(), after.front().y(), k + 1 == gear_.rings.size()}}) {
      double root = INFINITY;
      for (std::size_t j = 0; j < end->index.size(); ++j) root = std::min(root, h_of(*end, j));
      if (const auto s = stand(*end, body ? std::max(corner, root - module) : corner); !s) return s;
    }
  }
  for (std::size_t k = 0; k < rings_.size(); ++k) {
    for (std::size_t i = 0; i < rings_[k].falling.size(); ++i) add_surface_strip(rings_[k], i, std::uint8_t(k));
    if (k + 1 < rings_.size())
      if (const auto s = add_groove(k); !s) return s;
  }
  return add_body();
}

/// Distance of p to the triangles of the cell and, if that is more than `enough`, of its neighbours.
double PitchBuilder::distance_near(const RingRows& ring, std::size_t strip, std::size_t column, const Vec3& p,
                                   double enough) const {
  const auto to_cell = [&](std::size_t i, std::size_t j) {
    const Vec3 &p00 = at(ring.rows[i], j), &p01 = at(ring.rows[i], j + 1);
    const Vec3 &p10 = at(ring.rows[i + 1], j), &p11 = at(ring.rows[i + 1], j + 1);
    return ring.falling[i][j]
               ? std::min(distance_to_triangle(p, p00, p10, p01), distance_to_triangle(p, p10, p11, p01))
               : std::min(distance_to_triangle(p, p00, p10, p11), distance_to_triangle(p, p00, p11, p01));
  };
  double best = to_cell(strip, column);
  const std::size_t i_end = std::min(strip + 2, ring.falling.size()), j_end = std::min(column + 2, columns_.size());
  for (std::size_t i = strip - std::min<std::size_t>(strip, 1); i < i_end; ++i)
    for (std::size_t j = column - std::min<std::size_t>(column, 1); j < j_end && best > enough; ++j)
      best = std::min(best, to_cell(i, j));
  return best;
}

Result<std::array<double, tooth_space::kSurfaces>> PitchBuilder::measure_sag(int n) const {
  std::array<double, tooth_space::kSurfaces> sag{};
  for (std::size_t k = 0; k < rings_.size(); ++k) {
    const auto& stations = grid_.stations[k];
    std::optional<ToothSection> near;
    for (std::size_t i = 0; i + 1 < stations.size(); ++i)
      for (int a = 0; a < n + (i + 2 == stations.size() ? 1 : 0); ++a) {
        const double s =
            a == n ? stations[i + 1] : stations[i] + (stations[i + 1] - stations[i]) * double(a) / double(n);
        auto section = ToothSection::at(*gear_.rings[k].space, s, near ? &*near : nullptr);
        if (!section) return section.error();
        near = *section;
        for (int b = 0; b < n; ++b) {
          if (a % n == 0 && b == 0) continue;  // a vertex
          const auto row = exact_row(*near, double(b) / double(n));
          if (!row) return row.error();
          for (std::size_t j = 0; j < columns_.size(); ++j) {
            double& worst = sag[std::size_t(segment_patch(columns_[j].segment))];
            worst = std::max(worst, distance_near(rings_[k], i, j, (*row)[j].p, worst));
          }
        }
      }
  }
  // The end faces are exact below outlines that are as good as the surfaces above them.
  const double surface = *std::max_element(sag.begin(), sag.end());
  sag[std::size_t(Piece::end)] = std::max(surface, turned_sag_);
  sag[std::size_t(Piece::body)] = turned_sag_;
  if (rings_.size() > 1) sag[std::size_t(Piece::groove)] = turned_sag_;
  for (double& s : sag) s *= kMargin;
  return sag;
}

}  // namespace toothpath::mesh
