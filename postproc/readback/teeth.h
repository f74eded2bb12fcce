// Teeth that are written out one behind the other, each behind its (TOOTH k) comment: a program that can be followed
// tooth by tooth, without the moves of all teeth in memory.
#pragma once

#include <cstddef>
#include <map>
#include <set>

#include "postproc/readback/reader.h"

namespace toothpath::readback {

/// Sees every move of a program, in order.
class NamedTeeth {
 public:
  void add(const ExecutedMove& m) {
    if (m.operation < 0) {
      if (last_ >= 0) good_ = false;
      return;
    }
    Operation& o = operations_[m.operation];
    if (m.operation != last_ && o.moves > 0) good_ = false;  // taken up again
    last_ = m.operation;
    ++o.moves;
    if (o.moves == 1) o.first_piece = m.piece;
    if (m.piece != o.piece) o.ahead = true;  // taken up with another tool
    o.piece = m.piece;
    if (m.tooth >= 0) o.ahead = false;
    if (m.tooth < 0) {
      if (!o.ahead || !m.rapid) good_ = false;
    } else if (m.tooth != o.tooth) {
      if (!o.teeth.insert(m.tooth).second) good_ = false;
      if (o.tooth < 0) o.first = m.tooth;
      o.tooth = m.tooth;
    }
    if (in_first(m)) ++first_;
    if (!m.rapid && o.tooth == o.first) o.cuts = true;
  }
  /// Every operation stands in one piece, and so does every tooth of it; all cuts are named, and the first tooth cuts.
  [[nodiscard]] bool one_by_one() const {
    bool cuts = !operations_.empty();
    for (const auto& [number, o] : operations_) cuts = cuts && o.cuts;
    return good_ && cuts;
  }
  /// Moves of the first teeth, and of what stands ahead of them in their operation.
  [[nodiscard]] std::size_t moves_of_first() const { return first_; }
  [[nodiscard]] bool in_first(const ExecutedMove& m) const {
    if (m.operation < 0) return true;
    const Operation& o = operations_.at(m.operation);
    return m.tooth < 0 ? m.piece == o.first_piece : m.tooth == o.first;
  }

 private:
  struct Operation {
    int first = -1, tooth = -1, first_piece = -1, piece = -1;
    bool ahead = true;  ///< of the first tooth of a piece
    std::size_t moves = 0;
    bool cuts = false;
    std::set<int> teeth;
  };
  std::map<int, Operation> operations_;
  int last_ = -1;
  std::size_t first_ = 0;
  bool good_ = true;
};

}  // namespace toothpath::readback
