#include "cam/analytic/swept_path.h"

#include <algorithm>

namespace toothpath::analytic {
namespace {

std::vector<Box> boxes_of(const std::vector<BallMove>& moves) {
  std::vector<Box> boxes(moves.size());
  for (std::size_t k = 0; k < moves.size(); ++k) {
    boxes[k].add(moves[k].from);
    boxes[k].add(moves[k].to);
  }
  return boxes;
}

}  // namespace

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

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

}  // namespace toothpath::analytic
