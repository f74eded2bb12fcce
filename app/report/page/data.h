// The data behind the 3D view, as JSON with packed arrays.
#pragma once

#include <string>

#include "app/report/page/report_page.h"

namespace toothpath::page {

/// What does not fit together in `page`, or Ok; see render_report_page().
[[nodiscard]] Status check_report_page(const ReportPage& page);

/// Name of an operation for people: its number in the job and its type.
[[nodiscard]] std::string operation_name(const ReportPage& page, int operation);

/// JSON text for the page's script, safe inside a script element. Expects a page that check_report_page() accepts.
[[nodiscard]] std::string report_data_json(const ReportPage& page);

}  // namespace toothpath::page
