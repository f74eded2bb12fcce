#include "geometry/bevel_gear/section_models.h"

#include <cmath>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath::bevel_gear {
namespace {

/// The section turned about the centre of the equivalent gear: pitch point at (0, 0), second coordinate towards the
/// wall.
Vec2 turned_section(const FingerProfile<double>& c, double p) {
  const auto q = c.at(p);
  const double tau = c.kappa_v * c.r_0, half = sinc(0.5 * tau);
  return {q.x * std::cos(tau) + q.rho * std::sin(tau) - 0.5 * c.kappa_v * c.r_0 * c.r_0 * half * half,
          q.rho * std::cos(tau) - q.x * std::sin(tau) - c.r_0 * sinc(tau)};
}

/// Azimuths are compared near each other: the trace winds, the point does not.

}  // namespace

Vec3 section_model_point(SectionModel model, const BevelWall<double>& w, double beta, double p) {
  const auto& t = w.trace;
  const double s = w.sigma;
  if (model == SectionModel::centre_path) {
    const auto c = t.centre(w.sigma, beta);
    const auto q = w.cutter.at(p);
    return blank_from_cutter<double>(q.x, -s * q.rho * std::cos(c.beta_c), s * q.rho * std::sin(c.beta_c), c.R_c, c.e,
                                     t.sin_delta, t.cos_delta);
  }
  const Vec2 q = turned_section(w.cutter, p);
  const double b = t.h * beta, e = t.theta(beta) / t.sin_delta - s * t.e_h;
  return blank_from_cutter<double>(q[0], -s * q[1] * std::cos(b), s * q[1] * std::sin(b), t.R(beta), e, t.sin_delta,
                                   t.cos_delta);
}

double centre_path_estimate(const BevelWall<double>& w, double beta, double p) {
  const auto f = w.point(beta, p);
  const auto q = w.cutter.at(p);
  const double turn = f.gamma - f.centre.beta_c;
  return -0.5 * q.rho * q.cos_psi * turn * turn;
}

std::optional<double> section_model_deviation(SectionModel model, const BevelWall<double>& w, double ell,
                                              double height) {
  const auto at = bevel_inverse(w, ell, height);
  if (!at) return std::nullopt;
  const double sd = w.trace.sin_delta, cd = w.trace.cos_delta;
  // Newton for the model's parameters from those of the wall; derivatives by differences, the residual decides.
  double beta = at->beta, p = at->p;
  const double step_p = 1e-5 * w.cutter.r_0, step_b = 1e-6, scale = w.trace.R_0;
  const auto cone = [&](double b, double q) { return cone_point(section_model_point(model, w, b, q), sd, cd); };
  for (int k = 0; k < 30; ++k) {
    const ConePoint f = cone(beta, p);
    const double f0 = f.ell - ell, f1 = f.height - height;
    if (std::hypot(f0, f1) < 1e-13 * scale) break;
    const ConePoint b1 = cone(beta + step_b, p), b0 = cone(beta - step_b, p), p1 = cone(beta, p + step_p),
                    p0 = cone(beta, p - step_p);
    const double a = (b1.ell - b0.ell) / (2 * step_b), c = (b1.height - b0.height) / (2 * step_b);
    const double b = (p1.ell - p0.ell) / (2 * step_p), d = (p1.height - p0.height) / (2 * step_p), det = a * d - b * c;
    if (!(std::abs(det) > 0)) return std::nullopt;
    const double db = -(d * f0 - b * f1) / det, dp = -(a * f1 - c * f0) / det;
    if (!std::isfinite(db) || !std::isfinite(dp)) return std::nullopt;
    beta += std::clamp(db, -0.05, 0.05);
    p = std::max(p + dp, w.cutter.p_A);
    if (!(beta > 2 * step_b)) return std::nullopt;
  }
  const ConePoint f = cone(beta, p);
  if (std::hypot(f.ell - ell, f.height - height) > 1e-10 * scale) return std::nullopt;
  const auto wall = w.point(at->beta, at->p);
  const double r = ell * sd + height * cd, turn = wrapped(at->azimuth - f.azimuth), azimuth = wrapped(at->azimuth);
  return r * turn * (wall.n.y() * std::cos(azimuth) - wall.n.x() * std::sin(azimuth));
}

std::vector<SectionModelMap> section_model_maps(const BevelGear& g, const SectionModelOptions& options) {
  std::vector<SectionModelMap> maps;
  const bool whole = options.height_from == 0 && options.height_to == 0;
  const double low = whole ? g.cutter().x_C : options.height_from,
               high = whole ? g.parameters().addendum_mm : options.height_to;
  for (std::size_t i = 0; i < g.halves().size(); ++i)
    for (const auto& w : g.halves()[i].walls)
      for (const SectionModel model : {SectionModel::centre_path, SectionModel::tooth_trace}) {
        SectionModelMap m;
        m.model = model;
        m.half = static_cast<int>(i);
        m.sigma = w.sigma;
        m.rows = options.rows;
        m.columns = options.columns;
        const double from = g.halves()[i].ell_from, to = g.halves()[i].ell_to;
        for (int c = 0; c < m.columns; ++c) m.ell.push_back(from + (to - from) * c / (m.columns - 1));
        for (int r = 0; r < m.rows; ++r) m.height.push_back(low + (high - low) * r / (m.rows - 1));
        m.least_mm = std::numeric_limits<double>::infinity();
        m.greatest_mm = -m.least_mm;
        double squares = 0;
        int points = 0;
        for (const double height : m.height)
          for (const double ell : m.ell) {
            const auto d = section_model_deviation(model, w, ell, height);
            m.deviation_mm.push_back(d.value_or(std::numeric_limits<double>::quiet_NaN()));
            if (!d) continue;
            if (*d < m.least_mm) m.least_mm = *d, m.least_ell = ell, m.least_height = height;
            m.greatest_mm = std::max(m.greatest_mm, *d);
            squares += *d * *d;
            ++points;
          }
        if (points == 0) m.least_mm = m.greatest_mm = 0;
        m.rms_mm = points > 0 ? std::sqrt(squares / points) : 0;
        maps.push_back(std::move(m));
      }
  return maps;
}

}  // namespace toothpath::bevel_gear
