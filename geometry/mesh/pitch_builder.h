// The vertices and triangles of one angular pitch on a given grid, and how far its facets sag.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "geometry/mesh/tooth_grid.h"
#include "geometry/mesh/tooth_mesh.h"
#include "geometry/mesh/tooth_section.h"

namespace toothpath::mesh {

/// Builds the pitch row by row: the toothed surface of every ring, its end faces, the groove floors, the body below.
/// Holds references to gear and grid.
class PitchBuilder {
 public:
  PitchBuilder(const ToothedSolid& gear, const ToothGrid& grid, double tolerance_mm)
      : gear_(gear), grid_(grid), chart_(gear.chart()), columns_(grid_columns(grid)) {
    out_.teeth = gear.teeth;
    out_.tolerance_mm = tolerance_mm;
  }

  /// Refused: a section that does not close (undercut, pointed), a place where the tooth overhangs an end face.
  Status build();
  /// Largest distance [mm] of exact points to the mesh with a margin of 15 %, by patch; n x n points a cell. After
  /// `build`.
  Result<std::array<double, tooth_space::kSurfaces>> measure_sag(int n) const;
  ToothMesh take() { return std::move(out_); }

 private:
  /// A row of vertices across the pitch, at one station.
  struct Row {
    std::vector<std::int32_t> index;
    std::vector<Vec2> uv;      ///< by slot; empty for the rows below the teeth
    std::vector<double> feet;  ///< what is turned below the row stands at its azimuths turned by this; empty: at these
  };
  /// The toothed surface of one ring: its rows and the way each cell is cut in two.
  struct RingRows {
    std::vector<Row> rows;
    std::vector<std::vector<char>> falling;  ///< [strip][column]: the diagonal runs (i + 1, j) to (i, j + 1)
  };

  Result<std::vector<SectionPoint>> exact_row(const ToothSection& section, double shift) const;
  Result<RingRows> add_ring(std::size_t ring, const std::vector<double>& stations);
  Row add_row(std::vector<Vec3> points, const Row* shared = nullptr, double shared_h = 0);
  Row row_at(const Row& profile, const Vec2& corner, const std::vector<double>& turns = {});
  Row row_below(const Row& profile, double h);
  std::optional<Row> foot_of(const Row& profile, double corner_h);
  std::vector<Row> turned_rows(const Row& from, const Row& profile, const std::vector<Vec2>& corners);
  Status below_the_teeth(const Row& end, double h, const char* what) const;
  Status add_groove(std::size_t ring);
  Status add_body();
  void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c, const TriangleTag& tag);
  void add_surface_strip(const RingRows& ring, std::size_t strip, std::uint8_t zone);
  void add_plain_strip(const Row& from, const Row& to, Piece patch, std::uint8_t zone);
  Status stand(Row& end, double lowest) const;
  double distance_near(const RingRows& ring, std::size_t strip, std::size_t column, const Vec3& p, double enough) const;
  const Vec3& at(const Row& row, std::size_t j) const { return out_.mesh.vertices[std::size_t(row.index[j])]; }
  double h_of(const Row& row, std::size_t j) const { return chart_.up(at(row, j)); }
  double s_of(const Row& row) const { return chart_.along(at(row, 0)); }

  const ToothedSolid& gear_;
  const ToothGrid& grid_;
  tooth_space::Chart chart_;
  std::vector<GridColumn> columns_;
  std::vector<RingRows> rings_;
  ToothMesh out_;
  double turned_sag_ = 0;  ///< of facets on surfaces of revolution
};

}  // namespace toothpath::mesh
