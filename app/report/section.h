// A part of the report that is a table: page and set-up sheet show it, each in its own form. Who makes them:
// app/report/sections.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/report/svg/chart.h"

namespace toothpath::report {

struct Section {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::string note;  ///< below the table
  std::string id;    ///< its anchor on the page; empty: it stands on the set-up sheet alone
  std::size_t sheet_rows =
      std::size_t(-1);                      ///< first rows that the set-up sheet prints; 0: it stands on the page alone
  std::vector<svg::LineChart> charts = {};  ///< on the page, above the table
};

}  // namespace toothpath::report
