// How the flank of a tooth gives way: displacement of stations under loads on stations, for the tooth in the middle of
// a clamped row and read on it and on its neighbours.
//
// All sectors of a row are equal, so one sector is factored with its two cuts last; what remains of it at the cuts (its
// Schur complement) is chained from sector to sector. The result is that of the whole row.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/elastic/sector.h"

namespace toothpath::elastic {

/// For E = 1, of a body: divide by its E. Loads press on the flank, displacements are counted into the material.
struct ToothCompliance {
  int reach = 0;  ///< neighbours on either side that are read
  /// Of the tooth o pitches on from the loaded one, o = -reach..reach at index o + reach: displacement of station i
  /// under a force of 1 spread over station k as a hat (bilinear to its neighbours, along the normals), mm/N.
  std::vector<Eigen::MatrixXd> at_offset;
  double reciprocity = 0;  ///< largest |C - C^T| of the loaded tooth, part of its largest value
};

/// @param nu     Poisson's ratio
/// @param teeth  sectors of the row, odd, >= 3; its outer cuts and the back of the rim are clamped
/// Refused: a stiffness that is not positive definite.
[[nodiscard]] Result<ToothCompliance> tooth_compliance(const Sector& sector, double nu, int teeth);

/// What a hat does to whole teeth, for E = 1.
struct ToothFields {
  int reach = 0;  ///< neighbours on either side
  /// Of the tooth o pitches on, o = -reach..reach: displacements of its nodes in its own frame, 3 rows a node, a column
  /// the hat of force 1 of a station, mm/N.
  std::vector<Eigen::MatrixXd> at_offset;
};
/// Parameters and refusals as above.
[[nodiscard]] Result<ToothFields> tooth_fields(const Sector& sector, double nu, int teeth);

/// Area of the hat of every station, mm^2.
[[nodiscard]] std::vector<double> hat_areas(const Sector& sector);

/// Forces on the nodes of the sector, one column a station: a hat of force 1 into the material.
[[nodiscard]] Eigen::MatrixXd hat_loads(const Sector& sector);

}  // namespace toothpath::elastic
