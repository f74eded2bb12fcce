// Measured points as measuring machines hand them out: DMIS results and plain lists of x y z.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::inspection {

/// One measured point, gear frame.
struct FilePoint {
  SourcePosition at;      ///< of its x in the file
  std::string label;      ///< of its DMIS feature; empty: none
  Vec3 p = Vec3::Zero();  ///< mm
  std::optional<Vec3> n;  ///< unit vector out of the material where the file states one
};

struct PointFile {
  std::vector<FilePoint> points;
  std::size_t other_features = 0;      ///< measured features of DMIS that are no points: left out
  std::optional<double> unit_mm = {};  ///< mm of the unit of x, y, z that the file states; the points are in mm
};

/// More points are refused.
inline constexpr std::size_t kMostPoints = 500'000;

/// Whether a text looks like DMIS: a statement of it begins with DMISMN/, DMISMD/, FA(, F( or UNITS/.
[[nodiscard]] bool looks_like_dmis(std::string_view text);

/// The measured points of a DMIS text (ISO 22093): every `FA(label)=FEAT/POINT,CART,x,y,z,i,j,k` or with POL (radius,
/// angle, height in the XY plane), and `PTDATA/CART,x,y,z[,i,j,k]` behind an FA of another kind (a surface, a curve).
/// The unit is that of the last UNITS before the point: MM, CM, M, INCH or FEET, and ANGDEC or ANGRAD; without UNITS
/// mm and degrees. `$` continues a line, `$$` is a comment; upper and lower case. All other statements are passed over.
/// Refused, with line and column: a point that is not complete, numbers that are none, normals that are none.
[[nodiscard]] Result<PointFile> parse_dmis_results(std::string_view text, const std::string& file);

/// Lines `x y z` or `x y z i j k`, all of the same number of columns, as `table_text.h` parts them: blanks, tabs,
/// commas or semicolons, quotes, decimal points or decimal commas. One column more ahead of them names the point: a
/// whole number or a text. A first line may name the columns, in any order, with the unit of x, y, z: `Point;X
/// [mm];..`; without a unit they are mm. Empty lines and those that begin with #, %, ; or // are comments. Refused,
/// with line and column: other columns, units that are none or differ, numbers that are none, normals that are none.
[[nodiscard]] Result<PointFile> parse_plain_points(std::string_view text, const std::string& file);

}  // namespace toothpath::inspection
