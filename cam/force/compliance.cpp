#include "cam/force/compliance.h"

#include <array>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath::force {
namespace {

constexpr double kAgree = 1e-10;  // of a piece: two levels of halving
constexpr int kMostHalvings = 40;

/// Gauss's rule with ten nodes.
template <typename F>
double gauss(const F& f, double from, double to) {
  constexpr std::array<std::pair<double, double>, 5> kNodes = {{{0.14887433898163121, 0.29552422471475287},
                                                                {0.43339539412924719, 0.26926671930999635},
                                                                {0.67940956829902441, 0.21908636251598204},
                                                                {0.86506336668898451, 0.14945134915058059},
                                                                {0.97390652851717172, 0.06667134430868814}}};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (const auto& [x, w] : kNodes) sum += w * (f(middle - half * x) + f(middle + half * x));
  return half * sum;
}

/// Integral of f >= 0; NaN where the halvings do not come to an end.
template <typename F>
double integral(const F& f, double from, double to, double whole, int halvings) {
  const double middle = 0.5 * (from + to), low = gauss(f, from, middle), high = gauss(f, middle, to);
  if (std::abs(low + high - whole) <= kAgree * (low + high)) return low + high;
  if (halvings == kMostHalvings) return std::numeric_limits<double>::quiet_NaN();
  return integral(f, from, middle, low, halvings + 1) + integral(f, middle, to, high, halvings + 1);
}

/// The part of the beam in one meridian.
void add(Compliance& sum, const tool::Meridian& meridian, double share, double load, double at, const Elasticity& of) {
  const double from = std::max(load, at), nu = of.poisson, E = of.youngs_modulus_N_mm2, G = E / (2 * (1 + nu)),
               k = 6 * (1 + nu) / (7 + 6 * nu);
  for (const auto& piece : meridian.pieces()) {
    const double low = std::max(from, piece.from[0]), high = piece.to[0];
    if (!(high > low)) continue;
    const auto square = [&](double h) {
      const double d = 2 * share * meridian.radius(h);
      return d * d;
    };
    const auto bending = [&](double h) {
      const double d2 = square(h);
      return (h - load) * (h - at) * 64 / (E * kPi * d2 * d2);
    };
    const auto shear = [&](double h) { return 4 / (k * G * kPi * square(h)); };
    sum.bending += integral(bending, low, high, gauss(bending, low, high), 0);
    sum.shear += integral(shear, low, high, gauss(shear, low, high), 0);
  }
}

}  // namespace

double clamped_at(const tool::Profile& mill) {
  if (!mill.holder().empty()) return mill.holder().from();
  return mill.shank().empty() ? mill.cutting().to() : mill.shank().to();
}

Result<Compliance> compliance(const tool::Profile& mill, double load_mm, double at_mm, const Elasticity& of) {
  const double clamp = clamped_at(mill);
  for (const double h : {load_mm, at_mm})
    if (!(h > 0 && h < clamp))
      return fail("a force at {:.4f} mm above the tip does not act between the tip and the holder, 0 to {:.4f} mm", h,
                  clamp);
  Compliance sum;
  add(sum, mill.cutting(), of.flute_share, load_mm, at_mm, of);
  add(sum, mill.shank(), 1, load_mm, at_mm, of);
  if (!std::isfinite(sum.total()))
    return fail("the tool has no radius somewhere between {:.4f} mm above its tip and its holder at {:.4f} mm",
                std::max(load_mm, at_mm), clamp);
  return sum;
}

}  // namespace toothpath::force
