// The surface of ball centres over one tooth space: the offset of flank, fillet, root, fillet, flank taken as one
// sheet.
//
// A place on the sheet is (sigma, r): sigma in [0, 5] runs across the space (piece + fraction of the piece), r is where
// the ball CENTRE stands along the tooth, s of the space's chart (of a face gear: its radius). Where the ball is too
// large for the fillet the raw offset crosses itself; the part behind the crossing is cut away (a gap in sigma; both
// ends of a gap have the same centre), so that the ball touches both walls of the corner at once and gouges neither.
#pragma once

#include <optional>
#include <vector>

#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

struct SheetPoint {
  Piece piece = Piece::root;
  double u = 0, v = 0;  ///< parameters of the contact point on the piece
  Vec3 centre = Vec3::Zero();
  PatchPoint contact;
};

/// Parameters where the raw offset leaves the true one: sigma in (from, to) is behind the crossing.
struct SheetGap {
  double from = 0, to = 0;
};

/// Which corner a gap stands for: between root land and plus wall, between root land and minus wall, or both in one
/// where the ball does not reach the root land. The two need not meet in the middle of the land.
enum class SheetCorner { plus, minus, both };
[[nodiscard]] SheetCorner corner_of(const SheetGap& gap);

class OffsetSheet {
 public:
  /// One profile: the trimmed offset at a fixed r.
  struct Node {
    double sigma = 0;
    SheetPoint at;
    double azimuth = 0;
  };
  struct Station {
    double r = 0;
    std::vector<Node> nodes;     ///< all, in sigma
    std::vector<SheetGap> gaps;  ///< in sigma, not overlapping
  };

  /// Offset by `delta` (ball radius + allowance) for r in [r_from, r_to]. Holds a reference to the space. The range
  /// shrinks to where the surfaces exist; `r_from()`, `r_to()` tell what is left. An empty sheet (no station) means: no
  /// surface at all.
  OffsetSheet(const ToothSpace& space, double delta, double r_from, double r_to, int stations = 33);
  OffsetSheet(ToothSpace&& space, double delta, double r_from, double r_to, int stations = 33) = delete;

  [[nodiscard]] double delta() const { return delta_; }
  [[nodiscard]] double r_from() const { return stations_.front().r; }
  [[nodiscard]] double r_to() const { return stations_.back().r; }
  [[nodiscard]] bool empty() const { return stations_.empty(); }
  [[nodiscard]] const std::vector<Station>& stations() const { return stations_; }
  [[nodiscard]] bool has_gaps() const { return has_gaps_; }
  [[nodiscard]] const ToothSpace& space() const { return *space_; }

  /// Raw offset at (sigma, r), not trimmed. Nothing on an empty sheet.
  [[nodiscard]] std::optional<SheetPoint> raw(double sigma, double r) const;
  /// Trimmed: a sigma inside a gap is moved to the nearer end of the gap.
  [[nodiscard]] std::optional<SheetPoint> at(double sigma, double r) const;
  /// Gaps at any r of the range.
  [[nodiscard]] std::vector<SheetGap> gaps(double r) const;

 private:
  /// Evenly spaced stations over the part of the range in which the surfaces exist; none or at least two.
  [[nodiscard]] std::vector<Station> regular_stations(double r_from, double r_to, int count) const;
  [[nodiscard]] std::optional<Station> make_station(double r, const Station* neighbour) const;
  [[nodiscard]] std::optional<SheetPoint> solve(Piece piece, double u, double r, double v_start) const;
  [[nodiscard]] double parameter(Piece piece, double fraction, double r) const;
  void find_gaps(Station& station) const;
  [[nodiscard]] bool refine_gap(SheetGap& gap, double r) const;
  [[nodiscard]] std::size_t station_before(double r) const;

  [[nodiscard]] const Chart& chart() const { return space_->outline().chart; }
  /// Radius of the tip surface at r: lengths that rounding is measured by.
  [[nodiscard]] double size(double r) const { return chart().sine == 0 ? r : chart().r(r, space_->tip(r)); }

  const ToothSpace* space_;
  double delta_ = 0;
  double top_plus_[2] = {0, 0}, top_minus_[2] = {0, 0};  ///< theta at the tip = c0 + c1 r
  bool has_gaps_ = false;
  std::vector<Station> stations_;
};

}  // namespace toothpath::tooth_space
