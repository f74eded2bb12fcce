#include <algorithm>

#include "app/base/units.h"
#include "app/report/sections/sections.h"
#include "geometry/base/angle.h"

namespace toothpath::sections {
namespace {

using Station = report::SidePass::Station;

std::string range_text(const std::vector<Station>& stations, double Station::*member, double factor, int digits) {
  if (stations.empty()) return {};
  const auto [low, high] = std::minmax_element(
      stations.begin(), stations.end(), [&](const Station& a, const Station& b) { return a.*member < b.*member; });
  return fmt::format("{:.{}f} to {:.{}f}", (*low).*member * factor, digits, (*high).*member * factor, digits);
}

/// One curve a pass of the finishing operation; the passes of others look the same.
svg::LineChart chart(const std::vector<const report::PassReport*>& passes, const char* title, const char* y_label,
                     double Station::*member, double factor) {
  svg::LineChart out;
  out.title = title;
  out.x_label = "radius [mm]";
  out.y_label = y_label;
  for (const report::PassReport* p : passes) {
    svg::ChartSeries curve{fmt::format("zone {}, {}", p->zone, p->name), {}, {}};
    for (const Station& s : p->side->stations) {
      curve.x.push_back(s.r_mm);
      curve.y.push_back(s.*member * factor);
    }
    out.series.push_back(std::move(curve));
  }
  return out;
}

}  // namespace

/// How the side of a mill lies on every flank: why the operation has its strips, and which rotaries move.
report::Section side_passes(const SectionInput& input) {
  report::Section section;
  std::vector<const report::PassReport*> last;
  for (const report::PassReport& p : input.report.passes) {
    if (!p.side) continue;
    if (!last.empty() && last.front()->operation != p.operation) last.clear();
    last.push_back(&p);
  }
  if (last.empty()) return section;
  section.title = "Line milling";
  section.id = "line-milling";
  section.sheet_rows = 0;
  section.columns = {"op",        "zone",       "flank",   "strip",   "tilt deg", "lean along the tooth deg",
                     "misfit um", "contact mm", "records", "rotaries"};
  for (const report::PassReport& p : input.report.passes) {
    if (!p.side) continue;
    section.rows.push_back({std::to_string(p.operation), std::to_string(p.zone), fmt::format("{:+d}", p.side->flank),
                            std::to_string(p.side->strip),
                            range_text(p.side->stations, &Station::tilt_rad, degrees(1.0), 1),
                            range_text(p.side->stations, &Station::lean_rad, degrees(1.0), 1),
                            fmt::format("{:.2f}", app::um(p.side->misfit_mm)), fmt::format("{:.2f}", p.length_mm),
                            std::to_string(p.points), p.side->rotaries});
  }
  section.charts = {
      chart(last, "Tilt of the tool", "tilt from the gear axis [\u00b0]", &Station::tilt_rad, degrees(1.0)),
      chart(last, "Lean along the tooth", "lean [\u00b0]", &Station::lean_rad, degrees(1.0)),
      chart(last, "Misfit of the side", "misfit [\u00b5m]", &Station::misfit_mm, app::kUm)};
  section.note =
      "The straight side touches the flank along its whole height; the lean that makes the gap a cubic changes along "
      "the "
      "tooth, and with it the tilt. Misfit: what the side leaves by its form, at most, at each place of the last "
      "line-milled "
      "operation; flanks outside the ring are not shown.";
  return section;
}

}  // namespace toothpath::sections
