#include "geometry/face_gear/gear.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/base/refusals.h"
#include "geometry/face_gear/flank_field.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/reference_radius.h"
#include "geometry/face_gear/space_sheet.h"
#include "geometry/face_gear/swept_solid.h"

namespace toothpath::face_gear {
namespace {

constexpr double kLeastShaftAngleDeg = 60, kMostShaftAngleDeg = 120;
constexpr int kLeastTeeth = 4, kMostShaperTeeth = 1000, kMostTeeth = 10000;

/// Collects the refusals of one gear.
class Inspection : public Refusals {
 public:
  explicit Inspection(const FaceGearParameters& gear) : gear_(gear) {}

  void numbers();
  void zone_numbers();
  void modified_zones();
  void shaper(std::size_t zone);
  void land_over_zone(std::size_t zone, const FaceGearRing& r);
  void swept_flank(std::size_t zone, const FaceGearRing& r);
  void ring(std::size_t zone, const FaceGearRing& r, std::vector<std::string>& warnings);
  void groove(const std::vector<FaceGearRing>& rings, std::vector<std::string>& warnings);
  void modify(std::size_t zone, const FaceGearParameters& gear, FaceGearRing& r, std::vector<std::string>& warnings);

 private:
  const FaceGearParameters& gear_;
};

void Inspection::numbers() {
  integer_range("shaper_teeth", gear_.shaper_teeth, kLeastTeeth, kMostShaperTeeth);
  integer_range("teeth", gear_.teeth, kLeastTeeth, kMostTeeth);
  if (refusals.empty() && gear_.teeth < gear_.shaper_teeth)
    refuse("teeth", "teeth = {} is below shaper_teeth = {}: the face gear has the larger count", gear_.teeth,
           gear_.shaper_teeth);
  if (gear_.mate_teeth != 0) {
    integer_range("mate_teeth", gear_.mate_teeth, 3, kMostShaperTeeth);
    if (gear_.mate_teeth > gear_.shaper_teeth)
      refuse("mate_teeth", "mate_teeth = {} exceeds shaper_teeth = {}: a pinion larger than the shaper interferes",
             gear_.mate_teeth, gear_.shaper_teeth);
  }
  range("module", gear_.module_mm, 0.05, 100, " mm");
  range("pressure_angle", degrees(gear_.pressure_angle_rad), 5, 45, " deg");
  range("addendum_coefficient", gear_.addendum_coefficient, 0.1, 2, "");
  range("clearance_coefficient", gear_.clearance_coefficient, 0, 1, "");
  const double gamma = degrees(gear_.shaft_angle_rad);
  if (!(gamma >= kLeastShaftAngleDeg - 1e-9 && gamma <= kMostShaftAngleDeg + 1e-9))
    refuse("shaft_angle", "shaft_angle = {:.6g} deg is outside [{:g}, {:g}] deg", gamma, kLeastShaftAngleDeg,
           kMostShaftAngleDeg);
  if (!std::isfinite(gear_.offset_mm)) refuse("offset", "offset = {} mm is not a length", gear_.offset_mm);
  if (gear_.reference_radius_mm && !(*gear_.reference_radius_mm > 0 && *gear_.reference_radius_mm < 1e5))
    refuse("reference_radius", "reference_radius = {:.6g} mm is outside (0, 100000) mm", *gear_.reference_radius_mm);
  if (!(gear_.shaper_tip_radius_mm >= 0))
    refuse("shaper_tip_radius", "shaper_tip_radius = {:.6g} mm is below 0", gear_.shaper_tip_radius_mm);
  range("backlash", gear_.backlash_mm, 0, gear_.module_mm, " mm");
  range("stock.allowance_top", gear_.allowance_top_mm, 0, 1000, " mm");
  if (std::isnan(gear_.groove_depth_mm))
    refuse("stock.groove_depth", "groove_depth = {} mm is not a length", gear_.groove_depth_mm);
}

void Inspection::zone_numbers() {
  const auto& zones = gear_.zones;
  zone_count(zones.size());
  for (std::size_t k = 0; k < zones.size(); ++k) {
    const auto& z = zones[k];
    helix_angle(k, z.helix_angle_rad);
    if (!(z.inner_radius_mm > 0 && z.inner_radius_mm < 1e5))
      refuse(zone_key(k, "inner_radius"), "inner_radius = {:.6g} mm is outside (0, 100000) mm", z.inner_radius_mm);
    if (!(z.outer_radius_mm > z.inner_radius_mm && z.outer_radius_mm < 1e5))
      refuse(zone_key(k, "outer_radius"), "outer_radius = {:.6g} mm is not above the inner_radius {:.6g} mm",
             z.outer_radius_mm, z.inner_radius_mm);
    if (z.inner_radius_mm > 0 && !(z.inner_radius_mm > std::abs(gear_.offset_mm)))
      refuse(zone_key(k, "inner_radius"), "inner_radius = {:.6g} mm does not clear |offset| = {:.6g} mm",
             z.inner_radius_mm, std::abs(gear_.offset_mm));
    if (k > 0 && !(z.inner_radius_mm >= zones[k - 1].outer_radius_mm))
      refuse(zone_key(k, "inner_radius"),
             "inner_radius = {:.6g} mm lies inside zone {}, which ends at {:.6g} mm: zones go outwards without overlap",
             z.inner_radius_mm, k - 1, zones[k - 1].outer_radius_mm);
  }
}

void Inspection::modified_zones() {
  for (auto& refusal : modification::refused_zones(gear_.modifications, int(gear_.zones.size())))
    add(std::move(refusal));
}

void Inspection::shaper(std::size_t zone) {
  const Status status = check_shaper(gear_, gear_.zones[zone].helix_angle_rad);
  if (status) return;
  FaceGearParameters sharp = gear_;
  sharp.shaper_tip_radius_mm = 0;
  const bool without_rounding = bool(check_shaper(sharp, gear_.zones[zone].helix_angle_rad));
  const std::string key = without_rounding        ? "shaper_tip_radius"
                          : gear_.backlash_mm > 0 ? "backlash"
                                                  : "addendum_coefficient";
  const bool said = std::any_of(refusals.begin(), refusals.end(), [&](const auto& r) {
    return r.key == key && r.diagnostic.message == status.error().message;
  });
  if (!said) refusals.push_back({key, status.error()});
}

void Inspection::ring(std::size_t k, const FaceGearRing& r, std::vector<std::string>& warnings) {
  const auto& z = r.zone;
  const double inner = z.inner_radius_mm, outer = z.outer_radius_mm;
  if (!(inner > r.surface.M2)) {
    refuse(zone_key(k, "inner_radius"),
           "inner_radius = {:.4f} mm is not above the gear's base radius {:.4f} mm: no flank exists inside it", inner,
           r.surface.M2);
    return;
  }
  for (const auto& flank : r.limits.flanks) {
    if (flank.undercut_radius && inner < *flank.undercut_radius)
      refuse(zone_key(k, "inner_radius"),
             "inner_radius = {:.4f} mm lies inside the undercut limit R1c = {:.4f} mm of flank side {:+d}", inner,
             *flank.undercut_radius, flank.side);
    if (flank.flank_start_radius && inner < *flank.flank_start_radius)
      refuse(zone_key(k, "inner_radius"),
             "inner_radius = {:.4f} mm: inside {:.4f} mm the fillet of flank side {:+d} reaches up to the tip and no "
             "involute is left",
             inner, *flank.flank_start_radius, flank.side);
    if (flank.flank_end_radius && outer > *flank.flank_end_radius)
      refuse(zone_key(k, "outer_radius"),
             "outer_radius = {:.4f} mm: outside {:.4f} mm the fillet of flank side {:+d} reaches up to the tip and no "
             "involute is left",
             outer, *flank.flank_end_radius, flank.side);
    if (flank.involute_start_radius && inner < *flank.involute_start_radius)
      warnings.push_back(
          fmt::format("zone {}: inner radius {:.4f} mm lies inside the involute start R1b = {:.4f} mm of flank side "
                      "{:+d}; the tip corner there is not conjugate",
                      k, inner, *flank.involute_start_radius, flank.side));
  }
  if (!r.limits.pointing_radius) land_over_zone(k, r);
  else if (outer > *r.limits.pointing_radius)
    refuse(zone_key(k, "outer_radius"), "outer_radius = {:.4f} mm exceeds the pointing limit R2 = {:.4f} mm", outer,
           *r.limits.pointing_radius);
  else if (r.limits.land_radius && outer > *r.limits.land_radius)
    warnings.push_back(
        fmt::format("zone {}: outer radius {:.4f} mm exceeds R2' = {:.4f} mm, where the top land is {:.4g} mm", k,
                    outer, *r.limits.land_radius, r.limits.practical_land_mm));
  const double theta_act = active_roll_parameter(gear_, z.helix_angle_rad);
  if (r.surface.shaper.theta_t < theta_act)
    warnings.push_back(
        fmt::format("zone {}: the tip rounding {:.4f} mm shortens the active flank (theta_t = {:.6f} < {:.6f}); up to "
                    "{:.4f} mm keeps it",
                    k, gear_.shaper_tip_radius_mm, r.surface.shaper.theta_t, theta_act,
                    largest_active_tip_radius(gear_, z.helix_angle_rad)));
}

/// No pointing radius was found: the top land over the zone itself decides.
void Inspection::land_over_zone(std::size_t k, const FaceGearRing& r) {
  constexpr int kSections = 32;
  const double inner = r.zone.inner_radius_mm, outer = r.zone.outer_radius_mm;
  for (int n = kSections; n >= 0; --n) {  // from the outside, where teeth are thinnest
    const double radius = inner + (outer - inner) * n / kSections;
    const auto land = tip_thickness(r.surface, radius);
    if (land && *land > 0) continue;
    if (land)
      refuse(zone_key(k, "outer_radius"),
             "outer_radius = {:.4f} mm: the top land at radius {:.4f} mm is {:.4f} mm, limit 0: the tooth is pointed",
             outer, radius, *land);
    else
      refuse(zone_key(k, "outer_radius"),
             "outer_radius = {:.4f} mm: at radius {:.4f} mm a flank does not reach the tip surface", outer, radius);
    return;
  }
}

/// Just outside R1c the corner that the fillet cuts into the flank can run outwards instead of inwards (large offset,
/// helix or shaft angle far from 90 deg). No closed form says where it ends: the solid shaper decides at the inner end
/// of the zone.
void Inspection::swept_flank(std::size_t k, const FaceGearRing& r) {
  constexpr int kHeights = 6;
  const double inner = r.zone.inner_radius_mm, outer = r.zone.outer_radius_mm, z_tip = r.surface.z_tip(inner);
  const double cut_limit = 1e-4 * gear_.module_mm;
  for (const double radius : {inner, inner + 0.02 * (outer - inner), inner + 0.1 * (outer - inner)})
    for (const int side : {1, -1}) {
      const auto low = fillet_line_height(r.surface, side, radius);
      if (!low) continue;
      for (int n = 0; n <= kHeights; ++n) {
        const double z = *low + (z_tip - *low) * n / kHeights;
        const auto at = invert_flank(r.surface, side, radius, z);
        if (!at || at->theta < 0) continue;  // not conjugate there, and warned of as such
        const double cut = -swept_clearance(r.surface, r.surface.flank(side, at->theta, at->B).p);
        if (cut <= cut_limit) continue;
        refuse(zone_key(k, "inner_radius"),
               "inner_radius = {:.4f} mm: at radius {:.4f} mm and height {:.4f} mm the shaper cuts {:.4f} mm into "
               "flank side {:+d}, limit {:.4f} mm: undercut beyond R1c",
               inner, radius, z, cut, side, cut_limit);
        return;
      }
    }
}

/// Gives the ring its modification, and judges what it makes of the flanks.
void Inspection::modify(std::size_t k, const FaceGearParameters& gear, FaceGearRing& r,
                        std::vector<std::string>& warnings) {
  auto made = ring_modification(gear, r.surface, static_cast<int>(k));
  if (auto* refusal = made.refused()) {
    refusals.push_back(std::move(*refusal));
    return;
  }
  r.modification = *made;
  if (!r.modification) return;
  r.form = std::make_shared<const tooth_space::ModifiedForm>(modified_form(gear, r));
  if (auto refusal = tooth_space::refused(*r.form, static_cast<int>(k))) refusals.push_back(std::move(*refusal));
  else if (auto narrow = tooth_space::narrow_land(*r.form, static_cast<int>(k), r.limits.practical_land_mm);
           !narrow.empty())
    warnings.push_back(std::move(narrow));
}

double mid_groove(const std::vector<FaceGearRing>& rings) {
  return 0.5 * (rings[0].zone.outer_radius_mm + rings[1].zone.inner_radius_mm);
}

/// Lowest root surface of both rings between and at the edges of the groove.
double root_in_groove(const std::vector<FaceGearRing>& rings) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& ring : rings)
    for (const double r : {rings[0].zone.outer_radius_mm, rings[1].zone.inner_radius_mm})
      lowest = std::min(lowest, root_height(ring.surface, r).value_or(lowest));
  return lowest;
}

