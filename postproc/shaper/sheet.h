// The set-up of a gear shaper as a file for programs and as a sheet of paper for the setter.
#pragma once

#include <string>
#include <vector>

#include "postproc/shaper/setup.h"

namespace toothpath::shaper {

/// shaper.json: mm, deg, min; ratios as [numerator, denominator]. Ends in a line feed.
/// @param study  error against cutting time for several circular feeds, may be empty
[[nodiscard]] std::string shaper_json(const ShaperSetup& setup, const std::vector<FeedStudyRow>& study);

/// shaper.html: one A4 side without script: steps in the setter's order, change gears, slide, stroke, pass table with
/// inspection values, error against cutting time; every assumed value marked "assumed".
[[nodiscard]] std::string shaper_html(const ShaperSetup& setup, const std::vector<FeedStudyRow>& study);

/// The circular feeds that the sheet compares: the job's times 1/2, 1, 2, 4, 8, as far as they are sound.
[[nodiscard]] std::vector<double> compared_feeds(const ShaperSetup& setup);

}  // namespace toothpath::shaper
