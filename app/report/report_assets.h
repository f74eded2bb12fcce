// Text files beside this header, embedded by CMake.
#pragma once

#include <string_view>

namespace toothpath {

extern const std::string_view kReportTemplate;  ///< report_page.html
extern const std::string_view kReportStyle;     ///< report_page.css
extern const std::string_view kReportView;      ///< the 3D view: report_arrays.js .. report_view.js
extern const std::string_view kReportScript;    ///< the page around it: report_values.js .. report_start.js

}  // namespace toothpath
