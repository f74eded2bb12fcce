#include "geometry/bevel_gear/gear.h"

#include "geometry/base/angle.h"
#include "geometry/bevel_gear/limits.h"
#include "geometry/bevel_gear/modified_walls.h"
#include "geometry/bevel_gear/pass.h"
#include "geometry/bevel_gear/walls.h"

namespace toothpath::bevel_gear {

double BevelGear::pitch() const { return 2 * kPi / parameters_.teeth; }

double BevelGear::normal_module(double R) const { return 2 * sin_delta_ / parameters_.teeth * R * std::sqrt(R / R_0_); }

FingerProfile<double> BevelGear::profile_of(const FingerCutterData& c) const {
  const auto& p = parameters_;
  return make_finger_profile<double>({p.pressure_angle_rad, kappa_v(), p.dedendum_mm, c.module_mm, c.tip_radius_mm,
                                      c.rack_depth_mm, c.profile_height_mm},
                                     profile_law(p));
}

BevelTrace<double> BevelGear::trace(int h, double r_0) const {
  BevelTrace<double> t;
  t.R_0 = R_0_;
  t.sin_delta = sin_delta_;
  t.cos_delta = cos_delta_;
  t.r_0 = r_0;
  t.e_h = e_h_;
  t.h = h;
  t.beta_ref = t.beta(R_ref_);
  t.beta_end = t.beta(t.R_lim());
  return t;
}

Vec3 BevelGear::tip(double R_c, double e, double lift) const {
  return blank_from_cutter<double>(lift - parameters_.dedendum_mm, 0.0, 0.0, R_c, e, sin_delta_, cos_delta_);
}

Vec3 BevelGear::axis(double e) const { return {cos_delta_ * std::cos(e), cos_delta_ * std::sin(e), -sin_delta_}; }

std::optional<BevelCorner> bevel_corner(const BevelTrace<double>& inner, const BevelTrace<double>& outer, int sigma,
                                        double R_J) {
  const double beta_J = inner.beta(R_J), shift = inner.r_0 / (2 * inner.R_0 * std::cos(beta_J));
  double b1 = beta_J + shift, b2 = beta_J - shift;
  // Newton with the closed-form derivatives dR_c/dbeta = -F cos(beta_c) ds/dR.. of both curves, ds/dbeta = -2 R_0
  // sin(beta).
  for (int k = 0; k < 50; ++k) {
    if (!(b1 > 0) || !(b2 > 0)) return std::nullopt;
    const auto c1 = inner.curved_centre(sigma, b1), c2 = outer.curved_centre(sigma, b2);
    const double v1 = -2 * inner.R_0 * std::sin(b1) * inner.speed_ratio(sigma, b1);
    const double v2 = -2 * outer.R_0 * std::sin(b2) * outer.speed_ratio(sigma, b2);
    const double a = v1 * std::cos(c1.beta_c), b = -v2 * std::cos(c2.beta_c);
    const double c = v1 * std::sin(c1.beta_c) / c1.R_c, d = -v2 * std::sin(c2.beta_c) / c2.R_c;
    const double f0 = c1.R_c - c2.R_c, f1 = c1.theta_c - c2.theta_c, det = a * d - b * c;
    if (!(std::abs(det) > 0)) return std::nullopt;
    const double s1 = std::clamp(-(d * f0 - b * f1) / det, -0.1, 0.1),
                 s2 = std::clamp(-(a * f1 - c * f0) / det, -0.1, 0.1);
    b1 += s1;
    b2 += s2;
    if (std::abs(s1) + std::abs(s2) < 1e-14 && k > 0) {
      const auto at = inner.curved_centre(sigma, b1), other = outer.curved_centre(sigma, b2);
      if (std::hypot(at.R_c - other.R_c, at.R_c * (at.theta_c - other.theta_c)) > 1e-11 * inner.R_0)
        return std::nullopt;
      return BevelCorner{sigma, b1, b2, at.R_c, at.e};
    }
  }
  return std::nullopt;
}

double contact_reach(const BevelWall<double>& wall, double beta, double height) {
  ProfilePoint<double> q;
  // Profile point at this height: parameter by bisection, x(p) is monotone.
  double lo = wall.cutter.p_A, hi = wall.cutter.p_D;
  for (int k = 0; k < 80; ++k) {
    const double mid = 0.5 * (lo + hi);
    (wall.cutter.at(mid).x < height ? lo : hi) = mid;
  }
  q = wall.cutter.at(hi);
  const auto f = wall.point_at(wall.trace.centre(wall.sigma, beta), q);
  return q.rho * std::abs(std::sin(f.gamma));
}

/// In modules: how far a wall grid stays away from where ell(beta) turns back.
constexpr double kRegularMargin = 0.01;
constexpr int kPathLooks = 256;

class BevelGearBuilder {
 public:
  using Step = void (BevelGearBuilder::*)();

