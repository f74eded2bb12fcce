#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/help/completion.h"

namespace toothpath::help {
namespace {

/// In single quotes, as fish reads them.
std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

/// The words of `complete` that propose a value; nothing else is proposed but for files.
std::string fish_proposal(const Value& value) {
  switch (value.kind) {
    case ValueKind::text: return "-x";
    case ValueKind::file: return "-r -F";
    case ValueKind::job: return "-x -a '(__toothpath_toml)'";
    case ValueKind::machine: return "-x -a '(toothpath completion machines 2>/dev/null; __toothpath_toml)'";
    case ValueKind::directory: return "-x -a '(__fish_complete_directories)'";
    case ValueKind::choice:
      return fmt::format("-x -a {}", fish_quoted(fmt::format("{}", fmt::join(value.choices, " "))));
  }
  return "-x";
}

std::string option_line(const std::string& condition, const Option& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return fmt::format("complete -c toothpath{}{} -d {}{}\n", condition, names, fish_quoted(option.help),
                     option.value ? " " + fish_proposal(*option.value) : "");
}

constexpr const char* kFish = R"fish(# Completion of {} in fish, made by `toothpath completion fish`.

# The command that the words before reached, and behind it the number of its arguments that are there.
function __toothpath_reached
    set -l path ''
    set -l place 0
    set -l skip 0
    for word in (commandline -opc)[2..-1]
        if test $skip = 1
            set skip 0
            continue
        end
        switch $word
            case '-*'
                contains -- "$path $word"{} && set skip 1
                continue
        end
        switch "$path $word"
{}            case '*'
                set place (math $place + 1)
        end
    end
    echo $path
    echo $place
end

# __toothpath_at PATH [PLACE]
function __toothpath_at
    set -l reached (__toothpath_reached)
    test "$reached[1]" = "$argv[1]"; or return 1
    test (count $argv) -eq 1; or test "$reached[2]" = "$argv[2]"
end

# Files of this ending, and the folders on the way to them.
function __toothpath_toml
    __fish_complete_suffix .toml | string match -r '^.*(?:/|\.toml)$'
end

complete -c toothpath -f
{})fish";

}  // namespace

std::string fish_completion(const Program& program) {
  std::string words, with_value, lines;
  for (const auto& [path, command] : all_commands(program)) {
    const std::string condition = fmt::format(" -n {}", fish_quoted("__toothpath_at " + fish_quoted(path)));
    for (const Command& inner : command->commands) {
      words += fmt::format("            case {}\n                set path {}\n", fish_quoted(path + " " + inner.name),
                           fish_quoted(path.empty() ? inner.name : path + " " + inner.name));
      lines += fmt::format("complete -c toothpath{} -a {} -d {}\n", condition, fish_quoted(inner.name),
                           fish_quoted(inner.description));
    }
    for (const Option& option : options_at(program, *command)) {
      lines += option_line(condition, option);
      if (!option.value) continue;
      for (const std::string& name : option.names) with_value += " " + fish_quoted(path + " " + name);
    }
    for (std::size_t k = 0; k < command->arguments.size(); ++k)
      if (command->arguments[k].value.kind != ValueKind::text)
        lines += fmt::format("complete -c toothpath -n {} {}\n",
                             fish_quoted(fmt::format("__toothpath_at {} {}", fish_quoted(path), k)),
                             fish_proposal(command->arguments[k].value));
  }
  return fmt::format(kFish, program.version, with_value, words, lines);
}

}  // namespace toothpath::help
