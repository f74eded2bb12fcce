#include "cam/finger_milling.h"

#include <cmath>
#include <functional>

#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kRidgeShare = 0.85;     // of the allowed ridge that the planner uses
constexpr double kClearAir = 1.0;        // mm, between cutter and blank beyond the large end
constexpr double kLift = 3.0;            // mm, of the tip above the face cone between passes
constexpr int kFine = 96;                // intervals on which the chord error of a piece is measured

using Centre = CutterCentre<double>;

/// A smooth piece of a centre path over t = 0 .. 1.
using Piece = std::function<Centre(double)>;

double crown_distance(const Centre& a, const Centre& b) {
  const double d = b.theta_c - a.theta_c, s = std::sin(0.5 * d);
  return std::sqrt((b.R_c - a.R_c) * (b.R_c - a.R_c) + 4 * a.R_c * b.R_c * s * s);
}

struct RawPass {
  std::string name;
  int half = 0;
  bool outward = false;
  std::vector<Piece> pieces;  ///< in the direction of growing R_c
};

class Planner {
 public:
  Planner(const BevelGear& gear, const ToolAssembly& tool, const MillingOperation& op, int index, const Tolerances& tol)
      : gear_(gear), tool_(tool), op_(op), sd_(gear.sin_delta()), cd_(gear.cos_delta()) {
    chord_ = std::min(op.chord_tolerance_mm, 0.5 * tol.gouge_mm);
    plan_.path.operation = index;
    plan_.path.operation_type = to_string(op.type);
    plan_.path.tool = op.tool;
    plan_.path.spindle_rpm = op.speed_rpm;
  }

  Result<FingerPlan> plan() {
    if (op_.type == OperationType::finger_roughing)
      rough();
    else if (op_.type == OperationType::finger_finishing)
      finish();
    else
      return fail("a {} operation is not milled by a finger mill", to_string(op_.type));
    write();
    return std::move(plan_);
  }

 private:
  const BevelTrace<double>& trace(std::size_t half) const { return gear_.halves()[half].walls[0].trace; }

  /// Straight run-out at the large end until the cutter has left the blank.
  void run_out(std::size_t half, RawPass& pass) const {
    if (half + 1 != gear_.halves().size()) return;
    const Centre end = pass.pieces.back()(1.0);
    const double want = gear_.R_e() + gear_.cutter().rho_D + kClearAir;
    if (end.R_c >= want) return;
    double length = want - end.R_c;
    for (int k = 0; k < 60; ++k) {
      const Centre c = trace(half).run_straight(end, length);
      if (std::abs(c.R_c - want) < 1e-9) break;
      length += (want - c.R_c) / std::max(0.2, std::cos(c.beta_c));
    }
    const BevelTrace<double> t = trace(half);
    pass.pieces.push_back([t, end, length](double s) { return t.run_straight(end, s * length); });
  }

  RawPass wall(std::size_t i, int sigma) const {
    const BevelHalf& half = gear_.halves()[i];
    const int k = sigma > 0 ? 0 : 1;
    RawPass pass;
    pass.name = sigma > 0 ? "wall L" : "wall U";
    pass.half = static_cast<int>(i);
    // Material lies at lower azimuth of wall L: on the left of an outward feed, seen from the shank.
    pass.outward = (sigma < 0) == op_.climb;
    const auto t = half.walls[k].trace;
    const double from = half.beta_from[k], to = half.beta_to[k];
    const auto curve = [t, sigma](double a, double b) {
      return [t, sigma, a, b](double s) { return t.centre(sigma, a + (b - a) * s); };
    };
    // The path changes from curve to tangent at beta_end: a joint between pieces.
    if (-sigma * half.hand > 0 && to < t.beta_end && from > t.beta_end) {
      pass.pieces.push_back(curve(from, t.beta_end));
      pass.pieces.push_back(curve(t.beta_end, to));
    } else {
      pass.pieces.push_back(curve(from, to));
    }
    run_out(i, pass);
    return pass;
  }

  RawPass middle(std::size_t i) const {
    const BevelHalf& half = gear_.halves()[i];
    const auto t = trace(i);
    const double from = t.beta(half.R_from), to = t.beta(std::min(half.R_to, t.R_lim()));
    RawPass pass;
    pass.name = "middle";
    pass.half = static_cast<int>(i);
    pass.pieces.push_back([t, from, to](double s) { return t.middle(from + (to - from) * s); });
    run_out(i, pass);
    return pass;
  }

  /// Trace parameters that both walls' passes of a half have in common, and the middle too.
  std::pair<double, double> common(std::size_t i) const {
    const BevelHalf& half = gear_.halves()[i];
    const auto& t = trace(i);
    const double from = std::min({half.beta_from[0], half.beta_from[1], t.beta(half.R_from)});
    const double to = std::max({half.beta_to[0], half.beta_to[1], t.beta(std::min(half.R_to, t.R_lim())), t.beta_end});
    return {from, to};
  }

