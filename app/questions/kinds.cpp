#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/questions/steps.h"
#include "app/rexs/gears.h"
#include "geometry/base/printable.h"
#include "machines/machine_file.h"

namespace toothpath::questions {
namespace {

using app::Dialog;
using proposal::Quantity;
using proposal::Wishes;
namespace fs = std::filesystem;

/// Machine files by the words of a job, without their ending: those in a folder that can be used, installed ones.
std::vector<std::string> machine_names(std::span<const std::string> files, const std::string& folder, bool shaper) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const auto path = machines::find_machine_file(file, folder);
    const auto opened = path ? machines::open_machine_file(*path) : Result<machines::MachineFileText>(path.error());
    if (opened && (opened->kind == machines::MachineKind::gear_shaper) == shaper)
      names.push_back(fs::path(file).stem().string());
  }
  return names;
}

/// The TOML files in the folder of the job, in order.
std::vector<std::string> files_beside(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".toml" && at->is_regular_file(error))
      files.push_back(at->path().filename().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// One's own machine first; there is no default: a program for another machine is no help.
DoneOrErrors ask_machine(Wishes& wishes, const Given& request, Dialog& dialog) {
  const bool shaper = wishes.route == proposal::Route::shaped;
  const fs::path parent = fs::path(request.file).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  const std::vector<std::string> own = machine_names(files_beside(folder), folder, shaper),
                                 installed = machine_names(machines::installed_machines(), ".", shaper);
  if (!dialog.asks())
    return usage(
        fmt::format("--machine is missing: machine; a machine file, or one of {}", fmt::join(installed, ", ")));
  if (!own.empty()) dialog.tell({{"machines beside the job", fmt::format("{}", fmt::join(own, ", "))}});
  dialog.tell({{"machines that come with Toothpath", fmt::format("{}", fmt::join(installed, ", "))}});
  const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
    if (const auto named = can_be_named("--machine", answer); !named) return named.error().message;
    Wishes tried = wishes;
    tried.machine = answer;
    const auto machine = proposal::choose_machine(tried, parent.string());
    const auto* errors = machine.refused();
    if (!errors) return std::nullopt;
    const Diagnostic& first = errors->front();
    return first.position.file.empty() ? first.message : first.text();
  };
  const auto machine = dialog.text("--machine", "machine: the name or the path of its file",
                                   own.size() == 1 ? std::optional(own.front()) : std::nullopt, judge);
  if (auto* errors = machine.refused()) return *errors;
  wishes.machine = machine.value();
  return Ok{};
}

/// The gear of a REXS file by its number, or the only one.
Expected<const rexs::Component*, std::vector<Diagnostic>> choose_component(const rexs::RexsFile& file,
                                                                           std::optional<int> number, Dialog& dialog) {
  const std::vector<const rexs::Component*> gears = rexs::gears_of(file);
  if (gears.empty())
    return std::vector{fail_at({file.file, 1, 1}, "no cylindrical_gear and no bevel_gear stands in this file")};
  std::vector<std::string> titles;
  for (const rexs::Component* gear : gears) titles.push_back(gear->title());
  const std::string all = fmt::format("{}", fmt::join(titles, ", "));
  const auto of = [&](int id) -> const rexs::Component* {
    const auto found = std::find_if(gears.begin(), gears.end(), [&](const auto* g) { return g->id == id; });
    return found == gears.end() ? nullptr : *found;
  };
  if (!number && gears.size() == 1) return gears.front();
  if (!number && dialog.asks()) {
    dialog.tell({{"gears of the file", all}});
    const auto answer = dialog.number({"--component", "number of the gear", kComponent, true}, {}, gears.front()->id);
    if (auto* errors = answer.refused()) return *errors;
    number = static_cast<int>(answer.value());
  }
  if (!number) return usage(fmt::format("--component is missing: {} has {}", printable(file.file), all));
  if (const rexs::Component* gear = of(*number)) return gear;
  return usage(fmt::format("--component = {} is no gear of {}: it has {}", *number, printable(file.file), all));
}

