// Text that is safe inside HTML, SVG and inline scripts.
#pragma once

#include <string>
#include <string_view>

namespace toothpath::svg {

/// `&`, `<`, `>`, `"` and `'` as entities; control characters other than tab and newline, hidden ones
/// (is_hidden), and bytes that are not valid UTF-8, become U+FFFD. For element content and quoted attributes.
[[nodiscard]] std::string html_escape(std::string_view text);
/// With a capital at its begin.
[[nodiscard]] std::string sentence(std::string text);

/// Valid UTF-8: bytes that are not become U+FFFD. For text that goes into JSON.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// A word of more than 24 bytes (a path, a hash): a table cell that holds one lets it break, or it pushes the others
/// off the paper.
[[nodiscard]] bool has_long_word(std::string_view text);

/// JSON text made safe inside a script element: `<`, `>`, `&` and the two Unicode line ends as \u escapes. These
/// characters occur only inside the strings of a JSON text, where the escapes mean the same.
[[nodiscard]] std::string script_safe_json(std::string_view json);

/// A number for people: at most `digits` significant digits, no trailing zeros, powers of ten beyond 1e-4 and 1e6. "-0"
/// is "0", NaN and infinities are an en dash.
[[nodiscard]] std::string short_number(double value, int digits = 4);

}  // namespace toothpath::svg
