// Stress in bricks, and at the fillet of a loaded tooth. For a force of 1 and any E: stress does not depend on E where
// displacements are those of E = 1.
//
// Inside a brick stress is best at its 2^3 Gauss points; at a node it is extrapolated from them, trilinear, and the
// mean over the bricks that meet there. Components add up, principal values do not: they come last.
#pragma once

#include <vector>

#include "geometry/elastic/tooth_compliance.h"

namespace toothpath::elastic {

/// xx, yy, zz, xy, yz, zx; MPa for forces in N.
using Stress = Eigen::Matrix<double, 6, 1>;
/// Stress as a linear map of the displacements of the nodes, three a node.
using StressOfBrick = Eigen::Matrix<double, 6, 3 * kBrickNodes>;

/// At the place (u, v, w) of a brick, straight from its shape functions, for E = 1. Precondition: not folded there.
[[nodiscard]] StressOfBrick brick_stress(const BrickNodes& nodes, double nu, double u, double v, double w);
/// At every node, extrapolated from the 2^3 Gauss points.
[[nodiscard]] std::vector<StressOfBrick> nodal_stress(const BrickNodes& nodes, double nu);
/// The largest principal value.
[[nodiscard]] double largest_principal(const Stress& stress);

/// Nodes of the fillet under the loaded flank, from the end of the flank to the foot, without those two rows: the flank
/// is pressed nearby, the foot is a re-entrant edge of the bricks.
[[nodiscard]] std::vector<int> fillet_nodes(const Sector& sector);

/// Of the tooth o pitches on at index o + reach: stress at node n of `nodes` under the hat of force 1 of station k,
/// rows 6 n to 6 n + 5, column k, in the frame of that tooth.
struct HatStress {
  int reach = 0;
  std::vector<Eigen::MatrixXd> at_offset;
};
[[nodiscard]] HatStress hat_stress(const Sector& sector, double nu, const ToothFields& fields,
                                   const std::vector<int>& nodes);

}  // namespace toothpath::elastic
