// What a finger mill leaves on a gear: conditions, deviation of the walls, over-cut at the small end.
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/bevel_gear/finger_cutter_design.h"
#include "geometry/bevel_gear/limits.h"
#include "geometry/bevel_gear/pass.h"

namespace toothpath::bevel_gear {
namespace {

constexpr double kLargestDeviation = 0.01;  // of the mean normal module: a mill that leaves more is not usable

/// Smallest signed distance of a blank point to the mill over a pass: samples, then golden section about the nearest.
double clearance(const Vec3& point, const BevelTrace<double>& t, int sigma, double beta_from, double beta_to,
                 const FingerSolid& solid) {
  constexpr int kSamples = 120;
  const auto distance = [&](double beta) {
    const auto c = t.centre(sigma, beta);
    return solid.signed_distance(cutter_from_blank<double>(point, c.R_c, c.e, t.sin_delta, t.cos_delta));
  };
  double best = std::numeric_limits<double>::infinity();
  int at = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double d = distance(beta_from + (beta_to - beta_from) * i / kSamples);
    if (d < best) best = d, at = i;
  }
  double a = beta_from + (beta_to - beta_from) * std::max(0, at - 1) / kSamples;
  double b = beta_from + (beta_to - beta_from) * std::min(kSamples, at + 1) / kSamples;
  const double g = 0.5 * (std::sqrt(5.0) - 1);
  double x1 = b - g * (b - a), x2 = a + g * (b - a), f1 = distance(x1), f2 = distance(x2);
  for (int k = 0; k < 40; ++k) {
    if (f1 < f2) b = x2, x2 = x1, f2 = f1, x1 = b - g * (b - a), f1 = distance(x1);
    else a = x1, x1 = x2, f1 = f2, x2 = a + g * (b - a), f2 = distance(x2);
  }
  return std::min({best, f1, f2});
}

/// The gear of a design with another mill on it.
struct Judge {
  const BevelGear& g;
  const FingerProfile<double>& c;
  CutterJudgement& out;

  void condition(std::string name, std::string quantity, double value, double limit, bool at_least, std::string unit,
                 bool only_remark, std::string meaning) const {
    const bool met = at_least ? value >= limit : value <= limit;
    out.conditions.push_back({std::move(name), std::move(quantity), value, limit, at_least, std::move(unit),
                              met           ? Verdict::met
                              : only_remark ? Verdict::remark
                                            : Verdict::broken,
                              std::move(meaning)});
  }
  [[nodiscard]] BevelWall<double> wall(const BevelHalf& half, int k) const {
    BevelWall<double> cut{g.trace(half.hand, c.r_0), c, k == 0 ? 1 : -1};
    for (int side = 0; side < 2; ++side) cut.trace.lead[side] = half.walls[k].trace.lead[side];
    return cut;
  }

  void profile_conditions() const {
    const auto& p = g.parameters();
    const double m_i = g.normal_module(g.R_i()), share = out.data.module_mm / m_i;
    condition("width at the small end", "m_nj / m_n(R_i)", share, 0.99, false, "", false,
              "wider than the space: the pass of one wall cuts the other");
    condition("not needlessly thin", "m_nj / m_n(R_i)", share, 0.97, true, "", true,
              "usable; more fill passes and a weaker tip than necessary");
    condition("C on the involute", "tan(alpha_n) + kappa_v p_C",
              c.sin_a / c.cos_a - c.kappa_v * out.data.rack_depth_mm / (c.sin_a * c.cos_a), 0, true, "", true,
              "C sits on the base circle: the rack depth is not reached");
    condition("involute above the tip", "-x_C", -c.x_C, c.h_f, false, "mm", false,
              "the involute would reach below the tip");
    condition("not pointed", "tip radius r_t", c.r_t, c.line_radius(-c.h_f) * c.cos_phi / (1 - c.sin_phi), false, "mm",
              false, "no flat is left at the tip");
    condition("corner arc below C", "tip radius r_t", c.r_t, (c.x_C + c.h_f) / (1 - c.sin_phi), false, "mm", false,
              "the arc eats the involute");
    condition("retractable", "angle of BC, phi", degrees(c.phi), 0, true, "deg", false,
              "undercut mill: pulling out along the axis gouges");
    condition("tip at working depth", "difference to the dedendum", std::abs(c.h_f - p.dedendum_mm),
              1e-6 * p.outer_transverse_module_mm, false, "mm", false, "the root lies at another depth");
    condition("profile above the tooth", "x_D", c.x_D, p.addendum_mm, true, "mm", false,
              "the cylinder cuts the top of the flank");
    condition("reserve above the tooth", "x_D", c.x_D, 1.1 * p.addendum_mm, true, "mm", true,
              "little reserve for depth errors and resharpening");
    condition("top land at the small end", "s_an", bevel_top_land(g, g.R_i()), 0.2 * m_i, true, "mm",
              bevel_top_land(g, g.R_i()) >= 0, "thin tooth tips, whatever the mill");
    condition("face width", "b", p.face_width_mm, face_width_for_module(g, out.data.module_mm / 0.99), false, "mm",
              false, "at this face width the small end is too narrow for the mill");
  }

