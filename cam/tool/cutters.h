// The kinds of cutters: what a job calls them, which numbers they are ordered by, what they can do. To add one: a line
// in cutters.cpp; and a planner, if it cuts in a new way.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cam/tool/profile.h"

namespace toothpath::tool {

/// What planners ask of a cutter.
enum class CutterUse : std::uint8_t {
  layers,      ///< roughing in layers
  ball_end,    ///< passes of a ball over flanks, fillets and root
  side,        ///< the straight side in contact along a line
  tooth_form,  ///< the form of a tooth space: finger mills
};

/// One number of a [[tool]] beside those that every tool has. Open below: the low end itself is refused.
struct CutterNumber {
  const char* key;
  double ToolAssembly::*member;
  double low, high;
  bool open_low = false;
  bool degrees = false;  ///< read in deg, kept in rad
};

struct CutterKind {
  CutterType type;
  const char* word;     ///< `type` in job files
  const char* name;     ///< for people
  bool form_from_gear;  ///< its meridian follows from the gear (cam/finger/finger_profile.h), not from numbers alone
  CutterShape shape;    ///< of the others
  std::span<const CutterUse> uses;
  std::span<const CutterNumber> numbers;
  std::string (*size)(const ToolAssembly&);        ///< "dia 1.6 mm"
  std::string (*short_size)(const ToolAssembly&);  ///< for NC comments, capital ASCII: "D1.6"

  [[nodiscard]] bool serves(CutterUse use) const;
};

[[nodiscard]] std::span<const CutterKind> cutter_kinds();
[[nodiscard]] const CutterKind& kind_of(CutterType type);
[[nodiscard]] inline const CutterKind& kind_of(const ToolAssembly& tool) { return kind_of(tool.type); }
[[nodiscard]] inline bool serves(const ToolAssembly& tool, CutterUse use) { return kind_of(tool).serves(use); }

/// Does it cut the same about the centre of its ball end however it leans? Ball mills whose flute is no wider.
[[nodiscard]] bool turns_freely(const ToolAssembly& tool);

/// "ball end mill, dia 1.6 mm (R0.8 LONG, holder ER16)"; names only where the job has them.
[[nodiscard]] std::string cutter_text(const ToolAssembly& tool);
/// "BALL END MILL D1.6".
[[nodiscard]] std::string cutter_comment(const ToolAssembly& tool);
/// What the shop calls tool and holder: "NAME R2 LONG", "HOLDER ER16 X 70"; only what the job says.
[[nodiscard]] std::vector<std::string> shop_names(const ToolAssembly& tool);

/// A cutting part as cutter location data state it (ISO 4343, CUTTER/d,r,e,f,a,b,h): twice the distance from the axis
/// to where lower and upper line meet, corner radius, its centre beside the axis and above the tip [mm], the lower line
/// above the plane across the axis, the upper line off the axis [deg], height [mm].
using AptCutter = std::array<double, 7>;
/// Nothing: a form that these seven numbers cannot state, the finger mill's.
[[nodiscard]] std::optional<AptCutter> apt_cutter(const ToolAssembly& tool);

/// The profile of a tool whose form its numbers give and that a job reader has accepted; nothing is checked again.
[[nodiscard]] Profile profile_of(const ToolAssembly& tool);

/// A body of a tool as a drawing shows it: (h, r) from below, arcs in chords.
struct Outline {
  Body body = Body::none;
  std::vector<Vec2> line;
};
/// Ball end, flutes, shank and holder. A finger mill whose gear is not known here is drawn as wide as its module at the
/// tip.
[[nodiscard]] std::vector<Outline> outline_of(const ToolAssembly& tool);

/// Height above the tip of the centre of the round end: the ball's radius, the corner's of a bull nose, 0 of a flat
/// mill.
[[nodiscard]] double end_centre_mm(const ToolAssembly& tool);

}  // namespace toothpath::tool
