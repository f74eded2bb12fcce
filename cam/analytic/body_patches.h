// The surface of one ring, piece by piece, as shank and holder see it: quads in the parameters of the exact patches
// that can be halved without end. The hull of a quad's corners holds its piece of the surface up to a proven sag, which
// shrinks with the square of the quad; every place that is told lies on the surface itself.
//
// Sheet: the analytic patches, bent as cam/analytic/patch_bounds.h proves, cut off at the tip surface and the ends.
// Land: between the two tip edges of tooth 0, whose azimuths are solved at every station. Ends: surfaces of
// constant s below the profile of the sheet. Groove floor: of constant h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "cam/analytic/gear_cells.h"
#include "cam/analytic/patch_bounds.h"

namespace toothpath::analytic {

/// What a cell is a piece of: one of the five of a tooth space (the sheet), a top land, an end of the ring, or the
/// floor of the groove.
struct BodySurface {
  tooth_space::Piece piece = tooth_space::Piece::root;
  bool outer = false;  ///< of an end
  [[nodiscard]] bool sheet() const { return int(piece) < tooth_space::kPieces; }
  [[nodiscard]] bool end() const { return piece == tooth_space::Piece::end; }
};

/// A quad of a cell. Parameters: sheet: coordinates of the frame of its block; land: (share from the minus to the plus
/// edge, s); ends: (index on the border, share of the height); floor: (azimuth, s). Corners run around the
/// quad.
struct BodyQuad {
  std::array<Vec2, 4> at;
  std::array<Vec3, 4> corner;    ///< places of space 0 whose hull holds the quad's piece up to its sag
  std::array<bool, 4> stands{};  ///< the corner is a place of the surface
};

/// The corners of what of a quad may stand for material.
struct BodyHull {
  std::array<FacetCorner, 12> corner;
  std::size_t count = 0;
};

/// Every place of a cell's piece of the surface is centre + x a + y b, |x|, |y| <= 1, or within `off` of such a place;
/// all lie within `radius` of the centre. Proven as `BodyPatches::above` is.
struct BodyBox {
  Vec3 centre = Vec3::Zero(), a = Vec3::Zero(), b = Vec3::Zero();
  double off = 0, radius = 0;
};

/// What the patches of a ring are made of.
struct BodyRing {
  double s_from = 0, s_to = 0;
  double base_mm = 0;   ///< lower border of the end faces
  double floor_mm = 0;  ///< height of the groove floor
  std::vector<double> table_s;
  std::array<std::vector<std::optional<tooth_space::EdgePlace>>, 2>
      tip;  ///< plus and minus edge of tooth 0 over `table_s`
  std::array<std::vector<std::optional<CurveBend>>, 2>
      tip_bend;                             ///< of their azimuths, from place to place; none: not proven
  std::array<std::vector<double>, 2> edge;  ///< their azimuths, also where there is no such place
  std::array<std::vector<Vec2>, 2> border;  ///< of the inner and the outer end, `end_border`
  std::array<double, 2> border_sag{};       ///< how far the surface may leave the border between its points
};

class BodyPatches {
 public:
  struct SheetCell {
    std::size_t index = 0;   ///< of the cell
    std::array<Vec2, 4> uv;  ///< around the cell
    std::array<Vec3, 4> corner;
  };

  BodyPatches(const tooth_space::ToothSpace& space, BodyRing ring, std::size_t cells);

  /// Cells of one piece that lie beside each other and share the bound of their second derivatives.
  struct SheetBlock {
    tooth_space::Piece piece = tooth_space::Piece::tip;
    std::vector<SheetCell> cells;
  };
  /// Made on all threads, kept in their order.
  void add_blocks(const std::vector<SheetBlock>& blocks);
  /// A cell of another surface, from the low and high ends of its parameters. `found_by`: the corners by which a search
  /// finds it, along both parameters: (low, low), (high, low), (low, high), (high, high).
  void add(std::size_t index, BodySurface surface, const Vec2& low, const Vec2& high,
           const std::array<Vec3, 4>& found_by);

