// The line HASH of a program: does it still fit the text?
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace toothpath::readback {

struct ProgramHash {
  std::uint64_t stated = 0;  ///< by the comment at the top
  std::uint64_t found = 0;   ///< of what stands between it and the comment at the end
  std::size_t blocks = 0;    ///< stated there too; 0: not
  int line = 0;              ///< of the comment at the top
  int end_line = 0;          ///< of the one at the end; 0: there is none
  bool ends_agree = true;    ///< both comments say the same
  [[nodiscard]] bool fits() const { return end_line > 0 && ends_agree && stated == found; }
};

/// Nothing: no comment "HASH ...". Comments of every language that is read: (..), ;.. and $$.., behind a block number
/// or not. Counted are the lines between the comments at the top and the last such comment, without block numbers and
/// carriage returns.
[[nodiscard]] std::optional<ProgramHash> hash_of_program(std::string_view text);

/// Of a text without that comment, or edited since: lines that are neither comments nor empty nor %.
[[nodiscard]] std::size_t count_blocks(std::string_view text);

}  // namespace toothpath::readback
