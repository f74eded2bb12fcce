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
/// "15.00000 deg, right hand". @param rad > 0: right hand; @param without  the word for a gear whose angle is 0
[[nodiscard]] DataRow data_helix(std::string_view symbol, std::string_view what, double rad,
                                 std::string_view without = "spur");

/// One self-contained page without script.
[[nodiscard]] std::string data_sheet_html(const DataSheet& sheet);

}  // namespace toothpath::sheet
