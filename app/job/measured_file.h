// Measured deviations of the flanks: the inspection grid as CSV with one more column, read back and fitted; files of
// points stand in measured_points.h.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/face_gear/gear.h"
#include "geometry/inspection/grid.h"
#include "geometry/inspection/tooth_index.h"
#include "geometry/modification/flank_correction.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::job {

/// Deviations beyond this size are not corrected but refused, as are files whose largest deviation is below the least:
/// both look like another unit.
inline constexpr double kLargestDeviationUm = 500, kLeastDeviationUm = 0.1;

/// A measured grid: nominal points as `inspection_grid` makes them, and the deviation of each along its normal, mm.
struct MeasuredFlanks {
  std::string file;
  std::vector<inspection::InspectionPoint> points;
  std::vector<double> deviation_mm;
};

/// Reads lines `zone,flank,row,column,x,y,z,i,j,k,deviation_um` with that header, as a spreadsheet may save them
/// (geometry/inspection/table_text.h: other separators, quotes, decimal commas), any order, every point of the grid
/// once; the numbers of rows (5 or more) and columns (9 or more) are those of the file. Points must be the nominal ones
/// within 0.005 mm. Refused with line and column: another header, numbers that are none, points off the grid or
/// missing, coordinates in inch, m or um, deviations whose size speaks of another unit. `file` stands in the messages.
[[nodiscard]] Result<MeasuredFlanks> parse_measured(std::string_view text, const std::string& file,
                                                    const face_gear::FaceGear& gear);

/// The inspection grid of a gear, for its measured files.
struct GridOfGear {
  std::size_t zones = 0;
  bool walls = false;  ///< flanks are called L and U (side +1 and -1), not 1 and -1
  /// Points in the order zone, side (+1, -1), row, column; those of bevel gears without `theta` and `B`. Refused: fewer
  /// rows or columns than the gear type needs.
  std::function<Result<std::vector<inspection::InspectionPoint>>(int rows, int columns)> nominal;
  std::function<Vec2(const inspection::InspectionPoint&)> place{};  ///< along the face, height: any unit
  std::function<double(int zone)> foot{};  ///< height at which flanks begin, below all points of the grid
  /// Of gears whose flanks are smooth sheets: files of points are put on them, and tell how the teeth stand.
  std::optional<tooth_space::ToothedSolid> solid = {};
};
/// As above, of any gear type.
[[nodiscard]] Result<MeasuredFlanks> parse_measured(std::string_view text, const std::string& file,
                                                    const GridOfGear& gear);
/// The fit of one flank, for the report.
struct FittedFlank {
  int zone = 0, side = 1;
  std::string file;  ///< that was fitted; of several grids the last
  int teeth = 1;     ///< on which it was measured
  modification::CorrectionResidual residual;
};
struct FittedCorrection {
  std::vector<std::shared_ptr<const modification::RingCorrection>> rings;
  std::vector<FittedFlank> flanks;
  inspection::IndexOfTeeth index = {};  ///< of the last file that measured several teeth
  std::vector<std::string> warnings = {};
  std::vector<inspection::InspectionPoint> grid = {};  ///< of the first file that is one
  /// What was measured at a place of the face and a height, as `GridOfGear::place` has them; > 0: material left. mm
  [[nodiscard]] double deviation_mm(int zone, int side, const Vec2& place) const {
    return -rings[std::size_t(zone)]->side(side).at(-place.y(), place.x()).value;
  }
};

/// The files that a command names, in the order of the cuts.
struct MeasuredInput {
  std::vector<std::string> files;
  std::optional<double> ball_diameter_mm = {};  ///< points are the centres of a ball of that diameter
};

/// Reads the files in the order of the cuts, grids or points each; their fits add up. Refused: as `parse_measured` and
/// `parse_measured_points`; a file that cannot be read (`file_access`); files of points where the gear has no `solid`;
/// a ball's diameter beside a grid, which holds deviations already; grids of different size.
[[nodiscard]] Result<FittedCorrection> fit_measured(const MeasuredInput& measured, const GridOfGear& gear);

/// A gear whose target answers measured files.
struct CorrectedGear {
  face_gear::FaceGear gear;
  FittedCorrection fit;
  std::vector<std::string> files;
  std::vector<inspection::InspectionPoint> grid;  ///< where correction.json tells the target
};
/// Errors: those of `fit_measured`.
[[nodiscard]] Result<CorrectedGear> correct_gear(const face_gear::FaceGear& nominal, const MeasuredInput& measured);

/// correction.json: files, and for every flank degrees, sizes measured and left, and the offset of the target at the
/// grid, um. Ends in a line feed.
[[nodiscard]] std::string correction_json(const CorrectedGear& corrected);
[[nodiscard]] std::string correction_json(const std::vector<std::string>& files, const std::vector<FittedFlank>& flanks,
                                          const std::vector<inspection::InspectionPoint>& grid,
                                          const std::function<double(const inspection::InspectionPoint&)>& offset_mm);

}  // namespace toothpath::job
