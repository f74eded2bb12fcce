// Where the cut surface of a gear is measured, whatever a program has cut: places of the surface on a dense grid and on
// fine lines across each space, and which of them the balls of the job reach. Found once for all teeth and programs.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/cut/cut_surface.h"
#include "cam/cut/zone_places.h"
#include "cam/path/operation.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::cut {

/// The operation and the ball that each region is judged by.
class RegionJudges {
 public:
  /// Holds a reference to `operations`, of which there must be one for the rest to be asked.
  RegionJudges(const std::vector<path::MillingOperation>& operations, const std::vector<tool::ProofTool>& tools);

  [[nodiscard]] bool none() const { return operations_.empty(); }
  /// The operation that finishes the region, else the last one.
  [[nodiscard]] const path::MillingOperation& last_in(path::Region region) const { return operations_[last_[region]]; }
  /// Radius of the ball end of its tool, or of what stands for it.
  [[nodiscard]] double ball_in(path::Region region) const { return balls_[last_[region]]; }
  [[nodiscard]] bool by_side(path::Region region) const {
    return last_in(region).type == path::OperationType::line_milling;
  }
  /// Does the last operation leave a surface on which cusps are looked for?
  [[nodiscard]] bool smooths() const { return !none() && operations_.back().type != path::OperationType::roughing; }

 private:
  const std::vector<path::MillingOperation>& operations_;
  std::vector<double> balls_;  // of every operation's tool
  path::ByRegion<std::size_t> last_;
};

/// A patch of a zone, row by row.
struct PatchPlaces {
  tooth_space::Piece piece = tooth_space::Piece::root;
  int rows = 0, columns = 0;
  std::vector<std::optional<tooth_space::SheetPoint>> at;  ///< nothing where the piece has no point
  std::vector<std::uint8_t> reachable;                     ///< may the ball end that the place is judged by touch it?
};

/// A line across the space, from tip to tip.
struct LinePlaces {
  double r = 0;      ///< contact radius
  bool end = false;  ///< of the ring: no cusps are looked for
  struct Place {
    tooth_space::Piece piece = tooth_space::Piece::root;
    double sigma = 0;
    std::optional<Vec3> p;
  };
  std::vector<Place> places;
};

class MeasuredPlaces {
 public:
  struct Zone {
    ZonePlaces places;
    std::array<PatchPlaces, tooth_space::kPieces> patches;
    std::vector<LinePlaces> lines;  ///< empty where the last operation roughs
  };

  /// Holds references to `part` and `judges`. Asks the whole surface, on all cores.
  MeasuredPlaces(const analytic::GearDistance& part, const RegionJudges& judges, const CutSurfaceOptions& options);

  [[nodiscard]] const std::vector<Zone>& zones() const { return zones_; }
  /// Can the ball end that the place is judged by touch it? The side of a mill is asked for all of its flank.
  [[nodiscard]] bool reachable(const tooth_space::PatchPoint& place, path::Region region) const;
  /// Greatest difference between a radius and the distance from a centre that far above a place of the grid.
  [[nodiscard]] double solve_residual_mm() const { return solve_residual_mm_; }
  /// Greatest distance between neighbours on a line.
  [[nodiscard]] double line_step_mm() const { return line_step_mm_; }

 private:
  void find_patch(const ZonePlaces& places, PatchPlaces& patch);
  [[nodiscard]] LinePlaces line_across(const ZonePlaces& places, double r, bool end);
  [[nodiscard]] bool reachable(const tooth_space::PatchPoint& place, path::Region region, double* residual) const;

  const analytic::GearDistance& part_;
  const RegionJudges& judges_;
  CutSurfaceOptions o_;
  std::vector<Zone> zones_;
  double solve_residual_mm_ = 0, line_step_mm_ = 0;
};

}  // namespace toothpath::cut
