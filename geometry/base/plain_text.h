// Text files that other programs wrote, as one kind of text.
#pragma once

#include <string>

#include "geometry/base/result.h"

namespace toothpath {

/// The text of a foreign file in UTF-8 with line feeds: UTF-16 (known by its byte order mark, or by a zero byte beside
/// its first character) is converted, byte order marks go, CR LF and a lone CR become a line feed. Bytes that are no
/// UTF-8 stay as they are. Refused: UTF-16 that ends within a character. `file` stands in the message.
[[nodiscard]] Result<std::string> plain_text(std::string bytes, const std::string& file);

}  // namespace toothpath