  [[nodiscard]] const BodyQuad& quad(std::size_t cell) const { return cells_[cell].quad; }
  /// How far the cell's piece of the surface may leave the hull of its quad's corners. mm, proven as `above` is
  [[nodiscard]] double sag(std::size_t cell) const { return cells_[cell].sag; }
  [[nodiscard]] const BodyBox& box(std::size_t cell) const { return boxes_[cell]; }
  /// How far any piece of the surface may lie from the corners by which its cell is found.
  [[nodiscard]] double search_margin() const { return search_margin_; }
  [[nodiscard]] const BodySurface& surface(std::size_t cell) const { return cells_[cell].surface; }

  /// Parameters of the piece, of a place of a cell of the sheet.
  [[nodiscard]] Vec2 parameters(std::size_t cell, const Vec2& at) const {
    return blocks_[cells_[cell].block].frame.uv(at);
  }

  /// Across its longer side; where the bend may leave more of the hull than that, across the parameter that bends more;
  /// along the border where that stands out more than the quad is high.
  [[nodiscard]] std::array<BodyQuad, 2> halved(std::size_t cell, const BodyQuad& quad) const;
  /// Longest side that halving shortens, mm. A quad of an end is higher by what its border may stand out.
  [[nodiscard]] double size(std::size_t cell, const BodyQuad& quad) const;
  /// The part of its height that no halving shortens, mm: the sag between the points of the border; 0 but for ends.
  [[nodiscard]] double stays(std::size_t cell, const BodyQuad& quad) const;
  [[nodiscard]] BodyHull outline(std::size_t cell, const BodyQuad& quad) const;
  /// The most by which the hull can lie above the surface along a unit vector g, and in any direction. mm
  [[nodiscard]] double above(std::size_t cell, const BodyQuad& quad, const Vec3& g) const;
  [[nodiscard]] double sag(std::size_t cell, const BodyQuad& quad) const;
  /// The place of the surface at some parameters; those of the sheet beyond the tip or an end are moved back to that
  /// border.
  [[nodiscard]] std::optional<Vec3> settled(std::size_t cell, const Vec2& at) const;

  /// Blocks whose bound is sampled, not proven: where interval arithmetic finds none.
  [[nodiscard]] std::size_t sampled_blocks() const { return sampled_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }

 private:
  struct Block {
    tooth_space::Piece piece = tooth_space::Piece::tip;
    PatchFrame frame;
    PatchBend bend;
    bool sampled = false;
  };
  /// A block with its cells; those whose bound is found only of smaller boxes are blocks of their own.
  struct MadeBlock {
    Block block;
    std::vector<SheetCell> cells;
  };
  struct Cell {
    BodySurface surface;
    std::uint32_t block = 0;
    double sag = 0;
    BodyQuad quad;
  };
  /// Lengths of the sides along both parameters, as `size` counts.
  [[nodiscard]] Vec2 sides(const Cell& cell, const BodyQuad& quad) const;
  /// How much higher a quad of an end is than `sides` count, mm: halves of its stretch of the border stand out less.
  [[nodiscard]] double stands_out(const Cell& cell, const BodyQuad& quad) const;
  /// What the bend along both parameters may leave of the hull of a quad's corners, as `sag` counts. mm
  [[nodiscard]] Vec2 bends(const Cell& cell, const BodyQuad& quad) const;
  [[nodiscard]] BodyQuad made(const Cell& cell, const std::array<Vec2, 4>& at) const;
  [[nodiscard]] BodyQuad end_quad(const Cell& cell, const std::array<Vec2, 4>& at) const;
  [[nodiscard]] const tooth_space::Chart& chart() const { return space_.outline().chart; }
  [[nodiscard]] double edge_azimuth(int which, double s) const;
  [[nodiscard]] Vec3 land(double share, double s) const;
  [[nodiscard]] PatchBend land_bend(double s_from, double s_to);
  [[nodiscard]] PatchBend sheet_bend(const Block& block, double half_a, double half_b) const;
  void make(const SheetBlock& block, std::vector<MadeBlock>& out) const;
  [[nodiscard]] double cell_sag(std::size_t index) const;
  [[nodiscard]] std::optional<Vec3> settled_sheet(const Block& block, Vec2 uv) const;
  void measure(std::size_t index);

  const tooth_space::ToothSpace& space_;
  BodyRing ring_;
  std::vector<Cell> cells_;
  std::vector<BodyBox> boxes_;  ///< of the cells
  std::vector<Block> blocks_;
  double search_margin_ = 0;
  std::size_t sampled_ = 0;
};

}  // namespace toothpath::analytic
