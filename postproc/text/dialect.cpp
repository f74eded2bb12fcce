#include "postproc/text/dialect.h"

#include <algorithm>

#include "postproc/text/lines.h"

namespace toothpath::text {
namespace {

constexpr int kTurnBehindX = 9;  // X Y Z A B C U V W R

/// Of the rotaries, in the order of the alphabet.
std::string rotaries_of(const std::array<char, 5>& letters) {
  std::string rotaries;
  for (const char letter : {'A', 'B', 'C'})
    if (std::find(letters.begin() + 3, letters.end(), letter) != letters.end()) rotaries += letter;
  return rotaries;
}

NcLines::Values offset_values(const NcDialect& dialect, const std::string& work_offset,
                              const std::array<char, 5>& letters) {
  const std::string rotaries = rotaries_of(letters);
  NcLines::Values values = {{"offset", work_offset}};
  for (const char letter : rotaries)
    values["rotaries"] += (values["rotaries"].empty() ? "" : ", ") + std::string(1, letter);
  values["offset_words"] = values["rotaries"] + (rotaries.empty() ? "R" : ", R");
  if (dialect.datum != nullptr) values["datum"] = std::to_string(dialect.datum(work_offset));
  if (dialect.origin_parameter == nullptr) return values;
  const int x = dialect.origin_parameter(dialect.offset_number(work_offset));
  for (const char letter : rotaries) values["offset_squares"] += fmt::format("#{0}*#{0}+", x + 3 + (letter - 'A'));
  values["offset_squares"] += fmt::format("#{0}*#{0}", x + kTurnBehindX);
  return values;
}

}  // namespace

NcLinesOfText offset_check_lines(const NcDialect& dialect, const std::string& work_offset,
                                 const std::array<char, 5>& letters) {
  const NcLines::Values values = offset_values(dialect, work_offset, letters);
  NcLinesOfText out;
  for (const std::string& line : dialect.offset_check) out.push_back(expanded(line, values).value_or(line));
  return out;
}

std::string offset_trust(const NcDialect& dialect, const std::string& work_offset, const std::array<char, 5>& letters) {
  return expanded(dialect.offset_trust, offset_values(dialect, work_offset, letters)).value_or(dialect.offset_trust);
}

bool has_program_number(const NcDialect& dialect) {
  return std::any_of(dialect.frame_begin.begin(), dialect.frame_begin.end(),
                     [](const std::string& line) { return line.find("{number}") != std::string::npos; });
}

std::vector<std::string> names_of_own_lines(const NcDialect& dialect, bool tool) {
  std::vector<std::string> names = {"offset", "top", "teeth", "free", "name", "id"};
  if (has_program_number(dialect)) names.emplace_back("number");
  if (dialect.datum != nullptr) names.emplace_back("datum");
  if (tool) names.insert(names.end(), {"tool", "speed"});
  return names;
}

std::optional<std::string> unknown_name(std::string_view pattern, const std::vector<std::string>& names) {
  for (std::size_t open = pattern.find('{'); open != std::string_view::npos; open = pattern.find('{', open + 1)) {
    const std::size_t close = pattern.find('}', open);
    std::string name(pattern.substr(open + 1, close == std::string_view::npos ? close : close - open - 1));
    if (close == std::string_view::npos || std::find(names.begin(), names.end(), name) == names.end()) return name;
  }
  return std::nullopt;
}

Result<machines::CoolantWords> coolant_words(const NcDialect& dialect, machines::Coolant coolant) {
  const auto found = dialect.coolant.find(coolant);
  if (found != dialect.coolant.end()) return found->second;
  std::string list;
  for (const auto& [other, words] : dialect.coolant) list += (list.empty() ? "" : ", ") + std::string(to_string(other));
  const std::string help =
      dialect.takes_coolant
          ? fmt::format(
                "; post.coolant_{} = [\"M..\", \"M..\"] in the machine file gives those of the builder, on and off",
                to_string(coolant))
          : std::string();
  return fail("mode = \"{}\": dialect \"{}\" has words for {} alone{}", to_string(coolant), dialect.name, list, help);
}

}  // namespace toothpath::text
