#include <algorithm>
#include <cmath>

#include "app/base/option_number.h"
#include "app/proposal/gear_limits.h"
#include "app/proposal/points_gear.h"
#include "app/questions/steps.h"
#include "geometry/base/angle.h"
#include "geometry/base/length_unit.h"

namespace toothpath::questions {
namespace {

using app::Dialog;
using proposal::Quantity;
using proposal::Question;
using proposal::Wishes;

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
Expected<proposal::PointsOfFile, std::vector<Diagnostic>> choose_points(const Given& request, Dialog& dialog) {
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
DoneOrErrors wish_meridians(Wishes& wishes, proposal::PointsOfFile& points, const Given& request, Dialog& dialog) {
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
                                                                          const Wishes& wishes, const Given& request) {
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

}  // namespace

DoneOrErrors wish_numbers(proposal::Wishes& wishes, const Given& request, app::Dialog& dialog,
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

}  // namespace toothpath::questions
