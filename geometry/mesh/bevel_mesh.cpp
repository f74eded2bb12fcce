#include "geometry/mesh/bevel_mesh.h"

#include "geometry/base/angle.h"

namespace toothpath::mesh {
namespace {

constexpr double kOfArc = 1.0 / 3;             // of the rows of a wall, on the fillet
constexpr double kUndersideTurn = radians(1);  // between two rows: sag 4e-5 of the radius

/// One closed or open row of points at one cone distance: azimuths and heights over one pitch.
struct Section {
  double ell = 0;
  std::vector<Vec3> points;  ///< of tooth space 0, azimuth growing, the first point of the next pitch left out
  std::vector<double> patch;
};

/// Wall points at one cone distance from tip (first) to root (last).
Result<std::vector<Vec3>> wall_points(const bevel_gear::BevelGear& g, const bevel_gear::BevelWall<double>& w,
                                      double ell, int rows) {
  const auto tip = bevel_gear::bevel_inverse(w, ell, g.parameters().addendum_mm);
  if (!tip) return fail("wall {} does not reach the tip at cone distance {:.4f}", w.sigma > 0 ? "L" : "U", ell);
  std::vector<Vec3> points{w.point(tip->beta, tip->p).p};
  // The parameter runs faster along the involute than along the arc: each has rows of its own.
  const double low = w.cutter.p_A, arc = w.cutter.p_B;
  const int on_arc = std::max(1, int(kOfArc * (rows - 1))), above = rows - 1 - on_arc;
  for (int r = 1; r < rows; ++r) {
    const double p = r <= above ? tip->p + (arc - tip->p) * r / above : arc + (low - arc) * (r - above) / on_arc;
    const auto beta = bevel_gear::bevel_beta_at(w, ell, std::max(p, low));
    if (!beta) return fail("wall {} does not reach the root at cone distance {:.4f}", w.sigma > 0 ? "L" : "U", ell);
    points.push_back(w.point(*beta, std::max(p, low)).p);
  }
  return points;
}

Result<Section> tooth_section(const bevel_gear::BevelGear& g, const bevel_gear::BevelHalf& half, double ell,
                              const BevelMeshOptions& o) {
  const auto L = wall_points(g, half.walls[0], ell, o.rows), U = wall_points(g, half.walls[1], ell, o.rows);
  if (!L) return L.error();
  if (!U) return U.error();
  Section s;
  s.ell = ell;
  const auto add = [&](const Vec3& p, double patch) {
    s.points.push_back(p);
    s.patch.push_back(patch);
  };
  for (const auto& p : *L) add(p, 0);
  // Azimuths may pass +-180 deg: differences are taken of the shortest way.
  const double from = azimuth(L->back()), across = std::remainder(azimuth(U->back()) - from, 2 * kPi);
  for (int k = 1; k <= o.root_points; ++k)
    add(bevel_gear::blank_point(ell, -g.parameters().dedendum_mm, from + across * k / (o.root_points + 1),
                                g.sin_delta(), g.cos_delta()),
        1);
  for (auto it = U->rbegin(); it != U->rend(); ++it) add(*it, 2);
  const double begin = azimuth(U->front());
  const double land = std::remainder(azimuth(L->front()) + g.pitch() - begin, 2 * kPi);
  if (!(land > 0)) return fail("the teeth are pointed at cone distance {:.4f}", ell);
  for (int k = 1; k <= o.land_points; ++k)
    add(bevel_gear::blank_point(ell, g.parameters().addendum_mm, begin + land * k / (o.land_points + 1), g.sin_delta(),
                                g.cos_delta()),
        3);
  return s;
}

/// The same azimuths on another cone: groove floor, ends of the body.
Section flattened(const bevel_gear::BevelGear& g, const Section& s, double ell, double height) {
  Section out;
  out.ell = ell;
  out.patch.assign(s.points.size(), 4);
  for (const auto& p : s.points)
    out.points.push_back(bevel_gear::blank_point(ell, height, azimuth(p), g.sin_delta(), g.cos_delta()));
  return out;
}

Result<std::vector<Section>> sections(const bevel_gear::BevelGear& g, const BevelMeshOptions& o) {
  std::vector<Section> all;
  const double floor = -g.parameters().dedendum_mm;
  for (std::size_t i = 0; i < g.halves().size(); ++i) {
    const auto& half = g.halves()[i];
    for (int k = 0; k < o.stations; ++k) {
      auto s = tooth_section(g, half, half.ell_from + (half.ell_to - half.ell_from) * k / (o.stations - 1), o);
      if (!s) return s.error();
      if (i > 0 && k == 0) all.push_back(flattened(g, *s, s->ell, floor));
      all.push_back(std::move(*s));
    }
    if (i + 1 < g.halves().size()) {
      const Section edge = all.back();
      all.push_back(flattened(g, edge, edge.ell, floor));
    }
  }
  return all;
}

/// Rows of the underside between the large and the small end. Their azimuths differ by the turn of the teeth: long
/// facets between them would lie inside the cone.
std::vector<Section> underside(const bevel_gear::BevelGear& g, const Section& large, const Section& small) {
  const auto turn_to = [](const Vec3& a, const Vec3& b) { return angle_from_to(a, b); };
  const double first = turn_to(large.points.front(), small.points.front());
  const int rows = 1 + int(std::abs(first) / kUndersideTurn);
  std::vector<Section> out;
  for (int k = 1; k < rows; ++k) {
    const double t = double(k) / rows, ell = large.ell + t * (small.ell - large.ell);
    Section row = flattened(g, large, ell, underside_height(g));
    for (std::size_t j = 0; j < row.points.size(); ++j) {
      const double turn = first + wrapped(turn_to(large.points[j], small.points[j]) - first);
      row.points[j] = turned(row.points[j], t * turn);
    }
    out.push_back(std::move(row));
  }
  return out;
}

/// Along the meridian: the underside at the small end, the teeth, back along the underside.
Result<std::vector<Section>> closed_loop(const bevel_gear::BevelGear& g, const BevelMeshOptions& o) {
  auto rows = sections(g, o);
  if (!rows) return rows.error();
  const double under = underside_height(g);
  std::vector<Section> loop{flattened(g, rows->front(), rows->front().ell, under)};
  for (auto& s : *rows) loop.push_back(std::move(s));
  loop.push_back(flattened(g, loop.back(), loop.back().ell, under));
  for (auto& row : underside(g, loop.back(), loop.front())) loop.push_back(std::move(row));
  return loop;
}

/// Corners that coincide become one, triangles without area are left out.
void add_triangle(TriangleMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c) {
  if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
}

}  // namespace

double underside_height(const bevel_gear::BevelGear& g) {
  // Below the root by two modules, but no nearer to the axis than a third of the radius there.
  const auto& p = g.parameters();
  const double depth =
      std::min(2 * p.outer_transverse_module_mm,
               (g.R_i() * g.sin_delta() - p.dedendum_mm * g.cos_delta()) / (1.5 * std::max(1e-9, g.cos_delta())));
  return -p.dedendum_mm - depth;
}

Result<TriangleMesh> bevel_gear_mesh(const bevel_gear::BevelGear& g, const BevelMeshOptions& o) {
  const auto made = closed_loop(g, o);
  if (!made) return made.error();
  const std::vector<Section>& loop = *made;
  TriangleMesh mesh;
  const std::size_t n = loop.front().points.size(), teeth = static_cast<std::size_t>(g.parameters().teeth),
                    around = n * teeth;
  std::vector<std::vector<std::int32_t>> index(loop.size(), std::vector<std::int32_t>(around));
  for (std::size_t i = 0; i < loop.size(); ++i)
    for (std::size_t k = 0; k < teeth; ++k) {
      const Turn turn(g.pitch() * static_cast<double>(k));
      for (std::size_t j = 0; j < n; ++j) {
        const Vec3& p = loop[i].points[j];
        const std::size_t at = k * n + j;
        // A station beside the groove shares its root points with the groove floor.
        if (i > 0 && (p - loop[i - 1].points[j]).norm() < 1e-9) {
          index[i][at] = index[i - 1][at];
          continue;
        }
        index[i][at] = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(turn(p));
      }
    }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    // The last row closes back on the first: the underside.
    const std::size_t next = (i + 1) % loop.size();
    for (std::size_t j = 0; j < around; ++j) {
      const std::size_t k = (j + 1) % around;
      add_triangle(mesh, index[i][j], index[i][k], index[next][k]);
      add_triangle(mesh, index[i][j], index[next][k], index[next][j]);
    }
  }
  return mesh;
}

