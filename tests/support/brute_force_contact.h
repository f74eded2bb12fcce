// When do a pinion and a face gear touch? Two dense clouds of flank points, modified by the words where they are,
// turned until the first pair meets. No normals, no parallel-surface theorem, no closed-form turn of the pinion.
#pragma once

#include <vector>

#include "geometry/contact/pinion.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::test {

/// One flank of a pinion from the textbook involute and the words of its modifications, and where its axis stands.
class PinionByTheWords {
 public:
  PinionByTheWords(const face_gear::FaceGear& gear, int zone, int side, int teeth,
                   const contact::Misalignment& moved = {},
                   const std::vector<modification::Modification>& modifications = {});
  /// The pinion's axis a, down d and across b, and where Z = 0 is; gear frame at a turn of 0.
  struct Placed {
    Vec3 foot, a, d, b;
  };
  [[nodiscard]] const Placed& placed() const { return placed_; }
  [[nodiscard]] double r_b() const { return r_b_; }
  [[nodiscard]] double r_a() const { return r_a_; }
  /// The place whose plain one is on radius R > r_b and in section Z, at a turn of 0: (x along d, y along b, Z).
  [[nodiscard]] Vec3 own(double R, double Z) const;

 private:
  [[nodiscard]] Vec3 plain(double R, double Z) const;
  int side_, zone_;
  std::vector<modification::Modification> modifications_;
  double alpha_, r_b_, r_a_, twist_, L0_, space_, depth_, from_, to_;
  Placed placed_;
};

class BruteForceContact {
 public:
  BruteForceContact(const face_gear::FaceGear& gear, int zone, int side, int pinion_teeth,
                    const contact::Misalignment& moved = {},
                    const std::vector<modification::Modification>& on_pinion = {});

  /// Turn of the gear at which it lies on the pinion that has turned by phi_1: extreme over all points of both clouds
  /// and over the neighbouring teeth. Error about the sag of the clouds' meshes, 1e-7 rad.
  [[nodiscard]] double gear_turn(double phi_1) const;

 private:
  [[nodiscard]] double azimuth_at(double r, double z) const;  ///< NaN beside the flank

  int side_, pinion_teeth_;
  double r_in_, r_out_, z_low_, z_high_, pitch_;
  int columns_, rows_;
  std::vector<double> azimuth_, low_, top_;  ///< gear flank as columns of constant radius; ends of every column
  std::vector<Vec3> pinion_;                 ///< cloud at phi_1 = 0, about its axis: (x along d, y along b, Z)
  PinionByTheWords::Placed placed_;
};

}  // namespace toothpath::test
