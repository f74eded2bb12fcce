// A report page from made-up but plausible numbers: a curved tooth space of two zones, three operations, two tools.
#pragma once

#include <cstddef>

#include "app/report/page/report_page.h"

namespace toothpath::test {

struct SyntheticPageOptions {
  std::size_t path_points = 12000;  ///< of all operations together, about
  bool gouged = true;               ///< two dozen places beyond the tolerance, not verified
  bool one_operation = false;       ///< finishing alone
  bool awkward_names = false;       ///< markup, quotes, script ends and bytes that are not UTF-8 in every text
  bool study = true;                ///< with a work-precision table
};

/// A wheel of 24 teeth on the plate of a trunnion: plate, cradle, column and nose; joints that tilt and turn it.
[[nodiscard]] page::MachineScene synthetic_machine();

[[nodiscard]] page::ReportPage synthetic_page(const SyntheticPageOptions& options);

}  // namespace toothpath::test
