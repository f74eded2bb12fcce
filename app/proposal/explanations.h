// What `toothpath new` asks for, in the words of the shop: shown where somebody answers "?".
#pragma once

#include <string_view>

namespace toothpath::proposal {

/// One to three sentences on the option, "--module"; empty: the question says it all.
[[nodiscard]] std::string_view explanation_of(std::string_view option);

}  // namespace toothpath::proposal
