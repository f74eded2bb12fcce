#include "cam/gear_distance.h"

#include <algorithm>
#include <cmath>

#include "cam/gear_ring.h"
#include "cam/swept_path.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear_inverse.h"

namespace toothpath {
namespace {

constexpr double kBorder = 1e-9;         // a foot this far beyond the border of a piece (in its parameter) still counts
// Corrected pieces share their normals to 1e-5 only; a foot so little beyond is about 1e-6 mm wrong.
constexpr double kCorrectedBorder = 3e-5;


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

struct GearDistance::Impl {
  FaceGear gear;
  std::vector<std::unique_ptr<GearRing>> rings;
  double pitch = 0;
  double sag = 0;
  std::optional<FaceGearRefusal> refusal;
  explicit Impl(const FaceGear& g) : gear(g) {}
};

GearDistance::GearDistance(const FaceGear& gear, double reach_mm) : impl_(std::make_unique<Impl>(gear)) {
  impl_->pitch = gear.pitch();
  for (int zone = 0; zone < int(gear.rings().size()); ++zone) {
    auto ring = GearRing::make(gear, zone, reach_mm);
    if (auto* refusal = std::get_if<1>(&ring)) {
      impl_->refusal = std::move(*refusal);
      impl_->rings.clear();
      return;
    }
    impl_->rings.push_back(std::move(std::get<0>(ring)));
    impl_->sag = std::max(impl_->sag, impl_->rings.back()->sag);
  }
}

GearDistance::~GearDistance() = default;
GearDistance::GearDistance(GearDistance&&) noexcept = default;

const std::vector<GearDistance::Cell>& GearDistance::cells(int zone) const { return impl_->rings[std::size_t(zone)]->cells; }
const std::vector<std::array<Vec3, 3>>& GearDistance::triangles(int zone) const { return impl_->rings[std::size_t(zone)]->triangles; }
const std::optional<FaceGearRefusal>& GearDistance::refusal() const { return impl_->refusal; }
const SpatialIndex& GearDistance::cell_index(int zone) const { return *impl_->rings[std::size_t(zone)]->index; }
const SpaceSheet& GearDistance::space(int zone) const { return impl_->rings[std::size_t(zone)]->space; }
const BodyPatches& GearDistance::patches(int zone) const { return *impl_->rings[std::size_t(zone)]->patches; }
std::size_t GearDistance::unproven() const {
  std::size_t sum = 0;
  for (const auto& ring : impl_->rings) sum += ring->patches->sampled_blocks() + ring->unproven_edges;
  return sum;
}
double GearDistance::cell_sag_mm() const { return impl_->sag; }
const FaceGear& GearDistance::gear() const { return impl_->gear; }
int GearDistance::zones() const { return int(impl_->rings.size()); }
double GearDistance::space_azimuth(int zone, double r) const {
  const auto& ring = *impl_->rings[std::size_t(zone)];
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
    const auto& ring = *rings[zone];
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
        take(distance_to_segment(c, e.a, e.b) - e.sag, false, int(zone), e.patch, e.a, c);
        return r_query;
      });
    // Newton must agree with the facets; where it does not, the facets decide with their sag.
    if (best.distance > d_mesh + 2 * ring.sag + 1e-9) take(d_mesh - ring.sag, false, int(zone), "flank", c, c);
    // End faces, top lands, and the inside of the material.
    if (beside) {
      const auto& profile = r < ring.r_in ? ring.end_in : ring.end_out;
      if (profile.size() > 2 && in_material(profile, azimuth, z, z_tip))
        take(gap_r, true, int(zone), "end", c, c);
    }
    if (z >= z_tip) {
      double foot = 0;
      const double d = ring.to_tip_meridian(r, z, foot);
      if (ring.over_land(azimuth, foot)) take(d, ring.tip_sag == 0, int(zone), "tip", 
                                              Vec3(c.x() * foot / r, c.y() * foot / r, ring.space.surface().z_tip(foot)), c);
    } else if (!beside && !found) {
      // No surface near: either free in a wide space or deep inside the material.
      if (ring.over_land(azimuth, r) || in_material(ring.profile(r), azimuth, z, z_tip)) take(-within, false, int(zone), "inside", c, c);
    }
  }
  if (rings.size() > 1) {
    const double floor_z = impl_->gear.groove_floor();
    for (std::size_t zone = 0; zone + 1 < rings.size(); ++zone) {
      const double gap = std::max({rings[zone]->r_out - r, r - rings[zone + 1]->r_in, 0.0});
      const double height = z - floor_z;
      if (gap == 0) take(height, true, int(zone), "groove", Vec3(asked.x(), asked.y(), floor_z), asked);
    }
  }
  return best;
}

}  // namespace toothpath
