#include "cam/finger/milling.h"

#include <algorithm>
#include <cmath>

#include "cam/finger/finger_profile.h"
#include "cam/finger/passes.h"
#include "cam/finger/reference.h"
#include "cam/tool/cutters.h"

namespace toothpath::finger {
namespace {

constexpr double kLift = 3.0;  // mm, of the tip above the face cone between passes
// mm: a block with straight joints (R_c, e) stays this close to the straight tip. Posts move the joints; below their
// own tolerance of 0.5 um they insert nothing, and only two axes move.
constexpr double kJointSag = 4e-4;
constexpr int kPlaces = 8;         // a block is compared with its piece at the ends of so many parts
constexpr int kMostAttempts = 40;  // each with a twelfth more points
constexpr int kFine = 96;          // intervals on which the chord error of a piece is measured

using Centre = bevel_gear::CutterCentre<double>;

class FingerPlanner {
 public:
  FingerPlanner(const bevel_gear::BevelGear& gear, const path::MillingOperation& op, int index,
                const proof::ProofLimits& tol)
      : gear_(gear), op_(op), sd_(gear.sin_delta()), cd_(gear.cos_delta()) {
    // The other half is for what posts and proof add. The proof counts a shift of the centre with its leverage.
    chord_ = std::min(op.chord_tolerance_mm, 0.5 * tol.gouge_mm / centre_leverage(gear));
    plan_.path.operation = index;
    plan_.path.operation_type = to_string(op.type);
    plan_.path.tool = op.tool;
    plan_.path.spindle_rpm = op.speed_rpm;
  }

  Result<FingerPlan> plan() {
    if (op_.type == path::OperationType::finger_roughing)
      passes_ = roughing_passes(gear_, op_.ridge_mm, plan_.ridge_predicted_mm);
    else if (op_.type == path::OperationType::finger_finishing) passes_ = wall_passes(gear_, op_.climb);
    else return fail("a {} operation is not milled by a finger mill", to_string(op_.type));
    cut_into_blocks();
    write();
    return std::move(plan_);
  }

 private:
  /// A centre on a pass, and the half that it counts for.
  struct PassPoint {
    Centre centre;
    int half = 0;
  };

  /// How far a block a..b leaves the exact piece at a point c of it in the same share s, as a multiple of what is
  /// allowed: across the path and down, for a straight tip and for straight joints (R_c, e), and both against each
  /// other.
  double block_error(const Centre& a, const Centre& b, const Centre& c, double s) const {
    const double R_s = a.R_c + s * (b.R_c - a.R_c), e_s = a.e + s * (b.e - a.e);
    const double dR = R_s - c.R_c, dT = a.theta_c + s * (b.theta_c - a.theta_c) - c.theta_c;
    const double joints = std::abs(c.R_c * dT * std::cos(c.beta_c) - dR * std::sin(c.beta_c));
    const Vec3 tip = gear_.tip(a.R_c, a.e) + s * (gear_.tip(b.R_c, b.e) - gear_.tip(a.R_c, a.e));
    const Vec3 q = bevel_gear::cutter_from_blank<double>(tip, c.R_c, c.e, sd_, cd_);
    const double across = q.y() * std::cos(c.beta_c) - q.z() * std::sin(c.beta_c);
    const double chord = std::max(joints, std::hypot(across, q.x() + gear_.parameters().dedendum_mm));
    return std::max(chord / chord_, (tip - gear_.tip(R_s, e_s)).norm() / kJointSag);
  }

