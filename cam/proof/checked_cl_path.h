// A path that the gouge check has passed. Only the check can make one, and the posts accept nothing else.
#pragma once

#include <utility>

#include "cam/path/cl_path.h"

namespace toothpath::analytic {
class GougeCheck;
}  // namespace toothpath::analytic
namespace toothpath::finger {
class FingerGougeCheck;
}  // namespace toothpath::finger

namespace toothpath::proof {

class CheckedClPath {
 public:
  [[nodiscard]] const path::ClPath& path() const { return path_; }

 private:
  explicit CheckedClPath(path::ClPath path) : path_(std::move(path)) {}
  friend class analytic::GougeCheck;      // ball mills on face gears: cam/analytic/gouge_check.h
  friend class finger::FingerGougeCheck;  // finger mills on bevel gears: cam/finger/check.h
  path::ClPath path_;
};

}  // namespace toothpath::proof
