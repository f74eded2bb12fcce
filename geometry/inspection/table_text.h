// Tables as spreadsheets and measuring machines write them: cells between semicolons, tabs, commas or blanks, in quotes
// or not, numbers with a decimal point or a decimal comma.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::inspection {

struct TableCell {
  std::string text;  ///< without quotes and blanks around it
  int column = 1;    ///< where it begins, from 1
};

/// Cells of the line that names the columns. One kind of separator parts them: semicolons, else tabs, else commas, else
/// blanks; a unit in brackets belongs to the name before it: `X [mm] Y [mm]`. Empty cells at the end are dropped.
[[nodiscard]] std::vector<TableCell> heading_cells(std::string_view line);

/// Cells of a line of numbers: semicolons part them; where there are none, blanks and single commas with blanks around
/// them. Commas are decimal commas where semicolons stand in the line, or where blanks part it, every comma stands
/// between two digits and no decimal point is there. Empty cells at the end are dropped.
[[nodiscard]] std::vector<TableCell> number_cells(std::string_view line);

/// A finite number, the whole text, with a decimal point or one decimal comma.
[[nodiscard]] bool read_cell(std::string_view text, double& value);

/// The line names exactly these columns, which commas part in `names`.
[[nodiscard]] bool names_columns(std::string_view line, std::string_view names);

/// The numbers of a line, as many as asked; nothing where it is anything else.
template <std::size_t count>
[[nodiscard]] std::optional<std::array<double, count>> numbers_of(std::string_view line) {
  std::array<double, count> out{};
  const auto cells = number_cells(line);
  if (cells.size() != count) return std::nullopt;
  for (std::size_t k = 0; k < count; ++k)
    if (!read_cell(cells[k].text, out[k])) return std::nullopt;
  return out;
}

/// One line of a text and its number; the text loses it. Ends of lines are LF or CR LF.
struct TextLine {
  std::string_view text;
  int number = 0;
};
[[nodiscard]] TextLine take_line(std::string_view& rest, int before);

/// What spreadsheets write ahead of a table to say its separator: `sep=;`.
[[nodiscard]] bool is_separator_line(std::string_view line);

}  // namespace toothpath::inspection
