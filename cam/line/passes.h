// One pass of a mill's side along one strip of a flank: stations, smoothed angles, ends, and records as sparse as the
// chord allows.
//
// Gear frame, space 0, mm, rad. The pass runs towards rising s. Derivation: docs/line_milling.md, sections 5 and 6.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cam/line/pose.h"

namespace toothpath::line {

/// Which rotaries may move while a pass cuts.
enum class Rotaries { both, tilt_stands, azimuth_stands };
[[nodiscard]] const char* to_string(Rotaries rotaries);

/// What does not leave a pose its room: a body of the tool, and what of the gear it meets.
struct Blocked {
  std::string body, patch;
  double gap_mm = 0;    ///< least gap found; negative: it cuts
  double least_mm = 0;  ///< that it must keep
  enum class Need : std::uint8_t { touch, stock, clearance } need = Need::clearance;  ///< why it must keep that
};
/// Nothing where a pose is free.
using Room = std::function<std::optional<Blocked>(const AxisLine<double>&)>;

struct PassOptions {
  Rotaries rotaries = Rotaries::both;
  double chord_mm = 5e-4;  ///< by how much a block may rise above the largest gap of its ends; it sinks below the least
                           ///< by a quarter of that at most
  double bias_mm =
      0;  ///< least gap that every pose keeps over the domain: takes up what follows (verification, rounding)
  double station = 0.1;   ///< stations, in modules
  double longest = 0.1;   ///< longest block along the anchors, in modules
  double overrun = 0.12;  ///< how far beyond the ends of the ring the last foot is carried, in modules
  /// Is there something across the end where s begins, where it ends (the other ring, a groove)? There the ball end is
  /// lifted out of the way.
  bool lift_from = false, lift_to = false;
  double base_lift = 0;  ///< of the ball end everywhere, along the axis, mm: it leaves more room between the flanks
  double lift_margin = 0.08;  ///< the lift begins where the ball end's foot is so far beyond the end, in modules
  double lift_slope = 1;      ///< mm of lift per mm of contact, at most
  double enough_mm =
      INFINITY;  ///< give up where the best pose of a station alone leaves more than this: a pass without records
  /// What stands in the way of a pose (cam/line/room.h)? Beyond the last full station the pass ends there; at a full
  /// one it is refused. Empty: nothing does.
  Room room;
};

/// What a report draws of a pass.
struct StationFigures {
  double at = 0;                       ///< along the ring as it is told: a radius, or z
  double lean = 0, eps = 0, tilt = 0;  ///< rad; the tilt from the gear axis
  double covered = 0;                  ///< share of the height in the ring
  double best = 0;                     ///< misfit of the best pose of this station alone, mm
  double misfit = 0;                   ///< largest gap over the strip less the least, as it is cut, mm
};

struct LineRecord {
  double s = 0;
  AxisLine<double> axis;       ///< ball end's centre and direction
  Vec3 anchor = Vec3::Zero();  ///< of the contact, for feeds
  Place at;                    ///< on the flank below it
  double most = 0;             ///< largest gap over the strip
  double lift = 0;
  double contact_ratio = 1;  ///< way of the tip from the record before, over the way of the contact
};

/// By how much more may stand between the places where `left_mm` is looked at, as a factor.
inline constexpr double kPlacesSee = 1.002;

struct LinePass {
  int zone = 0, side = 1;
  int strip = 0, strips = 1;  ///< of so many of its flank, from the tip down
  int number = 0;             ///< of the passes of its zone
  Rotaries rotaries = Rotaries::both;
  std::vector<StationFigures> stations;  ///< those with a foot in the ring
  std::vector<LineRecord> records;
  double misfit_mm = 0;  ///< worst of all stations and records, smoothing included, bias not
  double left_mm = 0;  ///< most that stands as it is cut, looked at more densely (misfit.h): bias, blocks, lifts in it
  double unpassed_mm = 0;  ///< planned to stand at ends of the ring that it does not reach
  double best_mm = 0;      ///< worst of the poses alone, over the full stations
  double chord_mm = 0;     ///< worst seen within a block, as `PassOptions::chord_mm` counts
  double contact_mm = 0;   ///< way of the contact
  double contact_top_mm =
      0;  ///< highest height of a contact above the tip, along the axis, lifts included: the flutes must reach it
  double shortened_mm = 0;              ///< lost at ends that are not clear before the last foot has left the ring
  std::optional<Blocked> shortened_by;  ///< what is in the way where a pass ends early, feet in the ring or not
};

/// Plans a pass. Refused, with quantity, value and limit: a tilt above 60 deg from upright, flutes that end below a
/// contact of any pose, lifted ones too (`law_end`), a full station without room, fewer than four full stations, an
/// axis condition that no lean fulfils, a flank whose ends are not reached.
/// @param law_end  highest usable t of the tool
[[nodiscard]] Result<LinePass> plan_pass(const LineFit& fit, const PassOptions& options, double law_end);

}  // namespace toothpath::line
