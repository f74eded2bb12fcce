// A whole face gear: its rings of teeth, blank, groove and limits. The one object that planners and checks ask.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/face_gear/limits.h"
#include "geometry/face_gear/surface.h"

namespace toothpath::modification {
struct RingCorrection;
}  // namespace toothpath::modification
namespace toothpath::tooth_space {
struct ModifiedForm;
}  // namespace toothpath::tooth_space

namespace toothpath::face_gear {

struct RingModification;
class SpaceSheet;

/// One ring with everything precomputed.
struct FaceGearRing {
  FaceGearZone zone;
  FaceGearSurface<double> surface;
  ZoneLimits limits;
  std::shared_ptr<const RingModification> modification = nullptr;   ///< of the nominal flanks; none: plain
  std::shared_ptr<const tooth_space::ModifiedForm> form = nullptr;  ///< what it comes to; with a modification
  std::shared_ptr<const modification::RingCorrection> correction =
      nullptr;  ///< flanks to aim at instead of the nominal ones; none: the nominal
  /// Are the flanks to aim at other than the plain ones?
  [[nodiscard]] bool displaced() const { return modification != nullptr || correction != nullptr; }
  /// The ring of the drawing, without a correction.
  [[nodiscard]] FaceGearRing drawn() const {
    FaceGearRing ring = *this;
    ring.correction = nullptr;
    return ring;
  }
};

class FaceGear {
 public:
  /// Checks every limit of the gear. On failure returns all refusals.
  static Expected<FaceGear, std::vector<Refusal>> make(const FaceGearParameters& parameters);

  [[nodiscard]] const FaceGearParameters& parameters() const { return parameters_; }
  [[nodiscard]] const std::vector<FaceGearRing>& rings() const { return rings_; }
  [[nodiscard]] double pitch() const { return rings_.front().surface.pitch; }
  [[nodiscard]] double inner_radius() const { return rings_.front().zone.inner_radius_mm; }
  [[nodiscard]] double outer_radius() const { return rings_.back().zone.outer_radius_mm; }
  /// The tooth spaces of the drawing, modified flanks and all, without a correction: what meshes, inspection points and
  /// contact are made of.
  [[nodiscard]] const SpaceSheet& drawn(std::size_t zone) const { return *drawn_[zone]; }
  /// The same gear with other flanks to aim at, one correction a ring. Planners and checks then take the corrected
  /// flanks for the finished surface; limits, blank, meshes and inspection points stay those of the nominal gear.
  [[nodiscard]] FaceGear corrected(
      const std::vector<std::shared_ptr<const modification::RingCorrection>>& corrections) const;
  /// Highest point of the blank (tip surface plus stock), mm in z.
  [[nodiscard]] double blank_top() const;
  /// Does the uncut blank hold this place? One ring for each zone, up to the stock above its tips.
  [[nodiscard]] bool in_blank(const Vec3& p) const;
  /// Height z of the relief groove's floor; only with two zones. `groove_depth_mm` is measured from the tip surface of
  /// the inner ring at mid-groove; without it the floor lies 0.25 m below the lowest root between the two rings.
  [[nodiscard]] double groove_floor() const;
  /// Lowest point of the tooth spaces (root surface), over all rings.
  [[nodiscard]] double lowest_root() const;
  /// Soft findings that a report must show (involute start inside the face, land below 0.2 m, ...).
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  FaceGear() = default;
  FaceGearParameters parameters_;
  std::vector<FaceGearRing> rings_;
  std::vector<std::shared_ptr<const SpaceSheet>> drawn_;
  std::vector<std::string> warnings_;
};

}  // namespace toothpath::face_gear
