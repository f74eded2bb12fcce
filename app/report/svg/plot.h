// The plots of the report page as inline SVG: axes with units and ticks, a legend, colours from the style sheet of the
// page.
//
// Every function returns one <svg> element without script. Colours are classes (s0 ... s7, ax, grid, lim), so one text
// serves light, dark and print. Where there is nothing to draw the result is empty.
#pragma once

#include <string>
#include <vector>

#include "app/report/svg/chart.h"
#include "cam/proof/verification.h"

namespace toothpath::svg {

/// Long curves are thinned to first, least, greatest and last point of each of some hundred columns: no peak is lost.
[[nodiscard]] std::string svg_line_chart(const LineChart& chart);

[[nodiscard]] std::string svg_histogram(const HistogramChart& chart);

/// Rows of two bars on a logarithmic scale over at most eight decades; values <= 0 have no bar.
[[nodiscard]] std::string svg_paired_bars(const PairedBarChart& chart);

/// One bar a name, linear scale from zero.
[[nodiscard]] std::string svg_bars(const std::vector<std::pair<std::string, double>>& rows, const std::string& x_label);

/// Directions tried for the tool: distance from the centre is the lean against the gear axis, angle the azimuth about
/// it (0 to the right, counter-clockwise), both of the axis from tip to holder. Clear directions are filled by their
/// gap; the others carry the colour of the body that is in the way. A ring marks the direction chosen.
[[nodiscard]] std::string svg_direction_map(const proof::DirectionChoice& choice);

/// Ticks at 1, 2 or 5 times a power of ten inside [low, high]; about `wanted` of them. Empty unless low < high.
[[nodiscard]] std::vector<double> nice_ticks(double low, double high, int wanted);

}  // namespace toothpath::svg
