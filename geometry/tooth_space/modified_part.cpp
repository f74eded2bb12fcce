#include "geometry/tooth_space/modified_part.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/tooth_space/flank_depth.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::tooth_space {
namespace {

using modification::Field;
using modification::FlankCorrection;
using modification::SmoothCurve;

/// What moves one flank.
struct Moved {
  FlankRectangle rectangle;
  Field drawn;
  const FlankCorrection* measured = nullptr;  ///< may be null
  SmoothCurve turns{0};  ///< over s: slope of the fillet's offset at its flank, beyond what the field says there
};

constexpr int kTurnStations = 65;   // along the tooth, where the slope of a fillet's offset is sought
constexpr int kDepthStations = 33;  // along the tooth, where the depth of the fillet line is sought
constexpr double kStraight = 1e-9;  // of the depth: a fillet line that is bent by less is straight
constexpr double kJoin =
    3e-5;  // of u: moved pieces share their normals to 1e-6; a foot so little beyond is right to 1e-6 mm

/// Over a fillet, 0 at its flank and 1 at the root: carry value and slope from there to nothing.
const SmoothCurve kFades({0, 1}, {{0, {1, 0, -3, 2}}}), kSwings({0, 1}, {{0, {0, 1, -2, 1}}});

class ModifiedSpace final : public ToothSpace {
 public:
  /// @param kept  keeps the fields of a correction alive
  ModifiedSpace(const ExactSpace& plain, Moved plus, Moved minus,
                std::shared_ptr<const modification::RingCorrection> kept)
      : plain_(plain), outline_(plain.outline()), moved_{std::move(plus), std::move(minus)}, kept_(std::move(kept)) {
    outline_.join = kJoin;
    for (const int side : {1, -1}) moved_[side > 0 ? 0 : 1].turns = turns_of(side);
  }

  [[nodiscard]] const Outline& outline() const override { return outline_; }
  [[nodiscard]] double tip(double s) const override { return plain_.tip(s); }
  [[nodiscard]] CurveBend tip_bend(double s_from, double s_to) const override { return plain_.tip_bend(s_from, s_to); }
  [[nodiscard]] Borders borders(Piece piece) const override { return plain_.borders(piece); }
  [[nodiscard]] Borders active(Piece flank) const override { return plain_.active(flank); }

  [[nodiscard]] std::optional<PatchPoint> at(Piece piece, double u, double v) const override {
    if (side_of(piece) == 0) return plain_.at(piece, u, v);
    const auto skin = plain_.second(piece, u, v);
    if (!skin) return {};
    const Vec3T<Second> p = skin->p + skin->n * offset(piece, second_variable(u, 0), *skin);
    return patch_of(p, Vec3(skin->n[0].v.v, skin->n[1].v.v, skin->n[2].v.v));
  }
  [[nodiscard]] std::optional<PatchFoot> foot(Piece piece, const Vec3& c, double u, double v) const override {
    if (side_of(piece) == 0) return plain_.foot(piece, c, u, v);
    return search_foot(*this, piece, c, u, v, plain_.longest_steps(piece));
  }
  [[nodiscard]] std::optional<EdgePlace> tip_edge(int side, double s,
                                                  const std::optional<EdgePlace>& near = {}) const override {
    const auto start = near ? near : plain_.tip_edge(side, s);
    return start ? search_tip_edge(*this, side, s, {start->u, start->v}, near) : std::nullopt;
  }
  [[nodiscard]] std::optional<EdgePlace> plain_tip_edge(int side, double s,
                                                        const std::optional<EdgePlace>& near = {}) const override {
    return plain_.tip_edge(side, s, near);
  }
  [[nodiscard]] std::optional<double> start_v(Piece piece, double u, double s, double distance,
                                              const std::optional<Near>& near, int attempt) const override {
    return plain_.start_v(piece, u, s, distance, near, attempt);
  }
  [[nodiscard]] double longest_step(Piece piece, double s) const override { return plain_.longest_step(piece, s); }

  /// The offset is small, so that its own levers may be long.
  [[nodiscard]] std::optional<Jet> enclosure(Piece piece, const PatchFrame& frame, double half_a,
                                             double half_b) const override {
    if (side_of(piece) == 0) return plain_.enclosure(piece, frame, half_a, half_b);
    const auto skin = plain_.boxed(piece, frame, half_a, half_b);
    if (!skin) return {};
    const BoxParameters box(frame, half_a, half_b);
    Jet jet;
    jet.add(skin->p);
    jet.add(Vec3T<BoxSecond>(skin->n * offset(piece, box.u, *skin)));
    return jet;
  }