  /// Between the walls: polar blend of both wall paths at the same trace parameter, mu in (-1, 1), -1 = wall L.
  static Centre blend(const BevelTrace<double>& t, double beta, double mu) {
    const Centre L = t.centre(1, beta), U = t.centre(-1, beta);
    const double a = 0.5 * (1 - mu), b = 0.5 * (1 + mu);
    Centre c;
    c.R_c = a * L.R_c + b * U.R_c;
    c.theta_c = a * L.theta_c + b * U.theta_c;
    c.e = c.theta_c / t.sin_delta;
    const double f_L = t.speed_ratio(1, beta), f_U = t.speed_ratio(-1, beta);
    const double dR = a * f_L * std::cos(L.beta_c) + b * f_U * std::cos(U.beta_c);
    const double dT = a * f_L * std::sin(L.beta_c) / L.R_c + b * f_U * std::sin(U.beta_c) / U.R_c;
    c.beta_c = std::atan2(c.R_c * dT, dR);
    return c;
  }

  /// Gaps between the middle and one wall that the allowed ridge asks for, at trace parameter beta.
  int gaps(std::size_t i, double beta) const {
    const auto& t = trace(i);
    const Centre L = t.centre(1, beta), U = t.centre(-1, beta);
    const double allowed = finger_gap(gear_, t.R(beta), kRidgeShare * op_.ridge_mm);
    return std::max(1, static_cast<int>(std::ceil(0.5 * crown_distance(L, U) / allowed)));
  }

  void rough() {
    for (std::size_t n = gear_.halves().size(); n-- > 0;) {
      raw_.push_back(middle(n));
      const auto [from, to] = common(n);
      const int most = std::max(gaps(n, to), gaps(n, from));
      for (int k = 1; k < most; ++k)
        for (const int side : {-1, 1}) raw_.push_back(fill(n, side * static_cast<double>(k) / most, from, to));
      double worst = 0;
      for (int s = 0; s <= 32; ++s) {
        const double beta = from + (to - from) * s / 32.0;
        const auto& t = trace(n);
        worst = std::max(worst, finger_ridge(gear_, t.R(beta), 0.5 * crown_distance(t.centre(1, beta), t.centre(-1, beta)) / most));
      }
      plan_.ridge_predicted_mm = std::max(plan_.ridge_predicted_mm, worst);
    }
  }

  RawPass fill(std::size_t n, double mu, double from, double to) const {
    const auto t = trace(n);
    RawPass pass;
    pass.name = fmt::format("fill {:.2f}", mu);
    pass.half = static_cast<int>(n);
    pass.pieces.push_back([t, mu, from, to](double s) { return blend(t, from + (to - from) * s, mu); });
    run_out(n, pass);
    return pass;
  }

  void finish() {
    for (std::size_t n = gear_.halves().size(); n-- > 0;)
      for (const int sigma : {1, -1}) raw_.push_back(wall(n, sigma));
  }

  /// Distance of a straight block a..b from the exact piece, at a point c of it in the same share s: across the path and
  /// down, for a straight tip and for straight joints (R_c, e).
  double block_error(const Centre& a, const Centre& b, const Centre& c, double s) const {
    const double dR = a.R_c + s * (b.R_c - a.R_c) - c.R_c, dT = a.theta_c + s * (b.theta_c - a.theta_c) - c.theta_c;
    const double joints = std::abs(c.R_c * dT * std::cos(c.beta_c) - dR * std::sin(c.beta_c));
    const Vec3 tip = gear_.tip(a.R_c, a.e) + s * (gear_.tip(b.R_c, b.e) - gear_.tip(a.R_c, a.e));
    const Vec3 q = cutter_from_blank<double>(tip, c.R_c, c.e, sd_, cd_);
    const double across = q.y() * std::cos(c.beta_c) - q.z() * std::sin(c.beta_c);
    return std::max(joints, std::hypot(across, q.x() + gear_.parameters().dedendum_mm));
  }

  /// Points of a piece with equal chord errors: the error of a block grows with the square of its share.
  std::vector<Centre> sample(const Piece& piece) {
    std::vector<double> sum(kFine + 1, 0.0);
    const double target = 0.9 * chord_;
    for (int i = 0; i < kFine; ++i) {
      const double a = static_cast<double>(i) / kFine, b = static_cast<double>(i + 1) / kFine;
      const double err = block_error(piece(a), piece(b), piece(0.5 * (a + b)), 0.5);
      sum[static_cast<std::size_t>(i) + 1] = sum[static_cast<std::size_t>(i)] + std::sqrt(err / target);
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
      double worst = 0;
      for (std::size_t i = 1; i < points.size(); ++i)
        for (const double s : {0.25, 0.5, 0.75})
          worst = std::max(worst, block_error(points[i - 1], points[i], piece(at[i - 1] + s * (at[i] - at[i - 1])), s));
      if (worst <= chord_ || attempt >= 40) {
        plan_.chord_mm = std::max(plan_.chord_mm, worst);
        return points;
      }
      n += 1 + n / 12;
    }
  }

