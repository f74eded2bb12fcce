// The links of a machine, one behind the other from the work to the tool, and where the joints between them put them.
//
// Link 0 carries the work, the last one the spindle; joint k stands between the links k and k + 1. The bed is the link
// that stands still. Which linear axes lie on the side of the work moves no tool over the work, but it moves bodies.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "machines/kinematic_chain.h"

namespace toothpath::machines {

struct Joint {
  char letter = 'X';
  bool rotary = false;
  std::size_t axis = 0;  ///< of X Y Z, or the number of the rotary in KinematicChain::rotary()
};

/// Where a rigid body stands: p becomes turn p + shift.
struct Place {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
  [[nodiscard]] Vec3 of(const Vec3& p) const { return turn * p + shift; }
};

class Links {
 public:
  /// The chain must outlive it.
  explicit Links(const KinematicChain& chain);

  [[nodiscard]] std::size_t count() const { return joints_.size() + 1; }
  [[nodiscard]] std::size_t bed() const { return bed_; }
  [[nodiscard]] const std::vector<Joint>& joints() const { return joints_; }
  [[nodiscard]] const KinematicChain& chain() const { return chain_; }
  /// "bed", "spindle", "table" (the link of the work), or the letter of the axis that moves the link against the one
  /// nearer to the bed. Empty: none.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// All that find() knows.
  [[nodiscard]] std::vector<std::string> names() const;
  /// A place of joint k with all joints at zero: a point on the axis of a rotary, and its direction or that of the
  /// linear axis.
  [[nodiscard]] Vec3 point(std::size_t joint) const;
  [[nodiscard]] Vec3 direction(std::size_t joint) const;
  /// Of every link, against the bed.
  [[nodiscard]] std::vector<Place> places(const Joints& joints) const;

 private:
  const KinematicChain& chain_;
  std::vector<Joint> joints_;
  std::size_t bed_ = 0;
};

}  // namespace toothpath::machines
