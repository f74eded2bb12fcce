// The pieces that the SVG plots share: shapes as text, scales, axes, a legend. Lengths in SVG units (px of the view
// box).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace toothpath::svg {

/// Collects the elements of one <svg>.
class SvgCanvas {
 public:
  /// @param label  read by screen readers, unescaped
  SvgCanvas(double width, double height, std::string_view label);

  void line(double x1, double y1, double x2, double y2, std::string_view css_class);
  void rectangle(double x, double y, double width, double height, std::string_view css_class,
                 std::string_view tip = {});
  void circle(double x, double y, double radius, std::string_view css_class, std::string_view tip = {});
  /// `d` as in the SVG path element; see move_to() and line_to().
  void path(std::string_view d, std::string_view css_class);
  /// @param anchor  "start", "middle" or "end"; `text` unescaped
  void text(double x, double y, std::string_view text, std::string_view anchor, std::string_view css_class = {});
  /// Text that runs upwards, centred on (x, y).
  void text_upwards(double x, double y, std::string_view text, std::string_view css_class = {});
  void raw(std::string_view svg) { body_ += svg; }

  [[nodiscard]] std::string finish() &&;

 private:
  std::string body_;
};

/// From a value to a place; low maps to `at_low`, high to `at_high`. A logarithmic scale needs low > 0.
struct Scale {
  double low = 0, high = 1, at_low = 0, at_high = 1;
  bool log = false;
  [[nodiscard]] double operator()(double value) const;
};

struct Tick {
  double value = 0;
  std::string label;  ///< empty: a minor tick
};

/// Ticks for a scale: 1-2-5 steps, or decades with 2 and 5 (where the decades are few).
[[nodiscard]] std::vector<Tick> ticks_for(const Scale& scale, int wanted);

/// Grid, tick labels and axis titles around the plot area that the two scales span.
void draw_axes(SvgCanvas& canvas, const Scale& x, const Scale& y, std::string_view x_label, std::string_view y_label);

struct LegendEntry {
  std::string name, css_class;
  bool dot = false;  ///< a filled dot instead of a line
};
/// Rows from `top` downwards, wrapped at `width`; returns the height used (0 without entries).
double draw_legend(SvgCanvas& canvas, const std::vector<LegendEntry>& entries, double left, double top, double width);

/// Width of a text in the plots' font, estimated from above [px].
[[nodiscard]] double text_width(std::string_view text);

/// One decimal, without a trailing ".0".
[[nodiscard]] std::string px(double value);

}  // namespace toothpath::svg
