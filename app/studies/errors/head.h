// The head of `study machine-errors`: what all its samples share, as it stands in the first line of their files.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/errors/error_list.h"
#include "app/studies/errors/real_flanks.h"

namespace toothpath::errors {

inline constexpr const char* kStudy = "machine-errors";
inline constexpr int kVersion = 1;  ///< of what a sample means: another one, other samples
inline constexpr const char* kAll = "all together";

/// Sample k is of row k mod (errors + 1): of each error alone, last of all together.
[[nodiscard]] inline std::optional<std::size_t> error_of_sample(int sample, std::size_t errors) {
  const auto row = std::size_t(sample) % (errors + 1);
  return row < errors ? std::optional(row) : std::nullopt;
}

[[nodiscard]] inline nlohmann::ordered_json json_of(const Cost& cost) {
  return {{"shift_um", cost.shift_um}, {"rms_um", cost.rms_um},     {"deepest_um", cost.deepest_um},
          {"left_um", cost.left_um},   {"gouge_um", cost.gouge_um}, {"gouge_bound_um", cost.gouge_bound_um},
          {"within", cost.within}};
}

[[nodiscard]] inline nlohmann::ordered_json json_of(const std::vector<Error>& errors) {
  auto out = nlohmann::ordered_json::array();
  for (const Error& e : errors)
    out.push_back(
        {{"error", e.name}, {"size", e.size}, {"unit", e.unit}, {"source", e.source}, {"meaning", e.meaning}});
  return out;
}

}  // namespace toothpath::errors
