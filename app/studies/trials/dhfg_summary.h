// What `study dhfg` says of its samples: tables, charts, files.
#pragma once

#include <string>
#include <vector>

#include "app/process/opening_and_end.h"
#include "app/studies/trials/dhfg_samples.h"

namespace toothpath::trials {

/// Of a quick study scallops are this many times, chord tolerances and roughing steps these many times as coarse.
inline constexpr double kQuickScallop = 10, kQuickChord = 5, kQuickStep = 2;

struct DhfgSummary {
  process::NamedFiles files;  ///< dhfg.csv, dhfg.json, dhfg.html
  std::string json;           ///< of dhfg.json
  std::string text;           ///< for the screen
};
inline const std::vector<std::string> kDhfgFiles = {"dhfg.csv", "dhfg.json", "dhfg.html"};

[[nodiscard]] DhfgSummary summary_of(const StudyFacts& facts, const StudyFound& found);

}  // namespace toothpath::trials