/// Asks what a REXS file leaves open.
DoneOrErrors answer_question(rexs::Open open, const std::string& why, Dialog& dialog, rexs::Said& said) {
  const bool left = open == rexs::Open::left_flank;
  const char* option = left ? "--left-flank" : "--ratio-of-roll";
  const auto& words = left ? kFlankWords : kRatioWords;
  if (!dialog.asks()) return usage(fmt::format("{} is missing, {} or {}: {}", option, words[0], words[1], why));
  dialog.tell({{option, why}});
  const auto word = dialog.word(option, left ? "the left flank of the file is" : "its ratio_of_roll is", "", words);
  if (auto* errors = word.refused()) return *errors;
  (left ? said.left_is_concave : said.work_per_cradle) = word.value() == words[0];
  return Ok{};
}

/// What the options say of a REXS file.
Expected<rexs::Said, std::vector<Diagnostic>> said_of_rexs(const Given& request) {
  rexs::Said said{{}, {}, request.dedendum, request.root_radius};
  const auto one = [](const char* option, const std::string& text, const auto& words,
                      std::optional<bool>& first) -> Status {
    if (text.empty()) return Ok{};
    if (std::find(words.begin(), words.end(), text) == words.end())
      return fail_as(DiagnosticKind::usage, "{} = {} is neither {} nor {}", option, printable(text), words[0],
                     words[1]);
    first = text == words[0];
    return Ok{};
  };
  if (auto told = one("--left-flank", request.left_flank, kFlankWords, said.left_is_concave); !told)
    return std::vector{told.error()};
  if (auto told = one("--ratio-of-roll", request.ratio_of_roll, kRatioWords, said.work_per_cradle); !told)
    return std::vector{told.error()};
  return said;
}

/// The gear of --rexs.
Expected<Wishes, std::vector<Diagnostic>> gear_of_rexs(const Given& request, Dialog& dialog, proposal::Told& notes) {
  auto told = said_of_rexs(request);
  if (auto* errors = told.refused()) return std::move(*errors);
  rexs::Said& said = told.value();
  const auto file = rexs::read_rexs(request.rexs);
  if (!file) return std::vector{file.error()};
  const auto gear = choose_component(*file, request.component, dialog);
  if (auto* errors = gear.refused()) return *errors;
  while (true) {
    auto made = rexs::gear_of(*file, *gear.value(), said);
    if (auto* obstacles = made.refused()) {
      if (!obstacles->errors.empty()) return std::move(obstacles->errors);
      const auto& [open, why] = obstacles->questions.front();
      if (auto asked = answer_question(open, why, dialog, said); auto* errors = asked.refused())
        return std::move(*errors);
      continue;
    }
    notes = {{"gear of the file", gear.value()->title()}};
    if (const auto& out = made.value().left_out; !out.empty())
      notes.emplace_back("not taken over", fmt::format("{}", fmt::join(out, ", ")));
    Wishes wishes;
    if (auto* cylinder = std::get_if<cylindrical::CylindricalParameters>(&made.value().gear)) {
      wishes.gear = proposal::Gear::cylindrical;
      wishes.cylinder = std::make_shared<const cylindrical::CylindricalParameters>(std::move(*cylinder));
    } else {
      wishes.gear = proposal::Gear::spiral_bevel;
      wishes.spiral = std::make_shared<const spiral_bevel::SpiralBevelParameters>(
          std::get<spiral_bevel::SpiralBevelParameters>(std::move(made.value().gear)));
    }
    dialog.tell(notes);
    return wishes;
  }
}

Dialog::Answer<std::string> ask_gear(const Given& request, Dialog& dialog) {
  const bool by_points = request.gear.empty() && !request.points.empty();
  return dialog.word("--gear", "kind of gear",
                     by_points ? std::string(word_of(proposal::Gear::flank_grid)) : request.gear,
                     proposal::gear_words());
}

