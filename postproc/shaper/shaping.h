// How a face gear is to be shaped: the [shaping] table of a job, mm and m/min.
#pragma once

namespace toothpath::shaper {

struct Shaping {
  double cutting_speed_m_min = 0;
  enum class SpeedBasis { mean, peak } speed_basis = SpeedBasis::mean;
  double circular_feed_mm = 0;  ///< per double stroke on the cutter's pitch circle
  double radial_feed_mm = 0;    ///< per double stroke
  double over_run_mm = 0;       ///< at each end of the face
  enum class OffsetReference { outer_radius, mean_radius, given } offset_reference = OffsetReference::outer_radius;
  double offset_reference_mm = 0;  ///< when given
};

}  // namespace toothpath::shaper