 private:
  /// Along the normal out of the material, mm.
  template <typename S>
  [[nodiscard]] S offset(Piece piece, const S& u, const Skin<S>& skin) const {
    const Moved& moved = moved_[side_of(piece) > 0 ? 0 : 1];
    const S y = moved.rectangle.down(skin.along, skin.depth), x = moved.rectangle.along(skin.along);
    S c = -moved.drawn.removal(y, x);
    if (moved.measured) c = c + moved.measured->offset(S(y / S(moved.rectangle.on.depth_mm)), x);
    if (!is_fillet(piece)) return c;
    const auto [flank, root] = ends_of(piece);
    const S t = (u - S(flank)) / S(root - flank);
    return c * kFades(t) + moved.turns(skin.along) * kSwings(t);
  }

  /// u of a fillet at its flank and at the root.
  struct Ends {
    double flank = 0, root = 0;
  };
  [[nodiscard]] Ends ends_of(Piece fillet) const {
    const Borders b = plain_.borders(fillet);
    return side_of(fillet) > 0 ? Ends{b.from, b.to} : Ends{b.to, b.from};
  }

  /// Flank and fillet bend differently, so that the same field turns their normals differently by a term of second
  /// order: the slope that takes it back, along the fillet line. Where a place is not found the one before it holds.
  [[nodiscard]] SmoothCurve turns_of(int side) const {
    const Piece flank = flank_of(side), fillet = fillet_of(side);
    const Borders b = plain_.borders(flank);
    const double u_flank = side > 0 ? b.to : b.from;
    const Ends ends = ends_of(fillet);
    std::vector<double> stations, slopes;
    for (int k = 0; k < kTurnStations; ++k) {
      const double s = outline_.s_from + (outline_.s_to - outline_.s_from) * k / (kTurnStations - 1);
      stations.push_back(s);
      slopes.push_back(slopes.empty() ? 0 : slopes.back());
      const auto v_flank = v_at(plain_, flank, u_flank, s), v_fillet = v_at(plain_, fillet, ends.flank, s);
      const auto on = v_flank ? at(flank, u_flank, *v_flank) : std::nullopt;
      const auto skin = v_fillet ? plain_.second(fillet, ends.flank, *v_fillet) : std::nullopt;
      if (!on || !skin) continue;
      const Second c = offset(fillet, second_variable(ends.flank, 0), *skin);
      const auto first = [](const Vec3T<Second>& x) { return Vec3(x[0].v.d[0], x[1].v.d[0], x[2].v.d[0]); };
      const Vec3 n(skin->n[0].v.v, skin->n[1].v.v, skin->n[2].v.v);
      const double asked = -on->n.dot(first(skin->p) + c.v.v * first(skin->n)) / on->n.dot(n);
      slopes.back() = (asked - c.v.d[0]) * (ends.root - ends.flank);
    }
    return SmoothCurve::spline(stations, slopes);
  }

  const ExactSpace& plain_;
  Outline outline_;
  std::array<Moved, 2> moved_;
  std::shared_ptr<const modification::RingCorrection> kept_;
};

class ModifiedPart final : public ToothedPart {
 public:
  /// @param spaces  one a zone; none: the plain one
  ModifiedPart(std::shared_ptr<const ToothedPart> plain, std::vector<std::unique_ptr<const ToothSpace>> spaces)
      : plain_(std::move(plain)), spaces_(std::move(spaces)) {}

  [[nodiscard]] int teeth() const override { return plain_->teeth(); }
  [[nodiscard]] int zones() const override { return plain_->zones(); }
  [[nodiscard]] const ToothSpace& space(int zone) const override {
    const auto& own = spaces_[std::size_t(zone)];
    return own ? *own : plain_->space(zone);
  }
  [[nodiscard]] double module_mm() const override { return plain_->module_mm(); }
  [[nodiscard]] double lowest_root() const override { return plain_->lowest_root(); }
  [[nodiscard]] std::optional<double> groove_floor() const override { return plain_->groove_floor(); }
  [[nodiscard]] double blank_top() const override { return plain_->blank_top(); }
  [[nodiscard]] bool in_blank(const Vec3& p) const override { return plain_->in_blank(p); }
  [[nodiscard]] std::optional<Refusal> refusal(int zone) const override { return plain_->refusal(zone); }
  [[nodiscard]] std::string close_to_limit(int zone) const override { return plain_->close_to_limit(zone); }

