// What the writers of probing programs share.
#pragma once

#include <string>
#include <vector>

#include "postproc/probing/probing.h"

namespace toothpath::probing {

/// A letter and a value with four decimals; `sign`: a plus, too.
[[nodiscard]] std::string word(char letter, double value, bool sign = false);
/// X and Y of a place, or all three, blanks between.
[[nodiscard]] std::string words(const Vec3& place, int count, bool sign = false);
/// What stands at the head of every program, ASCII, upper case, without brackets.
[[nodiscard]] std::vector<std::string> header(const ProbeProgram& program);

}  // namespace toothpath::probing
