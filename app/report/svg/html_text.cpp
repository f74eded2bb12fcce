#include "app/report/svg/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/base/printable.h"

namespace toothpath::svg {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
constexpr std::size_t kLongWord = 24;

}  // namespace

std::string valid_utf8(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    out += length == 0 ? kReplacement : text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return out;
}

std::string sentence(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.front() = char(text.front() - 'a' + 'A');
  return text;
}

std::string html_escape(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const auto code = static_cast<unsigned char>(text[i]);
    const bool control = (code < 0x20U && code != '\n' && code != '\t') || code == 0x7FU;
    if (length == 0 || control || (length > 1 && is_hidden(text.substr(i, length)))) out += kReplacement;
    else if (code == '&') out += "&amp;";
    else if (code == '<') out += "&lt;";
    else if (code == '>') out += "&gt;";
    else if (code == '"') out += "&quot;";
    else if (code == '\'') out += "&#39;";
    else out += text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return out;
}

bool has_long_word(std::string_view text) {
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    if (end - from > kLongWord) return true;
    from = end + 1;
  }
  return false;
}

std::string script_safe_json(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '<') out += "\\u003c";
    else if (c == '>') out += "\\u003e";
    else if (c == '&') out += "\\u0026";
    else if (json.substr(i, 3) == "\xE2\x80\xA8") out += "\\u2028", i += 2;
    else if (json.substr(i, 3) == "\xE2\x80\xA9") out += "\\u2029", i += 2;
    else out += c;
  }
  return out;
}

std::string short_number(double value, int digits) {
  if (!std::isfinite(value)) return "\xE2\x80\x93";
  std::string text = fmt::format("{:.{}g}", value, digits);
  const double rounded = std::abs(value);
  if (rounded >= 1e-4 && rounded < 1e6 && text.find('e') != std::string::npos) text = fmt::format("{:.0f}", value);
  return text == "-0" ? "0" : text;
}

}  // namespace toothpath::svg
