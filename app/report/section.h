// A part of the report that is a table: page and set-up sheet show it, each in its own form. Who makes them:
// app/report/sections.
#pragma once

#include <string>
#include <vector>

namespace toothpath::report {

struct Section {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::string note;  ///< below the table
  std::string id;    ///< its anchor on the page; empty: it stands on the set-up sheet alone
};

}  // namespace toothpath::report
