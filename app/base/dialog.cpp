#include "app/base/dialog.h"

#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "app/base/option_number.h"
#include "geometry/base/printable.h"
#include "machines/toml/near_name.h"

namespace toothpath::app {
namespace {

std::vector<Diagnostic> usage(std::string message) {
  return {Diagnostic{DiagnosticKind::usage, {}, std::move(message)}};
}

std::optional<std::string> ask(const std::string& line) {
  std::fprintf(stderr, "%s: ", printable(line).c_str());
  std::fflush(stderr);
  std::string answer;
  if (!std::getline(std::cin, answer)) return std::nullopt;
  return answer;
}

Result<double> read_answer(const NumberQuestion& question, const std::string& text) {
  if (!question.whole) return read_number(question.text, text, question.range);
  const auto whole = read_whole_number(question.text, text, question.range);
  if (!whole) return whole.error();
  return static_cast<double>(*whole);
}

}  // namespace

Dialog::Dialog(bool quiet) : asks_(!quiet && ::isatty(STDIN_FILENO) != 0) {}

void Dialog::tell(const std::vector<std::pair<std::string, std::string>>& lines) const {
  if (!asks_) return;
  for (const auto& [what, value] : lines)
    std::fprintf(stderr, "    %s: %s\n", printable(what).c_str(), printable(value).c_str());
}

Dialog::Answer<std::string> Dialog::word(const char* option, const char* text, std::string given,
                                         std::span<const std::string_view> words) const {
  while (true) {
    if (!given.empty()) {
      if (std::find(words.begin(), words.end(), given) != words.end()) return given;
      const std::string wrong = fmt::format("{} = \"{}\" is not one of {}{}", option, printable(given),
                                            fmt::join(words, ", "), toml::did_you_mean(given, words));
      if (!asks_) return usage(wrong);
      std::fprintf(stderr, "  %s\n", wrong.c_str());
    }
    if (!asks_) return usage(fmt::format("{} is missing: {}; one of {}", option, text, fmt::join(words, ", ")));
    const auto answer = ask(fmt::format("{} ({}) [{}]", text, fmt::join(words, ", "), words.front()));
    if (!answer) return usage(fmt::format("{} is missing: the answers ended", option));
    given = answer->empty() ? std::string(words.front()) : *answer;
  }
}

Dialog::Answer<double> Dialog::number(const NumberQuestion& question, std::optional<double> given,
                                      std::optional<double> proposed) const {
  if (given) return *given;
  if (!asks_) {
    if (proposed) return *proposed;
    return usage(fmt::format("{} is missing: {}, {:g} to {:g}{}", question.option, question.text, question.range.low,
                             question.range.high, question.range.unit));
  }
  const std::string line = fmt::format("{} ({:g} to {:g}{}){}", question.text, question.range.low, question.range.high,
                                       question.range.unit, proposed ? fmt::format(" [{:g}]", *proposed) : "");
  while (true) {
    const auto answer = ask(line);
    if (!answer) return usage(fmt::format("{} is missing: the answers ended", question.option));
    if (answer->empty() && proposed) return *proposed;
    const auto read = read_answer(question, *answer);
    if (read) return *read;
    std::fprintf(stderr, "  %s\n", printable(read.error().message).c_str());
  }
}

Dialog::Answer<std::string> Dialog::text(const std::string& option, const std::string& text,
                                         const std::optional<std::string>& proposed, const Judge& judge) const {
  while (true) {
    auto answer = ask(proposed ? fmt::format("{} [{}]", text, *proposed) : text);
    if (!answer) return usage(fmt::format("{} is missing: the answers ended", option));
    if (answer->empty() && proposed) answer = *proposed;
    const auto wrong = judge(*answer);
    if (!wrong) return *answer;
    std::fprintf(stderr, "  %s\n", printable(*wrong).c_str());
  }
}

}  // namespace toothpath::app
