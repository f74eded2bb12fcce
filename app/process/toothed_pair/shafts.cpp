#include "app/process/toothed_pair/shafts.h"

#include <cmath>
#include <utility>

#include "geometry/base/angle.h"
#include "geometry/bevel_gear/limits.h"
#include "geometry/face_gear/space_sheet.h"

namespace toothpath::toothed_pair {
namespace {

using Refused = std::vector<Diagnostic>;

/// Share of a pitch cone, or of a base pitch, by which two gears may differ and still mesh.
constexpr double kFits = 1e-3;
/// How far shafts may stand beside the angle at which the teeth of both lie along each other.
constexpr double kBesideParallel = radians(1), kBesideSkew = radians(5);

contact::MatePlace outside(const Shafts& shafts, const JobGear&, const JobGear&, const contact::Misalignment& moved) {
  contact::Misalignment of_carrier = moved;
  if (shafts.pinion_carries) std::swap(of_carrier.axial_mm, of_carrier.gear_axial_mm);
  contact::OutsideShafts at;
  at.angle_rad = shafts.angle_rad;
  at.distance_mm = shafts.distance_mm;
  at.skew = shafts.skew;
  return contact::outside_place(at, of_carrier);
}
contact::MatePlace on_face_gear(const Shafts& shafts, const JobGear& carrier, const JobGear& other,
                                const contact::Misalignment& moved) {
  const JobGear &face = shafts.pinion_carries ? other : carrier, &pinion = shafts.pinion_carries ? carrier : other;
  const auto& sheet = dynamic_cast<const face_gear::SpaceSheet&>(face.part->space(0));
  const contact::MatePlace place = contact::pinion_place(sheet.surface(), pinion.part->teeth(), moved);
  return shafts.pinion_carries ? contact::seen_from_mate(place) : place;
}

/// What the keys of a gear say of its shaft.
struct Cone {
  std::optional<double> pitch_angle_rad, shaft_angle_rad;
};
std::optional<Cone> cone_of(const job::Job& job) {
  if (const auto* g = job.straight_bevel_gear()) return Cone{g->pitch_angle_rad, std::nullopt};
  if (const auto* g = std::get_if<spiral_bevel::SpiralBevelParameters>(&job.gear))
    return Cone{g->pitch_angle_rad, g->shaft_angle_rad};
  if (const auto* g = job.bevel_gear())
    return Cone{bevel_gear::bevel_pitch_angle(*g),
                g->mate_teeth > 0 ? std::optional(g->shaft_angle_rad) : std::nullopt};
  if (std::holds_alternative<flank_grid::FlankGridParameters>(job.gear)) return Cone{};
  return std::nullopt;
}

/// Transverse, on the reference cylinder.
struct Rolling {
  double radius_mm = 0, base_mm = 0, shift_mm = 0, helix_rad = 0;
  double base_helix_rad = 0;
  [[nodiscard]] double normal_base_pitch(int teeth) const {
    return kTwoPi * base_mm / teeth * std::cos(base_helix_rad);
  }
};
/// Of a cylindrical gear, or of the shaper of a face gear.
template <typename P>
Rolling rolling_of(const P& p, int teeth, double beta, double shift_mm) {
  const double wide = p.module_plane == ModulePlane::normal ? 1 / std::cos(beta) : 1;
  const double r = 0.5 * p.module_mm * wide * teeth, alpha = std::atan(std::tan(p.pressure_angle_rad) * wide);
  return {r, r * std::cos(alpha), shift_mm, beta, std::atan(std::tan(beta) * std::cos(alpha))};
}
Rolling rolling_of(const cylindrical::CylindricalParameters& p, std::size_t zone = 0) {
  return rolling_of(p, p.teeth, p.zones[zone].helix_angle_rad, p.profile_shift * p.module_mm);
}

/// A face gear runs with what its shaper would run with: every zone has one of the pinion.
std::optional<Diagnostic> refused_pinion(const JobGear& face, const JobGear& pinion) {
  const auto& f = *face.job.face_gear();
  const auto& p = *pinion.job.cylindrical_gear();
  for (std::size_t k = 0; k < f.zones.size(); ++k) {
    const Rolling shaper = rolling_of(f, f.shaper_teeth, f.zones[k].helix_angle_rad, 0);
    std::optional<std::size_t> along;
    for (std::size_t n = 0; n < p.zones.size(); ++n)
      if (std::abs(p.zones[n].helix_angle_rad - shaper.helix_rad) < kBesideParallel) along = n;
    if (!along)
      return fail_at(pinion.job.where("gear.zone"),
                     "no zone has a helix_angle of {:g} deg, that of zone {} of the face gear and of its shaper",
                     degrees(shaper.helix_rad), k);
    const double wanted = shaper.normal_base_pitch(f.shaper_teeth),
                 pitch = rolling_of(p, *along).normal_base_pitch(p.teeth);
    if (std::abs(pitch - wanted) > kFits * wanted)
      return fail_at(
          pinion.job.where("gear.module"),
          "the normal base pitch, {:.5f} mm, is not that of the face gear, {:.5f} mm: module, pressure angle "
          "and helix angle must be those of its shaper",
          pitch, wanted);
  }
  return {};
}

/// The distance at which thicknesses and spaces of the drawings, without allowances, leave no backlash.
std::optional<double> distance_without_backlash(const Rolling& a, const Rolling& b) {
  const double alpha = std::acos(a.base_mm / a.radius_mm),
               wanted =
                   std::tan(alpha) - alpha + (a.shift_mm + b.shift_mm) * std::tan(alpha) / (a.radius_mm + b.radius_mm);
  if (!(wanted > 0)) return std::nullopt;
  double working = alpha;
  for (int k = 0; k < 50; ++k) {
    const double slope = std::tan(working) * std::tan(working);
    working -= (std::tan(working) - working - wanted) / slope;
    if (!(working > 1e-3)) working = 1e-3;
  }
  return (a.base_mm + b.base_mm) / std::cos(working);
}

process::ValueOrErrors<Shafts> cylinders(const JobGear& gear, const JobGear& pinion, const process::ContactAsked& asked,
                                         Shafts out) {
  const auto &g = *gear.job.cylindrical_gear(), &p = *pinion.job.cylindrical_gear();
  const Rolling a = rolling_of(g), b = rolling_of(p);
  const double asked_rad = radians(std::abs(asked.shaft_angle_deg.value_or(0))), along = a.helix_rad + b.helix_rad;
  out.skew = asked_rad != 0;
  if (out.skew && (g.zones.size() > 1 || p.zones.size() > 1))
    return Refused{fail_at((g.zones.size() > 1 ? gear : pinion).job.where("gear.zone"),
                           "--shaft-angle {:g}: teeth of two helix angles lie along those of a mate on parallel shafts "
                           "alone",
                           *asked.shaft_angle_deg)};
  // On parallel shafts both helices have one lead a base pitch; on crossed ones normal base pitches do it.
  const auto base_pitch = [&](const Rolling& r, const JobGear& of) {
    return out.skew ? r.normal_base_pitch(of.part->teeth()) : kTwoPi * r.base_mm / of.part->teeth();
  };
  const double pitch_a = base_pitch(a, gear), pitch_b = base_pitch(b, pinion);
  if (std::abs(pitch_a - pitch_b) > kFits * pitch_a)
    return Refused{
        fail_at(pinion.job.where("gear.module"),
                "the {}base pitch, {:.5f} mm, is not that of the mate, {:.5f} mm: {} of both must agree",
                out.skew ? "normal " : "", pitch_b, pitch_a,
                out.skew ? "normal module and normal pressure angle" : "module, pressure angle and helix angle")};
  if (std::abs(std::abs(along) - asked_rad) > (out.skew ? kBesideSkew : kBesideParallel))
    return Refused{fail_at(pinion.job.where("gear.zone[0].helix_angle"),
                           "helix_angle = {:g} deg and {:g} deg of the mate: the teeth lie along each other on shafts "
                           "at {:g} deg, not {:g}; --shaft-angle DEG says at which these stand",
                           degrees(b.helix_rad), degrees(a.helix_rad), degrees(std::abs(along)), degrees(asked_rad))};
  if (out.skew) out.angle_rad = along > 0 ? -asked_rad : asked_rad;
  const bool plain = std::abs(a.shift_mm + b.shift_mm) < 1e-9;
  const auto found = asked.axis_distance_mm ? asked.axis_distance_mm
                     : !out.skew            ? distance_without_backlash(a, b)
                     : plain                ? std::optional(a.radius_mm + b.radius_mm)
                                            : std::nullopt;
  if (!found)
    return Refused{fail_at(pinion.job.where("gear.profile_shift"), "{}: --axis-distance MM says where the shafts stand",
                           out.skew ? "the profile shifts of both are no plus and minus, and the distance of crossed "
                                      "shafts is not found then"
                                    : "these profile shifts leave no distance without backlash")};
  out.distance_mm = *found;
  return out;
}

process::ValueOrErrors<Shafts> crossing(const JobGear& gear, const JobGear& pinion, const Cone& a, const Cone& b,
                                        const process::ContactAsked& asked, Shafts out) {
  out.distance_mm = asked.axis_distance_mm.value_or(0);
  const auto key = a.shaft_angle_rad ? a.shaft_angle_rad : b.shaft_angle_rad;
  if (a.shaft_angle_rad && b.shaft_angle_rad && std::abs(*a.shaft_angle_rad - *b.shaft_angle_rad) > 1e-6)
    return Refused{fail_at(pinion.job.where("gear.shaft_angle"), "shaft_angle = {:g} deg, but {:g} deg of the mate",
                           degrees(*b.shaft_angle_rad), degrees(*a.shaft_angle_rad))};
  if (asked.shaft_angle_deg) out.angle_rad = radians(*asked.shaft_angle_deg);
  else if (key) out.angle_rad = *key;
  else if (a.pitch_angle_rad && b.pitch_angle_rad) out.angle_rad = *a.pitch_angle_rad + *b.pitch_angle_rad;
  else
    return Refused{fail_at((a.pitch_angle_rad ? pinion : gear).job.where("gear.type"),
                           "type = \"{}\" says no shaft angle, and its mate none for it: --shaft-angle DEG is needed",
                           (a.pitch_angle_rad ? pinion : gear).job.gear_type())};
  if (a.pitch_angle_rad && b.pitch_angle_rad && out.distance_mm == 0) {
    const double rolls = std::sin(*a.pitch_angle_rad) * pinion.part->teeth(),
                 with = std::sin(*b.pitch_angle_rad) * gear.part->teeth();
    if (std::abs(rolls - with) > kFits * with)
      return Refused{
          fail_at(pinion.job.where("gear.teeth"),
                  "pitch angles {:.5f} and {:.5f} deg do not roll on each other with {} and {} teeth: the sines must "
                  "be as the teeth",
                  degrees(*b.pitch_angle_rad), degrees(*a.pitch_angle_rad), pinion.part->teeth(), gear.part->teeth())};
    if (const double sum = *a.pitch_angle_rad + *b.pitch_angle_rad; std::abs(sum - out.angle_rad) > kBesideParallel)
      return Refused{fail_at(pinion.job.where("gear.pitch_angle"),
                             "pitch angles {:.5f} and {:.5f} deg add up to {:.5f} deg, the shafts stand at {:g} deg",
                             degrees(*b.pitch_angle_rad), degrees(*a.pitch_angle_rad), degrees(sum),
                             degrees(out.angle_rad))};
  }
  const auto *spiral = gear.job.spiral_bevel_gear(), *with = pinion.job.spiral_bevel_gear();
  if (spiral && with && spiral->hand == with->hand)
    return Refused{fail_at(pinion.job.where("gear.hand"),
                           "hand = \"{}\" is that of the mate, too: teeth that mesh from outside have both hands",
                           with->hand > 0 ? "right" : "left")};
  return out;
}

}  // namespace

process::ValueOrErrors<Shafts> shafts_of(const JobGear& job, const JobGear& mate, const process::ContactAsked& asked) {
  Shafts out;
  const bool face = job.job.face_gear() != nullptr, other_face = mate.job.face_gear() != nullptr;
  const bool job_is_larger = face != other_face ? face : job.part->teeth() >= mate.part->teeth();
  out.pinion_carries = !job_is_larger && (asked.as_cut || !asked.measured.files.empty());
  out.job_is_gear = job_is_larger || out.pinion_carries;
  const JobGear &gear = job_is_larger ? job : mate, &pinion = job_is_larger ? mate : job;
  const auto a = cone_of(gear.job), b = cone_of(pinion.job);
  const bool cylinder = pinion.job.cylindrical_gear() != nullptr;
  if (face || other_face) {
    if (!cylinder && !(b && !b->pitch_angle_rad))
      return Refused{fail_at(pinion.job.where("gear.type"),
                             "type = \"{}\" does not run with a face gear: a cylindrical_gear or a flank_grid does",
                             pinion.job.gear_type())};
    if (asked.shaft_angle_deg || asked.axis_distance_mm)
      return Refused{fail_at(gear.job.where("gear"),
                             "--shaft-angle and --axis-distance: the face gear says them, as shaft_angle and offset")};
    if (cylinder)
      if (auto refused = refused_pinion(gear, pinion)) return Refused{std::move(*refused)};
    out.angle_rad = gear.job.face_gear()->shaft_angle_rad;
    out.distance_mm = gear.job.face_gear()->offset_mm;
    out.place = on_face_gear;
    return out;
  }
  out.place = outside;
  if (cylinder && gear.job.cylindrical_gear() != nullptr) return cylinders(gear, pinion, asked, out);
  if (a && b) return crossing(gear, pinion, *a, *b, asked, out);
  const JobGear& other = cylinder ? gear : pinion;
  if (const auto grid = cone_of(other.job); !grid || grid->pitch_angle_rad)
    return Refused{fail_at(other.job.where("gear.type"), "type = \"{}\" does not run with a {}", other.job.gear_type(),
                           (cylinder ? pinion : gear).job.gear_type())};
  if (!asked.shaft_angle_deg || !asked.axis_distance_mm)
    return Refused{
        fail_at(other.job.where("gear.type"),
                "type = \"flank_grid\" with a cylindrical gear: --shaft-angle DEG and --axis-distance MM say "
                "how the shafts stand")};
  out.angle_rad = radians(*asked.shaft_angle_deg);
  out.distance_mm = *asked.axis_distance_mm;
  return out;
}

}  // namespace toothpath::toothed_pair
