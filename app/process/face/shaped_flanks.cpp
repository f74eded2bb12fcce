#include "app/process/face/shaped_flanks.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "app/process/face/shaper_setup.h"
#include "geometry/base/angle.h"
#include "geometry/contact/tooth_contact.h"

namespace toothpath::face {
namespace {

/// Strokes of one even turn at full depth about the place where a tooth at azimuth 0 is cut.
std::vector<shaper::ShaperStroke> strokes_of_one_turn(const shaper::ShaperSetup& s) {
  const double r = s.inner_radius_mm;
  const double window =
      std::asin(std::min(1.0, (std::abs(s.surface.E) + s.surface.shaper.r_a) / r)) + 2 * s.surface.pitch;
  const int half = static_cast<int>(std::ceil(window / (2 * kPi) * s.strokes_turn));
  const double step = s.machine.axes.at('A').sign * 2 * kPi / s.strokes_turn,
               ratio = double(s.work_teeth) / s.cutter_teeth;
  std::vector<shaper::ShaperStroke> strokes;
  for (int j = -half; j <= half; ++j)
    strokes.push_back({0.0, s.start_mm, s.end_mm, ratio * step * (j - 1), ratio * step * j, step * (j - 1), step * j});
  return strokes;
}

}  // namespace

process::ValueOrErrors<std::vector<process::CutFlanks::Flank>> places_on(const job::Job& job,
                                                                         const face_gear::FaceGear& gear, int rows,
                                                                         int columns) {
  std::vector<process::CutFlanks::Flank> places;
  for (int zone = 0; zone < static_cast<int>(gear.rings().size()); ++zone)
    for (const int side : {1, -1}) {
      auto exact = contact::exact_flank(gear, zone, side, rows, columns);
      if (!exact) return std::vector{process::located(job, fmt::format("gear.zone[{}]", zone), exact.error())};
      places.push_back({zone, side, rows, columns, std::move(exact->points), std::move(exact->normals), {}});
    }
  return places;
}

process::ValueOrErrors<process::CutFlanks> shaped_flanks(const job::Job& job, const face_gear::FaceGear& gear,
                                                         std::vector<process::CutFlanks::Flank> places) {
  auto planned = shaper_setup_of(job, gear);
  if (auto* errors = planned.refused()) return std::move(*errors);
  const shaper::ShaperSetup& setup = planned.value();
  const auto strokes = strokes_of_one_turn(setup);
  process::CutFlanks cut;
  cut.route = "shaped";
  cut.flanks = std::move(places);
  cut.cutting_minutes = cut.total_minutes = setup.total_min();
  cut.warnings = setup.warnings;
  for (const auto& key : setup.machine.assumed_keys)
    cut.assumed.push_back(fmt::format("{}: {}", job.machine.file, key));
  for (auto& flank : cut.flanks) {
    flank.deviation_mm.assign(flank.nominal.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, flank.nominal.size(), [&](std::size_t k) {
      // Whichever tooth the place belongs to: turned to the tooth at azimuth 0.
      const Vec3& p = flank.nominal[k];
      const double pitch = setup.surface.pitch, middle = std::atan2(setup.surface.E, setup.surface.L_p);
      const double turn = -pitch * std::round((std::atan2(p.y(), p.x()) - middle) / pitch);
      flank.deviation_mm[k] = shaper::swept_distance(setup.surface, strokes, turned(p, turn));
    });
  }
  return cut;
}

}  // namespace toothpath::face
