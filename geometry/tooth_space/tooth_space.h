// The tooth space of any gear, as planners and proofs ask for it: five smooth pieces from tooth 0 through the root to
// tooth 1, in a chart of the meridian plane in which the teeth stand upright.
//
// A gear type comes in by one kernel (kernel_space.h) or, where it has closed forms, by its own class.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/base/angle.h"
#include "geometry/base/vec.h"
#include "geometry/tooth_space/enclosure.h"
#include "geometry/tooth_space/piece.h"

namespace toothpath::tooth_space {

/// Ends of a range.
struct Range {
  double low = 0, high = 0;
};

/// The meridian plane (r, z) turned so that teeth stand upright: s runs along the teeth, h out of the body; sine >= 0.
/// Face gear: (r, z); cylindrical gear: (-z, r); bevel gear with its apex below: s runs along the pitch cone towards
/// the apex, sine and cosine are the cosine of the pitch angle and its sine with a minus.
struct Chart {
  double cosine = 1, sine = 0;
  [[nodiscard]] double along(const Vec3& p) const { return cosine * radius(p) - sine * p.z(); }
  [[nodiscard]] double up(const Vec3& p) const { return sine * radius(p) + cosine * p.z(); }
  /// Derivatives of both while p moves by d.
  [[nodiscard]] double along(const Vec3& p, const Vec3& d) const { return cosine * outwards(p, d) - sine * d.z(); }
  [[nodiscard]] double up(const Vec3& p, const Vec3& d) const { return sine * outwards(p, d) + cosine * d.z(); }
  /// Both over a range of radii and of z.
  [[nodiscard]] Range along(const Range& r, const Range& z) const {
    return {(cosine > 0 ? cosine * r.low : cosine * r.high) - sine * z.high,
            (cosine > 0 ? cosine * r.high : cosine * r.low) - sine * z.low};
  }
  [[nodiscard]] Range up(const Range& r, const Range& z) const {
    return {sine * r.low + (cosine > 0 ? cosine * z.low : cosine * z.high),
            sine * r.high + (cosine > 0 ? cosine * z.high : cosine * z.low)};
  }
  /// Radius and height of a place.
  [[nodiscard]] double r(double s, double h) const { return cosine * s + sine * h; }
  [[nodiscard]] double z(double s, double h) const { return cosine * h - sine * s; }
  [[nodiscard]] Vec3 place(double s, double azimuth, double h) const {
    const double r = this->r(s, h);
    return {r * std::cos(azimuth), r * std::sin(azimuth), z(s, h)};
  }
  /// Unit vectors along the teeth and out of the body, in the meridian plane at an azimuth.
  [[nodiscard]] Vec3 along_at(double azimuth) const {
    return {cosine * std::cos(azimuth), cosine * std::sin(azimuth), -sine};
  }
  [[nodiscard]] Vec3 up_at(double azimuth) const {
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
  }

