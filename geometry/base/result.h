// Result<T>: a value or a Diagnostic. What a job, machine file or mesh can cause travels this way;
// a broken promise between our own functions is an assertion.
#pragma once

#include <fmt/format.h>

#include <cassert>
#include <utility>
#include <variant>

#include "geometry/base/diagnostic.h"

namespace toothpath {

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}             // NOLINT
  Result(Diagnostic error) : state_(std::in_place_index<1>, std::move(error)) {}    // NOLINT

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] T& value() & { assert(has_value()); return std::get<0>(state_); }
  [[nodiscard]] const T& value() const& { assert(has_value()); return std::get<0>(state_); }
  [[nodiscard]] T&& value() && { assert(has_value()); return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  [[nodiscard]] const Diagnostic& error() const { assert(!has_value()); return std::get<1>(state_); }

 private:
  std::variant<T, Diagnostic> state_;
};

/// Success without a value.
struct Ok {};
using Status = Result<Ok>;

/// A diagnostic without position: `return fail("teeth = {} is below 2", z);`
template <typename... Args>
[[nodiscard]] Diagnostic fail(fmt::format_string<Args...> text, Args&&... args) {
  return {DiagnosticKind::refused_input, {}, fmt::format(text, std::forward<Args>(args)...)};
}

/// The same with the place where the number was written.
template <typename... Args>
[[nodiscard]] Diagnostic fail_at(SourcePosition position, fmt::format_string<Args...> text, Args&&... args) {
  return {DiagnosticKind::refused_input, std::move(position), fmt::format(text, std::forward<Args>(args)...)};
}

/// The same with its kind.
template <typename... Args>
[[nodiscard]] Diagnostic fail_as(DiagnosticKind kind, fmt::format_string<Args...> text, Args&&... args) {
  return {kind, {}, fmt::format(text, std::forward<Args>(args)...)};
}

}  // namespace toothpath
