// Text files of the folder assets, embedded by CMake.
#pragma once

#include <string_view>

namespace toothpath::page {

extern const std::string_view kReportTemplate;  ///< report_page.html
extern const std::string_view kReportStyle;     ///< report_page.css
extern const std::string_view kReportView;      ///< the 3D view: arrays.js .. view.js
extern const std::string_view kReportScript;    ///< the page around it: values.js .. start.js

}  // namespace toothpath::page
