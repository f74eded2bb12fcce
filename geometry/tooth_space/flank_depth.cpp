#include "geometry/tooth_space/flank_depth.h"

#include <cmath>

#include "geometry/tooth_space/limits.h"

namespace toothpath::tooth_space {
namespace {

constexpr double kAsDeep = 1e-9;  // of the depth: ends that differ by less are alike

}  // namespace

std::optional<FlankDepth> flank_depth(const ToothSpace& space, int side) {
  const Outline& ring = space.outline();
  const Piece piece = flank_of(side);
  const Borders b = space.borders(piece);
  const double u = side > 0 ? b.to : b.from, middle = 0.5 * (ring.s_from + ring.s_to);
  const auto depth = [&](double s) -> std::optional<double> {
    const auto q = place_at(space, piece, u, s);
    return q ? std::optional(space.tip(s) - ring.chart.up(q->p)) : std::nullopt;
  };
  const auto from = depth(ring.s_from), at = depth(middle), to = depth(ring.s_to);
  if (!from || !at || !to || !(*from > 0) || !(*at > 0) || !(*to > 0)) return {};
  const bool alike = std::abs(*to - *from) <= kAsDeep * *at;
  return FlankDepth{*at, middle, alike ? 0 : (*to - *from) / (*at * (ring.s_to - ring.s_from))};
}

}  // namespace toothpath::tooth_space
