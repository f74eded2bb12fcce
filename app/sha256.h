// SHA-256, so that a report names the exact bytes it speaks of (the same digits as the command sha256sum prints).
#pragma once

#include <string>
#include <string_view>

namespace toothpath {

/// 64 hexadecimal digits. Source: FIPS 180-4.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace toothpath