/// Kind of gear, and all of one that stands in a file.
Expected<Wishes, std::vector<Diagnostic>> gear_wished(const Given& request, Dialog& dialog, proposal::Told& notes) {
  using Given = std::vector<std::pair<const char*, bool>>;
  const Given by_points = {{"--points", !request.points.empty()},
                           {"--points-unit", !request.points_unit.empty()},
                           {"--root", !request.root.empty()},
                           {"--tip", !request.tip.empty()}};
  const auto belong = [](const char* to, const Given& options) {
    for (const auto& [option, given] : options)
      if (given) return usage(fmt::format("{} does not belong {}", option, to));
    return std::vector<Diagnostic>();
  };
  if (!request.rexs.empty()) {
    auto wishes = gear_of_rexs(request, dialog, notes);
    if (wishes.refused()) return wishes;
    if (!request.gear.empty() && request.gear != word_of(*wishes.value().gear))
      return usage(
          fmt::format("--gear {}: that of --rexs is {}", printable(request.gear), word_of(*wishes.value().gear)));
    if (auto errors = belong("to --rexs", by_points); !errors.empty()) return errors;
    if (auto errors = belong("to --rexs, whose file says it", {{"--hand", !request.hand.empty()}}); !errors.empty())
      return errors;
    return wishes;
  }
  if (auto errors = belong("to a job without --rexs", {{"--component", request.component.has_value()},
                                                       {"--left-flank", !request.left_flank.empty()},
                                                       {"--ratio-of-roll", !request.ratio_of_roll.empty()},
                                                       {"--dedendum-coefficient", request.dedendum.has_value()},
                                                       {"--root-radius-coefficient", request.root_radius.has_value()}});
      !errors.empty())
    return errors;
  Wishes wishes;
  const auto gear = ask_gear(request, dialog);
  if (auto* errors = gear.refused()) return *errors;
  wishes.gear = proposal::gear_of(gear.value());
  if (!has_hand(*wishes.gear))
    if (auto errors = belong(fmt::format("to --gear {}", gear.value()).c_str(), {{"--hand", !request.hand.empty()}});
        !errors.empty())
      return errors;
  if (wishes.gear != proposal::Gear::flank_grid)
    if (auto errors = belong(fmt::format("to --gear {}", gear.value()).c_str(), by_points); !errors.empty())
      return errors;
  return wishes;
}

}  // namespace

Expected<proposal::Wishes, std::vector<Diagnostic>> kinds_wished(const Given& request, app::Dialog& dialog,
                                                                 proposal::Told& notes) {
  auto wished = gear_wished(request, dialog, notes);
  if (wished.refused()) return wished;
  Wishes wishes = std::move(wished.value());
  std::vector<std::string_view> routes;
  for (const proposal::Route route : proposal::routes_of(*wishes.gear)) routes.push_back(word_of(route));
  const std::string given = request.route.empty() && !dialog.asks() ? std::string(routes.front()) : request.route;
  const auto route = dialog.word("--cut", "how it is cut", given, routes);
  if (auto* errors = route.refused()) return *errors;
  wishes.route = proposal::route_of(route.value());
  wishes.machine = request.machine;
  if (wishes.machine.empty())
    if (auto asked = ask_machine(wishes, request, dialog); auto* errors = asked.refused()) return std::move(*errors);
  return wishes;
}

std::vector<Diagnostic> missing_in(const Given& request, app::Dialog& dialog) {
  std::vector<Diagnostic> all;
  const auto add = [&](std::vector<Diagnostic> errors) { all.insert(all.end(), errors.begin(), errors.end()); };
  std::optional<proposal::Gear> gear;
  if (request.rexs.empty()) {
    const auto word = ask_gear(request, dialog);
    if (const auto* errors = word.refused()) add(*errors);
    else gear = proposal::gear_of(word.value());
  }
  Wishes wishes;
  wishes.route = proposal::route_of(request.route);
  if (request.machine.empty())
    if (const auto asked = ask_machine(wishes, request, dialog); const auto* errors = asked.refused()) add(*errors);
  if (!gear) return all;
  if (gear == proposal::Gear::flank_grid && request.points.empty())
    add(usage("--points is missing: a file with the points of both flanks of one space"));
  const auto said = [&](Quantity q) {
    const auto at = static_cast<std::size_t>(q);
    return request.whole[at].has_value() || request.numbers[at].has_value();
  };
  const bool by_cone = said(Quantity::cone_distance) || said(Quantity::mean_cone_distance);
  for (const proposal::Question& q : proposal::questions()) {
    if (!belongs(q, *gear) || !only_the_user_knows(q.what) || stands_for_another(q.what) || said(q.what)) continue;
    if (q.what == Quantity::module && by_cone) continue;
    const auto asked = dialog.number({q.option, q.text, q.range, q.whole}, {}, {});
    if (const auto* errors = asked.refused()) add(*errors);
  }
  return all;
}

}  // namespace toothpath::questions
