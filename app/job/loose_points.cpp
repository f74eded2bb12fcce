#include "app/job/loose_points.h"

#include <array>
#include <cmath>

#include "app/job/flank_points.h"
#include "geometry/base/printable.h"
#include "geometry/inspection/point_file.h"
#include "geometry/inspection/table_text.h"
#include "machines/toml/input_text.h"

namespace toothpath::job {
namespace {

constexpr std::size_t kMostLooseBytes = 64u << 20;
constexpr double kFarthestPoint = 1e5;  // mm
constexpr std::string_view kNominalGrid = "zone,flank,row,column,x,y,z,i,j,k",
                           kDeviatingGrid = "zone,flank,row,column,x,y,z,i,j,k,deviation_um";

using Loose = std::vector<flank_grid::LoosePoint>;

/// Of a points file of a job, which names flank, row and column of every point.
void add_named(const flank_grid::GridPoints& grid, int side, const std::string& file, Loose& out) {
  for (std::size_t k = 0; k < grid.place.size(); ++k) {
    out.push_back({grid.place[k], {}, {file, grid.line[k], 1}, side});
    if (!grid.normal.empty()) out.back().n = grid.normal[k];
  }
}

Result<Loose> loose_of(const inspection::PointFile& read) {
  Loose out;
  for (const inspection::FilePoint& point : read.points) {
    if (point.n.has_value() != read.points.front().n.has_value())
      return fail_at(point.at, "the point {} a normal, and the first one of the file {}: all or none need one",
                     point.n ? "has" : "lacks", point.n ? "lacks it" : "has one");
    out.push_back({point.p, point.n, point.at, 0});
  }
  return out;
}

/// Columns of an inspection grid by its header; 0: it is none.
std::size_t grid_columns(std::string_view line) {
  return inspection::names_columns(line, kDeviatingGrid) ? 11 : inspection::names_columns(line, kNominalGrid) ? 10 : 0;
}

/// The columns of the header, its line number; the text loses all up to it.
std::size_t take_grid_header(std::string_view& text, int& number) {
  auto line = inspection::take_line(text, number);
  if (inspection::is_separator_line(line.text)) line = inspection::take_line(text, line.number);
  number = line.number;
  return grid_columns(line.text);
}

Result<flank_grid::LoosePoint> grid_point(const std::vector<inspection::TableCell>& cells, const SourcePosition& at) {
  flank_grid::LoosePoint point;
  point.at = at;
  const std::string& flank = cells[1].text;
  if (flank == "1" || flank == "L") point.flank = 1;
  else if (flank == "-1" || flank == "U") point.flank = -1;
  else return fail_at({at.file, at.line, cells[1].column}, "flank = \"{}\" must be 1 or -1 (L or U)", printable(flank));
  std::array<double, 7> value{};
  for (std::size_t k = 4; k < cells.size(); ++k)
    if (!inspection::read_cell(cells[k].text, value[k - 4]))
      return fail_at({at.file, at.line, cells[k].column}, "\"{}\" is no finite number", printable(cells[k].text));
  Vec3 n(value[3], value[4], value[5]);
  if (!(std::abs(n.norm() - 1) < 1e-3))
    return fail_at({at.file, at.line, cells[7].column}, "the normal ({:g}, {:g}, {:g}) is no unit vector", n.x(), n.y(),
                   n.z());
  n.normalize();
  point.p = Vec3(value[0], value[1], value[2]) + 1e-3 * value[6] * n;
  point.n = n;
  return point;
}

Result<Loose> loose_grid(std::string_view text, const std::string& file) {
  Loose out;
  int number = 0;
  const std::size_t columns = take_grid_header(text, number);
  while (!text.empty()) {
    const auto line = inspection::take_line(text, number);
    number = line.number;
    const auto cells = inspection::number_cells(line.text);
    if (cells.empty()) continue;
    if (cells.size() != columns)
      return fail_at({file, number, 1}, "{} columns, must be {}: {}", cells.size(), columns,
                     columns == 11 ? kDeviatingGrid : kNominalGrid);
    auto point = grid_point(cells, {file, number, cells[4].column});
    if (!point) return point.error();
    out.push_back(std::move(*point));
  }
  if (out.empty()) return fail_at({file, number, 1}, "no point stands in this file");
  return out;
}

}  // namespace

Result<LoosePoints> read_loose_points(const std::string& file, std::optional<double> unit_mm) {
  const auto text = toml::read_input_text(file, kMostLooseBytes);
  if (!text) return text.error();
  LoosePoints out;
  out.file = file;
  std::optional<double> stated;
  std::string_view ahead = *text;
  int first = 0;
  if (take_grid_header(ahead, first) > 0) {
    auto grid = loose_grid(*text, file);
    if (!grid) return grid.error();
    out.points = std::move(*grid);
  } else if (looks_like_flank_points(*text)) {
    const auto named = parse_flank_points(*text, file);
    if (!named) return named.error();
    add_named(named->plus, 1, file, out.points);
    add_named(named->minus, -1, file, out.points);
  } else {
    const auto read = inspection::looks_like_dmis(*text) ? inspection::parse_dmis_results(*text, file)
                                                         : inspection::parse_plain_points(*text, file);
    if (!read) return read.error();
    auto loose = loose_of(*read);
    if (!loose) return loose.error();
    out.points = std::move(*loose);
    stated = read->unit_mm;
  }
  if (unit_mm && stated && *unit_mm != *stated)
    return Diagnostic{
        DiagnosticKind::usage,
        {},
        fmt::format("--points-unit is {:g} mm, but {} states a unit of {:g} mm", *unit_mm, printable(file), *stated)};
  for (flank_grid::LoosePoint& point : out.points) {
    if (!stated) point.p *= unit_mm.value_or(1);
    if (!(radius(point.p) > 0 && point.p.norm() < kFarthestPoint))
      return fail_at(point.at, "({:g}, {:g}, {:g}) mm is no place beside the axis", point.p.x(), point.p.y(),
                     point.p.z());
  }
  out.states_unit = stated.has_value() || unit_mm.has_value();
  return out;
}

}  // namespace toothpath::job
