// The body of a bevel gear that stands on one ring of teeth, whatever its teeth: end faces square to the pitch cone,
// half a module below the roots a flat back, a bore, a hub.
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::tooth_space {

/// mm; heights are h of the chart, the front is the small end. The space's s is minus the cone distance.
struct BevelBody {
  int teeth = 0;
  double module_mm = 0;  ///< outer, transverse
  double lowest_root = 0;
  double root_back = 0, root_front = 0;  ///< lowest at either end
  double bore_mm = 0, hub_mm = 0, hub_length_mm = 0;

  /// Where the end faces stop, (r, z).
  [[nodiscard]] Vec2 back(const Outline& ring) const;
  [[nodiscard]] Vec2 front(const Outline& ring) const;
  /// What is wrong with bore and hub.
  [[nodiscard]] std::optional<Refusal> refusal(const Outline& ring) const;
};

/// The gear as planners and proofs ask for it. The blank is turned: face cone, back and front cone, bore.
[[nodiscard]] std::shared_ptr<const ToothedPart> bevel_part(std::shared_ptr<const ToothSpace> space,
                                                            const BevelBody& body);
/// The finished gear; the space must outlive it. Without a bore it reaches to the axis.
[[nodiscard]] ToothedSolid bevel_solid(const ToothSpace& space, const BevelBody& body);
/// z of the front of that body and of its back, hub included. mm
[[nodiscard]] std::array<double, 2> body_ends(const ToothSpace& space, const BevelBody& body);

}  // namespace toothpath::tooth_space
