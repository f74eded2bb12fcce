#include "app/proposal/points_gear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/job/flank_points.h"
#include "app/job/measured_points.h"
#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"
#include "geometry/inspection/point_file.h"
#include "geometry/inspection/table_text.h"
#include "machines/toml/input_text.h"

namespace toothpath::proposal {
namespace {

constexpr std::size_t kMostPointBytes = 64u << 20;
constexpr double kSmallModule = 0.5;     // mm: below it inches are likelier
constexpr double kFilletModules = 0.25;  // of the proposed fillet,
constexpr double kFilletOfWidth = 0.4;   // at most this share of the space
constexpr double kFarthest = 1e5;        // mm

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

}  // namespace

Result<PointsOfFile> read_points(const std::string& file, std::optional<double> unit_mm) {
  const auto text = toml::read_input_text(file, kMostPointBytes);
  if (!text) return text.error();
  Loose points;
  std::optional<double> stated;
  if (job::looks_like_flank_points(*text)) {
    const auto named = job::parse_flank_points(*text, file);
    if (!named) return named.error();
    add_named(named->plus, 1, file, points);
    add_named(named->minus, -1, file, points);
  } else {
    const auto read = inspection::looks_like_dmis(*text) ? inspection::parse_dmis_results(*text, file)
                                                         : inspection::parse_plain_points(*text, file);
    if (!read) return read.error();
    auto loose = loose_of(*read);
    if (!loose) return loose.error();
    points = std::move(*loose);
    stated = read->unit_mm;
  }
  if (unit_mm && stated && *unit_mm != *stated)
    return Diagnostic{
        DiagnosticKind::usage,
        {},
        fmt::format("--points-unit is {:g} mm, but {} states a unit of {:g} mm", *unit_mm, printable(file), *stated)};
  for (flank_grid::LoosePoint& point : points) {
    if (!stated) point.p *= unit_mm.value_or(1);
    if (!(radius(point.p) > 0 && point.p.norm() < kFarthest))
      return fail_at(point.at, "({:g}, {:g}, {:g}) mm is no place beside the axis", point.p.x(), point.p.y(),
                     point.p.z());
  }
  auto ordered = flank_grid::order_points(points);
  if (!ordered) return ordered.error();
  return PointsOfFile{file, stated.has_value() || unit_mm.has_value(), std::move(*ordered)};
}

std::optional<std::string> looks_like_inches(const PointsOfFile& points, double teeth) {
  const double module_mm = 2 * flank_grid::MeridianProposal(points.points).outer_mm() / teeth;
  if (points.states_unit || module_mm >= kSmallModule) return {};
  return fmt::format("{} states no unit: in mm the module of {:g} teeth is {:.4f} mm, in inches {:.3f} mm",
                     printable(points.file), teeth, module_mm, kInchMm * module_mm);
}

Result<std::vector<Vec2>> read_meridian(const char* option, const std::string& text) {
  std::string plain = text;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  const auto four = inspection::numbers_of<4>(plain);
  if (!four || !((*four)[0] > 0 && (*four)[2] > 0))
    return fail_as(
        DiagnosticKind::usage,
        "{} = \"{}\": two places of the meridian are needed, [[r, z], [r, z]] in mm with r above 0, from the "
        "end of column 0 to the other",
        option, printable(text));
  return std::vector{Vec2((*four)[0], (*four)[1]), Vec2((*four)[2], (*four)[3])};
}

std::string meridian_text(const std::vector<Vec2>& line) {
  std::string text;
  for (const Vec2& p : line) text += fmt::format("{}[{:.6f}, {:.6f}]", text.empty() ? "" : ", ", p.x(), p.y());
  return "[" + text + "]";
}

double proposed_fillet_mm(const flank_grid::MeridianProposal& meridians, double teeth) {
  const double proposed =
      std::min(kFilletModules * 2 * meridians.outer_mm() / teeth, kFilletOfWidth * meridians.width_mm());
  return std::max(0.001, std::floor(1e3 * proposed) / 1e3);
}

}  // namespace toothpath::proposal
