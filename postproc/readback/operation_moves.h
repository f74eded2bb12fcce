// The moves of one operation of an executed program: machine moves ahead of its first tooth, its teeth, machine moves
// behind the last. An operation that changes its tool between teeth is taken up again: it has several pieces.
#pragma once

#include <cstddef>
#include <vector>

#include "postproc/readback/reader.h"

namespace toothpath::readback {

struct OperationMoves {
  struct Piece {
    std::size_t first = 0;  ///< its first move, among those of the operation
    std::size_t total = 0;
    std::size_t lead = 0;   ///< machine moves ahead of its first tooth
    std::size_t trail = 0;  ///< machine moves behind its last one
    bool started = false;   ///< a move of a tooth was met

    [[nodiscard]] std::size_t teeth() const { return started ? total - lead - trail : 0; }
    [[nodiscard]] std::size_t begin() const { return first + lead; }
    [[nodiscard]] std::size_t end() const { return first + total - trail; }
  };
  std::size_t total = 0;
  bool started = false;   ///< a move of a tooth was met
  bool labelled = false;  ///< some move stands behind the comment of a tooth
  std::vector<Piece> pieces;
  bool tcp = false;  ///< the move before kept the tip: a retract that ends that is the tooth's own

  /// The next move of the operation.
  void add(const ExecutedMove& m) {
    if (pieces.empty() || m.piece != last_) {
      pieces.emplace_back();
      pieces.back().first = total;
    }
    last_ = m.piece;
    Piece& p = pieces.back();
    ++total;
    ++p.total;
    started = started || !m.machine;
    p.started = p.started || !m.machine;
    labelled = labelled || m.tooth >= 0;
    if (!p.started) ++p.lead;
    p.trail = p.started && m.machine && !tcp ? p.trail + 1 : 0;
    tcp = m.tcp;
  }
  [[nodiscard]] std::size_t lead() const { return pieces.empty() ? 0 : pieces.front().lead; }
  [[nodiscard]] std::size_t trail() const { return pieces.empty() ? 0 : pieces.back().trail; }
  [[nodiscard]] std::size_t teeth() const {
    std::size_t sum = 0;
    for (const Piece& p : pieces) sum += p.teeth();
    return sum;
  }

 private:
  int last_ = 0;
};

}  // namespace toothpath::readback
