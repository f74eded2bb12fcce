// Where a text releases and clamps the rotaries that the machine can hold. All are released behind the opening of an
// operation, and each ahead of the blocks that turn it. It is clamped behind the turn of a link, if it stands still in
// the cuts up to the next one; of the first turn of a tooth once more, so that a program can be taken up there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "postproc/joints/program.h"
#include "postproc/text/dialect.h"

namespace toothpath::text {

class NcClamps {
 public:
  /// @param stops the program may stop behind every tooth: what the operator does then is not known
  NcClamps(const joints::AxisProgram& program, const NcDialect& dialect, bool stops)
      : program_(program), dialect_(dialect), stops_(stops) {}

  [[nodiscard]] bool any() const { return dialect_.clamps[0] || dialect_.clamps[1]; }

  // Lines for these places, in the order of the text.
  [[nodiscard]] std::vector<std::string> opening();
  /// A tooth begins. @param looped its index turns, and it is entered from its own end
  void enter(const std::vector<joints::AxisBlock>& tooth, bool looped);
  [[nodiscard]] std::vector<std::string> ahead(const std::vector<joints::AxisBlock>& tooth, std::size_t block);
  [[nodiscard]] std::vector<std::string> behind(const std::vector<joints::AxisBlock>& tooth, std::size_t block);

  /// A tooth has ended.
  void leave() {
    if (stops_) stopped();
  }
  /// The program has stopped.
  void stopped() { state_.fill(State::unknown); }

  /// What the lines so far take where they change something, min.
  [[nodiscard]] double minutes() const { return minutes_; }

 private:
  enum class State { unknown, released, clamped };
  [[nodiscard]] bool turns(const std::vector<joints::AxisBlock>& tooth, std::size_t block, std::size_t rotary) const;
  [[nodiscard]] bool stands_in_cuts(const std::vector<joints::AxisBlock>& tooth, std::size_t block,
                                    std::size_t rotary) const;
  void change(std::size_t rotary, State to, std::vector<std::string>& lines);

  const joints::AxisProgram& program_;
  const NcDialect& dialect_;
  bool stops_;
  std::array<State, 2> state_ = {State::unknown, State::unknown};
  std::array<bool, 2> said_{};                        // in this tooth
  std::array<bool, 2> enters_{};                      // the first link of this tooth turns it
  std::array<bool, 2> says_{};                        // whatever the state: the text stands for several teeth
  std::optional<std::array<std::int64_t, 2>> stood_;  // behind the tooth before
  double minutes_ = 0;
};

/// What clamping takes in the program: `clamp_minutes` of its operations and of all.
void note_clamp_times(joints::AxisProgram& program, const NcDialect& dialect, bool stops = false);

}  // namespace toothpath::text
