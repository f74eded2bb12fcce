// Remarks in NC text.
#pragma once

#include <string>
#include <string_view>

namespace toothpath::numbers {

/// Text that may stand in a remark of any dialect: printable ASCII, upper case, ( ) -> [ ]; Latin letters with marks
/// (U+00C0 to U+00FF) without them, as in GRUEN, CITROEN; the rest -> '?', one a letter.
[[nodiscard]] std::string comment_text(std::string_view text);

}  // namespace toothpath::numbers
