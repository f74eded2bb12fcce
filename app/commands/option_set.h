// The options of a command as it declares them. Only option_set.cpp, app/command_line.cpp and app/command_tree.cpp know
// the library that reads them.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/base/option_number.h"

namespace CLI {
class App;
}

namespace toothpath::commands {

/// Options in the order in which the help lists them. Every value is filled in when the command line has been read, and
/// must live until then. `type` stands behind the option in the help. An empty name or text is refused (kind usage).
class OptionSet {
 public:
  explicit OptionSet(CLI::App& app) : app_(app) {}

  /// An argument by its place, required.
  void file(const char* name, std::string& value, const char* help);
  /// --out DIR. Without it the results go where standard_out_dir() says, and the help says it, too.
  void out_dir(std::string& value);
  void out_dir_or_none(std::string& value, const char* help);
  /// That of out_dir(), and the folder below "out" of this command; nothing: it has none.
  struct OutDir {
    std::string* value = nullptr;
    std::string below;
  };
  [[nodiscard]] const OutDir& out_dir() const { return out_; }
  /// What stands below "Examples:" in the help, without the name of the program: "run gear.toml".
  void examples(std::initializer_list<const char*> lines);

  void flag(const char* name, bool& value, const char* help);
  void text(const char* name, std::string& value, const char* help, const char* type);
  void required_text(const char* name, std::string& value, const char* help, const char* type);
  /// One of these words, which the help and the shells list. Another one is refused by who takes it.
  void word(const char* name, std::string& value, const char* help, const char* type,
            std::span<const std::string_view> words);
  /// As often as wanted.
  void texts(const char* name, std::vector<std::string>& values, const char* help, const char* type);
  /// One or more, repeated or one behind the other.
  void files(const char* name, std::vector<std::string>& values, const char* help);
  void required_files(const char* name, std::vector<std::string>& values, const char* help);
  /// Refused (kind usage): what is no finite number of the range, whose unit stands in the help.
  void number(const char* name, std::optional<double>& value, const char* help, const toml::Range& range);
  void whole_number(const char* name, std::optional<int>& value, const char* help, const toml::Range& range);

 private:
  CLI::App& app_;
  OutDir out_;
};

/// Where the results of a command go that is given no --out: `out` beside its job for `run`, of any other command a
/// folder of its own name in it. So no command replaces the results of another.
/// @param job_file  empty: the command has no job; then below the working directory
[[nodiscard]] std::string standard_out_dir(const std::string& job_file, const std::string& below);

}  // namespace toothpath::commands
