// Lines of Siemens text: where a comment begins, capitals, and what stands ahead of the words of a block.
#pragma once

#include <string>
#include <string_view>

#include "postproc/readback/acting_comment.h"
#include "postproc/readback/scanner.h"

namespace toothpath::controls {

/// The line up to its comment; a ; inside "text" begins none.
[[nodiscard]] std::string_view siemens_code(std::string_view line);

/// The same text with capitals, but for what stands in quotes: the control reads both alike. @param room holds it where
/// a letter changes
[[nodiscard]] std::string_view in_capitals(std::string_view code, std::string& room);

/// Takes what may stand ahead of a block: / or /0 to /9, then N10 or :10. @returns there was a /
bool take_beginning(readback::NcScanner& s);

/// ;$PATH=/_N_.. says where the control files the text when it reads it in.
[[nodiscard]] std::optional<readback::ActingComment> siemens_acting_comment(std::string_view line);

}  // namespace toothpath::controls
