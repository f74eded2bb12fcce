#include "app/report/svg/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/report/svg/canvas.h"
#include "app/report/svg/html_text.h"

namespace toothpath::svg {
namespace {

constexpr double kPlotWidth = 480, kPlotHeight = 200, kPlotLeft = 64, kPlotRight = 14, kPlotTop = 10, kPlotBottom = 44;
constexpr std::size_t kColumns = 400;  ///< of a thinned curve
constexpr double kDrawable = 1e100;    ///< larger values are gaps: differences of two could overflow

bool drawable(double v, bool log) { return std::abs(v) < kDrawable && (!log || v > 1 / kDrawable); }

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double v, bool log) {
    if (drawable(v, log)) low = std::min(low, v), high = std::max(high, v);
  }
  [[nodiscard]] bool empty() const { return low > high; }
  /// Widened by a share of itself; a single value gets some room on both sides.
  void widen(double share, bool log) {
    if (log) {
      const double factor = high > low ? std::pow(high / low, share) : 2;
      low /= factor, high *= factor;
    } else {
      const double room = high > low ? share * (high - low) : std::max(std::abs(high) * 0.1, 1e-3);
      low -= room, high += room;
    }
  }
};

struct Point {
  double x = 0, y = 0;
};

/// First, least, greatest and last point of each column, in order; all points when those of the curve, `total`, are
/// few.
std::vector<Point> thinned(const std::vector<Point>& points, double low, double high, std::size_t total) {
  if (total <= 4 * kColumns) return points;
  const auto column_of = [&](const Point& p) {
    return static_cast<std::size_t>(std::clamp((p.x - low) / (high - low), 0.0, 1.0) * (kColumns - 1));
  };
  std::vector<Point> out;
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i, least = i, greatest = i;
    while (end < points.size() && column_of(points[end]) == column_of(points[i])) {
      if (points[end].y < points[least].y) least = end;
      if (points[end].y > points[greatest].y) greatest = end;
      ++end;
    }
    std::size_t keep[] = {i, std::min(least, greatest), std::max(least, greatest), end - 1};
    for (std::size_t k = 0; k < 4; ++k)
      if (k == 0 || keep[k] != keep[k - 1]) out.push_back(points[keep[k]]);
    i = end;
  }
  return out;
}

/// The curve in pieces without gaps.
std::vector<std::vector<Point>> pieces(const ChartSeries& series, bool log_x, bool log_y) {
  std::vector<std::vector<Point>> out;
  bool open = false;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    const double x = series.x[i], y = series.y[i];
    const bool drawn = drawable(x, log_x) && drawable(y, log_y);
    if (drawn && !open) out.emplace_back();
    if (drawn) out.back().push_back({x, y});
    open = drawn;
  }
  return out;
}

std::string path_of(const std::vector<Point>& points, const Scale& x, const Scale& y) {
  std::string d;
  std::string last;
  for (const Point& p : points) {
    std::string at = fmt::format("{} {}", px(x(p.x)), px(y(p.y)));
    if (at == last) continue;
    d += d.empty() ? "M" : "L";
    d += at;
    last = std::move(at);
  }
  return points.size() == 1 ? d + "h.1" : d;
}

}  // namespace

