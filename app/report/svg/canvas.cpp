#include "app/report/svg/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"

namespace toothpath::svg {
namespace {

std::string superscript(int exponent) {
  static constexpr const char* kDigits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                            "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string out = exponent < 0 ? "\u207b" : "";
  for (const char c : std::to_string(std::abs(exponent))) out += kDigits[c - '0'];
  return out;
}

std::string decade_label(int exponent) {
  return exponent >= -3 && exponent <= 4 ? short_number(std::pow(10.0, exponent))
                                         : fmt::format("10{}", superscript(exponent));
}

/// Enough decimals to tell neighbouring ticks apart, the same for all of them.
std::string tick_label(double value, double step) {
  const double magnitude = std::max(std::abs(value), step);
  if (magnitude >= 1e6 || magnitude < 1e-4) return short_number(value, 3);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_not_of("-0.") == std::string::npos) return "0";
  return text.starts_with('-') ? fmt::format("\u2212{}", text.substr(1)) : text;
}

std::vector<Tick> decade_ticks(const Scale& scale) {
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(scale.low) - 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(scale.high) + 1e-9));
  const int every = std::max(1, (last - first + 7) / 8);
  const double slack = 1e-9;
  for (int e = first; e <= last; ++e) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, e);
      if (value < scale.low * (1 - slack) || value > scale.high * (1 + slack)) continue;
      const bool labelled = digit == 1 ? (e - first) % every == 0 : last - first <= 2;
      if (digit == 1) ticks.push_back({value, labelled ? decade_label(e) : ""});
      else if (every == 1) ticks.push_back({value, labelled ? short_number(value) : ""});
    }
  }
  return ticks;
}

}  // namespace

SvgCanvas::SvgCanvas(double width, double height, std::string_view label)
    : body_(fmt::format(R"(<svg class="plot" viewBox="0 0 {} {}" role="img" aria-label="{}">)", px(width), px(height),
                        html_escape(label))) {}

void SvgCanvas::line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  body_ +=
      fmt::format(R"(<line x1="{}" y1="{}" x2="{}" y2="{}" class="{}"/>)", px(x1), px(y1), px(x2), px(y2), css_class);
}

void SvgCanvas::rectangle(double x, double y, double width, double height, std::string_view css_class,
                          std::string_view tip) {
  body_ += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" class="{}")", px(x), px(y), px(width), px(height),
                       css_class);
  body_ += tip.empty() ? "/>" : fmt::format("><title>{}</title></rect>", html_escape(tip));
}

void SvgCanvas::circle(double x, double y, double radius, std::string_view css_class, std::string_view tip) {
  body_ += fmt::format(R"(<circle cx="{}" cy="{}" r="{}" class="{}")", px(x), px(y), px(radius), css_class);
  body_ += tip.empty() ? "/>" : fmt::format("><title>{}</title></circle>", html_escape(tip));
}

void SvgCanvas::path(std::string_view d, std::string_view css_class) {
  body_ += fmt::format(R"(<path d="{}" class="{}"/>)", d, css_class);
}

void SvgCanvas::text(double x, double y, std::string_view text, std::string_view anchor, std::string_view css_class) {
  body_ += fmt::format(R"(<text x="{}" y="{}" text-anchor="{}" class="{}">{}</text>)", px(x), px(y), anchor, css_class,
                       html_escape(text));
}

void SvgCanvas::text_upwards(double x, double y, std::string_view text, std::string_view css_class) {
  body_ +=
      fmt::format(R"svg(<text transform="translate({} {}) rotate(-90)" text-anchor="middle" class="{}">{}</text>)svg",
                  px(x), px(y), css_class, html_escape(text));
}

std::string SvgCanvas::finish() && { return std::move(body_) + "</svg>"; }

double Scale::operator()(double value) const {
  const double share = log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return at_low + share * (at_high - at_low);
}

std::vector<double> nice_ticks(double low, double high, int wanted) {
  if (!(low < high) || wanted < 1) return {};
  const double raw = (high - low) / wanted;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * decade;
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= raw * (1 - 1e-9)) {
      step = digit * decade;
      break;
    }
  std::vector<double> ticks;
  const double slack = 1e-9 * (high - low) / step;
  const auto last = static_cast<long>(std::floor(high / step + slack));
  for (auto k = static_cast<long>(std::ceil(low / step - slack)); k <= last; ++k)
    ticks.push_back(static_cast<double>(k) * step);
  return ticks;
}

std::vector<Tick> ticks_for(const Scale& scale, int wanted) {
  if (scale.log && scale.high / scale.low >= 3) return decade_ticks(scale);
  std::vector<Tick> ticks;
  const std::vector<double> values = nice_ticks(scale.low, scale.high, wanted);
  const double step = values.size() > 1 ? values[1] - values[0] : scale.high - scale.low;
  for (const double v : values) ticks.push_back({v, tick_label(v, step)});
  return ticks;
}

void draw_axes(SvgCanvas& canvas, const Scale& x, const Scale& y, std::string_view x_label, std::string_view y_label) {
  const double width = x.at_high - x.at_low, height = y.at_low - y.at_high;
  double label_edge = 0;
  for (const Tick& tick : ticks_for(y, std::max(3, static_cast<int>(height / 42)))) {
    const double at = y(tick.value);
    canvas.line(x.at_low, at, x.at_high, at, tick.label.empty() ? "grid minor" : "grid");
    canvas.text(x.at_low - 6, at + 4, tick.label, "end");
    label_edge = std::max(label_edge, text_width(tick.label));
  }
  for (const Tick& tick : ticks_for(x, std::max(2, static_cast<int>(width / 75)))) {
    const double at = x(tick.value);
    canvas.line(at, y.at_low, at, y.at_high, tick.label.empty() ? "grid minor" : "grid");
    canvas.text(at, y.at_low + 17, tick.label, "middle");
  }
  canvas.line(x.at_low, y.at_low, x.at_high, y.at_low, "ax");
  canvas.line(x.at_low, y.at_low, x.at_low, y.at_high, "ax");
  canvas.text(x.at_low + width / 2, y.at_low + 36, x_label, "middle", "lab");
  canvas.text_upwards(13, y.at_high + height / 2, y_label, "lab");
}

double draw_legend(SvgCanvas& canvas, const std::vector<LegendEntry>& entries, double left, double top, double width) {
  constexpr double kRow = 18, kSwatch = 22, kGap = 16;
  double x = left, y = top;
  for (const LegendEntry& entry : entries) {
    const double needed = kSwatch + text_width(entry.name);
    if (x > left && x + needed > left + width) x = left, y += kRow;
    if (entry.dot) canvas.circle(x + 8, y + 8, 4.5, entry.css_class);
    else canvas.line(x, y + 8, x + 16, y + 8, entry.css_class);
    canvas.text(x + kSwatch, y + 12, entry.name, "start");
    x += needed + kGap;
  }
  return entries.empty() ? 0 : y - top + kRow + 4;
}

double text_width(std::string_view text) {
  std::size_t characters = 0;
  for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  return 7.2 * static_cast<double>(characters);
}

std::string px(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

}  // namespace toothpath::svg
