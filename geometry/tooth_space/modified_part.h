// Any toothed part whose flanks a drawing, or the answer to a measurement, moves along their normals: one displaced
// space for each ring, as exact and as proven as the plain one. docs/modifications.md, section 7.
//
// A flank is a rectangle: depth below the tip surface, along h of the chart, and the place along the tooth as messages
// tell it (radius, z, cone distance). Where teeth taper depths are counted in shares of the flank's own: mm in the
// middle of the ring, 0 at the tip and `depth_mm` at the fillet line everywhere. The offset of the flank runs on into
// the fillet and fades to nothing at the root, value and slope.
#pragma once

#include <memory>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/modification/flank_correction.h"
#include "geometry/modification/modification.h"
#include "geometry/modification/smooth_curve.h"
#include "geometry/tooth_space/exact_space.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::tooth_space {

/// The flank of a side as modifications count it.
struct FlankRectangle {
  modification::Rectangle on;
  modification::SmoothCurve share{1};  ///< over s: depth of the fillet line, as a share of `on.depth_mm`
  double sign = 1;                     ///< place along the tooth: sign times s

  /// Coordinates of a place with s and the depth below the tip surface.
  template <typename S>
  [[nodiscard]] S along(const S& s) const {
    return S(sign) * s;
  }
  template <typename S>
  [[nodiscard]] S down(const S& s, const S& below_tip) const {
    return below_tip / share(s);
  }
  /// Of a place of the flank: x along the tooth, y the share of the depth.
  [[nodiscard]] Vec2 share_at(const ToothSpace& space, const Vec3& p) const {
    const Chart& chart = space.outline().chart;
    const double s = chart.along(p);
    return {along(s), down(s, space.tip(s) - chart.up(p)) / on.depth_mm};
  }
};
/// Nothing where the flank has no fillet line.
[[nodiscard]] std::optional<FlankRectangle> flank_rectangle(const ToothSpace& space, int side);

/// Fields that answer measured deviations, one a zone; each may be missing. Their theta is the share of the depth, 0 at
/// the tip and 1 at the fillet line, their place along the tooth that of the rectangle.
using Corrections = std::vector<std::shared_ptr<const modification::RingCorrection>>;

/// The part with its flanks moved by -removal and by the offsets of the corrections. Blank, tips, root and body stay
/// those of `plain`. Refused: what modification::refused refuses, with its key; a part whose spaces are no ExactSpace,
/// or whose flanks have no fillet line (key "modification").
[[nodiscard]] Expected<std::shared_ptr<const ToothedPart>, Refusal> modified_part(
    std::shared_ptr<const ToothedPart> plain, const std::vector<modification::Modification>& modifications,
    const Corrections& corrections = {});

}  // namespace toothpath::tooth_space
