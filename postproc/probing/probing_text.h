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
/// How a touch is come to.
enum class Coming {
  first,   ///< from the height of the tool change
  turned,  ///< the same, the rotaries turn before
  beside,  ///< from the touch before, at the clear height
};
[[nodiscard]] Coming coming_to(const ProbeProgram& program, std::size_t touch);
/// What stands at the head of every program, ASCII, upper case, without brackets.
[[nodiscard]] std::vector<std::string> header(const ProbeProgram& program);

}  // namespace toothpath::probing
