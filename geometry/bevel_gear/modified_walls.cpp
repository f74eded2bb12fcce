#include "geometry/bevel_gear/modified_walls.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/modification/separate.h"

namespace toothpath::bevel_gear {
namespace {

using modification::Modification;
using modification::Separate;

constexpr double kMostTurned = 0.1;  // rad: of a normal by modifications; beyond it amounts are no small offsets
constexpr double kMostMixed = 1e-6;  // mm: of a grid that is no sum, left out as nothing
constexpr int kLooks = 512;          // places along profile and path

template <typename... Args>
std::optional<Refusal> refuse(std::string key, fmt::format_string<Args...> text, Args&&... args) {
  return Refusal{std::move(key), fail(text, std::forward<Args>(args)...)};
}

/// Side of a flank as modifications count it: seen from the large end with the tips up, U is the right one.
int side_of(int sigma) { return -sigma; }

}  // namespace

modification::Rectangle rectangle_of(const BevelGearParameters& p, double from, double to) {
  return {2 * p.addendum_mm, from, to};
}

modification::Rectangle rectangle_of(const BevelGear& gear, int zone) {
  const BevelGearParameters& p = gear.parameters();
  if (p.form == BevelForm::single) return rectangle_of(p, gear.R_i(), gear.R_e());
  const double w = p.relief_half_width_mm;
  return zone == 0 ? rectangle_of(p, gear.R_i(), gear.R_ref() - w) : rectangle_of(p, gear.R_ref() + w, gear.R_e());
}

std::shared_ptr<const ProfileLaw> profile_law(const BevelGearParameters& p) {
  ProfileLaw law;
  const modification::Rectangle on = rectangle_of(p, 0, 1);  // the face does not matter
  for (const Modification& m : p.modifications) {
    if (m.amount_mm == 0 || m.kind == modification::Kind::end_relief) continue;
    if (modification::refused({m}, m.zone.value_or(0), on)) return nullptr;
    for (auto& curve : separate(m, on).over_depth) law.removed.curves.push_back(std::move(curve));
  }
  if (law.removed.curves.empty()) return nullptr;
  law.tip_mm = p.addendum_mm;
  for (const auto& curve : law.removed.curves) law.bent_to = std::max(law.bent_to, curve.bent_to());
  return std::make_shared<const ProfileLaw>(std::move(law));
}

std::shared_ptr<const LeadLaw> lead_law(const BevelGearParameters& p, int sigma, int zone,
                                        const modification::Rectangle& on, const FingerProfile<double>& cutter) {
  LeadLaw law;
  for (const Modification& m : p.modifications) {
    if (m.amount_mm == 0 || !m.meets(side_of(sigma), zone)) continue;
    for (auto& curve : separate(m, on).over_face) law.removed.curves.push_back(std::move(curve));
  }
  if (law.removed.curves.empty()) return nullptr;
  // The plain profile at p = 0, on the pitch circle of the equivalent gear.
  law.per_normal = 1 / std::cos(cutter.alpha_n + cutter.kappa_v * cutter.r_0);
  return std::make_shared<const LeadLaw>(std::move(law));
}

std::optional<Refusal> refused_modification(const BevelGearParameters& p, int zone, int zones,
                                            const modification::Rectangle& on) {
  if (auto refusal = modification::refused(p.modifications, zone, on)) return refusal;
  for (std::size_t k = 0; k < p.modifications.size(); ++k) {
    const Modification& m = p.modifications[k];
    if (m.amount_mm == 0 || (m.zone && *m.zone != zone)) continue;
    const auto key = [&](const char* name) { return fmt::format("modification[{}].{}", k, name); };
    const Separate parts = separate(m, on);
    if (m.kind == modification::Kind::twist)
      return refuse(key("kind"),
                    "twist of {:g} mm changes along the face with the depth, the limit is 0: the finger mill has one "
                    "profile, stands square to the pitch cone and takes a sum of one removal over the depth and one "
                    "along the face; crowning, slopes or reliefs would do",
                    m.amount_mm);
    if (parts.mixed_mm > kMostMixed)
      return refuse(key("file"),
                    "the grid is no sum of one removal over the depth and one along the face, which is all that a "
                    "finger mill takes: {:.4g} mm are left at depth {:.4f} mm, cone distance {:.4f} mm, the limit is "
                    "{:g}; equal rows, equal columns or their sum would do",
                    parts.mixed_mm, parts.depth_mm, parts.along_mm, kMostMixed);
    if (parts.over_depth.empty()) continue;
    if (m.flanks != modification::Flanks::both)
      return refuse(key("flank"),
                    "flank = \"{}\", but {} is made by the profile of the finger mill, and one mill cuts both flanks; "
                    "flank = \"both\", or a modification along the face would do",
                    to_string(m.flanks), to_string(m.kind));
    if (m.zone && zones > 1)
      return refuse(key("zone"),
                    "zone = {}, but {} is made by the profile of the finger mill, and one mill cuts both halves; no "
                    "zone, or a modification along the face would do",
                    *m.zone, to_string(m.kind));
  }
  return std::nullopt;
}

std::optional<Refusal> refused_profile(const FingerProfile<double>& c) {
  if (!c.law) return std::nullopt;
  double turned = 0, turned_at = 0, leans = kPi, leans_at = 0;
  for (int k = 0; k <= kLooks; ++k) {
    const double p = c.p_C + (c.p_D - c.p_C) * k / kLooks;
    // The plain profile and how far it may go before it folds: the radius of its hollow.
    const bool on_involute = p >= c.plain_p_C;
    const ProfilePoint<double> plain =
        on_involute ? c.involute(p)
                    : ProfilePoint<double>{
                          c.plain_x_C + (p - c.plain_p_C) * c.plain_cos_phi, 0, c.plain_sin_phi, c.plain_cos_phi, 0, 1};
    const double depth = c.law->tip_mm - plain.x, taken = c.law->removed.derivative(depth, 0);
    if (!(plain.dS > taken * plain.dpsi))
      return refuse(
          "modification",
          "the modifications take {:.4f} mm at depth {:.4f} mm, not below {:.4f} mm, the radius of the hollow "
          "flank of the mill there: its profile would fold; less amount, or less rack_depth of the mill",
          taken, depth, plain.dS / plain.dpsi);
    const ProfilePoint<double> q = c.flank(p);
    const double turn = std::abs(std::atan2(q.sin_psi * plain.cos_psi - q.cos_psi * plain.sin_psi,
                                            q.cos_psi * plain.cos_psi + q.sin_psi * plain.sin_psi));
    if (turn > turned) turned = turn, turned_at = depth;
    const double psi = std::atan2(q.sin_psi, q.cos_psi);
    if (psi < leans) leans = psi, leans_at = depth;
  }
  if (turned > kMostTurned)
    return refuse("modification",
                  "the modifications turn the normal of the flanks by {:.4f} rad at depth {:.4f} mm, limit {:g}: a "
                  "longer length or less amount would do",
                  turned, turned_at, kMostTurned);
  if (leans < 0)
    return refuse(
        "modification",
        "the modifications make the profile of the mill lean inwards, {:.4f} deg at depth {:.4f} mm, must not "
        "be negative: it could not be retracted along its axis; a longer length or less amount would do",
        degrees(leans), leans_at);
  return std::nullopt;
}

std::optional<Refusal> refused_path(const BevelTrace<double>& t, double R_from, double R_to) {
  if (!t.lead[0] && !t.lead[1]) return std::nullopt;
  for (int k = 0; k <= kLooks; ++k) {
    const double R = R_from + (R_to - R_from) * k / kLooks, beta = t.beta(R);
    double both = 0;
    for (const int sigma : {1, -1}) {
      const PathDistance<double> off = t.distance(sigma, beta);
      both += t.r_0 - off.d;
      if (const double turn = std::atan(std::abs(off.slope)); turn > kMostTurned)
        return refuse("modification",
                      "the modifications turn wall {} by {:.4f} rad at cone distance {:.4f} mm, limit {:g}: a longer "
                      "length or less amount would do",
                      sigma > 0 ? "L" : "U", turn, R, kMostTurned);
    }
    const double room = 2 * (R * t.e_h * t.sin_delta * std::cos(beta) - t.r_0) + both;
    if (room < 0)
      return refuse("modification",
                    "the modifications leave a space {:.4f} mm narrower than the mill at cone distance {:.4f} mm, must "
                    "not be negative: less added material or a mill of less module would do",
                    -room, R);
  }
  return std::nullopt;
}

ModifiedForm modified_form(const BevelGear& gear) {
  ModifiedForm form;
  const auto& c = gear.cutter();
  if (c.law)
    for (int k = 0; k <= kLooks; ++k) {
      const double depth = 2 * gear.parameters().addendum_mm * k / kLooks;
      form.profile_mm = std::max(form.profile_mm, c.law->removed.derivative(depth, 0));
      form.profile_turned_rad =
          std::max(form.profile_turned_rad, std::atan(std::abs(c.law->removed.derivative(depth, 1))));
    }
  for (const BevelHalf& half : gear.halves())
    for (int k = 0; k < 2; ++k)
      if (const auto& law = half.walls[k].trace.lead[k])
        for (int n = 0; n <= kLooks; ++n) {
          const double R = half.ell_from + (half.ell_to - half.ell_from) * n / kLooks;
          form.lead_mm = std::max(form.lead_mm, law->removed.derivative(R, 0));
          form.lead_turned_rad = std::max(form.lead_turned_rad, std::atan(std::abs(law->removed.derivative(R, 1))));
        }
  return form;
}

}  // namespace toothpath::bevel_gear
