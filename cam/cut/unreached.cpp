#include "cam/cut/unreached.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cam/cut/zone_places.h"
#include "geometry/tooth_space/curvature.h"

namespace toothpath::cut {
namespace {

constexpr int kColumns = 33;
constexpr int kRows[tooth_space::kPieces] = {40, 33, 9, 33, 40};  // places of a piece across the space
constexpr double kTouch = 1e-7;    // mm: deeper in, a ball counts as stopped by what it meets
constexpr int kShrinkSteps = 60;   // of one ball; each takes it to the place it met deepest
constexpr double kBeside = 2e-3;   // of the radius: a foot this near to the place itself
constexpr double kEdgeSag = 1e-3;  // mm: more than the polylines of edges leave
constexpr double kSharp = 1e-3;    // mm: a ball smaller than this is none
constexpr double kFinest = 1e-5;   // of the pattern search, in sigma and in shares of the face

class BallSearch {
 public:
  BallSearch(const analytic::GearDistance& part, int zone, double most)
      : part_(part), places_(part, zone), zone_(zone), most_(most) {}

  /// Radius of the largest ball that touches the surface at a place; nothing where there is no surface.
  [[nodiscard]] std::optional<double> radius(double sigma, double share) const {
    const auto s = places_.at(sigma, places_.radius(share));
    if (!s) return {};
    const double k = concave_curvature(s->contact);
    return shrunk(s->contact.p, s->contact.n, k * most_ > 1 ? 1 / k : most_);
  }

  /// The tightest place of a grid, followed to its bottom.
  [[nodiscard]] LargestBall tightest() const {
    struct Column {
      double radius = INFINITY, sigma = 0, share = 0;
    };
    std::vector<Column> columns(kColumns);
    tbb::parallel_for(0, kColumns, [&](int c) {
      Column& best = columns[std::size_t(c)];
      const double share = double(c) / (kColumns - 1), r = places_.radius(share);
      for (int piece = 0; piece < tooth_space::kPieces; ++piece) {
        const auto [from, to] = places_.range(tooth_space::Piece(piece), r);
        for (int row = 0; row < kRows[piece]; ++row) {
          const double sigma = from + (to - from) * row / (kRows[piece] - 1);
          if (const auto R = radius(sigma, share); R && *R < best.radius) best = {*R, sigma, share};
        }
      }
    });
    const auto& best = *std::min_element(columns.begin(), columns.end(),
                                         [](const Column& a, const Column& b) { return a.radius < b.radius; });
    return followed(best.radius, best.sigma, best.share);
  }

 private:
  /// The ball in the normal n at p, made smaller until it meets nothing: through the place met deepest each time.
  [[nodiscard]] double shrunk(Vec3 p, Vec3 n, double R) const {
    for (int k = 0; k < kShrinkSteps; ++k) {
      const Vec3 c = p + R * n;
      const auto q = part_.nearest(c, R);
      if (q.distance >= R - kTouch) return R;
      const double turn = std::atan2(q.point.y(), q.point.x()) - std::atan2(c.y(), c.x());
      const Vec3 across = q.foot - turned(p, turn);
      // A foot beside the place is its own curvature, which is known already; one on an edge may be nearer by the sag
      // of the edge's polyline.
      if (across.norm() < kBeside * R || (!q.exact && q.distance >= R - kEdgeSag)) return R;
      const double ahead = across.dot(turned(n, turn)), next = ahead > 0 ? across.squaredNorm() / (2 * ahead) : R;
      if (!(next < R)) return R;
      R = next;
    }
    return R;
  }

  [[nodiscard]] LargestBall followed(double R, double sigma, double share) const {
    double step_sigma = 0.02, step_share = 1.0 / (kColumns - 1);
    while (step_sigma > kFinest || step_share > kFinest) {
      bool better = false;
      for (const auto& [ds, dr] :
           {std::pair{step_sigma, 0.0}, {-step_sigma, 0.0}, {0.0, step_share}, {0.0, -step_share}}) {
        const double at = std::clamp(share + dr, 0.0, 1.0), r = places_.radius(at);
        const double s = std::clamp(sigma + ds, places_.range(tooth_space::Piece::flank_plus, r).first,
                                    places_.range(tooth_space::Piece::flank_minus, r).second);
        const auto there = radius(s, at);
        if (!there || *there >= R) continue;
        R = *there;
        sigma = s;
        share = at;
        better = true;
        break;
      }
      if (better) continue;
      step_sigma *= 0.5;
      step_share *= 0.5;
    }
    LargestBall ball{R < kSharp ? 0.0 : R, zone_, tooth_space::Piece::root, Vec3::Zero()};
    if (const auto s = places_.at(sigma, places_.radius(share))) {
      ball.piece = s->piece;
      ball.place = s->contact.p;
    }
    return ball;
  }

  const analytic::GearDistance& part_;
  ZonePlaces places_;
  int zone_;
  double most_;
};

}  // namespace

double concave_curvature(const tooth_space::PatchPoint& at) {
  const double least = tooth_space::principal_curvatures(at).least;
  return std::isfinite(least) ? std::max(0.0, -least) : 0.0;
}

LargestBall largest_reaching_ball(const analytic::GearDistance& part, double most_mm) {
  LargestBall least;
  least.radius_mm = most_mm;
  for (int zone = 0; zone < part.zones(); ++zone)
    if (const auto ball = BallSearch(part, zone, most_mm).tightest(); zone == 0 || ball.radius_mm < least.radius_mm)
      least = ball;
  return least;
}

}  // namespace toothpath::cut
