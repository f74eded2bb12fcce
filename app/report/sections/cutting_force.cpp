#include "app/report/sections/sections.h"
#include "cam/force/load.h"
#include "geometry/base/angle.h"

namespace toothpath::sections {
namespace {

using report::estimate;

std::vector<std::string> row_of(const report::OperationReport& o, const report::CuttingLoad& c) {
  const std::string compliance = c.compliance ? estimate(1000 * c.compliance->total()) : "";
  std::vector<std::string> row{std::to_string(o.operation), std::to_string(o.tool_number), compliance};
  if (!c.load) {
    row.insert(row.end(), 7, "");
    row.push_back("not computed: " + c.not_computed);
    return row;
  }
  const force::OperationLoad& l = *c.load;
  for (const double value : {l.force_N, 1000 * l.deflection_mm}) row.push_back(estimate(value));
  row.push_back(c.may_leave_mm ? estimate(1000 * *c.may_leave_mm) : "");
  for (const double value : {1000 * l.chip_mm, 1000 * l.mean_chip_mm, degrees(l.engaged_rad), 1000 * l.torque_Nm})
    row.push_back(estimate(value));
  row.push_back(c.slender ? "slender" : "");
  return row;
}

}  // namespace

/// Force and deflection of every operation.
report::Section cutting_force(const SectionInput& input) {
  report::Section section;
  for (const report::OperationReport& o : input.report.operations)
    if (o.cutting) section.rows.push_back(row_of(o, *o.cutting));
  if (section.rows.empty()) return section;
  section.title = "Force and deflection";
  section.id = "force";
  section.sheet_rows = 0;
  section.columns = {"op",           "T",       "compliance um/N", "force N",     "deflection um",
                     "may leave um", "chip um", "mean chip um",    "engaged deg", "torque N mm",
                     "remark"};
  section.note = "An estimate, no part of the proof. " + input.report.force_basis +
                 " Compliance: where the tool cuts, holder and spindle rigid. Roughing: in full material, as the first "
                 "pass of a layer. A tool is slender where it bends by more than the operation may leave beside what "
                 "it was asked to; where that is more than its stock, it bends away and does not cut it.";
  return section;
}

}  // namespace toothpath::sections
