// Where words count from: the work offset, one that the program writes, and zeros of rotaries that it moves.
#include <cmath>

#include "postproc/readback/execution.h"

namespace toothpath::readback {
namespace {

constexpr double kOneTurn = 360;  // deg

}  // namespace

NcExecution::Problem NcExecution::select_offset(const std::string& name) {
  const bool written = !name.empty() && name == control_.index_offset;
  if (written && !written_) return fmt::format("work offset {} ahead of the line that writes it", name);
  const auto found = control_.work_offsets.find(name);
  if (!written && found == control_.work_offsets.end()) return fmt::format("work offset {} is not defined", name);
  const Vec3& at = written ? written_->at_mm : found->second;
  if (tcp_ && !rules_.offsets_turn && offset_ != at) return "another work offset with TCP on";
  if (plane_ && offset_ != at) return "another work offset in a tilted plane";
  offset_ = at;
  in_written_ = written;
  if (rules_.offsets_turn) frame_deg_ = written ? written_->turn_deg : 0;
  return std::nullopt;
}

NcExecution::Problem NcExecution::write_offset(const std::optional<Vec3>& at_mm, double turn_deg) {
  if (in_written_) return fmt::format("{} is written while words count from it", control_.index_offset);
  if (!at_mm && !written_)
    return fmt::format("{} is turned ahead of the line that says where it is", control_.index_offset);
  written_ = WrittenOffset{at_mm ? *at_mm : written_->at_mm, turn_deg};
  return std::nullopt;
}

NcExecution::Problem NcExecution::move_zero(std::size_t axis, double degrees, std::string_view word) {
  if (tcp_) return fmt::format("{} moves the zero of {} with TCP on", word, control_.letters[axis]);
  if (!zeros_cleared_ && degrees != 0)
    return fmt::format("{} ahead of the line that clears it: what an earlier program has left is not known", word);
  if (control_.rollover[axis] && rules_.sign_is_sense && !(std::abs(degrees) < kOneTurn))
    return fmt::format("{} moves the zero of {}, which rolls over, by {} deg, outside -360 .. 360", word,
                       control_.letters[axis], degrees);
  set_zero(axis, degrees);
  return std::nullopt;
}

/// Nothing turns: the axis stands elsewhere in its words.
void NcExecution::set_zero(std::size_t axis, double degrees) {
  rolled_[axis] -= degrees - zero_[axis];
  zero_[axis] = degrees;
}

NcExecution::Problem NcExecution::clear_zeros() {
  if (tcp_ && (zero_[3] != 0 || zero_[4] != 0)) return "the zero of a rotary goes back with TCP on";
  for (const std::size_t a : {3U, 4U}) set_zero(a, 0);
  zeros_cleared_ = true;
  return std::nullopt;
}

/// Nothing that a program has moved may be left to the next one.
NcExecution::Problem NcExecution::zeros_allow_end() const {
  for (std::size_t a = 3; a < 5; ++a)
    if (zero_[a] != 0)
      return fmt::format("program end while {} counts from {} deg: the next program would begin there",
                         control_.letters[a], zero_[a]);
  if (in_written_) return fmt::format("program end in {}: the next program would begin there", control_.index_offset);
  if (written_ && written_->turn_deg != 0)
    return fmt::format("program end while {} is turned by {} deg: the next program would find it so",
                       control_.index_offset, written_->turn_deg);
  return std::nullopt;
}

}  // namespace toothpath::readback
