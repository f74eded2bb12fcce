// The charts of the shaper sheet: what finite circular feeds leave on the flanks, over the feed and over the time.
#pragma once

#include <string>
#include <vector>

#include "postproc/shaper/simulation.h"

namespace toothpath::shaper {

/// Two small <svg> side by side, logarithmic axes with units: greatest and mean square deviation over circular feed and
/// over minutes; the job's own feed is ringed. Without script; empty for fewer than two rows.
[[nodiscard]] std::string feed_study_charts(const std::vector<FeedStudyRow>& study, double job_feed_mm);

}  // namespace toothpath::shaper
