// The parts of the report page that are plain HTML and SVG. Each function returns markup, empty where there is nothing
// to say.
#pragma once

#include <string>

#include "app/report/page/report_page.h"

namespace toothpath::page {

/// Title, verdict, reasons.
[[nodiscard]] std::string page_header(const ReportPage& page);
/// Key figures and warnings.
[[nodiscard]] std::string overview_section(const ReportPage& page);
/// Summary of the job and assumed values.
[[nodiscard]] std::string job_section(const ReportPage& page);
/// Worst places with links into the 3D view, and the excerpt of the program.
[[nodiscard]] std::string gouge_section(const ReportPage& page);
/// Histogram and table of the deviation after each operation.
[[nodiscard]] std::string deviation_section(const ReportPage& page);
[[nodiscard]] std::string ledger_section(const ReportPage& page);
[[nodiscard]] std::string direction_section(const ReportPage& page);
/// Axis positions, speeds and feed over time.
[[nodiscard]] std::string motion_section(const ReportPage& page);
/// Where the flanks of the gear end.
[[nodiscard]] std::string limits_section(const ReportPage& page);
[[nodiscard]] std::string work_precision_section(const ReportPage& page);
/// What `page.contact` holds.
[[nodiscard]] std::string contact_section(const ReportPage& page);
/// One of `page.sections`.
[[nodiscard]] std::string section_of_the_report(const report::Section& section);
[[nodiscard]] std::string stages_section(const ReportPage& page);
[[nodiscard]] std::string tables_section(const ReportPage& page);

}  // namespace toothpath::page
