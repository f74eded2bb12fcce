// The options of a command as it declares them. Only option_set.cpp, app/command_line.cpp and app/command_tree.cpp know
// the library that reads them.
#pragma once

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
  /// --out DIR, required; without a help text that of most commands.
  void out_dir(std::string& value);
  void out_dir(std::string& value, const char* help);
  void out_dir_or_none(std::string& value, const char* help);

  void flag(const char* name, bool& value, const char* help);
  void text(const char* name, std::string& value, const char* help, const char* type);
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
};

}  // namespace toothpath::commands
