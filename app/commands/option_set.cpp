#include "app/commands/option_set.h"

#include <CLI/CLI.hpp>

namespace toothpath::commands {

void OptionSet::file(const char* name, std::string& value, const char* help) {
  app_.add_option(name, value, help)->required()->type_name("FILE");
}

void OptionSet::out_dir(std::string& value) {
  out_dir(value, "directory for the results; made where it does not exist");
}
void OptionSet::out_dir(std::string& value, const char* help) {
  app_.add_option("--out", value, help)->required()->type_name("DIR");
}
void OptionSet::out_dir_or_none(std::string& value, const char* help) {
  app_.add_option("--out", value, help)->type_name("DIR");
}

void OptionSet::flag(const char* name, bool& value, const char* help) { app_.add_flag(name, value, help); }
void OptionSet::text(const char* name, std::string& value, const char* help, const char* type) {
  app_.add_option(name, value, help)->type_name(type);
}

void OptionSet::files(const char* name, std::vector<std::string>& values, const char* help) {
  app_.add_option(name, values, help)->type_name("FILE");
}
void OptionSet::required_files(const char* name, std::vector<std::string>& values, const char* help) {
  app_.add_option(name, values, help)->required()->type_name("FILE");
}

void OptionSet::number(const char* name, int& value, const char* help) { app_.add_option(name, value, help); }
void OptionSet::number(const char* name, std::optional<int>& value, const char* help) {
  app_.add_option(name, value, help);
}
void OptionSet::number(const char* name, std::optional<double>& value, const char* help) {
  app_.add_option(name, value, help);
}
void OptionSet::number(const char* name, std::optional<double>& value, const char* help, double least, double most) {
  app_.add_option(name, value, help)->check(CLI::Range(least, most));
}

}  // namespace toothpath::commands