void Inspection::groove(const std::vector<FaceGearRing>& rings, std::vector<std::string>& warnings) {
  if (rings.size() < 2) {
    if (gear_.groove_depth_mm >= 0)
      warnings.push_back(fmt::format(
          "groove_depth = {:.4f} mm has no effect: a gear with one zone has no relief groove", gear_.groove_depth_mm));
    return;
  }
  const double r = mid_groove(rings);
  if (gear_.groove_depth_mm >= 0) {
    const double depth = rings[0].surface.z_tip(r) - root_in_groove(rings);
    if (gear_.groove_depth_mm < depth * (1 - 1e-12))
      refuse("stock.groove_depth",
             "groove_depth = {:.4f} mm does not reach the root beside the groove, {:.4f} mm below the tip surface at "
             "mid-groove",
             gear_.groove_depth_mm, depth);
    if (gear_.groove_depth_mm > 1000)
      refuse("stock.groove_depth", "groove_depth = {:.4f} mm exceeds 1000 mm", gear_.groove_depth_mm);
  }
  if (rings[0].zone.outer_radius_mm == rings[1].zone.inner_radius_mm &&
      rings[0].zone.helix_angle_rad != rings[1].zone.helix_angle_rad)
    refuse("zone[1].inner_radius",
           "inner_radius = {:.4f} mm leaves no relief groove: zone 0 of another helix ends at {:.4f} mm",
           rings[1].zone.inner_radius_mm, rings[0].zone.outer_radius_mm);
}

