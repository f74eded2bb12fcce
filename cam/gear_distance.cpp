#include "cam/gear_distance.h"

#include <algorithm>
#include <cmath>

#include "cam/gear_cells.h"
#include "cam/swept_path.h"
#include "geometry/face_gear_inverse.h"

namespace toothpath {
namespace {

constexpr double kTwoPi = 6.283185307179586476925286766559;
constexpr double kCellLength = 0.45;     // mm along the tooth
constexpr double kBorder = 1e-9;         // a foot this far beyond the border of a piece (in its parameter) still counts
// Corrected pieces share their normals to 1e-5 only; a foot so little beyond is about 1e-6 mm wrong.
constexpr double kCorrectedBorder = 3e-5;
constexpr int kEndPoints = 3000;         // on the profile at an end of the ring
constexpr int kBands = 4;                // a fillet may be touched at both of its ends: seeds from several bands

double radius(const Vec3& p) { return std::hypot(p.x(), p.y()); }
Vec3 turned(const Vec3& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
}

struct EdgeSegment {
  Vec3 a, b;
  const char* patch;
};

}  // namespace

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - ab * (d1 / (d1 - d3))).norm();
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - ac * (d2 / (d2 - d6))).norm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).norm();
  const Vec3 n = ab.cross(ac);
  return std::abs(ap.dot(n)) / n.norm();
}

struct GearDistance::Ring {
  SpaceSheet space;
  double r_in = 0, r_out = 0;
  std::vector<Cell> cells;
  std::unique_ptr<SpatialIndex> index;
  std::vector<EdgeSegment> edges;
  std::unique_ptr<SpatialIndex> edge_index;
  double sag = 0, edge_sag = 0;
  double tip_sag = 0;  // of the tip surface's meridian against the straight line between its ends
  double z_tip_in = 0, z_tip_out = 0;
  std::vector<double> table_r, mid, tip_plus, tip_minus;  // azimuths over r
  std::vector<double> opening;                            // azimuth of the middle between the tip edges, over r
  std::vector<std::vector<Vec2>> profiles;                // the same at every station
  std::vector<Vec2> end_in, end_out;                      // (azimuth, z) of the sheet at the ends, tip to tip
  OffsetSheet sheet;
  std::vector<std::array<Vec3, 3>> triangles;  // of the cells, for bodies
  std::vector<bool> border;  // a cell: partly beyond an end of the ring or the tip

  [[nodiscard]] bool on_ring(const Vec3& p) const {
    const double rp = radius(p);
    return rp >= r_in - 1e-9 && rp <= r_out + 1e-9 && p.z() <= space.surface().z_tip(rp) + 1e-9;
  }
  [[nodiscard]] bool over_land(double azimuth, double r) const {
    return azimuth <= lookup(tip_plus, r) || azimuth >= lookup(tip_minus, r);
  }
  /// Distance to the tip surface's meridian in the plane (r, z), from below; `foot` is the radius of its foot.
  [[nodiscard]] double to_tip_meridian(double r, double z, double& foot) const {
    const double dr = r_out - r_in, dz = z_tip_out - z_tip_in;
    const double t = std::clamp(((r - r_in) * dr + (z - z_tip_in) * dz) / (dr * dr + dz * dz), 0.0, 1.0);
    foot = r_in + t * dr;
    return std::hypot(r - foot, z - z_tip_in - t * dz) - tip_sag;
  }

  Ring(const SpaceSheet& s, OffsetSheet o) : space(s), sheet(std::move(o)) {}

  [[nodiscard]] double lookup(const std::vector<double>& y, double r) const {
    const double t = std::clamp((r - table_r.front()) / (table_r.back() - table_r.front()), 0.0, 1.0) * double(y.size() - 1);
    const auto k = std::min(std::size_t(t), y.size() - 2);
    return y[k] + (t - double(k)) * (y[k + 1] - y[k]);
  }
  /// Is (azimuth, z) at this profile inside the material? The profile runs from tip to tip.
  static bool in_material(const std::vector<Vec2>& profile, double azimuth, double z, double z_tip) {
    if (z >= z_tip) return false;
    if (azimuth <= profile.front().x() || azimuth >= profile.back().x()) return true;
    // The space is star-shaped seen from above: the profile is a function of the azimuth up to steep flanks.
    const auto it = std::lower_bound(profile.begin(), profile.end(), azimuth,
                                     [](const Vec2& q, double az) { return q.x() < az; });
    if (it == profile.begin() || it == profile.end()) return true;
    const Vec2 &a = *(it - 1), &b = *it;
    const double t = b.x() > a.x() ? (azimuth - a.x()) / (b.x() - a.x()) : 0;
    return z < a.y() + t * (b.y() - a.y());
  }
};

