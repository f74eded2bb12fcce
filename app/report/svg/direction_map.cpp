// Polar map of the tool directions tried: lean outwards, azimuth around.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/report/svg/canvas.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"
#include "geometry/base/angle.h"

namespace toothpath::svg {
namespace {

constexpr double kMapWidth = 480, kRadius = 150;
constexpr int kGapClasses = 4;  ///< clear directions are shaded in so many steps of their gap

/// What the colours and rings of a map stand for.
struct MapScale {
  double widest_degrees = 5, greatest_gap = 0;  ///< mm
  bool any_clear = false;
  std::vector<std::string> bodies;  ///< in the way of some direction, each once, sorted
};

MapScale scale_of(const proof::DirectionChoice& choice) {
  MapScale s;
  double widest = choice.lean_rad;
  for (const auto& c : choice.candidates) {
    widest = std::max(widest, c.lean_rad);
    if (c.clear) s.any_clear = true, s.greatest_gap = std::max(s.greatest_gap, c.gap_mm);
    else if (std::find(s.bodies.begin(), s.bodies.end(), to_string(c.worst_body)) == s.bodies.end())
      s.bodies.emplace_back(to_string(c.worst_body));
  }
  std::sort(s.bodies.begin(), s.bodies.end());
  s.widest_degrees = std::max(5.0, widest / kDegree * 1.02);
  return s;
}

std::vector<LegendEntry> legend_of(const MapScale& scale, bool fixed) {
  std::vector<LegendEntry> legend;
  for (int k = 0; scale.any_clear && k < kGapClasses; ++k) {
    const double from = scale.greatest_gap * k / kGapClasses, to = scale.greatest_gap * (k + 1) / kGapClasses;
    legend.push_back({fmt::format("clear, gap {}\u2013{} mm", short_number(from, 2), short_number(to, 2)),
                      fmt::format("gap g{}", k), true});
  }
  for (std::size_t i = 0; i < scale.bodies.size(); ++i)
    legend.push_back({(scale.bodies[i].empty() ? "another body" : scale.bodies[i]) + " in the way",
                      fmt::format("block b{}", i % 4), true});
  legend.push_back({fixed ? "chosen" : "mean of the path", "chosen", true});
  return legend;
}

std::string shade_of(const proof::DirectionChoice::Candidate& c, const MapScale& scale) {
  if (!c.clear)
    return fmt::format(
        "block b{}",
        (std::find(scale.bodies.begin(), scale.bodies.end(), to_string(c.worst_body)) - scale.bodies.begin()) % 4);
  const double share = scale.greatest_gap > 0 ? c.gap_mm / scale.greatest_gap : 0;
  return fmt::format("gap g{}", std::clamp(static_cast<int>(share * kGapClasses), 0, kGapClasses - 1));
}

}  // namespace

std::string svg_direction_map(const proof::DirectionChoice& choice) {
  if (choice.candidates.empty()) return {};
  const MapScale scale = scale_of(choice);
  const std::vector<double> rings = nice_ticks(0, scale.widest_degrees, 4);
  const double outer_degrees = std::max(scale.widest_degrees, rings.back());
  const std::vector<LegendEntry> legend = legend_of(scale, choice.fixed);

  SvgCanvas probe(1, 1, "");
  const double legend_height = draw_legend(probe, legend, 10, 0, kMapWidth - 20);
  const double cx = kMapWidth / 2, cy = legend_height + kRadius + 30;
  SvgCanvas canvas(kMapWidth, cy + kRadius + 30,
                   fmt::format("Tool directions, operation {}, zone {}", choice.operation, choice.zone));
  draw_legend(canvas, legend, 10, 2, kMapWidth - 20);

  const auto radius_of = [&](double lean_rad) { return lean_rad / kDegree / outer_degrees * kRadius; };
  for (int degrees = 0; degrees < 360; degrees += 45) {
    const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
    canvas.line(cx, cy, cx + kRadius * c, cy - kRadius * s, "grid");
    const char* anchor = c > 0.3 ? "start" : c < -0.3 ? "end" : "middle";
    canvas.text(cx + (kRadius + 8) * c, cy - (kRadius + 10) * s + 4, fmt::format("{}\u00b0", degrees), anchor);
  }
  for (const double ring : rings)
    if (ring > 0) canvas.circle(cx, cy, ring / outer_degrees * kRadius, "grid ring");

  // Dots as large as the spacing allows, so that a dense map reads as areas.
  const double size = std::clamp(0.95 * kRadius / std::sqrt(static_cast<double>(choice.candidates.size())), 1.6, 7.0);
  for (const auto& c : choice.candidates) {
    const double x = cx + radius_of(c.lean_rad) * std::cos(c.azimuth_rad),
                 y = cy - radius_of(c.lean_rad) * std::sin(c.azimuth_rad);
    canvas.circle(x, y, size, shade_of(c, scale),
                  fmt::format("lean {}\u00b0, azimuth {}\u00b0: gap {} mm ({})", short_number(c.lean_rad / kDegree, 3),
                              short_number(c.azimuth_rad / kDegree, 3), short_number(c.gap_mm, 3), c.worst_body));
  }
  for (const double ring : rings)
    if (ring > 0)
      canvas.text(cx + 0.38 * radius_of(ring * kDegree), cy - 0.92 * radius_of(ring * kDegree) + 4,
                  fmt::format("{}\u00b0", short_number(ring)), "middle", "halo");
  const double azimuth = std::atan2(choice.axis.y(), choice.axis.x());
  const double lean = std::atan2(std::hypot(choice.axis.x(), choice.axis.y()), choice.axis.z());
  canvas.circle(cx + radius_of(lean) * std::cos(azimuth), cy - radius_of(lean) * std::sin(azimuth),
                std::max(6.0, size + 2), "chosen");
  return std::move(canvas).finish();
}

}  // namespace toothpath::svg
