// A whole gear by points: its tooth space, the body below it, and its limits; refuses with key, value and limit.
#pragma once

#include <memory>
#include <vector>

#include "geometry/flank_grid/fitted_grid.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::flank_grid {

class FlankGridGear {
 public:
  /// Checks every limit of the gear. On failure returns all refusals.
  static Expected<FlankGridGear, std::vector<Refusal>> make(const FlankGridParameters& parameters);

  [[nodiscard]] const FlankGridParameters& parameters() const { return parameters_; }
  [[nodiscard]] const GridSpace& space() const { return *grid_.space; }
  [[nodiscard]] std::shared_ptr<const GridSpace> shared_space() const { return grid_.space; }
  [[nodiscard]] const GridQuality& quality() const { return grid_.quality; }
  /// Transverse module half way up the teeth at their larger end.
  [[nodiscard]] double module_mm() const;
  /// h of the root surface at s, and the least over the teeth: no higher than any place.
  [[nodiscard]] double root(double s) const;
  [[nodiscard]] double lowest_root() const;
  /// The turned body behind the teeth, (r, z): from where the end face at s_to stops, half a module below the roots, to
  /// where that at s_from does. Hub, if any, behind the end of the teeth that lies farther along z.
  [[nodiscard]] const std::vector<Vec2>& body() const { return body_; }

 private:
  std::vector<Refusal> make_body();
  /// (r, z) where an end face stops, half a module below the root; least radius of the root between both ends.
  [[nodiscard]] Vec2 foot_of_end(bool to) const;
  [[nodiscard]] double least_root_radius() const;

  FlankGridParameters parameters_;
  FittedGrid grid_;
  std::vector<Vec2> body_;
};

/// The gear as planners and proofs ask for it. The blank is turned: tip surface, ends, bore.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const FlankGridGear& gear);

/// The finished gear, which must outlive it.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const FlankGridGear& gear);

}  // namespace toothpath::flank_grid
