// The page for the tool grinder: one A4 sheet with order data, section to scale, profile table, conditions, and what
// the mills of the job would do.
#pragma once

#include <string>
#include <vector>

#include "app/report/sheet/cutter_drawing.h"

namespace toothpath::sheet {

/// A mill that was judged.
struct JudgedCutter {
  std::string name;  ///< "designed", "tool 1"
  bevel_gear::CutterJudgement judgement;
};

struct CutterSheet {
  std::string job_name, job_file;
  std::string gear_line;             ///< teeth, module, hand ... of the gear in one line
  JudgedCutter drawn;                ///< the mill that the sheet describes
  std::vector<JudgedCutter> others;  ///< the other mills, shown with their verdict; the first one is drawn dashed
  double length_mm = 0;              ///< of the drawn contour, from the tip
  double dxf_chord_mm = 0;           ///< measured chord error of the DXF
  std::vector<std::string> warnings;
};

/// No script; prints on one A4 page.
[[nodiscard]] std::string cutter_sheet_html(const CutterSheet& sheet);

/// Rows `part,p,from_tip,x,radius,diameter,inclination_deg,curvature` of the whole profile, 10 significant digits.
[[nodiscard]] std::string cutter_csv(const bevel_gear::FingerProfile<double>& profile, double chord_mm);

/// "within limits" or "not usable", with the numbers that people ask for first.
[[nodiscard]] std::string judgement_line(const bevel_gear::CutterJudgement& judgement);

}  // namespace toothpath::sheet
