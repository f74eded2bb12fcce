#include "postproc/text/dialect.h"

#include <algorithm>

namespace toothpath::text {

bool has_program_number(const NcDialect& dialect) {
  return std::any_of(dialect.frame_begin.begin(), dialect.frame_begin.end(),
                     [](const std::string& line) { return line.find("{number}") != std::string::npos; });
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