void warn_sharp_fillet(const FaceGearParameters& gear, const std::vector<FaceGearRing>& rings,
                       std::vector<std::string>& warnings) {
  if (gear.shaper_tip_radius_mm > 0) return;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    const auto& f = rings[k].surface;
    const double r =
        std::hypot(f.shaper.r_a / f.i, f.E);  // where the tip edge rolls without sliding, shaft angle 90 deg
    if (f.Cg == 0 && r > rings[k].zone.inner_radius_mm && r < rings[k].zone.outer_radius_mm)
      warnings.push_back(fmt::format(
          "zone {}: the sharp shaper tip leaves a fillet of radius 0 at r = {:.4f} mm, which no ball can follow", k,
          r));
  }
}

}  // namespace

Expected<FaceGear, std::vector<Refusal>> FaceGear::make(const FaceGearParameters& parameters) {
  Inspection inspection(parameters);
  inspection.numbers();
  inspection.zone_numbers();
  inspection.modified_zones();
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  for (std::size_t k = 0; k < parameters.zones.size(); ++k) inspection.shaper(k);
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);

  FaceGear gear;
  gear.parameters_ = parameters;
  gear.parameters_.reference_radius_mm = reference_radius_of(parameters);
  for (const auto& zone : gear.parameters_.zones) {
    const auto surface = make_surface<double>(gear.parameters_, zone.helix_angle_rad);
    gear.rings_.push_back({zone, surface, zone_limits(surface, parameters.module_mm, parameters.least_land_mm), nullptr,
                           nullptr, nullptr});
    inspection.ring(gear.rings_.size() - 1, gear.rings_.back(), gear.warnings_);
    if (inspection.refusals.empty()) inspection.swept_flank(gear.rings_.size() - 1, gear.rings_.back());
  }
  inspection.groove(gear.rings_, gear.warnings_);
  if (inspection.refusals.empty())
    for (std::size_t k = 0; k < gear.rings_.size(); ++k)
      inspection.modify(k, gear.parameters_, gear.rings_[k], gear.warnings_);
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  warn_sharp_fillet(parameters, gear.rings_, gear.warnings_);
  for (const auto& ring : gear.rings_)
    gear.drawn_.push_back(std::make_shared<const SpaceSheet>(gear.parameters_, ring));
  return gear;
}

