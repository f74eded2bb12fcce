#include "cam/ball/axis_records.h"

#include <algorithm>
#include <cmath>

namespace toothpath::ball {
namespace {

constexpr int kAxisSamples = 16;  // of the axis between two points of a pass

}  // namespace

BallPass::Point blend_points(const BallPass::Point& a, const BallPass::Point& b, double t) {
  return {a.centre + t * (b.centre - a.centre), a.contact + t * (b.contact - a.contact), a.touching && b.touching};
}

PassTrack::PassTrack(const BallPass& pass) : points_(&pass.points) {
  for (std::size_t k = 0; k < pass.points.size(); ++k)
    at_.push_back(k == 0 ? 0 : at_.back() + (pass.points[k].centre - pass.points[k - 1].centre).norm());
}

BallPass::Point PassTrack::point(double s) const {
  if (at_.size() < 2) return points_->front();
  const auto k =
      std::size_t(std::clamp<long>(std::upper_bound(at_.begin(), at_.end(), s) - at_.begin(), 1, long(at_.size()) - 1));
  const double span = at_[k] - at_[k - 1];
  return blend_points((*points_)[k - 1], (*points_)[k], span > 0 ? std::clamp((s - at_[k - 1]) / span, 0.0, 1.0) : 0);
}

AxisRecords records_with_axes(const PassTrack& track, const std::function<Vec3(double s)>& axis, double chord_mm,
                              double ball_radius_mm) {
  const double limit = std::min(0.9 * kMostTurnPerRecord, std::sqrt(8 * chord_mm / ball_radius_mm));
  const auto& at = track.at();
  const auto& points = track.points();
  AxisRecords out;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (k > 0) {
      const double from = at[k - 1], to = at[k];
      double turn = 0;
      for (int j = 1; j <= kAxisSamples; ++j)
        turn = std::max(turn, kAxisSamples * angle_between(axis(from + (to - from) * (j - 1) / kAxisSamples),
                                                           axis(from + (to - from) * j / kAxisSamples)));
      const int pieces = std::max(1, int(std::ceil(turn / limit)));
      for (int j = 1; j < pieces; ++j) {
        const double t = double(j) / pieces;
        out.points.push_back(blend_points(points[k - 1], points[k], t));
        out.axes.push_back(axis(from + t * (to - from)));
      }
    }
    out.points.push_back(points[k]);
    out.axes.push_back(axis(at[k]));
  }
  return out;
}

}  // namespace toothpath::ball
