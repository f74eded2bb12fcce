#include "geometry/loaded_bevel/loaded_bevel_pair.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/loaded/cell_position.h"
#include "geometry/loaded/half_space.h"
#include "geometry/loaded_bevel/bevel_body.h"
#include "geometry/loaded_bevel/bevel_flanks.h"

namespace toothpath::loaded_bevel {
namespace {

using bevel_gear::BevelGear;
using loaded::LoadedPosition;

/// Nominal lever of the normals about a gear's axis, in the middle of its face.
double lever_of(const BevelGear& gear) {
  const double cos_beta = std::sqrt(gear.R_m() / gear.R_0());
  return gear.R_m() * gear.sin_delta() * std::cos(gear.parameters().pressure_angle_rad) * cos_beta;
}

/// Along the pinion's axis, of a unit normal force in the middle of the outermost half of the wheel.
double axial_of(const contact::BevelPair& pair, int sigma) {
  const auto& half = pair.wheel().halves().back();
  const auto place =
      pair.wheel_place(static_cast<int>(pair.wheel().halves().size()) - 1, sigma, (half.ell_from + half.ell_to) / 2, 0);
  if (!place) return 0;
  return pair.turned_to_pinion(place->normal, -azimuth(place->point)).z();
}

}  // namespace

Result<LoadedBevelPair> make_loaded_bevel_pair(const BevelGear& pinion, const BevelGear& wheel, int sigma,
                                               const BevelPairOptions& options) {
  auto rolled = contact::BevelPair::make(pinion, wheel, options.moved, {}, options.left);
  if (!rolled) return rolled.error();
  LoadedBevelPair out{std::move(*rolled), sigma, options, 0, 0, 0, 0, {}};
  out.modulus = loaded::contact_modulus(options.wheel.E, options.wheel.nu, options.pinion.E, options.pinion.nu);
  out.lever = lever_of(options.torque_on_pinion ? pinion : wheel);
  out.wheel_lever = options.torque_on_pinion ? out.lever * out.pair.ratio() : out.lever;
  out.half_axial = axial_of(out.pair, sigma);
  out.halves.resize(wheel.halves().size());
  std::vector<Status> done(2 * out.halves.size(), Status(Ok{}));
  tbb::parallel_for(std::size_t(0), done.size(), [&](std::size_t n) {
    BevelHalfBodies& half = out.halves[n / 2];
    const bool on_wheel = n % 2 == 0;
    const BevelGear& gear = on_wheel ? wheel : pinion;
    auto body = bevel_body(gear, static_cast<int>(n / 2), sigma, on_wheel ? options.wheel : options.pinion);
    if (!body) {
      done[n] = fail("half {} of the {}: {}", n / 2, on_wheel ? "wheel" : "pinion", body.error().message);
      return;
    }
    loaded::FreeEnds& ends = on_wheel ? half.wheel_ends : half.pinion_ends;
    ends = body->ends;
    if (on_wheel) ends.origin = out.pair.wheel_apex(), ends.axis = out.pair.wheel_axis();
    (on_wheel ? half.wheel : half.pinion) = std::move(*body);
  });
  for (const auto& status : done)
    if (!status) return status.error();
  return out;
}

Result<LoadedBevelPair> with_left(LoadedBevelPair pair, const contact::BevelLeft& left) {
  pair.options.left = left;
  auto rolled = contact::BevelPair::make(pair.pair.pinion(), pair.pair.wheel(), pair.options.moved, {}, left);
  if (!rolled) return rolled.error();
  pair.pair = std::move(*rolled);
  return pair;
}

Result<LoadedPosition> loaded_position(const LoadedBevelPair& pair, const loaded::Load& load, double phi_1) {
  if (!(load.torque_nmm > 0) || !std::isfinite(load.torque_nmm))
    return fail("torque = {:g} N m on the {} is not above 0", load.torque_nmm / 1000,
                pair.options.torque_on_pinion ? "pinion" : "wheel");
  const BevelFlanks flanks(pair, phi_1);
  auto found = loaded::cell_position(flanks, load, phi_1);
  if (const auto& without = flanks.nearest_siteless(); found && found->approach_mm > without.approach_mm)
    return fail(
        "at {:.4f} deg under {:g} N m the flanks approach by {:.4g} mm, and tooth {} touches from {:.4g} mm on: its "
        "walls "
        "cannot be continued about any place where they meet. A smaller torque or other modifications would help",
        degrees(phi_1), load.torque_nmm / 1000, found->approach_mm, without.tooth, without.approach_mm);
  if (found && !(found->approach_mm < kFarthestGap))
    return fail(
        "at {:.4f} deg under {:g} N m the flanks approach by {:.4g} mm: beyond {:g} mm, where linear theory and the "
        "teeth that are looked at have ended",
        degrees(phi_1), load.torque_nmm / 1000, found->approach_mm, kFarthestGap);
  return found;
}

Result<loaded::LoadedCycle> loaded_cycle(const LoadedBevelPair& pair, const loaded::Load& load) {
  loaded::LoadedCycle cycle;
  cycle.normal_n = load.torque_nmm / pair.lever;
  cycle.single_axial_n = cycle.normal_n * std::abs(pair.half_axial);
  auto found = loaded::positions_over(load.positions, pair.pair.pinion().pitch(),
                                      [&](double phi) { return loaded_position(pair, load, phi); });
  if (!found) return found.error();
  cycle.positions = std::move(*found);
  return cycle;
}

}  // namespace toothpath::loaded_bevel
