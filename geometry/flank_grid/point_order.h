// From loose points of two flanks to their grids: which flank, row and column each of them is.
#pragma once

#include <optional>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/flank_grid/parameters.h"

namespace toothpath::flank_grid {

/// One point in any order.
struct LoosePoint {
  Vec3 p = Vec3::Zero();
  std::optional<Vec3> n;  ///< unit normal out of the material; of all points or of none
  SourcePosition at;      ///< where a file states it
  int flank = 0;          ///< as the file calls it, 1 or -1; 0: it does not
};

struct OrderedPoints {
  GridPoints plus, minus;  ///< rows from the root to the tip, columns towards growing r + z
};

/// Finds the two flanks, by the normals or by the two sheets that the points lie on, and in each of them rows and
/// columns. The tip is where the space is wider; it lies outwards, and of teeth on a face where the normals say, else
/// towards falling z as in the frame of the job. Refused, with the place of a point: points that are doubled or
/// missing, a row or column that is missing, folds, points beside both sheets, normals into the material, flanks of a
/// tooth instead of a space, fewer than 4 x 4 points.
[[nodiscard]] Result<OrderedPoints> order_points(const std::vector<LoosePoint>& points);

/// What of root and tip follows from the points.
class MeridianProposal {
 public:
  explicit MeridianProposal(const OrderedPoints& points);

  /// (r, z) at the end of column 0 and at the other: the line through the last rows, between the outermost points, or
  /// between the lines of the outermost columns where these lean.
  [[nodiscard]] std::vector<Vec2> tip() const { return ends(tip_, tip_slope_); }
  /// The root along the first rows on which a ball stands that touches them.
  [[nodiscard]] std::vector<Vec2> root(double fillet_radius_mm) const;
  /// Of the ball that touches the first rows and such a root, on average.
  [[nodiscard]] double fillet_radius_mm(const std::vector<Vec2>& root) const;
  /// Largest radius of the points, mm.
  [[nodiscard]] double outer_mm() const { return outer_; }
  /// Least width of the space between the first rows, along the circle, mm.
  [[nodiscard]] double width_mm() const { return width_; }

 private:
  struct Foot {
    Vec2 q, n;  ///< (r, z) of a point of the first rows, its normal there
  };
  [[nodiscard]] std::vector<Vec2> ends(double height, double slope) const;

  Vec2 along_, up_;
  /// s of an end at h = 0, and its growth by h.
  struct End {
    double s = 0, lean = 0;
  };
  End from_, to_;
  double tip_ = 0, tip_slope_ = 0, foot_slope_ = 0, outer_ = 0, width_ = 0;
  std::vector<Foot> feet_;
};

}  // namespace toothpath::flank_grid
