// A finished gear as meshes, solids, stock and measuring ask for it: its rings of teeth, and what is turned between and
// below them.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// The spaces must outlive it. mm; s and h are those of the chart that all rings share.
struct ToothedSolid {
  struct Ring {
    const ToothSpace* space = nullptr;
    int zone = 0;  ///< of the job
  };
  int teeth = 0;
  double module_mm = 0;
  double lowest_root = 0;   ///< h of the lowest place of the tooth spaces
  std::vector<Ring> rings;  ///< in the order of rising s
  /// (s, h) behind each ring: where its end face stops, the corners of what follows, and where the end face of the next
  /// ring begins; behind the last one the body, back to the first ring. At least two. Between two corners a plane,
  /// cylinder or cone; radius 0 is the axis.
  std::vector<std::vector<Vec2>> corners;
  /// Inspection points of side -1 lie on tooth 0, as those of side +1 do; else on tooth 1, so that both bound space 0.
  bool measured_on_one_tooth = false;
  /// u of flanks beyond which, towards the tip, nothing is measured; none: they are good up to the tip.
  std::optional<double> flanks_begin = {};
  /// What gives a wider top land, a wider root land and a deeper groove, for messages.
  struct WaysOut {
    const char *land = "", *root = "", *groove = "";
  };
  WaysOut ways_out = {};

  [[nodiscard]] const Chart& chart() const { return rings.front().space->outline().chart; }
  [[nodiscard]] double pitch() const { return kTwoPi / teeth; }
};

/// A station along the teeth, for messages: "radius 61.2000 mm".
[[nodiscard]] inline std::string station(const Outline& outline, double s) {
  return fmt::format("{} {:.4f} mm", outline.along, outline.sign * s);
}

}  // namespace toothpath::tooth_space
