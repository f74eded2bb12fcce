#include "app/report/limits/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/report/page/study_page.h"
#include "geometry/base/angle.h"
#include "machines/assumed.h"

namespace toothpath::limits {
namespace {

constexpr int kPoints = 121;
constexpr double kSameLimit = 1e-6;  // mm: limits of both sides that agree

std::string side_name(int side) { return side > 0 ? "+1" : "-1"; }

/// A vertical line of the plot.
svg::ChartSeries mark(const std::string& name, double r, double low, double high) {
  return {name, {r, r}, {low, high}};
}

/// Radii that the plots of a zone span: a little more than the zone and its limits.
std::pair<double, double> span_of(const face_gear::FaceGearRing& ring) {
  double low = ring.zone.inner_radius_mm, high = ring.zone.outer_radius_mm;
  for (const auto& flank : ring.limits.flanks)
    for (const auto& r : {flank.undercut_radius, flank.involute_start_radius})
      if (r) low = std::min(low, *r);
  if (ring.limits.pointing_radius)
    high = std::max(high, std::min(*ring.limits.pointing_radius, high + 4 * (high - low)));
  const double margin = 0.06 * (high - low);
  return {low - margin, high + margin};
}

svg::LineChart land_chart(const face_gear::FaceGearRing& ring, std::size_t zone) {
  svg::LineChart chart;
  chart.title = fmt::format("Top land over the radius, zone {}", zone);
  chart.x_label = "radius [mm]";
  chart.y_label = "thickness on the tip surface [mm]";
  const auto [low, high] = span_of(ring);
  svg::ChartSeries land{"tooth thickness", {}, {}};
  double most = 0;
  for (int k = 0; k < kPoints; ++k) {
    const double r = low + (high - low) * k / (kPoints - 1);
    const auto s = face_gear::tip_thickness(ring.surface, r);
    land.x.push_back(r);
    land.y.push_back(s.value_or(std::numeric_limits<double>::quiet_NaN()));
    if (s) most = std::max(most, *s);
  }
  chart.series.push_back(std::move(land));
  const double top = 1.05 * most;
  chart.series.push_back(
      {"zone",
       {ring.zone.inner_radius_mm, ring.zone.inner_radius_mm, ring.zone.outer_radius_mm, ring.zone.outer_radius_mm},
       {0, 0.03 * top, 0.03 * top, 0}});
  for (const auto& flank : ring.limits.flanks)
    if (flank.undercut_radius)
      chart.series.push_back(mark("undercut, flank " + side_name(flank.side), *flank.undercut_radius, 0, top));
  for (const auto& flank : ring.limits.flanks)
    if (flank.involute_start_radius)
      chart.series.push_back(
          mark("involute start, flank " + side_name(flank.side), *flank.involute_start_radius, 0, top));
  if (ring.limits.pointing_radius && *ring.limits.pointing_radius < high)
    chart.series.push_back(mark("pointed", *ring.limits.pointing_radius, 0, top));
  chart.limits = {{"land 0", 0},
                  {fmt::format("land {:g} mm", ring.limits.practical_land_mm), ring.limits.practical_land_mm}};
  chart.note = "Inner limit: " + governing_limit(ring.limits) + fmt::format(", {:.4f} mm.", ring.limits.inner_limit);
  return chart;
}

svg::LineChart height_chart(const face_gear::FaceGearRing& ring, std::size_t zone) {
  svg::LineChart chart;
  chart.title = fmt::format("Heights over the radius, zone {}", zone);
  chart.x_label = "radius [mm]";
  chart.y_label = "z [mm]";
  chart.series = {
      {"tip surface", {}, {}}, {"fillet line, flank +1", {}, {}}, {"fillet line, flank -1", {}, {}}, {"root", {}, {}}};
  const auto [low, high] = span_of(ring);
  for (int k = 0; k < kPoints; ++k) {
    const double r = low + (high - low) * k / (kPoints - 1);
    const auto add = [&](std::size_t n, const std::optional<double>& z) {
      chart.series[n].x.push_back(r);
      chart.series[n].y.push_back(z.value_or(std::numeric_limits<double>::quiet_NaN()));
    };
    add(0, r > std::abs(ring.surface.E) ? std::optional(ring.surface.z_tip(r)) : std::nullopt);
    add(1, face_gear::fillet_line_height(ring.surface, 1, r));
    add(2, face_gear::fillet_line_height(ring.surface, -1, r));
    add(3, face_gear::root_height(ring.surface, r));
  }
  chart.note = "Between tip surface and fillet line lies the involute flank; a fillet line ends at its undercut.";
  return chart;
}

std::string number_or_none(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "none";
}

}  // namespace

std::string governing_limit(const face_gear::ZoneLimits& limits) {
  std::string name = limits.inner_limit_name, side;
  int sides = 0;
  for (const auto& flank : limits.flanks) {
    bool here = false;
    for (const auto& r : {flank.undercut_radius, flank.involute_start_radius, flank.flank_start_radius})
      here = here || (r && std::abs(*r - limits.inner_limit) < kSameLimit);
    if (!here) continue;
    ++sides;
    side = ", flank " + side_name(flank.side);
  }
  return sides == 1 ? name + side : name;
}

std::vector<svg::LineChart> limit_charts(const face_gear::FaceGear& gear) {
  std::vector<svg::LineChart> charts;
  for (std::size_t k = 0; k < gear.rings().size(); ++k) {
    charts.push_back(land_chart(gear.rings()[k], k));
    charts.push_back(height_chart(gear.rings()[k], k));
  }
  return charts;
}

std::string limits_page(const face_gear::FaceGear& gear, const std::string& job_name,
                        const std::vector<std::string>& assumed) {
  page::StudyPage page;
  const auto& p = gear.parameters();
  page.title = "Limits of the flanks: " + job_name;
  page.subtitle = fmt::format("face gear {}/{}, module {:g} mm, offset {:g} mm, shaft angle {:g} deg", p.shaper_teeth,
                              p.teeth, p.module_mm, p.offset_mm, degrees(p.shaft_angle_rad));
  page.verdict = gear.warnings().empty()
                     ? "inside all limits"
                     : fmt::format("{} remark{}", gear.warnings().size(), gear.warnings().size() == 1 ? "" : "s");
  page.good = gear.warnings().empty();
  page.introduction = gear.warnings();
  if (page.introduction.empty())
    page.introduction = {"Every zone lies between the undercut and the pointed end of its teeth."};
  if (!assumed.empty())
    page.introduction.push_back(
        fmt::format("The limits are those of the gear alone. Of the machine that it was planned for are assumed {}.",
                    machines::counted_keys(assumed)));
  page.charts = limit_charts(gear);
  page::PageTable table{"Limits",
                        {"zone", "flank", "undercut radius", "involute start", "pointed radius", "land radius",
                         "fillet line at the inner end", "at the outer end"},
                        {},
                        ""};
  for (std::size_t k = 0; k < gear.rings().size(); ++k) {
    const auto& ring = gear.rings()[k];
    for (const auto& flank : ring.limits.flanks)
      table.rows.push_back(
          {std::to_string(k), side_name(flank.side), number_or_none(flank.undercut_radius),
           number_or_none(flank.involute_start_radius), number_or_none(ring.limits.pointing_radius),
           number_or_none(ring.limits.land_radius),
           number_or_none(face_gear::fillet_line_height(ring.surface, flank.side, ring.zone.inner_radius_mm)),
           number_or_none(face_gear::fillet_line_height(ring.surface, flank.side, ring.zone.outer_radius_mm))});
    table.note +=
        fmt::format("Zone {}: the inner limit {:.4f} mm is the {}; land radius is where {:g} mm of land are left. ", k,
                    ring.limits.inner_limit, governing_limit(ring.limits), ring.limits.practical_land_mm);
  }
  page.tables = {std::move(table)};
  return study_page_html(page);
}

}  // namespace toothpath::limits
