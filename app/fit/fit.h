// The gear that comes nearest to measured points: least squares of their distances from its exact flanks.
// docs/fit.md
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/fit/placing.h"

namespace toothpath::fit {

struct Bound {
  std::string key;
  double low = 0, high = 0;
};

struct Asked {
  std::vector<std::string> free;  ///< keys within [gear]; none: the usual ones
  std::vector<Bound> bounds;
  bool turns = true;          ///< the part stands turned about its axis, nobody knows how far
  bool shifts = false;        ///< and moved along it
  double ball_radius_mm = 0;  ///< the points are centres of such a ball
};

/// What became of one number that was free.
enum class End : std::uint8_t {
  determined,
  at_bound,  ///< the points would have it beyond
  held,      ///< the points do not determine it beside the others: it keeps its start
};
[[nodiscard]] const char* to_string(End end);

struct Row {
  std::string key;  ///< "rotation" and "axial_position" are no keys of a job
  const char* unit = "";
  double start = 0, low = 0, high = 0, value = 0;
  double deviation = 0;  ///< standard deviation, of determined numbers
  End end = End::determined;
  /// Of a held one: what moves together without moving the flanks at the points, each by how much.
  std::vector<std::pair<std::string, double>> moves_with = {};
};

struct Size {
  double rms_mm = 0, worst_mm = 0;
  std::size_t worst = 0;  ///< of the placed points
};

struct Fitted {
  std::vector<Row> rows;
  Placing placing;  ///< on the fitted gear
  Pose pose;        ///< of the part
  std::vector<double> before_mm,
      after_mm;  ///< of every placed point; before: the start, turned where that is free
  Size before, after;
  Numbers numbers;
  Gear gear;
  Spaces spaces;
  int steps = 0;  ///< of the minimiser, in all
};

/// Refused: a gear type that is not fitted, at its place; free numbers or bounds that are none (kind usage); too few
/// points on flanks, at the file; a start that has no flanks.
[[nodiscard]] Result<Fitted> fit_gear(const job::Job& job, const job::LoosePoints& points, const Asked& asked);

}  // namespace toothpath::fit
