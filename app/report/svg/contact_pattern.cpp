#include "app/report/svg/contact_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/svg/canvas.h"
#include "app/report/svg/html_text.h"

namespace toothpath::svg {
namespace {

constexpr double kPatternLeft = 62, kPatternRight = 16, kPatternWidth = 620, kPatternBottom = 46, kLongest = 6;

/// Fills for light and dark pages alike: the flank is metal, the compound blue.
constexpr const char* kFills[] = {"#0b3c8c", "#2f6fd0", "#86b4ee", "#c3c8ce", "#dfe2e5", "#eceef0"};
constexpr int kClasses = 6;

int class_of(double gap, double compound) {
  if (gap <= compound / 3) return 0;
  if (gap <= compound * 2 / 3) return 1;
  if (gap <= compound) return 2;
  if (gap <= compound * 3) return 3;
  return gap < 1e6 ? 4 : 5;
}

struct Frame {
  Scale x, y;
  double height = 0;
};

Frame frame_of(const std::vector<double>& xs, const std::vector<double>& ys, double top) {
  const auto [x0, x1] = std::minmax_element(xs.begin(), xs.end());
  const auto [y0, y1] = std::minmax_element(ys.begin(), ys.end());
  const double dx = std::max(*x1 - *x0, 1e-9), dy = std::max(*y1 - *y0, 1e-9);
  const double plot = kPatternWidth - kPatternLeft - kPatternRight;
  const double unit = plot / (dx * 1.04);
  const double high = std::clamp(dy * 1.08 * unit, plot / kLongest, plot * 0.75);
  Frame f;
  f.x = {*x0 - 0.02 * dx, *x1 + 0.02 * dx, kPatternLeft, kPatternWidth - kPatternRight};
  f.y = {*y0 - 0.04 * dy, *y1 + 0.04 * dy, top + high, top};
  f.height = top + high + kPatternBottom;
  return f;
}

/// Coloured bands: a cell has the mean of its corners' values, neighbours of one class in a row are one polygon.
template <typename Class>
void fill_cells(SvgCanvas& canvas, const Frame& f, int rows, int columns, const std::vector<double>& x,
                const std::vector<double>& y, int classes, Class class_at, const std::vector<std::string>& fills) {
  std::vector<std::string> paths(static_cast<std::size_t>(classes));
  const auto at = [&](int r, int c) {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
  };
  const auto place = [&](std::size_t k) { return px(f.x(x[k])) + " " + px(f.y(y[k])); };
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns;) {
      const int kind = class_at(r, c);
      int end = c + 1;
      while (end + 1 < columns && class_at(r, end) == kind) ++end;
      if (kind >= 0) {
        std::string& d = paths[static_cast<std::size_t>(kind)];
        d += "M" + place(at(r, c));
        for (int k = c + 1; k <= end; ++k) d += "L" + place(at(r, k));
        for (int k = end; k >= c; --k) d += "L" + place(at(r + 1, k));
        d += "Z";
      }
      c = end;
    }
  for (std::size_t k = 0; k < paths.size(); ++k)
    if (!paths[k].empty())
      canvas.raw(
          fmt::format(R"(<path d="{}" fill="{}" stroke="{}" stroke-width="0.4"/>)", paths[k], fills[k], fills[k]));
}

void outline(SvgCanvas& canvas, const Frame& f, int rows, int columns, const std::vector<double>& x,
             const std::vector<double>& y) {
  std::string d;
  const auto add = [&](int r, int c) {
    const auto k = static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
    d += (d.empty() ? "M" : "L") + px(f.x(x[k])) + " " + px(f.y(y[k]));
  };
  for (int c = 0; c < columns; ++c) add(0, c);
  for (int r = 1; r < rows; ++r) add(r, columns - 1);
  for (int c = columns - 2; c >= 0; --c) add(rows - 1, c);
  for (int r = rows - 2; r > 0; --r) add(r, 0);
  canvas.raw(fmt::format(R"(<path d="{}Z" fill="none" stroke="#5a6570" stroke-width="1"/>)", d));
}

/// Boxes with their meaning along the top; returns the height used.
double key(SvgCanvas& canvas, const std::vector<std::pair<std::string, std::string>>& entries) {
  double x = kPatternLeft, y = 6;
  for (const auto& [fill, text] : entries) {
    const double wide = 24 + text_width(text) + 14;
    if (x + wide > kPatternWidth && x > kPatternLeft) x = kPatternLeft, y += 20;
    canvas.raw(
        fmt::format(R"(<rect x="{}" y="{}" width="16" height="12" fill="{}" stroke="#8a949e" stroke-width="0.6"/>)",
                    px(x), px(y), fill));
    canvas.text(x + 21, y + 10.5, text, "start");
    x += wide;
  }
  return y + 24;
}

/// Where a grid of values has a level: a piece of line in every triangle of a cell that it crosses.
std::string level_line(const PatternDrawing& p, const Frame& f, double level) {
  std::string d;
  const auto triangle = [&](const std::size_t(&corners)[3]) {
    std::string piece;
    for (int k = 0; k < 3; ++k) {
      const std::size_t a = corners[k], b = corners[(k + 1) % 3];
      if ((p.moment[a] < level) == (p.moment[b] < level)) continue;
      const double t = (level - p.moment[a]) / (p.moment[b] - p.moment[a]);
      piece += (piece.empty() ? "M" : "L") + px(f.x(p.x[a] + t * (p.x[b] - p.x[a]))) + " " +
               px(f.y(p.y[a] + t * (p.y[b] - p.y[a])));
    }
    d += piece;
  };
  const auto columns = static_cast<std::size_t>(p.columns);
  for (std::size_t r = 0; r + 1 < static_cast<std::size_t>(p.rows); ++r)
    for (std::size_t c = 0; c + 1 < columns; ++c) {
      const std::size_t k = r * columns + c;
      triangle({k, k + 1, k + columns});
      triangle({k + 1, k + columns + 1, k + columns});
    }
  return d;
}

}  // namespace

std::string svg_contact_pattern(const PatternDrawing& p) {
  const auto size = static_cast<std::size_t>(p.rows) * static_cast<std::size_t>(p.columns);
  if (p.rows < 2 || p.columns < 2 || p.x.size() != size || p.y.size() != size || p.gap_um.size() != size) return {};
  const auto um = [&](double f) { return short_number(p.compound_um * f, 3); };
  std::vector<std::pair<std::string, std::string>> entries = {{kFills[0], "\u2264 " + um(1.0 / 3) + " \u00b5m"},
                                                              {kFills[1], "\u2264 " + um(2.0 / 3)},
                                                              {kFills[2], "\u2264 " + um(1) + " (compound)"},
                                                              {kFills[3], "\u2264 " + um(3)},
                                                              {kFills[4], "wider"},
                                                              {kFills[5], "never met"}};
  if (!p.outline) entries.pop_back();
  SvgCanvas probe(1, 1, "");
  const double top = key(probe, entries);
  std::vector<double> xs, ys;
  for (std::size_t k = 0; k < size; ++k)
    if (p.outline || p.gap_um[k] < 1e6) xs.push_back(p.x[k]), ys.push_back(p.y[k]);
  if (xs.empty()) return {};
  const Frame f = frame_of(xs, ys, top);
  SvgCanvas canvas(kPatternWidth, f.height, p.title);
  key(canvas, entries);
  draw_axes(canvas, f.x, f.y, p.x_label, p.y_label);
  const auto gap = [&](int r, int c) {
    return p.gap_um[static_cast<std::size_t>(r) * static_cast<std::size_t>(p.columns) + static_cast<std::size_t>(c)];
  };
  fill_cells(canvas, f, p.rows, p.columns, p.x, p.y, kClasses,
             [&](int r, int c) {
               const double corners[] = {gap(r, c), gap(r, c + 1), gap(r + 1, c), gap(r + 1, c + 1)};
               if (*std::max_element(corners, corners + 4) > 1e6) return p.outline ? kClasses - 1 : -1;
               return class_of((corners[0] + corners[1] + corners[2] + corners[3]) / 4, p.compound_um);
             },
             {kFills, kFills + kClasses});
  if (p.outline) outline(canvas, f, p.rows, p.columns, p.x, p.y);
  if (p.path.size() > 1) {
    std::string d;
    for (const auto& [x, y] : p.path) d += (d.empty() ? "M" : "L") + px(f.x(x)) + " " + px(f.y(y));
    canvas.raw(fmt::format(R"(<path d="{}" fill="none" stroke="#e0701c" stroke-width="1.8"/>)", d));
  }
  if (p.moment.size() == size)
    for (const double level : p.lines)
      canvas.raw(
          fmt::format(R"(<path d="{}" fill="none" stroke="#e0701c" stroke-width="1.4"/>)", level_line(p, f, level)));
  return std::move(canvas).finish();
}

std::string svg_flank_field(const FlankFieldDrawing& p) {
  const auto size = static_cast<std::size_t>(p.rows) * static_cast<std::size_t>(p.columns);
  if (p.rows < 2 || p.columns < 2 || p.x.size() != size || p.y.size() != size || p.value.size() != size) return {};
  double largest = p.largest;
  if (!(largest > 0))
    for (const double v : p.value) largest = std::max(largest, std::abs(v));
  if (!(largest > 0)) largest = 1;
  // From kBelowZero to kAboveZero.
  static const std::vector<std::string> fills = {"#b03a25", "#dc7650", "#efb08e", "#f7dccb", "#f3f3f3",
                                                 "#d3e0f2", "#9db9e2", "#5f86c8", "#2b4f9e"};
  const int classes = static_cast<int>(fills.size());
  const auto class_of_value = [&](double v) {
    return std::clamp(static_cast<int>(std::floor((v / largest + 1) / 2 * classes)), 0, classes - 1);
  };
  std::vector<std::pair<std::string, std::string>> entries;
  for (const int k : {0, 2, 4, 6, 8}) {
    const double middle = ((k + 0.5) * 2 / classes - 1) * largest;
    entries.emplace_back(fills[static_cast<std::size_t>(k)],
                         k == 4 ? "0" : short_number(middle, 2) + (k == 8 ? " " + p.unit : ""));
  }
  SvgCanvas probe(1, 1, "");
  const double top = key(probe, entries);
  const Frame f = frame_of(p.x, p.y, top);
  SvgCanvas canvas(kPatternWidth, f.height, p.title);
  key(canvas, entries);
  draw_axes(canvas, f.x, f.y, p.x_label, p.y_label);
  const auto value = [&](int r, int c) {
    return p.value[static_cast<std::size_t>(r) * static_cast<std::size_t>(p.columns) + static_cast<std::size_t>(c)];
  };
  fill_cells(
      canvas, f, p.rows, p.columns, p.x, p.y, classes,
      [&](int r, int c) {
        const double mean = (value(r, c) + value(r, c + 1) + value(r + 1, c) + value(r + 1, c + 1)) / 4;
        return std::isnan(mean) ? -1 : class_of_value(mean);
      },
      fills);
  outline(canvas, f, p.rows, p.columns, p.x, p.y);
  return std::move(canvas).finish();
}

}  // namespace toothpath::svg
