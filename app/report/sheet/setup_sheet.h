// setup.html: what the machinist needs at the machine, on A4 paper.
#pragma once

#include <string>

#include "app/job/job.h"
#include "app/report/run_report.h"
#include "machines/machine.h"

namespace toothpath::sheet {

/// The part as the sketch shows it: a ring of teeth on a body, gear frame, mm.
struct PartOutline {
  double inner_radius = 0, outer_radius = 0;
  double tooth_top = 0, root = 0, bottom = 0;  ///< z
  std::string words;                           ///< what the gear is, as on its drawing
  /// Teeth stand outwards, from inner_radius (their roots) to outer_radius, between tooth_top and root = bottom, which
  /// are the end faces of the gear; else they stand upright.
  bool around = false;
};

/// Machine, work offset, tools with lengths and run times, operations, axis ranges, every assumed value, warnings, and
/// a sketch of the part in the machine as inline SVG. One self-contained page without script. The job has a set-up.
[[nodiscard]] std::string setup_sheet(const job::Job& job, const PartOutline& part, const machines::Machine& machine,
                                      const report::RunReport& report);

}  // namespace toothpath::sheet
