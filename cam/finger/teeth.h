// The check of a program that cuts several tooth spaces of a bevel gear, each measured on its own.
#pragma once

#include <span>

#include "cam/finger/check.h"

namespace toothpath::finger {

/// The worst of every tooth space that is cut, as `FingerGougeCheck::verify` says of each; grids and what is left are
/// those of the space where most may stand, of equal ones the first. Rapids at spaces that nothing cuts are judged with
/// the first one. Runs on all threads, same bytes on any number.
[[nodiscard]] FingerCheckResult verify_teeth(const FingerGougeCheck& check, std::span<const path::ToolMotion> motions);

}  // namespace toothpath::finger
