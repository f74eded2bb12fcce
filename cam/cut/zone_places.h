// Places on the finished surface of one tooth space, by (sigma, contact radius): where the cut surface is measured.
#pragma once

#include <optional>
#include <utility>

#include "cam/analytic/gear_distance.h"
#include "geometry/tooth_space/offset_sheet.h"

namespace toothpath::cut {

/// Between tip edge and tip edge of one zone, from its inner to its outer radius; sigma as in
/// geometry/tooth_space/offset_sheet.h.
class ZonePlaces {
 public:
  /// Holds a reference to `part`, which must have the zone.
  ZonePlaces(const analytic::GearDistance& part, int zone);

  /// Contact radius [mm] at a share of the face width, 0 at the inner end. Clamped to where the surfaces exist.
  [[nodiscard]] double radius(double share) const;
  /// Point, normal and derivatives; `u` and `v` are the parameters of the piece. Nothing where the piece has no point.
  [[nodiscard]] std::optional<tooth_space::SheetPoint> at(double sigma, double r) const { return sheet_.raw(sigma, r); }
  /// sigma from end to end of a piece at radius r; flanks begin at the tip surface.
  [[nodiscard]] std::pair<double, double> range(tooth_space::Piece piece, double r) const;

 private:
  [[nodiscard]] double tip_sigma(bool plus, double r) const;

  const tooth_space::ToothSpace& space_;
  tooth_space::OffsetSheet sheet_;
};

}  // namespace toothpath::cut
