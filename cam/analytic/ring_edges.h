// How far the polylines of a ring's edges may leave the edges themselves, proven segment by segment from second
// derivatives.
#pragma once

#include <vector>

#include "cam/analytic/patch_bounds.h"

namespace toothpath::analytic {

/// A place of the sheet at an end of the ring.
struct EndPlace {
  tooth_space::Piece piece = tooth_space::Piece::root;
  double u = 0, v = 0;
  Vec3 p = Vec3::Zero();
  double sigma = 0;  ///< across the space, as of an OffsetSheet
};

/// Sag of every segment between neighbouring places, mm; -1 where no bound is found. The last step of a piece ends at
/// the first place of the next one.
[[nodiscard]] std::vector<double> end_edge_sags(const tooth_space::ToothSpace& space,
                                                const std::vector<EndPlace>& places);

/// Derivatives of the azimuth of a tip edge by s, from place to place; none where no bound is found.
[[nodiscard]] std::vector<std::optional<CurveBend>> tip_bends(
    const tooth_space::ToothSpace& space, int side, const std::vector<std::optional<tooth_space::EdgePlace>>& places,
    const std::vector<double>& stations);

/// Sag of every segment of a tip edge, mm; -1 where no bound is known.
[[nodiscard]] std::vector<double> tip_edge_sags(const tooth_space::ToothSpace& space,
                                                const std::vector<std::optional<CurveBend>>& bends,
                                                const std::vector<double>& stations);

/// Radius and height of the tip surface over a stretch of s, with derivatives by s: enclosed.
struct TipMeridian {
  Interval r, r1, r2, z2;
  TipMeridian(const tooth_space::ToothSpace& space, double s_from, double s_to);
};

}  // namespace toothpath::analytic
