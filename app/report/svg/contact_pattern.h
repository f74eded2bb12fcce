// A contact pattern as a drawing of the flank, as the marking compound shows it on a rolling tester.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace toothpath::svg {

/// One flank seen flat: a grid of places with the gap that the mate leaves at each.
struct PatternDrawing {
  std::string title;             ///< read by screen readers
  std::string x_label, y_label;  ///< "radius [mm]", "height z [mm]"
  int rows = 0, columns = 0;
  std::vector<double> x, y;    ///< row-major, mm
  std::vector<double> gap_um;  ///< row-major; beyond 1e6: the mate never comes
  double compound_um = 6;
  bool outline = true;  ///< false: only places that the mate meets are drawn, and no edge around them
  std::vector<std::pair<double, double>> path;  ///< path of contact, drawn as a line
  std::vector<double> moment;                   ///< of line contact, row-major: when a place touches; or empty
  std::vector<double> lines;                    ///< moments whose lines of contact are drawn
};

/// The pattern in three depths of compound, what lies just outside it in grey, the outline of the flank. Drawn to scale
/// unless the flank is longer than 6 times its height. One <svg>; empty without places.
[[nodiscard]] std::string svg_contact_pattern(const PatternDrawing& drawing);

/// The colours of a flank field, for the words beside it.
inline constexpr const char *kBelowZero = "red", *kAboveZero = "blue";
/// A signed quantity on the flank (deviation, difference of two) as these colours, -largest .. +largest. Cells with a
/// NaN corner stay empty.
struct FlankFieldDrawing {
  std::string title, x_label, y_label, unit;
  int rows = 0, columns = 0;
  std::vector<double> x, y, value;
  double largest = 0;  ///< 0: the largest size on the flank
};
[[nodiscard]] std::string svg_flank_field(const FlankFieldDrawing& drawing);

}  // namespace toothpath::svg