  /// Regularity and cusps of all passes, reach of the corner's fillet.
  void path_conditions() const {
    const auto& p = g.parameters();
    double regularity = std::numeric_limits<double>::infinity(), speed = regularity, loss = 0;
    for (std::size_t i = 0; i < g.halves().size(); ++i)
      for (int k = 0; k < 2; ++k) {
        const auto& half = g.halves()[i];
        const auto w = wall(half, k);
        const auto& t = w.trace;
        for (int n = 0; n <= 16; ++n)
          for (int j = 1; j < 16; ++j) {
            const double q = c.p_A + (c.p_D - c.p_A) * j / 16.0;
            if (c.at(q).x > p.addendum_mm || !(c.at(q).dS > 1e-12)) continue;
            const auto beta = bevel_beta_at(w, half.ell_from + (half.ell_to - half.ell_from) * n / 16.0, q);
            if (beta) regularity = std::min(regularity, bevel_curvature(w, *beta, q).regularity);
          }
        const double R = w.eps() > 0 ? std::min(half.R_to, t.R_lim()) : half.R_from;
        speed = std::min(speed, t.speed_ratio(w.sigma, t.beta(R)));
        if (w.eps() > 0 && i + 1 == g.halves().size() && g.R_e() > t.R_lim())
          loss = 0.17 * std::pow(t.r_0, 3) / (t.R_0 * t.R_0);
      }
    condition("regular envelope", "smallest J_n", regularity, 1e-9, true, "", false, "the mill undercuts the flank");
    condition("no cusp of the path in the face", "smallest F", speed, 0.05, true, "", false,
              "the path turns back inside the face");
    condition("loss where the path ends early", "flank error", 1000 * loss, 1, false, "um", false,
              "R_0 is too near the large end for this mill");
    if (!g.herringbone()) return;
    const int sigma = -p.hand, k = sigma > 0 ? 0 : 1;
    const auto inner = wall(g.halves()[0], k), outer = wall(g.halves()[1], k);
    const auto X = bevel_corner(inner.trace, outer.trace, sigma, g.R_ref());
    const double reach = X ? std::max(contact_reach(inner, X->beta_inner, p.addendum_mm),
                                      contact_reach(outer, X->beta_outer, p.addendum_mm))
                           : std::numeric_limits<double>::infinity();
    condition("fillet of the corner inside the relief", "reach about R_J", reach, p.relief_half_width_mm, false, "mm",
              false, "the mate's ridge runs into the fillet");
  }

  void walls(const JudgementOptions& options) const {
    const double low = std::max(g.cutter().x_C, -g.parameters().dedendum_mm), high = g.parameters().addendum_mm,
                 sd = g.sin_delta(), cd = g.cos_delta();
    for (std::size_t i = 0; i < g.halves().size(); ++i)
      for (int k = 0; k < 2; ++k) {
        const auto& half = g.halves()[i];
        const auto &designed = half.walls[k], actual = wall(half, k);
        WallDeviation d;
        d.half = static_cast<int>(i);
        d.sigma = designed.sigma;
        d.least_mm = std::numeric_limits<double>::infinity();
        d.greatest_mm = -d.least_mm;
        for (int r = 0; r < options.rows; ++r)
          for (int n = 0; n < options.columns; ++n) {
            const double height = low + (high - low) * r / (options.rows - 1),
                         ell = half.ell_from + (half.ell_to - half.ell_from) * n / (options.columns - 1);
            const auto a = bevel_inverse(designed, ell, height), b = bevel_inverse(actual, ell, height);
            if (!a) continue;
            if (!b) {
              ++d.missing;
              continue;
            }
            const auto f = designed.point(a->beta, a->p);
            const double deviation = (ell * sd + height * cd) * std::remainder(b->azimuth - a->azimuth, 2 * kPi) *
                                     (f.n.y() * std::cos(a->azimuth) - f.n.x() * std::sin(a->azimuth));
            ++d.points;
            if (deviation < d.least_mm) d.least_mm = deviation, d.least_ell = ell, d.least_height = height;
            if (deviation > d.greatest_mm) d.greatest_mm = deviation, d.greatest_ell = ell, d.greatest_height = height;
          }
        if (d.points == 0) d.least_mm = d.greatest_mm = 0;
        out.walls.push_back(d);
      }
  }

