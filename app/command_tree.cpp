#include "app/command_tree.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace toothpath {
namespace {

/// The words of "TEXT:{auto,always,never}".
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

help::Value value_of(const CLI::Option& option) {
  help::Value value{help::ValueKind::text, option.get_type_name(), choices_in(option.get_type_name())};
  const std::string name = option.get_name(option.get_positional());
  if (!value.choices.empty()) value.kind = help::ValueKind::choice;
  else if (value.name.starts_with("JOB") || option.get_description().starts_with("job file"))
    value.kind = help::ValueKind::job;
  else if (name == "MACHINE" || name == "--machine") value.kind = help::ValueKind::machine;
  else if (value.name == "FILE") value.kind = help::ValueKind::file;
  else if (value.name == "DIR") value.kind = help::ValueKind::directory;
  return value;
}

help::Command describe(const CLI::App& app) {
  help::Command command;
  command.name = app.get_name();
  command.description = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) {
      command.arguments.push_back({option->get_name(true), value_of(*option), option->get_description()});
      continue;
    }
    help::Option entry;
    for (const std::string& name : option->get_snames()) entry.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) entry.names.push_back("--" + name);
    if (option->get_items_expected_max() > 0) entry.value = value_of(*option);
    entry.required = option->get_required();
    entry.repeatable = option->get_items_expected_max() > 1;
    entry.help = option->get_description();
    command.options.push_back(std::move(entry));
  }
  std::istringstream footer(app.get_footer());
  for (std::string line; std::getline(footer, line);)
    if (line.starts_with("  toothpath ")) command.examples.push_back(line.substr(2));
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); }))
    command.commands.push_back(describe(*inner));
  return command;
}

}  // namespace

help::Program describe_program(const CLI::App& app, const std::string& version) {
  return {describe(app), version, app.get_footer()};
}

}  // namespace toothpath
