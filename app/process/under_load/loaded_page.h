// A pair of gears under load, for people: on the screen, as a table and as charts.
#pragma once

#include <string>
#include <vector>

#include "app/process/under_load/loaded_contact.h"
#include "app/report/page/report_page.h"

namespace toothpath::under_load {

[[nodiscard]] std::string loaded_summary(const LoadedContact& found);
/// What was loaded and how, for the head of a page.
[[nodiscard]] std::string loaded_introduction(const LoadedContact& found);
/// The pair itself, and what the job asks for besides.
[[nodiscard]] std::vector<page::PageTable> loaded_tables(const LoadedContact& found);
[[nodiscard]] std::vector<svg::LineChart> loaded_charts(const LoadedContact& found);

}  // namespace toothpath::under_load
