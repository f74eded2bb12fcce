// Result<T>: a value or a Diagnostic; Expected<T, E>: a value or an E. What a job, machine file or mesh can cause
// travels this way; a broken promise between our own functions is an assertion.
#pragma once

#include <fmt/format.h>

#include <cassert>
#include <utility>
#include <variant>

#include "geometry/base/diagnostic.h"

namespace toothpath {

/// A value, or what stands in its place: a diagnostic, or the list of all refusals.
template <typename T, typename E>
class [[nodiscard]] Expected {
 public:
  Expected(T value) : state_(std::in_place_index<kValue>, std::move(value)) {}  // NOLINT
  Expected(E error) : state_(std::in_place_index<kError>, std::move(error)) {}  // NOLINT

  [[nodiscard]] bool has_value() const { return state_.index() == kValue; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] T& value() & {
    assert(has_value());
    return *std::get_if<kValue>(&state_);
  }
  [[nodiscard]] const T& value() const& {
    assert(has_value());
    return *std::get_if<kValue>(&state_);
  }
  [[nodiscard]] T&& value() && {
    assert(has_value());
    return std::move(*std::get_if<kValue>(&state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  [[nodiscard]] E& error() & {
    assert(!has_value());
    return *std::get_if<kError>(&state_);
  }
  [[nodiscard]] const E& error() const& {
    assert(!has_value());
    return *std::get_if<kError>(&state_);
  }
  [[nodiscard]] E&& error() && {
    assert(!has_value());
    return std::move(*std::get_if<kError>(&state_));
  }
  /// Why there is no value; null where there is one: `if (auto* errors = made.refused()) return
  /// failed(std::move(*errors));`
  [[nodiscard]] E* refused() { return std::get_if<kError>(&state_); }
  [[nodiscard]] const E* refused() const { return std::get_if<kError>(&state_); }
  /// The value; null where there is none.
  [[nodiscard]] T* value_if() { return std::get_if<kValue>(&state_); }
  [[nodiscard]] const T* value_if() const { return std::get_if<kValue>(&state_); }

 private:
  static constexpr std::size_t kValue = 0, kError = 1;
  std::variant<T, E> state_;
};

template <typename T>
using Result = Expected<T, Diagnostic>;

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
