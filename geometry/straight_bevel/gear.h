// A whole straight bevel gear: its tooth space and its limits; refuses with key, value and limit.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/straight_bevel/crown_kernel.h"
#include "geometry/tooth_space/kernel_space.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::straight_bevel {

using CrownSpace = tooth_space::KernelSpace<CrownKernel<double>>;

class StraightBevelGear {
 public:
  /// Checks every limit of the gear. On failure returns all refusals.
  static Expected<StraightBevelGear, std::vector<Refusal>> make(const StraightBevelParameters& parameters);

  [[nodiscard]] const StraightBevelParameters& parameters() const { return parameters_; }
  [[nodiscard]] const CrownSpace& space() const { return *space_; }
  /// Half angle of the root cone.
  [[nodiscard]] double root_angle() const { return parameters_.pitch_angle_rad - space_->kernel().theta_f; }

 private:
  StraightBevelParameters parameters_;
  std::shared_ptr<const CrownSpace> space_;
};

/// The gear as planners and proofs ask for it. The blank is turned: face cone, back and front cone, bore. The gear is
/// copied.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const StraightBevelGear& gear);

/// The finished gear, which must outlive it. Both ends go down half a module below the roots there, the body behind
/// them is flat; without a bore it reaches to the axis.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const StraightBevelGear& gear);
/// z of the front of that body and of its back, hub included. mm
[[nodiscard]] std::array<double, 2> body_ends(const StraightBevelGear& gear);

/// Arc of the top land on the face cone at s. mm
[[nodiscard]] double top_land_mm(const CrownSpace& space, double s);
/// How the curve of the flank turns across the space at u, in the sense of the whole flank: 0 or less is undercut.
[[nodiscard]] double flank_speed(const CrownKernel<double>& kernel, double u);

}  // namespace toothpath::straight_bevel
