// A STEP file as text: ISO 10303-21 (clear text encoding), schema AUTOMOTIVE_DESIGN of ISO 10303-214. Instances get
// their numbers in the order in which they are written. Lengths in mm, to 1e-7 mm.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::exchange {

/// Number of an instance.
using StepId = int;

class StepText {
 public:
  /// `#n=TEXT;`, TEXT as formatted.
  template <typename... Args>
  StepId add(fmt::format_string<Args...> text, Args&&... args) {
    fmt::format_to(std::back_inserter(body_), "#{}=", ++last_);
    fmt::format_to(std::back_inserter(body_), text, std::forward<Args>(args)...);
    body_ += ";\n";
    return last_;
  }
  StepId point(const Vec3& p);
  StepId direction(const Vec3& d);
  /// AXIS2_PLACEMENT_3D. @param x  any direction across the axis
  StepId placement(const Vec3& origin, const Vec3& axis, const Vec3& x);
  StepId vertex(const Vec3& p) { return add("VERTEX_POINT('',#{})", point(p)); }

  /// The instances as a whole file. @param name  of the file in its header
  [[nodiscard]] std::string file(std::string_view name, std::string_view program) const;

 private:
  std::string body_;
  StepId last_ = 0;
};

/// A list of references: `(#1,#2)`.
[[nodiscard]] std::string references(std::span<const StepId> ids);
/// A real number of the format: it has a point.
[[nodiscard]] std::string real(double value);
/// A string of the format: quoted, quotes doubled, what is not printable ASCII as \X\hh.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace toothpath::exchange