FaceGear FaceGear::corrected(
    const std::vector<std::shared_ptr<const modification::RingCorrection>>& corrections) const {
  assert(corrections.size() == rings_.size());
  FaceGear gear = *this;
  for (std::size_t k = 0; k < rings_.size(); ++k) gear.rings_[k].correction = corrections[k];
  return gear;
}

double FaceGear::blank_top() const {
  double top = -std::numeric_limits<double>::infinity();
  for (const auto& ring : rings_)
    for (const double r : {ring.zone.inner_radius_mm, ring.zone.outer_radius_mm})
      top = std::max(top, ring.surface.z_tip(r));
  return top + parameters_.allowance_top_mm;
}

bool FaceGear::in_blank(const Vec3& p) const {
  const double r = radius(p);
  return std::any_of(rings_.begin(), rings_.end(), [&](const FaceGearRing& ring) {
    return r >= ring.zone.inner_radius_mm && r <= ring.zone.outer_radius_mm &&
           p.z() <= ring.surface.z_tip(r) + parameters_.allowance_top_mm;
  });
}

double FaceGear::groove_floor() const {
  assert(rings_.size() == 2);
  if (parameters_.groove_depth_mm >= 0)
    return rings_[0].surface.z_tip(mid_groove(rings_)) - parameters_.groove_depth_mm;
  return root_in_groove(rings_) - 0.25 * parameters_.module_mm;
}

double FaceGear::lowest_root() const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& ring : rings_)
    for (const double r : {ring.zone.inner_radius_mm, ring.zone.outer_radius_mm})
      lowest = std::min(lowest, root_height(ring.surface, r).value_or(lowest));
  return lowest;
}

}  // namespace toothpath::face_gear
