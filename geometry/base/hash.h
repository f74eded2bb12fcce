// The hashes: one that names bytes so that nobody can mistake them, and one that is quick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // of OpenSSL

namespace toothpath {

/// 64 hexadecimal digits, those that the command sha256sum prints: a report names with them the exact bytes it speaks
/// of. Source: FIPS 180-4, by OpenSSL's libcrypto; throws std::runtime_error where that cannot work (a build of it
/// without SHA-256).
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

/// The same of bytes that come in pieces, with a fixed amount of memory.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Of all that was added; nothing may be added afterwards.
  [[nodiscard]] std::string hex();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// FNV-1a, 64 bits: the line HASH of NC programs, tables in memory.
/// @param h of what comes before, where the bytes come in pieces
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view bytes, std::uint64_t h = 14695981039346656037ULL) {
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

}  // namespace toothpath
