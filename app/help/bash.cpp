#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/help/completion.h"

namespace toothpath::help {
namespace {

/// What the shell runs to propose this value.
std::string bash_proposal(const Value& value) {
  switch (value.kind) {
    case ValueKind::text: return ":";
    case ValueKind::file: return "_toothpath_files";
    case ValueKind::job: return "_toothpath_files toml";
    case ValueKind::machine: return "_toothpath_machines";
    case ValueKind::directory: return "_toothpath_directories";
    case ValueKind::choice:
      return fmt::format("_toothpath_words {}", shell_quoted(fmt::format("{}", fmt::join(value.choices, " "))));
  }
  return ":";
}

constexpr const char* kBashHead = R"bash(# Completion of {0} in bash, made by `toothpath completion bash`.

_toothpath_words() {{ mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur"); }}
_toothpath_directories() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$cur")
}}
# Files, of one ending where there is one, and the folders on the way to them.
_toothpath_files() {{
  compopt -o filenames 2>/dev/null
  if [[ -z ${{1-}} ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  else
    mapfile -t COMPREPLY < <(compgen -d -- "$cur"; compgen -f -X "!*.$1" -- "$cur")
  fi
}}
_toothpath_machines() {{
  local names
  _toothpath_files toml
  names=$("${{COMP_WORDS[0]}}" completion machines 2>/dev/null)
  mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -W "$names" -- "$cur")
}}
)bash";

constexpr const char* kBashWords = R"bash(
_toothpath() {
  local cur=${COMP_WORDS[COMP_CWORD]} path='' place=0 word option='' i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $word == '=' ]]; then continue; fi
    if [[ -n $option ]]; then option=''; continue; fi
    if [[ $word == -* ]]; then
      case "$path $word" in
)bash";

constexpr const char* kBashCommands = R"bash(      esac
      continue
    fi
    case "$path $word" in
)bash";

constexpr const char* kBashValues = R"bash(      *) place=$((place + 1)) ;;
    esac
  done
  [[ $cur != '=' ]] || cur=''
  if [[ -n $option ]]; then
    case "$path $option" in
)bash";

constexpr const char* kBashOptions = R"bash(    esac
    return
  fi
  if [[ $cur == -* ]]; then
    case $path in
)bash";

constexpr const char* kBashPlaces = R"bash(    esac
    return
  fi
  case "$path $place" in
)bash";

constexpr const char* kBashEnd = R"bash(  esac
}
complete -F _toothpath toothpath
)bash";

}  // namespace

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string bash_completion(const Program& program) {
  std::string with_value, values, words, names, places;
  for (const auto& [path, command] : all_commands(program)) {
    std::vector<std::string> all, inner;
    for (const Option& option : options_at(program, *command)) {
      all.insert(all.end(), option.names.begin(), option.names.end());
      if (!option.value) continue;
      std::vector<std::string> keys;
      for (const std::string& name : option.names) keys.push_back(shell_quoted(path + " " + name));
      with_value += fmt::format("        {}) option=$word ;;\n", fmt::join(keys, " | "));
      values += fmt::format("      {}) {} ;;\n", fmt::join(keys, " | "), bash_proposal(*option.value));
    }
    names += fmt::format("      {}) _toothpath_words {} ;;\n", shell_quoted(path),
                         shell_quoted(fmt::format("{}", fmt::join(all, " "))));
    for (const Command& below : command->commands) {
      inner.push_back(below.name);
      const std::string whole = path.empty() ? below.name : path + " " + below.name;
      words +=
          fmt::format("      {}) path={} place=0 ;;\n", shell_quoted(path + " " + below.name), shell_quoted(whole));
    }
    if (!inner.empty())
      places += fmt::format("    {}) _toothpath_words {} ;;\n", shell_quoted(path + " 0"),
                            shell_quoted(fmt::format("{}", fmt::join(inner, " "))));
    for (std::size_t k = 0; k < command->arguments.size(); ++k)
      places += fmt::format("    {}) {} ;;\n", shell_quoted(fmt::format("{} {}", path, k)),
                            bash_proposal(command->arguments[k].value));
  }
  return fmt::format(kBashHead, program.version) + kBashWords + with_value + kBashCommands + words + kBashValues +
         values + kBashOptions + names + kBashPlaces + places + kBashEnd;
}

}  // namespace toothpath::help