Result<TriangleMesh> bevel_pitch_part(const bevel_gear::BevelGear& g, const BevelMeshOptions& o) {
  const auto loop = closed_loop(g, o);
  if (!loop) return loop.error();
  TriangleMesh mesh;
  const std::size_t n = loop->front().points.size() + 1;
  std::vector<std::vector<std::int32_t>> index(loop->size(), std::vector<std::int32_t>(n));
  for (std::size_t i = 0; i < loop->size(); ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const Vec3 p = j + 1 < n ? (*loop)[i].points[j] : turned((*loop)[i].points[0], g.pitch());
      const bool same = i > 0 && (p - mesh.vertices[std::size_t(index[i - 1][j])]).norm() < 1e-9;
      index[i][j] = same ? index[i - 1][j] : std::int32_t(mesh.vertices.size());
      if (!same) mesh.vertices.push_back(p);
    }
  for (std::size_t i = 0; i < loop->size(); ++i) {
    const std::size_t next = (i + 1) % loop->size();
    for (std::size_t j = 0; j + 1 < n; ++j) {
      add_triangle(mesh, index[i][j], index[i][j + 1], index[next][j + 1]);
      add_triangle(mesh, index[i][j], index[next][j + 1], index[next][j]);
    }
  }
  return mesh;
}

Result<TriangleMesh> bevel_pitch_mesh(const bevel_gear::BevelGear& g, std::vector<double>& patch,
                                      const BevelMeshOptions& o) {
  auto rows = sections(g, o);
  if (!rows) return rows.error();
  TriangleMesh mesh;
  patch.clear();
  const std::size_t n = rows->front().points.size() + 1;
  const Turn pitch(g.pitch());
  for (const auto& row : *rows) {
    for (std::size_t j = 0; j < n; ++j) {
      Vec3 p = row.points[j % (n - 1)];
      if (j + 1 == n) p = pitch(p);
      mesh.vertices.push_back(p);
      patch.push_back(j + 1 == n ? row.patch.back() : row.patch[j]);
    }
  }
  for (std::size_t i = 0; i + 1 < rows->size(); ++i)
    for (std::size_t j = 0; j + 1 < n; ++j) {
      const auto at = [&](std::size_t r, std::size_t k) { return static_cast<std::int32_t>(r * n + k); };
      const auto same = [&](std::size_t k) {
        return (mesh.vertices[i * n + k] - mesh.vertices[(i + 1) * n + k]).norm() < 1e-9;
      };
      if (!same(j + 1)) add_triangle(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1));
      if (!same(j)) add_triangle(mesh, at(i, j), at(i + 1, j + 1), at(i + 1, j));
    }
  return mesh;
}

}  // namespace toothpath::mesh
