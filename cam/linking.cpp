#include "cam/linking.h"

#include <algorithm>
#include <cmath>

namespace toothpath {
namespace {

class Linker {
 public:
  Linker(const LinkingOptions& o, const HopIsClear& clear, std::vector<ClRecord>& out) : o_(o), clear_(clear), out_(out) {}

  void run(const std::vector<BallPass>& passes) {
    int number = 0;
    for (const auto& pass : passes) {
      if (pass.points.empty()) continue;
      pass_ = number++;
      approach(pass.points.front().centre);
      for (std::size_t k = 1; k < pass.points.size(); ++k) feed(pass.points[k - 1], pass.points[k]);
      last_ = pass.points.back().centre;
      engaged_ = true;
    }
    if (engaged_) leave();
  }

 private:
  [[nodiscard]] Vec3 tip(const Vec3& centre) const { return centre - o_.ball_radius_mm * o_.axis; }
  /// The centre lifted along the axis to the clearance height.
  [[nodiscard]] Vec3 above(const Vec3& centre) const {
    const double lift = (o_.clearance_height_mm + o_.ball_radius_mm * o_.axis.z() - centre.z()) / o_.axis.z();
    return centre + std::max(lift, 0.0) * o_.axis;
  }
  void add(const Vec3& centre, MoveKind kind, double feed) {
    out_.push_back({tip(centre), o_.axis, kind == MoveKind::rapid ? 0.0 : feed, kind, o_.zone, pass_});
  }

  void approach(const Vec3& start) {
    if (engaged_) {
      const Vec3 lift = o_.hop_mm * o_.axis, a = last_ + lift, b = start + lift;
      if ((b - a).norm() <= o_.longest_hop_mm && clear_(last_, a) && clear_(a, b) && clear_(b, start)) {
        add(a, MoveKind::retract, o_.feed_mm_min);
        add(b, MoveKind::engage, o_.feed_mm_min);
        add(start, MoveKind::engage, o_.feed_mm_min);
        return;
      }
      leave();
    }
    add(above(start), MoveKind::rapid, 0);
    add(start, MoveKind::engage, o_.feed_mm_min);
  }

  void leave() { add(above(last_), MoveKind::retract, o_.feed_mm_min); }

  void feed(const BallPass::Point& from, const BallPass::Point& to) {
    const double way = (to.centre - from.centre).norm(), contact = (to.contact - from.contact).norm();
    double speed = o_.feed_mm_min;
    if (from.touching && to.touching && contact > 0) speed *= std::min(way / contact, 1.2);
    add(to.centre, MoveKind::feed, speed);
  }

  const LinkingOptions& o_;
  const HopIsClear& clear_;
  std::vector<ClRecord>& out_;
  int pass_ = 0;
  bool engaged_ = false;
  Vec3 last_ = Vec3::Zero();
};

}  // namespace

void link_passes(const std::vector<BallPass>& passes, const LinkingOptions& options, const HopIsClear& hop_is_clear,
                 std::vector<ClRecord>& records) {
  Linker(options, hop_is_clear, records).run(passes);
}

}  // namespace toothpath
