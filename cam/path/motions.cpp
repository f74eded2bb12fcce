#include "cam/path/motions.h"

namespace toothpath::path {

std::vector<ToolMotion> motions_of(const ClPath& path) {
  std::vector<ToolMotion> out;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const ClRecord &a = path.records[k - 1], &b = path.records[k];
    ToolMotion m;
    m.tip_from = a.tip;
    m.tip_to = b.tip;
    m.axis_from = a.axis;
    m.axis_to = b.axis;
    m.rapid = b.kind == MoveKind::rapid;
    m.minutes = m.rapid || b.feed_mm_min <= 0 ? 0 : (b.tip - a.tip).norm() / b.feed_mm_min;
    m.operation = path.operation;
    m.line = static_cast<int>(k);
    out.push_back(m);
  }
  return out;
}

}  // namespace toothpath::path
