#include "postproc/numbers/comment.h"

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

}  // namespace toothpath::numbers
