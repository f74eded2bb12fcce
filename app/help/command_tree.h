// The commands of the program with their options as plain data: what shells and the manual page are told.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace toothpath::help {

/// What a shell may propose for a value.
enum class ValueKind { text, file, job, machine, directory, choice };

struct Value {
  ValueKind kind = ValueKind::text;
  std::string name;                  ///< as the help shows it: "FILE", "NUMBER (1 to 1024)"
  std::vector<std::string> choices;  ///< of ValueKind::choice
};

struct Argument {
  std::string name;  ///< "JOB"
  Value value;
  std::string help;
};

struct Option {
  std::vector<std::string> names;  ///< with their dashes, the short one first
  std::optional<Value> value;      ///< none: a flag
  bool required = false, repeatable = false;
  std::string help;
};

struct Command {
  std::string name;  ///< of the program itself: "toothpath"
  std::string description;
  std::vector<Argument> arguments;  ///< all of them required
  std::vector<Option> options;
  std::vector<Command> commands;           ///< below this one
  std::vector<std::string> examples = {};  ///< "toothpath run gear.toml"
};

struct Program {
  Command command;      ///< its options stand behind every command, too
  std::string version;  ///< "toothpath 0.1.0"
  std::string footer;   ///< exit codes
};

/// A command with the words that lead to it: "" (the program), "run", "machine", "machine show", in the order of the
/// help.
struct CommandAt {
  std::string path;
  const Command* command = nullptr;
};

inline void append_commands(const Command& command, const std::string& path, std::vector<CommandAt>& out) {
  out.push_back({path, &command});
  for (const Command& inner : command.commands)
    append_commands(inner, path.empty() ? inner.name : path + " " + inner.name, out);
}

[[nodiscard]] inline std::vector<CommandAt> all_commands(const Program& program) {
  std::vector<CommandAt> out;
  append_commands(program.command, "", out);
  return out;
}

/// Options that may stand behind a command: its own, then those of the program; of two with one name the first.
[[nodiscard]] inline std::vector<Option> options_at(const Program& program, const Command& command) {
  std::vector<Option> out = command.options;
  if (&command == &program.command) return out;
  for (const Option& option : program.command.options) {
    bool known = false;
    for (const Option& own : command.options) known = known || own.names == option.names;
    if (!known) out.push_back(option);
  }
  return out;
}

}  // namespace toothpath::help
