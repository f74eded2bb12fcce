// How far a text lets the control leave the corners of the path, and the words that say so: the writer's side. What a
// reader finds in the text it counts by itself (postproc/readback/motion.cpp).
#pragma once

#include "postproc/text/writer.h"

namespace toothpath::text {

/// What {blend} stands for in a program.
struct CornerWords {
  double blend_mm = 0;     ///< a distance from the path, or the way ahead of and behind a corner
  double granted_mm = 0;   ///< the tip leaves the corners by no more
  double axis_deg = 0;     ///< what {blend_axis} stands for
  double granted_rad = 0;  ///< the tool axis leaves its blend by no more; 0 where it follows from the tip's own words
  bool group = false;      ///< the axes of the path are named
  double radius_mm = 0;    ///< with it: of every rotary
  bool wide = false;       ///< of an operation whose corners a later one takes
  bool contour = false;    ///< by the lines `contour_on`
};

/// @param op  the words of one operation; null: those of the program, which hold where an operation has none of its own
[[nodiscard]] CornerWords corner_words(const joints::AxisProgram& program, const NcDialect& dialect,
                                       const NcHeader& header, const joints::AxisOperation* op = nullptr);

}  // namespace toothpath::text
