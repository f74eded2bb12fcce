// The moves of one operation of an executed program: machine moves ahead of its first tooth, its teeth, machine moves
// behind the last.
#pragma once

#include <cstddef>

#include "postproc/readback/reader.h"

namespace toothpath::readback {

struct OperationMoves {
  std::size_t total = 0;
  std::size_t lead = 0;   ///< machine moves ahead of the first tooth
  std::size_t trail = 0;  ///< machine moves behind the last one
  bool started = false;   ///< a move of a tooth was met
  bool labelled = false;  ///< some move stands behind the comment of a tooth
  bool tcp = false;       ///< the move before kept the tip: a retract that ends that is the tooth's own

  /// The next move of the operation.
  void add(const ExecutedMove& m) {
    ++total;
    started = started || !m.machine;
    labelled = labelled || m.tooth >= 0;
    if (!started) ++lead;
    trail = started && m.machine && !tcp ? trail + 1 : 0;
    tcp = m.tcp;
  }
  [[nodiscard]] std::size_t teeth() const { return started ? total - lead - trail : 0; }
};

}  // namespace toothpath::readback
