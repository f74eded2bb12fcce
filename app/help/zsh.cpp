#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/help/completion.h"

namespace toothpath::help {
namespace {

/// Text inside a specification of _arguments, where brackets and colons have a meaning.
std::string zsh_plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

/// ":NAME:ACTION" of a value.
std::string message_and_action(const Value& value) {
  std::string action;
  switch (value.kind) {
    case ValueKind::text: action = " "; break;
    case ValueKind::file: action = "_files"; break;
    case ValueKind::job: action = "_files -g \"*.toml\""; break;
    case ValueKind::machine: action = "_toothpath_machines"; break;
    case ValueKind::directory: action = "_files -/"; break;
    case ValueKind::choice: action = fmt::format("({})", fmt::join(value.choices, " ")); break;
  }
  return fmt::format(":{}:{}", zsh_plain(value.name), action);
}

std::string zsh_function(const std::string& path) {
  std::string name = path.empty() ? "_toothpath" : "_toothpath_" + path;
  for (char& c : name)
    if (c == ' ' || c == '-') c = '_';
  return name;
}

/// The specifications of a command's options and arguments, a line each.
std::string zsh_specifications(const Program& program, const Command& command) {
  std::string out;
  for (const Option& option : options_at(program, command))
    for (const std::string& name : option.names)
      out += fmt::format(" \\\n    {}", shell_quoted(fmt::format(
                                            "{}{}{}[{}]{}", option.repeatable ? "*" : "", name,
                                            option.value && name.starts_with("--") ? "=" : "", zsh_plain(option.help),
                                            option.value ? message_and_action(*option.value) : "")));
  for (std::size_t k = 0; k < command.arguments.size(); ++k)
    out += fmt::format(
        " \\\n    {}",
        shell_quoted(fmt::format("{}{}", k + 1,
                                 message_and_action({command.arguments[k].value.kind,
                                                     command.arguments[k].name + ", " + command.arguments[k].help,
                                                     command.arguments[k].value.choices}))));
  return out;
}

std::string zsh_group(const Program& program, const CommandAt& at) {
  std::string described, calls;
  for (const Command& inner : at.command->commands) {
    described += fmt::format("\n        {}", shell_quoted(zsh_plain(inner.name) + ":" + inner.description));
    calls += fmt::format("        {}) {} ;;\n", inner.name,
                         zsh_function(at.path.empty() ? inner.name : at.path + " " + inner.name));
  }
  return fmt::format(R"(
{}() {{
  local curcontext="$curcontext" state line
  local -a commands
  _arguments -C{} \
    '1: :->command' \
    '*:: :->rest'
  case $state in
    command)
      commands=({})
      _describe -t commands command commands
      ;;
    rest)
      case $words[1] in
{}      esac
      ;;
  esac
}}
)",
                     zsh_function(at.path), zsh_specifications(program, *at.command), described, calls);
}

}  // namespace

std::string zsh_completion(const Program& program) {
  std::string out = fmt::format(R"zsh(#compdef toothpath
# Completion of {} in zsh, made by `toothpath completion zsh`: to be sourced, or in a folder of $fpath as _toothpath.

_toothpath_machines() {{
  local -a names
  names=(${{(f)"$(toothpath completion machines 2>/dev/null)"}})
  _alternative 'machines:installed machine:compadd -a names' 'files:machine file:_files -g "*.toml"'
}}
)zsh",
                                program.version);
  for (const CommandAt& at : all_commands(program))
    out += at.command->commands.empty() ? fmt::format("\n{}() {{\n  _arguments{}\n}}\n", zsh_function(at.path),
                                                      zsh_specifications(program, *at.command))
                                        : zsh_group(program, at);
  return out +
         "\nif [[ $funcstack[1] == _toothpath ]]; then _toothpath \"$@\"; else compdef _toothpath toothpath; fi\n";
}

}  // namespace toothpath::help
