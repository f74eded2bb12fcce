#include "cam/path/cl_path.h"

namespace toothpath::path {

const char* to_string(MoveKind kind) {
  switch (kind) {
    case MoveKind::rapid: return "rapid";
    case MoveKind::engage: return "engage";
    case MoveKind::feed: return "feed";
    case MoveKind::retract: return "retract";
  }
  return "";
}

}  // namespace toothpath::path
