#include "postproc/text/dialect.h"

#include <algorithm>

namespace toothpath::text {

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