std::string svg_line_chart(const LineChart& chart) {
  Range across, up;
  for (const ChartSeries& series : chart.series)
    for (const auto& piece : pieces(series, chart.log_x, chart.log_y))
      for (const Point& p : piece) across.add(p.x, chart.log_x), up.add(p.y, chart.log_y);
  if (across.empty()) return {};
  for (const ChartLimit& limit : chart.limits) up.add(limit.y, chart.log_y);
  if (chart.markers || !(across.low < across.high)) across.widen(0.04, chart.log_x);
  up.widen(0.06, chart.log_y);

  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < chart.series.size(); ++i)
    if (chart.series.size() > 1 || !chart.limits.empty())
      legend.push_back({chart.series[i].name, fmt::format("s{}", i % 8)});
  if (!chart.limits.empty()) legend.push_back({chart.limits.size() == 1 ? chart.limits[0].name : "limit", "lim"});

  SvgCanvas probe(1, 1, "");  // only to learn how many rows the legend takes
  const double legend_height = draw_legend(probe, legend, kPlotLeft, 0, kPlotWidth - kPlotLeft - kPlotRight);
  const double top = kPlotTop + legend_height;
  SvgCanvas canvas(kPlotWidth, top + chart.plot_height + kPlotBottom, chart.title);
  draw_legend(canvas, legend, kPlotLeft, 2, kPlotWidth - kPlotLeft - kPlotRight);
  const Scale x{across.low, across.high, kPlotLeft, kPlotWidth - kPlotRight, chart.log_x};
  const Scale y{up.low, up.high, top + chart.plot_height, top, chart.log_y};
  draw_axes(canvas, x, y, chart.x_label, chart.y_label);
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const std::string css_class = fmt::format("s{}", i % 8);
    for (const auto& piece : pieces(chart.series[i], chart.log_x, chart.log_y)) {
      canvas.path(path_of(thinned(piece, across.low, across.high, chart.series[i].x.size()), x, y), "cv " + css_class);
      if (!chart.markers) continue;
      for (const Point& p : piece)
        canvas.circle(x(p.x), y(p.y), 3.2, "dot " + css_class,
                      fmt::format("{}: {}, {}", chart.series[i].name, short_number(p.x), short_number(p.y)));
    }
  }
  for (const ChartLimit& limit : chart.limits)
    if (drawable(limit.y, chart.log_y)) canvas.line(kPlotLeft, y(limit.y), kPlotWidth - kPlotRight, y(limit.y), "lim");
  return std::move(canvas).finish();
}

std::string svg_histogram(const HistogramChart& chart) {
  std::size_t most = 0;
  for (const std::size_t count : chart.counts) most = std::max(most, count);
  if (most == 0 || !(chart.step > 0)) return {};
  Range across;
  const auto edge = [&](std::size_t bin) {
    const double at = chart.from + chart.step * static_cast<double>(bin);
    return chart.log_x ? std::pow(10.0, at) : at;
  };
  across.add(edge(0), chart.log_x);
  across.add(edge(chart.counts.size()), chart.log_x);
  for (const ChartLimit& limit : chart.limits) across.add(limit.y, chart.log_x);
  across.widen(0.02, chart.log_x);

  std::vector<LegendEntry> legend;
  for (const ChartLimit& limit : chart.limits)
    legend.push_back({fmt::format("{} {}", limit.name, short_number(limit.y)), "lim"});
  SvgCanvas probe(1, 1, "");
  const double top = kPlotTop + draw_legend(probe, legend, kPlotLeft, 0, kPlotWidth - kPlotLeft - kPlotRight);
  SvgCanvas canvas(kPlotWidth, top + kPlotHeight + kPlotBottom, chart.title);
  draw_legend(canvas, legend, kPlotLeft, 2, kPlotWidth - kPlotLeft - kPlotRight);
  const Scale x{across.low, across.high, kPlotLeft, kPlotWidth - kPlotRight, chart.log_x};
  const Scale y{0, static_cast<double>(most) * 1.05, top + kPlotHeight, top};
  draw_axes(canvas, x, y, chart.x_label, chart.y_label);
  for (std::size_t i = 0; i < chart.counts.size(); ++i) {
    if (chart.counts[i] == 0) continue;
    const double left = edge(i), right = edge(i + 1);
    const double at = y(static_cast<double>(chart.counts[i]));
    canvas.rectangle(x(left), at, std::max(0.7, x(right) - x(left) - 0.6), y.at_low - at, "bar s0",
                     fmt::format("{} to {}: {}", short_number(left), short_number(right), chart.counts[i]));
  }
  for (const ChartLimit& limit : chart.limits)
    if (drawable(limit.y, false)) canvas.line(x(limit.y), y.at_low, x(limit.y), y.at_high, "lim");
  return std::move(canvas).finish();
}

}  // namespace toothpath::svg
