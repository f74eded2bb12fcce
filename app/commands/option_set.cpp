#include "app/commands/option_set.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>

namespace toothpath::commands {
namespace {

template <typename Number, typename Read>
void add_number(CLI::App& app, const char* name, std::optional<Number>& value, const char* help,
                const toml::Range& range, Read read) {
  const auto take = [&value, name, range, read](const std::string& text) {
    const auto number = read(name, text, range);
    if (!number) throw CLI::ValidationError(number.error().message);
    value = *number;
  };
  app.add_option_function<std::string>(name, take, help)
      ->type_name(fmt::format("NUMBER ({:g} to {:g}{})", range.low, range.high, range.unit));
}

/// A name or a word that says nothing is a slip of whoever wrote the command: an unset variable of a script.
CLI::Option* not_empty(CLI::Option* option) {
  return option->check(CLI::Validator(
      [name = option->get_name()](const std::string& text) { return text.empty() ? name + " is empty" : ""; }, ""));
}

/// "": `run`; "check"; "study_stability".
std::string below_out(const CLI::App& app) {
  const CLI::App* group = app.get_parent();
  if (group && group->get_parent()) return group->get_name() + "_" + app.get_name();
  return app.get_name() == "run" ? "" : app.get_name();
}

}  // namespace

std::string standard_out_dir(const std::string& job_file, const std::string& below) {
  const std::filesystem::path out = std::filesystem::path(job_file).parent_path() / "out";
  return (below.empty() ? out : out / below).string();
}

void OptionSet::file(const char* name, std::string& value, const char* help) {
  not_empty(app_.add_option(name, value, help))->required()->type_name("FILE");
}

void OptionSet::out_dir(std::string& value) {
  out_ = {&value, below_out(app_)};
  const bool has_job = !app_.get_options([](const CLI::Option* o) {
                              return o->get_positional() && o->get_description().starts_with("job file");
                            })
                            .empty();
  not_empty(app_.add_option("--out", value,
                            fmt::format("folder for the results; created if missing (default: {}/{})",
                                        standard_out_dir({}, out_.below), has_job ? " beside the job" : "")))
      ->type_name("DIR");
}
void OptionSet::out_dir_or_none(std::string& value, const char* help) {
  not_empty(app_.add_option("--out", value, help))->type_name("DIR");
}

void OptionSet::examples(std::initializer_list<const char*> lines) {
  std::string text = lines.size() > 1 ? "Examples:\n" : "Example:\n";
  for (const char* line : lines) text += fmt::format("  toothpath {}\n", line);
  app_.footer(text + "\n" + app_.get_footer());
}

void OptionSet::flag(const char* name, bool& value, const char* help) { app_.add_flag(name, value, help); }
void OptionSet::text(const char* name, std::string& value, const char* help, const char* type) {
  not_empty(app_.add_option(name, value, help))->type_name(type);
}
void OptionSet::required_text(const char* name, std::string& value, const char* help, const char* type) {
  not_empty(app_.add_option(name, value, help))->required()->type_name(type);
}

void OptionSet::word(const char* name, std::string& value, const char* help, const char* type,
                     std::span<const std::string_view> words) {
  text(name, value, help, fmt::format("{}:{{{}}}", type, fmt::join(words, ",")).c_str());
}
void OptionSet::texts(const char* name, std::vector<std::string>& values, const char* help, const char* type) {
  not_empty(app_.add_option(name, values, help))->type_name(type)->allow_extra_args(false);
}

void OptionSet::files(const char* name, std::vector<std::string>& values, const char* help) {
  not_empty(app_.add_option(name, values, help))->type_name("FILE");
}
void OptionSet::required_files(const char* name, std::vector<std::string>& values, const char* help) {
  not_empty(app_.add_option(name, values, help))->required()->type_name("FILE");
}

void OptionSet::number(const char* name, std::optional<double>& value, const char* help, const toml::Range& range) {
  add_number(app_, name, value, help, range, app::read_number);
}
void OptionSet::whole_number(const char* name, std::optional<int>& value, const char* help, const toml::Range& range) {
  add_number(app_, name, value, help, range, app::read_whole_number);
}

}  // namespace toothpath::commands
