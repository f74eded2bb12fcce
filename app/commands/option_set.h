// The options of a command as it declares them. Only option_set.cpp and app/command_line.cpp know the library that
// reads them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace toothpath::commands {

/// Options in the order in which the help lists them. Every value is filled in when the command line has been read, and
/// must live until then. `type` stands behind the option in the help.
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
  /// One or more, repeated or one behind the other.
  void files(const char* name, std::vector<std::string>& values, const char* help);
  void required_files(const char* name, std::vector<std::string>& values, const char* help);
  void number(const char* name, int& value, const char* help);
  void number(const char* name, std::optional<int>& value, const char* help);
  void number(const char* name, std::optional<double>& value, const char* help);
  /// Refused (kind usage) outside of least .. most.
  void number(const char* name, std::optional<double>& value, const char* help, double least, double most);

 private:
  CLI::App& app_;
};

}  // namespace toothpath::commands
