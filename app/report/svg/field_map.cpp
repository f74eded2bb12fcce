#include "app/report/svg/field_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/svg/canvas.h"
#include "app/report/svg/html_text.h"

namespace toothpath::svg {
namespace {

constexpr double kFieldWidth = 480, kFieldHeight = 250, kFieldLeft = 58, kFieldTop = 8, kFieldBottom = 96;

/// White to a strong blue or red; t = -1 .. 1.
std::string colour(double t) {
  const double s = std::clamp(std::abs(t), 0.0, 1.0);
  const int far[2][3] = {{27, 79, 156}, {178, 34, 34}};
  int rgb[3];
  for (int k = 0; k < 3; ++k) rgb[k] = static_cast<int>(std::lround(255 + (far[t > 0 ? 1 : 0][k] - 255) * s));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// Edges half way between the centres, the outer ones at the outermost centres.
std::vector<double> edges(const std::vector<double>& centres) {
  std::vector<double> e{centres.front()};
  for (std::size_t i = 0; i + 1 < centres.size(); ++i) e.push_back(0.5 * (centres[i] + centres[i + 1]));
  e.push_back(centres.back());
  return e;
}

}  // namespace

std::string svg_field_map(const FieldMap& map) {
  if (map.x.size() < 2 || map.y.size() < 2 || map.values.size() != map.x.size() * map.y.size()) return {};
  const double largest = map.largest > 0 ? map.largest : 1;
  SvgCanvas canvas(kFieldWidth, kFieldHeight + kFieldTop + kFieldBottom, map.title);
  const Scale x{map.x.front(), map.x.back(), kFieldLeft, kFieldWidth - 8, false},
      y{map.y.front(), map.y.back(), kFieldTop + kFieldHeight, kFieldTop, false};
  draw_axes(canvas, x, y, map.x_label, map.y_label);
  const auto ex = edges(map.x), ey = edges(map.y);
  for (std::size_t r = 0; r < map.y.size(); ++r)
    for (std::size_t c = 0; c < map.x.size(); ++c) {
      const double v = map.values[r * map.x.size() + c];
      if (!std::isfinite(v)) continue;
      // A little overlap: neighbouring cells leave no hair lines.
      canvas.raw(fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>",
                             x(ex[c]), y(ey[r + 1]), x(ex[c + 1]) - x(ex[c]) + 0.3, y(ey[r]) - y(ey[r + 1]) + 0.3,
                             colour(v / largest)));
    }
  constexpr int kSteps = 40;
  const double top = kFieldTop + kFieldHeight + 50, left = kFieldLeft, width = kFieldWidth - kFieldLeft - 60;
  for (int k = 0; k < kSteps; ++k)
    canvas.raw(fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"12\" fill=\"{}\"/>",
                           left + width * k / kSteps, top, width / kSteps + 0.3, colour(-1 + (2 * k + 1.0) / kSteps)));
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
    canvas.text(left + 0.5 * width * (1 + share), top + 28, short_number(share * largest, 3), "middle");
  canvas.text(left + width + 24, top + 11, map.unit, "start");
  return std::move(canvas).finish();
}

}  // namespace toothpath::svg
