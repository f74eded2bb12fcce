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

constexpr std::string_view kBlanks = " \t";

std::vector<Diagnostic> usage(std::string message) {
  return {Diagnostic{DiagnosticKind::usage, {}, std::move(message)}};
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::optional<std::string> line_from_terminal(const std::string& question) {
  std::fprintf(stderr, "%s: ", printable(question).c_str());
  std::fflush(stderr);
  std::string answer;
  if (!std::getline(std::cin, answer)) return std::nullopt;
  return answer;
}

Result<double> read_answer(const NumberQuestion& question, std::string_view text) {
  const std::string_view unit = trimmed(question.range.unit);
  if (!unit.empty() && text.ends_with(unit)) text = trimmed(text.substr(0, text.size() - unit.size()));
  if (text.find(',') != std::string_view::npos)
    return fail_as(DiagnosticKind::usage,
                   "{} = {}: a comma is not read, for it may stand before decimals or between "
                   "thousands; 2.5 is written with a point",
                   question.text, printable(text));
  if (!question.whole) return read_number(question.text, text, question.range);
  const auto whole = read_whole_number(question.text, text, question.range);
  if (!whole) return whole.error();
  return static_cast<double>(*whole);
}

}  // namespace

Dialog::Dialog(bool quiet, Explain explain, Keep keep)
    : asks_(!quiet && ::isatty(STDIN_FILENO) != 0), explain_(std::move(explain)), keep_(std::move(keep)) {}

void Dialog::tell(const std::vector<std::pair<std::string, std::string>>& lines) const {
  if (!asks_ || next_ < said_.size()) return;
  for (const auto& [what, value] : lines)
    std::fprintf(stderr, "    %s: %s\n", printable(what).c_str(), printable(value).c_str());
}

void Dialog::changed() const {
  if (keep_) keep_(said_);
}

Dialog::Answer<std::string> Dialog::ask(const std::string& option, const std::string& line,
                                        const std::optional<std::string>& proposed, const Judge& judge) {
  const auto wrong_of = [&](const std::string& answer) {
    return answer.empty() && !proposed ? std::optional<std::string>("an answer is needed: nothing is proposed")
                                       : judge(answer.empty() ? *proposed : answer);
  };
  const auto taken = [&](const std::string& answer) { return answer.empty() ? *proposed : answer; };
  const auto known = std::find_if(said_.begin() + std::ptrdiff_t(next_), said_.end(),
                                  [&](const SaidAnswer& said) { return said.option == option; });
  if (known != said_.end()) {
    if (!wrong_of(known->answer)) {
      next_ = std::size_t(known - said_.begin()) + 1;
      return taken(known->answer);
    }
    said_.erase(known, said_.end());  // it was right beside other answers
    changed();
  }
  while (true) {
    const auto line_said = line_from_terminal(line);
    if (!line_said) return usage(fmt::format("{} is missing: the answers ended", option));
    const std::string answer(trimmed(*line_said));
    if (answer == "?") {
      const std::string_view more = explain_ ? explain_(option) : std::string_view();
      std::fprintf(stderr, "  %s%s%s (option %s; \"<\" goes back)\n", line.c_str(), more.empty() ? "" : ". ",
                   std::string(more).c_str(), option.c_str());
      continue;
    }
    if (answer == "<" && next_ == 0) {
      std::fprintf(stderr, "  this is the first question\n");
      continue;
    }
    if (answer == "<") {
      said_.resize(next_ - 1);
      back_ = true;
      changed();
      return usage(fmt::format("{} is missing", option));
    }
    if (const auto wrong = wrong_of(answer)) {
      std::fprintf(stderr, "  %s\n", printable(*wrong).c_str());
      continue;
    }
    said_.insert(said_.begin() + std::ptrdiff_t(next_), {option, answer});
    ++next_;
    changed();
    return taken(answer);
  }
}

Dialog::Answer<std::string> Dialog::word(const char* option, const char* text, const std::string& given,
                                         std::span<const std::string_view> words) {
  const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
    if (std::find(words.begin(), words.end(), answer) != words.end()) return std::nullopt;
    return fmt::format("{} = \"{}\" is not one of {}{}", option, printable(answer), fmt::join(words, ", "),
                       toml::did_you_mean(answer, words));
  };
  if (!given.empty()) {
    const auto wrong = judge(given);
    if (!wrong) return given;
    if (!asks_) return usage(*wrong);
    std::fprintf(stderr, "  %s\n", wrong->c_str());
  }
  if (!asks_) return usage(fmt::format("{} is missing: {}; one of {}", option, text, fmt::join(words, ", ")));
  return ask(option, fmt::format("{} ({}) [{}]", text, fmt::join(words, ", "), words.front()),
             std::string(words.front()), judge);
}

Dialog::Answer<double> Dialog::number(const NumberQuestion& question, std::optional<double> given,
                                      std::optional<double> proposed) {
  if (given) return *given;
  if (!asks_) {
    if (proposed) return *proposed;
    return usage(fmt::format("{} is missing: {}, {:g} to {:g}{}", question.option, question.text, question.range.low,
                             question.range.high, question.range.unit));
  }
  std::optional<double> read;
  const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
    const auto number = read_answer(question, answer);
    if (!number) return number.error().message;
    read = *number;
    return std::nullopt;
  };
  const auto answer = ask(question.option,
                          fmt::format("{} ({:g} to {:g}{}){}", question.text, question.range.low, question.range.high,
                                      question.range.unit, proposed ? fmt::format(" [{:g}]", *proposed) : ""),
                          proposed ? std::optional(fmt::format("{}", *proposed)) : std::nullopt, judge);
  if (auto* errors = answer.refused()) return *errors;
  return *read;
}

Dialog::Answer<std::string> Dialog::text(const std::string& option, const std::string& text,
                                         const std::optional<std::string>& proposed, const Judge& judge) {
  return ask(option, proposed ? fmt::format("{} [{}]", text, *proposed) : text, proposed, judge);
}

bool Dialog::went_back() { return std::exchange(back_, false); }

void Dialog::begin_again(std::vector<SaidAnswer> said) {
  said_.insert(said_.begin(), std::make_move_iterator(said.begin()), std::make_move_iterator(said.end()));
  next_ = 0;
}

bool Dialog::forget(std::string_view option) {
  const auto found = std::find_if(said_.begin(), said_.end(), [&](const SaidAnswer& s) { return s.option == option; });
  if (found == said_.end()) return false;
  said_.erase(found, said_.end());
  next_ = std::min(next_, said_.size());
  changed();
  return true;
}

}  // namespace toothpath::app
