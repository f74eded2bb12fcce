// A whole spiral bevel gear: its tooth space and its limits; refuses with key, value and limit.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/spiral_bevel/cutter_kernel.h"
#include "geometry/tooth_space/bevel_body.h"
#include "geometry/tooth_space/kernel_space.h"

// Made once, in gear.cpp: it takes long to compile.
extern template class toothpath::tooth_space::KernelSpace<toothpath::spiral_bevel::CutterKernel>;

namespace toothpath::spiral_bevel {

using CutterSpace = tooth_space::KernelSpace<CutterKernel>;

class SpiralBevelGear {
 public:
  /// Checks every limit of the gear. On failure returns all refusals of the first step that finds any.
  static Expected<SpiralBevelGear, std::vector<Refusal>> make(const SpiralBevelParameters& parameters);

  [[nodiscard]] const SpiralBevelParameters& parameters() const { return parameters_; }
  [[nodiscard]] const CutterSpace& space() const { return *space_; }
  [[nodiscard]] std::shared_ptr<const CutterSpace> shared_space() const { return space_; }
  [[nodiscard]] const tooth_space::BevelBody& body() const { return body_; }
  /// Arc on the pitch circle at the mean cone distance. mm
  [[nodiscard]] double space_width_mm() const { return space_width_mm_; }
  /// At the middle of the face on the pitch cone, of a side, rad; positive: the gear's own hand.
  [[nodiscard]] double spiral_angle(int side) const;

 private:
  SpiralBevelParameters parameters_;
  std::shared_ptr<const CutterSpace> space_;
  tooth_space::BevelBody body_;
  double space_width_mm_ = 0;
};

/// The gear as planners and proofs ask for it.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const SpiralBevelGear& gear);
/// The finished gear, which must outlive it.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const SpiralBevelGear& gear);

/// Arc of the root between the fillets at s. mm
[[nodiscard]] double root_land_mm(const CutterSpace& space, double s);

}  // namespace toothpath::spiral_bevel
