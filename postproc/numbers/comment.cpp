#include "postproc/numbers/comment.h"

#include <algorithm>

namespace toothpath::numbers {
namespace {

// U+00C0 .. U+00DF without their marks, as passports write them; U+00E0 .. U+00FF are their small letters.
constexpr std::string_view kLatin[] = {"A",  "A", "A",  "A", "AE", "AA", "AE", "C", "E",  "E", "E",
                                       "E",  "I", "I",  "I", "I",  "D",  "N",  "O", "O",  "O", "O",
                                       "OE", "X", "OE", "U", "U",  "U",  "UE", "Y", "TH", "SS"};
constexpr unsigned char kSmallY = 0xBF;  // the second byte of the only small letter that has no capital there

}  // namespace

std::string comment_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const auto byte = static_cast<unsigned char>(c),
               next = static_cast<unsigned char>(at + 1 < text.size() ? text[at + 1] : 0);
    const bool of_two = (byte == 0xC2 || byte == 0xC3) && (next & 0xC0U) == 0x80U;
    if (c >= 'a' && c <= 'z') out += static_cast<char>(c - 'a' + 'A');
    else if (c == '(' || c == ')') out += c == '(' ? '[' : ']';
    else if (byte == 0xC3 && of_two) out += next == kSmallY ? "Y" : kLatin[next & 0x1FU];
    else if ((byte & 0xC0U) == 0x80U && at > 0 && static_cast<unsigned char>(text[at - 1]) >= 0x80U) continue;
    else if (c == '%' || c == ';' || c < ' ' || c >= '~') out += '?';
    else out += c;
    if (of_two) ++at;
  }
  return out;
}

namespace {

/// Bytes of the whole words that fit, or of as many letters of a first word that is longer.
std::size_t fitting(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text.size();
  const auto blank = text.find_last_of(' ', most);
  if (blank != std::string_view::npos && blank > 0) return blank;
  while (most > 1 && (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80U) --most;  // a letter of several bytes
  return std::max<std::size_t>(most, 1);
}

}  // namespace

std::string first_words(std::string_view text, std::size_t most) {
  const std::string_view kept = text.substr(0, fitting(text, most));
  return std::string(kept.size() == text.size() ? kept : kept.substr(0, kept.find_last_not_of(" ,;-") + 1));
}

std::vector<std::string> lines_of_words(std::string_view text, std::size_t most) {
  std::vector<std::string> out;
  do {
    const std::size_t end = fitting(text, most);
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(' ')));
  } while (!text.empty());
  return out;
}

}  // namespace toothpath::numbers
