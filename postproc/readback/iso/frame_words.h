// Words that say where words count from: work offsets, G52 of rotaries, G10 L2, tilted planes; and the parameters that
// hold work offsets.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "postproc/readback/execution.h"
#include "postproc/readback/iso/flow.h"
#include "postproc/readback/iso/language.h"
#include "postproc/readback/iso/words.h"

namespace toothpath::iso {

class FrameWords {
 public:
  /// Tells the parameters of the work offsets. All must outlive it.
  FrameWords(const readback::NcControl& control, const IsoLanguage& language, NcFlow& flow,
             readback::NcExecution& execution);

  using Problem = std::optional<Diagnostic>;
  /// The work offset of the block, if it has one.
  [[nodiscard]] Problem select(const Request& r);
  /// G52 in a block of its own; all axes named as zero: nothing is left of an earlier one.
  [[nodiscard]] Problem zeros(const Request& r);
  /// A block with G52 that names all axes, and all of them as zero.
  [[nodiscard]] bool clears_zeros(const Request& r) const;
  /// G10 L2 P: where the work offset that the machine file leaves to programs is, and how it is turned.
  [[nodiscard]] Problem write_offset(const Request& r);
  /// G68.2 X Y Z I J K: the origin, seen from the work offset, and Euler's angles about Z, the new X and the new Z.
  /// G53.1 P1: the rotaries turn to it, the one that tilts not below its zero; P2 not above.
  [[nodiscard]] Problem tilt(const Request& r);
  /// Ahead of a move: has the program looked at what is taken as 0 of the work offset of the shop, its turn and the
  /// zeros of its rotaries?
  void look();

 private:
  [[nodiscard]] Diagnostic here(int column, std::string message) const {
    return flow_.here(column, std::move(message));
  }
  void tell_offset(const std::string& name, const std::optional<Vec3>& at_mm, double turn_deg);

  const readback::NcControl& control_;
  const IsoLanguage& language_;
  NcFlow& flow_;
  readback::NcExecution& execution_;
  int shop_offset_ = -1;               // number of the work offset of the shop that was selected last
  std::optional<std::size_t> looked_;  // parameters that were seen to be 0 when it was looked at
};

}  // namespace toothpath::iso
