// Attributes of one component as numbers. All that is wrong is collected.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/rexs/rexs_file.h"
#include "machines/toml/key_notes.h"

namespace toothpath::rexs {

inline constexpr toml::Range kLength = toml::Range::positive(10000, " mm");

/// Units of the schema that gears need.
enum class Unit { none, mm, deg };

/// Gathers refusals over the components of one gear.
class Refused {
 public:
  template <typename... Args>
  void add(const SourcePosition& at, fmt::format_string<Args...> text, Args&&... args) {
    errors.push_back(fail_at(at, text, std::forward<Args>(args)...));
  }
  std::vector<Diagnostic> errors;
};

class Quantities {
 public:
  Quantities(const Component& component, Refused& refused) : component_(component), refused_(refused) {}
  [[nodiscard]] const Component& component() const { return component_; }

  // Refused: what is no finite number, another unit than that of the schema, what is outside the range. Degrees stay
  // degrees.
  [[nodiscard]] std::optional<double> optional(const char* id, Unit unit, const toml::Range& range) const;
  /// Refused as well where it is missing.
  [[nodiscard]] double number(const char* id, Unit unit, const toml::Range& range) const;
  /// Refused as well where it is no whole number.
  [[nodiscard]] int whole(const char* id, const toml::Range& range) const;
  [[nodiscard]] std::optional<std::string> word(const char* id) const;
  [[nodiscard]] std::vector<double> list(const char* id) const;
  /// What the gear types do not know must be 0 or absent: a number or all of an array.
  void must_be_zero(const char* id, const char* why) const;
  /// @param what  that would do
  void missing(const char* id, const char* what = "") const;

 private:
  [[nodiscard]] std::optional<double> number_of(const Attribute& attribute, const std::string& text) const;

  const Component& component_;
  Refused& refused_;
};

/// The numbers of a component that others refer to.
[[nodiscard]] inline SourcePosition at_of(const Component& component, const char* id) {
  const Attribute* found = component.find(id);
  return found ? found->at : component.at;
}

}  // namespace toothpath::rexs
