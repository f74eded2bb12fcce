// Cutter location data: what the planners make, the gouge check proves and the posts print.
//
// A record is the tool tip and the unit tool axis (tip to holder) in the workpiece frame W (the gear frame), mm. All
// our cutters are bodies of revolution. A path holds the records of tooth space 0; the other spaces are turned copies.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::path {

/// How the tool arrives at a record from the one before it.
enum class MoveKind { rapid, engage, feed, retract };
[[nodiscard]] const char* to_string(MoveKind kind);

struct ClRecord {
  Vec3 tip = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  double feed_mm_min = 0;  ///< of the tip on the way to this record; 0 for a rapid
  MoveKind kind = MoveKind::rapid;
  int zone = 0;  ///< ring, from the inside, from 0
  int pass = 0;  ///< from 0 within the operation and zone
};

/// One operation on one tooth space. The first record is a rapid to a point outside the blank, above everything;
/// rapids link only such points. Between two zones the path is at such a point (not in a herringbone corner).
struct ClPath {
  int operation = 0;           ///< index in the job, from 0
  std::string operation_type;  ///< "roughing", "finishing", ... as in the job
  int tool = 0;                ///< index into the job's list of tools
  double spindle_rpm = 0;
  std::vector<ClRecord> records;
};

}  // namespace toothpath::path