  /// A mill whose walls stand this far from the design makes another gear; the mate decides whether that is good
  /// enough.
  void wall_condition() const {
    condition("walls as designed", "largest deviation", 1000 * std::max(-out.deepest_mm(), out.proudest_mm()), 10,
              false, "um", true, "another tooth form: made for another gear, or reaching another depth");
    const double module = g.normal_module(g.R_m());
    condition("walls of this gear", "largest deviation", 1000 * std::max(-out.deepest_mm(), out.proudest_mm()),
              1000 * kLargestDeviation * module, false, "um", false,
              "more than a hundredth of the mean normal module: the profile belongs to another gear");
  }

  /// Points of the designed walls near the small end against the pass of the opposite wall, the mill as a solid.
  void small_end() const {
    const auto& half = g.halves().front();
    const FingerSolid solid(c);
    const double b = half.R_to - half.R_from, low = std::max(g.cutter().x_C, -g.parameters().dedendum_mm),
                 high = g.parameters().addendum_mm;
    double worst = 0;
    for (int k = 0; k < 2; ++k) {
      const auto other = wall(half, 1 - k);
      // A pass that ends before one of these places is looked at up to its end.
      const double over = other.eps() < 0 ? 1.25 * c.rho_D * std::sin(other.trace.beta(g.R_i())) +
                                                0.1 * g.parameters().outer_transverse_module_mm
                                          : 0.0;
      const double from =
          beta_at_centre(other.trace, other.sigma, std::max(g.R_i() - over, 0.1 * g.R_i())).value_or(kPi / 2 - 1e-6);
      const double to = beta_at_centre(other.trace, other.sigma, g.R_i() + 0.5 * b).value_or(0);
      for (int n = 0; n <= 6; ++n)
        for (int r = 0; r <= 8; ++r) {
          const auto at = bevel_inverse(half.walls[k], g.R_i() + 0.25 * b * n / 6, low + (high - low) * r / 8);
          if (at)
            worst = std::min(
                worst, clearance(half.walls[k].point(at->beta, at->p).p, other.trace, other.sigma, from, to, solid));
        }
    }
    // What rounding leaves is no cut.
    out.small_end_overcut_mm = worst < -1e-9 ? -worst : 0.0;
    condition("opposite wall at the small end", "over-cut", 1000 * out.small_end_overcut_mm, 0, false, "um", false,
              "measured with the mill as a solid along its pass");
  }

  void widths() const {
    const auto width = [&](double R) { return 2 * (R * g.e_h() * g.sin_delta() * std::sqrt(R / g.R_0()) - c.r_0); };
    out.free_width_small_mm = width(g.R_i());
    out.free_width_large_mm = width(g.R_e());
    // Both walls and the middle pass: two gaps of half the free width.
    const double gap = std::max(0.0, out.free_width_large_mm / 4);
    out.ridge_mm = gap < c.rho_D ? FingerSolid(c).lower_surface(gap) + c.h_f : c.x_D + c.h_f;
  }
};

}  // namespace

std::string CutterCondition::text() const {
  const char* verdicts[] = {"met", "remark", "broken"};
  const std::string u = unit.empty() ? "" : " " + unit;
  return fmt::format("{}: {} = {:.4f}{}, limit {} {:.4f}{}, {}", name, quantity, value, u,
                     at_least ? ">=" : "<=", limit, u, verdicts[static_cast<int>(verdict)]);
}

bool CutterJudgement::usable() const {
  for (const auto& c : conditions)
    if (c.verdict == Verdict::broken) return false;
  return true;
}

double CutterJudgement::deepest_mm() const {
  double least = 0;
  for (const auto& w : walls) least = std::min(least, w.least_mm);
  return least;
}

double CutterJudgement::proudest_mm() const {
  double greatest = 0;
  for (const auto& w : walls) greatest = std::max(greatest, w.greatest_mm);
  return greatest;
}

CutterJudgement judge_finger_profile(const BevelGear& g, const FingerCutterData& data,
                                     const FingerProfile<double>& profile, const JudgementOptions& options) {
  CutterJudgement out;
  out.data = data;
  out.profile = profile;
  const Judge trial{g, out.profile, out};
  out.small_end_estimate_mm = 0.5 * kPi * (data.module_mm - g.normal_module(g.R_i()));
  trial.profile_conditions();
  // A mill whose profile contradicts itself has no walls to compare.
  const bool possible = profile.phi >= 0 && profile.rho_o >= 0 && profile.x_B <= profile.x_C && profile.x_D > 0 &&
                        std::isfinite(profile.rho_D);
  if (!possible) return out;
  trial.widths();
  trial.path_conditions();
  trial.walls(options);
  trial.wall_condition();
  trial.small_end();
  return out;
}

CutterJudgement judge_finger_cutter(const BevelGear& g, const FingerCutterData& data, const JudgementOptions& options) {
  return judge_finger_profile(g, data, g.profile_of(data), options);
}

}  // namespace toothpath::bevel_gear
