#include <algorithm>
#include <array>

#include "geometry/inspection/point_file.h"
#include "geometry/inspection/point_words.h"

namespace toothpath::inspection {
namespace {

struct Cell {
  std::string_view text;
  int column = 0;  ///< from 1
};

/// Cells of a line: blanks part them, and so does one comma or semicolon with blanks around it.
std::vector<Cell> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  std::size_t k = 0;
  bool wants = false;  // a separator stood before: an empty cell is one
  while (true) {
    while (k < line.size() && (line[k] == ' ' || line[k] == '\t')) ++k;
    const std::size_t begin = k;
    while (k < line.size() && line[k] != ' ' && line[k] != '\t' && line[k] != ',' && line[k] != ';') ++k;
    if (k > begin || wants || k < line.size()) cells.push_back({line.substr(begin, k - begin), int(begin) + 1});
    while (k < line.size() && (line[k] == ' ' || line[k] == '\t')) ++k;
    if (k >= line.size()) return cells;
    wants = line[k] == ',' || line[k] == ';';
    if (wants) ++k;
  }
}

bool names_columns(const std::vector<Cell>& cells) {
  static constexpr std::array<std::string_view, 6> kNames = {"X", "Y", "Z", "I", "J", "K"};
  if (cells.size() != 3 && cells.size() != 6) return false;
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (upper(cells[k].text) != kNames[k]) return false;
  return true;
}

/// Commas within numbers: semicolons or blanks part the cells as well.
bool decimal_commas(std::string_view line) {
  const auto digit = [&](std::size_t k) { return k < line.size() && line[k] >= '0' && line[k] <= '9'; };
  std::size_t inside = 0;
  for (std::size_t k = 1; k < line.size(); ++k) inside += line[k] == ',' && digit(k - 1) && digit(k + 1);
  return inside >= 3 && (line.find(';') != std::string_view::npos || line.find('\t') != std::string_view::npos ||
                         line.find(' ') != std::string_view::npos);
}

Result<FilePoint> point_of(const std::vector<Cell>& cells, int number, const std::string& file) {
  FilePoint point;
  point.at = {file, number, cells[0].column};
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 0; k < cells.size(); ++k) {
    double& value = k < 3 ? point.p[Eigen::Index(k)] : normal[Eigen::Index(k) - 3];
    if (!read_number(cells[k].text, value))
      return fail_at({file, number, cells[k].column}, "{} = \"{}\" is no finite number", "xyzijk"[k], cells[k].text);
  }
  if (cells.size() == 3) return point;
  const auto unit = read_normal(normal, {file, number, cells[3].column});
  if (!unit) return unit.error();
  point.n = *unit;
  return point;
}

}  // namespace

Result<PointFile> parse_plain_points(std::string_view text, const std::string& file) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  PointFile out;
  int number = 0, first_line = 0;
  std::size_t columns = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number;
    if (is_comment(trimmed(line))) continue;
    const auto cells = cells_of(line);
    if (out.points.empty() && columns == 0 && names_columns(cells)) {
      columns = cells.size();
      first_line = number;
      continue;
    }
    if (cells.size() != (columns ? columns : cells.size() == 6 ? 6u : 3u)) {
      const SourcePosition at{file, number, cells.front().column};
      if (decimal_commas(line)) return fail_at(at, "decimal commas: numbers need a decimal point");
      if (columns) return fail_at(at, "{} columns, but {} in line {}", cells.size(), columns, first_line);
      return fail_at(at, "{} columns, must be 3 (x y z) or 6 (x y z i j k)", cells.size());
    }
    if (!columns) {
      columns = cells.size();
      first_line = number;
    }
    auto point = point_of(cells, number, file);
    if (!point)
      return decimal_commas(line)
                 ? fail_at({file, number, cells.front().column}, "decimal commas: numbers need a decimal point")
                 : point.error();
    if (out.points.size() == kMostPoints) return too_many_points(point->at);
    out.points.push_back(std::move(*point));
  }
  if (out.points.empty())
    return fail_at({file, std::max(number, 1), 1}, "no measured point: lines x y z or x y z i j k are needed");
  return out;
}

}  // namespace toothpath::inspection
