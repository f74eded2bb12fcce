#include "app/process/face/ease_off/map.h"

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

const Vec3& point_of(const SideMap& side, const contact::EaseOff::Place& at) {
  return (*side.members)[at.member].flank.points[at.index];
}

Json place_json(const SideMap& side, const contact::EaseOff::Place& at) {
  const Vec3& p = point_of(side, at);
  return {
      {"um", at.gap_mm * app::kUm}, {"zone", (*side.members)[at.member].flank.zone}, {"r", radius(p)}, {"z", p.z()}};
}

/// Rows or columns of the grid that are told: the first, the last and so many between.
std::vector<int> some_of(int count, int most) {
  std::vector<int> out;
  const int told = std::min(count, most);
  for (int k = 0; k < told; ++k) out.push_back(k * (count - 1) / (told - 1));
  return out;
}

Json grid_json(const contact::ContactFlank& flank, const contact::EaseOffMap& map) {
  Json grid = {{"zone", flank.zone}, {"r", Json::array()}, {"z", Json::array()}, {"um", Json::array()}};
  const auto columns = some_of(flank.columns, kJsonColumns);
  for (const int c : columns) grid["r"].push_back(rounded(radius(flank.points[flank.index(0, c)]), 1e-6));
  for (const int r : some_of(flank.rows, kJsonRows)) {
    Json heights = Json::array(), values = Json::array();
    for (const int c : columns) {
      const auto k = flank.index(r, c);
      heights.push_back(rounded(flank.points[k].z(), 1e-6));
      values.push_back(std::isnan(map.gap_mm[k]) ? Json(nullptr) : Json(rounded(map.gap_mm[k] * app::kUm, 1e-4)));
    }
    grid["z"].push_back(std::move(heights));
    grid["um"].push_back(std::move(values));
  }
  return grid;
}

}  // namespace

std::string map_csv(const std::vector<SideMap>& sides) {
  std::string out = "surface,flank,zone,row,column,r,z,ease_off_um,phi_2_deg,pinion_radius,pinion_Z\n";
  for (const SideMap& side : sides) {
    if (side.found == nullptr) continue;
    for (std::size_t m = 0; m < side.members->size(); ++m) {
      const contact::ContactFlank& f = (*side.members)[m].flank;
      const contact::EaseOffMap& map = side.found->maps[m];
      for (int r = 0; r < f.rows; ++r)
        for (int c = 0; c < f.columns; ++c) {
          const auto k = f.index(r, c);
          out += fmt::format("{},{},{},{},{},{:.6f},{:.6f},", side.surface, side.side, f.zone, r, c,
                             radius(f.points[k]), f.points[k].z());
          out += std::isnan(map.gap_mm[k])
                     ? ",,,\n"
                     : fmt::format("{:.4f},{:.6f},{:.6f},{:.6f}\n", map.gap_mm[k] * app::kUm, degrees(map.phi_2[k]),
                                   map.pinion_radius_mm[k], map.pinion_Z_mm[k]);
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
  for (std::size_t m = 0; m < side.members->size(); ++m)
    json["zones"].push_back(grid_json((*side.members)[m].flank, side.found->maps[m]));
  return json;
}

std::string map_summary(const SideMap& side) {
  if (side.found == nullptr) return "    ease-off: none, the flanks have no common normal\n";
  const auto& found = *side.found;
  const auto where = [&](const contact::EaseOff::Place& at) {
    const Vec3& p = point_of(side, at);
    const std::string zone =
        side.members->size() > 1 ? fmt::format("zone {}, ", (*side.members)[at.member].flank.zone) : "";
    return fmt::format("{}r {:.2f}, z {:.2f} mm", zone, radius(p), p.z());
  };
  if (found.greatest.gap_mm < 1e-8) return "    ease-off: none, the flanks are conjugate\n";
  return fmt::format("    ease-off: up to {:.2f} um at {}; least at {}\n", found.greatest.gap_mm * app::kUm,
                     where(found.greatest), where(found.least));
}

std::vector<page::StudyPage::Figure> map_figures(const SideMap& side, const std::string& name) {
  std::vector<page::StudyPage::Figure> figures;
  if (side.found == nullptr) return figures;
  for (std::size_t m = 0; m < side.members->size(); ++m) {
    const contact::ContactFlank& f = (*side.members)[m].flank;
    svg::FlankFieldDrawing field{
        "ease-off, " + name, "radius from the gear's axis [mm]", "height z [mm]", "um", 0, f.columns, {}, {}, {}, 0};
    for (const int r : some_of(f.rows, kDrawnRows)) {
      ++field.rows;
      for (int c = 0; c < f.columns; ++c) {
        const auto k = f.index(r, c);
        field.x.push_back(radius(f.points[k]));
        field.y.push_back(f.points[k].z());
        field.value.push_back(side.found->maps[m].gap_mm[k] * app::kUm);
      }
    }
    const std::string zone = side.members->size() > 1 ? fmt::format(", ring {}", f.zone) : "";
    figures.push_back({"Ease-off: " + name + zone, svg::svg_flank_field(field),
                       fmt::format("How far the gear's flank stands off the one that would run with this pinion at the "
                                   "exact ratio; at most {:.2f} um. Where nothing is drawn the pinion's involute ends "
                                   "before.",
                                   side.found->greatest.gap_mm * app::kUm)});
  }
  return figures;
}

}  // namespace toothpath::ease_off
