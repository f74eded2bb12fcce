// Measured points of any number of teeth, read from results of measuring machines, and the correction that answers
// them.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/job/measured_file.h"
#include "geometry/inspection/flank_points.h"
#include "geometry/inspection/tooth_index.h"
#include "machines/toml/key_notes.h"

namespace toothpath::job {

/// Range of the diameter of a probe's ball.
inline constexpr toml::Range kBallDiameter = toml::Range::positive(50, "mm");

/// Points on flanks, as a file states them.
struct MeasuredPoints {
  std::string file;
  std::vector<inspection::FlankPoint> points;
  std::size_t other_features = 0;  ///< measured features of DMIS that are no points: left out
};

/// Whether a text is an inspection grid as CSV, with or without its deviations; all else is read as points.
[[nodiscard]] bool looks_like_grid(std::string_view text);

/// Reads DMIS results or plain lists of x y z (geometry/inspection/point_file.h), gear frame, and puts every point on
/// its flank. Refused, with line and column: what the readers refuse, points on no flank or on two, deviations whose
/// size speaks of another unit. `file` stands in the messages.
/// @param ball_diameter_mm  > 0: the points are centres of a ball of that diameter
[[nodiscard]] Result<MeasuredPoints> parse_measured_points(std::string_view text, const std::string& file,
                                                           const tooth_space::ToothedSolid& gear,
                                                           double ball_diameter_mm);

/// Fits one file: a shape for all teeth, and for each tooth how far it stands off. Refused, at the file: a flank
/// without points, or too few of them (`FlankCorrection::fit_scattered`). The gear has a `solid`.
[[nodiscard]] Result<FittedCorrection> fit_points(const GridOfGear& gear, const MeasuredPoints& measured);

}  // namespace toothpath::job
