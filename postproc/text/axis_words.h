// The axis words of a block: what has changed or must be named, the index of a loop, rotaries that roll over.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "postproc/joints/program.h"
#include "postproc/text/dialect.h"
#include "postproc/text/lines.h"

namespace toothpath::text {

/// How the word of the index rotary is printed.
enum class IndexWord {
  literal,  ///< as it stands
  shifted,  ///< by the variable of the loop
};

class NcAxisWords {
 public:
  NcAxisWords(const joints::AxisProgram& program, const NcDialect& dialect, NcLines& out)
      : program_(program), dialect_(dialect), out_(out) {}

  /// Appends the word of one axis (0 to 4) with a blank ahead, if the block needs it.
  void print(const joints::AxisBlock& b, std::size_t axis, IndexWord index);

  /// The next block names every axis that it may.
  void forget() { known_.fill(false); }
  /// The rotaries have gone to those of `b` without a word of theirs (tool vectors).
  void stand(const joints::AxisBlock& b) { position_ = {b.words[3], b.words[4]}; }
  /// The rotaries have gone to those of `b` by a tilted plane: the next block names every axis that it may.
  void turn_by_plane(const joints::AxisBlock& b) {
    stand(b);
    last_[3] = b.words[3];
    last_[4] = b.words[4];
    forget();
  }
  /// The body of a loop begins: the rotaries stand where the tooth before ends.
  void enter_loop(const std::vector<joints::AxisBlock>& tooth);

  /// The block moves a rotary, seen from the words before.
  [[nodiscard]] bool turns(const joints::AxisBlock& b) const {
    return b.words[3] != last_[3] || b.words[4] != last_[4];
  }
  /// Length that the control takes for a feed block: X Y Z if any of them moves, else the rotaries [mm or deg].
  [[nodiscard]] double length(const joints::AxisBlock& b) const;
  [[nodiscard]] int decimals(std::size_t axis) const {
    return axis < 3 ? program_.format.linear_decimals : program_.format.rotary_decimals;
  }
  /// 360 deg as a word.
  [[nodiscard]] std::int64_t turn_word() const;

 private:
  [[nodiscard]] bool by_sign(std::size_t axis) const {
    return program_.rollover[axis] && dialect_.rollover.way == NcRollover::Way::sign;
  }
  void shifted_number(std::size_t axis, std::int64_t word);
  void rollover_number(std::size_t axis, std::int64_t word, bool shifted, bool backwards);

  const joints::AxisProgram& program_;
  const NcDialect& dialect_;
  NcLines& out_;
  std::array<std::int64_t, 5> last_{};
  std::array<bool, 5> known_{};
  std::array<std::int64_t, 2> position_{};  // of the rotaries
  std::array<bool, 2> commanded_{};         // they stand there
};

}  // namespace toothpath::text
