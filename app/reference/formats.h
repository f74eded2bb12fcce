// The formats of this program's files with all their keys, and what each key means.
#pragma once

#include <span>
#include <string>

#include "app/reference/survey.h"

namespace toothpath::reference {

/// One sentence. The key is dotted; a `*` stands for any one part of it.
struct Meaning {
  const char* key;
  const char* text;
};

struct Format {
  Ask ask;
  Reference reference;
  std::span<const Meaning> meanings;

  /// Of a key or a table; empty: nobody wrote one.
  [[nodiscard]] std::string meaning(const std::string& key) const;
};

[[nodiscard]] Format job_format(int most_others = kMostOthers);
/// Machine files of `kind = "five_axis"`.
[[nodiscard]] Format milling_machine_format();
/// Machine files of `kind = "gear_shaper"`.
[[nodiscard]] Format gear_shaper_format();

[[nodiscard]] std::span<const Meaning> job_meanings();
[[nodiscard]] std::span<const Meaning> machine_meanings();
/// Does the key of a meaning stand for this one?
[[nodiscard]] bool stands_for(std::string_view pattern, std::string_view key);

}  // namespace toothpath::reference
