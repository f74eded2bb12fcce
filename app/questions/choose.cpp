#include <algorithm>
#include <filesystem>

#include "app/questions/steps.h"
#include "geometry/base/printable.h"

namespace toothpath::questions {
namespace {

using app::Dialog;
namespace fs = std::filesystem;

/// All questions in their order.
Expected<Choice, std::vector<Diagnostic>> once(const Given& request, Dialog& dialog) {
  Choice choice;
  auto wished = kinds_wished(request, dialog, choice.notes);
  if (auto* errors = wished.refused()) return std::move(*errors);
  choice.wishes = std::move(wished.value());
  auto machine = proposal::choose_machine(choice.wishes, fs::path(request.file).parent_path().string());
  if (auto* errors = machine.refused()) return std::move(*errors);
  choice.machine = std::move(machine.value());
  dialog.tell(limits_of(choice.machine));
  if (auto more = wish_conditions(choice.wishes, request, dialog, choice.machine); auto* errors = more.refused())
    return std::move(*errors);
  if (auto numbers = wish_numbers(choice.wishes, request, dialog, choice.machine); auto* errors = numbers.refused())
    return std::move(*errors);
  auto gear = proposal::choose_gear(choice.wishes);
  if (auto* errors = gear.refused()) return std::move(*errors);
  choice.gear = std::move(gear.value());
  dialog.tell(limits_of(choice.gear));
  if (auto tools = choose_tools(request, dialog, choice); auto* errors = tools.refused()) return std::move(*errors);
  if (const auto draft = proposal::draft_of(request.name, choice.wishes, choice.machine, choice.gear, choice.shelf, 0))
    dialog.tell(limits_of(*draft, choice.machine, choice.gear));
  return choice;
}

/// An option that was not given is no news without the others that are missing.
std::vector<Diagnostic> with_all_that_is_missing(const Given& request, Dialog& dialog, std::vector<Diagnostic> errors) {
  std::vector<Diagnostic> missing = missing_in(request, dialog);
  const auto is_first = [&](const Diagnostic& one) { return one.message == errors.front().message; };
  return std::any_of(missing.begin(), missing.end(), is_first) ? missing : errors;
}

/// The option with which all of these begin, if one was asked for: it is asked for again. Errors of other kinds end.
bool asked_again(const std::vector<Diagnostic>& errors, Dialog& dialog) {
  for (const Diagnostic& error : errors) {
    if (error.kind != DiagnosticKind::refused_input || !error.message.starts_with("--")) continue;
    if (!dialog.forget(error.message.substr(0, error.message.find_first_of(": =")))) continue;
    for (const Diagnostic& said : errors) dialog.tell({{"not possible", said.message}});
    dialog.begin_again();
    return true;
  }
  return false;
}

}  // namespace

Expected<Choice, std::vector<Diagnostic>> choose(const Given& request, app::Dialog& dialog) {
  while (true) {
    auto chosen = once(request, dialog);
    auto* errors = chosen.refused();
    if (!errors) return chosen;
    if (!dialog.asks()) return with_all_that_is_missing(request, dialog, std::move(*errors));
    if (dialog.went_back()) dialog.begin_again();
    else if (!asked_again(*errors, dialog)) return chosen;
  }
}

Status can_be_named(const char* option, const std::string& text) {
  if (printable(text) == text) return Ok{};
  return fail_at({text, 0, 0},
                 "{}: a job cannot name it: there are bytes in it that are not UTF-8, or signs that cannot "
                 "be seen; give it another name",
                 option);
}

}  // namespace toothpath::questions
