#include "app/proposal/wishes.h"

#include <algorithm>
#include <cmath>

#include "app/proposal/gear_limits.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/shaper.h"
#include "geometry/flank_grid/point_order.h"

namespace toothpath::proposal {
namespace {

constexpr std::string_view kGearWords[] = {
    "face",           "double_helical", "offset",    "bevel_herringbone", "cylindrical", "cylindrical_double_helical",
    "straight_bevel", "spiral_bevel",   "flank_grid"};
constexpr std::string_view kRouteWords[] = {"ball", "line", "shaped", "finger"};
constexpr Route kFaceRoutes[] = {Route::line, Route::ball, Route::shaped};
constexpr Route kDoubleRoutes[] = {Route::line, Route::ball};
constexpr Route kBevelRoutes[] = {Route::finger};
constexpr Route kMillRoutes[] = {Route::ball, Route::line};

constexpr Question kQuestions[] = {
    {Quantity::teeth, "--teeth", "teeth of the gear", {10, 1000}, true},
    {Quantity::mate_teeth, "--mate-teeth", "teeth of the mate", {8, 1000}, true},
    {Quantity::pitch_angle,
     "--pitch-angle",
     "pitch angle of a spiral bevel gear, instead of the shaft angle",
     {1, 88, " deg"},
     false},
    {Quantity::shaft_angle, "--shaft-angle", "shaft angle of a spiral bevel gear", {10, 170, " deg"}, false},
    {Quantity::cone_distance,
     "--cone-distance",
     "outer cone distance of a spiral bevel gear, instead of the module",
     {1, 2000, " mm"},
     false},
    {Quantity::mean_cone_distance,
     "--mean-cone-distance",
     "cone distance in the middle of its face, instead of the module; takes --face-width",
     {1, 2000, " mm"},
     false},
    {Quantity::shaper_teeth, "--shaper-teeth", "teeth of the shaper, or of the pinion", {8, 400}, true},
    {Quantity::module,
     "--module",
     "module, transverse (of a bevel gear at the large end, of a cylindrical gear normal)",
     {0.3, 20, " mm"},
     false},
    {Quantity::pressure_angle, "--pressure-angle", "pressure angle", {14.5, 30, " deg"}, false},
    {Quantity::helix,
     "--helix",
     "helix angle of the shaper, or of the cylindrical gear (its upper ring)",
     {-45, 45, " deg"},
     false},
    {Quantity::offset, "--offset", "offset of the axes", {-500, 500, " mm"}, false},
    {Quantity::tip_radius,
     "--tip-radius",
     "rounding of the shaper's tip, which makes the fillet",
     {0, 10, " mm"},
     false},
    {Quantity::inner, "--inner", "inner end of the teeth, radius", {1, 2000, " mm"}, false},
    {Quantity::outer, "--outer", "outer end of the teeth, radius", {1, 2000, " mm"}, false},
    {Quantity::spiral,
     "--spiral",
     "spiral angle, of herringbones at the large end, of a spiral bevel gear in the middle of the face",
     {0, 45, " deg"},
     false},
    {Quantity::face_width,
     "--face-width",
     "face width, of a bevel gear along the pitch cone, of two rings with their groove",
     {1, 500, " mm"},
     false},
    {Quantity::profile_shift, "--profile-shift", "profile shift in modules", {-2, 2}, false},
    {Quantity::cutter_radius,
     "--cutter-radius",
     "mean radius of the face mill for a spiral bevel gear",
     {1, 1000, " mm"},
     false},
    {Quantity::fillet_radius,
     "--fillet-radius",
     "radius of the ball that rolls between flank and root of a gear by points",
     {0, 1000, " mm", true},
     false},
    {Quantity::bore, "--bore", "diameter of the bore; 0: none", {0, 2000, " mm"}, false},
};

constexpr double kInch = 25.4;        // mm
constexpr double kRadiusStep = 0.25;  // mm, of proposed ends

constexpr double kDoubleWidth = 8, kLeastDoubleWidth = 5;  // of a double helical gear with its groove, modules
constexpr double kDoubleHelix = 30;                        // deg, of a double helical cylinder

double rounded(double x, double step) { return std::round(x / step) * step; }

/// Of the shaper, so that it keeps a land at its tip.
double proposed_tip(const Wishes& wishes) {
  const double full = face_gear::largest_tip_radius(face_parameters(wishes), radians(wishes.at(Quantity::helix)));
  return std::max(0.0, std::floor(std::min(0.3 * wishes.at(Quantity::module), 0.8 * full) / 0.005) * 0.005);
}

/// The helix angle of whole 5 deg, at most 30, that leaves room for two rings.
double helix_with_room(const Wishes& wishes) {
  for (const double helix : {30.0, 25.0, 20.0, 15.0}) {
    Wishes tried = wishes;
    tried[Quantity::helix] = helix;
    tried[Quantity::tip_radius] = proposed_tip(tried);
    const auto range = face_range(tried);
    if (range && range->outer - range->inner > kLeastDoubleWidth * wishes.at(Quantity::module)) return helix;
  }
  return 10.0;
}

/// The least profile shift without undercut, in steps; 0 where none is needed.
double least_shift(const Wishes& wishes) {
  const auto p = cylindrical_parameters(wishes);
  return std::max(0.0, std::ceil(20 * cylindrical::least_profile_shift(p, p.zones.front())) / 20);
}

/// Of the standard face mills the one that is nearest to the mean cone distance; smaller gears have one of their own.
double proposed_cutter(const Wishes& wishes) {
  constexpr double kDiameters[] = {2.75, 3.5, 4.5, 5, 6, 7.5, 9, 10.5, 12, 14, 16, 18, 21};  // inch
  const double teeth = wishes.at(Quantity::teeth), delta = spiral_bevel::pitch_angle(drawing_of(wishes)),
               mean = 0.5 * (wishes.at(Quantity::module) * teeth / std::sin(delta) - wishes.at(Quantity::face_width));
  if (mean < 0.5 * kInch * kDiameters[0]) return std::max(1.0, rounded(mean, 0.5));
  double best = 0;
  for (const double diameter : kDiameters)
    if (const double radius = 0.5 * kInch * diameter; std::abs(radius - mean) < std::abs(best - mean)) best = radius;
  return best;
}

std::optional<double> proposed_end(Quantity quantity, const Wishes& wishes) {
  const auto range = face_range(wishes);
  if (!range) return std::nullopt;
  const double m = wishes.at(Quantity::module);
  if (quantity == Quantity::inner) return std::ceil((range->inner + 0.05 * m) / kRadiusStep) * kRadiusStep;
  const double inner = wishes[Quantity::inner].value_or(range->inner);
  const double width = (wishes.gear == Gear::double_helical ? kDoubleWidth : 4) * m;
  const double most = range->outer - 0.05 * m;
  return std::floor(std::min(most, inner + width) / kRadiusStep) * kRadiusStep;
}

}  // namespace

std::span<const std::string_view> gear_words() { return kGearWords; }
std::span<const std::string_view> route_words() { return kRouteWords; }

std::optional<Gear> gear_of(std::string_view word) {
  const auto* found = std::find(std::begin(kGearWords), std::end(kGearWords), word);
  return found == std::end(kGearWords) ? std::nullopt : std::optional(static_cast<Gear>(found - kGearWords));
}

std::optional<Route> route_of(std::string_view word) {
  const auto* found = std::find(std::begin(kRouteWords), std::end(kRouteWords), word);
  return found == std::end(kRouteWords) ? std::nullopt : std::optional(static_cast<Route>(found - kRouteWords));
}

std::span<const Route> routes_of(Gear gear) {
  switch (gear) {
    case Gear::face:
    case Gear::offset: return kFaceRoutes;
    case Gear::double_helical: return kDoubleRoutes;
    case Gear::bevel_herringbone: return kBevelRoutes;
    case Gear::cylindrical:
    case Gear::cylindrical_double_helical:
    case Gear::straight_bevel:
    case Gear::spiral_bevel:
    case Gear::flank_grid: return kMillRoutes;
  }
  return {};
}

std::string_view word_of(Gear gear) { return kGearWords[static_cast<std::size_t>(gear)]; }
std::string_view word_of(Route route) { return kRouteWords[static_cast<std::size_t>(route)]; }

std::span<const Question> questions() { return kQuestions; }

bool belongs(const Question& question, Gear gear) {
  const bool by_points = question.what == Quantity::fillet_radius;
  if (gear == Gear::flank_grid || by_points)
    return gear == Gear::flank_grid &&
           (by_points || question.what == Quantity::bore || question.what == Quantity::teeth);
  const bool herringbone = gear == Gear::bevel_herringbone, spiral = gear == Gear::spiral_bevel,
             cylindrical = is_cylindrical(gear), bevel = herringbone || spiral || gear == Gear::straight_bevel;
  switch (question.what) {
    case Quantity::teeth:
    case Quantity::module:
    case Quantity::pressure_angle: return true;
    case Quantity::mate_teeth: return bevel;
    case Quantity::spiral: return herringbone || spiral;
    case Quantity::cutter_radius:
    case Quantity::pitch_angle:
    case Quantity::shaft_angle:
    case Quantity::cone_distance:
    case Quantity::mean_cone_distance: return spiral;
    case Quantity::face_width: return bevel || cylindrical;
    case Quantity::profile_shift: return cylindrical;
    case Quantity::offset: return gear == Gear::offset;
    case Quantity::helix: return !bevel;
    case Quantity::shaper_teeth:
    case Quantity::tip_radius:
    case Quantity::inner:
    case Quantity::outer: return !bevel && !cylindrical;
    case Quantity::bore: return cylindrical || gear == Gear::straight_bevel;
    case Quantity::fillet_radius: break;
  }
  return false;
}

std::optional<double> proposed(Quantity quantity, const Wishes& wishes) {
  const double teeth = wishes.at(Quantity::teeth), m = wishes.at(Quantity::module);
  switch (quantity) {
    case Quantity::teeth:
    case Quantity::mate_teeth:
    case Quantity::pitch_angle:
    case Quantity::cone_distance:
    case Quantity::mean_cone_distance:
    case Quantity::module: return std::nullopt;
    case Quantity::shaft_angle: return 90.0;
    case Quantity::fillet_radius: {
      if (!wishes.grid) return std::nullopt;
      const flank_grid::MeridianProposal meridians({wishes.grid->plus, wishes.grid->minus});
      return std::floor(1e3 * meridians.fillet_radius_mm(wishes.grid->root)) / 1e3;
    }
    case Quantity::bore: return 0.0;
    case Quantity::shaper_teeth: return std::clamp(std::round(2.6 * std::sqrt(teeth)), 16.0, 100.0);
    case Quantity::pressure_angle: return 20.0;
    case Quantity::helix:
      return wishes.gear == Gear::double_helical               ? helix_with_room(wishes)
             : wishes.gear == Gear::cylindrical_double_helical ? kDoubleHelix
                                                               : 0.0;
    case Quantity::offset: return rounded(0.05 * m * teeth, 0.5);
    case Quantity::tip_radius: return wishes.route == Route::shaped ? 0.0 : proposed_tip(wishes);
    case Quantity::inner:
    case Quantity::outer: return proposed_end(quantity, wishes);
    case Quantity::spiral: return wishes.gear == Gear::spiral_bevel ? 35.0 : 30.0;
    case Quantity::cutter_radius: return proposed_cutter(wishes);
    case Quantity::profile_shift: return least_shift(wishes);
    case Quantity::face_width: {
      if (wishes.gear == Gear::cylindrical) return std::max(1.0, rounded(8 * m, 0.5));
      if (wishes.gear == Gear::cylindrical_double_helical) return std::max(2.0, rounded(14 * m, 0.5));
      const double delta = wishes.gear == Gear::spiral_bevel ? spiral_bevel::pitch_angle(drawing_of(wishes))
                                                             : std::atan2(teeth, wishes.at(Quantity::mate_teeth));
      const double width = 0.29 * 0.5 * m * teeth / std::sin(delta);
      return rounded(wishes.gear == Gear::spiral_bevel ? std::min(width, 10 * m) : width, 0.5);
    }
  }
  return std::nullopt;
}

}  // namespace toothpath::proposal
