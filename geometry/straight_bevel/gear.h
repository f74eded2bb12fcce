// A whole straight bevel gear: its tooth space and its limits; refuses with key, value and limit.
#pragma once

#include <memory>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/straight_bevel/crown_kernel.h"
#include "geometry/tooth_space/bevel_body.h"
#include "geometry/tooth_space/kernel_space.h"

// Made once, in gear.cpp: it takes long to compile.
extern template class toothpath::tooth_space::KernelSpace<toothpath::straight_bevel::CrownKernel<double>>;

namespace toothpath::straight_bevel {

using CrownSpace = tooth_space::KernelSpace<CrownKernel<double>>;

class StraightBevelGear {
 public:
  /// Checks every limit of the gear. On failure returns all refusals.
  static Expected<StraightBevelGear, std::vector<Refusal>> make(const StraightBevelParameters& parameters);

  [[nodiscard]] const StraightBevelParameters& parameters() const { return parameters_; }
  [[nodiscard]] const CrownSpace& space() const { return *space_; }
  [[nodiscard]] std::shared_ptr<const CrownSpace> shared_space() const { return space_; }
  [[nodiscard]] const tooth_space::BevelBody& body() const { return body_; }
  /// Half angle of the root cone.
  [[nodiscard]] double root_angle() const { return parameters_.pitch_angle_rad - space_->kernel().theta_f; }

 private:
  StraightBevelParameters parameters_;
  std::shared_ptr<const CrownSpace> space_;
  tooth_space::BevelBody body_;
};

/// The gear as planners and proofs ask for it.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const StraightBevelGear& gear);
/// The finished gear, which must outlive it.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const StraightBevelGear& gear);

/// How the curve of the flank turns across the space at u, in the sense of the whole flank: 0 or less is undercut.
[[nodiscard]] double flank_speed(const CrownKernel<double>& kernel, double u);

}  // namespace toothpath::straight_bevel