  /// What a block a..b may leave its piece by, whose parameters there are t_a and t_b: the distance from the nearest
  /// pose of the piece at seven places of the block, for a straight tip and for straight joints, and what may lie
  /// between two of them. There the distance bends by no more than the path (the turn of its heading, doubled) and the
  /// cone under a straight line.
  double block_bound(const std::function<Centre(double)>& piece, const Centre& a, const Centre& b, double t_a,
                     double t_b) const {
    const double length = crown_distance(a, b), per_length = (t_b - t_a) / length;
    const Vec3 tip_a = gear_.tip(a.R_c, a.e), tip_b = gear_.tip(b.R_c, b.e);
    /// Crown-plane and normal distance (along the generatrix, azimuthal, down) of something from a pose -> distance
    /// from the path.
    const auto nearest = [&](double s, const auto& seen_from) {
      double t = t_a + s * (t_b - t_a);
      Centre c = piece(t);
      Vec3 d = seen_from(c);
      for (int k = 0; k < 3; ++k) {
        t = std::clamp(t + (d.x() * std::cos(c.beta_c) + d.y() * std::sin(c.beta_c)) * per_length, 0.0, 1.0);
        c = piece(t);
        d = seen_from(c);
      }
      return std::hypot(d.y() * std::cos(c.beta_c) - d.x() * std::sin(c.beta_c), d.z());
    };
    double worst = 0, bend = 0, heading = a.beta_c + a.theta_c;
    for (int k = 1; k <= kPlaces; ++k) {
      const double s = static_cast<double>(k) / kPlaces;
      const Centre c = piece(t_a + s * (t_b - t_a));
      bend = std::max(bend, std::abs(c.beta_c + c.theta_c - heading) * kPlaces / length);
      heading = c.beta_c + c.theta_c;
      if (k == kPlaces) break;
      const Vec3 tip = tip_a + s * (tip_b - tip_a);
      worst = std::max(worst, nearest(s, [&](const Centre& from) {
                         const Vec3 q = bevel_gear::cutter_from_blank<double>(tip, from.R_c, from.e, sd_, cd_);
                         return Vec3(q.z(), q.y(), q.x() + gear_.parameters().dedendum_mm);
                       }));
      const double R = a.R_c + s * (b.R_c - a.R_c), theta = a.theta_c + s * (b.theta_c - a.theta_c);
      worst =
          std::max(worst, nearest(s, [&](const Centre& from) {
                     return Vec3(R * std::cos(theta - from.theta_c) - from.R_c, R * std::sin(theta - from.theta_c), 0);
                   }));
    }
    const double cone = 1 / (gear_.R_i() * sd_ - gear_.parameters().dedendum_mm * cd_);
    return worst + (2 * bend + cone) * length * length / (8 * kPlaces * kPlaces);
  }

  /// Points of a piece with equal block errors: the error of a block grows with the square of its share.
  std::vector<Centre> sample(const std::function<Centre(double)>& piece) {
    std::vector<double> sum(kFine + 1, 0.0);
    for (int i = 0; i < kFine; ++i) {
      const double a = static_cast<double>(i) / kFine, b = static_cast<double>(i + 1) / kFine;
      sum[static_cast<std::size_t>(i) + 1] =
          sum[static_cast<std::size_t>(i)] +
          std::sqrt(block_error(piece(a), piece(b), piece(0.5 * (a + b)), 0.5) / 0.9);
    }
    const double length = crown_distance(piece(0), piece(1));
    int n = std::max({1, static_cast<int>(std::ceil(sum.back())), static_cast<int>(std::ceil(length / 10))});
    for (int attempt = 0;; ++attempt) {
      std::vector<double> at{0.0};
      std::size_t k = 0;
      for (int i = 1; i < n; ++i) {
        const double want = sum.back() * i / n;
        while (k + 1 < kFine && sum[k + 1] < want) ++k;
        const double width = sum[k + 1] - sum[k];
        at.push_back((static_cast<double>(k) + (width > 0 ? (want - sum[k]) / width : 0.0)) / kFine);
      }
      at.push_back(1.0);
      std::vector<Centre> points;
      for (const double t : at) points.push_back(piece(t));
      double worst = 0, bound = 0;
      for (std::size_t i = 1; i < points.size(); ++i)
        for (const double s : {0.25, 0.5, 0.75})
          worst = std::max(worst, block_error(points[i - 1], points[i], piece(at[i - 1] + s * (at[i] - at[i - 1])), s));
      for (std::size_t i = 1; i < points.size() && (worst <= 1 || attempt >= kMostAttempts); ++i)
        bound = std::max(bound, block_bound(piece, points[i - 1], points[i], at[i - 1], at[i]));
      if ((worst <= 1 && bound <= chord_) || attempt >= kMostAttempts) {
        plan_.chord_mm = std::max(plan_.chord_mm, bound);
        return points;
      }
      n += 1 + n / 12;
    }
  }

