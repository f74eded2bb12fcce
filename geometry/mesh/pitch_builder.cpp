#include "geometry/mesh/pitch_builder.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::mesh {
namespace {

constexpr double kSame_mm = 1e-9;      ///< vertices of one row that are closer are one vertex
constexpr double kMargin = 1.15;       ///< on the measured sag
constexpr double kFootModules = 0.25;  ///< how far below the root an end face ends and the body begins

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
    if (!p) return fail("{} is not defined at radius {:.4f} mm", to_string(segment_patch(c.segment)), section.radius());
    points.push_back(*p);
  }
  return points;
}

/// Adds the vertices of one row. The last column is the first one turned by a pitch; coincident neighbours are one
/// vertex; where the row meets `shared` at height `shared_z`, that row's vertices are taken.
PitchBuilder::Row PitchBuilder::add_row(std::vector<Vec3> points, const Row* shared, double shared_z) {
  Row row;
  const std::size_t n = points.size();
  row.index.assign(n, -1);
  const auto same = [&](std::size_t a, std::size_t b) { return (points[a] - points[b]).norm() <= kSame_mm; };
  if (shared)
    for (std::size_t j = 0; j < n; ++j)
      if (std::abs(at(*shared, j).z() - shared_z) <= kSame_mm) row.index[j] = shared->index[j];
  const auto add = [&](const Vec3& p, Index from) {
    out_.mesh.vertices.push_back(p);
    out_.turned_from.push_back(from);
    return Index(out_.mesh.vertices.size() - 1);
  };
  if (row.index[0] < 0) row.index[0] = add(points[0], -1);
  if (row.index[n - 1] < 0) row.index[n - 1] = add(turned_by_pitches(points[0], 1, out_.teeth), row.index[0]);
  for (std::size_t j = n - 1; j-- > 1 && row.index[j] < 0 && same(j, j + 1);) row.index[j] = row.index[j + 1];
  for (std::size_t j = 1; j + 1 < n; ++j)
    if (row.index[j] < 0) row.index[j] = same(j, j - 1) ? row.index[j - 1] : add(points[j], -1);
  return row;
}

/// The row straight below a profile row, at height z.
PitchBuilder::Row PitchBuilder::row_below(const Row& profile, double z) {
  std::vector<Vec3> points;
  for (std::size_t j = 0; j < profile.index.size(); ++j) points.emplace_back(at(profile, j).x(), at(profile, j).y(), z);
  return add_row(std::move(points), &profile, z);
}

