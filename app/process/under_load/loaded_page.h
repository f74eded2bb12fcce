// A pair of gears under load, for people: on the screen, as a table and as charts.
#pragma once

#include <string>
#include <vector>

#include "app/process/opening_and_end.h"
#include "app/process/under_load/loaded_contact.h"
#include "app/report/page/study_page.h"

namespace toothpath::under_load {

[[nodiscard]] std::string loaded_summary(const LoadedContact& found);
/// Words, tables and charts of the page of a pair.
void add_to_page(page::StudyPage& page, const LoadedContact& found);
/// The pair itself, and what the job asks for besides.
[[nodiscard]] std::vector<page::PageTable> loaded_tables(const LoadedContact& found);
[[nodiscard]] std::vector<svg::LineChart> loaded_charts(const LoadedContact& found);
/// loaded.csv, pressure.csv and, where the settings ask for it, root_stress.csv join `files`.
void add_files(process::NamedFiles& files, const LoadedContact& found);

}  // namespace toothpath::under_load
