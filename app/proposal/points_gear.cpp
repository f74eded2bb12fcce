#include "app/proposal/points_gear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/job/loose_points.h"
#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"
#include "geometry/inspection/table_text.h"

namespace toothpath::proposal {
namespace {

constexpr double kSmallModule = 0.5;     // mm: below it inches are likelier
constexpr double kFilletModules = 0.25;  // of the proposed fillet,
constexpr double kFilletOfWidth = 0.4;   // at most this share of the space

}  // namespace

Result<PointsOfFile> read_points(const std::string& file, std::optional<double> unit_mm) {
  const auto loose = job::read_loose_points(file, unit_mm);
  if (!loose) return loose.error();
  auto ordered = flank_grid::order_points(loose->points);
  if (!ordered) return ordered.error();
  return PointsOfFile{file, loose->states_unit, std::move(*ordered)};
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
