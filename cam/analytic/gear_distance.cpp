#include "cam/analytic/gear_distance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "cam/analytic/gear_ring.h"
#include "geometry/base/angle.h"

namespace toothpath::analytic {
namespace {

constexpr double kTreeError = 1e-7;  // mm: of distances to facets, with room to spare
constexpr double kFlatTip = 0.577;  // mm/mm: of a tip surface that is no farther from what stands above it than 1 / 1.5
constexpr double kShortLine = 0.5;  // a line that spans more than this share of its radius is not looked at

/// What s and h some places have.
struct Extent {
  tooth_space::Range s, h;
};

double beyond(double low, double high, double x) { return std::max({low - x, x - high, 0.0}); }

/// The line's least distance from the z axis.
double radius_of_line(const Vec3& from, const Vec3& to) {
  return distance_to_segment(Vec3::Zero(), {from.x(), from.y(), 0}, {to.x(), to.y(), 0});
}

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
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).norm();
  const Vec3 n = ab.cross(ac);
  return std::abs(ap.dot(n)) / n.norm();
}

struct GearDistance::Impl {
  std::shared_ptr<const tooth_space::ToothedPart> part;
  std::vector<std::unique_ptr<GearRing>> rings;
  tooth_space::Chart chart;
  double pitch = 0;
  double sag = 0;
  std::optional<tooth_space::ToothedPart::Stretch> groove;
  double groove_floor = 0;  ///< where there is a groove
  std::optional<Refusal> refusal;
  int half_turn = 0;        ///< teeth
  std::vector<Turn> turns;  ///< of every tooth back to space 0, from -half_turn on

  explicit Impl(std::shared_ptr<const tooth_space::ToothedPart> p)
      : part(std::move(p)), chart(part->chart()), pitch(part->pitch()), half_turn(part->teeth() / 2 + 1) {
    for (int k = -half_turn; k <= half_turn; ++k) turns.emplace_back(-double(k) * pitch);
  }
  [[nodiscard]] Vec3 to_space_0(const Vec3& p, double tooth) const {
    return turns[std::size_t(int(tooth) + half_turn)](p);
  }
  /// How many teeth a place at s lies from space 0: whole numbers are the middles of the openings.
  [[nodiscard]] double spaces_from_0(const GearRing& ring, double s, double azimuth) const {
    return std::remainder(azimuth - ring.lookup(ring.opening, s), kTwoPi) / pitch;
  }
  template <typename Facets>
  [[nodiscard]] double keeps(const Extent& places, double within, const Facets& facets) const;
  class Question;
};

GearDistance::GearDistance(std::shared_ptr<const tooth_space::ToothedPart> part, double reach_mm)
    : impl_(std::make_unique<Impl>(std::move(part))) {
  std::vector<std::optional<Expected<std::unique_ptr<GearRing>, Refusal>>> made(std::size_t(impl_->part->zones()));
  tbb::parallel_for(std::size_t(0), made.size(),
                    [&](std::size_t zone) { made[zone] = GearRing::make(*impl_->part, int(zone), reach_mm); });
  for (auto& ring : made) {
    if (auto* refusal = (*ring).refused()) {
      impl_->refusal = std::move(*refusal);
      impl_->rings.clear();
      return;
    }
    impl_->rings.push_back(std::move((*ring).value()));
    impl_->sag = std::max(impl_->sag, impl_->rings.back()->sag);
  }
  impl_->groove = impl_->part->groove();
  impl_->groove_floor = impl_->part->groove_floor().value_or(0);
}

GearDistance::~GearDistance() = default;
GearDistance::GearDistance(GearDistance&&) noexcept = default;

