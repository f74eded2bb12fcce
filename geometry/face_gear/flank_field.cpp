#include "geometry/face_gear/flank_field.h"

#include <Eigen/LU>
#include <cmath>

#include "geometry/face_gear/limits.h"
#include "geometry/face_gear/space_sheet.h"

namespace toothpath::face_gear {
namespace {

constexpr int kRadii = 33, kHeights = 49, kFilletPlaces = 13;

/// Most hollow principal curvature, 1/mm; negative where the surface is hollow.
double most_hollow(const PatchPoint& q) {
  const double E = q.pu.squaredNorm(), F = q.pu.dot(q.pv), G = q.pv.squaredNorm();
  const double e = q.nu.dot(q.pu), f = 0.5 * (q.nu.dot(q.pv) + q.nv.dot(q.pu)), g = q.nv.dot(q.pv);
  const double det = E * G - F * F, mean = 0.5 * (e * G - 2 * f * F + g * E) / det, gauss = (e * g - f * f) / det;
  return mean - std::sqrt(std::max(0.0, mean * mean - gauss));
}

double hollow_radius(const PatchPoint& q) {
  const double k = most_hollow(q);
  return k < 0 ? -1 / k : INFINITY;
}

/// Visits both sheets at the same places, from the tip to the root: plain and modified point.
class Look {
 public:
  Look(const FaceGearParameters& gear, const FaceGearRing& ring)
      : ring_(ring), modified_(gear, ring.drawn()), plain_(gear, plain_ring(ring)) {
    form_.hollow_flank.value = form_.hollow_fillet.value = form_.land_mm.value = INFINITY;
    form_.plain_hollow_flank_mm = form_.plain_hollow_fillet_mm = INFINITY;
  }

  ModifiedForm form() {
    for (int k = 0; k < kRadii; ++k) {
      const double r =
          ring_.zone.inner_radius_mm + (ring_.zone.outer_radius_mm - ring_.zone.inner_radius_mm) * k / (kRadii - 1);
      for (const int side : {1, -1}) column(side, r);
      land(r);
    }
    return form_;
  }

 private:
  static FaceGearRing plain_ring(const FaceGearRing& ring) {
    FaceGearRing out = ring.drawn();
    out.modification = nullptr;
    return out;
  }
  static void note(ModifiedForm::Most& most, double value, bool better, int side, const PatchPoint& at) {
    if (better) most = {value, side, std::hypot(at.p.x(), at.p.y()), at.p.z()};
  }

  void column(int side, double r) {
    const auto& f = ring_.surface;
    const auto low = fillet_line_height(f, side, r);
    const auto top = invert_flank(f, side, r, f.z_tip(r));
    if (!low || !top) return;
    std::optional<FlankCoordinates> near = top;
    for (int n = 0; n < kHeights && near; ++n) {
      const double z = f.z_tip(r) + (*low - f.z_tip(r)) * n / (kHeights - 1);
      near = invert_flank(f, side, r, z, near);
      if (near && near->theta >= 0) flank(side, near->theta, near->B);
    }
    const auto Z_t = near ? std::optional(f.flank_Z(side, near->theta, near->B)) : std::nullopt;
    for (int n = 0; n < kFilletPlaces && Z_t && f.shaper.rho > 0; ++n)
      fillet(side, f.shaper.A_t + (f.shaper.A_e - f.shaper.A_t) * n / (kFilletPlaces - 1), *Z_t);
  }

  void flank(int side, double theta, double B) {
    const auto piece = tooth_space::flank_of(side);
    const auto q = modified_.at(piece, theta, B), p = plain_.at(piece, theta, B);
    if (!q || !p) return;
    const double removed = (p->p - q->p).dot(p->n), turned = std::acos(std::min(1.0, p->n.dot(q->n)));
    note(form_.removed_mm, removed, removed > form_.removed_mm.value, side, *q);
    note(form_.turned_rad, turned, turned > form_.turned_rad.value, side, *q);
    const double hollow = hollow_radius(*q);
    note(form_.hollow_flank, hollow, hollow < form_.hollow_flank.value, side, *q);
    form_.plain_hollow_flank_mm = std::min(form_.plain_hollow_flank_mm, hollow_radius(*p));
  }

  void fillet(int side, double A, double Z) {
    const auto piece = tooth_space::fillet_of(side);
    const auto q = modified_.at(piece, A, Z), p = plain_.at(piece, A, Z);
    if (!q || !p) return;
    const double hollow = hollow_radius(*q);
    note(form_.hollow_fillet, hollow, hollow < form_.hollow_fillet.value, side, *q);
    form_.plain_hollow_fillet_mm = std::min(form_.plain_hollow_fillet_mm, hollow_radius(*p));
  }

  void land(double r) {
    const auto width = [&](const SpaceSheet& sheet) -> std::optional<double> {
      const auto plus = sheet.tip_edge(1, r), minus = sheet.tip_edge(-1, r);
      if (!plus || !minus) return {};
      return r * (plus->azimuth - minus->azimuth);
    };
    const auto left = width(modified_), before = width(plain_);
    if (!left || !before || *left >= form_.land_mm.value) return;
    form_.land_mm = {*left, 0, r, ring_.surface.z_tip(r)};
    form_.plain_land_mm = *before;
  }

  const FaceGearRing& ring_;
  SpaceSheet modified_, plain_;
  ModifiedForm form_;
};

}  // namespace

ModifiedForm modified_form(const FaceGearParameters& gear, const FaceGearRing& ring) { return Look(gear, ring).form(); }

Expected<std::shared_ptr<const RingModification>, Refusal> ring_modification(const FaceGearParameters& gear,
                                                                             const FaceGearSurface<double>& surface,
                                                                             int zone) {
  using Made = std::shared_ptr<const RingModification>;
  if (gear.modifications.empty()) return Made{};
  const auto on = rectangle_of(surface, gear.zones[std::size_t(zone)]);
  if (auto refusal = modification::refused(gear.modifications, zone, on)) return std::move(*refusal);
  const auto of_side = [&](int side) { return modification::Field(gear.modifications, side, zone, on); };
  auto made = std::make_shared<RingModification>(RingModification{of_side(1), of_side(-1)});
  if (made->plus.empty() && made->minus.empty()) return Made{};
  return Made(std::move(made));
}

}  // namespace toothpath::face_gear
