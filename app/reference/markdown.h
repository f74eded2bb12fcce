// The reference of all keys as a page in Markdown.
#pragma once

#include <string>

#include "app/reference/formats.h"

namespace toothpath::reference {

/// What a value may be, in words: "0.01 to 100 mm", "\"up\" or \"down\"".
[[nodiscard]] std::string value_text(const toml::ValueShape& shape);
/// `sections` begin with "## ".
[[nodiscard]] std::string markdown_sections(const Format& format);
/// docs/job_reference.md.
[[nodiscard]] std::string job_markdown();
/// docs/machine_reference.md.
[[nodiscard]] std::string machine_markdown();

}  // namespace toothpath::reference
