// What a fit came to: fit.json, a page with the map of what remains, a line a point, a table for the screen.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/fit/fit.h"
#include "app/report/page/study_page.h"

namespace toothpath::fit {

struct Told {
  const job::Job& job;
  const job::LoosePoints& points;
  const Fitted& fitted;
  std::vector<std::string> refused;  ///< why the fitted gear is none that can be cut
};

[[nodiscard]] nlohmann::ordered_json fit_json(const Told& told);
/// Every point that lies on a flank: where, and what the start and the fitted gear leave of it.
[[nodiscard]] std::string points_csv(const Told& told);
/// With a map for every flank whose points cover it.
[[nodiscard]] page::StudyPage fit_page(const Told& told);
/// For the screen, from the tables of the page.
[[nodiscard]] std::string fit_summary(const Told& told, const page::StudyPage& page);

}  // namespace toothpath::fit
