#include "app/job/measured_points.h"

#include <algorithm>
#include <cmath>

#include "geometry/inspection/table_text.h"

namespace toothpath::job {
namespace {

std::optional<Diagnostic> check_sizes(const inspection::PointFile& file,
                                      const std::vector<inspection::FlankPoint>& points) {
  std::size_t largest = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (std::abs(points[k].deviation_mm) > std::abs(points[largest].deviation_mm)) largest = k;
  const double um = std::abs(points[largest].deviation_mm) * 1000;
  if (um < kLeastDeviationUm)
    return fail_at(file.points[largest].at,
                   "the points lie within {:.3g} um of the exact flanks, below {:g} um: are they nominal points? So "
                   "little needs no correction",
                   um, kLeastDeviationUm);
  return {};
}

Diagnostic in_file(const MeasuredPoints& measured, int zone, int side, const std::string& why) {
  return fail_at({measured.file, 1, 1}, "zone {}, flank {:+}: {}", zone, side, why);
}

}  // namespace

bool looks_like_grid(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  auto line = inspection::take_line(text, 0);
  if (inspection::is_separator_line(line.text)) line = inspection::take_line(text, 1);
  const auto cells = inspection::heading_cells(line.text);
  return (cells.empty() && text.empty()) || (!cells.empty() && cells.front().text == "zone");
}

Result<MeasuredPoints> parse_measured_points(std::string_view text, const std::string& file,
                                             const tooth_space::ToothedSolid& gear, double ball_diameter_mm) {
  const auto read = inspection::looks_like_dmis(text) ? inspection::parse_dmis_results(text, file)
                                                      : inspection::parse_plain_points(text, file);
  if (!read) return read.error();
  auto placed = inspection::place_on_flanks(gear, *read, 0.5 * ball_diameter_mm);
  if (!placed) return placed.error();
  if (auto size = check_sizes(*read, *placed)) return *size;
  return MeasuredPoints{file, std::move(*placed), read->other_features};
}

Result<FittedCorrection> fit_points(const GridOfGear& gear, const MeasuredPoints& measured) {
  const auto grid = inspection::inspection_grid(*gear.solid);
  if (!grid) return grid.error();
  FittedCorrection result;
  std::vector<inspection::ToothPlace> places;
  for (int zone = 0; zone < int(gear.zones); ++zone) {
    modification::RingCorrection ring;
    for (const int side : {1, -1}) {
      std::vector<modification::FlankDeviation> nominal;
      for (const auto& p : *grid) {
        if (p.zone != zone || p.side != side) continue;
        const Vec2 place = gear.place(p);
        nominal.push_back({p.row, p.column, -place.y(), place.x(), 0});
      }
      std::vector<modification::ScatteredDeviation> flank;
      for (const auto& p : measured.points) {
        if (p.zone != zone || p.side != side) continue;
        inspection::InspectionPoint foot{zone, side};
        foot.theta = p.theta;
        foot.B = p.B;
        foot.p = p.foot;
        const Vec2 place = gear.place(foot);
        flank.push_back({p.tooth, -place.y(), place.x(), p.deviation_mm});
      }
      if (flank.empty()) return in_file(measured, zone, side, "no point was measured on it; every flank needs some");
      auto fit = modification::FlankCorrection::fit_scattered(flank, nominal, -gear.foot(zone));
      if (!fit) return in_file(measured, zone, side, fit.error().message);
      result.flanks.push_back({zone, side, measured.file, int(fit->teeth.size()), fit->field.residual()});
      for (const auto& tooth : fit->teeth) places.push_back({zone, side, tooth.tooth, tooth.middle_mm});
      (side > 0 ? ring.plus : ring.minus) = std::move(fit->field);
    }
    result.rings.push_back(std::make_shared<modification::RingCorrection>(std::move(ring)));
  }
  auto index = inspection::index_of_teeth(*gear.solid, places);
  if (!index) return index.error();
  result.index = std::move(*index);
  if (measured.other_features)
    result.warnings.push_back(fmt::format("{}: {} measured features are no points and were left out", measured.file,
                                          measured.other_features));
  return result;
}

}  // namespace toothpath::job
