#include <algorithm>
#include <array>

#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"
#include "geometry/inspection/point_file.h"
#include "geometry/inspection/point_words.h"
#include "geometry/inspection/table_text.h"

namespace toothpath::inspection {
namespace {

using Cells = std::vector<TableCell>;

/// Which cell of a line holds what.
struct Columns {
  std::array<std::size_t, 6> at{};  ///< of x y z i j k
  std::size_t values = 3;           ///< 3, or 6 with normals
  std::size_t count = 0;            ///< cells of a line
  bool numbered = false;            ///< the first cell is the number or the name of the point
  std::optional<double> mm = {};    ///< of the stated unit of x, y, z
  int line = 0;                     ///< that told it
};

constexpr std::array<std::string_view, 6> kNames = {"X", "Y", "Z", "I", "J", "K"};
constexpr std::array<std::string_view, 3> kNormalNames = {"NX", "NY", "NZ"};

/// "X [mm]", "X (mm)", "X/mm", "X_mm", "X mm": a name and its unit.
struct Heading {
  std::string name, unit;
};
Heading heading_of(std::string_view text) {
  const auto both = [](std::string_view name, std::string_view unit) {
    while (!unit.empty() && std::string_view("[]() \t").find(unit.front()) != std::string_view::npos)
      unit.remove_prefix(1);
    while (!unit.empty() && std::string_view("[]() \t").find(unit.back()) != std::string_view::npos)
      unit.remove_suffix(1);
    if (upper(unit).starts_with("IN ") && mm_of_unit(unit.substr(3))) unit.remove_prefix(3);
    return Heading{upper(trimmed(name)), std::string(unit)};
  };
  if (const auto at = text.find_first_of("[(/"); at != std::string_view::npos && at > 0)
    return both(text.substr(0, at), text.substr(at + 1));
  if (const auto at = text.find_first_of("_ "); at != std::string_view::npos && at > 0) {
    Heading split = both(text.substr(0, at), text.substr(at + 1));
    if (mm_of_unit(split.unit)) return split;
  }
  return {upper(trimmed(text)), {}};
}

/// The columns by their names; nothing where the line does not name x, y and z. Columns ahead of them name the point.
/// Refused: other columns, other units, units that differ.
Result<std::optional<Columns>> named_columns(const Cells& cells, int number, const std::string& file) {
  std::array<std::optional<std::size_t>, 6> at;
  std::vector<Heading> headings;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    headings.push_back(heading_of(cells[k].text));
    for (std::size_t n = 0; n < kNames.size(); ++n)
      if (!at[n] && (headings[k].name == kNames[n] || (n >= 3 && headings[k].name == kNormalNames[n - 3]))) at[n] = k;
  }
  if (!at[0] || !at[1] || !at[2]) return std::optional<Columns>();
  Columns out;
  out.count = cells.size();
  out.line = number;
  out.values = at[3] && at[4] && at[5] ? 6 : 3;
  for (std::size_t n = 0; n < out.values; ++n) out.at[n] = *at[n];
  const auto used = [&](std::size_t k) {
    return std::find(out.at.begin(), out.at.begin() + std::ptrdiff_t(out.values), k) !=
           out.at.begin() + std::ptrdiff_t(out.values);
  };
  const std::size_t first = *std::min_element(out.at.begin(), out.at.begin() + std::ptrdiff_t(out.values));
  for (std::size_t k = first; k < cells.size(); ++k)
    if (!used(k))
      return fail_at({file, number, cells[k].column},
                     "column \"{}\": behind x, y, z only i, j, k (the normal) are read; leave it out",
                     printable(cells[k].text));
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t k = out.at[n];
    const std::string& unit = headings[k].unit;
    if (unit != headings[out.at[0]].unit)
      return fail_at({file, number, cells[k].column}, "\"{}\" and \"{}\" are in different units",
                     printable(cells[out.at[0]].text), printable(cells[k].text));
    if (unit.empty()) continue;
    out.mm = mm_of_unit(unit);
    if (!out.mm)
      return fail_at({file, number, cells[k].column}, "\"{}\": the unit \"{}\" is none of mm, um, cm, m, inch",
                     printable(cells[k].text), printable(unit));
  }
  return std::optional(out);
}

