// The exact flanks that the numbers of a gear have, whether it can be cut or not.
#include <cmath>
#include <type_traits>

#include "app/fit/numbers.h"
#include "app/job/form_mill.h"
#include "geometry/bevel_gear/part.h"
#include "geometry/bevel_gear/walls.h"
#include "geometry/cylindrical/part.h"
#include "geometry/face_gear/part.h"
#include "geometry/face_gear/reference_radius.h"
#include "geometry/face_gear/space_sheet.h"
#include "geometry/spiral_bevel/gear.h"
#include "geometry/spiral_bevel/set_up.h"
#include "geometry/straight_bevel/gear.h"
#include "geometry/tooth_space/modified_part.h"

namespace toothpath::fit {
namespace {

using bevel_gear::BevelGearParameters;
using cylindrical::CylindricalParameters;
using face_gear::FaceGearParameters;
using spiral_bevel::SpiralBevelParameters;
using straight_bevel::StraightBevelParameters;

bevel_gear::FingerCutterData mill_of(const BevelGearParameters& p, const job::Job& like) {
  return p.mill ? *p.mill : job::form_mill(like)->data;
}

Expected<Spaces, Refusal> plain_spaces(FaceGearParameters p, const job::Job&) {
  p.reference_radius_mm = face_gear::reference_radius_of(p);
  Spaces out;
  for (const auto& zone : p.zones) {
    const auto surface = face_gear::make_surface<double>(p, zone.helix_angle_rad);
    if (!std::isfinite(surface.shaper.theta_t))
      return Refusal{"shaper_tip_radius", fail("the shaper of these numbers has no involute at its tip")};
    out.push_back(std::make_shared<const face_gear::SpaceSheet>(p, face_gear::FaceGearRing{zone, surface, {}}));
  }
  return out;
}
Expected<Spaces, Refusal> plain_spaces(const BevelGearParameters& p, const job::Job& like) {
  const auto made = bevel_gear::walls_of(p, mill_of(p, like));
  if (const auto* refusals = made.refused()) return refusals->front();
  Spaces out;
  for (std::size_t half = 0; half < made.value().halves().size(); ++half)
    out.push_back(std::make_shared<const bevel_gear::WallSpace>(bevel_gear::WallKernel(made.value(), half)));
  return out;
}
Expected<Spaces, Refusal> plain_spaces(const CylindricalParameters& p, const job::Job&) {
  Spaces out;
  for (const auto& zone : p.zones)
    out.push_back(std::make_shared<const cylindrical::InvoluteSpace>(cylindrical::InvoluteKernel<double>(p, zone)));
  return out;
}
Expected<Spaces, Refusal> plain_spaces(const StraightBevelParameters& p, const job::Job&) {
  return Spaces{std::make_shared<const straight_bevel::CrownSpace>(straight_bevel::CrownKernel<double>(p))};
}
Expected<Spaces, Refusal> plain_spaces(const SpiralBevelParameters& p, const job::Job&) {
  auto made = spiral_bevel::set_up(p);
  if (auto* refusal = made.refused()) return std::move(*refusal);
  return Spaces{std::make_shared<const spiral_bevel::CutterSpace>(std::move(made.value().kernel))};
}

/// With its modifications a gear must be whole.
template <typename Made>
Expected<std::shared_ptr<const tooth_space::ToothedPart>, Refusal> whole(const Made& made) {
  if (const auto* refusals = made.refused()) return refusals->front();
  return part_of(*made);
}
auto whole_gear(const FaceGearParameters& p, const job::Job&) { return whole(face_gear::FaceGear::make(p)); }
auto whole_gear(const CylindricalParameters& p, const job::Job&) {
  return whole(cylindrical::CylindricalGear::make(p));
}
auto whole_gear(const StraightBevelParameters& p, const job::Job&) {
  return whole(straight_bevel::StraightBevelGear::make(p));
}
auto whole_gear(const SpiralBevelParameters& p, const job::Job&) {
  return whole(spiral_bevel::SpiralBevelGear::make(p));
}

/// Of a gear with modifications.
template <typename P>
Expected<Spaces, Refusal> modified_spaces(const P& p, const job::Job& like) {
  auto whole = whole_gear(p, like);
  if (auto* refusal = whole.refused()) return std::move(*refusal);
  auto part = std::move(whole).value();
  if (!like.modifications.empty()) {
    auto made = tooth_space::modified_part(std::move(part), like.modifications);
    if (auto* refusal = made.refused()) return std::move(*refusal);
    part = std::move(made).value();
  }
  Spaces out;
  for (int zone = 0; zone < part->zones(); ++zone) out.emplace_back(part, &part->space(zone));
  return out;
}
/// Its profile and its paths carry them.
Expected<Spaces, Refusal> modified_spaces(const BevelGearParameters& p, const job::Job& like) {
  return plain_spaces(p, like);
}

}  // namespace

Expected<Spaces, Refusal> spaces_of(const Gear& gear, const job::Job& like) {
  return std::visit(
      [&](const auto& p) -> Expected<Spaces, Refusal> {
        bool plain = like.modifications.empty();
        if constexpr (requires { p.modifications; }) plain = plain && p.modifications.empty();
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(p)>, flank_grid::FlankGridParameters>)
          return Refusal{"type", fail("is not fitted")};
        else return plain ? plain_spaces(p, like) : modified_spaces(p, like);
      },
      gear);
}

}  // namespace toothpath::fit
