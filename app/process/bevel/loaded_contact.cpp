#include "app/process/bevel/loaded_contact.h"

#include <algorithm>

#include "app/job/file.h"
#include "app/process/cut_flanks.h"
#include "app/process/under_load/loaded_side.h"
#include "geometry/contact/bevel_pattern_place.h"
#include "geometry/decks/bevel_deck.h"
#include "geometry/loaded_bevel/bevel_body.h"
#include "geometry/loaded_bevel/bevel_friction.h"
#include "geometry/loaded_bevel/bevel_root_stress.h"
#include "geometry/loaded_bevel/loaded_bevel_pair.h"

namespace toothpath::bevel {
namespace {

/// Refused: a rim that does not fit the wheel. That of the pinion is no thicker than the pinion can have.
Result<loaded_bevel::BevelPairOptions> pair_options(const job::ContactSettings& settings,
                                                    const bevel_gear::BevelGear& pinion,
                                                    const bevel_gear::BevelGear& wheel) {
  const job::ContactLoad& load = settings.load.value();
  const double m = wheel.parameters().outer_transverse_module_mm, thickest = loaded_bevel::thickest_rim(wheel),
               rim = load.rim_mm.value_or(std::min(5 * m, thickest));
  if (!(rim >= 0.5 * m) || !(rim <= thickest))
    return fail(
        "rim = {:g} mm is not between half the module, {:g} mm, and {:.4g} mm, which leave the wheel a quarter of "
        "what is below its root at the small end",
        rim, 0.5 * m, thickest);
  const auto plans = under_load::body_plans(load, rim);
  loaded_bevel::BevelPairOptions options;
  options.wheel = plans[0], options.pinion = plans[1];
  options.pinion.bricks.rim_mm = std::min(rim, loaded_bevel::thickest_rim(pinion));
  options.torque_on_pinion = load.on_pinion;
  options.edge_radius_mm = load.edge_radius_mm;
  options.moved = contact::assembly_of(settings.moved);
  return options;
}

const char* wall_of(int sigma) { return sigma > 0 ? "wall L" : "wall U"; }

}  // namespace

process::ValueOrErrors<under_load::LoadedContact> analyse_loaded(
    const job::Job& job, const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
    const job::ContactSettings& settings, const contact::BevelLeft& left, const std::string& route) {
  under_load::LoadedContact found;
  found.words = under_load::kBevelWords;
  found.settings = settings.load.value();
  const job::ContactLoad& load = found.settings;
  found.rings = static_cast<int>(wheel.halves().size());
  found.pinion_teeth = pinion.parameters().teeth;
  found.torque_gear_Nm =
      load.on_pinion ? load.torque_Nm * wheel.parameters().teeth / pinion.parameters().teeth : load.torque_Nm;
  found.floating = load.pinion_axial == job::PinionHold::floating;
  if (found.floating && !wheel.herringbone())
    return std::vector{
        process::located(job, "contact.load.pinion_axial",
                         fail("pinion_axial = \"floating\" needs two halves of opposite hand: nothing else keeps the "
                              "pinion in its place"))};
  const auto options = pair_options(settings, pinion, wheel);
  if (!options) return std::vector{process::located(job, "contact.load.rim", options.error())};
  found.rim_mm = options->wheel.bricks.rim_mm, found.pinion_rim_mm = options->pinion.bricks.rim_mm;
  for (const int sigma : {1, -1}) {
    const auto pair = loaded_bevel::make_loaded_bevel_pair(pinion, wheel, sigma, *options);
    if (!pair) return std::vector{process::located(job, "gear", pair.error())};
    const auto carried = under_load::load_of(found, load.torque_Nm);
    auto drawn = under_load::loaded_side(*pair, carried, sigma, wall_of(sigma), load);
    if (!drawn) return std::vector{process::located(job, "contact.load", drawn.error())};
    under_load::add_side(found, std::move(*drawn), under_load::is_steel(load));
    if (!left) continue;
    const auto rough = loaded_bevel::with_left(*pair, left);
    if (!rough) return std::vector{process::located(job, "gear", rough.error())};
    auto worn = under_load::loaded_side(*rough, carried, sigma,
                                        fmt::format("{}, {}", wall_of(sigma), process::words_of_route(route)), load);
    if (!worn) return std::vector{process::located(job, "contact.load", worn.error())};
    worn->as_cut = true;
    under_load::add_side(found, std::move(*worn), false);
  }
  return found;
}

process::ValueOrErrors<process::NamedFiles> loaded_decks(const job::Job& job, const bevel_gear::BevelGear& pinion,
                                                         const bevel_gear::BevelGear& wheel,
                                                         const under_load::LoadedContact& found,
                                                         const job::ContactSettings& settings) {
  const auto options = pair_options(settings, pinion, wheel);
  if (!options) return std::vector{process::located(job, "contact.load.rim", options.error())};
  process::NamedFiles files;
  for (const auto& side : found.sides) {
    if (side.as_cut) continue;
    const auto pair = loaded_bevel::make_loaded_bevel_pair(pinion, wheel, side.side, *options);
    if (!pair) return std::vector{process::located(job, "gear", pair.error())};
    decks::BevelDeckOptions deck;
    deck.wheel.rim_mm = options->wheel.bricks.rim_mm, deck.pinion.rim_mm = options->pinion.bricks.rim_mm;
    deck.teeth = found.settings.row_teeth;
    deck.phi_1 = side.cycle.positions.front().phi;
    deck.approach_mm =
        under_load::range_of(side.cycle, [](const loaded::LoadedPosition& p) { return p.approach_mm; }).mean;
    for (int half = 0; half < found.rings; ++half) {
      auto text = decks::bevel_deck(*pair, half, deck);
      if (!text) return std::vector{process::located(job, "gear", text.error())};
      files.emplace_back(fmt::format("half_{}_wall_{}.inp", half, side.side > 0 ? "L" : "U"), std::move(*text));
    }
  }
  return files;
}

}  // namespace toothpath::bevel