  BevelGearBuilder(const BevelGearParameters& p, const FingerCutterData& c) {
    gear_.parameters_ = p;
    gear_.cutter_ = c;
  }

  /// @param judged  else the walls alone are made, and limits that they can break are not looked at
  Expected<BevelGear, std::vector<Refusal>> build(bool judged) {
    judged_ = judged;
    check_bevel_ranges(gear_.parameters_, gear_.cutter_, refusals_);
    for (const Step step : {&BevelGearBuilder::blank, &BevelGearBuilder::modifications, &BevelGearBuilder::profile,
                            &BevelGearBuilder::halves, &BevelGearBuilder::passes})
      if (refusals_.empty()) (this->*step)();
    for (const Step step : {&BevelGearBuilder::regularity, &BevelGearBuilder::top_land})
      if (judged && refusals_.empty()) (this->*step)();
    if (!refusals_.empty()) return std::move(refusals_);
    return std::move(gear_);
  }

 private:
  template <typename... Args>
  void refuse(const char* key, fmt::format_string<Args...> text, Args&&... args) {
    refusals_.push_back({key, fail(text, std::forward<Args>(args)...)});
  }
  template <typename... Args>
  void warn(fmt::format_string<Args...> text, Args&&... args) {
    gear_.warnings_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  void blank() {
    auto& g = gear_;
    const auto& p = g.parameters_;
    g.delta_ = bevel_pitch_angle(p);
    g.sin_delta_ = std::sin(g.delta_);
    g.cos_delta_ = std::abs(g.delta_ - kPi / 2) < 1e-15 ? 0.0 : std::cos(g.delta_);
    g.R_e_ = p.teeth * p.outer_transverse_module_mm / (2 * g.sin_delta_);
    g.R_i_ = g.R_e_ - p.face_width_mm;
    const double c = std::cos(p.outer_spiral_angle_rad);
    g.R_0_ = g.R_e_ / (c * c);
    if (!(g.R_i_ > 0)) {
      refuse("face_width", "face_width = {:.4f} reaches the apex; it must be below the outer cone distance {:.4f}",
             p.face_width_mm, g.R_e_);
      return;
    }
    const double R = p.apex_cone_distance_mm;
    g.R_ref_ = p.form == BevelForm::single && R == 0 ? g.R_m() : R;
    if (p.form == BevelForm::herringbone && !(R > g.R_i_ && R < g.R_e_))
      refuse("apex_cone_distance", "apex_cone_distance = {:.4f} lies outside the face, {:.4f} to {:.4f}", R, g.R_i_,
             g.R_e_);
    if (p.form == BevelForm::single && !(g.R_ref_ > 0 && g.R_ref_ <= g.R_0_))
      refuse("apex_cone_distance", "apex_cone_distance = {:.4f} is not on the tooth trace, which ends at R_0 = {:.4f}",
             R, g.R_0_);
    g.e_h_ = kPi / (2 * p.teeth) + p.backlash_mm / (4 * g.R_e_ * g.sin_delta_);
  }

  void modifications() {
    const auto& p = gear_.parameters_;
    const int zones = p.form == BevelForm::single ? 1 : 2;
    for (std::size_t k = 0; k < p.modifications.size(); ++k)
      if (const auto zone = p.modifications[k].zone; zone && (*zone < 0 || *zone >= zones))
        refusals_.push_back({fmt::format("modification[{}].zone", k),
                             fail("zone = {} is not below {}, the number of halves", *zone, zones)});
    for (int zone = 0; zone < zones && refusals_.empty(); ++zone)
      if (rectangle_of(gear_, zone).face() > 0)  // a groove that leaves no face is refused for that
        if (auto r = refused_modification(p, zone, zones, rectangle_of(gear_, zone)))
          refusals_.push_back(std::move(*r));
  }

  void profile() {
    auto& g = gear_;
    cutter_ = g.profile_of(g.cutter_);
    if (auto r = refused_profile(cutter_)) return refusals_.push_back(std::move(*r));
    if (judged_) check_bevel_cutter(g, cutter_, g.limits_, refusals_, g.warnings_);
  }

  /// What the walls leave of a tooth's tip at the small end; the equivalent gear, which refused pointed teeth ahead of
  /// them, is only near it.
  void top_land() {
    auto& g = gear_;
    const BevelHalf& inner = g.halves_.front();
    const double h = g.parameters_.addendum_mm;
    const auto L = bevel_inverse(inner.wall(1), g.R_i_, h), U = bevel_inverse(inner.wall(-1), g.R_i_, h);
    if (L && U) {
      const double tooth = g.pitch() - std::remainder(U->azimuth - L->azimuth, 2 * kPi);
      const double radius = g.R_i_ * g.sin_delta_ + h * g.cos_delta_;
      g.limits_.top_land_mm = radius * tooth * std::sqrt(g.R_i_ / g.R_0_);
    }
    judge_form();
    if (refusals_.empty() && !(g.limits_.top_land_mm > 0))
      refuse(
          "addendum",
          "addendum = {:.4f}: the walls as they are cut meet below the tip at the small end (top land {:.4f} mm, must "
          "be positive): the tooth is pointed; a smaller addendum or less backlash would do",
          h, g.limits_.top_land_mm);
    warn_of_thin_tips(g.limits_, g.warnings_);
  }

  /// What modifications come to; the plain gear beside it tells what they cost.
  void judge_form() {
    auto& g = gear_;
    const bool path = std::any_of(g.halves_.begin(), g.halves_.end(), [](const BevelHalf& half) {
      return half.walls[0].trace.lead[0] || half.walls[0].trace.lead[1];
    });
    if (!path && !cutter_.law) return;
    g.modified_ = modified_form(g);
    g.modified_->top_land_mm = g.limits_.top_land_mm;
    BevelGearParameters plain = g.parameters_;
    plain.modifications.clear();
    const auto made = BevelGear::make(plain, g.cutter_);
    if (const BevelGear* other = made.value_if()) g.modified_->plain_top_land_mm = other->limits().top_land_mm;
    if (!(g.limits_.top_land_mm > 0))
      refuse(
          "modification",
          "the modifications leave a top land of {:.4f} mm at the small end (plain {:.4f} mm), limit 0: the tooth is "
          "pointed; less amount would do",
          g.limits_.top_land_mm, g.modified_->plain_top_land_mm);
  }

  void add_half(int h, double from, double to) {
    BevelHalf b;
    b.hand = h;
    b.R_from = b.ell_from = from;
    b.R_to = b.ell_to = to;
    const int zone = static_cast<int>(gear_.halves_.size());
    const modification::Rectangle on = rectangle_of(gear_, zone);
    BevelTrace<double> trace = gear_.trace(h, cutter_.r_0);
    if (on.face() > 0)
      for (int k = 0; k < 2; ++k) trace.lead[k] = lead_law(gear_.parameters_, k == 0 ? 1 : -1, zone, on, cutter_);
    if (auto r = refused_path(trace, on.from_mm, on.to_mm)) refusals_.push_back(std::move(*r));
    for (int k = 0; k < 2; ++k) b.walls[k] = {trace, cutter_, k == 0 ? 1 : -1};
    gear_.halves_.push_back(std::move(b));
  }

  void halves() {
    auto& g = gear_;
    const auto& p = g.parameters_;
    if (p.form == BevelForm::single) return add_half(p.hand, g.R_i_, g.R_e_);
    add_half(p.hand, g.R_i_, g.R_ref_);
    add_half(-p.hand, g.R_ref_, g.R_e_);
    if (!refusals_.empty()) return;
    const int sigma = -p.hand;
    const auto X = bevel_corner(g.halves_[0].wall(sigma).trace, g.halves_[1].wall(sigma).trace, sigma, g.R_ref_);
    if (!X) {
      refuse("apex_cone_distance",
             "apex_cone_distance = {:.4f}: the cutter paths of the two halves do not cross on the concave side; the "
             "cutter is too wide for the corner",
             g.R_ref_);
      return;
    }
    g.corner_ = *X;
    if (judged_) room_for_corner();
    const double w = p.relief_half_width_mm;
    const double room = std::min(g.R_ref_ - g.R_i_, g.R_e_ - g.R_ref_);
    if (!(w < room))
      refuse("relief_half_width", "relief_half_width = {:.4f} leaves no face in one half; it must be below {:.4f}", w,
             room);
    g.halves_[0].ell_to = g.R_ref_ - w;
    g.halves_[1].ell_from = g.R_ref_ + w;
  }

  /// Halves and relief groove wide enough for the fillet of the corner.
  void room_for_corner() {
    auto& g = gear_;
    const BevelCorner& X = g.corner_;
    const double h_a = g.parameters_.addendum_mm;
    // rho sin(gamma) at the tip of the larger fillet of the two halves, measured from the crossing.
    const double reach = std::max(contact_reach(g.halves_[0].wall(X.sigma), X.beta_inner, h_a),
                                  contact_reach(g.halves_[1].wall(X.sigma), X.beta_outer, h_a));
    g.limits_.fillet_reach_mm = reach;
    const double least = 2 * reach, lo = g.R_i_ + least, hi = g.R_e_ - least;
    if (lo > hi)
      refuse("face_width",
             "face_width = {:.4f} is below {:.4f}, four times the reach of the corner fillet: no apex_cone_distance "
             "leaves both halves wide enough; a wider face or a mill of less diameter would do",
             g.R_e_ - g.R_i_, 2 * least);
    else if (g.R_ref_ < lo || g.R_ref_ > hi)
      refuse("apex_cone_distance",
             "apex_cone_distance = {:.4f} leaves a half narrower than {:.4f}, twice the reach of the corner fillet; it "
             "must lie between {:.4f} and {:.4f}",
             g.R_ref_, least, lo, hi);
    if (const double w = g.parameters_.relief_half_width_mm; w < reach)
      refuse("relief_half_width",
             "relief_half_width = {:.4f} is below {:.4f}, the reach of the corner fillet at the tip", w, reach);
  }

  /// Smallest F of a pass. On the equidistant F - 1 is monotone: it is smallest at the large end for eps = +1, at the
  /// small end for eps = -1. A modified path is only near that.
  static double least_speed_ratio(const BevelWall<double>& w, double from, double to) {
    const auto& t = w.trace;
    double least = t.speed_ratio(w.sigma, w.eps() > 0 ? std::max(to, t.beta_end) : from);
    for (int n = 0; t.lead_of(w.sigma) && n <= kPathLooks; ++n) {
      const double at = from + (to - from) * n / kPathLooks;
      if (!t.straight(w.sigma, at)) least = std::min(least, t.speed_ratio(w.sigma, at));
    }
    return least;
  }

  void passes() {
    auto& g = gear_;
    const auto& p = g.parameters_;
    const double rho_D = cutter_.rho_D, m_te = p.outer_transverse_module_mm;
    for (std::size_t i = 0; i < g.halves_.size(); ++i) {
      auto& half = g.halves_[i];
      const bool small_end = i == 0, large_end = i + 1 == g.halves_.size();
      for (int k = 0; k < 2; ++k) {
        const auto& w = half.walls[k];
        const auto& t = w.trace;
        const bool concave_corner = g.herringbone() && w.sigma == g.corner_.sigma;
        std::optional<double> from, to;
        if (small_end) {
          const double s = w.eps() < 0 ? 1.25 * rho_D * std::sin(t.beta(g.R_i_)) + 0.1 * m_te : 0.0;
          if (g.R_i_ - s > 0) from = beta_at_centre(t, w.sigma, g.R_i_ - s);
        } else {
          from = concave_corner ? g.corner_.beta_outer : t.beta(half.R_from);
        }
        if (large_end) {
          const double s = w.eps() > 0 ? 1.25 * rho_D * std::sin(t.beta(g.R_e_)) + 0.1 * m_te : 0.0;
          to = beta_at_centre(t, w.sigma, g.R_e_ + s);
        } else {
          to = concave_corner ? g.corner_.beta_inner : t.beta(half.R_to);
        }
        if (!from || !to) {
          refuse("face_width",
                 "face_width = {:.4f}: the pass of wall {} cannot run {} of the face; the trace ends at R_0 = {:.4f}",
                 p.face_width_mm, w.sigma > 0 ? "L" : "U", from ? "out of the large end" : "out of the small end",
                 g.R_0_);
          return;
        }
        half.beta_from[k] = *from;
        half.beta_to[k] = *to;
        least_F_ = std::min(least_F_, least_speed_ratio(w, *from, *to));
        if (w.eps() > 0 && *to < t.beta_end) {
          const double loss = 0.17 * std::pow(t.r_0, 3) / (t.R_0 * t.R_0);
          g.limits_.cusp_loss_mm = std::max(g.limits_.cusp_loss_mm, g.R_e_ > t.R_lim() ? loss : 0.0);
        }
      }
    }
    g.limits_.cusp_speed_ratio = least_F_;
    end_before_the_trace();
    if (!judged_) return;
    if (!(least_F_ > 0.05))
      refuse("face_width",
             "face_width = {:.4f}: the cutter centre path has a cusp inside the face (speed ratio {:.4f}, must exceed "
             "0.05)",
             p.face_width_mm, least_F_);
    check_bevel_cusp(g, refusals_, gear_.warnings_);
  }

  /// Just before the end of the trace the convex wall has no regular envelope at its tip: ell(beta) turns back there.
  void end_before_the_trace() {
    auto& g = gear_;
    const auto& p = g.parameters_;
    const double m_te = p.outer_transverse_module_mm;
    auto& last = g.halves_.back();
    last.ell_to = std::min(last.ell_to, last.walls[0].trace.R_lim());
    for (const auto& w : last.walls) {
      if (w.eps() > 0) continue;
      double lo = w.cutter.p_C, hi = w.cutter.p_D, farthest = 0;
      for (int k = 0; k < 60; ++k) {
        const double mid = 0.5 * (lo + hi);
        (w.cutter.at(mid).x < p.addendum_mm ? lo : hi) = mid;
      }
      for (int k = 0; k <= 400; ++k) farthest = std::max(farthest, w.generatrix(0.2 * k / 400, hi)[0]);
      last.ell_to = std::min(last.ell_to, farthest - kRegularMargin * m_te);
    }
  }

  void regularity() {
    auto& g = gear_;
    double least = std::numeric_limits<double>::infinity(), at_R = 0;
    for (const auto& half : g.halves_)
      for (int k = 0; k < 2; ++k) {
        const auto& w = half.walls[k];
        for (int i = 0; i <= 24; ++i)
          for (int j = 1; j <= 24; ++j) {
            const double beta = half.beta_from[k] + (half.beta_to[k] - half.beta_from[k]) * i / 24.0;
            const double p = w.cutter.p_A + (w.cutter.p_D - w.cutter.p_A) * j / 24.0;
            const auto q = w.cutter.at(p);
            if (q.x > g.parameters_.addendum_mm || !(q.dS > 1e-12)) continue;
            const auto f = w.point(beta, p);
            const ConePoint at = cone_point(f.p, g.sin_delta_, g.cos_delta_);
            if (at.ell < half.ell_from || at.ell > half.ell_to) continue;
            const double J = bevel_curvature(w, beta, p).regularity;
            if (J < least) least = J, at_R = at.ell;
          }
      }
    g.limits_.least_regularity = least;
    if (!(least > 0))
      refuse("tool.module",
             "the cutter undercuts the flank at cone distance {:.3f} (regularity {:.4f}, must be positive); a smaller "
             "module of the cutter or a larger spiral angle is needed",
             at_R, least);
  }

  BevelGear gear_;
  FingerProfile<double> cutter_;
  std::vector<Refusal> refusals_;
  bool judged_ = true;
  double least_F_ = std::numeric_limits<double>::infinity();
};

Expected<BevelGear, std::vector<Refusal>> BevelGear::make(const BevelGearParameters& parameters,
                                                          const FingerCutterData& cutter) {
  return BevelGearBuilder(parameters, cutter).build(true);
}

Expected<BevelGear, std::vector<Refusal>> walls_of(const BevelGearParameters& parameters,
                                                   const FingerCutterData& cutter) {
  return BevelGearBuilder(parameters, cutter).build(false);
}

}  // namespace toothpath::bevel_gear
