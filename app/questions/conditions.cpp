#include <fmt/ranges.h>

#include <algorithm>

#include "app/base/option_number.h"
#include "app/proposal/material.h"
#include "app/questions/steps.h"
#include "geometry/base/printable.h"

namespace toothpath::questions {
namespace {

using app::Dialog;
using proposal::Quality;
using proposal::Route;
using proposal::Wishes;

std::vector<Diagnostic> refused(std::string message) {
  return {Diagnostic{DiagnosticKind::refused_input, {}, std::move(message)}};
}

/// Values of the machine that nobody measured: they are shown, and whoever asks on a terminal is asked for a word.
DoneOrErrors accept_assumed(const std::string& given, const proposal::ChosenMachine& machine, Dialog& dialog) {
  if (!machine.assumed) return Ok{};
  const std::string which = proposal::assumed_words(machine);
  dialog.tell({{"assumed in the machine file, measured by nobody", which}});
  const auto word = dialog.word("--accept-assumed", "make the program with these values, and say so on every page",
                                given.empty() && !dialog.asks() ? std::string(kYesNo[0]) : given, kYesNo);
  if (auto* errors = word.refused()) return *errors;
  if (word.value() == kYesNo[0]) return Ok{};
  return refused(
      fmt::format("--accept-assumed: {} has values that are assumed ({}): measure them, and leave them out of "
                  "`assumed` in its file",
                  machine.name, which));
}

/// "class 6", "12", "12 um".
Result<Quality> read_quality(std::string_view text) {
  constexpr std::string_view kClass = "class", kUnit = "um";
  const auto trimmed = [](std::string_view part) {
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    return part;
  };
  Quality quality;
  if (text.starts_with(kClass)) {
    const auto number = app::read_whole_number("class", trimmed(text.substr(kClass.size())), proposal::kIsoClass);
    if (!number) return number.error();
    quality.iso_class = *number;
    return quality;
  }
  if (text.ends_with(kUnit)) text = trimmed(text.substr(0, text.size() - kUnit.size()));
  const auto number = app::read_number("tolerance", text, proposal::kTolerance);
  if (!number) return number.error();
  quality.tolerance_um = *number;
  return quality;
}

DoneOrErrors wish_quality(Wishes& wishes, const Given& request, Dialog& dialog) {
  if (request.iso_class && request.tolerance_um)
    return usage("--class and --tolerance say the same of a gear: give one of the two");
  wishes.quality = {request.iso_class, request.tolerance_um};
  if (wishes.quality.said() || !dialog.asks()) return Ok{};
  const auto judge = [](const std::string& answer) -> std::optional<std::string> {
    const auto read = read_quality(answer);
    return read ? std::nullopt : std::optional(read.error().message + ", or a class: \"class 6\"");
  };
  const auto answer = dialog.text("--tolerance", "form of the flanks: tolerance in um, or \"class 6\" of ISO 1328-1",
                                  fmt::format("{:g}", proposal::kUsualTolerance), judge);
  if (auto* errors = answer.refused()) return *errors;
  wishes.quality = *read_quality(answer.value());
  return Ok{};
}

/// One that the control can switch on.
DoneOrErrors wish_coolant(Wishes& wishes, const std::string& given, const proposal::ChosenMachine& machine,
                          Dialog& dialog) {
  std::vector<std::string_view> words = {to_string(machines::Coolant::off)};
  for (const machines::Coolant coolant : machine.coolants) words.emplace_back(to_string(coolant));
  if (given.empty() && (!dialog.asks() || words.size() == 1)) return Ok{};
  if (!given.empty() && std::find(words.begin(), words.end(), given) == words.end())
    return usage(fmt::format("--coolant = {}: {} has {}", printable(given), machine.name, fmt::join(words, ", ")));
  const auto word = dialog.word("--coolant", "coolant", given, words);
  if (auto* errors = word.refused()) return *errors;
  if (word.value() != words.front()) wishes.coolant = word.value();
  return Ok{};
}

/// Forces follow from it; without a terminal nothing is said of it.
DoneOrErrors wish_material(Wishes& wishes, const std::string& given, Dialog& dialog) {
  if (given.empty() && !dialog.asks()) return Ok{};
  const auto word = dialog.word("--material", "material of the part", given, proposal::material_words());
  if (auto* errors = word.refused()) return *errors;
  wishes.material = word.value();
  return Ok{};
}

constexpr const char* kAnyHeight = "any";

/// How high the blank is clamped.
DoneOrErrors wish_blank_top(Wishes& wishes, const std::optional<double>& given, const proposal::ChosenMachine& machine,
                            Dialog& dialog) {
  if (wishes.route == Route::finger) {
    if (given) return usage("--blank-top does not belong to --cut finger");
    return Ok{};
  }
  if (given && !machine.table_top_mm)
    return usage(
        fmt::format("--blank-top counts from the face of the table, and {} states none: say table_face in its "
                    "file",
                    machine.name));
  wishes.blank_top_mm = given;
  if (given || !dialog.asks() || !machine.table_top_mm) return Ok{};
  dialog.tell({{"face of the table", fmt::format("machine Z {:g} mm", *machine.table_top_mm)}});
  const auto read = [](const std::string& answer) { return app::read_number("height", answer, kBlankTop); };
  const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
    if (answer == kAnyHeight) return std::nullopt;
    const auto height = read(answer);
    return height ? std::nullopt : std::optional(height.error().message + fmt::format(", or \"{}\"", kAnyHeight));
  };
  const auto answer =
      dialog.text("--blank-top", "top of the blank above the face of the table, mm; any: where the travels have room",
                  std::string(kAnyHeight), judge);
  if (auto* errors = answer.refused()) return *errors;
  if (answer.value() != kAnyHeight) wishes.blank_top_mm = *read(answer.value());
  return Ok{};
}

}  // namespace

DoneOrErrors wish_conditions(Wishes& wishes, const Given& request, Dialog& dialog,
                             const proposal::ChosenMachine& machine) {
  if (auto done = accept_assumed(request.accept_assumed, machine, dialog); done.refused()) return done;
  if (wishes.route == Route::shaped) {
    for (const auto& [option, given] : {std::pair("--class", request.iso_class.has_value()),
                                        {"--tolerance", request.tolerance_um.has_value()},
                                        {"--coolant", !request.coolant.empty()},
                                        {"--material", !request.material.empty()},
                                        {"--blank-top", request.blank_top_mm.has_value()}})
      if (given) return usage(fmt::format("{} does not belong to --cut shaped", option));
    return Ok{};
  }
  if (auto done = wish_quality(wishes, request, dialog); done.refused()) return done;
  if (auto done = wish_material(wishes, request.material, dialog); done.refused()) return done;
  if (auto done = wish_coolant(wishes, request.coolant, machine, dialog); done.refused()) return done;
  return wish_blank_top(wishes, request.blank_top_mm, machine, dialog);
}

}  // namespace toothpath::questions
