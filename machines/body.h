// Simple bodies that a machine file states: table, cradle, head, column. They stand where they stand with every joint
// at its zero: linear axes at 0, the gauge point in the origin of machine coordinates, rotaries at their zeros.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::machines {

/// Edges along the machine axes; mm.
struct BoxShape {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// A solid of revolution between two circles, mm; a cylinder where their radii are equal. The circles are apart, the
/// radii not negative, and one at least above 0.
struct ConeShape {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< centres of the circles
  double radius_from = 0, radius_to = 0;
};

/// A closed mesh in a file, mm.
struct MeshShape {
  std::string file;  ///< beside the machine file, or an absolute path: as it is opened
};

struct MachineBody {
  std::string name;
  std::size_t link = 0;  ///< that carries it: an index of `Links`
  std::variant<BoxShape, ConeShape, MeshShape> shape;
  std::vector<std::string> touches;  ///< names of bodies that it bears on: no collision
  std::string key;                   ///< its table in the file, "body[0]": for Machine::where
};

/// Most bodies of a machine file.
inline constexpr std::size_t kMostBodies = 64;

}  // namespace toothpath::machines
