// The time that a control needs for blocks that follow one another: every axis keeps its speed, acceleration and, where
// stated, jerk; corners are passed as the path mode says.
//
// Model: a block is straight in its five axes. Its length is the Euclidean one with 1 deg as 1 mm, u its direction.
// Along it the speed is v <= length / time asked and <= speed_j / |u_j|, the acceleration <= acceleration_j / |u_j|,
// the jerk alike. Rapids begin and end at rest. From one feed block to the next v is the same, 0 or what the corner
// lets pass
// (`Corners`); one pass forward and one backward give the greatest v at all corners, and every block its quickest
// motion. Where a jerk is stated the acceleration is zero at corners, and blocks on one line are one stretch.
//
// LinuxCNC's rules are those of its source (2.9: tp/tp.c, tp/tc.c, task/emccanon.cc), in docs/times.md.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "machines/machine.h"
#include "postproc/timing/profile.h"

namespace toothpath::timing {

/// How one feed block joins the next.
enum class Corners : std::uint8_t {
  stop,   ///< the path stops at the corner (LinuxCNC's G61.1, Fanuc's G61)
  exact,  ///< LinuxCNC's G61: a stop, but where no axis changes its speed by more than a tenth of what it can in a
          ///< period; where a rotary turns always a stop
  blend,  ///< LinuxCNC's G64 P: an arc or two parabolas within the tolerance; nothing where a rotary turns is exact
  jump,   ///< the speed of every axis may jump by what it accelerates in one block time (Fanuc and others)
  round,  ///< a jump, or a parabola that leaves the corner by the tolerance at most (cycle 32, CYCLE832)
  way,    ///< a jump, or a parabola that begins and ends within the tolerance of the corner (G641 ADIS)
};

/// How far the path leaves corners is a number of the text.
[[nodiscard]] constexpr bool is_bounded(Corners corners) {
  return corners == Corners::round || corners == Corners::way;
}

/// Axes X Y Z and the two rotaries in the machine's order; mm, deg, minutes. An axis that is not there: infinities.
struct AxisLimits {
  std::array<double, 5> speed{}, acceleration{}, jerk{};  ///< jerk 0: none stated
  [[nodiscard]] bool has_jerk() const;
};

/// Of the machine file. It states every acceleration.
[[nodiscard]] AxisLimits limits_of(const machines::Machine& machine);

struct PathControl {
  Corners corners = Corners::jump;
  double period_min = 0;     ///< of the controller; a path from stop to stop takes whole periods. 0: any time
  double jump_min = 0;       ///< `jump`, `round` and `way`: the block time
  double tolerance_mm = 0;   ///< `blend`: P; `round`; `way`
  bool plans_words = false;  ///< with TCP the limits act on the words (tip and rotaries), not on the joints (LinuxCNC)
};

/// @param corners of the control that the machine file names: `exact` is LinuxCNC, the others `stop` or `jump`
[[nodiscard]] PathControl control_of(const machines::Machine& machine, Corners corners);

struct Block {
  std::array<double, 5> step{};  ///< mm and deg
  double minutes = 0;            ///< that the program asks for; 0: as quick as the axes can
  bool rapid = false;
};

/// Takes blocks in order and tells their times in order, as soon as they are known: at stops.
class PathTimer {
 public:
  using Sink = std::function<void(double minutes)>;
  PathTimer(const AxisLimits& limits, const PathControl& control, Sink sink);

  /// A block that moves nothing takes what it asks for, and the path stops.
  void add(const Block& block);
  /// The path stops here.
  void finish();
  /// Finishes; what follows is joined as said here.
  void set_corners(Corners corners, double tolerance_mm);

 private:
  struct Piece {
    std::array<double, 5> direction{};
    double length = 0, shortened = 0;  ///< `shortened`: the share of the acceleration that a corner takes away
    Limits limits;
    double leaves = 0;         ///< speed at its end
    std::vector<double> ends;  ///< of the blocks on it, from its beginning
  };
  struct Corner {
    double speed = 0, shortened = 0;
    double overlap_min = 0;  ///< the next block begins so much earlier (parabolas)
  };
  [[nodiscard]] Piece piece_of(const Block& block) const;
  [[nodiscard]] Corner corner_of(const Piece& a, const Piece& b) const;
  [[nodiscard]] Corner exact_corner(const Piece& a, const Piece& b) const;
  [[nodiscard]] Corner jumped_corner(const Piece& a, const Piece& b) const;
  [[nodiscard]] Corner blended_corner(const Piece& a, const Piece& b) const;
  [[nodiscard]] bool on_one_line(const Piece& a, const Piece& b) const;
  void flush(double overlap_min);

  AxisLimits limits_;
  PathControl control_;
  Sink sink_;
  bool jerk_ = false;
  std::vector<Piece> pieces_;
};

/// Times of all blocks [min]; at rest before the first and behind the last.
[[nodiscard]] std::vector<double> times_of(std::span<const Block> blocks, const AxisLimits& limits,
                                           const PathControl& control);

}  // namespace toothpath::timing
