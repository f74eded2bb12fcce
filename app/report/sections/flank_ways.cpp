#include "app/base/units.h"
#include "app/report/sections/sections.h"

namespace toothpath::sections {

/// What every flank takes by the side of its mill and by the ball end of it, and which was taken.
report::Section flank_ways(const SectionInput& input) {
  report::Section section;
  if (input.report.flank_ways.empty()) return section;
  section.title = "Side or ball: what each way takes";
  section.id = "flank-ways";
  section.sheet_rows = 0;
  section.columns = {"op", "zone", "flank", "strips: um left", "side min", "ball passes", "ball min", "taken"};
  std::string refused;
  for (const report::FlankWaysReport& w : input.report.flank_ways) {
    std::string tried;
    for (const auto& t : w.tried)
      tried +=
          fmt::format("{}{}: {}{:.2f}", tried.empty() ? "" : ", ", t.strips, t.more ? "over " : "", app::um(t.left_mm));
    section.rows.push_back({std::to_string(w.operation), std::to_string(w.zone), fmt::format("{:+d}", w.flank),
                            tried.empty() ? "-" : tried, tried.empty() ? "-" : fmt::format("{:.1f}", w.side_minutes),
                            std::to_string(w.ball_passes), fmt::format("{:.1f}", w.ball_minutes),
                            w.by_ball ? "ball" : "side"});
    const std::string why =
        fmt::format(" Operation {}, by the {}: {}.", w.operation, w.by_ball ? "side" : "ball end", w.refused);
    if (!w.refused.empty() && !refused.ends_with(why)) refused += why;  // once for both flanks
  }
  section.note =
      "Each number of strips that was tried with what it leaves; the last one is planned. Ball: about as many passes "
      "of the ball end of the same tool leave as much. Minutes: all teeth, at the feed of the contact, without links, "
      "rapids and what the axes of the machine take longer." +
      refused;
  return section;
}

}  // namespace toothpath::sections