const std::vector<GearDistance::Cell>& GearDistance::cells(int zone) const {
  return impl_->rings[std::size_t(zone)]->cells;
}
const std::vector<std::array<Vec3, 3>>& GearDistance::triangles(int zone) const {
  return impl_->rings[std::size_t(zone)]->triangles;
}
const std::optional<Refusal>& GearDistance::refusal() const { return impl_->refusal; }
const SpatialIndex& GearDistance::cell_index(int zone) const { return *impl_->rings[std::size_t(zone)]->index; }
const BodyPatches& GearDistance::patches(int zone) const { return *impl_->rings[std::size_t(zone)]->patches; }
std::size_t GearDistance::unproven() const {
  std::size_t sum = 0;
  for (const auto& ring : impl_->rings) sum += ring->patches->sampled_blocks() + ring->unproven_edges;
  return sum;
}
std::size_t GearDistance::bounded() const {
  std::size_t sum = 0;
  for (const auto& ring : impl_->rings) sum += ring->patches->blocks() + ring->edges.size();
  return sum;
}
double GearDistance::cell_sag_mm() const { return impl_->sag; }
const tooth_space::ToothedPart& GearDistance::part() const { return *impl_->part; }
int GearDistance::zones() const { return int(impl_->rings.size()); }
double GearDistance::space_azimuth(int zone, double s) const {
  const auto& ring = *impl_->rings[std::size_t(zone)];
  return ring.lookup(ring.mid, s);
}
double GearDistance::least_radius(int zone) const { return impl_->rings[std::size_t(zone)]->least_radius; }

/// One point asked: every ring in turn offers what lies nearest of its sheet, its edges, its ends and lands.
class GearDistance::Impl::Question {
 public:
  Question(const Impl& part, const Vec3& asked, double within)
      : part_(part), asked_(asked), within_(within), s_(part.chart.along(asked)), h_(part.chart.up(asked)) {
    best_.distance = within;
    best_.point = asked;
  }

  NearestPlace answer() {
    if (part_.refusal) {
      best_.distance = -within_;
      best_.patch = "inside";
      return best_;
    }
    for (std::size_t zone = 0; zone < part_.rings.size(); ++zone) ask(zone);
    grooves();
    return best_;
  }

 private:
  /// The point as one ring sees it.
  struct View {
    const GearRing& ring;
    int zone;
    Vec3 c;  ///< turned to space 0
    double azimuth, h, tip, gap_s;
    [[nodiscard]] bool beside() const { return gap_s > 0; }
    [[nodiscard]] bool in_air() const {
      return beside() || h >= tip;
    }  ///< certainly: not between the ends of the ring and below its tip
  };
  /// The nearest quad of every band of every piece, apart for whole quads and for those that reach beyond the ring: the
  /// nearest point of such a one may not exist, and must not hide a farther one that does.
  struct Seed {
    double d = INFINITY;
    std::size_t quad = 0;
  };
  struct Seeds {
    std::array<Seed, 2 * tooth_space::kPieces * kBands> of_band;
    double d_mesh = INFINITY;  ///< to whole quads
    double search = 0, slack = 0;
  };

  void take(double d, bool exact, int zone, const char* patch, const Vec3& foot, const Vec3& at) {
    if (d < best_.distance) best_ = {d, exact, zone, patch, foot, at};
  }

  void ask(std::size_t zone) {
    const auto& ring = *part_.rings[zone];
    const double gap_s = std::max({ring.s_from - s_, s_ - ring.s_to, 0.0});
    if (gap_s >= best_.distance) return;
    const double tip = ring.space.tip(std::clamp(s_, ring.s_from, ring.s_to));
    if (h_ - tip >= best_.distance * 1.5 && ring.tip_slope < kFlatTip) return;
    // The space whose opening lies next: its root may stand off the middle of its opening by a good part of a pitch.
    const double middle = ring.lookup(ring.opening, s_);
    const double away = std::remainder(toothpath::azimuth(asked_) - middle, kTwoPi);
    const double index = std::round(away / part_.pitch);
    const View at{ring, int(zone), part_.to_space_0(asked_, index), middle + away - index * part_.pitch, h_,
                  tip,  gap_s};
    const Seeds seeds = seeds_of(at);
    const bool found = sheet(at, seeds);
    edges(at);
    // Newton must agree with the facets; where it does not, the facets decide with their sag.
    if (best_.distance > seeds.d_mesh + seeds.slack)
      take(seeds.d_mesh - ring.facet_sag, false, at.zone, "flank", at.c, at.c);
    end_faces(at);
    land_or_inside(at, found);
  }

