#include "app/job/flank_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/base/printable.h"
#include "geometry/inspection/table_text.h"

namespace toothpath::job {
namespace {

constexpr std::array<std::string_view, 9> kGridColumns = {"flank", "row", "column", "x", "y", "z", "i", "j", "k"};
constexpr std::string_view kPlaces = "flank,row,column,x,y,z", kWithNormals = "flank,row,column,x,y,z,i,j,k";
constexpr int kMostNumber = 999;  // of a row or column

struct GridLine {
  int number = 0, side = 0, row = 0, column = 0;
  std::array<double, 9> value{};
};

/// @param count  numbers that the header names
Result<GridLine> parse_grid_line(const std::vector<inspection::TableCell>& cells, std::size_t count,
                                 const SourcePosition& at) {
  if (cells.size() != count)
    return fail_at(at, "{} columns, must be {}: {}", cells.size(), count,
                   count == kGridColumns.size() ? kWithNormals : kPlaces);
  GridLine line;
  line.number = at.line;
  for (std::size_t k = 0; k < count; ++k) {
    const SourcePosition here{at.file, at.line, cells[k].column};
    double& value = line.value[k];
    if (!inspection::read_cell(cells[k].text, value))
      return fail_at(here, "{} = \"{}\" is no finite number", kGridColumns[k], printable(cells[k].text));
    if (k == 0 && value != 1 && value != -1) return fail_at(here, "flank = {:g} must be 1 or -1", value);
    if ((k == 1 || k == 2) && !(value >= 0 && value <= kMostNumber && value == std::floor(value)))
      return fail_at(here, "{} = {:g} is no whole number from 0 to {}", kGridColumns[k], value, kMostNumber);
  }
  line.side = int(line.value[0]);
  line.row = int(line.value[1]);
  line.column = int(line.value[2]);
  return line;
}

Result<flank_grid::GridPoints> grid_of(const std::vector<GridLine>& lines, int side, bool normals,
                                       const SourcePosition& end) {
  flank_grid::GridPoints grid;
  for (const GridLine& line : lines) {
    if (line.side != side) continue;
    grid.rows = std::max(grid.rows, line.row + 1);
    grid.columns = std::max(grid.columns, line.column + 1);
  }
  const auto count = std::size_t(grid.rows) * std::size_t(grid.columns);
  grid.place.resize(count);
  grid.line.resize(count);
  if (normals) grid.normal.resize(count);
  for (const GridLine& line : lines) {
    if (line.side != side) continue;
    const std::size_t k = grid.index(line.row, line.column);
    if (grid.line[k] != 0)
      return fail_at({end.file, line.number, 1}, "flank {}, row {}, column {} stands in line {} already", side,
                     line.row, line.column, grid.line[k]);
    grid.line[k] = line.number;
    grid.place[k] = {line.value[3], line.value[4], line.value[5]};
    if (normals) grid.normal[k] = {line.value[6], line.value[7], line.value[8]};
  }
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (grid.line[grid.index(row, column)] == 0)
        return fail_at(end, "flank {}, row {}, column {} is missing of {} rows x {} columns, which count from 0", side,
                       row, column, grid.rows, grid.columns);
  return grid;
}

/// Numbers of a line that is a header; 0: it is none.
std::size_t columns_of(std::string_view line) {
  return inspection::names_columns(line, kWithNormals) ? 9 : inspection::names_columns(line, kPlaces) ? 6 : 0;
}

}  // namespace

bool looks_like_flank_points(std::string_view text) {
  auto line = inspection::take_line(text, 0);
  if (inspection::is_separator_line(line.text)) line = inspection::take_line(text, 1);
  return columns_of(line.text) > 0;
}

std::string flank_points_text(const FlankPoints& points) {
  const bool normals = !points.plus.normal.empty();
  std::string text = fmt::format("{}\n", normals ? kWithNormals : kPlaces);
  for (const int side : {1, -1}) {
    const flank_grid::GridPoints& grid = side > 0 ? points.plus : points.minus;
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const Vec3& p = grid.place[grid.index(row, column)];
        text += fmt::format("{},{},{},{},{},{}", side, row, column, p.x(), p.y(), p.z());
        if (normals) {
          const Vec3& n = grid.normal[grid.index(row, column)];
          text += fmt::format(",{:.12f},{:.12f},{:.12f}", n.x(), n.y(), n.z());
        }
        text += '\n';
      }
  }
  return text;
}

Result<FlankPoints> parse_flank_points(std::string_view text, const std::string& file) {
  std::vector<GridLine> lines;
  int number = 0;
  std::size_t count = 0;  // of columns; 0: the header was not met yet
  while (!text.empty()) {
    const auto [row, at_line] = inspection::take_line(text, number);
    number = at_line;
    const SourcePosition at{file, number, 1};
    if (count == 0) {
      if (inspection::is_separator_line(row)) continue;
      count = columns_of(row);
      if (count == 0)
        return fail_at(at, "the header is \"{}\", must be \"{}\" or \"{}\"", printable(row.substr(0, 120)), kPlaces,
                       kWithNormals);
      continue;
    }
    const auto cells = inspection::number_cells(row);
    if (cells.empty()) continue;
    auto line = parse_grid_line(cells, count, at);
    if (!line) return line.error();
    lines.push_back(*line);
  }
  FlankPoints out;
  for (const int side : {1, -1}) {
    if (std::none_of(lines.begin(), lines.end(), [&](const GridLine& line) { return line.side == side; }))
      return fail_at({file, std::max(number, 1), 1}, "flank {} has no point: {} names both flanks of one space", side,
                     count == 9 ? kWithNormals : kPlaces);
    auto grid = grid_of(lines, side, count == kGridColumns.size(), {file, std::max(number, 1), 1});
    if (!grid) return grid.error();
    (side > 0 ? out.plus : out.minus) = std::move(*grid);
  }
  return out;
}

}  // namespace toothpath::job
