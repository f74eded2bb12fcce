#include "postproc/readback/teeth.h"

#include <algorithm>
#include <utility>

namespace toothpath::readback {
namespace {

constexpr std::size_t kContext = 2;  // moves ahead of a tooth: the corner at the end of the last one lies on both

/// Cuts the moves of a program into teeth.
class Teeth {
 public:
  Teeth(const ReadBack& read, const TraceSink& sink) : sink_(sink) {
    trace_.operation = -1;
    for (const OperationTrace& o : read.operations) tools_.emplace(o.operation, o.tool);
  }

  void add(const ExecutedMove& m) {
    const bool other_operation = m.operation != trace_.operation;
    // What stands ahead of the first tooth goes with it.
    const bool other_tooth = !other_operation && m.tooth != tooth_ && tooth_ >= 0;
    if (other_operation) {
      finish();
      begin(m.operation, {});
    } else if (other_tooth) {
      std::vector<ExecutedMove> ahead(trace_.moves.end() - std::ptrdiff_t(std::min(kContext, trace_.moves.size())),
                                      trace_.moves.end());
      trace_.moves.push_back(m);
      trace_.after = 1;
      finish();
      begin(m.operation, std::move(ahead));
    }
    tooth_ = m.tooth;
    trace_.moves.push_back(m);
  }
  void finish() {
    if (trace_.operation >= 0) sink_(std::move(trace_));
    trace_ = {};
    trace_.operation = -1;
  }

 private:
  void begin(int operation, std::vector<ExecutedMove> ahead) {
    trace_ = {};
    trace_.operation = operation;
    trace_.kept_teeth = 1;
    if (const auto tool = tools_.find(operation); tool != tools_.end()) trace_.tool = tool->second;
    trace_.before = ahead.size();
    trace_.moves = std::move(ahead);
    tooth_ = -1;
  }

  const TraceSink& sink_;
  std::map<int, int> tools_;
  OperationTrace trace_;
  int tooth_ = -1;
};

}  // namespace

Status walk_teeth(std::string_view text, const std::string& file, const NcControl& control, const ReadBack& read,
                  const TraceSink& sink) {
  Teeth teeth(read, sink);
  if (auto s = execute_nc(text, file, control, [&](const ExecutedMove& m) { teeth.add(m); }); !s) return s;
  teeth.finish();
  return Ok{};
}

}  // namespace toothpath::readback
