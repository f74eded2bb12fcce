// The tools from which a job is made: those of standard sizes, or those that somebody has.
#pragma once

#include <vector>

#include "cam/tool/assembly.h"

namespace toothpath::proposal {

/// Tools as far as they are known: a length that is 0, or a holder that is empty, is not. Numbers are given when they
/// are chosen.
using Shelf = std::vector<tool::ToolAssembly>;

/// Ball mills and tapered ball mills of standard sizes for tooth spaces of this depth [mm]: carbide with the least
/// flute and stick-out that clear the teeth, in a slim collet chuck.
[[nodiscard]] Shelf standard_shelf(double depth_mm);

/// The tool with what is not known of it taken from the standard tool of its kind and size.
[[nodiscard]] tool::ToolAssembly completed(const tool::ToolAssembly& tool, double depth_mm);

/// Least length of flutes and least stick-out for tooth spaces of this depth, mm.
[[nodiscard]] double least_flute_mm(double depth_mm);
[[nodiscard]] double least_stick_out_mm(double depth_mm);

/// Does it come down to the root of tooth spaces of this depth [mm]: by its flutes, or as a ball mill that is above
/// them no thicker than its ball, and cuts with that?
[[nodiscard]] bool reaches_root(const tool::ToolAssembly& tool, double depth_mm);

/// The largest tool of a kind that is no wider than this [mm] and reaches the root; nullptr: none.
/// @param skip  so many larger ones that would fit are passed over
[[nodiscard]] const tool::ToolAssembly* largest(const Shelf& shelf, tool::CutterType type, double most_mm,
                                                double depth_mm, int skip = 0);

/// Speed and feed at which a tool cuts on a spindle of this speed.
struct Cutting {
  double speed_rpm = 0, feed_mm_min = 0;
};
[[nodiscard]] Cutting cutting_of(double diameter_mm, int teeth, double spindle_rpm, double most_feed_mm_min);

}  // namespace toothpath::proposal
