// What the proof of a program returns: gouge, clearance, what is left, and the ledger of errors. All lengths mm.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cam/tool/body.h"
#include "geometry/base/vec.h"
#include "geometry/tooth_space/piece.h"

namespace toothpath::proof {

/// A place where a body of the tool comes deepest into (or nearest to) the part.
struct WorstPlace {
  double depth_mm = 0;  ///< > 0: cut into the finished part
  tool::Body body = tool::Body::none;
  std::string patch;  ///< "flank +1", "fillet -1", "root", "tip", "groove", ...
  int operation = 0, tooth = 0, zone = 0;
  int line = 0;                         ///< of the NC program
  double radius_mm = 0, height_mm = 0;  ///< r and z of the place, gear frame
  Vec3 point = Vec3::Zero();            ///< turned to tooth space 0
};

/// Penetration of the cutting part into the finished surface, over all motions.
struct GougeResult {
  double measured_mm = 0;            ///< worst penetration found; negative: the least gap
  double bound_mm = 0;               ///< proven: nothing on any path between the samples is deeper
  int bound_line = 0;                ///< line of the move with the greatest bound
  double clearance_mm = 0;           ///< least proven gap of shank and holder
  double clearance_measured_mm = 0;  ///< least gap of shank and holder that was found; negative: they cut
  double clearance_followed_mm = 0;  ///< gaps are followed to this: where none less is found both others are cut there
  double required_clearance_mm = 0;
  bool rapids_clear = true;       ///< every rapid stays outside the blank, all bodies
  std::vector<WorstPlace> worst;  ///< deepest first, at most 20, only those beyond the tolerance or the clearance
  WorstPlace deepest;             ///< the single deepest place, also when all is well
  WorstPlace closest;  ///< of shank or holder, where they keep less than is required: the place of the least gap
  std::size_t motions = 0, distance_queries = 0;
  std::size_t sampled_patches = 0, patches = 0;  ///< of the part: bends known from samples alone, of so many

