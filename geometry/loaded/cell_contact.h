// Contact of elastic bodies on rectangular cells: pressures that only press, under one common motion. For places
// where flanks touch in a point or on an edge, which strips do not resolve. Lengths mm, forces N, pressures MPa.
// Derivation: docs/loaded_contact.md 5; Love 1929 for the cell, Polonsky and Keer 1999 for the search.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <limits>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::loaded {

/// The gap of a cell without material.
inline constexpr double kNoMaterial = std::numeric_limits<double>::infinity();

/// Cells of one pair of flanks in their common tangent plane; value (column, row) at row * columns + column.
struct CellWindow {
  int columns = 0, rows = 0;  ///< across and along
  double dx = 0, dy = 0;      ///< sides of a cell
  std::vector<double> gap;    ///< of the unloaded flanks; kNoMaterial where nothing can press
  [[nodiscard]] std::size_t size() const { return gap.size(); }
  /// Displacement of a cell under a force spread over a block of cells, from the block's images at free ends, mm/N;
  /// empty: there are none near.
  Eigen::MatrixXd images{};     ///< cells x blocks
  std::vector<int> blocks{};    ///< block of every cell
  std::vector<double> lever{};  ///< of every cell: by how much it nears when the bodies approach by 1; empty: 1
  [[nodiscard]] double lever_of(std::size_t cell) const { return lever.empty() ? 1.0 : lever[cell]; }
};

struct CellProblem {
  std::vector<CellWindow> windows;
  double compliance = 0;  ///< (1 - nu^2)/(pi E) of both bodies together
  double force = 0;       ///< sum of the cells' forces times their levers, > 0
  /// What the bodies have beyond the half-spaces of their windows: S^T R S of the forces of all cells.
  Eigen::SparseMatrix<double, Eigen::RowMajor> stations;  ///< S, stations x cells
  Eigen::MatrixXd remainder;                              ///< R
};

struct CellPressures {
  std::vector<double> pressure;  ///< of every cell, window after window
  double approach = 0;           ///< of the bodies from first touch
  int rounds = 0;
  double residual = 0;  ///< greatest overlap, and gap under pressure, part of the approach
};

/// integral of 1/distance over a rectangle with the sides 2a, 2b about the origin, seen from (x, y) in its plane.
/// Source: Love 1929.
[[nodiscard]] double rectangle_influence(double x, double y, double a, double b);

/// @param start  pressures to begin with, e.g. of a load nearby; empty: even
/// Refused: no cell with material, no force; no end within 2000 rounds.
[[nodiscard]] Result<CellPressures> press_cells(const CellProblem& problem, const std::vector<double>& start = {});

}  // namespace toothpath::loaded
