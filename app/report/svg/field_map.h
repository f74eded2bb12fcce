// A signed quantity over a rectangle as coloured cells: blue below zero, red above, white at zero.
#pragma once

#include <string>
#include <vector>

namespace toothpath::svg {

struct FieldMap {
  std::string title;  ///< read by screen readers
  std::string x_label, y_label, unit;
  std::vector<double> x, y;    ///< rising; cell centres
  std::vector<double> values;  ///< row by row of y; NaN cells stay empty
  double largest = 0;          ///< the scale is -largest .. +largest
};

/// One <svg> in the style of the other plots; empty where there is nothing to draw.
[[nodiscard]] std::string svg_field_map(const FieldMap& map);

}  // namespace toothpath::svg
