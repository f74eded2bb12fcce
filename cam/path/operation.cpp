#include "cam/path/operation.h"

namespace toothpath::path {

const char* to_string(OperationType type) {
  switch (type) {
    case OperationType::roughing: return "roughing";
    case OperationType::semi_finishing: return "semi_finishing";
    case OperationType::finishing: return "finishing";
    case OperationType::finger_roughing: return "finger_roughing";
    case OperationType::finger_finishing: return "finger_finishing";
  }
  return "";
}

}  // namespace toothpath::path
