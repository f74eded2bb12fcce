// The hashes: one that names bytes so that nobody can mistake them, and one that is quick.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace toothpath {

/// 64 hexadecimal digits, those that the command sha256sum prints: a report names with them the exact bytes it speaks
/// of. Source: FIPS 180-4, by OpenSSL's libcrypto; throws std::runtime_error where that cannot work (a build of it
/// without SHA-256).
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

/// FNV-1a, 64 bits: the line HASH of NC programs, tables in memory.
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t h = 14695981039346656037ULL;
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

}  // namespace toothpath
