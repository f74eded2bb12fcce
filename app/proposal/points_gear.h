// A gear by points from a file that has them in any order.
#pragma once

#include <optional>
#include <string>

#include "geometry/flank_grid/point_order.h"

namespace toothpath::proposal {

struct PointsOfFile {
  std::string file;
  bool states_unit = false;  ///< of x, y, z
  flank_grid::OrderedPoints points;
};

/// Reads the points of a file (app/job/loose_points.h) and orders them. Refused: what reading and ordering refuse.
/// @param unit_mm  of x, y, z as somebody says it; nothing: as the file says it, else mm
[[nodiscard]] Result<PointsOfFile> read_points(const std::string& file, std::optional<double> unit_mm);

/// Whether a gear of so many teeth is so small in mm that x, y, z may be in inches; then why.
[[nodiscard]] std::optional<std::string> looks_like_inches(const PointsOfFile& points, double teeth);

/// A meridian of two places, `[[r, z], [r, z]]` or `r z r z`. Refused (kind usage), with the name of the option: all
/// else.
[[nodiscard]] Result<std::vector<Vec2>> read_meridian(const char* option, const std::string& text);
/// As a job has it.
[[nodiscard]] std::string meridian_text(const std::vector<Vec2>& line);

/// Of the fillet, where nobody says root or radius.
[[nodiscard]] double proposed_fillet_mm(const flank_grid::MeridianProposal& meridians, double teeth);

}  // namespace toothpath::proposal
