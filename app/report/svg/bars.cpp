// Horizontal bars: the ledger of errors and the seconds of the stages.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/svg/canvas.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"

namespace toothpath::svg {
namespace {

constexpr double kBarsWidth = 480, kBarsRight = 58, kMostDecades = 8;

template <typename Rows>
double label_room(const Rows& rows) {
  double room = 40;
  for (const auto& row : rows) room = std::max(room, text_width(row));
  return std::min(room, 190.0) + 12;
}

/// Long names end in an ellipsis rather than run into the bars.
std::string fitted(const std::string& name, double room) {
  if (text_width(name) <= room) return name;
  std::string out;
  for (std::size_t i = 0; i < name.size() && text_width(out) + 14 < room; ++i) out += name[i];
  while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80U) != 0) out.pop_back();
  return out + "\u2026";
}

}  // namespace

std::string svg_paired_bars(const PairedBarChart& chart) {
  double low = 0, high = 0;
  const auto add = [&](double v) {
    if (!std::isfinite(v) || v <= 0) return;
    low = low > 0 ? std::min(low, v) : v;
    high = std::max(high, v);
  };
  std::vector<std::string> names;
  for (const auto& row : chart.rows) add(row.first), add(row.second), names.push_back(row.name);
  if (chart.rows.empty()) return {};
  if (high <= 0) low = high = 1;
  const double last = std::ceil(std::log10(high) + 1e-9);
  const double first = std::max(last - kMostDecades, std::min(std::floor(std::log10(low) - 1e-9), last - 1));

  constexpr double kRow = 34, kBarsTop = 26;
  const double left = label_room(names);
  const double bottom = kBarsTop + kRow * static_cast<double>(chart.rows.size());
  SvgCanvas canvas(kBarsWidth, bottom + 44, chart.title);
  draw_legend(canvas, {{chart.first_name, "bar s0", true}, {chart.second_name, "bar s1", true}}, left, 2,
              kBarsWidth - left - kBarsRight);
  const Scale x{std::pow(10.0, first), std::pow(10.0, last), left, kBarsWidth - kBarsRight, true};
  for (const Tick& tick : ticks_for(x, 5)) {
    canvas.line(x(tick.value), kBarsTop, x(tick.value), bottom, tick.label.empty() ? "grid minor" : "grid");
    canvas.text(x(tick.value), bottom + 17, tick.label, "middle");
  }
  const auto bar = [&](double value, double top, std::string_view css_class) {
    const bool drawn = std::isfinite(value) && value > 0;
    const double length = drawn ? std::max(1.5, x(value) - left) : 0;
    if (drawn) canvas.rectangle(left, top, length, 11, css_class);
    canvas.text(left + length + 5, top + 10, short_number(value, 3), "start", "val");
  };
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    const double top = kBarsTop + kRow * static_cast<double>(i) + 5;
    canvas.text(left - 8, top + 16, fitted(chart.rows[i].name, left - 12), "end");
    bar(chart.rows[i].first, top, "bar s0");
    bar(chart.rows[i].second, top + 13, "bar s1");
  }
  canvas.line(left, kBarsTop, left, bottom, "ax");
  canvas.line(left, bottom, kBarsWidth - kBarsRight, bottom, "ax");
  canvas.text((left + kBarsWidth - kBarsRight) / 2, bottom + 36, chart.x_label, "middle", "lab");
  return std::move(canvas).finish();
}

std::string svg_bars(const std::vector<std::pair<std::string, double>>& rows, const std::string& x_label) {
  double high = 0;
  std::vector<std::string> names;
  for (const auto& [name, value] : rows) {
    names.push_back(name);
    if (std::isfinite(value)) high = std::max(high, value);
  }
  if (rows.empty()) return {};
  if (high <= 0) high = 1;
  constexpr double kRow = 22, kBarsTop = 8;
  const double left = label_room(names);
  const double bottom = kBarsTop + kRow * static_cast<double>(rows.size());
  SvgCanvas canvas(kBarsWidth, bottom + 44, x_label);
  const Scale x{0, high, left, kBarsWidth - kBarsRight};
  for (const Tick& tick : ticks_for(x, 5)) {
    canvas.line(x(tick.value), kBarsTop, x(tick.value), bottom, "grid");
    canvas.text(x(tick.value), bottom + 17, tick.label, "middle");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double top = kBarsTop + kRow * static_cast<double>(i) + 4;
    const double length = std::isfinite(rows[i].second) ? std::max(0.0, x(rows[i].second) - left) : 0;
    canvas.text(left - 8, top + 11, fitted(names[i], left - 12), "end");
    canvas.rectangle(left, top, length, 14, "bar s0");
    canvas.text(left + length + 5, top + 11, short_number(rows[i].second, 3), "start", "val");
  }
  canvas.line(left, kBarsTop, left, bottom, "ax");
  canvas.line(left, bottom, kBarsWidth - kBarsRight, bottom, "ax");
  canvas.text((left + kBarsWidth - kBarsRight) / 2, bottom + 36, x_label, "middle", "lab");
  return std::move(canvas).finish();
}

}  // namespace toothpath::svg
