// A cutter as a profile r(h): its meridian from the tip upwards, made of arcs and lines, turned about the axis.
//
// Ball, tapered ball, flat, bull nose, barrel and finger mill are data of one type; planners state which profile they
// need. T frame: tip at the origin, z the axis towards the holder; in the half plane (h, r) h is the height above the
// tip, r >= 0 the radius. mm, rad.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cam/tool/assembly.h"
#include "cam/tool/frustum_distance.h"
#include "cam/tool/radius_law.h"
#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::tool {

/// One arc or line of a meridian. Heights do not fall from `from` to `to`; a level line is a flat or a shoulder.
struct MeridianPiece {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< (h, r)
  double bend = 0;  ///< 1 / radius: > 0 bulges outwards, < 0 hollow, 0 a line; an arc turns at most 180 deg
};

/// The point of a body nearest to a place of the half plane.
template <typename S>
struct MeridianDistance {
  S distance{};                          ///< negative inside
  Vec2T<S> gradient = Vec2T<S>::Zero();  ///< of the distance along (h, r), unit
};

/// The circle of a bent piece: centre, the unit direction from there to the middle of the arc, radius, and the chord's
/// distance from the centre.
template <typename S>
struct PieceCircle {
  Vec2T<S> centre, out;
  S R{}, chord_at{};
};
template <typename S>
PieceCircle<S> circle_of(const MeridianPiece& piece) {
  using std::sqrt;
  const S sense(piece.bend < 0 ? -1 : 1), R = sense / S(piece.bend);
  const Vec2T<S> a(S(piece.from[0]), S(piece.from[1])), b(S(piece.to[0]), S(piece.to[1])), chord = b - a;
  const S l2 = chord.dot(chord), h2 = R * R - l2 / S(4);
  PieceCircle<S> c;
  c.R = R;
  c.chord_at = h2 > S(0) ? S(sqrt(h2)) : S(0);  // 0: half a circle
  c.out = Vec2T<S>(-chord[1], chord[0]) * S(sense / sqrt(l2));
  c.centre = (a + b) * S(0.5) - c.out * c.chord_at;
  return c;
}

/// The place of a piece nearest to q, exact to rounding.
template <typename S>
Vec2T<S> nearest_on_piece(const MeridianPiece& piece, const Vec2T<S>& q) {
  using std::sqrt;
  const Vec2T<S> a(S(piece.from[0]), S(piece.from[1])), b(S(piece.to[0]), S(piece.to[1])), chord = b - a;
  const S l2 = chord.dot(chord);
  if (!(l2 > S(0))) return a;
  if (piece.bend == 0) {
    const S t = S((q - a).dot(chord)) / l2;
    return t < S(0) ? a : t > S(1) ? b : Vec2T<S>(a + chord * t);
  }
  const auto c = circle_of<S>(piece);
  const Vec2T<S> v = q - c.centre;
  const S length = sqrt(S(v.dot(v)));
  // On the arc if it lies beyond the chord as seen from the centre.
  if (!(length > S(0)) || S(v.dot(c.out)) * c.R < length * c.chord_at)
    return S((q - a).dot(q - a)) < S((q - b).dot(q - b)) ? a : b;
  return Vec2T<S>(c.centre + v * S(c.R / length));
}

/// Unit normal of a piece out of the body, at a place of it.
template <typename S>
Vec2T<S> piece_normal(const MeridianPiece& piece, const Vec2T<S>& at) {
  using std::sqrt;
  const Vec2T<S> left(S(piece.from[1] - piece.to[1]), S(piece.to[0] - piece.from[0]));
  if (piece.bend == 0) return Vec2T<S>(left / S(sqrt(S(left.dot(left)))));
  const auto c = circle_of<S>(piece);
  return Vec2T<S>((at - c.centre) * S(S(piece.bend < 0 ? -1 : 1) / c.R));
}

