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

[[nodiscard]] page::ReportPage synthetic_page(const SyntheticPageOptions& options);

}  // namespace toothpath::test
