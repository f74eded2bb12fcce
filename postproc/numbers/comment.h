// Remarks in NC text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace toothpath::numbers {

/// Text that may stand in a remark of any dialect: printable ASCII, upper case, ( ) -> [ ]; Latin letters with marks
/// (U+00C0 to U+00FF) without them, as in GRUEN, CITROEN; the rest -> '?', one a letter.
[[nodiscard]] std::string comment_text(std::string_view text);

/// The whole words of `text` that fit into so many characters; of a first word that is longer, its beginning.
[[nodiscard]] std::string first_words(std::string_view text, std::size_t most);
/// `text` in lines of so many characters at most, each of whole words; one empty line of an empty text.
[[nodiscard]] std::vector<std::string> lines_of_words(std::string_view text, std::size_t most);

}  // namespace toothpath::numbers
