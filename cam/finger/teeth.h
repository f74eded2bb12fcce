// The check of a program that cuts several tooth spaces of a bevel gear, each measured on its own.
#pragma once

#include <map>
#include <span>

#include "cam/finger/check.h"
#include "cam/proof/like_motion.h"

namespace toothpath::finger {

/// The worst of every tooth space that is cut, as `FingerGougeCheck::verify` says of each; grids and what is left are
/// those of the space where most may stand, of equal ones the first. Rapids at spaces that nothing cuts are judged with
/// the first one. Runs on all threads, same bytes on any number.
/// @param likes  motions that go nearly as others do. Every motion is proven by itself; on its walls a tooth whose
///               motions are nearly all like others is looked at where it is the one that is proven least, in depth,
///               gap or material left, and along the motions that are like none: what is found elsewhere is away from
///               this by no more than the likes are.
/// @param away   of later teeth that are no copies of the first one: no cut of that is farther from one of theirs, mm;
///               infinite where one is missing. Where the ridges of the first tooth and this way may stand higher than
///               they may, a tooth is looked at like the first one.
[[nodiscard]] FingerCheckResult verify_teeth(const FingerGougeCheck& check, std::span<const path::ToolMotion> motions,
                                             std::span<const proof::LikeMotion> likes = {},
                                             const std::map<int, double>& away = {});

}  // namespace toothpath::finger
