// FGROUP and FGREF of Siemens: the axes whose travel is the path, and the radius at which the turns of a rotary count.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "geometry/base/angle.h"
#include "postproc/readback/scanner.h"

namespace toothpath::controls {

class NcPathGroup {
 public:
  /// @param letters of the axes X Y Z and of the rotaries; 0: none
  explicit NcPathGroup(const std::array<char, 5>& letters) : letters_(letters) {}

  /// Behind FGROUP: (X,Y,Z) names the axes, () those of the machine data. @returns what is wrong; empty: nothing
  std::string group(readback::NcScanner& s) {
    if (!s.take("(")) return "( expected";
    named_.fill(false);
    while (!s.take(")")) {
      if (any() && !s.take(",")) return ", or ) expected";
      const auto a = axis(s);
      if (!a || named_[*a]) return "FGROUP names every axis of the machine once at most";
      named_[*a] = true;
    }
    return {};
  }
  /// Behind FGREF: [C]= and then the radius, which the caller reads. @returns the rotary; nothing: another text stands
  /// there
  std::optional<std::size_t> rotary(readback::NcScanner& s) const {
    const auto a = s.take("[") ? axis(s) : std::nullopt;
    return a && *a >= 3 && s.take("]=") ? a : std::nullopt;
  }
  void set_radius(std::size_t rotary, double mm) { radius_[rotary - 3] = mm; }

  /// mm of path for each mm or degree of an axis; nothing: what the machine data say.
  [[nodiscard]] std::optional<std::array<double, 5>> weights() const {
    if (!any()) return std::nullopt;
    std::array<double, 5> w{};
    for (std::size_t a = 0; a < 5; ++a) w[a] = !named_[a] ? 0 : a < 3 ? 1 : radians(radius_[a - 3]);
    return w;
  }

 private:
  [[nodiscard]] bool any() const { return std::find(named_.begin(), named_.end(), true) != named_.end(); }
  std::optional<std::size_t> axis(readback::NcScanner& s) const {
    for (std::size_t a = 0; a < 5; ++a)
      if (letters_[a] != 0 && s.at() == letters_[a]) return s.advance(1), a;
    return std::nullopt;
  }

  std::array<char, 5> letters_;
  std::array<bool, 5> named_{};
  std::array<double, 2> radius_ = {degrees(1), degrees(1)};  // as the control begins: 1 mm for 1 deg
};

}  // namespace toothpath::controls