/// A solid of revolution between two heights: a chain of pieces, closed by discs below and above.
class Meridian {
 public:
  /// Pieces from below, each beginning where the one before it ends; heights never fall, radii never negative.
  explicit Meridian(std::vector<MeridianPiece> pieces) : pieces_(std::move(pieces)) {}
  [[nodiscard]] const std::vector<MeridianPiece>& pieces() const { return pieces_; }
  /// Ends of the pieces from below, (h, r): a polyline where all of them are lines.
  [[nodiscard]] std::vector<Vec2> corners() const;
  [[nodiscard]] bool empty() const { return pieces_.empty(); }
  [[nodiscard]] double from() const { return pieces_.front().from[0]; }
  [[nodiscard]] double to() const { return pieces_.back().to[0]; }

  /// Radius at height h in [from, to]; at a shoulder the larger one; 0 outside.
  template <typename S>
  [[nodiscard]] S radius(const S& h) const {
    using std::sqrt;
    S widest(0);
    for (const auto& piece : pieces_) {
      if (h < S(piece.from[0]) || h > S(piece.to[0])) continue;
      const S dh(piece.to[0] - piece.from[0]), r0(piece.from[1]), r1(piece.to[1]);
      S r = dh > S(0) ? S(r0 + (h - S(piece.from[0])) / dh * (r1 - r0)) : std::max(r0, r1);
      if (piece.bend != 0) {
        const auto c = circle_of<S>(piece);
        const S x = h - c.centre[0], y2 = c.R * c.R - x * x, y = y2 > S(0) ? S(sqrt(y2)) : S(0);
        r = piece.bend > 0 ? S(c.centre[1] + y) : S(c.centre[1] - y);
      }
      widest = std::max(widest, r);
    }
    return widest;
  }
  [[nodiscard]] double largest_radius() const;
  /// Does the body equal its convex hull? (No hollow piece, no shoulder that stands out above a thinner part.)
  [[nodiscard]] bool convex() const;

  /// Signed distance of a place (h, r >= 0) to the boundary, negative inside. The axis is no boundary.
  template <typename S>
  [[nodiscard]] MeridianDistance<S> distance(const S& h, const S& r) const {
    using std::sqrt;
    const Vec2T<S> q(h, r);
    Vec2T<S> foot = Vec2T<S>::Zero(), normal = Vec2T<S>::Zero();
    S best(-1);
    const auto look = [&](const MeridianPiece& piece) {
      const Vec2T<S> p = nearest_on_piece<S>(piece, q);
      const S d2 = (q - p).dot(q - p);
      if (!(best < S(0)) && !(d2 < best)) return;
      best = d2;
      foot = p;
      normal = piece_normal<S>(piece, p);
    };
    const Vec2 low = pieces_.front().from, high = pieces_.back().to;
    if (low[1] > 0) look({Vec2(low[0], 0), low, 0});
    for (const auto& piece : pieces_) look(piece);
    if (high[1] > 0) look({high, Vec2(high[0], 0), 0});
    const bool in = !(h < S(low[0])) && !(h > S(high[0])) && !(r > radius<S>(h));
    const S d = sqrt(best), sense(in ? -1 : 1);
    return {S(sense * d), d > S(0) ? Vec2T<S>((q - foot) * S(sense / d)) : normal};
  }

  /// Truncated cones that enclose the body, from below: lines as they are, hollow arcs in chords, bulging arcs in
  /// tangents that leave it by no more than `sag_mm`. Together their union contains the body and lies within sag_mm of
  /// it.
  [[nodiscard]] std::vector<Frustum> enclosing_frustums(double sag_mm, Body body) const;

 private:
  std::vector<MeridianPiece> pieces_;
};

enum class CutterShape { ball, tapered_ball, flat, bull_nose, barrel };

