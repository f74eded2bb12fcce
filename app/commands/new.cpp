// `toothpath new`: a job for a gear and a machine, asked for on a terminal or said by options, proven before it is
// written.
#include <fcntl.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/base/dialog.h"
#include "app/base/interruption.h"
#include "app/base/kept_answers.h"
#include "app/base/new_file.h"
#include "app/base/option_number.h"
#include "app/commands/run.h"
#include "app/commands/shaper.h"
#include "app/job/file.h"
#include "app/job/flank_points.h"
#include "app/job/job.h"
#include "app/job/loose_points.h"
#include "app/proposal/explanations.h"
#include "app/proposal/gear_limits.h"
#include "app/proposal/library_shelf.h"
#include "app/proposal/points_gear.h"
#include "app/proposal/propose.h"
#include "app/rexs/gears.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"
#include "machines/machine_file.h"

namespace toothpath::commands {
namespace {

namespace fs = std::filesystem;
using app::Dialog;
using proposal::LibraryShelf;
using proposal::Quantity;
using proposal::Question;
using proposal::Wishes;

struct NewRequest : CommonRequest {
  std::string gear, route, machine, tools, unit, file, name;
  std::string points, points_unit, root, tip;  ///< of a gear by points
  std::string rexs, left_flank, ratio_of_roll;
  std::string hand;  ///< of a spiral bevel gear by a drawing, of the inner half of a herringbone
  bool with_mate = false, resume = false;
  std::optional<int> component;
  std::optional<double> dedendum, root_radius;
  std::vector<std::string> said;  ///< of tools: "12: stick_out = 40"
  std::array<std::optional<double>, proposal::kQuantities> numbers;
  std::array<std::optional<int>, proposal::kQuantities> whole;
};

std::vector<Diagnostic> usage(std::string message) {
  return {Diagnostic{DiagnosticKind::usage, {}, std::move(message)}};
}

constexpr toml::Range kComponent{0, 1e9};
constexpr toml::Range kRackCoefficient{0, 3};

using DoneOrErrors = Expected<Ok, std::vector<Diagnostic>>;

/// A job is UTF-8 and its texts are visible; names of files may be any bytes.
Status can_be_named(const char* option, const std::string& text) {
  if (printable(text) == text) return Ok{};
  return fail_at({text, 0, 0},
                 "{}: a job cannot name it: there are bytes in it that are not UTF-8, or signs that cannot "
                 "be seen; give it another name",
                 option);
}

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
DoneOrErrors ask_machine(Wishes& wishes, const NewRequest& request, Dialog& dialog) {
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

/// Gears of whose pair one is left-hand and the other right-hand.
bool has_hand(proposal::Gear gear) {
  return gear == proposal::Gear::spiral_bevel || gear == proposal::Gear::bevel_herringbone;
}

constexpr std::array<std::string_view, 2> kHandWords = {"left", "right"};
constexpr std::array<std::string_view, 2> kFlankWords = {"concave", "convex"};
constexpr std::array<std::string_view, 2> kRatioWords = {"work_per_cradle", "cradle_per_work"};

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
Expected<rexs::Said, std::vector<Diagnostic>> said_of_rexs(const NewRequest& request) {
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
Expected<Wishes, std::vector<Diagnostic>> gear_of_rexs(const NewRequest& request, Dialog& dialog,
                                                       proposal::Told& notes) {
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

/// Kind of gear, and all of one that stands in a file.
Expected<Wishes, std::vector<Diagnostic>> gear_wished(const NewRequest& request, Dialog& dialog,
                                                      proposal::Told& notes) {
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
  const auto gear = dialog.word(
      "--gear", "kind of gear",
      request.gear.empty() && !request.points.empty() ? std::string(word_of(proposal::Gear::flank_grid)) : request.gear,
      proposal::gear_words());
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

/// Kind of gear, how it is cut and on which machine.
Expected<Wishes, std::vector<Diagnostic>> kinds_wished(const NewRequest& request, Dialog& dialog,
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

/// What is proposed, as far as the machine turns it.
std::optional<double> proposed_number(const Question& question, const Wishes& wishes,
                                      const proposal::ChosenMachine& machine) {
  auto proposed = proposal::proposed(question.what, wishes);
  if (proposed && question.what == Quantity::outer && machine.mill)
    proposed = std::min(*proposed, 0.5 * machine.mill->largest_part_mm());
  return proposed;
}

/// Asks until the machine turns the gear as far as its diameter is known.
DoneOrErrors wish_number(Wishes& wishes, const Question& question, std::optional<double> given, Dialog& dialog,
                         const proposal::ChosenMachine& machine) {
  const auto proposed = proposed_number(question, wishes, machine);
  const bool ends = question.what == Quantity::inner || question.what == Quantity::outer;
  if (ends && !proposed && !given)
    return std::vector{Diagnostic{DiagnosticKind::refused_input,
                                  {},
                                  "no tooth has room with these numbers: its teeth are undercut where they are not "
                                  "pointed; fewer teeth of the shaper, or less helix angle, would help"}};
  while (true) {
    const auto answer =
        dialog.number({question.option, question.text, question.range, question.whole}, given, proposed);
    if (auto* errors = answer.refused()) return *errors;
    const auto before = proposal::least_swing_mm(wishes);
    wishes[question.what] = answer.value();
    const auto swing = proposal::least_swing_mm(wishes);
    if (!swing || swing == before) return Ok{};
    if (question.what == Quantity::outer || wishes.gear == proposal::Gear::bevel_herringbone ||
        wishes.gear == proposal::Gear::straight_bevel)
      dialog.tell(proposal::swing_of(machine, *swing));
    const Status turns = proposal::check_swing(machine, *swing);
    if (turns) return Ok{};
    if (given || !dialog.asks() || !ends) return std::vector{turns.error()};
    dialog.tell({{"too large", turns.error().message}});
    dialog.forget(question.option);
    wishes[question.what].reset();
  }
}

/// The points of --points, or of a file that is asked for.
Expected<proposal::PointsOfFile, std::vector<Diagnostic>> choose_points(const NewRequest& request, Dialog& dialog) {
  const auto unit = app::read_length_unit("--points-unit", request.points_unit);
  if (!unit) return std::vector{unit.error()};
  std::string file = request.points;
  if (file.empty() && !dialog.asks())
    return usage("--points is missing: a file with the points of both flanks of one space");
  if (file.empty()) {
    const auto judge = [](const std::string& answer) -> std::optional<std::string> {
      return answer.empty() ? std::optional<std::string>("the name of a file is needed") : std::nullopt;
    };
    const auto answer = dialog.text("--points", "file with the points of both flanks of one space", {}, judge);
    if (auto* errors = answer.refused()) return *errors;
    file = answer.value();
  }
  auto read = proposal::read_points(file, *unit);
  if (!read) return std::vector{read.error()};
  return std::move(*read);
}

/// The unit of points that are small in mm and state none: asked for, never guessed.
DoneOrErrors ask_unit(proposal::PointsOfFile& points, double teeth, Dialog& dialog) {
  const auto why = proposal::looks_like_inches(points, teeth);
  if (!why) return Ok{};
  if (!dialog.asks()) return usage(fmt::format("--points-unit is missing, mm or inch: {}", *why));
  dialog.tell({{"unit of the points", *why}});
  const auto word = dialog.word("--points-unit", "unit of x, y and z", "", app::kLengthUnits);
  if (auto* errors = word.refused()) return *errors;
  auto read = proposal::read_points(points.file, mm_of_unit(word.value()));
  if (!read) return std::vector{read.error()};
  points = std::move(*read);
  return Ok{};
}

/// A meridian as an option says it; asked for, with what follows from the points.
Expected<std::vector<Vec2>, std::vector<Diagnostic>> ask_meridian(const char* option, const char* text,
                                                                  const std::string& given,
                                                                  const std::vector<Vec2>& proposed, Dialog& dialog) {
  std::string said = given;
  if (said.empty() && !dialog.asks()) return proposed;
  if (said.empty()) {
    const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
      const auto read = proposal::read_meridian(option, answer);
      return read ? std::nullopt : std::optional(read.error().message);
    };
    const auto answer = dialog.text(option, text, proposal::meridian_text(proposed), judge);
    if (auto* errors = answer.refused()) return *errors;
    said = answer.value();
  }
  const auto read = proposal::read_meridian(option, said);
  if (!read) return std::vector{read.error()};
  return *read;
}

/// Tip and root of a gear by points, behind its teeth and ahead of its fillet.
DoneOrErrors wish_meridians(Wishes& wishes, proposal::PointsOfFile& points, const NewRequest& request, Dialog& dialog) {
  const double teeth = wishes.at(Quantity::teeth);
  if (auto asked = ask_unit(points, teeth, dialog); asked.refused()) return asked;
  const flank_grid::MeridianProposal meridians(points.points);
  flank_grid::FlankGridParameters grid;
  grid.teeth = static_cast<int>(teeth);
  grid.file = points.file;
  grid.plus = points.points.plus;
  grid.minus = points.points.minus;
  auto tip =
      ask_meridian("--tip", "tip surface in the meridian, [r, z] at both ends", request.tip, meridians.tip(), dialog);
  if (auto* errors = tip.refused()) return std::move(*errors);
  grid.tip = std::move(tip.value());
  const auto fillet = request.numbers[static_cast<std::size_t>(Quantity::fillet_radius)];
  auto root = ask_meridian("--root", "root surface in the meridian, [r, z] at both ends", request.root,
                           meridians.root(fillet.value_or(proposal::proposed_fillet_mm(meridians, teeth))), dialog);
  if (auto* errors = root.refused()) return std::move(*errors);
  grid.root = std::move(root.value());
  wishes.grid = std::make_shared<const flank_grid::FlankGridParameters>(std::move(grid));
  return Ok{};
}

constexpr double kSameDistance = 0.005;  // mm: both cone distances of a drawing

/// Transverse, at the large end.
std::optional<double> module_of(const Wishes& wishes, double outer_cone_distance) {
  return 2 * outer_cone_distance * std::sin(spiral_bevel::pitch_angle(proposal::drawing_of(wishes))) /
         wishes.at(Quantity::teeth);
}

/// What a drawing says of a spiral bevel gear instead of a question: a pitch angle of the shafts, a cone distance of
/// the module.
Expected<std::optional<double>, std::vector<Diagnostic>> given_by_drawing(Quantity what,
                                                                          const std::optional<double>& given,
                                                                          const Wishes& wishes,
                                                                          const NewRequest& request) {
  const auto said = [&](Quantity q) { return request.numbers[static_cast<std::size_t>(q)]; };
  const auto twice = [&](const char* one, const char* other) {
    return usage(fmt::format("{} and {} say the same of a gear: give one of the two", one, other));
  };
  if (what == Quantity::shaft_angle) {
    const auto pitch = said(Quantity::pitch_angle);
    if (!pitch) return given;
    if (given) return twice("--pitch-angle", "--shaft-angle");
    const double ratio = wishes.at(Quantity::mate_teeth) / wishes.at(Quantity::teeth);
    const auto shafts = spiral_bevel::shaft_angle_of(radians(*pitch), ratio);
    if (!shafts)
      return std::vector{
          fail_as(DiagnosticKind::refused_input,
                  "--pitch-angle = {:g} deg is not below {:.4f} deg: no cone of the mate with {:g} teeth "
                  "fits it",
                  *pitch, degrees(std::asin(1 / ratio)), wishes.at(Quantity::mate_teeth))};
    return std::optional(degrees(*shafts));
  }
  const auto outer = said(Quantity::cone_distance), mean = said(Quantity::mean_cone_distance),
             width = said(Quantity::face_width);
  if (what != Quantity::module || (!outer && !mean)) return given;
  if (outer && mean && width && std::abs(*outer - 0.5 * *width - *mean) <= kSameDistance)
    return module_of(wishes, *outer);
  if (outer && mean) return twice("--cone-distance", "--mean-cone-distance");
  if (given) return twice("--module", outer ? "--cone-distance" : "--mean-cone-distance");
  if (outer) return module_of(wishes, *outer);
  if (!width) return usage("--face-width is missing: the outer cone distance is --mean-cone-distance and half of it");
  return module_of(wishes, *mean + 0.5 * *width);
}

/// Without a terminal pinions are left-hand and wheels right-hand.
DoneOrErrors wish_hand(Wishes& wishes, const std::string& given, Dialog& dialog) {
  const bool pinion = wishes.at(Quantity::teeth) <= wishes.at(Quantity::mate_teeth);
  const auto word =
      dialog.word("--hand",
                  wishes.gear == proposal::Gear::bevel_herringbone ? "hand of its inner half; its mate has the other"
                                                                   : "hand of its spiral; its mate has the other",
                  given.empty() && !dialog.asks() ? std::string(kHandWords[pinion ? 0 : 1]) : given, kHandWords);
  if (auto* errors = word.refused()) return *errors;
  wishes.hand = word.value() == kHandWords[0] ? -1 : 1;
  return Ok{};
}

/// All numbers of the gear, each with the limits that are known before it.
DoneOrErrors wish_numbers(Wishes& wishes, const NewRequest& request, Dialog& dialog,
                          const proposal::ChosenMachine& machine) {
  if (wishes.whole()) {
    for (const Question& question : proposal::questions())
      if (const auto at = static_cast<std::size_t>(question.what); request.whole[at] || request.numbers[at])
        return usage(fmt::format("{} does not belong to --rexs, whose file says it", question.option));
    return Ok{};
  }
  const bool by_points = wishes.gear == proposal::Gear::flank_grid;
  std::optional<proposal::PointsOfFile> points;
  if (by_points) {
    auto read = choose_points(request, dialog);
    if (auto* errors = read.refused()) return std::move(*errors);
    points = std::move(read.value());
  }
  for (const Question& question : proposal::questions()) {
    const auto at = static_cast<std::size_t>(question.what);
    const auto given =
        question.whole && request.whole[at] ? std::optional<double>(*request.whole[at]) : request.numbers[at];
    if (!belongs(question, *wishes.gear)) {
      if (given) return usage(fmt::format("{} does not belong to --gear {}", question.option, word_of(*wishes.gear)));
      continue;
    }
    if (proposal::stands_for_another(question.what)) continue;
    if (question.what == Quantity::inner) {
      dialog.tell(limits_of(wishes));
      if (machine.mill)
        dialog.tell({{"outer end that turns on " + machine.name,
                      fmt::format("up to {:g} mm", 0.5 * machine.mill->largest_part_mm())}});
    }
    if (question.what == Quantity::fillet_radius)
      if (auto asked = wish_meridians(wishes, *points, request, dialog); asked.refused()) return asked;
    auto said = given_by_drawing(question.what, given, wishes, request);
    if (auto* errors = said.refused()) return std::move(*errors);
    if (auto asked = wish_number(wishes, question, said.value(), dialog, machine); asked.refused()) return asked;
  }
  if (has_hand(*wishes.gear)) return wish_hand(wishes, request.hand, dialog);
  if (!by_points) return Ok{};
  flank_grid::FlankGridParameters grid = *wishes.grid;
  grid.fillet_radius_mm = wishes.at(Quantity::fillet_radius);
  grid.bore_diameter_mm = wishes.at(Quantity::bore);
  wishes.grid = std::make_shared<const flank_grid::FlankGridParameters>(std::move(grid));
  return Ok{};
}

/// A folder of its own that goes with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const char* told = std::getenv("TMPDIR");
    const std::string place = told && *told ? told : "/tmp";
    path_ = place + "/toothpath-new-XXXXXX";
    if (::mkdtemp(path_.data())) {
      (void)app::register_temporary(AT_FDCWD, path_, true);
    } else {
      error_ = errno;
      path_ = place;
    }
  }
  ~TemporaryFolder() {
    if (error_ != 0) return;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    app::forget_temporary(AT_FDCWD, path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }  ///< where it is not there, of its parent
  [[nodiscard]] int error() const { return error_; }               ///< why it is not there, as in errno

 private:
  std::string path_;
  int error_ = 0;
};

/// The job as `run` or `shaper` finds it.
CommandOutcome prove(const app::UnnamedFile& job, const std::string& text, bool shaped, bool quiet) {
  const TemporaryFolder folder;
  if (folder.error() != 0)
    return failed(Diagnostic{DiagnosticKind::file_access,
                             {folder.path(), 0, 0},
                             fmt::format("cannot make a folder in which the job is tried: {}; name a place that can "
                                         "be written in TMPDIR",
                                         std::strerror(folder.error()))});
  if (const auto written = job.write(text); !written) return failed(written.error());
  RunRequest request;
  request.job_file = job.path();
  request.out_dir = folder.path() + "/out";
  request.quiet = quiet;
  return shaped ? run_shaper(request) : run_job(request);
}

struct Proposed {
  proposal::Draft draft;
  std::string text;
  CommandOutcome proof;
};

bool is_verified(const Expected<Proposed, std::vector<Diagnostic>>& proposed) {
  return proposed && proposed.value().proof.exit_code == app::ExitCode::ok;
}

/// What a job is made from.
struct Choice {
  Wishes wishes;
  proposal::Told notes;  ///< of a gear that stands in a file
  proposal::ChosenMachine machine;
  proposal::ChosenGear gear;
  proposal::Shelf shelf;           ///< empty: standard sizes
  proposal::LibraryWords library;  ///< of the tools, where they stand in one
};

/// Of the schema of jobs, for editors.
std::string schema_url() {
  const std::string path = machines::schema_file("job.schema.json");
  if (path.empty()) return {};
  std::string url = "file://";
  for (const char c : fs::path(path).lexically_normal().string()) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::string_view("/-._~").find(c) != std::string_view::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

/// The first way that is verified, else the last that was tried.
Expected<Proposed, std::vector<Diagnostic>> propose(const NewRequest& request, const Choice& choice) {
  std::optional<Proposed> last;
  std::vector<Diagnostic> refused;
  const bool shaped = choice.wishes.route == proposal::Route::shaped;
  const app::UnnamedFile job(request.file);
  for (int attempt = 0; attempt < proposal::kAttempts; ++attempt) {
    auto draft = proposal::draft_of(request.name, choice.wishes, choice.machine, choice.gear, choice.shelf, attempt);
    if (!draft) {
      if (refused.empty()) refused.push_back(draft.error());
      continue;
    }
    const std::string text = job_text(*draft, choice.library, schema_url());
    last = Proposed{*draft, text, prove(job, text, shaped, request.quiet)};
    if (last->proof.exit_code == app::ExitCode::ok || last->proof.exit_code == app::ExitCode::interrupted || shaped)
      return std::move(*last);
  }
  if (!last) return refused;
  return std::move(*last);
}

CommandOutcome told(const NewRequest& request, const Proposed& proposed, const proposal::Told& limits) {
  CommandOutcome outcome;
  outcome.exit_code = proposed.proof.exit_code;
  std::string out = request.file + "\n";
  nlohmann::ordered_json json = {{"schema", 1}, {"command", "new"}, {"file", request.file}, {"job", proposed.text}};
  if (const std::string& points = proposed.draft.wishes.points_file; !points.empty()) {
    json["points"] = points;
    out += fmt::format("  {:<40} {}\n", "its points, in order, beside it", points);
  }
  json["limits"] = nlohmann::ordered_json::object();
  for (const auto& [what, value] : limits) {
    out += fmt::format("  {:<40} {}\n", what, value);
    json["limits"][what] = value;
  }
  const bool verified = proposed.proof.exit_code == app::ExitCode::ok;
  json["verified"] = verified;
  json["proof"] = proposed.proof.report_json.empty() ? nlohmann::ordered_json()
                                                     : nlohmann::ordered_json::parse(proposed.proof.report_json);
  out += fmt::format("  {:<40} {}\n", "tried as it stands", verified ? "verified" : "NOT verified");
  if (!verified)
    for (const char* key : {"reasons", "would_help"})
      for (const auto& line : json["proof"].value(key, nlohmann::ordered_json::array()))
        out += fmt::format("    {} {}\n", std::string_view(key) == "reasons" ? "because   " : "would help",
                           line.get<std::string>());
  out += fmt::format("next: toothpath {} {} --out DIR\n",
                     proposed.draft.wishes.route == proposal::Route::shaped ? "shaper" : "run", request.file);
  outcome.summary = out;
  outcome.report_json = json_text(json, 2) + "\n";
  return outcome;
}

/// "stick_out (above 0 to 2000 mm), holder (..)".
std::string missing_text(const std::vector<job::MissingKey>& keys) {
  std::vector<std::string> all;
  for (const job::MissingKey& key : keys) all.push_back(fmt::format("{} ({})", key.key, job::shape_text(key.shape)));
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The library of --tools, with what --tool says beside it.
Expected<LibraryShelf, std::vector<Diagnostic>> open_library(const NewRequest& request) {
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

/// Asks for every key that a tool lacks.
DoneOrErrors complete(LibraryShelf& library, int number, proposal::Route route, Dialog& dialog) {
  while (!library.find(number)->whole()) {
    const LibraryShelf::Tool& tool = *library.find(number);
    const job::MissingKey key = LibraryShelf::missing(tool, route).front();
    const auto judge = [&](const std::string& answer) -> std::optional<std::string> {
      const auto& words = key.shape.words;
      if (!words.empty() && std::find(words.begin(), words.end(), answer) == words.end())
        return fmt::format("{} = \"{}\" is not {}", key.key, answer, job::shape_text(key.shape));
      const auto value = job::parse_tool_value(key.shape, answer);
      if (!value) return value.error().message;
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
  for (const auto* tool : candidates)
    told.emplace_back(tool->title(),
                      tool->whole() ? "whole" : "lacks " + missing_text(LibraryShelf::missing(*tool, route)));
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
    if (auto done = complete(library, number, route, dialog); auto* errors = done.refused()) return std::move(*errors);
    shelf.push_back(library.find(number)->reading.tool);
  }
  return shelf;
}

/// The tools of --tools: of a job, or of a file of another program.
DoneOrErrors choose_tools(const NewRequest& request, Dialog& dialog, Choice& choice) {
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
  const auto draft = proposal::draft_of(request.name, choice.wishes, choice.machine, choice.gear, choice.shelf, 0);
  if (const std::string lacks = lacking(library, choice); !lacks.empty() && (choice.shelf.empty() || !draft))
    return usage(
        fmt::format("--tools: {} does not say all of its tools that would do: {}; say it with --tool, as "
                    "--tool \"NUMBER: KEY = VALUE, KEY = VALUE\"",
                    request.tools, printable(lacks)));
  if (choice.shelf.empty())
    return usage(fmt::format("--tools: {} has no ball mill{} that fits the tooth spaces: {}", request.tools,
                             choice.wishes.route == proposal::Route::line ? " and no tapered ball mill" : "",
                             fmt::format("at most {:.3f} mm, flutes of at least {:.2f} mm",
                                         choice.gear.facts.most_finishing_mm(), choice.gear.facts.depth)));
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

/// All that is asked for, in its order.
Expected<Choice, std::vector<Diagnostic>> choose(const NewRequest& request, Dialog& dialog) {
  Choice choice;
  auto wished = kinds_wished(request, dialog, choice.notes);
  if (auto* errors = wished.refused()) return std::move(*errors);
  choice.wishes = std::move(wished.value());
  auto machine = proposal::choose_machine(choice.wishes, fs::path(request.file).parent_path().string());
  if (auto* errors = machine.refused()) return std::move(*errors);
  choice.machine = std::move(machine.value());
  dialog.tell(limits_of(choice.machine));
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

/// The ordered points of a gear beside its job: there while the job is tried, and afterwards where it is kept.
class PointsBesideJob {
 public:
  /// Nothing for gears that have no points. Errors: as of the job itself.
  Status write(const std::string& job, Wishes& wishes) {
    if (!wishes.grid) return Ok{};
    fs::path path(job);
    path.replace_filename(path.stem().string() + "_flanks.csv");
    wishes.points_file = path.filename().string();
    if (auto named = can_be_named("-o", wishes.points_file); !named) return named;
    if (auto fresh = app::check_new_file(path.string(), "-o"); !fresh) return fresh;
    auto written = app::write_new_file(path.string(), job::flank_points_text({wishes.grid->plus, wishes.grid->minus}));
    if (!written) return written;
    path_ = path.string();
    (void)app::register_temporary(AT_FDCWD, path_, false);
    return Ok{};
  }
  void keep() {
    if (!path_.empty()) app::forget_temporary(AT_FDCWD, path_);
    path_.clear();
  }
  PointsBesideJob() = default;
  ~PointsBesideJob() {
    if (path_.empty()) return;
    ::unlink(path_.c_str());
    app::forget_temporary(AT_FDCWD, path_);
  }
  PointsBesideJob(const PointsBesideJob&) = delete;
  PointsBesideJob& operator=(const PointsBesideJob&) = delete;

 private:
  std::string path_;
};

/// What the try refused, without places in a job that goes again.
std::vector<Diagnostic> without_places(std::vector<Diagnostic> errors) {
  for (Diagnostic& error : errors)
    if (error.kind != DiagnosticKind::file_access) error.position = {};
  return errors;
}

/// A job and what is told of it.
struct MadeJob {
  Proposed proposed;
  proposal::Told limits;
};

/// Tries ways to make the gear. Refused also: what `run` refuses of it, but for a program that is not verified.
Expected<MadeJob, std::vector<Diagnostic>> make_job(const NewRequest& request, Choice& choice, bool asks) {
  auto proposed = propose(request, choice);
  if (request.route.empty() && !asks && choice.wishes.route == proposal::Route::line && !is_verified(proposed)) {
    choice.wishes.route = proposal::Route::ball;  // nobody asked for the side of a mill
    if (auto other = propose(request, choice); is_verified(other)) proposed = std::move(other);
  }
  if (auto* errors = proposed.refused()) return std::move(*errors);
  CommandOutcome& proof = proposed.value().proof;
  if (proof.exit_code != app::ExitCode::ok && proof.exit_code != app::ExitCode::unverified)
    return without_places(std::move(proof.errors));
  proposal::Told limits = choice.notes;
  for (const auto& more : {limits_of(choice.wishes), limits_of(choice.gear),
                           limits_of(proposed.value().draft, choice.machine, choice.gear)})
    limits.insert(limits.end(), more.begin(), more.end());
  return MadeJob{std::move(proposed.value()), std::move(limits)};
}

/// Where the job of the mate goes: beside the other.
std::string mate_file(const std::string& file) {
  fs::path path(file);
  return path.replace_filename(path.stem().string() + "_mate" + path.extension().string()).string();
}

/// The other gear of a bevel pair: teeth exchanged, the other hand.
Expected<MadeJob, std::vector<Diagnostic>> make_mate(NewRequest request, const Choice& of, bool asks) {
  Choice choice = of;
  std::swap(choice.wishes[Quantity::teeth], choice.wishes[Quantity::mate_teeth]);
  choice.wishes.hand = -of.wishes.hand;
  request.file = mate_file(request.file), request.name += "_mate";
  auto gear = proposal::choose_gear(choice.wishes);
  if (auto* errors = gear.refused()) return std::move(*errors);
  choice.gear = std::move(gear.value());
  return make_job(request, choice, asks);
}

bool has_bevel_mate(const Wishes& wishes) {
  return wishes.gear == proposal::Gear::bevel_herringbone || wishes.gear == proposal::Gear::straight_bevel ||
         wishes.drawn();
}

/// Writes the job of the mate, and tells of both.
CommandOutcome with_mate(const NewRequest& request, CommandOutcome outcome, const MadeJob& mate) {
  NewRequest other = request;
  other.file = mate_file(request.file);
  if (auto written = app::write_new_file(other.file, mate.proposed.text); !written) return failed(written.error());
  const CommandOutcome more = told(other, mate.proposed, mate.limits);
  if (outcome.exit_code == app::ExitCode::ok) outcome.exit_code = more.exit_code;
  outcome.summary += more.summary + fmt::format("and of both: toothpath contact {} --mate {} --out DIR\n", request.file,
                                                fs::path(other.file).filename().string());
  auto json = nlohmann::ordered_json::parse(outcome.report_json);
  json["mate"] = nlohmann::ordered_json::parse(more.report_json);
  outcome.report_json = json_text(json, 2) + "\n";
  return outcome;
}

CommandOutcome make_and_write(const NewRequest& request, Choice& choice, bool asks) {
  if (request.with_mate && !has_bevel_mate(choice.wishes))
    return failed(usage("--with-mate: only bevel gears by their numbers have a mate of their own kind"));
  PointsBesideJob points;
  if (auto written = points.write(request.file, choice.wishes); !written) return failed(written.error());
  auto made = make_job(request, choice, asks);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  std::optional<MadeJob> mate;
  if (request.with_mate) {
    auto other = make_mate(request, choice, asks);
    if (auto* errors = other.refused()) {
      for (Diagnostic& error : *errors) error.message = "the mate: " + error.message;
      return failed(std::move(*errors));
    }
    mate = std::move(other.value());
  }
  if (auto written = app::write_new_file(request.file, made.value().proposed.text); !written)
    return failed(written.error());
  points.keep();
  CommandOutcome outcome = told(request, made.value().proposed, made.value().limits);
  return mate ? with_mate(request, std::move(outcome), *mate) : outcome;
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

/// Goes through the questions until they are answered, back and forth.
Expected<Choice, std::vector<Diagnostic>> choose_in_dialog(const NewRequest& request, Dialog& dialog) {
  while (true) {
    auto chosen = choose(request, dialog);
    auto* errors = chosen.refused();
    if (!errors) return chosen;
    if (dialog.went_back()) dialog.begin_again();
    else if (!dialog.asks() || !asked_again(*errors, dialog)) return chosen;
  }
}

CommandOutcome run_new(const NewRequest& asked) {
  NewRequest request = asked;
  if (request.file.empty()) return failed(usage("-o is missing: the job file to write"));
  std::vector<std::string> files = {request.file};
  if (request.with_mate) files.push_back(mate_file(request.file));
  for (const std::string& file : files)
    if (const auto fresh = app::check_new_file(file, "-o"); !fresh) return failed(fresh.error());
  if (request.name.empty()) request.name = fs::path(request.file).stem().string();
  for (const auto& [option, text] : {std::pair("--name", &request.name), {"--machine", &request.machine}})
    if (const auto named = can_be_named(option, *text); !named) return failed(named.error());
  const app::KeptAnswers kept(request.file);
  bool cannot_keep = false;
  Dialog dialog(request.quiet, proposal::explanation_of, [&](std::span<const app::SaidAnswer> said) {
    const auto written = kept.write(said);
    if (!written && !cannot_keep) dialog.tell({{"answers are not kept", written.error().text()}});
    cannot_keep = !written;
    app::set_state(written && !said.empty()
                       ? "the answers are kept in " + kept.path() + ": the same command with --resume goes on with them"
                       : "");
  });
  if (request.resume && !dialog.asks()) return failed(usage("--resume goes on with questions: it needs a terminal"));
  if (request.resume) {
    auto said = kept.read();
    if (!said) return failed(said.error());
    dialog.begin_again(std::move(*said));
  } else if (dialog.asks() && kept.there()) {
    return failed(
        usage(fmt::format("{} keeps answers to an earlier `new`: --resume goes on with them; to begin anew, "
                          "delete it",
                          kept.path())));
  }
  auto chosen = choose_in_dialog(request, dialog);
  if (auto* errors = chosen.refused()) return failed(std::move(*errors));
  CommandOutcome outcome = make_and_write(request, chosen.value(), dialog.asks());
  if (dialog.asks() && outcome.errors.empty()) (void)kept.write({});  // one that stays is told of by the next `new`
  return outcome;
}

void new_options(OptionSet& set, NewRequest& request) {
  set.word("--gear", request.gear, "kind of gear", "KIND", proposal::gear_words());
  set.word("--cut", request.route, "how it is cut; bevel_herringbone: finger", "WAY", proposal::route_words());
  set.text("--machine", request.machine, "a machine file, or the name of an installed machine", "NAME");
  set.text("--tools", request.tools,
           "tools instead of standard sizes: those of a job, or of a tool library of LinuxCNC, Fusion or FreeCAD",
           "FILE");
  set.word("--library-unit", request.unit, "unit of the lengths for which a tool library states none", "UNIT",
           app::kLengthUnits);
  set.texts("--tool", request.said, "what a tool library does not say of a tool: \"12: stick_out = 40, teeth = 2\"",
            "NUMBER:KEYS");
  for (const Question& question : proposal::questions()) {
    const auto at = static_cast<std::size_t>(question.what);
    if (question.whole) set.whole_number(question.option, request.whole[at], question.text, question.range);
    else set.number(question.option, request.numbers[at], question.text, question.range);
  }
  set.text("--points", request.points,
           "a gear by points: a file of x y z[ i j k] of both flanks of one space, in any order", "FILE");
  set.word("--points-unit", request.points_unit, "unit of x, y and z for which the file states none", "UNIT",
           app::kLengthUnits);
  set.text("--tip", request.tip,
           "its tip surface in the meridian, where not through the last rows of points: r z at both ends",
           "[[R, Z], [R, Z]]");
  set.text("--root", request.root, "its root surface, where not as deep as the fillet below the first rows",
           "[[R, Z], [R, Z]]");
  set.text("--rexs", request.rexs,
           "a cylindrical or spiral bevel gear, with the settings of its generator, from a REXS file 1.4 to 1.7",
           "FILE");
  set.whole_number("--component", request.component, "number of the gear in a REXS file that has several", kComponent);
  set.word("--left-flank", request.left_flank, "of a bevel gear in a REXS file whose flanks have a set-up each",
           "WHICH", kFlankWords);
  set.word("--ratio-of-roll", request.ratio_of_roll, "sense of ratio_of_roll where the file leaves it open", "SENSE",
           kRatioWords);
  set.word("--hand", request.hand,
           "hand of a spiral bevel gear, or of the inner half of a herringbone; without: pinions left, wheels right",
           "HAND", kHandWords);
  set.number("--dedendum-coefficient", request.dedendum, "of a cylindrical gear whose REXS file has no tool",
             kRackCoefficient);
  set.number("--root-radius-coefficient", request.root_radius, "of the rounding of its rack's tip", kRackCoefficient);
  set.text("--name", request.name, "name of the job; else that of the file", "NAME");
  set.flag("--with-mate", request.with_mate,
           "of a bevel gear by its numbers: the job of its mate, too, as JOB_mate.toml beside it");
  set.flag("--resume", request.resume, "goes on with the answers of a `new` on a terminal that ended before its job");
  set.text("-o", request.file, "the job file to write; an existing one is not replaced", "JOB.toml");
}

}  // namespace

void add_new(Commands& commands) {
  commands.push_back(command_of<NewRequest>(
      "new", "writes a job file: asks on a terminal, or takes options; tries the job before it writes it", new_options,
      run_new));
}

}  // namespace toothpath::commands
