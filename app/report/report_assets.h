// Text files beside this header, embedded by CMake.
#pragma once

#include <string_view>

namespace toothpath {

extern const std::string_view kReportTemplate;  ///< report_page.html
extern const std::string_view kReportStyle;     ///< report_page.css
extern const std::string_view kReportView;      ///< report_view.js
extern const std::string_view kReportScript;    ///< report_page.js

}  // namespace toothpath
