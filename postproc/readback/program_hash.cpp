#include "postproc/readback/program_hash.h"

#include <algorithm>
#include <charconv>

#include "geometry/base/hash.h"

namespace toothpath::readback {
namespace {

constexpr std::string_view kHash = "HASH ", kBlocks = " BLOCKS ";
constexpr std::size_t kDigits = 16;

/// A line without its end and its block number.
std::string_view plain(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  std::size_t digits = 0;
  while (digits < line.size() && line[digits] >= '0' && line[digits] <= '9') ++digits;
  if (digits > 0 && digits < line.size() && line[digits] == ' ') line.remove_prefix(digits + 1);
  return line;
}

/// What a comment says; nothing: the line is none.
std::optional<std::string_view> comment_of(std::string_view line) {
  std::size_t open = 0;
  if (line.starts_with("$$")) open = 2;
  else if (line.starts_with("(") || line.starts_with(";")) open = 1;
  else return std::nullopt;
  line.remove_prefix(open);
  if (line.starts_with(" ")) line.remove_prefix(1);
  return line;
}

/// The number of a comment "HASH 0123456789ABCDEF ..".
std::optional<std::uint64_t> hash_in(std::string_view line) {
  const auto comment = comment_of(line);
  if (!comment || !comment->starts_with(kHash) || comment->size() < kHash.size() + kDigits) return std::nullopt;
  const std::string_view digits = comment->substr(kHash.size(), kDigits);
  std::uint64_t value = 0;
  const auto r = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (r.ec != std::errc{} || r.ptr != digits.data() + digits.size()) return std::nullopt;
  return value;
}

/// The number behind "BLOCKS"; 0: none.
std::size_t blocks_in(std::string_view line) {
  const auto at = line.find(kBlocks);
  std::size_t blocks = 0;
  if (at != std::string_view::npos)
    std::from_chars(line.data() + at + kBlocks.size(), line.data() + line.size(), blocks);
  return blocks;
}

}  // namespace

std::size_t count_blocks(std::string_view text) {
  std::size_t blocks = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = plain(text.substr(begin, end - begin));
    begin = end + 1;
    if (!line.empty() && line != "%" && !comment_of(line)) ++blocks;
  }
  return blocks;
}

std::optional<ProgramHash> hash_of_program(std::string_view text) {
  std::optional<ProgramHash> out;
  std::uint64_t hash = fnv1a({});
  bool body = false;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = plain(text.substr(begin, end - begin));
    begin = end + 1;
    ++number;
    const auto stated = hash_in(line);
    if (!out) {
      if (stated) out = ProgramHash{*stated, 0, blocks_in(line), number, 0, true};
      continue;
    }
    body = body || !comment_of(line);
    if (!body) continue;
    if (stated) {  // the last one counts
      out->end_line = number;
      out->ends_agree = *stated == out->stated;
      out->found = hash;
    }
    hash = fnv1a("\n", fnv1a(line, hash));
  }
  return out;
}

}  // namespace toothpath::readback
