// One operation of a job: what the planners need to know, feeds in mm/min, lengths in mm.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/tooth_space/piece.h"

namespace toothpath::path {

/// Parts of the finished surface of a tooth space.
enum class Region : std::uint8_t { flank, fillet, root };
inline constexpr std::array kRegions{Region::flank, Region::fillet, Region::root};
[[nodiscard]] const char* to_string(Region region);  ///< as in the job file
/// What a piece of a tooth space is part of; walls are flanks.
[[nodiscard]] constexpr Region region_of(tooth_space::Piece piece) {
  return is_fillet(piece) ? Region::fillet : piece == tooth_space::Piece::root ? Region::root : Region::flank;
}

/// One value for each region.
template <typename T>
struct ByRegion {
  std::array<T, 3> value{};
  [[nodiscard]] static ByRegion everywhere(const T& v) { return {{v, v, v}}; }
  [[nodiscard]] T& operator[](Region region) { return value[std::size_t(region)]; }
  [[nodiscard]] const T& operator[](Region region) const { return value[std::size_t(region)]; }
};

/// One key of a tool axis that the job prescribes: with the ball centre at this radius about the gear axis the tool
/// leans so far from the normal of the pitch surface, outwards along the teeth and aside towards growing azimuth (away
/// from flank +1, towards flank -1).
struct ToolAxisKey {
  double radius_mm = 0, outwards_rad = 0, aside_rad = 0;
};

enum class OperationType { roughing, semi_finishing, finishing, line_milling, finger_roughing, finger_finishing };
[[nodiscard]] const char* to_string(OperationType type);  ///< as in the job file

/// Which rotaries may move while the side of a mill cuts: "both" or "one" in the job file.
enum class MovingRotaries : std::uint8_t { both, one };

inline constexpr int kMostStrips = 24;  ///< of a line-milled flank

struct MillingOperation {
  OperationType type = OperationType::finishing;
  int tool = 0;  ///< index into the list of tools
  double speed_rpm = 0;
  double feed_mm_min = 0;   ///< of the contact point (ball mill) or cutter centre on the pitch cone (finger mill)
  double step_down_mm = 0;  ///< roughing: between layers
  double step_over_mm = 0;  ///< roughing: between passes of a layer
  double allowance_mm = 0;  ///< stock left, along the normal of the finished surface
  double scallop_mm = 0;    ///< semi-finishing and finishing: cusp height between passes, the largest of its regions
  std::optional<ByRegion<double>> scallops_mm;  ///< another one for each of `regions`; none: `scallop_mm` everywhere
  ByRegion<bool> regions{{true, true, true}};   ///< semi-finishing and finishing: what is cut; line milling: the flank
  double chord_tolerance_mm = 0.005;            ///< sag of a block against the exact path; not asked for: 0.005
  bool climb = true;
  double chip_load_mm = 0;        ///< largest chip of a tooth, which rules the feed; 0: the feed stands
  double max_engagement_rad = 0;  ///< largest angle of a tooth in the material; 0: none is asked for
  double ridge_mm = 0;            ///< finger roughing: highest ridge left on the root
  /// Semi-finishing and finishing: prescribed tool axes, by ascending radius; both empty (the planner chooses) or both
  /// not. Those of passes on flank +1 of tooth 0 and its half of the root, and of the others.
  std::vector<ToolAxisKey> axis_plus, axis_minus;
  // Line milling.
  std::optional<int> strips;               ///< none: the least number that meets `left_mm`
  std::optional<double> left_mm;           ///< largest misfit; none: kDefaultLeft
  std::optional<MovingRotaries> rotaries;  ///< none: the fewest that meet `left_mm`
  bool best_way =
      false;  ///< by the ball end of its tool where that is quicker, or where the side leaves more than asked

  /// Does it leave the finished surface where it cuts?
  [[nodiscard]] bool finishes() const {
    return type == OperationType::finishing || (type == OperationType::line_milling && allowance_mm == 0);
  }
  /// Feed where the largest chip is `steepest` feeds per tooth, in (0, 1], of so many teeth: the job's, raised to
  /// kMostRaise times that at most where the operation does not finish, never above the chip load. mm/min
  [[nodiscard]] double feed_for(double steepest, int teeth) const;
  static constexpr double kMostRaise = 3;
  /// A region that is not cut has the largest of the others: heights of its own are those of `regions` alone.
  [[nodiscard]] double scallop_in(Region region) const {
    return scallops_mm && regions[region] ? (*scallops_mm)[region] : scallop_mm;
  }
  /// Largest misfit that a line-milled flank may keep.
  [[nodiscard]] double most_misfit_mm() const { return left_mm.value_or(kDefaultLeft); }
  static constexpr double kDefaultLeft = 5e-3;  ///< mm
};

/// Stock left by a ball end instead of a side, and the cusps on it: a tenth of the allowance, at least 2 um.
inline constexpr double kCuspPerAllowance = 0.1, kLeastCusp_mm = 0.002;
/// What the ball end of its tool does instead of a line milling: finishing with cusps of `left`, or semi-finishing with
/// the same allowance and cusps as above. Tool, speed, feed and chord tolerance stay.
[[nodiscard]] MillingOperation by_ball_end(const MillingOperation& line);

/// The operation before `n` that cut a region last, by index; nothing where none did. Roughing cuts all of them.
[[nodiscard]] std::optional<std::size_t> last_before(const std::vector<MillingOperation>& operations, std::size_t n,
                                                     Region region);

/// The most that an operation leaves where a ball of this radius fits, normal to the finished surface: its allowance
/// and the cusps between its passes. mm.
[[nodiscard]] double left_by(const MillingOperation& operation, double radius_mm);

/// A roughing pass that would remove nowhere more than this share of its tool's diameter is left out.
inline constexpr double kSkinShare = 0.1;

/// The operation that finishes a region last, by index; nothing where none does.
[[nodiscard]] inline std::optional<std::size_t> finisher_of(const std::vector<MillingOperation>& operations,
                                                            Region region) {
  for (std::size_t n = operations.size(); n-- > 0;)
    if (operations[n].finishes() && operations[n].regions[region]) return n;
  return {};
}

}  // namespace toothpath::path