/// A whole number, or a text that is no number at all: what names a point rather than measures it.
bool names_point(std::string_view text) {
  double value = 0;
  if (!read_cell(text, value)) return !text.empty();
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The columns by their number: x y z or x y z i j k, behind the number of the point where there is one more.
std::optional<Columns> counted_columns(const Cells& cells, int number) {
  const std::size_t n = cells.size();
  const bool numbered = n == 4 || n == 7;
  if (n != 3 && n != 6 && !(numbered && names_point(cells.front().text))) return std::nullopt;
  Columns out{{}, n < 6 ? 3u : 6u, n, numbered, {}, number};
  for (std::size_t k = 0; k < 6; ++k) out.at[k] = k + numbered;
  return out;
}

Result<FilePoint> point_of(const Cells& cells, const Columns& columns, int number, const std::string& file) {
  const auto place = [&](std::size_t n) { return SourcePosition{file, number, cells[columns.at[n]].column}; };
  if (columns.numbered && !names_point(cells.front().text))
    return fail_at({file, number, cells.front().column},
                   "\"{}\" is no number of a point; that of line {} is one, x y z follow it", cells.front().text,
                   columns.line);
  FilePoint point;
  point.at = place(0);
  Vec3 normal = Vec3::Zero();
  for (std::size_t n = 0; n < columns.values; ++n) {
    double& value = n < 3 ? point.p[Eigen::Index(n)] : normal[Eigen::Index(n) - 3];
    const std::string& text = cells[columns.at[n]].text;
    if (!read_cell(text, value)) return fail_at(place(n), "{} = \"{}\" is no finite number", "xyzijk"[n], text);
  }
  point.p *= columns.mm.value_or(1);
  if (columns.values == 3) return point;
  const auto unit = read_normal(normal, place(3));
  if (!unit) return unit.error();
  point.n = *unit;
  return point;
}

Diagnostic wrong_count(const Cells& cells, const Columns& columns, int number, const std::string& file) {
  const SourcePosition at{file, number, cells.front().column};
  if (columns.count > 0) return fail_at(at, "{} columns, but {} in line {}", cells.size(), columns.count, columns.line);
  if (cells.size() == 4 || cells.size() == 7)
    return fail_at(at,
                   "{} columns, must be 3 (x y z) or 6 (x y z i j k); one more ahead of them is a point's number, "
                   "and \"{}\" is none",
                   cells.size(), cells.front().text);
  return fail_at(at, "{} columns, must be 3 (x y z) or 6 (x y z i j k)", cells.size());
}

}  // namespace

Result<PointFile> parse_plain_points(std::string_view text, const std::string& file) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  PointFile out;
  Columns columns;
  int number = 0;
  while (!text.empty()) {
    const auto [line, at] = take_line(text, number);
    number = at;
    if (is_comment(trimmed(line)) || is_separator_line(line)) continue;
    if (columns.count == 0) {
      const auto named = named_columns(heading_cells(line), number, file);
      if (!named) return named.error();
      if (*named) {
        columns = **named;
        continue;
      }
    }
    const Cells cells = number_cells(line);
    if (cells.empty()) continue;
    if (columns.count == 0)
      if (const auto counted = counted_columns(cells, number)) columns = *counted;
    if (cells.size() != columns.count) return wrong_count(cells, columns, number, file);
    auto point = point_of(cells, columns, number, file);
    if (!point) return point.error();
    if (out.points.size() == kMostPoints) return too_many_points(point->at);
    out.points.push_back(std::move(*point));
  }
  if (out.points.empty())
    return fail_at({file, std::max(number, 1), 1}, "no measured point: lines x y z or x y z i j k are needed");
  out.unit_mm = columns.mm;
  return out;
}

}  // namespace toothpath::inspection
