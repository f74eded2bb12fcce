#include "geometry/tooth_space/modified_form.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/result.h"
#include "geometry/tooth_space/curvature.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::tooth_space {
namespace {

constexpr int kStations = 33, kHeights = 49, kFilletPlaces = 13;
/// Of both flanks alike the first counts, whatever rounding makes of them.
constexpr double kAlike = 1e-9;
bool more(double a, double b) { return a > b + kAlike * std::abs(b); }
bool less(double a, double b) { return a + kAlike * std::abs(a) < b; }

constexpr double kMostTurned = 0.1;  // rad: of a normal by modifications; beyond it amounts are no small offsets

double hollow_radius(const PatchPoint& q) {
  const double k = principal_curvatures(q).least;
  return k < 0 ? -1 / k : INFINITY;
}

/// Visits both surfaces at the same places, from the tip to the root: plain and modified point.
class Look {
 public:
  Look(const ToothSpace& plain, const ToothSpace& modified) : plain_(plain), modified_(modified) {
    form_.hollow_flank.value = form_.hollow_fillet.value = form_.land_mm.value = INFINITY;
    form_.plain_hollow_flank_mm = form_.plain_hollow_fillet_mm = INFINITY;
  }

  ModifiedForm form() {
    const Outline& ring = plain_.outline();
    for (int k = 0; k < kStations; ++k) {
      const double s = ring.s_from + (ring.s_to - ring.s_from) * k / (kStations - 1);
      for (const int side : {1, -1}) {
        flank(side, s);
        fillet(side, s);
      }
      land(s);
    }
    return form_;
  }

 private:
  static void note(ModifiedForm::Most& most, double value, bool better, int side, const PatchPoint& at) {
    if (better) most = {value, side, radius(at.p), at.p.z()};
  }

  void flank(int side, double s) {
    const Piece piece = flank_of(side);
    const auto tip = plain_.tip_edge(side, s);
    if (!tip) return;
    const Borders b = plain_.borders(piece);
    const double low = side > 0 ? b.to : b.from;
    for (int n = 0; n < kHeights; ++n) {
      const double u = tip->u + (low - tip->u) * n / (kHeights - 1);
      const auto v = v_at(plain_, piece, u, s);
      const auto p = v ? plain_.at(piece, u, *v) : std::nullopt, q = v ? modified_.at(piece, u, *v) : std::nullopt;
      if (!p || !q) continue;
      const double removed = (p->p - q->p).dot(p->n), turned = std::acos(std::min(1.0, p->n.dot(q->n)));
      note(form_.removed_mm, removed, more(removed, form_.removed_mm.value), side, *q);
      note(form_.turned_rad, turned, more(turned, form_.turned_rad.value), side, *q);
      const double hollow = hollow_radius(*q);
      note(form_.hollow_flank, hollow, less(hollow, form_.hollow_flank.value), side, *q);
      form_.plain_hollow_flank_mm = std::min(form_.plain_hollow_flank_mm, hollow_radius(*p));
    }
  }

  void fillet(int side, double s) {
    const Piece piece = fillet_of(side);
    const Borders b = plain_.borders(piece);
    for (int n = 0; n < kFilletPlaces; ++n) {
      const double u = b.from + (b.to - b.from) * n / (kFilletPlaces - 1);
      const auto v = v_at(plain_, piece, u, s);
      const auto p = v ? plain_.at(piece, u, *v) : std::nullopt, q = v ? modified_.at(piece, u, *v) : std::nullopt;
      if (!p || !q) continue;
      const double hollow = hollow_radius(*q);
      note(form_.hollow_fillet, hollow, less(hollow, form_.hollow_fillet.value), side, *q);
      form_.plain_hollow_fillet_mm = std::min(form_.plain_hollow_fillet_mm, hollow_radius(*p));
    }
  }

  void land(double s) {
    const double tip = plain_.tip(s), r = plain_.outline().chart.r(s, tip);
    const auto width = [&](const ToothSpace& space) -> std::optional<double> {
      const auto plus = space.tip_edge(1, s), minus = space.tip_edge(-1, s);
      if (!plus || !minus) return {};
      return r * (plus->azimuth - minus->azimuth);
    };
    const auto left = width(modified_), before = width(plain_);
    if (!left || !before || *left >= form_.land_mm.value) return;
    form_.land_mm = {*left, 0, r, plain_.outline().chart.z(s, tip)};
    form_.plain_land_mm = *before;
  }

  const ToothSpace &plain_, &modified_;
  ModifiedForm form_;
};

}  // namespace

ModifiedForm modified_form(const ToothSpace& plain, const ToothSpace& modified) { return Look(plain, modified).form(); }

std::optional<Refusal> refused(const ModifiedForm& form, int zone) {
  if (!(form.turned_rad.value <= kMostTurned))
    return Refusal{"modification",
                   fail("zone {}: the modifications turn the normal of flank {:+d} by {:.4f} rad at radius {:.4f} mm, "
                        "height {:.4f} mm, limit {:g}: a longer length or transition, or less amount, would do",
                        zone, form.turned_rad.side, form.turned_rad.value, form.turned_rad.radius_mm,
                        form.turned_rad.height_mm, kMostTurned)};
  if (!(form.land_mm.value > 0))
    return Refusal{"modification",
                   fail("zone {}: the modifications leave a top land of {:.4f} mm at radius {:.4f} mm (plain {:.4f} "
                        "mm), limit 0: the tooth is pointed",
                        zone, form.land_mm.value, form.land_mm.radius_mm, form.plain_land_mm)};
  return {};
}

std::string narrow_land(const ModifiedForm& form, int zone, double least_mm) {
  if (form.land_mm.value >= least_mm || form.plain_land_mm < least_mm) return {};
  return fmt::format(
      "zone {}: the modifications leave a top land of {:.4g} mm at radius {:.4f} mm, below {:.4g} mm; the plain tooth "
      "has {:.4g} mm",
      zone, form.land_mm.value, form.land_mm.radius_mm, least_mm, form.plain_land_mm);
}

}  // namespace toothpath::tooth_space