 private:
  std::shared_ptr<const ToothedPart> plain_;
  std::vector<std::unique_ptr<const ToothSpace>> spaces_;
};

/// Straight where the fillet line is, else cubics with its values and slopes.
std::optional<SmoothCurve> share_of_depth(const ToothSpace& space, int side, const FlankDepth& depth) {
  const Outline& ring = space.outline();
  const Piece piece = flank_of(side);
  const Borders b = space.borders(piece);
  std::vector<double> stations, shares, slopes;
  double bent = 0;
  for (int k = 0; k < kDepthStations; ++k) {
    const double s = ring.s_from + (ring.s_to - ring.s_from) * k / (kDepthStations - 1);
    const auto q = place_at(space, piece, side > 0 ? b.to : b.from, s);
    if (!q) return {};
    stations.push_back(s);
    shares.push_back((space.tip(s) - ring.chart.up(q->p)) / depth.middle_mm);
    const double rise = ring.chart.up(q->p, q->pv) / ring.chart.along(q->p, q->pv);
    slopes.push_back((space.tip_bend(s, s).slope.middle() - rise) / depth.middle_mm);
    if (!(shares.back() > 0) || !std::isfinite(slopes.back())) return {};
    bent = std::max(bent, std::abs(shares.back() - depth.share(s)));
  }
  if (depth.growth == 0 && bent <= kStraight) return SmoothCurve(1);
  if (bent <= kStraight) return SmoothCurve({ring.s_from, ring.s_to}, {{depth.s_middle, {1, depth.growth}}});
  return SmoothCurve::hermite(std::move(stations), shares, slopes);
}

}  // namespace

std::optional<FlankRectangle> flank_rectangle(const ToothSpace& space, int side) {
  const auto depth = flank_depth(space, side);
  if (!depth) return {};
  const Outline& ring = space.outline();
  const auto share = share_of_depth(space, side, *depth);
  if (!share) return {};
  const auto [from, to] = ring.told(ring.s_from, ring.s_to);
  return FlankRectangle{{depth->middle_mm, from, to}, *share, ring.sign};
}

Expected<std::shared_ptr<const ToothedPart>, Refusal> modified_part(
    std::shared_ptr<const ToothedPart> plain, const std::vector<modification::Modification>& modifications,
    const Corrections& corrections) {
  if (auto zones = modification::refused_zones(modifications, plain->zones()); !zones.empty())
    return std::move(zones.front());
  std::vector<std::unique_ptr<const ToothSpace>> spaces;
  for (int zone = 0; zone < plain->zones(); ++zone) {
    const auto correction =
        std::size_t(zone) < corrections.size() ? corrections[std::size_t(zone)] : Corrections::value_type{};
    const auto* exact = dynamic_cast<const ExactSpace*>(&plain->space(zone));
    if (!exact) return Refusal{"modification", fail("the flanks of zone {} are known by places alone", zone)};
    std::array<std::optional<Moved>, 2> moved;
    for (const int side : {1, -1}) {
      const auto rectangle = flank_rectangle(*exact, side);
      if (!rectangle)
        return Refusal{"modification", fail("flank {:+d} of zone {} has no fillet line below its tip", side, zone)};
      if (auto refusal = modification::refused(modifications, zone, rectangle->on)) return std::move(*refusal);
      moved[side > 0 ? 0 : 1] = Moved{*rectangle, Field(modifications, side, zone, rectangle->on),
                                      correction ? &correction->side(side) : nullptr};
    }
    const bool stays = moved[0]->drawn.empty() && moved[1]->drawn.empty() && !correction;
    spaces.push_back(
        stays ? nullptr
              : std::make_unique<ModifiedSpace>(*exact, std::move(*moved[0]), std::move(*moved[1]), correction));
  }
  return std::shared_ptr<const ToothedPart>(std::make_shared<ModifiedPart>(std::move(plain), std::move(spaces)));
}

}  // namespace toothpath::tooth_space
