#include "cam/path/operation.h"

namespace toothpath::path {

const char* to_string(Region region) {
  switch (region) {
    case Region::flank: return "flank";
    case Region::fillet: return "fillet";
    case Region::root: return "root";
  }
  return "";
}

const char* to_string(OperationType type) {
  switch (type) {
    case OperationType::roughing: return "roughing";
    case OperationType::semi_finishing: return "semi_finishing";
    case OperationType::finishing: return "finishing";
    case OperationType::line_milling: return "line_milling";
    case OperationType::finger_roughing: return "finger_roughing";
    case OperationType::finger_finishing: return "finger_finishing";
  }
  return "";
}

}  // namespace toothpath::path