  void write() {
    const double above = gear_.parameters().dedendum_mm + gear_.parameters().addendum_mm + kLift;
    std::vector<std::vector<Centre>> passes;
    for (const RawPass& raw : raw_) {
      std::vector<Centre> points;
      for (const Piece& piece : raw.pieces) {
        auto part = sample(piece);
        points.insert(points.end(), part.begin() + (points.empty() ? 0 : 1), part.end());
      }
      if (!raw.outward) std::reverse(points.begin(), points.end());
      passes.push_back(std::move(points));
    }
    // Between passes a straight tip cuts the corner over the cone: lifted by its sag as well.
    double sag = 0;
    for (std::size_t i = 1; i < passes.size(); ++i) {
      const Centre &a = passes[i - 1].back(), &b = passes[i].front();
      sag = std::max(sag, (std::max(a.R_c, b.R_c) * sd_ + above * cd_) * (1 - std::cos(0.5 * (b.e - a.e))) * cd_);
    }
    const double lift = above + sag;
    std::vector<int> count(gear_.halves().size(), 0);
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const auto& points = passes[i];
      const int zone = raw_[i].half, number = count[static_cast<std::size_t>(zone)]++;
      const auto add = [&](const Centre& c, double up, double feed, MoveKind kind) {
        plan_.path.records.push_back({gear_.tip(c.R_c, c.e, up), gear_.axis(c.e), feed, kind, zone, number});
      };
      add(points.front(), lift, 0, MoveKind::rapid);
      add(points.front(), 0, op_.feed_mm_min, MoveKind::engage);
      double length = 0;
      for (std::size_t k = 1; k < points.size(); ++k) {
        const double step = crown_distance(points[k - 1], points[k]);
        const double tip = (gear_.tip(points[k].R_c, points[k].e) - gear_.tip(points[k - 1].R_c, points[k - 1].e)).norm();
        length += step;
        add(points[k], 0, op_.feed_mm_min * tip / step, MoveKind::feed);
      }
      add(points.back(), lift, op_.feed_mm_min, MoveKind::retract);
      plan_.passes.push_back({zone, number, raw_[i].name, raw_[i].outward, length, points.size()});
    }
  }

  const BevelGear& gear_;
  const ToolAssembly& tool_;
  const MillingOperation& op_;
  double sd_, cd_, chord_ = 0;
  std::vector<RawPass> raw_;
  FingerPlan plan_;
};

/// Height above the root cone of the lower surface of the cutter at lateral distance y.
double surface_height(const BevelGear& gear, const FingerSolid& solid, double R_c, double y) {
  const double x = solid.lower_surface(y), a = x * gear.cos_delta() + R_c * gear.sin_delta();
  return x + y * y / (std::hypot(a, y) + a) * gear.cos_delta() + gear.parameters().dedendum_mm;
}

}  // namespace

double finger_ridge(const BevelGear& gear, double R_c, double gap) {
  return surface_height(gear, FingerSolid(gear.cutter()), R_c, 0.5 * gap);
}

double finger_gap(const BevelGear& gear, double R_c, double ridge) {
  const FingerSolid solid(gear.cutter());
  double lo = 0, hi = gear.cutter().rho_D;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (lo + hi);
    (surface_height(gear, solid, R_c, mid) < ridge ? lo : hi) = mid;
  }
  return 2 * lo;
}

FingerCutterData finger_cutter_data(const ToolAssembly& tool) {
  return {tool.module_mm, tool.tip_radius_mm, tool.rack_depth_mm, tool.profile_height_mm};
}

Result<BevelGear> gear_for_finger_mill(const BevelGear& gear, const ToolAssembly& tool) {
  auto made = BevelGear::make(gear.parameters(), finger_cutter_data(tool));
  if (const auto* bad = std::get_if<1>(&made)) return bad->front().diagnostic;
  const double flutes = tool.flute_length_mm > 0 ? tool.flute_length_mm : gear.parameters().dedendum_mm + tool.profile_height_mm;
  const double least = gear.parameters().dedendum_mm + gear.parameters().addendum_mm;
  if (flutes < least && tool.shank_diameter_mm > 2 * std::get<0>(made).cutter().rho_D)
    return fail("flute_length = {:.4f} is below the tooth depth {:.4f}: the shank would cut the tip of the teeth", flutes, least);
  return std::move(std::get<0>(made));
}

Result<FingerPlan> plan_finger_operation(const BevelGear& gear, const ToolAssembly& tool, const MillingOperation& operation,
                                         int operation_index, const Tolerances& tolerances) {
  if (tool.type != CutterType::finger_mill) return fail("tool {} is not a finger mill", tool.number);
  auto own = gear_for_finger_mill(gear, tool);
  if (!own) return own.error();
  if (operation.type == OperationType::finger_roughing && !(operation.ridge_mm > 0))
    return fail("ridge = {:.4f} must be positive", operation.ridge_mm);
  return Planner(*own, tool, operation, operation_index, tolerances).plan();
}

}  // namespace toothpath
