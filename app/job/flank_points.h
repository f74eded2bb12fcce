// The points of a gear's flanks, as a file states them.
#pragma once

#include <string>
#include <string_view>

#include "geometry/base/result.h"
#include "geometry/flank_grid/parameters.h"

namespace toothpath::job {

struct FlankPoints {
  flank_grid::GridPoints plus, minus;  ///< flanks 1 and -1
};

/// Reads lines `flank,row,column,x,y,z` or `flank,row,column,x,y,z,i,j,k` with that header, as a spreadsheet may save
/// them (geometry/inspection/table_text.h), any order, every point of both grids once; rows and columns count from 0.
/// Refused with line and column: another header, numbers that are none, points that stand there twice or are missing.
/// `file` stands in the messages.
[[nodiscard]] Result<FlankPoints> parse_flank_points(std::string_view text, const std::string& file);
/// Whether the first line is one of those headers.
[[nodiscard]] bool looks_like_flank_points(std::string_view text);
/// Such a file, every number with all its digits; normals with twelve.
[[nodiscard]] std::string flank_points_text(const FlankPoints& points);

}  // namespace toothpath::job