  /// The least gap may be much larger than the proven one: nothing so near was found.
  [[nodiscard]] bool clearance_at_least() const {
    constexpr double kNear_mm = 0.05;
    return clearance_measured_mm >= clearance_followed_mm || clearance_measured_mm > clearance_mm + kNear_mm;
  }
};

/// Material left (> 0) or missing (< 0) on the finished surface after an operation, along the normal.
struct ExcessResult {
  int operation = 0;
  double max_mm = 0, min_mm = 0, rms_mm = 0;
  double bound_mm = 0;  ///< max_mm plus what may stand between the grid points
  std::size_t points = 0;
  double histogram_from_mm = 0, histogram_step_mm = 0;
  std::vector<std::size_t> histogram;
};

/// Corners that no ball of the finishing radius can reach without gouging. What a finished surface may keep anywhere
/// (cusps, chords and a margin: `limit_mm`) is no corner that was left: `share`, `height_mm` and `active` speak of what
/// stands higher than that.
struct UnreachedResult {
  std::size_t points = 0;    ///< of the grid, whatever stays there
  double max_height_mm = 0;  ///< greatest excess at these points
  double ball_mm = 0;  ///< diameter of the finishing ball; 0: the last operation does not finish, nothing below is told
  double limit_mm = 0;
  double share = 0;      ///< of the area of the finished surface
  double height_mm = 0;  ///< greatest height; 0: nothing was left
  double largest_ball_mm =
      0;  ///< diameter of the largest ball that reaches all of the surface; 0 where nothing was left, or no ball does
  struct Place {
    double height_mm = 0;
    int zone = 0;
    tooth_space::Piece patch = tooth_space::Piece::flank_plus;
    double radius_mm = 0, z_mm = 0;
  };
  std::optional<Place>
      active;  ///< the highest place on an active flank: between the tip and what a pinion equal to the shaper touches
  [[nodiscard]] bool left() const { return height_mm > 0; }
};

/// Cusp height reached by the last operation.
struct ScallopResult {
  double requested_mm = 0, reached_min_mm = 0, reached_max_mm = 0;  ///< on the flanks
  double share_within = 0;   ///< share of the flank between -15 % and +5 % of the request
  double fillet_max_mm = 0;  ///< highest cusp on fillets and root
};

/// One grid of the cut surface: a patch of tooth space 0 with its deviation. Row-major, rows along the profile.
struct SurfaceGrid {
  int zone = 0;
  tooth_space::Piece patch = tooth_space::Piece::root;
  int rows = 0, columns = 0;
  std::vector<Vec3> points, normals;
  std::vector<std::vector<float>> excess_um;  ///< one field an operation, in the job's order
  std::vector<unsigned char> reachable;       ///< 0: a corner that the finishing ball cannot reach
};

/// Where a deviation comes from.
enum class ErrorSource : std::uint8_t {
  flank_solve,
  chord,
  scallop,
  line_misfit,
  ridge,
  orientation,
  axis_linearisation,
  rounding,
  path_blending,
  tool_form,
  half_angle,
  run_out,
  pivots,
  tool_length,
  verification,
  deflection,
  point_spacing,
  given_normals,
  meridian_corners,
  continuation
};
[[nodiscard]] constexpr const char* to_string(ErrorSource source) {
  switch (source) {
    case ErrorSource::flank_solve: return "flank solve";
    case ErrorSource::chord: return "chord";
    case ErrorSource::scallop: return "scallop";
    case ErrorSource::line_misfit: return "line misfit";
    case ErrorSource::ridge: return "ridge";
    case ErrorSource::orientation: return "orientation";
    case ErrorSource::axis_linearisation: return "axis linearisation";
    case ErrorSource::rounding: return "rounding";
    case ErrorSource::path_blending: return "path blending";
    case ErrorSource::tool_form: return "tool form";
    case ErrorSource::half_angle: return "half angle";
    case ErrorSource::run_out: return "run-out";
    case ErrorSource::pivots: return "pivots";
    case ErrorSource::tool_length: return "tool length";
    case ErrorSource::verification: return "verification";
    case ErrorSource::deflection: return "deflection";
    case ErrorSource::point_spacing: return "spacing of the points";
    case ErrorSource::given_normals: return "given normals";
    case ErrorSource::meridian_corners: return "corners of root and tip";
    case ErrorSource::continuation: return "continuation";
  }
  return "";
}

struct LedgerEntry {
  ErrorSource source = ErrorSource::flank_solve;
  double predicted_um = 0;
  /// None: the prediction is a model, or the job's word, that nothing of the proof measures; it is no part of any sum.
  std::optional<double> measured_um;
  std::string note;     ///< what was measured, or why the source does not occur
  bool counted = true;  ///< false: nothing states how large it is; the note says what would
};

/// Why the tool stands as it does in one zone of one operation.
struct DirectionChoice {
  int operation = 0, zone = 0;
  bool fixed = true;
  Vec3 axis = Vec3::UnitZ();
  double lean_rad = 0;              ///< angle between the axis and the gear axis
  double clearance_mm = 0;          ///< least gap of shank and holder in that direction
  bool clearance_at_least = false;  ///< gaps are followed no further: they keep that or more
  // Simultaneous (`fixed` is false): `axis` is the mean of the path; leans are from the normal of the pitch surface.
  double least_lean_rad = 0, greatest_lean_rad = 0;
  double greatest_turn_rad_per_mm = 0;  ///< of the axis, along the ball centre
  double greatest_step_rad = 0;         ///< between two neighbouring records of a pass
  int passes = 0, turning_passes = 0;   ///< inside the others the axis stands still
  std::string explanation;
  /// Map of the directions tried: lean and azimuth [rad], least gap [mm], worst body.
  struct Candidate {
    double lean_rad = 0, azimuth_rad = 0, gap_mm = 0;
    tool::Body worst_body = tool::Body::none;
    bool clear = false;
  };
  std::vector<Candidate> candidates;
};

}  // namespace toothpath::proof
