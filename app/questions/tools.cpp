#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "app/base/option_number.h"
#include "app/job/file.h"
#include "app/job/job.h"
#include "app/questions/steps.h"
#include "geometry/base/printable.h"

namespace toothpath::questions {
namespace {

using app::Dialog;
using proposal::LibraryShelf;
namespace fs = std::filesystem;

/// "stick_out (above 0 to 2000 mm), holder (..)".
std::string missing_text(const std::vector<job::MissingKey>& keys) {
  std::vector<std::string> all;
  for (const job::MissingKey& key : keys) all.push_back(fmt::format("{} ({})", key.key, job::shape_text(key.shape)));
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The library of --tools, with what --tool says beside it.
Expected<LibraryShelf, std::vector<Diagnostic>> open_library(const Given& request) {
  auto library = LibraryShelf::open(request.tools, request.unit);
  if (!library) return std::vector{library.error()};
  for (const std::string& said : request.said) {
    const auto colon = said.find(':');
    if (colon == std::string::npos)
      return usage(fmt::format("--tool {}: its number, a colon and keys of a [[tool]] are needed: 12: stick_out = 40",
                               printable(said)));
    const auto number = app::read_whole_number("--tool", said.substr(0, colon), job::kToolNumber);
    if (!number) return std::vector{number.error()};
    const auto keys = job::parse_tool_keys(said.substr(colon + 1));
    if (!keys) return usage(fmt::format("--tool {}: {}", *number, printable(keys.error().message)));
    if (const Status taken = library->say(*number, *keys); !taken) return std::vector{taken.error()};
  }
  return std::move(*library);
}

/// What a file lacks of its tools that would do, all of it by name.
std::string lacking(const LibraryShelf& library, const Choice& choice) {
  std::vector<std::string> all;
  for (const auto* tool : library.candidates(*choice.wishes.route, choice.gear.facts))
    if (!tool->whole())
      all.push_back(
          fmt::format("{} lacks {}", tool->title(), missing_text(LibraryShelf::missing(*tool, *choice.wishes.route))));
  return fmt::format("{}", fmt::join(all, "; "));
}

/// "; tool 5 (..): ..", why the tools that are no candidates are none.
std::string reasons(const LibraryShelf& library, const Choice& choice) {
  std::string all;
  for (const auto& [title, why] : library.left_out(*choice.wishes.route, choice.gear.facts))
    all += fmt::format("; {}: {}", title, why);
  return all;
}

/// Asks for every key that a tool lacks. An answer with which it would not do is none.
DoneOrErrors complete(LibraryShelf& library, int number, proposal::Route route, const proposal::FaceFacts& facts,
                      Dialog& dialog) {
  while (!library.find(number)->whole()) {
    const LibraryShelf::Tool& tool = *library.find(number);
    const job::MissingKey key = LibraryShelf::missing(tool, route).front();
    const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
      const auto& words = key.shape.words;
      if (!words.empty() && std::find(words.begin(), words.end(), answer) == words.end())
        return fmt::format("{} = \"{}\" is not {}", key.key, answer, job::shape_text(key.shape));
      const auto value = job::parse_tool_value(key.shape, answer);
      if (!value) return value.error().message;
      LibraryShelf tried = library;
      if (const Status taken = tried.say(number, {{{key.key, {}, *value}}}); !taken) return taken.error().message;
      if (const std::string why = LibraryShelf::why_not(*tried.find(number), route, facts); !why.empty())
        return fmt::format("{} then does not do: {}", tool.title(), why);
      const Status taken = library.say(number, {{{key.key, {}, *value}}});
      return taken ? std::nullopt : std::optional(taken.error().message);
    };
    const auto answer =
        dialog.text(fmt::format("--tool {}: {}", number, key.key),
                    fmt::format("{}: {} ({})", tool.title(), key.key, job::shape_text(key.shape)), {}, judge);
    if (auto* errors = answer.refused()) return *errors;
  }
  return Ok{};
}

std::vector<int> numbers_in(const std::string& text) {
  std::vector<int> numbers;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) {
    const auto first = word.find_first_not_of(' '), last = word.find_last_not_of(' ');
    const auto number = app::read_whole_number(
        "--tool", first == std::string::npos ? "" : word.substr(first, last - first + 1), job::kToolNumber);
    numbers.push_back(number ? *number : 0);
  }
  return numbers;
}

/// Asks which tools of a library may be used, and for what it does not say of them.
Expected<proposal::Shelf, std::vector<Diagnostic>> ask_for_tools(LibraryShelf& library, const Choice& choice,
                                                                 Dialog& dialog) {
  const proposal::Route route = *choice.wishes.route;
  const auto candidates = library.candidates(route, choice.gear.facts);
  proposal::Told told;
  for (const auto* tool : candidates) {
    std::string line = tool->whole() ? "whole" : "lacks " + missing_text(LibraryShelf::missing(*tool, route));
    for (const std::string& note : tool->known.notes) line += "; " + note;
    told.emplace_back(tool->title(), line);
  }
  for (const auto& [title, why] : library.left_out(route, choice.gear.facts))
    told.emplace_back(title, "not offered: " + why);
  dialog.tell(told);
  std::vector<int> proposed;
  for (const auto* tool : LibraryShelf::proposed(candidates, choice.gear.facts)) proposed.push_back(tool->number());
  const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
    for (const int number : numbers_in(answer))
      if (std::none_of(candidates.begin(), candidates.end(), [&](const auto* t) { return t->number() == number; }))
        return "one of the numbers above, or some with commas between them";
    return std::nullopt;
  };
  const auto answer =
      dialog.text("--tool", fmt::format("tools of {} that may be used, by number", library.file()),
                  proposed.empty() ? std::nullopt : std::optional(fmt::format("{}", fmt::join(proposed, ", "))), judge);
  if (auto* errors = answer.refused()) return *errors;
  proposal::Shelf shelf;
  for (const int number : numbers_in(answer.value())) {
    if (auto done = complete(library, number, route, choice.gear.facts, dialog); auto* errors = done.refused())
      return std::move(*errors);
    shelf.push_back(library.find(number)->reading.tool);
  }
  return shelf;
}

}  // namespace

