#include "app/process/bevel/pair_ease_off.h"

#include <nlohmann/json.hpp>

#include "app/base/units.h"

namespace toothpath::bevel {
namespace {

constexpr std::size_t kMotionStride = 2;  // positions of the roll to one of contact.json

/// The map of one wall, for those that show it. What is found must outlive it.
ease_off::SideMap map_of(const PairEaseOff& found, std::size_t side) {
  ease_off::SideMap map{&kBevelWords, kBevelWords.sides[side], {}, nullptr};
  const auto& wall = found.walls[side];
  if (!wall) return map;
  map.found = &wall->found;
  for (const auto& grid : wall->grids) {
    ease_off::MappedFlank flank{grid.half, grid.rows, grid.columns, {}, {}};
    for (const auto& place : grid.places) {
      flank.x.push_back(place.ell);
      flank.y.push_back(place.height);
    }
    map.flanks.push_back(std::move(flank));
  }
  return map;
}

ease_off::MotionCurve motion_of(const contact::BevelContact& rolled, std::size_t side, double pitch) {
  ease_off::MotionCurve curve{kBevelWords.side(side), 1, {},   {}, rolled.error_mean_rad,
                              rolled.error_range_rad, 0, pitch};
  for (const auto& at : rolled.pair) {
    curve.phi_2.push_back(at.phi_2);
    curve.error_rad.push_back(at.error_rad);
  }
  return curve;
}

}  // namespace

process::ValueOrErrors<PairEaseOff> analyse_ease_off(const BevelPairAsked& pair, const contact::BevelPair& stands,
                                                     const std::vector<contact::BevelContact>& rolled,
                                                     const process::ContactAsked& asked, app::StageClock& clock) {
  if (!asked.write_file.empty() && pair.modify != pair.own())
    return std::vector{fail_at(pair.job->where("gear"),
                               "--write writes the job of the gear that it makes, the {} of the pair, but --modify {} "
                               "finds keys of its mate; without --write they are shown, or run the mate's job with "
                               "--mate {}",
                               pair.own() == std::string("gear") ? "wheel" : "pinion", pair.modify, pair.job->file)};
  PairEaseOff out;
  out.compound_mm = pair.roll.compound_mm;
  clock.run("ease-off", [&] {
    for (const std::size_t s : {0u, 1u}) {
      if (auto found = contact::bevel_ease_off(stands, sigma_of(s), pair.roll.rows, pair.roll.columns))
        out.walls[s] = std::move(*found);
      for (std::size_t h = 0; out.walls[s] && h < rolled[s].patterns.size(); ++h)
        out.places[s].push_back(contact::bevel_pattern_place(stands, rolled[s].patterns[h], out.walls[s]->found.maps[h],
                                                             out.compound_mm, 0));
      out.motion[s] = motion_of(rolled[s], s, stands.wheel().pitch());
    }
    return 0;
  });
  auto misaligned = ease_off::misalign(*searched_pair(pair), *pair.job, pair.settings, asked, pair.modify, clock);
  if (auto* errors = misaligned.refused()) return std::move(*errors);
  out.misaligned = std::move(misaligned).value();
  return out;
}

void add_wall(nlohmann::ordered_json& wall, const PairEaseOff& found, std::size_t side) {
  wall["motion_curve"] = ease_off::motion_json(found.motion[side], kMotionStride);
  wall["ease_off"] = ease_off::map_json(map_of(found, side));
  wall["zones"] = nlohmann::ordered_json::array();
  for (std::size_t h = 0; h < found.places[side].size(); ++h)
    wall["zones"].push_back(ease_off::place_json(h, found.places[side][h], found.compound_mm));
}

void add_to_page(page::StudyPage& page, const PairEaseOff& found) {
  for (const std::size_t s : {0u, 1u})
    for (auto& figure : ease_off::map_figures(map_of(found, s), kBevelWords.side(s)))
      page.figures.push_back(std::move(figure));
  if (auto motion = ease_off::motion_chart({found.motion[0], found.motion[1]}); !motion.series.empty())
    page.charts.push_back(std::move(motion));
  ease_off::add_to_page(page, found.misaligned);
}

std::string ease_off_summary(const PairEaseOff& found) {
  std::string out;
  for (const std::size_t s : {0u, 1u}) {
    out += "  " + kBevelWords.side(s) + "\n" + ease_off::map_summary(map_of(found, s));
    for (std::size_t h = 0; h < found.places[s].size(); ++h) {
      const auto& place = found.places[s][h];
      out += fmt::format("    half {}: pattern profile {:.0f} to {:.0f} %, lead {:.0f} to {:.0f} %: {}\n", h,
                         100 * place.low, 100 * place.high, 100 * place.inner, 100 * place.outer,
                         ease_off::reached_text(place, found.compound_mm));
    }
  }
  return out + ease_off::misaligned_summary(found.misaligned);
}

std::string ease_off_csv(const PairEaseOff& found) { return ease_off::map_csv({map_of(found, 0), map_of(found, 1)}); }

}  // namespace toothpath::bevel
