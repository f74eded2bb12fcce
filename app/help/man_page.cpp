#include "app/help/man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace toothpath::help {
namespace {

constexpr std::size_t kLine = 78;

/// Text as roff shows it, in lines that people read too: nothing in it is a request or an escape.
std::string roff(const std::string& text) {
  std::string out;
  std::size_t begin = 0, space = std::string::npos;  // of the line, and its last space
  for (const char c : text) {
    if (out.size() == begin && (c == '.' || c == '\'')) out += "\\&";
    if (c == ' ' || c == '\n') space = out.size();
    if (c == '\\') out += "\\e";
    else if (c == '-') out += "\\-";
    else out += c == '\n' ? ' ' : c;
    if (out.size() - begin <= kLine || space == std::string::npos || space + 1 == out.size()) continue;
    out[space] = '\n';
    begin = std::exchange(space, std::string::npos) + 1;
    if (out[begin] == '.' || out[begin] == '\'') out.insert(begin, "\\&");
  }
  return out;
}

std::string value_words(const Value& value) {
  return "\\fI" + roff(value.choices.empty() ? value.name : fmt::format("{}", fmt::join(value.choices, "|"))) + "\\fR";
}

std::string option_entry(const Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back("\\fB" + roff(name) + "\\fR");
  return fmt::format(
      ".TP\n{}{}{}\n{}{}\n", fmt::join(names, ", "), option.value ? " " + value_words(*option.value) : "",
      option.value && option.repeatable ? " ..." : "", roff(option.help), option.required ? " (required)" : "");
}

/// "toothpath correct --measured FILE JOB".
std::string synopsis(const CommandAt& at) {
  std::string out = "\\fBtoothpath " + roff(at.path) + "\\fR";
  for (const Option& option : at.command->options)
    if (option.required && option.value)
      out += fmt::format(" \\fB{}\\fR {}", roff(option.names.back()), value_words(*option.value));
  for (const Argument& argument : at.command->arguments) out += " \\fI" + roff(argument.name) + "\\fR";
  return out;
}

std::string command_section(const CommandAt& at) {
  std::string out = fmt::format(".SS {}\n{}\n", synopsis(at), roff(at.command->description));
  for (const Argument& argument : at.command->arguments)
    out += fmt::format(".TP\n\\fI{}\\fR\n{}\n", roff(argument.name), roff(argument.help));
  for (const Option& option : at.command->options)
    if (option.names.back() != "--help") out += option_entry(option);
  if (!at.command->examples.empty()) out += at.command->examples.size() > 1 ? ".PP\nExamples:\n" : ".PP\nExample:\n";
  for (const std::string& example : at.command->examples) {
    std::string words = roff(example);  // in one line
    std::replace(words.begin(), words.end(), '\n', ' ');
    out += fmt::format(".br\n\\fB{}\\fR\n", words);
  }
  return out;
}

std::string first_small(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
  if (text.ends_with('.')) text.pop_back();
  return text;
}

constexpr const char* kManualEnd = R"(.SH ENVIRONMENT
.TP
\fBNO_COLOR\fR
where it is set and not empty, nothing is coloured
.SH FILES
.TP
\fI../share/toothpath/machines\fR
beside the folder of the program: the installed machine files
.TP
\fI../share/doc/toothpath\fR
samples to copy, and what stands behind the calculations
.SH EXAMPLES
.TP
\fBtoothpath run /usr/share/doc/toothpath/samples/spur_quick.toml \-\-out out\fR
plans and proves a small face gear; open out/report.html
.TP
\fBtoothpath machine list\fR
the names that a job may give as its machine
)";

}  // namespace

std::string man_page(const Program& program, const std::string& date) {
  std::string out = fmt::format(
      ".\\\" Made by `toothpath man-page`.\n.TH TOOTHPATH 1 \"{}\" \"{}\" \"User Commands\"\n.SH NAME\n"
      "toothpath \\- {}\n.SH SYNOPSIS\n\\fBtoothpath\\fR [\\fIOPTIONS\\fR] \\fICOMMAND\\fR ...\n",
      date, roff(program.version), roff(first_small(program.command.description)));
  out += ".SH DESCRIPTION\n" +
         roff(
             "A job file says which gear, machine, tools and operations. The program plans the paths, proves them "
             "against the exact flanks, writes the NC program, reads it back from the disk and proves what it read.") +
         "\n.SH OPTIONS\nThey may stand before or behind the command.\n";
  for (const Option& option : program.command.options) out += option_entry(option);
  out += ".SH COMMANDS\n";
  for (const CommandAt& at : all_commands(program))
    if (at.command->commands.empty()) out += command_section(at);
  return out + ".SH EXIT STATUS\n" + roff(program.footer) + "\n" + kManualEnd;
}

}  // namespace toothpath::help
