// A path that the gouge check has passed. Only the check can make one, and the posts accept nothing else.
#pragma once

#include <utility>

#include "cam/cl_path.h"

namespace toothpath {

class CheckedClPath {
 public:
  [[nodiscard]] const ClPath& path() const { return path_; }

 private:
  explicit CheckedClPath(ClPath path) : path_(std::move(path)) {}
  friend class GougeCheck;        // ball mills on face gears: cam/gouge_check.h
  friend class FingerGougeCheck;  // finger mills on bevel gears: cam/finger_check.h
  ClPath path_;
};

}  // namespace toothpath
