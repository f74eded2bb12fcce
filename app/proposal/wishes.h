// What somebody wants to cut, as far as it is known: what `toothpath new` asks for, and what a job is proposed from.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "app/proposal/quality.h"
#include "geometry/cylindrical/parameters.h"
#include "geometry/flank_grid/parameters.h"
#include "geometry/spiral_bevel/parameters.h"
#include "machines/toml/table_reader.h"

namespace toothpath::proposal {

enum class Gear : std::uint8_t {
  face,
  double_helical,
  offset,
  bevel_herringbone,
  cylindrical,
  cylindrical_double_helical,  ///< two rings of opposite hands, and a groove
  straight_bevel,
  spiral_bevel,  ///< its settings stand in a file, or follow from a drawing
  flank_grid,    ///< its points stand in a file
};
enum class Route : std::uint8_t {
  ball,    ///< ball mills alone
  line,    ///< flanks by the side of a tapered mill
  shaped,  ///< gear shaper
  finger,  ///< finger mill
};

[[nodiscard]] constexpr bool is_cylindrical(std::optional<Gear> gear) {
  return gear == Gear::cylindrical || gear == Gear::cylindrical_double_helical;
}

/// As the options say them.
[[nodiscard]] std::span<const std::string_view> gear_words();
[[nodiscard]] std::span<const std::string_view> route_words();
[[nodiscard]] std::optional<Gear> gear_of(std::string_view word);
[[nodiscard]] std::optional<Route> route_of(std::string_view word);
/// The routes by which a gear is cut, the proposed one first.
[[nodiscard]] std::span<const Route> routes_of(Gear gear);
[[nodiscard]] std::string_view word_of(Gear gear);
[[nodiscard]] std::string_view word_of(Route route);

enum class Quantity : std::uint8_t {
  teeth,
  shaper_teeth,
  mate_teeth,
  pitch_angle,  ///< says the shaft angle
  shaft_angle,
  cone_distance,  ///< outer; says the module, as the next one does
  mean_cone_distance,
  module,
  pressure_angle,
  helix,
  offset,
  tip_radius,
  inner,
  outer,
  spiral,
  face_width,
  profile_shift,
  cutter_radius,
  fillet_radius,
  bore,
};
inline constexpr std::size_t kQuantities = 20;

/// mm and deg, as a job says them.
struct Wishes {
  std::optional<Gear> gear;
  std::optional<Route> route;
  std::string machine;  ///< as a job names it
  std::array<std::optional<double>, kQuantities> numbers{};
  Quality quality;
  std::string coolant;                 ///< as a job says it; empty: none
  std::string material;                ///< a word of `material_words`; empty: not said
  std::optional<double> blank_top_mm;  ///< above the face of the table; nothing: where the travels have most room
  int hand = 0;  ///< of a spiral bevel gear by a drawing, of the inner half of a herringbone: 1 right, -1 left

  // Gears whose numbers stand in a file.
  std::shared_ptr<const cylindrical::CylindricalParameters> cylinder = {};
  std::shared_ptr<const spiral_bevel::SpiralBevelParameters> spiral = {};
  std::shared_ptr<const flank_grid::FlankGridParameters> grid = {};
  std::string points_file = {};                                    ///< of the grid, as the job names it
  [[nodiscard]] bool whole() const { return cylinder || spiral; }  ///< nothing of the gear is asked for
  /// Its settings follow from a drawing.
  [[nodiscard]] bool drawn() const { return gear == Gear::spiral_bevel && hand != 0; }

  [[nodiscard]] std::optional<double>& operator[](Quantity q) { return numbers[static_cast<std::size_t>(q)]; }
  [[nodiscard]] std::optional<double> operator[](Quantity q) const { return numbers[static_cast<std::size_t>(q)]; }
  /// 0 where it is not known.
  [[nodiscard]] double at(Quantity q) const { return (*this)[q].value_or(0); }
};

/// One number that is asked for.
struct Question {
  Quantity what;
  const char* option;  ///< "--teeth"
  const char* text;    ///< "teeth of the gear"
  toml::Range range;
  bool whole;
};

/// In the order in which they are asked.
[[nodiscard]] std::span<const Question> questions();
/// Of a drawing, where it stands instead of another quantity: asked for by options alone.
[[nodiscard]] constexpr bool stands_for_another(Quantity what) {
  return what == Quantity::pitch_angle || what == Quantity::cone_distance || what == Quantity::mean_cone_distance;
}
/// Nobody can propose it, whatever the other answers are.
[[nodiscard]] constexpr bool only_the_user_knows(Quantity what) {
  return what == Quantity::teeth || what == Quantity::mate_teeth || what == Quantity::module ||
         stands_for_another(what);
}
/// Does a gear of this kind have the quantity?
[[nodiscard]] bool belongs(const Question& question, Gear gear);
/// What is proposed after the answers so far; nothing: only the user knows.
[[nodiscard]] std::optional<double> proposed(Quantity quantity, const Wishes& wishes);

}  // namespace toothpath::proposal