DoneOrErrors choose_tools(const Given& request, app::Dialog& dialog, Choice& choice) {
  const bool library_file = !request.tools.empty() && fs::path(request.tools).extension() != ".toml";
  if (!library_file && !request.said.empty())
    return usage("--tool says what a tool library does not, and --tools names none");
  if (!library_file && !request.unit.empty())
    return usage("--library-unit is the unit of a tool library, and --tools names none");
  if (const auto unit = app::read_length_unit("--library-unit", request.unit); !unit) return std::vector{unit.error()};
  const bool used = choice.wishes.route == proposal::Route::ball || choice.wishes.route == proposal::Route::line;
  if (request.tools.empty() || !used) return Ok{};
  if (!library_file) {
    auto read = job::read_job_file(request.tools);
    if (auto* errors = read.refused()) return std::move(*errors);
    choice.shelf = std::move(read.value().tools);
    return Ok{};
  }
  auto opened = open_library(request);
  if (auto* errors = opened.refused()) return std::move(*errors);
  LibraryShelf& library = opened.value();
  const bool any = !library.candidates(*choice.wishes.route, choice.gear.facts).empty();
  choice.shelf = library.whole();
  if (dialog.asks() && any) {
    auto asked = ask_for_tools(library, choice, dialog);
    if (auto* errors = asked.refused()) return std::move(*errors);
    choice.shelf = std::move(asked.value());
  }
  if (!any) {
    const proposal::BallLimit limit = proposal::ball_limit(choice.gear);
    return std::vector{fail_as(DiagnosticKind::refused_input,
                               "{}: {} has no {} that reaches the root of the tooth spaces, at most {:.3f} mm wide and "
                               "{:.2f} mm deep; {} takes "
                               "a larger ball{}",
                               limit.option, request.tools,
                               choice.wishes.route == proposal::Route::line ? "tapered ball mill" : "ball mill",
                               choice.gear.facts.most_finishing_mm(), choice.gear.facts.depth, limit.larger,
                               printable(reasons(library, choice)))};
  }
  const auto draft = proposal::draft_of(request.name, choice.wishes, choice.machine, choice.gear, choice.shelf, 0);
  if (const std::string lacks = lacking(library, choice); !lacks.empty() && (choice.shelf.empty() || !draft))
    return usage(
        fmt::format("--tools: {} does not say all of its tools that would do: {}; say it with --tool, as "
                    "--tool \"NUMBER: KEY = VALUE, KEY = VALUE\"",
                    request.tools, printable(lacks)));
  std::error_code error;
  const fs::path from = fs::path(request.file).parent_path(),
                 near = fs::proximate(request.tools, from.empty() ? "." : from, error);
  if (error)
    return std::vector{Diagnostic{DiagnosticKind::file_access,
                                  {request.tools, 0, 0},
                                  "where it lies, seen from the job, is not known: " + error.message()}};
  if (auto named = can_be_named("--tools", near.string()); !named) return std::vector{named.error()};
  choice.library = library.words(near.string());
  return Ok{};
}

}  // namespace toothpath::questions
