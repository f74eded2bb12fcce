// A whole cylindrical gear: its zones, each with its tooth space, and its limits; refuses with key, value and limit.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/cylindrical/involute_kernel.h"
#include "geometry/tooth_space/kernel_space.h"

// Made once, in gear.cpp: it takes long to compile.
extern template class toothpath::tooth_space::KernelSpace<toothpath::cylindrical::InvoluteKernel<double>>;

namespace toothpath::cylindrical {

using InvoluteSpace = tooth_space::KernelSpace<InvoluteKernel<double>>;

class CylindricalGear {
 public:
  /// Checks every limit of the gear. On failure returns all refusals.
  static Expected<CylindricalGear, std::vector<Refusal>> make(const CylindricalParameters& parameters);

  [[nodiscard]] const CylindricalParameters& parameters() const { return parameters_; }
  [[nodiscard]] int zones() const { return int(spaces_.size()); }
  [[nodiscard]] const InvoluteSpace& space(int zone) const { return *spaces_[std::size_t(zone)]; }
  [[nodiscard]] double tip_diameter() const { return 2 * space(0).kernel().r_a; }
  [[nodiscard]] double root_diameter() const { return 2 * space(0).kernel().r_f; }
  /// Between two zones; 0: there is none.
  [[nodiscard]] double groove_diameter() const { return groove_diameter_mm_; }

 private:
  CylindricalParameters parameters_;
  std::vector<std::shared_ptr<const InvoluteSpace>> spaces_;
  double groove_diameter_mm_ = 0;
};

/// The least profile shift without undercut (of the rack's flank, x_min).
[[nodiscard]] double least_profile_shift(const CylindricalParameters& gear, const CylindricalZone& zone);
/// The largest rounding that the rack's tip can carry, in modules.
[[nodiscard]] double largest_root_radius_coefficient(const CylindricalParameters& gear, const CylindricalZone& zone);
/// The greatest tip diameter whose top land is `land_mm` wide; nothing where no diameter above the form circle has it.
[[nodiscard]] std::optional<double> tip_diameter_of_land(const InvoluteKernel<double>& gear, double land_mm);

/// What a shop asks of one zone. mm
struct CylindricalLimits {
  double form_diameter_mm = 0;      ///< where fillet and involute join
  double top_land_mm = 0;           ///< arc on the tip cylinder
  double fillet_radius_min_mm = 0;  ///< least concave radius of the fillet
  double root_ball_radius_mm = 0;   ///< of the largest ball that touches the root between the flanks
  double mid_flank_radius_mm = 0;   ///< convex principal radius half way up the involute; the other one is infinite
};
[[nodiscard]] CylindricalLimits limits_of(const InvoluteSpace& space);

}  // namespace toothpath::cylindrical
