// What the strokes of a shaper leave: every stroke is a straight sweep of the cutter's own profile through the work.
// Rigid-body motion and the involute only; no equation of meshing.
#pragma once

#include <optional>
#include <vector>

#include "geometry/face_gear/surface.h"

namespace toothpath::shaper {

struct ShaperSetup;

/// One cutting stroke: the edge goes straight along the cutter axis while cutter and work turn evenly.
struct ShaperStroke {
  double x_mm = 0;                        ///< lift of the cutter axis away from the work
  double z_from_mm = 0, z_to_mm = 0;      ///< place of the edge along the cutter axis
  double cutter_from = 0, cutter_to = 0;  ///< turn of the cutter about a, rad
  double work_from = 0, work_to = 0;      ///< turn of the work about z, rad
};

/// Signed distance of a point of the cutter's transverse plane to the cutter's solid at zero turn, mm, positive
/// outside. Exact on the involute, the tip rounding and the tip circle; inside the base circle the tooth is bounded by
/// radial lines.
/// @param x, y  along d and b from the cutter axis
[[nodiscard]] double cutter_distance(const face_gear::InvoluteShaper<double>& cutter, double x, double y);

/// The stroke's view of a work-fixed point: the cutter's distance to it at the moment when the edge passes its section.
/// Nothing if the edge does not reach the section.
[[nodiscard]] std::optional<double> stroke_distance(const face_gear::FaceGearSurface<double>& gear,
                                                    const ShaperStroke& stroke, const Vec3& point);

/// Least distance over strokes: > 0 material stays around the point, < 0 the point is cut away. +infinity if no stroke
/// comes near.
[[nodiscard]] double swept_distance(const face_gear::FaceGearSurface<double>& gear,
                                    const std::vector<ShaperStroke>& strokes, const Vec3& point);

/// The same for an endless generating motion at full depth (infinitely fine feed): minimum over the roll angle.
[[nodiscard]] double generated_distance(const face_gear::FaceGearSurface<double>& gear, const Vec3& point);

/// Sample points of both flanks of a tooth between fillet line and tip surface, rows along the height, columns along
/// the radius.
struct FlankSample {
  int side = 1;
  double theta = 0, B = 0;
  Vec3 point, normal;
};
[[nodiscard]] std::vector<FlankSample> flank_samples(const face_gear::FaceGearSurface<double>& gear,
                                                     double inner_radius, double outer_radius, int rows, int columns,
                                                     int tooth = 0);

/// Deviation of the cut flanks from the exact ones, um; positive is material left.
struct ShapedDeviation {
  double max_left_um = 0, rms_um = 0, deepest_um = 0;  ///< deepest: the least value, negative is a gouge
  std::size_t points = 0;
};
[[nodiscard]] ShapedDeviation shaped_deviation(const face_gear::FaceGearSurface<double>& gear,
                                               const std::vector<ShaperStroke>& strokes,
                                               const std::vector<FlankSample>& samples);

/// The strokes of the program, from the same whole numbers (angles not rounded to NC words).
/// @param first, last  double strokes, counted from 1
[[nodiscard]] std::vector<ShaperStroke> planned_strokes(const ShaperSetup& setup, int first, int last);

/// Error against cutting time for one circular feed.
struct FeedStudyRow {
  double circular_feed_mm = 0;
  double minutes = 0;  ///< infeed and one full turn
  ShapedDeviation deviation;
};
/// Strokes at the set-up's strokes per minute with other circular feeds; one tooth, both flanks, the conjugate ones of
/// 9 x 13 places each: the largest is that of these places.
[[nodiscard]] std::vector<FeedStudyRow> feed_study(const ShaperSetup& setup, const std::vector<double>& feeds_mm);

/// Least distances of the cutter's profile, lifted by `relief_mm` at the end of a stroke in the middle of the turn at
/// full depth: from the finished teeth, and from all material that earlier strokes have left (the next chips included).
/// Negative: it rubs.
struct BackStrokeClearance {
  double flank_mm = 0, stock_mm = 0;
};
/// Sampled on profile points of the teeth in engagement at the outer and the inner edge of the face.
[[nodiscard]] BackStrokeClearance back_stroke_clearance(const ShaperSetup& setup, double relief_mm);

/// Arcs on the tip surface at radius r if the work makes a full turn with the cutter lifted by x: tooth and space.
/// Nothing where no tooth stands or no space is cut.
struct TipArcs {
  double tooth_mm = 0, space_mm = 0;
};
[[nodiscard]] std::optional<TipArcs> tip_arcs_at_depth(const face_gear::FaceGearSurface<double>& gear, double r,
                                                       double x);

}  // namespace toothpath::shaper
