#include "cam/cut/swept_path.h"

#include <algorithm>

namespace toothpath::cut {
namespace {

std::vector<analytic::Box> boxes_of(const std::vector<BallMove>& moves) {
  std::vector<analytic::Box> boxes(moves.size());
  for (std::size_t k = 0; k < moves.size(); ++k) {
    boxes[k].add(moves[k].from);
    boxes[k].add(moves[k].to);
  }
  return boxes;
}

}  // namespace

SweptPath::SweptPath(std::vector<BallMove> moves, double ball_radius_mm)
    : moves_(std::move(moves)), radius_(ball_radius_mm), index_(boxes_of(moves_)) {}

double SweptPath::excess(const Vec3& p, double cap) const {
  double best = cap;
  index_.near(p, radius_ + cap, [&](std::size_t k, double) {
    best = std::min(best, distance_to_segment(p, moves_[k].from, moves_[k].to) - radius_);
    return radius_ + best;
  });
  return best;
}

}  // namespace toothpath::cut