  [[nodiscard]] Seeds seeds_of(const View& at) const {
    const auto& ring = at.ring;
    const Vec3& c = at.c;
    Seeds s;
    s.search = std::min(within_, best_.distance) + ring.facet_sag;
    s.slack =
        2 * ring.facet_sag + kTreeError;  // a facet farther than the nearest by this does not hold the nearest point
    const auto keep = [&](std::size_t k, double d) {
      const auto& quad = ring.quads[k];
      auto& seed = s.of_band[(std::size_t(quad.piece) * kBands + quad.band) * 2 + quad.border];
      if (d < seed.d || (d == seed.d && k < seed.quad)) seed = {d, k};
    };
    s.d_mesh = ring.whole_facets.near(c, s.search, s.slack, keep);
    ring.border_facets.near(c, std::min(s.d_mesh + s.slack, s.search), INFINITY, keep);
    return s;
  }

  /// Newton from every seed that can win. Did it find the sheet, on the ring or on its continuation?
  bool sheet(const View& at, const Seeds& seeds) {
    const auto& ring = at.ring;
    bool found = false;
    double accepted = INFINITY;                        // the best foot on the ring
    double beyond = INFINITY, beyond_seed = INFINITY;  // signed distance to the continuation
    for (const auto& seed : seeds.of_band) {
      // A seed whose facet is farther than the best exact distance cannot win.
      if (!(seed.d <= std::min(seeds.d_mesh + seeds.slack, seeds.search))) continue;
      if (seed.d - ring.facet_sag > accepted) continue;
      const auto& quad = ring.quads[seed.quad];
      const auto foot = ring.space.foot(quad.piece, at.c, quad.u, quad.v);
      // On the piece, not on its continuation beyond its borders?
      if (!foot || !ring.space.borders(quad.piece).hold(foot->u, ring.space.outline().join)) continue;
      if (foot->distance < 0 && at.in_air()) continue;  // seen through an end of the ring or the tip
      found = true;
      if (ring.on_ring(foot->at.p)) {
        accepted = std::min(accepted, foot->distance);
        take(foot->distance, true, at.zone, to_string(quad.piece), foot->at.p, at.c);
      } else if (seed.d < beyond_seed) {
        beyond = foot->distance;
        beyond_seed = seed.d;
      }
    }
    // Inside the material beside an end or below a tip edge: the nearest surface is that end or land.
    if (beyond < 0 && accepted == INFINITY) take(beyond, false, at.zone, "inside", at.c, at.c);
    return found;
  }

  void edges(const View& at) {
    const auto& ring = at.ring;
    const double look = std::min(within_, best_.distance) + ring.edge_sag;
    if (!(look > 0)) return;
    ring.edge_facets.near(at.c, look, ring.edge_sag + kTreeError, [&](std::size_t k, double d) {
      const auto& e = ring.edges[k];
      take(d - e.sag, false, at.zone, e.patch, e.a, at.c);
    });
  }

  void end_faces(const View& at) {
    if (!at.beside() || at.gap_s >= best_.distance) return;  // no nearer than what was found
    const auto& profile = s_ < at.ring.s_from ? at.ring.end_from : at.ring.end_to;
    if (profile.size() > 2 && in_material(profile, at.azimuth, h_, at.tip))
      take(at.gap_s, true, at.zone, "end", at.c, at.c);
  }

  void land_or_inside(const View& at, bool found) {
    const auto& ring = at.ring;
    if (h_ >= at.tip) {
      double foot = 0;
      const double d = ring.to_tip_meridian(s_, h_, foot);
      if (ring.over_land(at.azimuth, foot)) {
        const double tip = ring.space.tip(foot), r = ring.chart.r(foot, tip), from_axis = radius(asked_);
        take(d, ring.tip_sag == 0, at.zone, "tip",
             Vec3(at.c.x() * r / from_axis, at.c.y() * r / from_axis, ring.chart.z(foot, tip)), at.c);
      }
    } else if (!at.beside() && !found) {
      // No surface near: either free in a wide space or deep inside the material.
      if (ring.over_land(at.azimuth, s_) || ring.in_material_at(s_, at.azimuth, h_, at.tip))
        take(-within_, false, at.zone, "inside", at.c, at.c);
    }
  }

