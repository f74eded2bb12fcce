// How a corrected flank runs into its fillet: the offset at the fillet line goes on, its slope fades; the root land joins both sides.
#pragma once

#include <vector>

#include "geometry/base/dual.h"
#include "geometry/face_gear_surface.h"
#include "geometry/flank_correction.h"

namespace toothpath {

/// Offset of the fillet of one side, mm along its normal, over the fillet's parameters (A, Z): a parabola in A with value and slope of the
/// flank's field at A_t and zero slope at A_e, so that the fillet keeps its curvature and a ball that fits it still does.
class FilletBlend {
 public:
  using Dual2 = Dual<double, 2>;
  /// Sections Z in [from_mm, to_mm] are tabulated; beyond, and where no regular fillet line exists, the nearest values hold.
  FilletBlend(const FaceGearSurface<double>& surface, const FaceGearSurface<Dual2>& dual, const FlankCorrection& flank, int side,
              double from_mm, double to_mm);

  struct Offset {
    double value = 0, d_A = 0, d_Z = 0;
  };
  [[nodiscard]] Offset at(double A, double Z) const;

  /// Where the fillet ends: value, and the slope with the fraction across the root land that gives root and fillet the same normal there;
  /// with their derivatives along Z.
  struct End {
    double value = 0, slope = 0, d_value = 0, d_slope = 0;
  };
  [[nodiscard]] End end(double Z) const;

 private:
  struct Entry {
    double value = 0, slope = 0;    ///< offset and its derivative with the fraction of A at the fillet line
    double d_value = 0, d_slope = 0;  ///< with the table's own step
    double end = 0, d_end = 0;        ///< slope with the fraction of the root land
  };
  /// Place of Z in the table: entry and share of a step; outside the table the ends hold and derivatives are 0.
  struct Place {
    std::size_t k = 0;
    double y = 0;
    bool outside = false;
  };
  [[nodiscard]] Place place_of(double Z) const;
  double A_t_ = 0, A_span_ = 1, from_ = 0, step_ = 1;
  std::vector<Entry> table_;
};

}  // namespace toothpath
