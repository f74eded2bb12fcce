// Short finishing passes at the ends of a ring, where a ball wider than the fillet reaches deeper into it than in the
// middle.
//
// Such a ball touches two walls of a corner at once, at two different radii where the normals lean along the tooth
// (shaft angles other than 90 deg, helices). Near an end of the ring one of the two contacts lies beyond the end: the
// wall has ended, the ball is held by its edge only, and touches the other wall past the crossing at which the sheet of
// ball centres is cut off.
//
//        r  |  flank | past the crossing | hidden | ...         the end of the ring
//           |  ......|-------------------'
//           |  ......|-----------'        <- where the ball touches the edge of the other wall
//           |  ......|----'
//           |  ......|  from here on the ball touches both walls; the corner has its pass
//
// A ball that is held by both walls all along the ring may so come down to a spot of the root land at the very end.
#pragma once

#include <functional>
#include <vector>

#include "cam/ball/finishing.h"
#include "geometry/tooth_space/offset_sheet.h"

namespace toothpath::ball {

/// Distance [mm] from a ball centre (gear frame) to the finished part; exact up to the offset of the sheet, more may be
/// anything larger.
using PartDistance = std::function<double(const Vec3& centre)>;

/// Passes from an end of the ring (with run-out) to where the corner closes, spaced for the asked cusp, and over every
/// spot there that neither they nor `laid`, all other passes, cover; none on a sheet without gaps and where what stays
/// without them is below the asked cusp. Their ball centres keep the offset of the sheet from the part, but for 0.05
/// um.
[[nodiscard]] std::vector<BallPass> plan_corner_ends(const tooth_space::OffsetSheet& sheet,
                                                     const FinishingOptions& options, const PartDistance& distance,
                                                     std::vector<BallPass> laid);

}  // namespace toothpath::ball
