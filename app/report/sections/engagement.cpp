#include <algorithm>

#include "app/base/units.h"
#include "app/report/sections/sections.h"
#include "geometry/base/angle.h"

namespace toothpath::sections {
namespace {

using report::EngagementReport;

svg::LineChart chart(const std::vector<EngagementReport>& tracks, const char* title, const char* y_label,
                     std::vector<double> EngagementReport::*member, double factor) {
  svg::LineChart out;
  out.title = title;
  out.x_label = "way of the feed motions [mm]";
  out.y_label = y_label;
  for (const EngagementReport& t : tracks) {
    svg::ChartSeries curve{fmt::format("operation {}", t.operation), t.way_mm, {}};
    for (const double value : t.*member) curve.y.push_back(factor * value);
    out.series.push_back(std::move(curve));
  }
  return out;
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

std::string asked(double value, double factor) { return value > 0 ? fmt::format("{:g}", factor * value) : "-"; }

}  // namespace

/// How far a roughing mill stands in the material along its path, and the feeds that follow from it.
report::Section engagement(const SectionInput& input) {
  report::Section section;
  std::vector<EngagementReport> tracks;
  for (const EngagementReport& t : input.report.engagement) {
    if (t.way_mm.empty()) continue;
    tracks.push_back(t);
    const path::MillingOperation& o = input.job.operations[std::size_t(t.operation)];
    section.rows.push_back({std::to_string(t.operation), fmt::format("{:.0f}", degrees(most(t.engaged_rad))),
                            fmt::format("{:.0f}", degrees(t.beside_rad)), asked(o.max_engagement_rad, degrees(1.0)),
                            fmt::format("{:.3g} of {:g}", t.step_over_mm, o.step_over_mm),
                            fmt::format("{:.2f}", app::um(most(t.chip_mm))), asked(o.chip_load_mm, app::kUm),
                            fmt::format("{:g}", o.feed_mm_min),
                            fmt::format("{:.0f} to {:.0f}", least(t.feed_mm_min), most(t.feed_mm_min))});
  }
  if (section.rows.empty()) return section;
  section.title = "Engagement";
  section.id = "engagement";
  section.sheet_rows = 0;
  section.columns = {"op",
                     "engaged deg",
                     "but in passes that open a layer",
                     "max_engagement deg",
                     "step-over planned of asked mm",
                     "largest chip um",
                     "chip_load um",
                     "feed asked mm/min",
                     "feed planned mm/min"};
  section.charts = {
      chart(tracks, "Teeth in the material", "engaged angle [\u00b0]", &EngagementReport::engaged_rad, degrees(1.0)),
      chart(tracks, "Largest chip", "chip [\u00b5m]", &EngagementReport::chip_mm, app::kUm),
      chart(tracks, "Feed", "feed [mm/min]", &EngagementReport::feed_mm_min, 1)};
  section.note =
      "Measured on the stock that stands when the mill comes: points of its cutting part 10 deg apart, in the space "
      "that "
      "is cut first. The pass that opens a layer is a slot; the others are drawn together until they keep "
      "max_engagement. The feed follows the chip where the job states chip_load; it is raised to three times what was "
      "asked at most.";
  return section;
}

}  // namespace toothpath::sections
