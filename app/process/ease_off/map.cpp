#include "app/process/ease_off/map.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/report/svg/contact_pattern.h"
#include "geometry/base/angle.h"

namespace toothpath::ease_off {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kJsonRows = 11, kJsonColumns = 13, kDrawnRows = 121;

/// Enough for a micrometre of a thousandth.
double rounded(double value, double unit) { return std::round(value / unit) * unit; }

Json place_json(const SideMap& side, const contact::EaseOff::Place& at) {
  const MappedFlank& flank = side.flanks[at.member];
  return {{"um", at.gap_mm * app::kUm},
          {"zone", flank.zone},
          {side.words->x_key, flank.x[at.index]},
          {side.words->y_key, flank.y[at.index]}};
}

/// Rows or columns of the grid that are told: the first, the last and so many between.
std::vector<int> some_of(int count, int most) {
  std::vector<int> out;
  const int told = std::min(count, most);
  for (int k = 0; k < told; ++k) out.push_back(k * (count - 1) / (told - 1));
  return out;
}

Json grid_json(const PairWords& words, const MappedFlank& flank, const contact::EaseOffMap& map) {
  Json grid = {{"zone", flank.zone}, {words.x_key, Json::array()}, {words.y_key, Json::array()}, {"um", Json::array()}};
  const auto columns = some_of(flank.columns, kJsonColumns);
  for (const int c : columns) grid[words.x_key].push_back(rounded(flank.x[flank.index(0, c)], 1e-6));
  for (const int r : some_of(flank.rows, kJsonRows)) {
    Json heights = Json::array(), values = Json::array();
    for (const int c : columns) {
      const auto k = flank.index(r, c);
      heights.push_back(rounded(flank.y[k], 1e-6));
      values.push_back(std::isnan(map.gap_mm[k]) ? Json(nullptr) : Json(rounded(map.gap_mm[k] * app::kUm, 1e-4)));
    }
    grid[words.y_key].push_back(std::move(heights));
    grid["um"].push_back(std::move(values));
  }
  return grid;
}

}  // namespace

std::string map_csv(const std::vector<SideMap>& sides) {
  std::string out = sides.empty() ? "" : std::string(sides.front().words->csv_header) + "\n";
  for (const SideMap& side : sides) {
    if (side.found == nullptr) continue;
    for (std::size_t m = 0; m < side.flanks.size(); ++m) {
      const MappedFlank& f = side.flanks[m];
      const contact::EaseOffMap& map = side.found->maps[m];
      for (int r = 0; r < f.rows; ++r)
        for (int c = 0; c < f.columns; ++c) {
          const auto k = f.index(r, c);
          out += fmt::format("{},{},{},{},{:.6f},{:.6f},", side.side, f.zone, r, c, f.x[k], f.y[k]);
          out += std::isnan(map.gap_mm[k])
                     ? ",,,\n"
                     : fmt::format("{:.4f},{:.6f},{:.6f},{:.6f}\n", map.gap_mm[k] * app::kUm, degrees(map.phi_2[k]),
                                   map.pinion_across_mm[k], map.pinion_along_mm[k]);
        }
    }
  }
  return out;
}

Json map_json(const SideMap& side) {
  if (side.found == nullptr) return nullptr;
  Json json = {{"greatest", place_json(side, side.found->greatest)},
               {"least", place_json(side, side.found->least)},
               {"shift_um", side.found->shift_mm * app::kUm},
               {"zones", Json::array()}};
  for (std::size_t m = 0; m < side.flanks.size(); ++m)
    json["zones"].push_back(grid_json(*side.words, side.flanks[m], side.found->maps[m]));
  return json;
}

std::string map_summary(const SideMap& side) {
  if (side.found == nullptr) return "    ease-off: none, the flanks have no common normal\n";
  const auto& found = *side.found;
  const auto where = [&](const contact::EaseOff::Place& at) {
    const MappedFlank& f = side.flanks[at.member];
    const std::string zone = side.flanks.size() > 1 ? fmt::format("{} {}, ", side.words->zone, f.zone) : "";
    return fmt::format("{}{} {:.2f}, {} {:.2f} mm", zone, side.words->x_text, f.x[at.index], side.words->y_text,
                       f.y[at.index]);
  };
  if (found.greatest.gap_mm < 1e-8) return "    ease-off: none, the flanks are conjugate\n";
  return fmt::format("    ease-off: up to {:.2f} um at {}; least at {}\n", found.greatest.gap_mm * app::kUm,
                     where(found.greatest), where(found.least));
}

std::vector<page::StudyPage::Figure> map_figures(const SideMap& side, const std::string& name) {
  std::vector<page::StudyPage::Figure> figures;
  if (side.found == nullptr) return figures;
  for (std::size_t m = 0; m < side.flanks.size(); ++m) {
    const MappedFlank& f = side.flanks[m];
    svg::FlankFieldDrawing field{
        "ease-off, " + name, side.words->x_label, side.words->y_label, "um", 0, f.columns, {}, {}, {}, 0};
    for (const int r : some_of(f.rows, kDrawnRows)) {
      ++field.rows;
      for (int c = 0; c < f.columns; ++c) {
        const auto k = f.index(r, c);
        field.x.push_back(f.x[k]);
        field.y.push_back(f.y[k]);
        field.value.push_back(side.found->maps[m].gap_mm[k] * app::kUm);
      }
    }
    const std::string zone = side.flanks.size() > 1 ? fmt::format(", {} {}", side.words->ring, f.zone) : "";
    figures.push_back({"Ease-off: " + name + zone, svg::svg_flank_field(field),
                       fmt::format("How far the gear's flank stands off the one that would run with this pinion at the "
                                   "exact ratio; at most {:.2f} um. Where nothing is drawn the {} "
                                   "before.",
                                   side.found->greatest.gap_mm * app::kUm, side.words->end_of_mate)});
  }
  return figures;
}

}  // namespace toothpath::ease_off