  void cut_into_blocks() {
    for (const CentrePass& pass : passes_) {
      std::vector<PassPoint> points;
      for (const CentrePiece& piece : pass.pieces) {
        const auto part = sample(piece.at);
        for (std::size_t i = points.empty() ? 0 : 1; i < part.size(); ++i) points.push_back({part[i], piece.half});
      }
      if (!pass.outward) {
        // A point counts for the half of the block that ends there.
        for (std::size_t i = 0; i + 1 < points.size(); ++i) points[i].half = points[i + 1].half;
        std::reverse(points.begin(), points.end());
      }
      blocks_.push_back(std::move(points));
    }
  }

  /// Lift between passes. There a straight tip cuts the corner over the cone: its sag comes on top.
  double lift() const {
    const double above = gear_.parameters().dedendum_mm + gear_.parameters().addendum_mm + kLift;
    double sag = 0;
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
      const Centre &a = blocks_[i - 1].back().centre, &b = blocks_[i].front().centre;
      sag = std::max(sag, (std::max(a.R_c, b.R_c) * sd_ + above * cd_) * (1 - std::cos(0.5 * (b.e - a.e))) * cd_);
    }
    return above + sag;
  }

  void write() {
    const double up = lift();
    std::vector<int> count(gear_.halves().size(), 0);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const auto& points = blocks_[i];
      int zone = points.front().half;
      const auto begin = [&](int half) {
        zone = half;
        plan_.passes.push_back(
            {half, count[static_cast<std::size_t>(half)]++, passes_[i].name, passes_[i].outward, 0, 1});
      };
      begin(zone);
      const auto add = [&](const Centre& c, double height, double feed, path::MoveKind kind) {
        plan_.path.records.push_back(
            {gear_.tip(c.R_c, c.e, height), gear_.axis(c.e), feed, kind, zone, plan_.passes.back().pass});
      };
      add(points.front().centre, up, 0, path::MoveKind::rapid);
      add(points.front().centre, 0, op_.feed_mm_min, path::MoveKind::engage);
      for (std::size_t k = 1; k < points.size(); ++k) {
        const Centre &from = points[k - 1].centre, &to = points[k].centre;
        if (points[k].half != zone) begin(points[k].half);
        const double step = crown_distance(from, to),
                     tip = (gear_.tip(to.R_c, to.e) - gear_.tip(from.R_c, from.e)).norm();
        plan_.passes.back().length_mm += step;
        ++plan_.passes.back().points;
        add(to, 0, op_.feed_mm_min * tip / step, path::MoveKind::feed);
      }
      add(points.back().centre, up, op_.feed_mm_min, path::MoveKind::retract);
    }
  }

  const bevel_gear::BevelGear& gear_;
  const path::MillingOperation& op_;
  double sd_, cd_, chord_ = 0;
  std::vector<CentrePass> passes_;
  std::vector<std::vector<PassPoint>> blocks_;
  FingerPlan plan_;
};

}  // namespace

bevel_gear::FingerCutterData finger_cutter_data(const tool::ToolAssembly& tool) {
  return {tool.module_mm, tool.tip_radius_mm, tool.rack_depth_mm, tool.profile_height_mm};
}

Result<bevel_gear::BevelGear> gear_for_finger_mill(const bevel_gear::BevelGear& gear, const tool::ToolAssembly& tool) {
  auto made = bevel_gear::BevelGear::make(gear.parameters(), finger_cutter_data(tool));
  if (const auto* bad = made.refused()) return bad->front().diagnostic;
  const double flutes = finger_flute_end(made.value().cutter(), tool);
  const double least = gear.parameters().dedendum_mm + gear.parameters().addendum_mm;
  if (flutes < least && tool.shank_diameter_mm > 2 * made.value().cutter().rho_D)
    return fail("flute_length = {:.4f} is below the tooth depth {:.4f}: the shank would cut the tip of the teeth",
                flutes, least);
  return std::move(made).value();
}

Result<FingerPlan> plan_finger_operation(const bevel_gear::BevelGear& gear, const tool::ToolAssembly& tool,
                                         const path::MillingOperation& operation, int operation_index,
                                         const proof::ProofLimits& limits) {
  if (!tool::serves(tool, tool::CutterUse::tooth_form)) return fail("tool {} is not a finger mill", tool.number);
  auto own = gear_for_finger_mill(gear, tool);
  if (!own) return own.error();
  if (operation.type == path::OperationType::finger_roughing && !(operation.ridge_mm > 0))
    return fail("ridge = {:.4f} must be positive", operation.ridge_mm);
  return FingerPlanner(*own, operation, operation_index, limits).plan();
}

}  // namespace toothpath::finger
