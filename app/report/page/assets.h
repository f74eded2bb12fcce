// Text files beside this header, embedded by CMake.
#pragma once

#include <string_view>

namespace toothpath::page {

extern const std::string_view kReportTemplate;  ///< report_page.html
extern const std::string_view kReportStyle;     ///< report_page.css
extern const std::string_view kReportView;      ///< the 3D view: app/report/page/arrays.js .. app/report/page/view.js
extern const std::string_view kReportScript;    ///< the page around it: app/report/page/values.js .. app/report/page/start.js

}  // namespace toothpath::page
