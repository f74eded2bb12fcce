// What the last program, or the lines of a check, may have left is not known until the text says it.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace toothpath::tool_check {

/// Modes that a text must say again ahead of a move; by a number of the reader's own and the words that say them.
class Unsaid {
 public:
  /// Modes behind a check of the tool.
  void all(std::map<unsigned, const char*> modes) { modes_ = std::move(modes), checked_ = true; }
  /// Modes at the begin of a program.
  void at_begin(std::map<unsigned, const char*> modes) { modes_ = std::move(modes); }
  void said(unsigned mode) { modes_.erase(mode); }
  /// The modal groups of a block, a bit each.
  void said_groups(std::uint32_t groups) {
    std::erase_if(modes_, [&](const auto& mode) { return mode.first < 32 && (groups >> mode.first & 1U) != 0; });
  }
  [[nodiscard]] bool none() const { return modes_.empty(); }
  /// What is wrong with a move while one is left. @param move  "an axis word"
  [[nodiscard]] std::string text(const char* move) const {
    if (!checked_)
      return fmt::format("{} ahead of {}: what it does would depend on the last program", move, modes_.begin()->second);
    return fmt::format(
        "{} behind a check of the tool, which may have changed every mode: {} must be said again ahead "
        "of it",
        move, modes_.begin()->second);
  }

 private:
  std::map<unsigned, const char*> modes_;
  bool checked_ = false;  // a check of the tool was run
};

}  // namespace toothpath::tool_check
