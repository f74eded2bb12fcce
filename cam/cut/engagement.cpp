#include "cam/cut/engagement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::cut {
namespace {

/// Points of the cutting part at one height, in the frame of the tool.
struct PointRing {
  double height = 0, radius = 0;
  double normal_out = 1, normal_up = 0;  ///< of the surface: from the axis, along it
};

constexpr double kChipCounts =
    0.5;  // of the largest chip: the tip of a ball that sinks touches all around, and cuts little
constexpr double kPlaces = 0.2;  // of the largest radius, between the places of a motion that are looked at

std::vector<PointRing> rings_of(const tool::Meridian& meridian) {
  const double longest = kEngagementStep * meridian.largest_radius();
  std::vector<PointRing> out;
  for (const tool::MeridianPiece& piece : meridian.pieces()) {
    const double length = (piece.to - piece.from).norm() * (piece.bend != 0 ? 0.5 * kPi : 1);
    const int count = std::max(1, int(std::ceil(length / longest)));
    for (int k = 0; k < count; ++k) {
      const Vec2 chord = piece.from + (piece.to - piece.from) * ((k + 0.5) / count);
      const Vec2 at = tool::nearest_on_piece<double>(piece, chord), normal = tool::piece_normal<double>(piece, at);
      out.push_back({at[0], at[1], normal[1], normal[0]});
    }
  }
  return out;
}

class Along {
 public:
  Along(const std::vector<path::ToolMotion>& motions, const EngagementQuery& q)
      : motions_(motions), q_(q), rings_(rings_of(q.mill.cutting())), own_(cuts_of(motions), q.cutting, q.top_mm) {
    for (int k = 0; k < int(2 * kPi / kEngagementStep); ++k) around_.push_back(k * kEngagementStep);
  }

  std::vector<Engaged> run() const {
    std::vector<std::size_t> done(motions_.size(), 0);  // motions that cut, before each
    for (std::size_t k = 1; k < motions_.size(); ++k) done[k] = done[k - 1] + (motions_[k - 1].rapid ? 0 : 1);
    std::vector<Engaged> out(motions_.size());
    WorkShare share{double(motions_.size())};
    tbb::parallel_for(std::size_t{0}, motions_.size(), [&](std::size_t k) {
      if (!motions_[k].rapid && k % q_.one_of == 0) out[k] = worst(motions_[k], done[k]);
      share.add();
    });
    return out;
  }

 private:
  static std::vector<path::ToolMotion> cuts_of(std::vector<path::ToolMotion> motions) {
    std::erase_if(motions, [](const path::ToolMotion& m) { return m.rapid; });
    return motions;
  }

  [[nodiscard]] Engaged worst(const path::ToolMotion& m, std::size_t done) const {
    Engaged most;
    const double way = (m.tip_to - m.tip_from).norm();
    if (way == 0) return most;
    const int places = std::max(1, int(std::ceil(way / (kPlaces * q_.mill.cutting().largest_radius()))));
    for (int k = 0; k <= places; ++k) at(m, double(k) / places, done, most);
    return most;
  }

  void at(const path::ToolMotion& m, double t, std::size_t done, Engaged& most) const {
    const Vec3 tip = path::tip_at(m, t), axis = path::axis_at(m, t), feed = (m.tip_to - m.tip_from).normalized();
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    double steepest = 0;
    std::vector<Engaged> at_heights;
    for (const PointRing& ring : rings_) {
      Engaged here;
      for (const double a : around_) {
        const Vec3 out = std::cos(a) * u + std::sin(a) * v;
        const double along = (ring.normal_out * out + ring.normal_up * axis).dot(feed);
        if (along <= 0 || !stands(tip + ring.height * axis + ring.radius * out, done)) continue;
        here.angle_rad += kEngagementStep;
        here.steepest = std::max(here.steepest, along);
      }
      steepest = std::max(steepest, here.steepest);
      at_heights.push_back(here);
    }
    most.steepest = std::max(most.steepest, steepest);
    for (const Engaged& here : at_heights) {
      if (here.steepest >= kChipCounts * steepest) most.angle_rad = std::max(most.angle_rad, here.angle_rad);
      if (here.steepest >= kChipCounts) most.loaded_rad = std::max(most.loaded_rad, here.angle_rad);
    }
  }

  [[nodiscard]] bool stands(const Vec3& p, std::size_t done) const {
    if (!q_.in_blank(p)) return false;
    for (const Removed* removed : q_.before)
      if (removed->excess(p, kThinnestStock) < kThinnestStock) return false;
    return own_.excess_after(done, p, kThinnestStock) >= kThinnestStock;
  }

  const std::vector<path::ToolMotion>& motions_;
  const EngagementQuery& q_;
  std::vector<PointRing> rings_;
  std::vector<double> around_;
  SweptTool own_;
};

}  // namespace

std::vector<Engaged> engagement_along(const std::vector<path::ToolMotion>& motions, const EngagementQuery& query) {
  return Along(motions, query).run();
}

}  // namespace toothpath::cut
