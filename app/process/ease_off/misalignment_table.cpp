#include "app/process/ease_off/misalignment_table.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "app/base/units.h"
#include "app/process/ease_off/motion.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::ease_off {
namespace {

using Json = nlohmann::ordered_json;
using contact::Misalignment;

/// A quantity of a misalignment, as the tables say it.
struct Quantity {
  const char* name;
  double Misalignment::*value;
  bool angle;
  [[nodiscard]] std::string text(double by) const {
    return angle ? fmt::format("{} {:+g} deg", name, degrees(by)) : fmt::format("{} {:+g} mm", name, by);
  }
};
constexpr std::uint64_t kSeed = 1328;
constexpr Quantity kQuantities[] = {{"offset", &Misalignment::offset_mm, false},
                                    {"angle", &Misalignment::angle_rad, true},
                                    {"pinion axial", &Misalignment::axial_mm, false},
                                    {"gear axial", &Misalignment::gear_axial_mm, false}};

Json moved_json(const Misalignment& m) {
  return {{"offset_mm", m.offset_mm},
          {"angle_deg", degrees(m.angle_rad)},
          {"pinion_axial_mm", m.axial_mm},
          {"gear_axial_mm", m.gear_axial_mm}};
}

/// Edges that the pattern reaches.
std::vector<std::string> reached(const contact::PatternPlace& place, double compound_mm) {
  std::vector<std::string> out;
  for (int e = 0; e < contact::kEdges; ++e)
    if (place.reaches(contact::Edge(e), compound_mm)) out.emplace_back(to_string(contact::Edge(e)));
  return out;
}

std::string percent(double low, double high) { return fmt::format("{:.0f} to {:.0f}", 100 * low, 100 * high); }

}  // namespace

std::vector<NamedMisalignment> single_misalignments(const Misalignment& stands, const Misalignment& box) {
  std::vector<NamedMisalignment> list = {{"as it stands", stands}};
  for (const Quantity& q : kQuantities)
    for (const double way : {-1.0, 1.0}) {
      if (box.*q.value == 0) continue;
      Misalignment moved = stands;
      moved.*q.value += way * box.*q.value;
      list.push_back({q.text(way * box.*q.value), moved});
    }
  return list;
}

std::vector<NamedMisalignment> corner_misalignments(const Misalignment& stands, const Misalignment& box) {
  std::vector<NamedMisalignment> list = {{"", stands}};
  for (const Quantity& q : kQuantities) {
    if (box.*q.value == 0) continue;
    std::vector<NamedMisalignment> next;
    for (const auto& corner : list)
      for (const double way : {-1.0, 1.0}) {
        Misalignment moved = corner.moved;
        moved.*q.value += way * box.*q.value;
        next.push_back({corner.name + (corner.name.empty() ? "" : ", ") + q.text(way * box.*q.value), moved});
      }
    list = std::move(next);
  }
  if (list.size() < 4) list.clear();  // those stand among the single ones
  return list;
}

std::vector<NamedMisalignment> random_misalignments(const Misalignment& stands, const Misalignment& box, int count) {
  std::mt19937_64 random(kSeed);
  std::vector<NamedMisalignment> list;
  for (int k = 1; k <= count; ++k) {
    NamedMisalignment at{fmt::format("at random {}:", k), stands};
    for (const Quantity& q : kQuantities) {
      if (box.*q.value == 0) continue;
      // By hand: the library's distributions differ from one to the next.
      const double share = std::round((2 * (double(random() >> 11) * 0x1p-53) - 1) * 1000) / 1000;
      at.moved.*q.value += share * box.*q.value;
      at.name += (at.name.back() == ':' ? " " : ", ") + q.text(share * box.*q.value);
    }
    list.push_back(std::move(at));
  }
  return list;
}

