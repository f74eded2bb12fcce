// One pass as a line of stations with a lean each, and the two searches for it: one lean that is clear everywhere, else
// the cheapest way through the clear leans. Knows nothing of tools: what is clear is asked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "cam/ball/finishing.h"
#include "geometry/base/vec.h"

namespace toothpath::ball {

/// Weights of the cost, which is the integral along the pass of
///   kLeanWeight |q|^2 + kNearWeight |q - q of the pass beside it|^2 + kTurnWeight |dq/ds|^2,
/// q being the lean as two tangents (outwards, aside) against the pitch normal, s in mm.
inline constexpr double kLeanWeight = 0.1, kNearWeight = 0.5, kTurnWeight = 20;

/// Leans on a square grid inside a disc, least lean first.
struct LeanGrid {
  double step = 0;  ///< tangent
  int half = 0;     ///< columns to each side of upright
  std::vector<Vec2> leans;
  std::vector<std::pair<int, int>> cells;
  /// 0.04: 2.3 deg.
  explicit LeanGrid(double widest_tangent, double step_tangent = 0.04);
};

struct OrientationWay {
  std::vector<double> s, r;  ///< mm along the pass, and radius about the gear axis, of every station
  std::vector<BallPass::Point> points;
  std::vector<Vec2> lean;                                ///< one a station
  std::vector<std::size_t> near;                         ///< passes beside it, nearest first
  std::vector<std::pair<double, BallPass::Point>> also;  ///< places (s, point) that are asked with the nearest station
  bool constant = false, solved = false;
  bool tight = false;  ///< little room: searched at closer stations with the least margin

  /// mm from the station before to a station; of the first one to the next.
  [[nodiscard]] double step(std::size_t station) const;
  /// Lean at a radius, straight between the stations, constant beyond the ends.
  [[nodiscard]] Vec2 lean_at(double radius) const;
  /// Lean at s. Smooth: a cubic with limited slopes, which has a continuous derivative and never leaves the box of its
  /// two stations.
  [[nodiscard]] Vec2 lean_along(double at, bool smooth) const;
};

using LeanReference = std::function<Vec2(std::size_t station)>;
using LeanIsClear = std::function<bool(std::size_t station, const Vec2& lean)>;
/// Clear half-way between a station and the next one, with their leans?
using HalfWayIsClear = std::function<bool(std::size_t station, const Vec2& lean, const Vec2& next)>;

/// The cheapest lean of the grid that is clear at every station; false if there is none.
[[nodiscard]] bool find_constant(OrientationWay& way, const LeanGrid& grid, const LeanReference& reference,
                                 const LeanIsClear& clear);

/// What is known of a square of leans about `centre`, `half` to each side.
enum class Leans : std::uint8_t { mixed, none_clear, all_clear };
using LeansInSquare = std::function<Leans(std::size_t station, const Vec2& centre, double half)>;

/// A clear lean within the widest tangent, found by halving squares of leans, those nearest to `near` first; none where
/// no lean of any square is clear, but for squares smaller than `finest` that are not clear at their centres.
[[nodiscard]] std::optional<Vec2> find_clear_lean(double widest_tangent, double finest, const Vec2& near,
                                                  const std::function<Leans(const Vec2& centre, double half)>& square,
                                                  const std::function<bool(const Vec2& lean)>& clear);

struct WayFound {
  bool found = false;
  std::size_t blocked_at = 0;  ///< first station that is not reached
  bool none_clear = false;     ///< no lean at all is clear there; else some are, but none that is reached
};

/// The cheapest way through the clear leans by dynamic programming over stations and grid; between two stations the
/// lean turns by at most 0.25 rad/mm. Looks near the reference first, then at the whole grid; with `square` at once,
/// square by square: that is for fine grids.
[[nodiscard]] WayFound find_way(OrientationWay& way, const LeanGrid& grid, const LeanReference& reference,
                                const LeanIsClear& clear, const HalfWayIsClear& half_way,
                                const LeansInSquare& square = {});

/// A part of a pass that is cut in one stroke: from station to station, one lean a station.
struct WayStroke {
  std::size_t from = 0, to = 0;
  std::vector<Vec2> lean;
};
inline constexpr std::size_t kMostStrokes = 4;

/// Ways that together go over all stations where one alone does not, as few strokes as possible, at most kMostStrokes:
/// the tool leaves a stroke, turns, and begins the next one a station before the end of the last, or at that end where
/// no lean allows more. Empty: there are none. `blocked_at` is the first station that no stroke reaches.
[[nodiscard]] std::vector<WayStroke> find_strokes(const OrientationWay& way, const LeanGrid& grid,
                                                  const LeanReference& reference, const LeanIsClear& clear,
                                                  const HalfWayIsClear& half_way, std::size_t& blocked_at,
                                                  const LeansInSquare& square = {});

}  // namespace toothpath::ball
