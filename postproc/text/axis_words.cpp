#include "postproc/text/axis_words.h"

#include <cmath>

#include "postproc/joints/rollover.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::text {

std::int64_t NcAxisWords::turn_word() const { return numbers::to_fixed(360, program_.format.rotary_decimals); }

void NcAxisWords::enter_loop(const std::vector<joints::AxisBlock>& tooth) {
  if (!tooth.empty()) position_ = joints::loop_entry(tooth, program_);
  commanded_.fill(false);
}

void NcAxisWords::print(const joints::AxisBlock& b, std::size_t axis, IndexWord index) {
  if (program_.letters[axis] == 0) return;
  const bool is_index = static_cast<int>(axis) == program_.index_axis;
  if (axis >= 3 && program_.planes && program_.planes->tilted(b.words)) return;  // the plane has turned it
  const std::int64_t word = b.words[axis];
  const bool unchanged = known_[axis] && last_[axis] == word, backwards = axis >= 3 && word < position_[axis - 3];
  // By sign the round-off of the control's own sum decides about a whole turn where the axis stands already.
  const bool stands = by_sign(axis) && commanded_[axis - 3] && word == position_[axis - 3];
  known_[axis] = true;
  last_[axis] = word;
  if (axis >= 3) position_[axis - 3] = word;
  if (stands || (unchanged && !b.forced)) return;
  std::string& text = out_.text();
  text += ' ';
  text += program_.letters[axis];
  if (axis >= 3) {
    text += dialect_.rotary_equals;
    commanded_[axis - 3] = true;
  }
  const bool shifted = is_index && index == IndexWord::shifted;
  if (program_.rollover[axis]) rollover_number(axis, word, shifted, backwards);
  else if (shifted) shifted_number(axis, word);
  else out_.number(word, decimals(axis));
}

/// The angle of this tooth and the word.
void NcAxisWords::shifted_number(std::size_t axis, std::int64_t word) {
  std::string& text = out_.text();
  text += dialect_.loop.index;
  if (word == 0) return;
  if (word > 0 && !dialect_.sign_always) text += '+';
  out_.number(word, decimals(axis));
}

/// The place within the turn, and the way where the control asks for it.
void NcAxisWords::rollover_number(std::size_t axis, std::int64_t word, bool shifted, bool backwards) {
  const NcRollover& roll = dialect_.rollover;
  const std::int64_t place = joints::within_turn(word, turn_word());
  std::string& text = out_.text();
  text += roll.open;
  if (backwards && by_sign(axis)) text += '-';
  const std::size_t begin = text.size();
  if (shifted) shifted_number(axis, place);
  else out_.number(place, decimals(axis));
  if (shifted && !roll.index.empty()) {
    const auto place_in_turn = expanded(roll.index, {{"word", text.substr(begin)}});
    text.resize(begin);
    if (place_in_turn) text += *place_in_turn;
    else if (!out_.error())
      out_.error() = fail("dialect {}: \"{}\" names a value that does not exist here", dialect_.name, roll.index);
  }
  text += roll.close;
}

double NcAxisWords::length(const joints::AxisBlock& b) const {
  const auto part = [&](std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t a = from; a < to; ++a) {
      const double d =
          static_cast<double>(b.words[a] - last_[a]) / static_cast<double>(numbers::power_of_ten(decimals(a)));
      sum += d * d;
    }
    return std::sqrt(sum);
  };
  const double linear = part(0, 3);
  return linear > 0 ? linear : part(3, 5);
}

}  // namespace toothpath::text
