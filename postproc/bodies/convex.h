// Convex pieces of bodies and the distance between two of them, proven from below.
//
// Source: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, A fast procedure for computing the distance between complex
// objects in three-dimensional space, 1988. Every step gives a plane that separates the two by a known amount: that
// bound is what counts, so nothing rests on how well the descent ends.
#pragma once

#include <array>
#include <variant>

#include "geometry/base/vec.h"
#include "machines/links.h"

namespace toothpath::bodies {

struct Box {
  Vec3 centre = Vec3::Zero(), half = Vec3::Zero();  ///< edges along the axes of the body
};
/// Solid between two circles about an axis; as machines::ConeShape.
struct Cone {
  Vec3 from = Vec3::Zero(), axis = Vec3::UnitZ();  ///< unit
  double length = 0, radius_from = 0, radius_to = 0;
};
struct Triangle {
  std::array<Vec3, 3> corner;
};
using Convex = std::variant<Box, Cone, Triangle>;

/// The point of a piece farthest along `direction`, any length but 0.
[[nodiscard]] Vec3 farthest(const Convex& piece, const Vec3& direction);
/// A point of it.
[[nodiscard]] Vec3 middle(const Convex& piece);
/// Lowest and highest corner of its box.
[[nodiscard]] Box box_of(const Convex& piece);

struct Gap {
  double proven = 0;    ///< the true distance is not less
  double measured = 0;  ///< two points of theirs are so near, to rounding; infinite: none were looked at
};

/// Distance of two pieces, b standing at `place` in the frame of a; mm. Ends early where it is proven to be at least
/// `enough`. The two bounds differ by at most 1e-6 mm, or less than 1e-9 of the sizes, unless it ended early. Touching
/// or overlapping: 0, 0.
[[nodiscard]] Gap gap(const Convex& a, const Convex& b, const machines::Place& place, double enough);

}  // namespace toothpath::bodies
