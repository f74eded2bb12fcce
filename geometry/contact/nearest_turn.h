// The turn of a gear at which a place of its flank comes nearest to the flank of its mate. Inside of both ease-offs.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace toothpath::contact {

inline constexpr double kNever = -1e300;  ///< turn or nearness of a place that the mate's flank does not reach
inline constexpr int kStepsAPitch = 16, kWidestPitches = 6;

/// The lattice turn with the highest nearness, climbed to from `from`; nothing where the mate never comes.
/// @param f  nearness over the turn: minus the distance, mm; kNever where the mate's flank does not come
template <typename Nearness>
std::optional<double> highest_turn(const Nearness& f, double from, double step) {
  constexpr int kWidest = kWidestPitches * kStepsAPitch;
  double at = from, value = f(at);
  for (int k = 1; value == kNever && k <= 2 * kStepsAPitch; ++k)
    for (const double turn : {from + k * step, from - k * step})
      if (value == kNever && f(turn) > kNever) at = turn, value = f(turn);
  if (value == kNever) return std::nullopt;
  for (const double way : {step, -step})
    for (int k = 0; k < kWidest; ++k) {
      const double next = f(at + way);
      if (!(next > value)) break;
      at += way, value = next;
    }
  return at;
}

struct NearestTurn {
  double phi_2 = 0, bend = 0;  ///< rad; minus the second derivative of the nearness there, mm/rad^2
};

/// The top between the lattice turns by parabolas that close in; nothing at the end of the mate's flank.
template <typename Nearness>
std::optional<NearestTurn> top_near(const Nearness& f, double at, double step) {
  double value = f(at), bend = 0;
  const double last = step / 400;
  for (const double h : {step, step / 20, last}) {
    bool inside = false;
    for (int k = 0; k < 50 && !inside; ++k) {
      const double below = f(at - h), above = f(at + h), fall = 2 * value - below - above;
      // Beside the end of the flank a wide parabola does not fit; where the narrowest does not there is no top.
      if (below == kNever || above == kNever || !(fall > 0)) break;
      if (h > last) bend = fall / (h * h);
      const double way = std::clamp(0.5 * h * (above - below) / fall, -h, h);
      inside = std::abs(way) < h;
      if (const double there = f(at + way); there > value) at += way, value = there;
      else inside = true;
    }
    if (h == last && !inside) return std::nullopt;
  }
  return NearestTurn{at, bend};
}

/// Where a place comes nearest, sought from a turn near that one. @param pitch  of the gear, rad
template <typename Nearness>
std::optional<NearestTurn> nearest_turn(const Nearness& f, double from, double pitch) {
  const double step = pitch / kStepsAPitch;
  const auto near = highest_turn(f, from, step);
  return near ? top_near(f, *near, step) : std::nullopt;
}

}  // namespace toothpath::contact