Result<PitchBuilder::RingRows> PitchBuilder::add_ring(std::size_t zone, const std::vector<double>& radii) {
  RingRows rows;
  std::optional<ToothSection> near;
  const auto section_at = [&](double r) {
    return ToothSection::at(gear_.drawn(zone), out_.teeth, r, near ? &*near : nullptr);
  };
  for (std::size_t i = 0; i < radii.size(); ++i) {
    auto section = section_at(radii[i]);
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
  for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
    auto middle = section_at(0.5 * (radii[i] + radii[i + 1]));
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

/// A strip of a cylinder or plane between two rows; the azimuth runs on from column to column.
void PitchBuilder::add_plain_strip(const Row& from, const Row& to, Piece patch, std::uint8_t zone, bool v_is_z) {
  const auto coordinates = [&](const Row& row) {
    std::vector<Vec2> uv;
    double azimuth = std::atan2(at(row, 0).y(), at(row, 0).x());
    for (std::size_t j = 0; j < row.index.size(); ++j) {
      const double turn = j > 0 ? angle_from_to(at(row, j - 1), at(row, j)) : 0.0;
      const double r = std::hypot(at(row, j).x(), at(row, j).y());
      azimuth += turn;
      cylinder_sag_ = std::max(cylinder_sag_, 2 * r * std::pow(std::sin(turn / 4), 2));
      uv.emplace_back(azimuth, v_is_z ? at(row, j).z() : r);
    }
    return uv;
  };
  std::vector<Vec2> u0 = coordinates(from), u1 = coordinates(to);
  const double turns = 2 * kPi * std::round((u0[0].x() - u1[0].x()) / (2 * kPi));
  for (Vec2& u : u1) u.x() += turns;
  for (std::size_t j = 0; j + 1 < from.index.size(); ++j) {
    const Index i00 = from.index[j], i01 = from.index[j + 1], i10 = to.index[j], i11 = to.index[j + 1];
    const bool falling = (at(to, j) - at(from, j + 1)).squaredNorm() < (at(to, j + 1) - at(from, j)).squaredNorm();
    if (falling) {
      add_triangle(i00, i10, i01, {patch, zone, {u0[j], u1[j], u0[j + 1]}});
      add_triangle(i10, i11, i01, {patch, zone, {u1[j], u1[j + 1], u0[j + 1]}});
    } else {
      add_triangle(i00, i10, i11, {patch, zone, {u0[j], u1[j], u1[j + 1]}});
      add_triangle(i00, i11, i01, {patch, zone, {u0[j], u1[j + 1], u0[j + 1]}});
    }
  }
}

Status PitchBuilder::check_no_overhang(const Row& row, double r) const {
  for (std::size_t j = 0; j + 1 < row.index.size(); ++j)
    if (row.index[j] != row.index[j + 1] && !(angle_from_to(at(row, j), at(row, j + 1)) > 0))
      return fail("the flank overhangs at the end of the teeth, radius {:.4f} mm, height {:.4f} mm", r, at(row, j).z());
  return Ok{};
}

Status PitchBuilder::build() {
  const auto& rings = gear_.rings();
  const double m = gear_.parameters().module_mm;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    auto rows = add_ring(k, grid_.radii[k]);
    if (!rows) return rows.error();
    rings_.push_back(std::move(*rows));
    for (const Row* end : {&rings_.back().rows.front(), &rings_.back().rows.back()}) {
      const auto fine = check_no_overhang(*end, std::hypot(at(*end, 0).x(), at(*end, 0).y()));
      if (!fine) return fine.error();
    }
  }
  const double floor = rings.size() > 1 ? gear_.groove_floor() : 0, z_base = underside_z(gear_);

  for (std::size_t k = 0; k < rings.size(); ++k) {
    const auto zone = std::uint8_t(k);
    const RingRows& ring = rings_[k];
    for (std::size_t i = 0; i < ring.falling.size(); ++i) add_surface_strip(ring, i, zone);
    if (k + 1 == rings.size()) break;
    const Row &end = ring.rows.back(), &next = rings_[k + 1].rows.front();
    for (const Row* row : {&end, &next})
      for (std::size_t j = 0; j < row->index.size(); ++j)
        if (at(*row, j).z() < floor - kSame_mm)
          return fail("groove floor z = {:.4f} mm lies above the tooth space beside it (z = {:.4f} mm)", floor,
                      at(*row, j).z());
    if (!(std::hypot(at(next, 0).x(), at(next, 0).y()) - std::hypot(at(end, 0).x(), at(end, 0).y()) > kSame_mm))
      return fail("groove width = 0 between ring {} and ring {}: a solid needs a gap", k, k + 1);
    const Row a = row_below(end, floor), b = row_below(next, floor);
    add_plain_strip(end, a, Piece::end, zone, true);
    add_plain_strip(a, b, Piece::groove, zone, false);
    add_plain_strip(b, next, Piece::end, std::uint8_t(k + 1), true);
  }

  const Row &inner = rings_.front().rows.front(), &outer = rings_.back().rows.back();
  const auto last = std::uint8_t(rings.size() - 1);
  const auto foot_of = [&](const Row& row) {
    double z = INFINITY;
    for (std::size_t j = 0; j < row.index.size(); ++j) z = std::min(z, at(row, j).z());
    return row_below(row, z - kFootModules * m);
  };
  const Row outer_foot = foot_of(outer), outer_base = row_below(outer, z_base);
  const Row inner_base = row_below(inner, z_base), inner_foot = foot_of(inner);
  add_plain_strip(outer, outer_foot, Piece::end, last, true);
  add_plain_strip(outer_foot, outer_base, Piece::body, last, true);
  add_plain_strip(outer_base, inner_base, Piece::body, 0, false);
  add_plain_strip(inner_base, inner_foot, Piece::body, 0, true);
  add_plain_strip(inner_foot, inner, Piece::end, 0, true);
  return Ok{};
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
    const auto& radii = grid_.radii[k];
    std::optional<ToothSection> near;
    for (std::size_t i = 0; i + 1 < radii.size(); ++i)
      for (int a = 0; a < n + (i + 2 == radii.size() ? 1 : 0); ++a) {
        const double r = a == n ? radii[i + 1] : radii[i] + (radii[i + 1] - radii[i]) * double(a) / double(n);
        auto section = ToothSection::at(gear_.drawn(k), out_.teeth, r, near ? &*near : nullptr);
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
  // The end faces are exact cylinders below outlines that are as good as the surfaces above them.
  const double surface = *std::max_element(sag.begin(), sag.end());
  sag[std::size_t(Piece::end)] = std::max(surface, cylinder_sag_);
  sag[std::size_t(Piece::body)] = cylinder_sag_;
  if (rings_.size() > 1) sag[std::size_t(Piece::groove)] = cylinder_sag_;
  for (double& s : sag) s *= kMargin;
  return sag;
}

}  // namespace toothpath::mesh
