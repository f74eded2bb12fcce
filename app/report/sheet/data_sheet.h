// data_sheet.html: the table of gear data as it stands on a drawing, on A4 paper.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::sheet {

/// One line of the table; the value with its unit.
struct DataRow {
  std::string symbol, what, value;
};
struct DataGroup {
  std::string title;
  std::vector<DataRow> rows;
};
struct DataSheet {
  std::string job_name, job_file;
  std::string words;  ///< what the gear is, in one line
  std::vector<DataGroup> groups;
  std::vector<std::string> notes = {};
};

[[nodiscard]] DataRow data_number(std::string_view symbol, std::string_view what, double value);
[[nodiscard]] DataRow data_length(std::string_view symbol, std::string_view what, double mm);
[[nodiscard]] DataRow data_angle(std::string_view symbol, std::string_view what, double rad);
/// "right 15.0000 deg", "spur" where it is 0. @param rad > 0: right hand
[[nodiscard]] DataRow data_helix(std::string_view symbol, std::string_view what, double rad);

/// One self-contained page without script.
[[nodiscard]] std::string data_sheet_html(const DataSheet& sheet);

}  // namespace toothpath::sheet
