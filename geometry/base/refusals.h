// Gathers what is wrong with the numbers of a gear: refusals with their keys, each said once.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"

namespace toothpath {

/// The value next to `from`, on the way from there to `to`, that a test admits: of sixteen the first, then closer by
/// halving. Nothing where it admits none of them.
[[nodiscard]] std::optional<double> that_does(double from, double to, const std::function<bool(double)>& does);

/// Upwards to two digits, as a message says it. `value` is above 0.
[[nodiscard]] double told_upwards(double value);
/// Up from `from` in numbers of two digits, by `ratio` at a time: the first that a test admits. Where none below `most`
/// does, the first that is not below it.
[[nodiscard]] double told_that_does(double from, double ratio, double most, const std::function<bool(double)>& does);

class Refusals {
 public:
  std::vector<Refusal> refusals;

  [[nodiscard]] static std::string zone_key(std::size_t zone, const char* key) {
    return fmt::format("zone[{}].{}", zone, key);
  }

 protected:
  template <typename... Args>
  void refuse(std::string key, fmt::format_string<Args...> text, Args&&... args) {
    add({std::move(key), fail(text, std::forward<Args>(args)...)});
  }
  void add(Refusal refusal);
  /// low <= value <= high; anything else, also what is not a number, is refused. The text names the last word of the
  /// key.
  void range(const std::string& key, double value, double low, double high, const char* unit);
  void integer_range(const char* key, int value, int low, int high);
  /// A length above 0.
  void positive(const char* key, double value_mm);
  void not_negative(const char* key, double value_mm);
  /// One zone or two.
  void zone_count(std::size_t zones);
  void helix_angle(std::size_t zone, double helix_angle_rad);
};

}  // namespace toothpath