struct GearDistance::Impl {
  FaceGear gear;
  std::vector<Ring> rings;
  double pitch = 0;
  double sag = 0;
  std::optional<FaceGearRefusal> refusal;
  explicit Impl(const FaceGear& g) : gear(g) {}
};

GearDistance::GearDistance(const FaceGear& gear, double reach_mm) : impl_(std::make_unique<Impl>(gear)) {
  impl_->pitch = gear.pitch();
  int zone = 0;
  for (const auto& ring : gear.rings()) {
    const SpaceSheet space(gear.parameters(), ring);
    const double r_in = ring.zone.inner_radius_mm, r_out = ring.zone.outer_radius_mm;
    const double beyond = std::min(reach_mm, 0.25 * (r_out - r_in) + 1.0);
    const int stations = std::clamp(int((r_out - r_in + 2 * beyond) / kCellLength) + 2, 9, 400);
    Ring R(space, OffsetSheet(space, 0.0, r_in - beyond, r_out + beyond, stations));
    R.r_in = r_in;
    R.r_out = r_out;
    if (R.sheet.empty() || R.sheet.r_from() > r_in || R.sheet.r_to() < r_out) {
      const std::string key = "zone[" + std::to_string(zone) + "]";
      if (R.sheet.empty())
        impl_->refusal = {key, fail("zone {}: the flanks and fillets of the tooth space are found at no radius between {:.4f} and {:.4f} mm",
                                    zone, r_in - beyond, r_out + beyond)};
      else
        impl_->refusal = {key, fail("zone {}: the flanks and fillets of the tooth space are found from radius {:.4f} to {:.4f} mm only, the ring "
                                    "is {:.4f} to {:.4f} mm", zone, R.sheet.r_from(), R.sheet.r_to(), r_in, r_out)};
      impl_->rings.clear();
      return;
    }
    const auto& st = R.sheet.stations();
    std::vector<Box> boxes;
    for (std::size_t j = 0; j + 1 < st.size(); ++j) {
      for (std::size_t k = 0; k + 1 < st[j].nodes.size(); ++k) {
        const auto &n00 = st[j].nodes[k], &n01 = st[j].nodes[k + 1], &n10 = st[j + 1].nodes[k], &n11 = st[j + 1].nodes[k + 1];
        if (n00.at.piece != n01.at.piece) continue;
        Cell cell;
        cell.corner = {n00.at.contact.p, n01.at.contact.p, n10.at.contact.p, n11.at.contact.p};
        // The sheet goes on beyond the ends and the tip; what lies wholly there is no part of the gear.
        const auto all = [&](auto&& test) { return std::all_of(cell.corner.begin(), cell.corner.end(), test); };
        const auto above_tip = [&](const Vec3& p) { return p.z() > space.surface().z_tip(radius(p)) + kCellLength; };
        if (all([&](const Vec3& p) { return radius(p) < r_in; }) || all([&](const Vec3& p) { return radius(p) > r_out; }) ||
            all(above_tip))
          continue;
        const bool whole = all([&](const Vec3& p) { return R.on_ring(p); });
        cell.zone = zone;
        cell.piece = n00.at.piece;
        cell.band = std::clamp(int((0.5 * (n00.sigma + n01.sigma) - std::floor(n00.sigma)) * kBands), 0, kBands - 1);
        cell.u = 0.25 * (n00.at.u + n01.at.u + n10.at.u + n11.at.u);
        cell.v = 0.25 * (n00.at.v + n01.at.v + n10.at.v + n11.at.v);
        cell.centre = 0.25 * (cell.corner[0] + cell.corner[1] + cell.corner[2] + cell.corner[3]);
        if (const auto q = space.point(cell.piece, cell.u, cell.v)) {
          const double gap = std::min(distance_to_triangle(q->p, cell.corner[0], cell.corner[1], cell.corner[2]),
                                      distance_to_triangle(q->p, cell.corner[1], cell.corner[2], cell.corner[3]));
          R.sag = std::max(R.sag, gap);
        }
        Box box;
        for (const auto& p : cell.corner) {
          box.add(p);
          cell.radius = std::max(cell.radius, (p - cell.centre).norm());
        }
        boxes.push_back(box);
        R.cells.push_back(cell);
        R.border.push_back(!whole);
      }
    }
    for (const auto& station : st) {
      std::vector<Vec2> profile;
      for (const auto& node : station.nodes)
        profile.push_back({std::atan2(node.at.contact.p.y(), node.at.contact.p.x()), node.at.contact.p.z()});
      R.profiles.push_back(std::move(profile));
    }
    const std::size_t sheet_cells = R.cells.size();
    R.sag *= 2;  // the middle of a cell shows about the largest sag; twice that is taken as its bound
    for (std::size_t k = 0; k < sheet_cells; ++k) R.cells[k].radius += R.sag;

    // Edges: the sheet at both ends of the ring, and both tip edges.
    std::vector<Box> edge_boxes;
    const auto add_edge = [&](const std::vector<Vec3>& line, const char* patch) {
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        if ((line[k + 1] - line[k]).norm() < 1e-12) continue;
        R.edges.push_back({line[k], line[k + 1], patch});
        Box b;
        b.add(line[k]);
        b.add(line[k + 1]);
        edge_boxes.push_back(b);
        if (k > 0 && k + 2 < line.size()) {
          // Sag of a chord, estimated from the turn between neighbours.
          const Vec3 u = (line[k] - line[k - 1]), v = (line[k + 1] - line[k]);
          if (u.norm() > 1e-9 && v.norm() > 1e-9)
            R.edge_sag = std::max(R.edge_sag, 0.125 * v.norm() * u.normalized().cross(v.normalized()).norm());
        }
      }
    };
    const auto end_line = [&](double r, std::vector<Vec2>& profile) {
      std::vector<Vec3> line;
      const double z_tip = space.surface().z_tip(r);
      for (int k = 0; k <= kEndPoints; ++k) {
        const auto q = R.sheet.raw(5.0 * k / kEndPoints, r);
        if (!q || q->contact.p.z() > z_tip) continue;
        line.push_back(q->contact.p);
        profile.push_back({std::atan2(q->contact.p.y(), q->contact.p.x()), q->contact.p.z()});
      }
      // The corners where the flanks leave through the tip surface.
      for (const int side : {1, -1}) {
        const auto c = space.tip(side, r);
        if (!c) continue;
        const auto q = space.point(side > 0 ? SpacePiece::flank_plus : SpacePiece::flank_minus, c->at.theta, c->at.B);
        if (!q) continue;
        const Vec2 corner(std::atan2(q->p.y(), q->p.x()), z_tip);
        if (side > 0) {
          line.insert(line.begin(), q->p);
          profile.insert(profile.begin(), corner);
        } else {
          line.push_back(q->p);
          profile.push_back(corner);
        }
      }
      add_edge(line, "end edge");
    };
    end_line(r_in, R.end_in);
    end_line(r_out, R.end_out);
    std::vector<Vec3> plus_line, minus_line;
    std::optional<TipPlace> last_plus, last_minus;
    const auto start_of = [](const std::optional<TipPlace>& last) { return last ? std::optional(last->at) : std::nullopt; };
    const int table = 257;
    for (int k = 0; k < table; ++k) {
      const double r = r_in + (r_out - r_in) * k / (table - 1);
      const double z_tip = space.surface().z_tip(r);
      last_plus = space.tip(1, r, start_of(last_plus));
      last_minus = space.tip(-1, r, start_of(last_minus));
      const auto root = space.point(SpacePiece::root, 0.5, std::sqrt(r * r - space.surface().E * space.surface().E) / space.surface().Sg);
      R.table_r.push_back(r);
      R.mid.push_back(std::atan2(root->p.y(), root->p.x()));
      R.tip_plus.push_back(last_plus ? last_plus->azimuth : R.mid.back() - impl_->pitch / 2);
      R.tip_minus.push_back(last_minus ? last_minus->azimuth + impl_->pitch
                                       : R.mid.back() + impl_->pitch / 2);
      plus_line.push_back({r * std::cos(R.tip_plus.back()), r * std::sin(R.tip_plus.back()), z_tip});
      minus_line.push_back({r * std::cos(R.tip_minus.back()), r * std::sin(R.tip_minus.back()), z_tip});
    }
    for (std::size_t k = 0; k < R.tip_plus.size(); ++k) R.opening.push_back(0.5 * (R.tip_plus[k] + R.tip_minus[k]));
    R.z_tip_in = space.surface().z_tip(r_in);
    R.z_tip_out = space.surface().z_tip(r_out);
    for (int k = 1; k < 64; ++k) {
      const double t = k / 64.0, z = space.surface().z_tip(r_in + t * (r_out - r_in));
      R.tip_sag = std::max(R.tip_sag, 1.01 * std::abs(z - R.z_tip_in - t * (R.z_tip_out - R.z_tip_in)) - 1e-12);
    }
    add_edge(plus_line, "tip edge");
    add_edge(minus_line, "tip edge");
    R.edge_index = std::make_unique<SpatialIndex>(edge_boxes);
    // The top land of tooth 0, which ends space 0 on its low side: bodies wider than a space may stand on it.
    for (std::size_t k = 0; k + 4 < plus_line.size(); k += 4) {
      for (int part = 0; part < 4; ++part) {
        Cell cell;
        cell.sheet = false;
        cell.zone = zone;
        for (int corner = 0; corner < 4; ++corner) {
          const Vec3& a = plus_line[k + (corner / 2 ? 4 : 0)];
          const Vec3 b = turned(minus_line[k + (corner / 2 ? 4 : 0)], -impl_->pitch);
          cell.corner[std::size_t(corner)] = b + (a - b) * ((part + corner % 2) / 4.0);
        }
        cell.centre = 0.25 * (cell.corner[0] + cell.corner[1] + cell.corner[2] + cell.corner[3]);
        Box box;
        for (const auto& p : cell.corner) {
          box.add(p);
          cell.radius = std::max(cell.radius, (p - cell.centre).norm());
        }
        cell.radius += R.sag;
        boxes.push_back(box);
        R.cells.push_back(cell);
        R.border.push_back(true);
      }
    }
    // End faces and the groove floor, for bodies only as well. A strip of an end face ends at the lower of its two edges: the
    // sheet itself stands for the rest.
    const auto add_body_cell = [&](const std::array<Vec3, 4>& corner) {
      Cell cell;
      cell.sheet = false;
      cell.zone = zone;
      cell.corner = corner;
      cell.centre = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
      Box box;
      for (const auto& p : corner) {
        box.add(p);
        cell.radius = std::max(cell.radius, (p - cell.centre).norm());
      }
      cell.radius += R.sag;
      boxes.push_back(box);
      R.cells.push_back(cell);
    };
    const bool grooved = gear.rings().size() > 1;
    const double base = std::min(gear.lowest_root(), grooved ? gear.groove_floor() : INFINITY) - 0.5;
    const auto at = [](double r, double azimuth, double z) { return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z); };
    for (const bool outer : {false, true}) {
      const double r = outer ? r_out : r_in;
      const EndFace face{r, outer, space.surface().z_tip(r), R.lookup(R.opening, r) - impl_->pitch / 2, impl_->pitch, base};
      for (const auto& quad : end_face_quads(face, outer ? R.end_out : R.end_in)) add_body_cell(quad);
    }
    if (grooved && zone == 0) {
      constexpr int kStrips = 48;
      const double next = gear.rings()[1].zone.inner_radius_mm, from = R.lookup(R.mid, r_out) - impl_->pitch / 2;
      const int rows = std::max(1, int(std::ceil((next - r_out) / 1.0)));
      for (int k = 0; k < kStrips; ++k)
        for (int q = 0; q < rows; ++q) {
          const double a = from + impl_->pitch * k / kStrips, b = from + impl_->pitch * (k + 1) / kStrips;
          const double r0 = r_out + (next - r_out) * q / rows, r1 = r_out + (next - r_out) * (q + 1) / rows;
          add_body_cell({at(r0, a, gear.groove_floor()), at(r0, b, gear.groove_floor()), at(r1, a, gear.groove_floor()),
                         at(r1, b, gear.groove_floor())});
        }
    }
    for (auto& cell : R.cells) {
      cell.first_triangle = std::uint32_t(R.triangles.size());
      for (const std::size_t first : {0, 1}) {
        std::vector<Vec3> polygon{cell.corner[first], cell.corner[first + 1], cell.corner[first + 2]};
        if (cell.sheet) polygon = on_ring(space, std::move(polygon), R.sag);
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) R.triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
      }
      cell.triangles = std::uint32_t(R.triangles.size()) - cell.first_triangle;
    }
    R.index = std::make_unique<SpatialIndex>(boxes);
    impl_->sag = std::max(impl_->sag, R.sag);
    impl_->rings.push_back(std::move(R));
    ++zone;
  }
}

