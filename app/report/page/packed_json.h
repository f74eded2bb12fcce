// Packed arrays as the page's script reads them.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "app/report/page/packed_data.h"
#include "geometry/base/vec.h"

namespace toothpath::page {

using Columns = std::vector<std::vector<double>>;

inline constexpr int kLineLow = 32768;  ///< large whole numbers travel as two below 2^16

[[nodiscard]] inline nlohmann::json packed_json(const PackedArray& packed) {
  return {{"count", packed.count},
          {"steps", packed.steps},
          {"low", packed.low},
          {"high", packed.high},
          {"data", packed.base64}};
}

[[nodiscard]] inline nlohmann::json pack_floats(const Columns& columns, int steps = kPackedSteps) {
  return packed_json(pack(columns, steps));
}

/// Whole numbers of a range below 65535, exactly: one step a unit.
[[nodiscard]] inline nlohmann::json pack_integers(const std::vector<double>& column) {
  const auto [low, high] = std::minmax_element(column.begin(), column.end());
  const double range = column.empty() ? 0 : *high - *low;
  return packed_json(pack(std::span(&column, 1), std::max(1, static_cast<int>(range))));
}

[[nodiscard]] inline Columns columns_of(const std::vector<Vec3>& points) {
  Columns columns(3);
  for (const Vec3& p : points)
    for (int c = 0; c < 3; ++c) columns[static_cast<std::size_t>(c)].push_back(p[c]);
  return columns;
}

}  // namespace toothpath::page