/// What a tool is ordered by. Lengths mm from the tip, angles rad.
struct CutterData {
  CutterShape shape = CutterShape::ball;
  double diameter_mm = 0;         ///< of the ball end; flat and bull nose: of the cutter
  double half_angle_rad = 0;      ///< tapered ball and barrel: between axis and side where it leaves the ball
  double corner_radius_mm = 0;    ///< bull nose
  double meridian_radius_mm = 0;  ///< barrel: > 0 bulging, < 0 hollow
  double flute_length_mm = 0;     ///< the teeth end here
  double shank_diameter_mm = 0;
  double length_mm = 0;     ///< gauge line to tip; the shank ends there where there is no holder
  double stick_out_mm = 0;  ///< tip to the lower face of the holder
  std::vector<HolderSegment> holder;
  std::optional<MeridianError> meridian;  ///< measured: error of rho along t
};
/// What a job says of a tool whose form its numbers give, as cutter data.
[[nodiscard]] CutterData cutter_data(const ToolAssembly& tool);

/// What is above the cutting part of any assembly, as its numbers say; empty where they leave no room for it.
[[nodiscard]] Meridian shank_of(const ToolAssembly& tool);
[[nodiscard]] Meridian holder_of(const ToolAssembly& tool);

/// What a tool consists of where gaps are proven: convex bodies whose union contains it.
struct ProofBodies {
  double ball_height_mm = 0, ball_radius_mm = 0;  ///< centre above the tip; radius 0: no ball end
  std::vector<Frustum> frustums;                  ///< "flute", "shank", "holder", from below
};

/// A checked tool: cutting part, shank and holder.
class Profile {
 public:
  /// Refuses what makes no body, all reasons at once: numbers that are not finite or not positive; a half angle outside
  /// (0, 45) deg; a corner or ball that does not fit under the flutes; a shank of a tapered mill thinner than its
  /// flutes; a barrel whose flutes pass its widest place; a stick-out below the flutes; a measured meridian that begins
  /// above the ball's centre, is not ascending, or errs by more than r_0/10.
  static std::variant<Profile, std::vector<Refusal>> make(const CutterData& data);
  /// Of data that `make` would accept; nothing is checked again.
  static Profile of_accepted(const CutterData& data) { return unchecked(data); }
  /// A body from pieces, for cutters whose form is made elsewhere. `shank` and `holder` may be empty. No law.
  Profile(Meridian cutting, Meridian shank, Meridian holder)
      : cutting_(std::move(cutting)), shank_(std::move(shank)), holder_(std::move(holder)) {}

  /// Tip to the end of the teeth, nominal.
  [[nodiscard]] const Meridian& cutting() const { return cutting_; }
  /// Above the teeth: of a tapered mill the cone goes on, without teeth, until it is as thick as the shank; then a
  /// cylinder.
  [[nodiscard]] const Meridian& shank() const { return shank_; }
  [[nodiscard]] const Meridian& holder() const { return holder_; }
  /// Law of the side about the ball end; none for flat, bull nose and finger mills. Holds up to `law_end()`.
  [[nodiscard]] const std::optional<RadiusLaw<double>>& law() const { return law_; }
  /// Height t above the ball's centre whose ball touches at the end of the teeth, or where the measured meridian ends
  /// if that is lower.
  [[nodiscard]] double law_end() const { return law_end_; }
  [[nodiscard]] double half_angle_rad() const { return half_angle_; }
  /// A ball with a cylinder above it, as nominal: its distance is that of the ball's centre.
  [[nodiscard]] bool plain_ball() const { return law_ && half_angle_ == 0 && law_->R_m == 0 && !law_->error; }
  /// Signed distance from a point of T to the cutting part as it was measured, with its gradient: the nominal one less
  /// the error at the height of its foot. Without a measured meridian exact; with one the error is below f'^2 times the
  /// foot's distance from the axis.
  [[nodiscard]] FrustumSlope cutting_distance(const Vec3& point_T) const;

  /// Ball and truncated cones that contain the whole tool, no more than `sag_mm` outside of it, and what is measured
  /// above the nominal form.
  [[nodiscard]] ProofBodies proof_bodies(double sag_mm) const;

 private:
  Profile() : cutting_({}), shank_({}), holder_({}) {}
  static Profile unchecked(const CutterData& data);
  Meridian cutting_, shank_, holder_;
  std::optional<RadiusLaw<double>> law_;
  double law_end_ = 0, half_angle_ = 0;
};

}  // namespace toothpath::tool
