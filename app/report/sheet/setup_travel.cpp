#include "app/report/sheet/setup_travel.h"

#include <algorithm>
#include <cmath>

#include "app/report/sheet/sheet_html.h"
#include "geometry/base/angle.h"

namespace toothpath::sheet {
std::string riser_text(const choice::TravelOffer& offer) {
  const double z = offer.shift_mm.z();
  if (std::abs(z) < 5e-4) return {};
  return z > 0 ? fmt::format("needs a riser of {:.3f} mm under the part", z)
               : fmt::format("needs the part {:.3f} mm lower: a lower fixture, or none", -z);
}

report::Section travel_section(const joints::AxisProgram& program, const joints::Setup& setup) {
  report::Section section;
  section.title = "Room in the travels";
  if (!program.offer) return section;
  const choice::TravelOffer& offer = *program.offer;
  section.columns = {"axis",     "room now, mm", "most room, mm", "gear origin there", setup.work_offset + " there",
                     "shift, mm"};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    section.rows.push_back({std::string(1, "XYZ"[i]), millimetres(offer.room_now_mm[k]),
                            millimetres(offer.room_then_mm[k]), millimetres(setup.origin_mm[i] + offer.shift_mm[i]),
                            millimetres(setup.work_offset_at_mm[i] + offer.shift_mm[i]),
                            std::abs(offer.shift_mm[i]) < 5e-4 ? "0.000" : fmt::format("{:+.3f}", offer.shift_mm[i])});
  }
  section.note = "Room: from the outermost joint of the whole program to the nearer limit, margin taken off.";
  section.note +=
      offer.on_index_axis ? " The gear stays on the axis that turns it: only shifts along it were looked at." : "";
  section.note +=
      offer.posted
          ? " A program was built there and fits."
          : " Table and fixture are not known to the program: run the job with this origin before the part is moved.";
  const std::string riser = riser_text(offer);
  if (!riser.empty()) section.note += " The place with the most room " + riser + ".";
  return section;
}

report::Section time_section(const joints::AxisProgram& program, const std::optional<report::PolesReport>& poles) {
  report::Section section;
  section.title = "Run time";
  section.columns = {"what", "cutting", "rapids"};
  section.rows.push_back({"as the program asks", report::readable_minutes(program.feed_minutes),
                          report::readable_minutes(program.minutes - program.feed_minutes)});
  if (program.has_acceleration)
    section.rows.push_back({"with the accelerations of the axes", report::readable_minutes(program.accelerated.feed),
                            report::readable_minutes(program.accelerated.rapid)});
  section.note = fmt::format("The last row is {}.", program.time_model);
  std::string rulers;
  for (std::size_t i = 0; i < program.time_rulers.size(); ++i)
    if (program.time_ruled[i] > 0)
      rulers += fmt::format("{}{} {}", rulers.empty() ? "" : ", ", program.time_rulers[i], program.time_ruled[i]);
  if (!rulers.empty()) section.note += " Feed blocks by what ruled their time: " + rulers + ".";
  if (poles) section.note += " " + report::poles_text(*poles);
  return section;
}

}  // namespace toothpath::sheet
