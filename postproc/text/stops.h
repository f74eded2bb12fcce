// Where a program lets the operator look, and how: what a job may ask of its text beyond the cut.
#pragma once

#include <cstdint>

namespace toothpath::text {

/// Ahead of what the program may stop.
enum class Stops : std::uint8_t { none, tool_changes, operations, teeth };

/// How the operator says whether it does.
enum class StopWord : std::uint8_t {
  optional_stop,  ///< M1: stops where the switch is on
  block_skip,     ///< M0 in a block that is left out where the switch is on
};

/// Where the length of the tool is checked at the tool setter of the machine.
enum class ToolChecks : std::uint8_t {
  none,
  tool_changes,  ///< of a tool that has come, and of one that goes
  operations,    ///< .. and ahead of every operation
  teeth,         ///< .. and between teeth
};

/// What a job asks of the text.
struct TextWishes {
  Stops stops = Stops::none;
  StopWord stop_word = StopWord::optional_stop;
  bool restart_numbers = true;  ///< N words where the program can be taken up again, where blocks have no number else
  ToolChecks checks = ToolChecks::none;
  int teeth_between_checks = 0;    ///< at most; with `teeth`
  bool stop_at_first_cut = false;  ///< behind a change of the tool, ahead of its first cut
};

}  // namespace toothpath::text
