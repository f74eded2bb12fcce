// Results of the gouge check put together: of chunks of motions, of teeth, of bodies. The same result for any division
// of the same motions, when the parts are added in the order of the program.
#pragma once

#include "cam/proof/verification.h"

namespace toothpath::proof {

/// Nothing looked at yet: no depth, no gap, all rapids clear.
[[nodiscard]] GougeResult no_motion_yet(double required_clearance_mm);

/// One more of the places that are listed: deepest first, at most 20; of equal depth the one that came first.
void add_worst(GougeResult& result, WorstPlace place);

/// One more place that was looked at: kept where it is the deepest so far, of equal depth the one that came first.
void note_deepest(GougeResult& result, const WorstPlace& place);

/// The worse of both, value by value; motions and queries are summed. `later` comes behind `all` in the program.
void add_result(GougeResult& all, const GougeResult& later);

}  // namespace toothpath::proof