Result<std::vector<MisalignmentRow>> roll_rows(const RollSide& roll, const std::vector<NamedMisalignment>& list) {
  std::vector<std::optional<Result<contact::MisalignedContact>>> found(2 * list.size());
  WorkShare share(double(found.size()));
  tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t k) {
    const WorkShare part(share);
    found[k] = roll(k % 2, list[k / 2].moved);
  });
  std::vector<MisalignmentRow> rows;
  for (std::size_t k = 0; k < list.size(); ++k) {
    MisalignmentRow row{list[k], {}};
    for (const std::size_t s : {0u, 1u}) {
      auto& side = *found[2 * k + s];
      if (!side) return fail("{}: {}", list[k].name, side.error().message);
      row.sides[s] = std::move(*side);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string reached_text(const contact::PatternPlace& at_edges, double compound_mm) {
  if (!at_edges.any) return "no mark";
  std::string text;
  for (const auto& edge : reached(at_edges, compound_mm)) text += (text.empty() ? "" : ", ") + edge;
  return text.empty() ? "inside" : text;
}

Json place_json(std::size_t zone, const contact::PatternPlace& p, double compound_mm) {
  return {{"zone", zone},
          {"marked", p.any},
          {"profile", p.profile},
          {"lead", p.lead},
          {"profile_extent", {p.low, p.high}},
          {"lead_extent", {p.inner, p.outer}},
          {"reaches", reached(p, compound_mm)}};
}

Json table_json(const MisalignmentTable& table) {
  Json json = {{"box", moved_json(table.box)}, {"margin", table.margin}, {"rows", Json::array()}};
  for (const auto& row : table.rows) {
    Json r = {{"name", row.at.name}};
    r.update(moved_json(row.at.moved));
    r["flanks"] = Json::array();
    for (const std::size_t s : {0u, 1u}) {
      const auto& side = row.sides[s];
      const PairWords& words = *table.words;
      Json flank = {{words.side_key, words.numbered ? Json(s == 0 ? 1 : -1) : Json(words.sides[s])},
                    {"transmission_error",
                     transmission_error_json(side.error_mean_rad, side.error_range_rad, table.pitch_radius_mm)},
                    {"margin_gap_um", side.margin_gap_mm < 1e100 ? Json(side.margin_gap_mm * app::kUm) : Json(nullptr)},
                    {"zones", Json::array()}};
      for (std::size_t m = 0; m < side.at_edges.size(); ++m) {
        flank["zones"].push_back(place_json(m, side.at_edges[m], table.compound_mm));
      }
      r["flanks"].push_back(std::move(flank));
    }
    json["rows"].push_back(std::move(r));
  }
  return json;
}

page::PageTable table_page(const MisalignmentTable& table, const std::string& title) {
  page::PageTable out{title,
                      {"misalignment", table.words->flank, table.words->ring, "error range urad", "um", "profile %",
                       "lead %", "profile from to %", "lead from to %", "reaches"},
                      {},
                      ""};
  out.note = fmt::format(
      "Centre and extent of the pattern in shares of the flank: profile from the fillet line to the tip, lead from the "
      "inner end of the {} to the outer. Micrometres at the {} {:.3f} mm.",
      table.words->ring, table.words->lever, table.pitch_radius_mm);
  for (const auto& row : table.rows)
    for (const std::size_t s : {0u, 1u})
      for (std::size_t m = 0; m < row.sides[s].at_edges.size(); ++m) {
        const auto& side = row.sides[s];
        const contact::PatternPlace& p = side.at_edges[m];
        out.rows.push_back({row.at.name, table.words->sides[s], std::to_string(m),
                            fmt::format("{:.3f}", side.error_range_rad * app::kMicro),
                            fmt::format("{:.4f}", side.error_range_rad * table.pitch_radius_mm * app::kUm),
                            p.any ? fmt::format("{:.1f}", 100 * p.profile) : "-",
                            p.any ? fmt::format("{:.1f}", 100 * p.lead) : "-", p.any ? percent(p.low, p.high) : "-",
                            p.any ? percent(p.inner, p.outer) : "-", reached_text(p, table.compound_mm)});
      }
  return out;
}

svg::LineChart centre_chart(const MisalignmentTable& table) {
  svg::LineChart chart;
  chart.title = "Way of the pattern's centre under misalignment";
  chart.x_label = "lead, from the inner end [%]";
  chart.y_label = "profile, from the fillet line [%]";
  chart.note = "Three dots a line: less, as the pair stands, more.";
  chart.markers = true;
  if (table.rows.empty()) return chart;
  const auto add = [&](svg::ChartSeries& series, const MisalignmentRow& row, std::size_t s, std::size_t m) {
    const contact::PatternPlace& p = row.sides[s].at_edges[m];
    if (!p.any) return;
    series.x.push_back(100 * p.lead);
    series.y.push_back(100 * p.profile);
  };
  for (std::size_t n = 1; n + 1 < table.rows.size(); n += 2)
    for (const std::size_t s : {0u, 1u})
      for (std::size_t m = 0; m < table.rows[n].sides[s].at_edges.size(); ++m) {
        const std::string& name = table.rows[n].at.name;
        svg::ChartSeries series;
        series.name = name.substr(0, name.find_first_of("+-") - 1) + ", " + table.words->side(s);
        if (table.rows[n].sides[s].at_edges.size() > 1) series.name += fmt::format(", {} {}", table.words->ring, m);
        for (const MisalignmentRow* row : {&table.rows[n], &table.rows[0], &table.rows[n + 1]}) add(series, *row, s, m);
        chart.series.push_back(std::move(series));
      }
  return chart;
}

}  // namespace toothpath::ease_off
