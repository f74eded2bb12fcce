// A tooth of a face gear where its pinion touches it: the line of contact, or the valley of least gap, and any other
// place of the flank against the pinion. Housing frame; mm, rad. Derivation: docs/loaded_contact.md 2.
#pragma once

#include <optional>

#include "geometry/loaded/contact_line.h"

namespace toothpath::loaded {

/// What ends the flanks next to a place.
enum class FlankEnd { involute, gear_tip, pinion_tip, face };

struct LinePlace {
  double theta = 0, B = 0, r = 0, R = 0, Z = 0;
  Vec3 point = Vec3::Zero(), nearest = Vec3::Zero();
  double inside = 0;              ///< mm to the nearest end, negative beyond it; off the regular sheet far below zero
  double beyond = 0;              ///< distance along the flank to the nearest material
  FlankEnd end = FlankEnd::face;  ///< the one that `inside` counts from
  bool regular = false;
  Vec3 normal = Vec3::Zero();
  double gap = 0, curvature = 0, roundness = 0;  ///< of the unloaded flanks; across the line; along it, to across
  Vec3 steepest = Vec3::Zero();  ///< direction in the tangent plane that bends by `curvature`; with a pinion of its own
};

/// A removal, and over how far to either side its curvature is taken: a strip presses on its own width, and curvatures
/// of reliefs may jump.
struct BentBy {
  const Removal* removal = nullptr;
  double reach_mm = 0;  ///< 0: as little as differences resolve
};

class LineOfTooth {
 public:
  /// @param phi  turn of the shaper that stands where the gear does, from this tooth's own
  /// @param pinion  null: the pinion is the shaper, the gap is 0
  /// @param bent_by  what is taken off the flanks; with a pinion
  LineOfTooth(const face_gear::FaceGearSurface<double>& f, int side, double phi, const ContactBounds& bounds,
              const contact::Pinion<double>* pinion, const BentBy& bent_by = {})
      : f_(f), side_(side), phi_(phi), bounds_(bounds), pinion_(pinion) {
    if (bent_by.removal != nullptr && *bent_by.removal) bent_by_ = bent_by;
  }

  /// The place of the line with this B.
  [[nodiscard]] LinePlace at(double B) const;
  /// Any place of the flank. @param theta > 0
  [[nodiscard]] LinePlace at(double theta, double B) const;
  /// Of the places of both flanks with this B the one of least gap; empty: there are none. Where the line misses the
  /// flanks it lies on an edge. With a pinion. @param theta  of a place near there on the flanks, to begin with;
  /// updated
  [[nodiscard]] std::optional<LinePlace> nearest(double B, double& theta) const;
  /// The normal of the flank that an edge stands over, out of the gear: the pinion's at an edge of the gear, the gear's
  /// at an edge of the pinion. With a pinion.
  [[nodiscard]] Vec3 normal_over_edge(const LinePlace& p) const;
  /// From the pinion's axis, at the section of the point.
  [[nodiscard]] Vec3 from_axis(const Vec3& point) const;
  [[nodiscard]] double section(const Vec3& point) const;
  /// Fills in the relative curvatures of a place.
  void bend(LinePlace& p) const;
  /// dP/dtheta and dP/dB of a place; with a pinion of its own.
  struct Moves {
    Vec3 theta, B;
  };
  [[nodiscard]] Moves moves(const LinePlace& p) const;
  /// The stretch of B on the flank; false: the line misses it.
  bool find(double& from, double& to) const;

 private:
  [[nodiscard]] Vec3 axis_of_pinion() const { return pinion_ != nullptr ? pinion_->a : f_.a(); }
  /// Of the unloaded flanks at a place of the gear while both stand where the ratio puts them.
  [[nodiscard]] double gap(double theta, double B) const;
  /// What the removal adds to the relative curvatures, in the directions e and l of the tangent plane.
  void bend_by_removal(const Vec3& point, const Vec3& e, const Vec3& l,
                       face_gear::FaceGearSurface<double>::ShapeOperator& H) const;
  /// theta of the least gap at this B, by Newton between bounds: the gap is nearly a parabola, or pieces of some.
  [[nodiscard]] double valley(double B, double start) const;
  [[nodiscard]] double end(double in, double out) const;

  const face_gear::FaceGearSurface<double>& f_;
  int side_;
  double phi_;
  const ContactBounds& bounds_;
  const contact::Pinion<double>* pinion_;
  BentBy bent_by_;
};

/// A place as a segment without length.
[[nodiscard]] Segment segment_of(const LineOfTooth& line, const LinePlace& place);

}  // namespace toothpath::loaded
