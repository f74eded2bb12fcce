// Modified flanks once more, straight from the words of docs/modifications.md: a point of the plain flank less what its
// modifications take along the normal. Shares no code with the fields of the program; grids are left out.
#pragma once

#include <vector>

#include "geometry/face_gear/surface.h"
#include "geometry/modification/modification.h"

namespace toothpath::test {

[[nodiscard]] inline modification::Modification modification_of(modification::Kind kind, double amount_mm,
                                                                double length_mm = 0,
                                                                modification::Law law = modification::Law::parabolic) {
  modification::Modification m;
  m.kind = kind;
  m.amount_mm = amount_mm;
  m.length_mm = length_mm;
  m.law = law;
  return m;
}

/// Taken at depth y and place x along a face from `from` to `to`; `depth` is that of the active flank. mm
template <typename S>
S taken_by_the_words(const modification::Modification& m, const S& y, const S& x, double depth, double from,
                     double to) {
  using modification::Ends;
  using modification::Kind;
  const S C(m.amount_mm), L(m.length_mm), size = C < S(0) ? S(-C) : C;
  const auto relief = [&](const S& t) -> S {  // t from the relieved end
    if (m.law == modification::Law::parabolic) {
      if (t > L) return S(0);
      return t < S(0) ? S(C * (1 - 2 * t / L)) : S(C * (L - t) * (L - t) / (L * L));
    }
    const S w(m.transition());
    if (t <= L - w / 2) return C * (L - t) / L;
    return t >= L + w / 2 ? S(0) : S(C * (L + w / 2 - t) * (L + w / 2 - t) / (2 * w * L));
  };
  const auto crown = [&](const S& t, const S& span) -> S {  // the tangent beyond the ends
    const S u = 2 * t / span - 1, s = u < S(0) ? S(-u) : u;
    const S square = s > S(1) ? S(2 * s - 1) : S(s * s);
    return C < S(0) ? S(size * (1 - square)) : S(C * square);
  };
  const S H(depth), a(from), b(to), face = b - a;
  switch (m.kind) {
    case Kind::tip_relief: return relief(y);
    case Kind::root_relief: return relief(S(H - y));
    case Kind::end_relief:
      return S(m.ends == Ends::outer ? S(0) : relief(S(x - a))) + S(m.ends == Ends::inner ? S(0) : relief(S(b - x)));
    case Kind::profile_crowning: return crown(y, H);
    case Kind::lead_crowning: return crown(S(x - a), face);
    case Kind::pressure_angle_slope: return C > S(0) ? S(C * (1 - y / H)) : S(size * y / H);
    case Kind::helix_angle_slope: return C > S(0) ? S(C * (x - a) / face) : S(size * (b - x) / face);
    case Kind::twist: return size / 2 + C / 2 * (1 - 2 * y / H) * (2 * (x - a) / face - 1);
    case Kind::grid: break;
  }
  return S(0);
}

/// The point (theta, B) of the flank of side s of tooth 0 with all modifications of one zone.
template <typename S>
Vec3T<S> modified_by_the_words(const face_gear::FaceGearSurface<S>& f, const face_gear::FaceGearParameters& gear,
                               int zone, int s, const S& theta, const S& B) {
  using std::sqrt;
  const auto q = f.flank(s, theta, B);
  const S r = sqrt(S(q.p[0] * q.p[0] + q.p[1] * q.p[1])), y = (f.z_tip(r) - q.p[2]) * f.Sg;
  const auto& on = gear.zones[static_cast<std::size_t>(zone)];
  S taken(0);
  for (const auto& m : gear.modifications)
    if (m.meets(s, zone))
      taken += taken_by_the_words<S>(m, y, r, 2 * gear.addendum_coefficient * gear.module_mm, on.inner_radius_mm,
                                     on.outer_radius_mm);
  return q.p - q.n * taken;
}

}  // namespace toothpath::test
