// Travel of every axis over all teeth against the machine's limits, and the shift of the set-up that would fit.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/result.h"
#include "machines/machine.h"
#include "postproc/choice/travel_offer.h"
#include "postproc/joints/program.h"
#include "postproc/joints/setup.h"

namespace toothpath::joints {

/// Collects positions; joint moves are straight in the joints, so that ends are enough.
class TravelRecord {
 public:
  /// One end of a block. `moves_with_part`: false where Z stands at its own top, whatever the set-up.
  void note(const machines::Joints& joints, bool moves_with_part, int operation, int record, int tooth,
            const machines::KinematicChain& chain, const machines::LimitMargin& margin);

  /// Poses that move with the part go to `poses`, too.
  void collect(choice::TravelPoses* poses) { poses_ = poses; }

  [[nodiscard]] const std::array<double, 5>& least() const { return least_; }
  [[nodiscard]] const std::array<double, 5>& greatest() const { return greatest_; }
  [[nodiscard]] std::size_t violation_count() const { return count_; }
  [[nodiscard]] const std::vector<std::string>& first_violations() const { return first_; }
  /// Shift of the gear's origin along machine axis m with which all linear joints fit; empty: none does.
  [[nodiscard]] std::optional<double> shift_that_fits(int m) const;

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  std::array<double, 5> least_{kFar, kFar, kFar, kFar, kFar}, greatest_{-kFar, -kFar, -kFar, -kFar, -kFar};
  std::array<double, 3> shift_low_{-kFar, -kFar, -kFar}, shift_high_{kFar, kFar, kFar};
  std::size_t count_ = 0;
  bool rotary_outside_ = false;
  choice::TravelPoses* poses_ = nullptr;
  std::vector<std::string> first_;
};

/// Fills `program.ranges`; the error lists the first 20 violations, their number and the shifts along one axis that
/// would fit.
[[nodiscard]] std::optional<Diagnostic> check_travel(AxisProgram& program, const machines::Machine& machine,
                                                     const TravelRecord& record);

}  // namespace toothpath::joints
