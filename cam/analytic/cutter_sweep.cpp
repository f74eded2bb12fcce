#include "cam/analytic/cutter_sweep.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "cam/path/motion_blend.h"

namespace toothpath::analytic {
namespace {

constexpr double kCutterLook = 0.12;  // mm beyond the ball within which distances are wanted exactly, at least
constexpr double kLookShare = 0.2;    // and this share of its radius
constexpr double kSearchPad = 1e-4;   // mm: sag of edges, by which two distances may disagree
constexpr double kWreckShare =
    0.5;  // a ball whose centre is this near, in radii, is bounded by all that can be asked for
constexpr int kCutterHalvings = 24;
constexpr std::size_t kQueriesOfWreck = 1000;  // of a motion that is too deep: each of these costs the bound a quarter
constexpr int kLooksAbove = 3;                 // rows at which the whole flute above is looked at before each row is
constexpr double kShortestPiece = 1e-6;        // mm: shorter pieces are not halved

/// Heights of the flute in ball radii: close above the centre first, where the flute leaves the contact slowly.
std::vector<double> heights(double R, double top) {
  std::vector<double> out;
  double h = 0.3 * R, step = 0.4 * R;
  for (; h < top; h += step, step = std::min(step * 1.4, 1.2 * R)) out.push_back(h);
  if (top > 0) out.push_back(top);
  return out;
}

}  // namespace

double least_between(double d0, double d1, double length) {
  const double steep = 0.5 * (d0 + d1 - length);  // slope of 1 from both ends
  if (d0 <= 0 || d1 <= 0 || length <= 0) return std::min({d0, d1, std::max(steep, std::min(d0, d1) - length)});
  const double g0 = d0 * d0, g1 = d1 * d1;
  const double s = std::clamp(0.5 * (length - (g1 - g0) / length), 0.0, length);
  const double g = g0 + (g1 - g0) * s / length - s * (length - s);
  return std::min({d0, d1, std::max(g > 0 ? std::sqrt(g) : -INFINITY, steep)});
}

CutterSweep::CutterSweep(const GearDistance& part, const tool::ToolAssembly& tool, double proof_mm, double tolerance_mm)
    : part_(part),
      roof_(part.part()),
      R_(tool.radius_mm()),
      top_(tool.flute_length_mm - R_),
      proof_(proof_mm),
      tolerance_(tolerance_mm),
      within_(R_ + std::max(kCutterLook, kLookShare * R_)),
      known_(256) {
  for (const double h : heights(R_, top_)) rows_.push_back({h, false, Vec3::Zero(), 0});
}

Vec3 CutterSweep::place(double t, double height) const {
  return path::tip_at(*m_, t) + (R_ + height) * path::axis_at(*m_, t);
}

NearestPlace CutterSweep::query(const Vec3& p, double most) {
  ++queries_;
  if (most + kSearchPad < within_) return part_.nearest(p, most + kSearchPad);
  std::size_t key = 0;
  for (const double x : {p.x(), p.y(), p.z()}) key = (key ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
  Known& known = known_[key >> 56];
  if (known.at != p) known = {p, part_.nearest(p, within_)};
  return known.nearest;
}

void CutterSweep::note(const NearestPlace& q, tool::Body body) {
  const double depth = R_ - q.distance;
  if (depth <= found_.measured_mm) return;
  found_.measured_mm = depth;
  found_.deepest = q;
  found_.body = body;
  worst_ = std::max(worst_, std::min(depth, tolerance_ - proof_));
}

/// Is a proven least distance good enough? Where it is free; where it is no deeper than what was found before; where it
/// is close to what is seen here. A wreck need not be followed to a fraction of a micrometre. @param arm from the tip:
/// what the deviation of the axis does there is not made smaller by halving.
bool CutterSweep::settled(double least, double seen, double slack, double arm) const {
  const double deepest = R_ - least + slack;
  // Beyond the tolerance its own place is wanted: of a motion that deviates far, too, and passes by.
  const double here = deepest <= tolerance_ ? std::max(seen, worst_) : seen;
  const double leeway = here > 50 * tolerance_ ? 0.25 * here : 0;
  // The tool may slide along the part: the verdict stands, and how deep it is need not be known at any price.
  const std::size_t spent = (queries_ - queries_before_) / kQueriesOfWreck;
  if (spent > 0 && found_.measured_mm > tolerance_ && deepest <= (1 + 0.25 * double(spent)) * found_.measured_mm)
    return true;
  return deepest <= 0 || deepest <= here + proof_ + leeway + m_->deviation_mm + arm * m_->axis_deviation;
}

void CutterSweep::expect(double depth_mm) { worst_ = std::max(worst_, std::min(depth_mm, tolerance_ - proof_)); }

CutterFinding CutterSweep::check(const path::ToolMotion& motion, const KnownDepths& known) {
  m_ = &motion;
  found_ = {};
  queries_before_ = queries_;
  if (by_itself_) worst_ = 0;
  double least = 0;
  if (known.good(0)) {
    found_.bound_mm = known.of_part[0];
    least = R_ - found_.bound_mm;
  } else if (centre(least)) {
    part_bounds_.fill(found_.bound_mm);
    return found_;
  }
  const double ball = std::exchange(found_.bound_mm, -INFINITY);
  flute_leaves_ = INFINITY;
  if (known.good(1)) found_.bound_mm = known.of_part[1];
  else flute(least, ball);
  // A wreck is bounded already; there and above the part nothing was asked of the flute.
  part_bounds_ = {ball, least <= -within_ ? ball : std::max(found_.bound_mm, -flute_leaves_)};
  found_.bound_mm = std::max({ball, found_.bound_mm, found_.measured_mm});  // of a wreck less may have been asked
  return found_;
}

/// Follows the ball centre: its least distance. Is the whole cutting part above the part, so that nothing is left to
/// ask?
bool CutterSweep::centre(double& least) {
  const Vec3 a = place(0, 0), b = place(1, 0);
  const double length = (b - a).norm();
  const NearestPlace qa = chained_ && a == last_centre_ ? last_ : query(a, within_);
  const NearestPlace qb = b == a ? qa : query(b, qa.distance + length);
  note(qa, tool::Body::ball);
  note(qb, tool::Body::ball);
  const double height = height_above();
  if (height > 0) found_.bound_mm = std::max(-height, found_.measured_mm);
  else least = ball(0, 1, qa, qb, kCutterHalvings);
  chained_ = true;
  last_centre_ = b;
  last_ = qb;
  return height > 0;
}

/// How far the whole cutting part stays above the part.
double CutterSweep::height_above() const {
  const std::array<Vec3, 4> ends{place(0, 0), place(0, top_), place(1, 0), place(1, top_)};
  return roof_.over(ends) - R_ - path::line_slack(*m_, R_ + std::max(top_, 0.0), 1);
}

/// How far the flute stays above the part from a height on; 0 or less where that is not known.
double CutterSweep::height_from(double height, double next) const {
  if (!roof_.flat()) {
    const std::array<Vec3, 4> ends{place(0, height), place(0, top_), place(1, height), place(1, top_)};
    return roof_.over(ends) - R_ - path::line_slack(*m_, R_ + top_, 1);
  }
  if (m_->axis_from.z() < 0 || m_->axis_to.z() < 0) return 0;
  return std::min(place(0, height).z(), place(1, height).z()) - R_ - path::line_slack(*m_, R_ + next, 1) - roof_.top();
}

/// Follows the ball centre; returns its least distance, proven.
double CutterSweep::ball(double t0, double t1, const NearestPlace& q0, const NearestPlace& q1, int depth) {
  const Vec3 a = place(t0, 0), b = place(t1, 0);
  const double L = (b - a).norm(), slack = path::line_slack(*m_, R_, t1 - t0);
  const double low = std::min(q0.distance, q1.distance);
  if (low < kWreckShare * R_) {
    found_.bound_mm = R_ + within_;
    return -within_;
  }
  const double least = least_between(q0.distance, q1.distance, L);
  if (settled(least, R_ - low, slack, R_) || depth == 0 || L + slack < kShortestPiece) {
    found_.bound_mm = std::max(found_.bound_mm, R_ - least + slack);
    return least - slack;
  }
  const double t = 0.5 * (t0 + t1);
  const Vec3 c = place(t, 0);
  const auto q = query(c, std::min(q0.distance + (c - a).norm(), q1.distance + (c - b).norm()));
  note(q, tool::Body::ball);
  const double first = ball(t0, t, q0, q, depth - 1);
  return std::min(first, ball(t, t1, q, q1, depth - 1));
}

/// Lower bound of the distance at a height over the whole motion, from where it was asked last.
double CutterSweep::remembered(const Row& row) const {
  if (!row.known) return -INFINITY;
  const double away = std::max((place(0, row.height) - row.at).norm(), (place(1, row.height) - row.at).norm());
  return row.distance - away - path::line_slack(*m_, R_ + row.height, 1);
}

/// A lower bound of the distance to the surface at a height over the whole motion, by facets: enough where the flute
/// has left it.
double CutterSweep::fresh(Row& row) {
  const Vec3 a = place(0, row.height), b = place(1, row.height);
  const double L = (b - a).norm();
  const double keeps = part_.surface_keeps(b, within_);
  double d0 = row.known ? row.distance - (a - row.at).norm() : -INFINITY;
  if (!(row.known && a == row.at) && least_between(d0, keeps, L) < R_ + 0.5 * (within_ - R_))
    d0 = part_.surface_keeps(a, within_);
  row = {row.height, true, b, keeps};
  return least_between(d0, keeps, L) - path::line_slack(*m_, R_ + row.height, 1);
}

/// The same of all heights from this one on.
double CutterSweep::remembered_above(const Row& row) const {
  if (!row.above_known) return -INFINITY;
  double away = 0;
  for (const double t : {0.0, 1.0})
    away = std::max({away, (place(t, row.height) - row.low).norm(), (place(t, top_) - row.high).norm()});
  return row.keeps - away - path::line_slack(*m_, R_ + top_, 1);
}

double CutterSweep::fresh_above(Row& row) {
  const double length = top_ - row.height;
  const Vec3 a = place(0, row.height), b = place(1, row.height), A = place(0, top_), B = place(1, top_);
  const double L = std::max((b - a).norm(), (B - A).norm());  // no height between goes farther
  double keeps0 = row.above_known ? row.keeps - std::max((a - row.low).norm(), (A - row.high).norm()) : -INFINITY;
  const double keeps = part_.surface_keeps(b, m_->axis_to, length, within_);
  if (L == 0) keeps0 = keeps;
  else if (least_between(keeps0, keeps, L) < R_ + 0.5 * (within_ - R_))
    keeps0 = part_.surface_keeps(a, m_->axis_from, length, within_);
  row.above_known = true;
  row.low = b;
  row.high = B;
  row.keeps = keeps;
  return least_between(keeps0, keeps, L) - path::line_slack(*m_, R_ + top_, 1);
}

/// Is all of the flute from a height on, where the axis keeps `low`, no deeper than `free_mm` by one look along the
/// axis? Between that height and the row the parabola holds.
bool CutterSweep::clear_above(Row& row, double height, double low, double free_mm) {
  const double H = row.height - height;
  double keeps = remembered_above(row);
  if (R_ - least_between(low, keeps, H) > free_mm) keeps = std::max(keeps, fresh_above(row));
  const double least = least_between(low, keeps, H);
  if (R_ - least > free_mm) return false;
  found_.bound_mm = std::max(found_.bound_mm, R_ - least);
  return true;
}

/// The flute, height by height. At every moment the axis is a straight line: between two heights whose least distances
/// are proven, the same parabola bounds what lies between them. Where that keeps the axis off the surface, from a
/// centre outside of it, no height lies inside.
void CutterSweep::flute(double low, double ball_bound) {
  if (low <= -within_) return;  // a wreck, bounded already
  double h = 0;
  int looks = kLooksAbove;
  for (Row& row : rows_) {
    if (const double above = height_from(h, row.height); above > 0) {
      flute_leaves_ = above;
      return;  // above the part from here on
    }
    if (looks-- > 0 && clear_above(row, h, low, std::max(ball_bound, 0.0))) return;
    const double H = row.height - h;
    double high = remembered(row);
    // Nothing of this row was looked at: beyond the tolerance its own places are.
    const auto good = [&] { return settled(least_between(low, high, H), -INFINITY, 0, R_); };
    if (!good()) high = std::max(high, fresh(row));
    const double least = least_between(low, high, H);
    if (good()) found_.bound_mm = std::max(found_.bound_mm, R_ - least);
    else patch(0, 1, h, row.height, at(0, h), at(1, h), at(0, row.height), at(1, row.height), kCutterHalvings);
    low = high;
    h = row.height;
  }
}

double CutterSweep::at(double t, double height) {
  const auto q = query(place(t, height), within_);
  note(q, height > 0 ? tool::Body::flute : tool::Body::ball);
  return q.distance;
}

/// The axis from t0 to t1 and between two heights, from the distances d_th at its four corners.
void CutterSweep::patch(double t0, double t1, double h0, double h1, double d00, double d10, double d01, double d11,
                        int depth) {
  const double L0 = (place(t1, h0) - place(t0, h0)).norm(), L1 = (place(t1, h1) - place(t0, h1)).norm(), H = h1 - h0;
  const double slack = path::line_slack(*m_, R_ + h1, t1 - t0);
  const double low = least_between(d00, d10, L0), high = least_between(d01, d11, L1);
  const double least = least_between(low, high, H), corner = std::min({d00, d10, d01, d11});
  if (settled(least, R_ - corner, slack, R_ + h0) || depth == 0 || std::max({L0, L1, H}) + slack < kShortestPiece) {
    found_.bound_mm = std::max(found_.bound_mm, R_ - least + slack);
    return;
  }
  // Halve what costs more: the way between the heights, or the way along the motion. The deviation of the axis differs
  // by height alone.
  const double lean = m_->axis_deviation, along = slack - m_->deviation_mm - (R_ + h1) * lean;
  if (std::min(low, high) - least + H * lean > corner - std::min(low, high) + along) {
    const double h = 0.5 * (h0 + h1), a = at(t0, h), b = at(t1, h);
    patch(t0, t1, h0, h, d00, d10, a, b, depth - 1);
    patch(t0, t1, h, h1, a, b, d01, d11, depth - 1);
  } else {
    const double t = 0.5 * (t0 + t1), a = at(t, h0), b = at(t, h1);
    patch(t0, t, h0, h1, d00, a, d01, b, depth - 1);
    patch(t, t1, h0, h1, a, d10, b, d11, depth - 1);
  }
}

}  // namespace toothpath::analytic
