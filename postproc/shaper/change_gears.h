// Change gears of a gear shaper: trains of two or four wheels from the wheels that the machine has.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machines/shaper_machine.h"

namespace toothpath::shaper {

/// In lowest terms. Precondition: denominator > 0, numerator >= 0.
[[nodiscard]] machines::Ratio reduced(machines::Ratio ratio);

/// The wheels on the shelf. A number that stands twice means two wheels.
struct WheelSet {
  std::vector<int> teeth;
  int mesh_margin = 0;  ///< four wheels fit if a + b >= c + margin and c + d >= b + margin
};

/// Wheels a, b or a, b, c, d; the train's ratio is a/b or a/b * c/d. Empty: no train.
struct GearTrain {
  std::vector<int> wheels;
  [[nodiscard]] machines::Ratio ratio() const;  ///< in lowest terms
  [[nodiscard]] std::string text() const;       ///< "30/44" or "25/55 * 60/40"
};

/// Does the train consist of wheels of the set, each used no more often than it is there, and does it mesh?
[[nodiscard]] bool train_fits(const WheelSet& set, const GearTrain& train);

/// A train whose ratio equals the target exactly, in whole numbers. Of several: two wheels before four, then the
/// smallest sum of teeth, then the smallest a, b, c in turn. Nothing if there is none.
[[nodiscard]] std::optional<GearTrain> exact_train(const WheelSet& set, machines::Ratio target);

/// The train nearest to the target (smallest absolute difference); ties as above. Nothing with fewer than two wheels.
[[nodiscard]] std::optional<GearTrain> nearest_train(const WheelSet& set, double target);

/// The set without the wheels of a train: what is left for the next train.
[[nodiscard]] WheelSet without(const WheelSet& set, const GearTrain& train);

}  // namespace toothpath::shaper
