#include "geometry/inspection/bevel_grid.h"

namespace toothpath::inspection {
namespace {

constexpr double kAboveFillet = 0.02;  // mm

}  // namespace

Result<std::vector<InspectionPoint>> bevel_inspection_grid(const bevel_gear::BevelGear& gear,
                                                           const InspectionOptions& o) {
  std::vector<InspectionPoint> out;
  for (std::size_t i = 0; i < gear.halves().size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const auto& half = gear.halves()[i];
      const auto& w = half.walls[k];
      const double low = w.cutter.x_B + kAboveFillet, high = gear.parameters().addendum_mm;
      for (int r = 0; r < o.rows; ++r)
        for (int c = 0; c < o.columns; ++c) {
          const double u = o.margin + (1 - 2 * o.margin) * r / (o.rows - 1),
                       v = o.margin + (1 - 2 * o.margin) * c / (o.columns - 1);
          const double height = low + (high - low) * u, ell = half.ell_from + (half.ell_to - half.ell_from) * v;
          const auto at = bevel_gear::bevel_inverse(w, ell, height);
          if (!at)
            return fail("wall {} has no point at cone distance {:.4f}, height {:.4f}", w.sigma > 0 ? "L" : "U", ell,
                        height);
          const auto f = w.point(at->beta, at->p);
          out.push_back({int(i), w.sigma, r, c, at->p, at->beta, f.p, f.n});
        }
    }
  return out;
}

}  // namespace toothpath::inspection
