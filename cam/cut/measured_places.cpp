#include "cam/cut/measured_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/work_share.h"

namespace toothpath::cut {
namespace {

// A point counts as reached when a ball that touches it comes no closer than this to anything else, mm.
constexpr double kReachTolerance = 1e-4;
constexpr double kSamePlace = 1e-6;  // a foot this near to a place of the grid is that place, mm
constexpr int kSideSamples = 160;    // across a flank that the side of a mill cuts: its gap is a smooth cubic
constexpr double kSharpEnd = 0.02;   // mm: diameter of the ball that stands for the corner of a flat cutter

/// Radius of the ball that stands for the end of a tool.
double ball_of(const tool::ProofTool& tool) {
  if (tool.ball_mill) return tool.ball_mill->radius_mm();
  return std::max(0.5 * kSharpEnd, tool.cutting.empty() ? 0.0 : tool.cutting.front().round);
}

}  // namespace

RegionJudges::RegionJudges(const std::vector<path::MillingOperation>& operations,
                           const std::vector<tool::ProofTool>& tools)
    : operations_(operations) {
  for (const path::MillingOperation& operation : operations)
    balls_.push_back(ball_of(tools[std::size_t(operation.tool)]));
  if (operations.empty()) return;
  for (const path::Region region : path::kRegions) {
    const auto finisher = operations.back().finishes() ? path::finisher_of(operations, region) : std::nullopt;
    last_[region] = finisher.value_or(operations.size() - 1);
  }
}

MeasuredPlaces::MeasuredPlaces(const analytic::GearDistance& part, const RegionJudges& judges,
                               const CutSurfaceOptions& options)
    : part_(part), judges_(judges), o_(options) {
  const int lines = judges.smooths() ? o_.scallop_lines + 2 : 0;
  WorkShare share(double(part.zones()) * (tooth_space::kPieces + lines));
  zones_.reserve(std::size_t(part.zones()));
  for (int n = 0; n < part.zones(); ++n) {
    Zone& zone = zones_.emplace_back(Zone{ZonePlaces(part, n), {}, {}});
    for (int piece = 0; piece < tooth_space::kPieces; ++piece) {
      PatchPlaces& patch = zone.patches[std::size_t(piece)];
      patch.piece = tooth_space::Piece(piece);
      find_patch(zone.places, patch);
    }
    // The ends of the ring are among them.
    for (int line = 0; line < lines; ++line) {
      const bool end = line == 0 || line + 1 == lines;
      const double at = end ? double(line > 0) : (line - 0.5) / o_.scallop_lines;
      zone.lines.push_back(line_across(zone.places, zone.places.radius(at), end));
      share.add();
    }
  }
}

bool MeasuredPlaces::reachable(const tooth_space::PatchPoint& place, path::Region region) const {
  return reachable(place, region, nullptr);
}

bool MeasuredPlaces::reachable(const tooth_space::PatchPoint& place, path::Region region, double* residual) const {
  if (judges_.none() || judges_.by_side(region)) return true;
  const double R = judges_.ball_in(region);
  const auto q = part_.nearest(place.p + R * place.n, R + 0.01);
  // Where the foot is the place itself, the two solvers must agree.
  if (residual && q.exact && (q.foot - place.p).norm() < kSamePlace) *residual = std::abs(q.distance - R);
  return q.distance >= R - kReachTolerance;
}

void MeasuredPlaces::find_patch(const ZonePlaces& places, PatchPlaces& patch) {
  patch.rows = is_flank(patch.piece)                     ? o_.flank_rows
               : patch.piece == tooth_space::Piece::root ? o_.root_rows
                                                         : o_.fillet_rows;
  patch.columns = o_.columns;
  const std::size_t count = std::size_t(patch.rows) * std::size_t(patch.columns);
  WorkShare share(patch.columns);
  patch.at.resize(count);
  patch.reachable.resize(count);
  std::vector<double> residual(count, 0.0);
  tbb::parallel_for(0, patch.columns, [&](int column) {
    const double r = places.radius(double(column) / (patch.columns - 1));
    const auto [from, to] = places.range(patch.piece, r);
    for (int row = 0; row < patch.rows; ++row) {
      const std::size_t k = std::size_t(row) * std::size_t(patch.columns) + std::size_t(column);
      patch.at[k] = places.at(from + (to - from) * row / (patch.rows - 1), r);
      if (patch.at[k]) patch.reachable[k] = reachable(patch.at[k]->contact, path::region_of(patch.piece), &residual[k]);
    }
    share.add();
  });
  for (const double r : residual) solve_residual_mm_ = std::max(solve_residual_mm_, r);
}

LinePlaces MeasuredPlaces::line_across(const ZonePlaces& places, double r, bool end) {
  LinePlaces line{r, end, {}};
  for (int piece = 0; piece < tooth_space::kPieces; ++piece) {
    const path::Region region = path::region_of(tooth_space::Piece(piece));
    const double step = std::sqrt(8 * judges_.ball_in(region) * judges_.last_in(region).scallop_in(region)) / 24;
    const auto [from, to] = places.range(tooth_space::Piece(piece), r);
    const auto a = places.at(from, r), b = places.at(to, r);
    if (!a || !b) continue;
    const double length = (b->contact.p - a->contact.p).norm();
    const int n = judges_.by_side(region) ? kSideSamples : step > 0 ? std::max(16, int(1.2 * length / step)) : 16;
    line_step_mm_ = std::max(line_step_mm_, length / n);
    // Where two pieces join one point is enough.
    for (int k = line.places.empty() ? 0 : 1; k <= n; ++k)
      line.places.push_back({tooth_space::Piece(piece), from + (to - from) * k / n, {}});
  }
  tbb::parallel_for(std::size_t(0), line.places.size(), [&](std::size_t k) {
    if (const auto s = places.at(line.places[k].sigma, r)) line.places[k].p = s->contact.p;
  });
  return line;
}

}  // namespace toothpath::cut