  void grooves() {
    if (!part_.groove || std::max(part_.groove->from - s_, s_ - part_.groove->to) > 0) return;
    const double above = h_ - part_.groove_floor;
    take(above, true, 0, "groove", asked_ - above * part_.chart.up_at(toothpath::azimuth(asked_)), asked_);
  }

  const Impl& part_;
  const Vec3& asked_;
  double within_, s_, h_;
  NearestPlace best_;
};

/// @param facets  facets(ring, least): how far the places keep from the facets of a ring, up to `least`
template <typename Facets>
double GearDistance::Impl::keeps(const Extent& places, double within, const Facets& facets) const {
  if (refusal) return 0;
  double least = within;
  for (const auto& made : rings) {
    const auto& ring = *made;
    if (std::max(ring.s_from - places.s.high, places.s.low - ring.s_to) >= least) continue;
    least = facets(ring, least);
    // The facets of the ends stop below the roots, the ring goes on.
    least = std::min(least, std::hypot(std::max(places.h.low - ring.base_mm, 0.0),
                                       std::min(beyond(places.s.low, places.s.high, ring.s_from),
                                                beyond(places.s.low, places.s.high, ring.s_to))));
  }
  if (groove) {
    const double beside = std::max({groove->from - places.s.high, places.s.low - groove->to, 0.0});
    least = std::min(least, std::hypot(beside, beyond(places.h.low, places.h.high, groove_floor)));
  }
  return std::max(least, 0.0);
}

double GearDistance::surface_keeps(const Vec3& p, double within) const {
  const double s = impl_->chart.along(p), h = impl_->chart.up(p), at = toothpath::azimuth(p);
  return impl_->keeps({{s, s}, {h, h}}, within, [&](const GearRing& ring, double least) {
    const Vec3 c = impl_->to_space_0(p, std::round(impl_->spaces_from_0(ring, s, at)));
    const double lost = ring.facet_sag + kTreeError;
    for (const auto* facets : {&ring.whole_facets, &ring.border_facets, &ring.other_facets})
      least = std::min(least, facets->least(c, least + lost) - lost);
    return least;
  });
}

double GearDistance::surface_keeps(const Vec3& from, const Vec3& axis, double length, double within) const {
  const Vec3 to = from + length * axis, middle = 0.5 * (from + to);
  const double half = 0.5 * std::hypot(to.x() - from.x(), to.y() - from.y()), r = radius(middle),
               at = toothpath::azimuth(middle);
  const tooth_space::Chart& chart = impl_->chart;
  const double s = chart.along(middle),
               way = 0.5 * std::abs(chart.sine * (to.z() - from.z())) + std::abs(chart.cosine) * half;
  const tooth_space::Range rs{radius_of_line(from, to), std::max(radius(from), radius(to))},
      zs{std::min(from.z(), to.z()), std::max(from.z(), to.z())};
  const Extent places{chart.along(rs, zs), chart.up(rs, zs)};
  return impl_->keeps(places, within, [&](const GearRing& ring, double least) {
    // The spaces in which places of the line stand: each sees the facets of its own.
    const double sine = half / r;
    if (!(sine < kShortLine)) return 0.0;
    const double turn = sine / std::sqrt(1 - sine * sine) + ring.opening_slope * way,
                 about = 0.5 + 1e-9 + turn / impl_->pitch, middle_space = impl_->spaces_from_0(ring, s, at);
    const double lost = ring.facet_sag + kTreeError;
    for (double k = std::ceil(middle_space - about); k <= middle_space + about; ++k) {
      const double space = std::remainder(k, double(impl_->part->teeth()));
      const Vec3 c = impl_->to_space_0(from, space), along = impl_->to_space_0(axis, space);
      for (const auto* facets : {&ring.whole_facets, &ring.border_facets, &ring.other_facets})
        least = std::min(least, facets->least_along(c, along, length, least + lost) - lost);
    }
    return least;
  });
}

NearestPlace GearDistance::nearest(const Vec3& asked, double within) const {
  return Impl::Question(*impl_, asked, within).answer();
}

}  // namespace toothpath::analytic
