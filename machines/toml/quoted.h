// A text as a value of TOML.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace toothpath::toml {

/// In quotes, with everything escaped that means something there. @param text  UTF-8
[[nodiscard]] inline std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (code < 0x20 || code == 0x7f) out += fmt::format("\\u{:04X}", code);
    else out += c;
  }
  return out + '"';
}

}  // namespace toothpath::toml
