// Text of others (file names, keys, cells of tables) as it may go to a terminal: nothing in it can move the cursor,
// hide what stands there, or look like a line of ours.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace toothpath {

/// Length of the valid UTF-8 sequence at byte `i`, 0 where there is none (overlong forms and surrogates are invalid).
[[nodiscard]] std::size_t utf8_length(std::string_view text, std::size_t i);

/// Beyond ASCII, of a valid sequence: further control characters, separators of lines, signs that turn the direction of
/// writing, byte order mark. What follows them may look otherwise than it is.
[[nodiscard]] bool is_hidden(std::string_view sequence);

/// One line of visible text: control characters and bytes that are not UTF-8 as \xNN (line feed \n, tab \t), further
/// control characters, separators of lines and signs that turn the direction of writing as \u{NNNN}.
[[nodiscard]] std::string printable(std::string_view text);

/// The same, but line feeds stay, and with `color` the sequences that set a colour.
[[nodiscard]] std::string printable_lines(std::string_view text, bool color);

}  // namespace toothpath
