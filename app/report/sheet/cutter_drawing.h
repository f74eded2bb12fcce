// Drawings of a finger mill's axial section for the tool grinder: SVG to scale and DXF.
//
// Drawing frame: origin at the tip, X along the axis towards the shank, Y the radius. mm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/bevel_gear/finger_cutter_design.h"

namespace toothpath::sheet {

/// The contour as DXF text (R12 ASCII, AC1009), scale 1:1 in mm: flat and straight as LINE, corners as ARC, involutes
/// as open POLYLINE of vertices on the curve, cylinder up to `length_mm`, axis on a layer of its own, notes as comments
/// and TEXT.
struct CutterDxf {
  std::string text;
  double chord_error_mm =
      0;             ///< largest distance of a polyline's chord from the involute, measured between the vertices
  int vertices = 0;  ///< of one involute
};
/// @param chord_mm  allowed chord error of the polyline; its chords run outside the hollow flank, so the mill gets
/// thicker by it
[[nodiscard]] CutterDxf cutter_dxf(const bevel_gear::FingerProfile<double>& profile, double length_mm,
                                   const std::vector<std::string>& notes, double chord_mm = 2e-4);

/// Ratio of the SVG drawing: the largest of 200, 100, 50, 20, 10, 5, 2, 1, 1/2, 1/5 ... that fits width_mm x height_mm.
[[nodiscard]] double cutter_drawing_scale(const bevel_gear::FingerProfile<double>& profile, double length_mm,
                                          double width_mm, double height_mm);

/// One <svg> with sizes in mm, printable to scale without browser scaling: contour, axis, pitch line, points A to D
/// with their numbers, a scale bar. `compared`: another mill in the same frame, dashed, its pitch line on the same
/// place.
/// @param standalone  with namespace and white ground, for a file of its own
[[nodiscard]] std::string cutter_svg(const bevel_gear::FingerProfile<double>& profile, double length_mm, double scale,
                                     const std::optional<bevel_gear::FingerProfile<double>>& compared, bool standalone);

}  // namespace toothpath::sheet
