// How a corrected flank runs into its fillet: the offset at the fillet line, value and slope, fades to nothing at the
// root land.
#pragma once

#include <vector>

#include "geometry/base/dual.h"
#include "geometry/face_gear/flank_correction.h"
#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// Offset of the fillet of one side, mm along its normal, over the fillet's parameters (A, Z): a cubic in A with value
/// and slope of the flank's field at A_t and zero value and slope at A_e, so that flank, fillet and root stay one
/// smooth sheet.
class FilletBlend {
 public:
  using Dual2 = Dual<double, 2>;
  /// Sections Z in [from_mm, to_mm] are tabulated; beyond, and where no regular fillet line exists, the nearest values
  /// hold.
  FilletBlend(const FaceGearSurface<double>& surface, const FaceGearSurface<Dual2>& dual, const FlankCorrection& flank,
              int side, double from_mm, double to_mm);

  struct Offset {
    double value = 0, d_A = 0, d_Z = 0;
  };
  [[nodiscard]] Offset at(double A, double Z) const;

 private:
  struct Entry {
    double value = 0, slope = 0;      ///< offset and its derivative with the fraction of A at the fillet line
    double d_value = 0, d_slope = 0;  ///< with the table's own step
  };
  double A_t_ = 0, A_span_ = 1, from_ = 0, step_ = 1;
  std::vector<Entry> table_;
};

}  // namespace toothpath::face_gear
