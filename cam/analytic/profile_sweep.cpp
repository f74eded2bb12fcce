#include "cam/analytic/profile_sweep.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/path/motion_blend.h"

namespace toothpath::analytic {
namespace {

constexpr double kFreeAhead =
    0.4;                         // mm: so much farther a body in the open is looked at, so that later motions need not
constexpr double kClose = 0.01;  // mm: smaller gaps are followed to proof_mm,
constexpr double kUnknownDepth = 1;    // mm: told where the surfaces of the part cannot be followed
constexpr double kApartProof = 0.004;  // mm: larger ones to this

}  // namespace

ProfileSweep::ProfileSweep(const GearDistance& part, const tool::ProofTool& tool, double proof_mm, double tolerance_mm)
    : part_(part), ball_top_(tool.ball_top_mm), proof_(proof_mm), tolerance_(tolerance_mm) {
  for (const auto& shape : tool.cutting)
    bodies_.push_back(
        {shape, std::hypot(shape.core.to + shape.round, shape.widest()), false, Vec3::Zero(), Vec3::UnitZ(), 0});
  part_bounds_.resize(bodies_.size());
}

void ProfileSweep::expect(double depth_mm) { worst_ = std::max(worst_, std::min(depth_mm, tolerance_ - proof_)); }

/// Gap that is left of the one that was proven where the body was looked at last.
double ProfileSweep::left_of(const Body& body, const path::ToolMotion& m) const {
  if (!body.known) return -INFINITY;
  const auto away = [&](const Vec3& tip, const Vec3& axis) {
    return (tip - body.tip).norm() + body.arm * (axis - body.axis).norm();
  };
  return body.gap - std::max(away(m.tip_from, m.axis_from), away(m.tip_to, m.axis_to)) -
         path::line_slack(m, body.arm, 1);
}

/// How far a body is looked at: farther where it was in the open.
double ProfileSweep::look_ahead(const Body& body) {
  return kProfileLook + (body.known && body.gap < kProfileLook ? 0 : kFreeAhead);
}

/// The cells near all bodies that must be looked at.
NearCells ProfileSweep::near_all(const path::ToolMotion& m, const KnownDepths& known) const {
  std::vector<tool::RoundedFrustum> shapes;
  double enough = 0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (known.good(k) || left_of(bodies_[k], m) >= kProfileLook) continue;
    shapes.push_back(bodies_[k].shape);
    enough = std::max(enough, look_ahead(bodies_[k]));
  }
  return {part_, shapes, m, enough};
}

/// The depth that is proven.
double ProfileSweep::look(Body& body, const path::ToolMotion& m, const NearCells& near) {
  SweptGapOptions o;
  o.touching = true;
  o.enough_mm = look_ahead(body);
  o.contact_mm = kClose;
  o.contact_proof_mm = proof_;
  o.proof_mm = kApartProof;
  o.settled_mm = -worst_ - 0.5 * proof_;
  const auto gap = swept_gap(part_, body.shape, m, o, near);
  queries_ += gap.pieces;
  body.known = true;
  body.tip = m.tip_to;
  body.axis = m.axis_to;
  body.gap = gap.proven_mm;
  const double bound = -std::min(gap.proven_mm, kProfileLook);
  const double depth = -std::min(gap.measured_mm, kProfileLook);
  if (depth <= found_.measured_mm) return bound;
  found_.measured_mm = depth;
  found_.deepest.distance = gap.measured_mm;
  found_.deepest.zone = gap.zone;
  found_.deepest.patch = gap.patch;
  found_.deepest.foot = found_.deepest.point = gap.place;
  found_.body = ball_top_ > 0 && gap.height_mm < ball_top_ ? tool::Body::ball : tool::Body::flute;
  worst_ = std::max(worst_, std::min(depth, tolerance_ - proof_));
  return bound;
}

CutterFinding ProfileSweep::check(const path::ToolMotion& m, const KnownDepths& known) {
  found_ = {};
  found_.body = ball_top_ > 0 ? tool::Body::ball : tool::Body::flute;
  if (by_itself_) worst_ = 0;
  if (part_.refusal()) {  // nothing is known of where the part is
    found_.measured_mm = found_.bound_mm = kUnknownDepth;
    found_.deepest.patch = "inside";
    std::fill(part_bounds_.begin(), part_bounds_.end(), kUnknownDepth);
    return found_;
  }
  std::optional<NearCells> near;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Body& body = bodies_[k];
    if (known.good(k)) {
      part_bounds_[k] = known.of_part[k];
    } else if (left_of(body, m) < kProfileLook) {
      if (!near) near = near_all(m, known);
      part_bounds_[k] = look(body, m, *near);
    } else {
      part_bounds_[k] = -kProfileLook;
      found_.measured_mm = std::max(found_.measured_mm, -kProfileLook);
    }
    found_.bound_mm = std::max(found_.bound_mm, part_bounds_[k]);
  }
  return found_;
}

}  // namespace toothpath::analytic
