// R parameters and the whole variables of DEF INT: names, values, and what may be set.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "postproc/readback/scanner.h"

namespace toothpath::controls {

class SiemensVariables {
 public:
  /// Behind "DEF INT ": the names, parted by commas. @returns what is wrong; empty: they are known from here on
  std::string define(readback::NcScanner& s) {
    do {
      s.skip_blanks();
      const std::string name = identifier(s.rest());
      if (name.size() < 2 || name.size() > kLongestName || !readback::NcScanner::is_letter(name[0]) ||
          !readback::NcScanner::is_letter(name[1]))
        return "DEF INT needs names of 2 to 31 characters that begin with two letters";
      if (std::find(names_.begin(), names_.end(), name) != names_.end())
        return "variable " + name + " is defined twice";
      s.advance(name.size());
      names_.push_back(name);
      s.skip_blanks();
    } while (s.take(","));
    return s.done() ? std::string() : "words behind the names of DEF INT";
  }

  /// A variable that stands here, taken. Nothing: none does, and nothing is taken.
  std::optional<int> take(readback::NcScanner& s) const {
    const auto [id, length] = here(s);
    if (id < 0) return std::nullopt;
    s.advance(length);
    return id;
  }
  [[nodiscard]] bool stands(const readback::NcScanner& s) const { return here(s).id >= 0; }

  /// Null: it was never set.
  [[nodiscard]] const double* value(int id) const {
    const auto found = values_.find(id);
    return found == values_.end() ? nullptr : &found->second;
  }
  /// @returns what is wrong; empty: it is set
  std::string set(int id, double value) {
    if (id >= kNames && value != std::round(value))
      return names_[static_cast<std::size_t>(id - kNames)] + " is INT and takes whole numbers alone";
    values_[id] = value;
    return {};
  }

 private:
  struct Found {
    int id = -1;
    std::size_t length = 0;
  };
  static constexpr int kNames = 1000;  // R parameters are below
  static constexpr std::size_t kLongestName = 31;

  static std::string identifier(std::string_view text) {
    std::size_t n = 0;
    while (n < text.size() && (readback::NcScanner::is_letter(text[n]) || readback::NcScanner::is_digit(text[n]))) ++n;
    return std::string(text.substr(0, n));
  }
  [[nodiscard]] Found here(const readback::NcScanner& s) const {
    const std::string_view rest = s.rest();
    if (s.at() == 'R' && readback::NcScanner::is_digit(s.ahead())) {
      int n = 0;
      const auto r = std::from_chars(rest.data() + 1, rest.data() + rest.size(), n);
      if (r.ec != std::errc{} || n >= kNames) return {};
      return {n, static_cast<std::size_t>(r.ptr - rest.data())};
    }
    if (names_.empty() || !readback::NcScanner::is_letter(s.ahead())) return {};
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (rest.starts_with(names_[k]) && identifier(rest).size() == names_[k].size())
        return {kNames + static_cast<int>(k), names_[k].size()};
    return {};
  }

  std::vector<std::string> names_;
  std::unordered_map<int, double> values_;
};

}  // namespace toothpath::controls
