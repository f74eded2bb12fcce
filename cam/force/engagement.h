// The part of a cutter's surface that is in the material while it feeds by a small step: for three kinds of cut, the
// same few numbers. Chips are thin: the surface that a tooth sweeps stands for its body. Lengths mm, angles rad.
//
// At a place whose normal has the share n_f along the feed the chip is f_z n_f thick. So a tooth that sweeps the area A
// takes off S f_z, S being the section of the cut across the feed, and the mean chip is f_z S/A whatever its form.
#pragma once

#include "cam/tool/profile.h"
#include "geometry/base/result.h"

namespace toothpath::force {

struct Engagement {
  double edge_mm = 0;      ///< longest piece of a meridian in the material: of an edge without helix
  double arc_mm = 0;       ///< longest way of a point of a tooth in the material
  double radius_mm = 0;    ///< of that way about the tool's axis, or of the ball
  double area_mm2 = 0;     ///< A, in the material in a position of the tool
  double section_mm2 = 0;  ///< S
  double steepest = 0;     ///< greatest n_f: the largest chip a feed per tooth
  double height_mm = 0;    ///< above the tip, where the normal of the middle of the cut meets the axis
  [[nodiscard]] double angle_rad() const { return arc_mm / radius_mm; }
};

/// The side of a mill along a line of a surface that keeps the stock q over it: engaged angle sqrt(2 q/R), mean chip
/// f_z sqrt(2 q/R)/2. @param from_mm, to_mm  ends of the line, heights above the tip; their middle gives R, the length
/// of the meridian's normal from the axis. Source: docs/force.md (5).
/// Refused: ends that are not in the cutting part, ascending; a middle that is no side; stock that is not above 0 and
/// below R.
[[nodiscard]] Result<Engagement> side_engagement(const tool::Profile& mill, double from_mm, double to_mm,
                                                 double stock_mm);
/// The same from plain numbers. Valid for 0 < stock < radius.
[[nodiscard]] Engagement side_engagement(double length_mm, double radius_mm, double height_mm, double stock_mm);

/// One of many passes of a ball of radius R over a surface with the stock q on it, the step w apart. Seen along the
/// normal the ball is in the material within rho = sqrt(2 R q) of its contact, in front of it and outside of what the
/// pass before it took, x^2 < w (w + 2 y): x along the feed, y away from that pass. Its section is w q
/// less the cusp that stays, w^3/(24 R); passes wider than 2 rho cut grooves. Error: of order q/R. The longest meridian
/// is taken across the feed, which holds on flanks. Refused: a stock not above 0 and below R; a step not above 0.
[[nodiscard]] Result<Engagement> ball_engagement(double radius_mm, double stock_mm, double step_mm);
/// Step between passes that leave cusps so high on a plane, 0 < scallop < R.
[[nodiscard]] double step_of_scallop(double radius_mm, double scallop_mm);

/// A mill of any profile, fed across its axis in full material up to a height: what the first pass of a layer does. A
/// flat end does not cut. Section and area are those of the profile.
/// Refused: a depth not above 0, or beyond the cutting part.
[[nodiscard]] Result<Engagement> slot_engagement(const tool::Profile& mill, double depth_mm);

}  // namespace toothpath::force
