// What a plot shows: the data behind the SVG plots of the report page. No drawing here (see app/report/svg/plot.h).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace toothpath::svg {

/// One curve. `x` and `y` have the same length; a NaN (or a size beyond 1e100) in `y` interrupts the curve.
struct ChartSeries {
  std::string name;
  std::vector<double> x, y;
};

/// A horizontal line at a value that matters: an axis limit, a tolerance.
struct ChartLimit {
  std::string name;
  double y = 0;
};

/// A line plot. Labels carry the unit in brackets, "X [mm]". On a logarithmic axis values <= 0 are left out.
struct LineChart {
  std::string title;
  std::string x_label, y_label;
  std::vector<ChartSeries> series;
  std::vector<ChartLimit> limits;
  bool log_x = false, log_y = false;
  bool markers = false;      ///< a dot at every point: for tables of few points
  std::string note;          ///< one sentence below the plot, may be empty
  double plot_height = 200;  ///< of a plot that is 480 wide
};

/// Counts in bins of equal width.
struct HistogramChart {
  std::string title;
  std::string x_label;
  double from = 0, step = 1;  ///< left edge of the first bin and width of a bin, in the unit of x_label
  std::vector<std::size_t> counts;
  std::vector<ChartLimit> limits;       ///< vertical lines: `y` is a place on the x axis
  std::string y_label = "grid points";  ///< what is counted
  bool log_x = false;                   ///< `from` and `step` are decimal logarithms of x
};

/// Pairs of bars on a logarithmic scale: what was predicted and what was measured.
struct PairedBarChart {
  struct Row {
    std::string name;
    double first = 0, second = 0;
  };
  std::string title;
  std::string x_label;
  std::string first_name = "predicted", second_name = "measured";
  std::vector<Row> rows;
};

}  // namespace toothpath::svg
