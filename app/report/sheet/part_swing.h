// What the part sweeps on the machine's tables, and the heights that matter when it is set up.
#pragma once

#include <vector>

#include "app/report/run_report.h"
#include "machines/machine.h"
#include "postproc/joints/setup.h"

namespace toothpath::sheet {

/// Blank as a cylinder about the gear axis, gear frame, mm.
struct BlankCylinder {
  double radius_mm = 0, z_min_mm = 0, z_max_mm = 0;
};

struct PartSwing {
  struct Axis {
    char letter = '?';
    double radius_mm = 0;  ///< the blank stays within this distance of the axis, whatever the axes inside it do
    std::optional<double> limit_mm;  ///< radius of the largest part that the machine file states, where it states one
  };
  std::vector<Axis> axes;            ///< table axes, from the work outwards
  double top_mm = 0, bottom_mm = 0;  ///< machine Z of the blank over the turns of the program, all table axes
  double lowest_nose_mm = 0;         ///< machine Z of the gauge line at its lowest in the program
};

/// Swing radii are exact for the rims of the cylinder to 1e-5 of its radius, rounded up; heights are sampled every 0.5
/// deg of the outer table axis with what lies between added. `axes`: ranges of the program, machine coordinates.
[[nodiscard]] PartSwing part_swing(const BlankCylinder& blank, const joints::Setup& setup,
                                   const machines::Machine& machine, const std::vector<joints::AxisRange>& axes);

/// As a table of the set-up sheet.
[[nodiscard]] report::Section swing_section(const PartSwing& swing);

}  // namespace toothpath::sheet
