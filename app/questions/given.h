// What the options of `toothpath new` say: the rest is asked for, or proposed.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/proposal/wishes.h"

namespace toothpath::questions {

/// Empty: not said.
struct Given {
  std::string gear, route, machine, tools, unit, file, name;
  std::string points, points_unit, root, tip;  ///< of a gear by points
  std::string rexs, left_flank, ratio_of_roll;
  std::string hand;  ///< of a spiral bevel gear by a drawing, of the inner half of a herringbone
  std::string coolant, material, accept_assumed;
  std::optional<int> component, iso_class;
  std::optional<double> tolerance_um, blank_top_mm;
  std::optional<double> dedendum, root_radius;
  std::vector<std::string> said;  ///< of tools: "12: stick_out = 40"
  std::array<std::optional<double>, proposal::kQuantities> numbers;
  std::array<std::optional<int>, proposal::kQuantities> whole;
};

inline constexpr toml::Range kComponent{0, 1e9};
inline constexpr toml::Range kRackCoefficient{0, 3};
inline constexpr toml::Range kBlankTop{0, 5000, " mm", true};
inline constexpr std::array<std::string_view, 2> kYesNo = {"yes", "no"};
inline constexpr std::array<std::string_view, 5> kCoolantWords = {"off", "mist", "flood", "air", "through_spindle"};
inline constexpr std::array<std::string_view, 2> kHandWords = {"left", "right"};
inline constexpr std::array<std::string_view, 2> kFlankWords = {"concave", "convex"};
inline constexpr std::array<std::string_view, 2> kRatioWords = {"work_per_cradle", "cradle_per_work"};

}  // namespace toothpath::questions
