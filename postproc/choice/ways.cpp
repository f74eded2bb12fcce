#include "postproc/choice/ways.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::choice {
namespace {

constexpr double kSameMinutes = 1e-12;  // sums of the same turns in another order

}  // namespace

double reposition_minutes(const machines::KinematicChain& chain, const RotaryPair& from, const RotaryPair& to) {
  double minutes = 0;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    const machines::RotaryAxis& axis = chain.rotary(k);
    const double turn = to[k] - from[k];
    minutes = std::max(minutes, std::abs(axis.rollover ? std::remainder(turn, kTwoPi) : turn) / axis.max_speed);
  }
  return minutes;
}

std::vector<std::size_t> choose_ways(std::span<const std::vector<ToothWay>> teeth, const RotaryPair& from,
                                     const machines::KinematicChain& chain) {
  struct State {
    double minutes = 0;
    std::size_t before = 0;
  };
  std::vector<std::vector<State>> states;
  for (std::size_t n = 0; n < teeth.size(); ++n) {
    std::vector<State>& here = states.emplace_back();
    for (const ToothWay& way : teeth[n]) {
      State best;
      if (n == 0) best.minutes = reposition_minutes(chain, from, way.begin);
      for (std::size_t b = 0; n > 0 && b < teeth[n - 1].size(); ++b) {
        const double minutes = states[n - 1][b].minutes + reposition_minutes(chain, teeth[n - 1][b].end, way.begin);
        if (b == 0 || minutes < best.minutes - kSameMinutes) best = {minutes, b};
      }
      best.minutes += way.minutes;
      here.push_back(best);
    }
  }
  std::vector<std::size_t> out(teeth.size());
  if (teeth.empty()) return out;
  std::size_t at = 0;
  for (std::size_t w = 1; w < states.back().size(); ++w)
    if (states.back()[w].minutes < states.back()[at].minutes - kSameMinutes) at = w;
  for (std::size_t n = teeth.size(); n-- > 0;) {
    out[n] = at;
    at = states[n][at].before;
  }
  return out;
}

}  // namespace toothpath::choice
