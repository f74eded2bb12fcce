// How often the loops of a program turn: one that moves and counts for ever is found by it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

namespace toothpath::readback {

class LoopTurns {
 public:
  static constexpr std::uint32_t kMost = 100'000;  ///< of one loop in a program; a job may have 5000 teeth

  /// The program goes back to `line` (of its loop, from 0). @returns what is wrong with it, or nothing
  [[nodiscard]] std::optional<std::string> back_to(std::size_t line) {
    if (++turns_[line] <= kMost) return std::nullopt;
    return fmt::format("the loop has turned more than {} times: a loop without end", kMost);
  }

 private:
  std::unordered_map<std::size_t, std::uint32_t> turns_;
};

}  // namespace toothpath::readback
