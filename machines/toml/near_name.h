// What a misspelt name was meant to be.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace toothpath::toml {

/// Number of insertions, deletions and replacements of letters that turn a into b.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `name`, at most two letters from it and with more letters than that; the first of several;
/// empty: none, or a name of more than 60 letters. The view is into `known`, whose elements are strings.
template <typename Names>
[[nodiscard]] std::string_view near_name(std::string_view name, const Names& known) {
  constexpr std::size_t kLongest = 60, kMostLetters = 2;
  std::string_view best;
  if (name.size() > kLongest) return best;
  std::size_t nearest = kMostLetters + 1;
  for (const std::string_view candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance >= nearest || distance >= candidate.size()) continue;
    nearest = distance;
    best = candidate;
  }
  return best;
}

/// What a message says of it: "; did you mean "run"?"; empty: nothing is near.
template <typename Names>
[[nodiscard]] std::string did_you_mean(std::string_view name, const Names& known) {
  const std::string_view near = near_name(name, known);
  return near.empty() ? std::string() : "; did you mean \"" + std::string(near) + "\"?";
}

}  // namespace toothpath::toml
