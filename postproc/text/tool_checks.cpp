#include "postproc/text/tool_checks.h"

#include <algorithm>

#include "postproc/joints/tooth_order.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::text {

bool divide_for_checks(joints::AxisProgram& program, const TextWishes& wishes) {
  if (wishes.checks != ToolChecks::teeth) return false;
  const int most = std::max(1, wishes.teeth_between_checks);
  std::vector<joints::AxisOperation> divided;
  for (joints::AxisOperation& op : program.operations) {
    const int begin = op.first_place, end = op.end_of(program.teeth);
    if (end - begin <= most) {
      divided.push_back(std::move(op));
      continue;
    }
    for (int first = begin; first < end; first += most) {
      const int behind = std::min(end, first + most);
      divided.push_back(operation_between(op, first, behind, program));
      divided.back().end_place = behind;  // the order does not end here for the whole operation
    }
  }
  const bool more = divided.size() != program.operations.size();
  program.operations = std::move(divided);
  sum_times(program);
  return more;
}

void note_tool_checks(joints::AxisProgram& program, const NcDialect& dialect, const TextWishes& wishes,
                      const std::map<int, double>& tolerance_mm) {
  program.check_minutes = program.check_uncertainty_mm = 0;
  auto& all = program.operations;
  for (std::size_t i = 0; i < all.size(); ++i) {
    joints::AxisOperation& op = all[i];
    const bool comes = i == 0 || all[i - 1].tool_number != op.tool_number;
    const bool begins = comes || all[i - 1].operation != op.operation;
    const bool goes = i + 1 == all.size() || all[i + 1].tool_number != op.tool_number;
    const bool checks = wishes.checks != ToolChecks::none && dialect.tool_check;
    op.check_ahead =
        checks && (comes || (begins && wishes.checks == ToolChecks::operations) || wishes.checks == ToolChecks::teeth);
    op.check_behind = checks && goes;
    op.check_minutes = 0;
    if (!checks) continue;
    const auto stated = tolerance_mm.find(op.tool_number);
    op.check_tolerance_mm =
        stated != tolerance_mm.end() ? stated->second : dialect.tool_check->tolerance_mm.value_or(0);
    op.check_minutes = (int{op.check_ahead} + int{op.check_behind}) * dialect.tool_check->minutes;
    program.check_minutes += op.check_minutes;
    program.check_uncertainty_mm = dialect.tool_check->uncertainty_mm.value_or(0);
  }
}

std::vector<std::string> names_of_check_lines() {
  return {"tool", "length", "tolerance", "x", "y", "z", "clearance", "feed", "top", "work_top", "label", "label+1"};
}

NcLines::Values check_values(const NcLines::Values& of_operation, const joints::AxisOperation& op,
                             const NcDialect& dialect, int label) {
  const machines::ToolCheck& check = *dialect.tool_check;
  const int decimals = dialect.format.linear_decimals;
  NcLines::Values values = of_operation;
  const auto put = [&](const char* name, std::int64_t scaled) {
    values[name].clear();
    numbers::append_fixed(values[name], scaled, decimals, dialect.point_always);
  };
  put("length", numbers::to_fixed(op.tool_length_mm, decimals));
  put("tolerance", numbers::to_fixed_down(op.check_tolerance_mm * (1 + 1e-12), decimals));
  put("clearance", numbers::to_fixed(check.clearance_mm, decimals));
  put("feed", numbers::to_fixed_down(check.feed_mm_min * (1 + 1e-12), decimals));
  put("x", numbers::to_fixed(check.position_mm.x(), decimals));
  put("y", numbers::to_fixed(check.position_mm.y(), decimals));
  put("z", numbers::to_fixed(check.position_mm.z(), decimals));
  values["label"] = std::to_string(label);
  values["label+1"] = std::to_string(label + 1);
  return values;
}

std::string check_comment(const joints::AxisOperation& op) {
  return fmt::format("TOOL CHECK T{} WITHIN {:g} MM", op.tool_number, op.check_tolerance_mm);
}

}  // namespace toothpath::text
