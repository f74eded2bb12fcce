// What a job may ask of a loaded pair besides: what friction could add, and the stress at the roots.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/process/under_load/loaded_contact.h"
#include "app/report/page/report_page.h"

namespace toothpath::under_load {

[[nodiscard]] std::string besides_summary(const LoadedContact& found, const LoadedSide& side);
/// Joins `friction` and `root_stress` to the numbers of a flank, as far as they were asked for.
void add_besides(nlohmann::ordered_json& flank, const LoadedContact& found, const LoadedSide& side);
[[nodiscard]] std::string root_csv(const LoadedContact& found);  ///< a line a fillet; needs root_stress
[[nodiscard]] std::vector<page::PageTable> besides_tables(const LoadedContact& found);

}  // namespace toothpath::under_load
