#include "geometry/modification/modification.h"

#include <cmath>

namespace toothpath::modification {
namespace {

constexpr double kMostAmount = 0.1;        // of the depth
constexpr double kLeastTransition = 0.01;  // mm
constexpr std::size_t kLeastLines = 3;

template <std::size_t N>
const char* name(const std::array<const char*, N>& names, std::size_t k) {
  return k < N ? names[k] : "";
}

/// From `amount` at 0 to nothing at `length`, which is C1: a kink is rounded over `transition` about its place.
SmoothCurve relief(const Modification& m, double span) {
  const double C = m.amount_mm, L = m.length_mm;
  using Piece = SmoothCurve::Piece;
  const Piece nothing{0, {}};
  std::vector<double> knots{0};
  std::vector<Piece> pieces;
  if (m.law == Law::parabolic) {
    knots.push_back(L);
    pieces.push_back({L, {0, 0, C / (L * L)}});
  } else {
    const double half = 0.5 * m.transition();
    if (L > half) {
      knots.push_back(L - half);
      pieces.push_back({L, {0, -C / L}});
    }
    knots.push_back(L + half);
    pieces.push_back({L + half, {0, 0, C / (4 * half * L)}});
  }
  if (knots.back() < span) {
    knots.push_back(span);
    pieces.push_back(nothing);
  }
  return {std::move(knots), std::move(pieces)};
}

/// C at both ends of [0, span], nothing in the middle; negative: -C in the middle.
SmoothCurve crowning(double C, double span) {
  const double middle = 0.5 * span;
  return {{0, span}, {{middle, {C < 0 ? -C : 0, 0, C / (middle * middle)}}}};
}

/// From -1 at 0 to 1 at the other end.
SmoothCurve ramp(double span) { return {{0, span}, {{0.5 * span, {0, 2 / span}}}}; }

/// Nothing at one end, the amount at the end that its sign says.
SmoothCurve slope(double at_start, double span) {
  const double C = std::abs(at_start);
  return {{0, span}, {{0, {at_start > 0 ? C : 0, -at_start / span}}}};
}

SmoothCurve shifted(const SmoothCurve& curve, double by) {
  // Turned over twice: x -> -x -> by + x.
  return curve.mirrored(0).mirrored(by);
}

bool rises(const std::vector<double>& x) {
  for (std::size_t k = 1; k < x.size(); ++k)
    if (!(x[k] > x[k - 1])) return false;
  return true;
}

std::optional<Refusal> refused_grid(const Grid& g, const Rectangle& on, const auto& refuse) {
  if (g.depth_mm.size() < kLeastLines || g.along_mm.size() < kLeastLines)
    return refuse("file", fail("the grid has {} depths and {} radii, at least {} of each are needed", g.depth_mm.size(),
                               g.along_mm.size(), kLeastLines));
  if (!rises(g.depth_mm) || !rises(g.along_mm) || g.removal_mm.size() != g.depth_mm.size() * g.along_mm.size())
    return refuse("file", fail("the grid is no rectangle of rising depths and radii"));
  for (const double v : g.removal_mm)
    if (!(std::abs(v) <= kMostAmount * on.depth_mm))
      return refuse("file", fail("a removal of {:g} mm exceeds a tenth of the depth of the flank, {:.4g} mm", v,
                                 kMostAmount * on.depth_mm));
  return std::nullopt;
}

}  // namespace

const char* to_string(Kind kind) {
  return name<kKinds>({"tip_relief", "root_relief", "end_relief", "profile_crowning", "lead_crowning",
                       "pressure_angle_slope", "helix_angle_slope", "twist", "grid"},
                      std::size_t(kind));
}
const char* to_string(Law law) { return law == Law::linear ? "linear" : "parabolic"; }
const char* to_string(Flanks flanks) { return name<3>({"both", "left", "right"}, std::size_t(flanks)); }
const char* to_string(Ends ends) { return name<3>({"both", "inner", "outer"}, std::size_t(ends)); }

std::optional<Refusal> refused(const std::vector<Modification>& modifications, int zone, const Rectangle& on) {
  for (std::size_t k = 0; k < modifications.size(); ++k) {
    const Modification& m = modifications[k];
    if (m.zone && *m.zone != zone) continue;
    const auto refuse = [&](const char* key, Diagnostic why) {
      return std::optional(Refusal{fmt::format("modification[{}].{}", k, key), std::move(why)});
    };
    const double most = kMostAmount * on.depth_mm;
    if (m.grid) {
      if (auto r = refused_grid(*m.grid, on, refuse)) return r;
      continue;
    }
    if (!(std::abs(m.amount_mm) <= most))
      return refuse("amount",
                    fail("amount = {:g} mm exceeds a tenth of the depth of the flank, {:.4g} mm", m.amount_mm, most));
    if (!is_relief(m.kind)) continue;
    if (m.amount_mm < 0)
      return refuse("amount", fail("amount = {:g} mm is below 0: a relief takes material", m.amount_mm));
    const bool over_face = m.kind == Kind::end_relief;
    const double span = over_face ? on.face() * (m.ends == Ends::both ? 0.5 : 1) : on.depth_mm;
    const char* what = !over_face             ? "the depth of the active flank"
                       : m.ends == Ends::both ? "half the face, as both ends are relieved"
                                              : "the face";
    if (!(m.length_mm > 0) || !(m.length_mm <= span))
      return refuse("length",
                    fail("length = {:g} mm is not above 0 and at most {:.4g} mm, {}", m.length_mm, span, what));
    if (m.law != Law::linear) continue;
    const double transition = m.transition();
    if (!(transition >= kLeastTransition) || !(transition <= 2 * m.length_mm) ||
        !(m.length_mm + 0.5 * transition <= span))
      return refuse(
          m.transition_mm ? "transition" : "length",
          fail("transition = {:g} mm: its kink is rounded over {:g} mm at least and {:.4g} mm at most (twice "
               "the length, and half of it within {:.4g} mm, {})",
               transition, kLeastTransition, std::min(2 * m.length_mm, 2 * (span - m.length_mm)), span, what));
  }
  return std::nullopt;
}

std::vector<Refusal> refused_zones(const std::vector<Modification>& modifications, int zones) {
  std::vector<Refusal> out;
  for (std::size_t k = 0; k < modifications.size(); ++k)
    if (const auto zone = modifications[k].zone; zone && (*zone < 0 || *zone >= zones))
      out.push_back({fmt::format("modification[{}].zone", k),
                     fail("zone = {} is not below {}, the number of zones", *zone, zones)});
  return out;
}

Field::Field(const std::vector<Modification>& modifications, int side, int zone, const Rectangle& on) : on_(on) {
  for (const Modification& m : modifications)
    if (m.meets(side, zone)) add(m);
}

void Field::add(const Modification& m) {
  if (m.grid) return add_grid(*m.grid, m.amount_mm);
  const double C = m.amount_mm, depth = on_.depth_mm, face = on_.face();
  if (C == 0) return;
  const SmoothCurve one(1);
  const auto from_inner = [&](const SmoothCurve& curve) { return shifted(curve, on_.from_mm); };
  const auto from_outer = [&](const SmoothCurve& curve) { return curve.mirrored(on_.to_mm); };
  switch (m.kind) {
    case Kind::tip_relief: terms_.push_back({relief(m, depth), one}); break;
    case Kind::root_relief: terms_.push_back({relief(m, depth).mirrored(depth), one}); break;
    case Kind::end_relief:
      if (m.ends != Ends::outer) terms_.push_back({one, from_inner(relief(m, face))});
      if (m.ends != Ends::inner) terms_.push_back({one, from_outer(relief(m, face))});
      break;
    case Kind::profile_crowning: terms_.push_back({crowning(C, depth), one}); break;
    case Kind::lead_crowning: terms_.push_back({one, from_inner(crowning(C, face))}); break;
    case Kind::pressure_angle_slope: terms_.push_back({slope(C, depth), one}); break;
    case Kind::helix_angle_slope: terms_.push_back({one, from_outer(slope(C, face))}); break;
    case Kind::twist:
      terms_.push_back({SmoothCurve(0.5 * std::abs(C)), one});
      terms_.push_back({ramp(depth).times(-0.5 * C), from_inner(ramp(face))});
      break;
    case Kind::grid: break;
  }
}

/// A grid is the sum over its depths of the spline that is 1 there and 0 at all other depths, times the spline of its
/// removals along the face.
void Field::add_grid(const Grid& g, double factor) {
  const std::size_t width = g.along_mm.size();
  for (std::size_t k = 0; k < g.depth_mm.size(); ++k) {
    std::vector<double> unit(g.depth_mm.size(), 0.0), row(width);
    unit[k] = 1;
    bool any = false;
    for (std::size_t n = 0; n < width; ++n) {
      row[n] = factor * g.removal_mm[k * width + n];
      any |= row[n] != 0;
    }
    if (any) terms_.push_back({SmoothCurve::spline(g.depth_mm, unit), SmoothCurve::spline(g.along_mm, row)});
  }
}

}  // namespace toothpath::modification
