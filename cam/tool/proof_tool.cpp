#include "cam/tool/proof_tool.h"

#include <algorithm>
#include <cmath>

#include "cam/tool/cutters.h"
#include "cam/tool/profile.h"

namespace toothpath::tool {
namespace {

constexpr int kMostLinks = 400;         // of a chain
constexpr double kShortestLink = 1e-6;  // mm

/// The hull of two balls about the axis, centres at heights h_0 < h_1.
RoundedFrustum hull_of_balls(double h_0, double rho_0, double h_1, double rho_1) {
  const double rise = rho_1 - rho_0, length = h_1 - h_0, sin_tau = std::abs(rise) / length,
               cos_tau = std::sqrt(std::max(0.0, 1 - sin_tau * sin_tau));
  const double foot = std::abs(rise) * sin_tau,
               radius = std::abs(rise) * cos_tau;  // where the cone touches the larger ball less the smaller
  if (rise >= 0) return {{h_0, h_1 - foot, 0, radius, Body::flute}, rho_0};
  return {{h_0 + foot, h_1, radius, 0, Body::flute}, rho_1};
}

/// Bound of |rho''| between two heights: of the nominal arc, greatest where it is nearest to its centre, and of the
/// measured table, whose second derivative is linear between its points.
double most_bend(const RadiusLaw<double>& law, double t_0, double t_1) {
  const double most = law.R_m == 0 ? 0 : 1 / (std::abs(law.R_m - law.r_0) * law.cos_tau);
  if (!law.error) return most;
  double error = 0;
  const double small = 1e-3 * (t_1 - t_0);
  for (const double t : {t_0, t_1 - small})
    error = std::max(error, std::abs(law.error->at(t + small).slope - law.error->at(t).slope) / small);
  return most + 1.01 * error;  // the mean over a thousandth of a line is its end within a thousandth of its range
}

/// Balls of a law at heights so near to each other that the chords of rho leave it by no more than the sag; each grown
/// by what they do leave.
std::vector<RoundedFrustum> chain(const RadiusLaw<double>& law, double t_end, double sag_mm) {
  std::vector<double> stops{t_end};
  if (law.error)
    for (const double x : law.error->t)
      if (x > 0 && x < t_end) stops.push_back(x);
  std::sort(stops.begin(), stops.end());
  std::vector<RoundedFrustum> out;
  double from = 0;
  for (const double stop : stops) {
    const double length = stop - from;
    if (length < kShortestLink) continue;
    const double bend = most_bend(law, from, stop);
    const int links = std::clamp(int(std::ceil(length * std::sqrt(bend / (8 * sag_mm)))), 1, kMostLinks);
    const double step = length / links, grown = bend * step * step / 8;
    for (int k = 0; k < links; ++k) {
      const double a = from + k * step, b = k + 1 == links ? stop : from + (k + 1) * step;
      out.push_back(hull_of_balls(law.r_0 + a, law.rho(a) + grown, law.r_0 + b, law.rho(b) + grown));
    }
    from = stop;
  }
  return out;
}

/// The one body of a ball end with a straight side.
RoundedFrustum straight(const RadiusLaw<double>& law, double flute_end) {
  const double to = std::max(flute_end + law.r_0 * law.sin_tau, law.r_0 + kShortestLink),
               tan_tau = law.sin_tau / law.cos_tau;
  return {{law.r_0, to, 0, (to - law.r_0) * tan_tau, Body::flute}, law.r_0};
}

/// Flat and bull nose: flat, corner arc, straight; nothing where the meridian is not of that form.
std::optional<RoundedFrustum> bull_nose(const Meridian& cutting) {
  const auto& p = cutting.pieces();
  std::size_t k = 0;
  double flat = 0, corner = 0;
  if (k < p.size() && p[k].to[0] == p[k].from[0] && p[k].bend == 0) flat = p[k++].to[1];
  if (k < p.size() && p[k].bend > 0 && std::abs(p[k].bend * (p[k].to[0] - p[k].from[0]) - 1) < 1e-12)
    corner = 1 / p[k++].bend;
  const double radius = flat + corner;
  if (k < p.size() && (p[k].bend != 0 || p[k].from[1] != radius || p[k].to[1] != radius)) return {};
  if (k + 1 < p.size() || !(radius > 0)) return {};
  return RoundedFrustum{{corner, std::max(cutting.to(), corner + kShortestLink), flat, flat, Body::flute}, corner};
}

}  // namespace

std::vector<ProofTool> proof_tools(const std::vector<ToolAssembly>& tools) {
  std::vector<ProofTool> out;
  for (const auto& t : tools) out.push_back(proof_tool(t));
  return out;
}

ProofTool proof_tool(const ToolAssembly& t) {
  if (!turns_freely(t)) return proof_tool(profile_of(t), t.number);
  ProofTool out;
  out.number = t.number;
  const double R = t.radius_mm();
  out.cutting = {{{R, std::max(t.flute_length_mm, R + kShortestLink), 0, 0, Body::flute}, R}};
  out.ball_top_mm = R;
  out.bodies = shank_and_holder(t);
  out.ball_mill = t;
  return out;
}

ProofTool proof_tool(const Profile& profile, int number, double sag_mm) {
  ProofTool out;
  out.number = number;
  if (const auto& law = profile.law()) {
    out.ball_top_mm = law->r_0 * (1 - law->sin_tau);
    if (law->R_m == 0 && !law->error) {
      out.cutting = {straight(*law, profile.cutting().to())};
    } else {
      out.cutting = chain(*law, profile.law_end(), sag_mm);
      if (law->error) {  // above what was measured
        RadiusLaw<double> nominal = *law;
        nominal.error = nullptr;
        const double t = profile.law_end(), grown = std::max(0.0, law->error->largest()),
                     end = profile.cutting().to() - law->r_0 * (1 - law->sin_tau);
        if (end > t + kShortestLink)
          out.cutting.push_back(
              hull_of_balls(law->r_0 + t, nominal.rho(t) + grown, law->r_0 + end, nominal.rho(end) + grown));
      }
    }
  } else if (const auto body = bull_nose(profile.cutting())) {
    out.cutting = {*body};
  } else {
    for (const auto& f : profile.cutting().enclosing_frustums(sag_mm, Body::flute)) out.cutting.push_back({f, 0});
  }
  for (const auto& [meridian, body] :
       {std::pair{&profile.shank(), Body::shank}, std::pair{&profile.holder(), Body::holder}})
    for (const auto& f : meridian->enclosing_frustums(sag_mm, body)) out.bodies.push_back(f);
  return out;
}

}  // namespace toothpath::tool