 private:
  static double outwards(const Vec3& p, const Vec3& d) { return (p.x() * d.x() + p.y() * d.y()) / radius(p); }
};

/// A point of a piece with derivatives. Gear frame, mm; n is the unit normal out of the material.
struct PatchPoint {
  Vec3 p = Vec3::Zero(), n = Vec3::Zero();
  Vec3 pu = Vec3::Zero(), pv = Vec3::Zero();  ///< dp/du, dp/dv
  Vec3 nu = Vec3::Zero(), nv = Vec3::Zero();  ///< dn/du, dn/dv
};

/// Nearest point of a piece (continued beyond its borders) to some point c:  c = p + distance n.
struct PatchFoot {
  double u = 0, v = 0, distance = 0;
  PatchPoint at;
};

/// Where a flank leaves the tooth through the tip surface.
struct EdgePlace {
  double u = 0, v = 0;
  double azimuth = 0;  ///< of the flank's own tooth, unwrapped, rad
};

/// u where a piece begins and ends on the way from the plus to the minus flank. On its tip's side a flank goes on
/// without end (+ or - infinity): there the tip edge cuts it off.
struct Borders {
  double from = 0, to = 0;
  [[nodiscard]] bool hold(double u, double slack) const {
    return from <= to ? u >= from - slack && u <= to + slack : u >= to - slack && u <= from + slack;
  }
};

/// u of one wall of a space at its four borders; `tip`: + or - infinity.
struct WallBorders {
  double tip = 0, flank = 0;    ///< of the flank, where it ends
  double fillet = 0, root = 0;  ///< of the fillet, from the flank to the root
};
/// Of every piece, with the root as the share of its width.
[[nodiscard]] inline Borders borders_of(Piece piece, const WallBorders& plus, const WallBorders& minus) {
  switch (piece) {
    case Piece::flank_plus: return {plus.tip, plus.flank};
    case Piece::fillet_plus: return {plus.fillet, plus.root};
    case Piece::root: return {0, 1};
    case Piece::fillet_minus: return {minus.root, minus.fillet};
    case Piece::flank_minus: return {minus.flank, minus.tip};
    default: return {};
  }
}

/// An end of the teeth in the chart, a straight line: s grows by `lean` for each mm of h.
struct EndLine {
  double s = 0, h = 0;  ///< a place of it
  double lean = 0;
  [[nodiscard]] double at(double height) const { return s + lean * (height - h); }
};

/// One ring of teeth, by numbers.
struct Outline {
  Chart chart;
  double pitch = 0;             ///< rad
  double s_from = 0, s_to = 0;  ///< ends of the ring
  /// Where they are not square to the teeth: the ends that are drawn and measured, between s_from and s_to. Plans and
  /// proofs take longer teeth, which end at s_from and s_to at every height: the gear lies within them.
  std::optional<std::array<EndLine, 2>> leaning = {};
  const char *from = "inner", *to = "outer";  ///< and their names
  const char* along = "radius";               ///< what s is called in messages,
  double sign = 1;                            ///< and its sign there: s = -z is told as z
  std::optional<Vec3> pitch_normal = {};      ///< of the pitch surface, out of the body, at azimuth 0; none: up
  double join = 1e-9;  ///< a foot this far beyond the border of its piece (in u) still counts: how well pieces join

  /// Two values of s as messages tell them, in rising order.
  [[nodiscard]] std::pair<double, double> told(double a, double b) const {
    return {std::min(sign * a, sign * b), std::max(sign * a, sign * b)};
  }
  /// The end at s_from, or that at s_to.
  [[nodiscard]] EndLine end(bool last) const {
    return leaning ? (*leaning)[last ? 1 : 0] : EndLine{last ? s_to : s_from, 0, 0};
  }
  /// A station runs from s_from at one end to s_to at the other, evenly along s at each height: s itself where the ends
  /// are square. Of a place in the chart, and its change while that moves by (ds, dh).
  [[nodiscard]] double station(double s, double h) const {
    if (!leaning) return s;
    const double a = end(false).at(h), b = end(true).at(h);
    return s_from + (s - a) / (b - a) * (s_to - s_from);
  }
  [[nodiscard]] double station(const Vec3& p) const { return station(chart.along(p), leaning ? chart.up(p) : 0); }
  [[nodiscard]] double station(const Vec3& p, const Vec3& d) const {
    const double ds = chart.along(p, d);
    if (!leaning) return ds;
    const EndLine first = end(false), last = end(true);
    const double s = chart.along(p), h = chart.up(p), dh = chart.up(p, d), a = first.at(h), length = last.at(h) - a,
                 share = (s - a) / length;
    return (ds - first.lean * dh - share * (last.lean - first.lean) * dh) / length * (s_to - s_from);
  }
  /// s of a station at a height.
  [[nodiscard]] double s_at(double station, double h) const {
    if (!leaning) return station;
    const double a = end(false).at(h), b = end(true).at(h);
    return a + (station - s_from) / (s_to - s_from) * (b - a);
  }
};

/// Of teeth on a pitch cone, its apex below: s is minus the cone distance.
[[nodiscard]] inline Outline outline_on_cone(double sine, double cosine, int teeth, double small_end,
                                             double large_end) {
  Outline out;
  out.chart = {-sine, cosine};
  out.pitch = kTwoPi / teeth;
  out.s_from = -large_end;
  out.s_to = -small_end;
  out.from = "large";
  out.to = "small";
  out.along = "cone distance";
  out.sign = -1;
  return out;
}

/// A solved place next to the one that is asked for.
struct Near {
  double v = 0, s = 0;
};

/// One ring, space 0. Made once, then asked from several threads.
class ToothSpace {
 public:
  virtual ~ToothSpace() = default;