GearDistance::~GearDistance() = default;
GearDistance::GearDistance(GearDistance&&) noexcept = default;

const std::vector<GearDistance::Cell>& GearDistance::cells(int zone) const { return impl_->rings[std::size_t(zone)].cells; }
const std::vector<std::array<Vec3, 3>>& GearDistance::triangles(int zone) const { return impl_->rings[std::size_t(zone)].triangles; }
const std::optional<FaceGearRefusal>& GearDistance::refusal() const { return impl_->refusal; }
const SpatialIndex& GearDistance::cell_index(int zone) const { return *impl_->rings[std::size_t(zone)].index; }
const SpaceSheet& GearDistance::space(int zone) const { return impl_->rings[std::size_t(zone)].space; }
double GearDistance::cell_sag_mm() const { return impl_->sag; }
const FaceGear& GearDistance::gear() const { return impl_->gear; }
int GearDistance::zones() const { return int(impl_->rings.size()); }
double GearDistance::space_azimuth(int zone, double r) const {
  const auto& ring = impl_->rings[std::size_t(zone)];
  return ring.lookup(ring.mid, r);
}

NearestPlace GearDistance::nearest(const Vec3& asked, double within) const {
  NearestPlace best;
  best.distance = within;
  best.point = asked;
  if (impl_->refusal) {
    best.distance = -within;
    best.patch = "inside";
    return best;
  }
  const double r = radius(asked), z = asked.z();
  const auto take = [&](double d, bool exact, int zone, const char* patch, const Vec3& foot, const Vec3& at) {
    if (d < best.distance) best = {d, exact, zone, patch, foot, at};
  };
  const auto& rings = impl_->rings;
  for (std::size_t zone = 0; zone < rings.size(); ++zone) {
    const auto& ring = rings[zone];
    const double gap_r = std::max({ring.r_in - r, r - ring.r_out, 0.0});
    if (gap_r >= best.distance) continue;
    const double r_here = std::clamp(r, ring.r_in, ring.r_out);
    const double z_tip = ring.space.surface().z_tip(r_here);
    if (z - z_tip >= best.distance * 1.5 && std::abs(ring.space.surface().Cg) < 0.5) continue;
    // The space whose opening lies next: its root may stand off the middle of its opening by a good part of a pitch.
    const double middle = ring.lookup(ring.opening, r);
    const double away = std::remainder(std::atan2(asked.y(), asked.x()) - middle, kTwoPi);
    const double index = std::round(away / impl_->pitch);
    const Vec3 c = turned(asked, -index * impl_->pitch);
    const double azimuth = middle + away - index * impl_->pitch;
    const bool beside = gap_r > 0;
    const bool in_air = beside || z >= z_tip;  // certainly: neither between the radii of the ring and below its tip

    // Candidates: the nearest cell of every band of every piece, apart for whole cells and for those that reach beyond
    // the ring: the nearest point of such a one may not exist, and must not hide a farther one that does.
    struct Seed {
      double d = INFINITY;
      std::size_t cell = 0;
    };
    std::array<Seed, 2 * kSpacePieces * kBands> seeds;
    double d_mesh = INFINITY;  // to whole cells
    const double search = std::min(within, best.distance) + ring.sag;
    const double slack = 4 * ring.sag + 0.02;  // a facet farther than the nearest by this cannot hold the nearest point
    ring.index->near(c, search, [&](std::size_t k, double r_query) {
      const auto& cell = ring.cells[k];
      if (!cell.sheet || (c - cell.centre).norm() - cell.radius > std::min(d_mesh + slack, search)) return r_query;
      const double d = std::min(distance_to_triangle(c, cell.corner[0], cell.corner[1], cell.corner[2]),
                                distance_to_triangle(c, cell.corner[1], cell.corner[2], cell.corner[3]));
      const bool border = ring.border[k];
      if (!border) d_mesh = std::min(d_mesh, d);
      const std::size_t band = (std::size_t(cell.piece) * kBands + std::size_t(cell.band)) * 2 + border;
      auto& seed = seeds[band];
      if (d < seed.d || (d == seed.d && k < seed.cell)) seed = {d, k};
      return std::min(r_query, d_mesh + slack);
    });
    const auto& w = ring.space.surface().shaper;
    const double border_slack = ring.space.ring().correction ? kCorrectedBorder : kBorder;
    bool found = false;               // Newton has found the sheet, on the ring or on its continuation
    double accepted = INFINITY;       // the best foot on the ring
    double beyond = INFINITY, beyond_seed = INFINITY;  // signed distance to the continuation
    for (const auto& seed : seeds) {
      // A seed whose facet is farther than the best exact distance cannot win.
      if (!(seed.d <= std::min(d_mesh + slack, search))) continue;
      if (seed.d - ring.sag > accepted) continue;
      const auto& cell = ring.cells[seed.cell];
      const auto foot = ring.space.foot(cell.piece, c, cell.u, cell.v);
      if (!foot) continue;
      const bool flank = cell.piece == SpacePiece::flank_plus || cell.piece == SpacePiece::flank_minus;
      if (flank && foot->u > w.theta_t + border_slack) continue;
      if (!flank && cell.piece != SpacePiece::root && (foot->u < w.A_t - border_slack || foot->u > w.A_e + border_slack)) continue;
      if (cell.piece == SpacePiece::root && (foot->u < -border_slack || foot->u > 1 + border_slack)) continue;
      if (foot->distance < 0 && in_air) continue;  // seen through an end of the ring or the tip
      found = true;
      if (ring.on_ring(foot->at.p)) {
        accepted = std::min(accepted, foot->distance);
        take(foot->distance, true, int(zone), to_string(cell.piece), foot->at.p, c);
      } else if (seed.d < beyond_seed) {
        beyond = foot->distance;
        beyond_seed = seed.d;
      }
    }
    // Inside the material beside an end or below a tip edge: the nearest surface is that end or land.
    if (beyond < 0 && accepted == INFINITY) take(beyond, false, int(zone), "inside", c, c);
    // Edges of the ring.
    if (const double look = std::min(within, best.distance) + ring.edge_sag; look > 0)
      ring.edge_index->near(c, look, [&](std::size_t k, double r_query) {
        const auto& e = ring.edges[k];
        take(distance_to_segment(c, e.a, e.b) - ring.edge_sag, false, int(zone), e.patch, e.a, c);
        return r_query;
      });
    // Newton must agree with the facets; where it does not, the facets decide with their sag.
    if (best.distance > d_mesh + 2 * ring.sag + 1e-9) take(d_mesh - ring.sag, false, int(zone), "flank", c, c);
    // End faces, top lands, and the inside of the material.
    if (beside) {
      const auto& profile = r < ring.r_in ? ring.end_in : ring.end_out;
      if (profile.size() > 2 && Ring::in_material(profile, azimuth, z, z_tip))
        take(gap_r, true, int(zone), "end", c, c);
    }
    if (z >= z_tip) {
      double foot = 0;
      const double d = ring.to_tip_meridian(r, z, foot);
      if (ring.over_land(azimuth, foot)) take(d, ring.tip_sag == 0, int(zone), "tip", 
                                              Vec3(c.x() * foot / r, c.y() * foot / r, ring.space.surface().z_tip(foot)), c);
    } else if (!beside && !found) {
      // No surface near: either free in a wide space or deep inside the material.
      const auto& st = ring.sheet.stations();
      const double t = (r - st.front().r) / (st.back().r - st.front().r) * double(st.size() - 1);
      const auto& profile = ring.profiles[std::size_t(std::clamp(std::round(t), 0.0, double(st.size() - 1)))];
      if (ring.over_land(azimuth, r) || Ring::in_material(profile, azimuth, z, z_tip)) take(-within, false, int(zone), "inside", c, c);
    }
  }
  if (rings.size() > 1) {
    const double floor_z = impl_->gear.groove_floor();
    for (std::size_t zone = 0; zone + 1 < rings.size(); ++zone) {
      const double gap = std::max({rings[zone].r_out - r, r - rings[zone + 1].r_in, 0.0});
      const double height = z - floor_z;
      if (gap == 0) take(height, true, int(zone), "groove", Vec3(asked.x(), asked.y(), floor_z), asked);
    }
  }
  return best;
}

}  // namespace toothpath
