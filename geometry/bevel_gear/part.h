// An equal-base-circle bevel gear as planners and proofs of ball mills, meshes, solids and measuring see it: one ring
// of teeth a half.
#pragma once

#include <memory>
#include <vector>

#include "geometry/bevel_gear/wall_kernel.h"
#include "geometry/tooth_space/kernel_space.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::bevel_gear {

using WallSpace = tooth_space::KernelSpace<WallKernel>;

/// Is the place in the blank? It is turned: face cone, the groove of a herringbone down to the root, ends square to the
/// pitch cone.
[[nodiscard]] bool in_blank(const BevelGear& gear, const Vec3& p);

class BevelPart final : public tooth_space::ToothedPart {
 public:
  explicit BevelPart(BevelGear gear);

  [[nodiscard]] const BevelGear& gear() const { return gear_; }
  [[nodiscard]] int teeth() const override { return gear_.parameters().teeth; }
  [[nodiscard]] int zones() const override { return static_cast<int>(spaces_.size()); }
  [[nodiscard]] const WallSpace& space(int zone) const override { return spaces_[static_cast<std::size_t>(zone)]; }
  [[nodiscard]] double module_mm() const override { return gear_.parameters().outer_transverse_module_mm; }
  [[nodiscard]] double lowest_root() const override { return -gear_.parameters().dedendum_mm; }
  [[nodiscard]] std::optional<double> groove_floor() const override;
  [[nodiscard]] double blank_top() const override { return gear_.parameters().addendum_mm; }
  [[nodiscard]] bool in_blank(const Vec3& p) const override;
  [[nodiscard]] std::optional<Refusal> refusal(int zone) const override;

 private:
  BevelGear gear_;
  std::vector<WallSpace> spaces_;
};

/// The finished gear; the part must outlive it.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const BevelPart& part);

/// h of the underside that bodies of ours have: how thick a gear is below its teeth no job says. mm
[[nodiscard]] double underside_height(const BevelGear& gear);

}  // namespace toothpath::bevel_gear