  [[nodiscard]] virtual const Outline& outline() const = 0;
  /// h of the tip surface, and its first and second derivatives over a stretch, enclosed.
  [[nodiscard]] virtual double tip(double s) const = 0;
  [[nodiscard]] virtual CurveBend tip_bend(double s_from, double s_to) const = 0;
  [[nodiscard]] virtual Borders borders(Piece piece) const = 0;
  /// The part of a flank that a mate touches: from the tip to where that ends.
  [[nodiscard]] virtual Borders active(Piece flank) const = 0;

  /// Place and normal, exact, with exact first derivatives of both; nothing where the piece has no place.
  [[nodiscard]] virtual std::optional<PatchPoint> at(Piece piece, double u, double v) const = 0;
  /// Place and normal alone; the derivatives may be unset.
  [[nodiscard]] virtual std::optional<PatchPoint> point(Piece piece, double u, double v) const {
    return at(piece, u, v);
  }
  /// The local nearest place, from (u, v); nothing where it is not found. It may lie beyond the borders of the piece.
  [[nodiscard]] virtual std::optional<PatchFoot> foot(Piece piece, const Vec3& c, double u, double v) const = 0;
  /// The same from a foot nearby, derivatives of place and normal may be unset; and nothing where the ball about c does
  /// not fit the hollow of the piece there.
  [[nodiscard]] virtual std::optional<PatchFoot> next_foot(Piece piece, const Vec3& c, const PatchFoot& near) const;
  /// Where the flank of `side` of tooth 0 meets the tip surface at s; `near`: a place of the same edge.
  [[nodiscard]] virtual std::optional<EdgePlace> tip_edge(int side, double s,
                                                          const std::optional<EdgePlace>& near = {}) const = 0;
  /// The same of the flank without what modifications and corrections take off: from there sheets are woven.
  [[nodiscard]] virtual std::optional<EdgePlace> plain_tip_edge(int side, double s,
                                                                const std::optional<EdgePlace>& near = {}) const {
    return tip_edge(side, s, near);
  }

  /// Where Newton begins for the place at (u, s) of the parallel surface at `distance`: the first start that arrives
  /// counts. Nothing: this attempt has no start.
  static constexpr int kStarts = 3;
  [[nodiscard]] virtual std::optional<double> start_v(Piece piece, double u, double s, double distance,
                                                      const std::optional<Near>& near, int attempt) const = 0;
  /// The most by which v goes in one step of that Newton.
  [[nodiscard]] virtual double longest_step(Piece piece, double s) const = 0;

  /// Place, first and second derivatives over the box |a| <= half_a, |b| <= half_b of a frame; nothing where no
  /// enclosure is known: then proofs sample, and count that as unproven.
  [[nodiscard]] virtual std::optional<Jet> enclosure(Piece piece, const PatchFrame& frame, double half_a,
                                                     double half_b) const = 0;
  /// First and second derivatives by s of the azimuth of the tip edge of `side` between two of its places, enclosed:
  /// the edge cannot leave a box about them in which its slope is bounded. Nothing where no such box is found.
  [[nodiscard]] virtual std::optional<CurveBend> tip_azimuth(int side, const EdgePlace& from, double s_from,
                                                             const EdgePlace& to, double s_to) const;
  /// s of the tip surface at a station, and the largest h of the tip surface over the ring: no lower than any place.
  [[nodiscard]] double tip_s(double station) const;
  [[nodiscard]] double highest_tip() const;

 protected:
  ToothSpace() = default;
  ToothSpace(const ToothSpace&) = default;
  ToothSpace& operator=(const ToothSpace&) = default;
};

}  // namespace toothpath::tooth_space
