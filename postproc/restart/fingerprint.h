// Moves of two texts are compared by a number each.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "postproc/readback/reader.h"

namespace toothpath::restart {

/// A move as a number: words, times, tool, spindle and coolant, without the axes that had no word since the first tooth
/// began. Two moves that differ have the same number once in 2^64.
class Fingerprint {
 public:
  explicit Fingerprint(const readback::NcControl& control) : control_(control) {}

  std::uint64_t of(const readback::ExecutedMove& m) {
    set_ = static_cast<std::uint8_t>(set_ | m.commanded);
    by_plane_ = static_cast<std::uint8_t>(m.plane ? by_plane_ | m.commanded : by_plane_ & ~m.commanded);
    h_ = 14695981039346656037ULL;
    add(static_cast<std::uint64_t>(m.operation) << 32 | static_cast<std::uint32_t>(m.tool));
    add(static_cast<std::uint64_t>(m.tooth) << 16 | static_cast<std::uint64_t>(m.commanded) << 4 | (m.rapid ? 1U : 0U) |
        (m.tcp ? 2U : 0U) | (m.machine ? 4U : 0U));
    // A vector stands for the rotaries: which of their positions has it follows from where they stood.
    add(m.vector_print);
    for (std::size_t a = m.tcp ? 3 : 0; a < 5; ++a)
      if ((set_ & (1U << a)) != 0 && m.vector_print == 0) add_joint(m, a);
    if (m.tcp)
      for (int i = 0; i < 3; ++i) add(std::bit_cast<std::uint64_t>(m.tip[i]));
    if (!m.rapid) {
      add(std::bit_cast<std::uint64_t>(m.minutes));
      add(std::uint64_t{std::bit_cast<std::uint32_t>(m.speed_rpm)} << 16 | std::uint64_t{m.coolants} << 1 |
          (m.in_doubt ? 1U : 0U));
    }
    for (const float v : {m.blend_mm, m.blend_axis_rad, m.corner_path_mm, m.corner_share})
      add(std::bit_cast<std::uint32_t>(v));
    return h_;
  }
  /// Every axis of the machine has had its word.
  [[nodiscard]] bool all_set(const readback::NcControl& control) const {
    for (std::size_t a = 0; a < 5; ++a)
      if (control.letters[a] != 0 && (set_ & (1U << a)) == 0) return false;
    return true;
  }

 private:
  /// A rotary that rolls over counts by its place within the turn, where it has a word; any that a tilted plane has
  /// turned, too: the control takes the turn nearest to where it stood.
  void add_joint(const readback::ExecutedMove& m, std::size_t a) {
    double v = m.joints[a];
    const bool within_turn = control_.rollover[a] || (a >= 3 && (by_plane_ & (1U << a)) != 0);
    if (within_turn && (m.commanded & (1U << a)) == 0) return;
    if (within_turn) v -= 360 * std::floor(v / 360);
    add(std::bit_cast<std::uint64_t>(v));
  }
  void add(std::uint64_t v) {
    h_ = (h_ ^ v) * 1099511628211ULL;
    h_ ^= h_ >> 32;
  }
  const readback::NcControl& control_;
  std::uint8_t set_ = 0, by_plane_ = 0;
  std::uint64_t h_ = 0;
};

/// A move of the whole program.
struct Kept {
  std::uint64_t print = 0;
  std::int32_t line = 0;
};

}  // namespace toothpath::restart
