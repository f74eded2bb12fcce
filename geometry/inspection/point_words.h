// What the readers of measured points share: numbers, normals, and where they stand.
#pragma once

#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "geometry/inspection/point_file.h"

namespace toothpath::inspection {

/// Length of a stated normal may be off 1 by this much: files round its components.
inline constexpr double kNormalLength = 0.01;

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Of a trimmed line: empty, or a remark.
inline bool is_comment(std::string_view line) {
  return line.empty() || line.front() == '#' || line.front() == '%' || line.front() == ';' || line.starts_with("//");
}

inline std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
  return out;
}

/// A finite number, the whole text; a sign in front may be +.
inline bool read_number(std::string_view text, double& value) {
  if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

/// A normal as files state it, made one of length 1. Refused: its length.
inline Result<Vec3> read_normal(const Vec3& stated, const SourcePosition& at) {
  const double length = stated.norm();
  if (!(std::abs(length - 1) <= kNormalLength))
    return fail_at(at, "the normal ({:g}, {:g}, {:g}) has length {:.6g}, must be 1 within {:g}", stated.x(), stated.y(),
                   stated.z(), length, kNormalLength);
  return Vec3(stated / length);
}

inline Diagnostic too_many_points(const SourcePosition& at) { return fail_at(at, "more than {} points", kMostPoints); }

}  // namespace toothpath::inspection
