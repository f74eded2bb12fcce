// A program that a machinist runs in air before the first cut: the tip of a test bar stands on one point of the table
// while the rotary axes go through their range.
//
// What it proves depends on who keeps the tip there. Without TCP the words are joints that follow from the machine
// file: a sign, a pivot or a centre that is wrong there moves the tip off the point (dials.h says by how much). With
// TCP the text is the point and angles, the control makes the joints from data of its own, and it is those that are
// proven: the machine file may say what it likes. A machine with TCP runs both.
//
// Poses only, free of any dialect. Spec of the idea: dial indicators on the table at `point_mm`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"
#include "machines/machine.h"
#include "postproc/joints/program.h"
#include "postproc/text/dialect.h"

namespace toothpath::self_test {

/// A place where the machinist looks at the indicator.
struct SelfTestStation {
  std::array<double, 2> rotary_rad{};  ///< commands, in the order of KinematicChain::rotary
  std::string remark;                  ///< "A+30 C0: TABLE Y+ SIDE DOWN", ASCII upper case
  /// The axes stand as before, and TCP was switched off and on again with the words of the first rotary of the table
  /// counting from here, deg; 0: no such station.
  double zero_deg = 0;
};

struct SelfTest {
  Vec3 point_mm = Vec3::Zero();  ///< of the tip: table frame, which is machine coordinates with all rotaries at zero
  double tool_length_mm = 0;     ///< gauge point to the tip of the bar
  double approach_mm = 0;        ///< the tip comes down to the point from this height above it
  /// The first and the last stand at zero, or as near to it as the limits allow. Where the machine file grants that the
  /// transformation takes the rotary offset of the frame, the last one asks for it: by what the tip moves there if it
  /// does not, 1 mm is aimed at.
  std::vector<SelfTestStation> stations;
  /// Joints of every block. `station` >= 0: the block ends at that station.
  struct Move {
    machines::Joints joints;
    int station = -1;
  };
  std::vector<Move> moves;  ///< from the first station on
  /// Between two stations the tip leaves the point upwards, Z goes to its top, the rotaries turn alone, and the tip
  /// comes down again: a control without TCP that has no inverse time, where nobody says how fast a block is that turns
  /// and moves.
  bool lifts = false;
  double tip_bound_mm = 0;  ///< proven: between two blocks, all joints linear, the tip leaves the point by no more
  double tilt_rad = 0;      ///< largest tilt that is used
};

struct SelfTestOptions {
  std::optional<double> tool_length_mm;  ///< nothing: the first of 100, 60 and 30 mm that the travels allow
  double tip_mm = 0.005;                 ///< how far the tip may leave the point between two blocks
  double largest_tilt_rad = radians(30);
};

/// Chooses the point and the stations: each rotary axis alone (a full turn in quarters where its limits allow one, else
/// to both sides), then the quarters of one with the other tilted. Point: off the axes so that every sign shows, on the
/// table where there is one. `lifts` follows from the control. Errors: no rotary axis; no point near the table from
/// which even 5 degrees of tilt stay inside the travels: the message names axis, value and limit; a tool length that is
/// not positive.
[[nodiscard]] Result<SelfTest> plan_self_test(const machines::Machine& machine, const SelfTestOptions& options = {});

/// The same machine while its control has TCP off: its program moves the joints.
[[nodiscard]] machines::Machine without_tcp(machines::Machine machine);

/// The poses as an axis program: retract, point, every station with a stop behind it. The work offset stands at the
/// point. With TCP the blocks turn the rotaries alone and the control is what is tested. `test`: planned for this
/// machine, with or without TCP as it is here.
[[nodiscard]] joints::AxisProgram self_test_program(const SelfTest& test, const machines::Machine& machine,
                                                    const text::NcDialect& dialect);

/// The dialect without the line that starts the spindle.
[[nodiscard]] text::NcDialect in_air(text::NcDialect dialect);

/// What the text of a self-test does, read back through the machine's kinematics.
struct SelfTestProof {
  double worst_mm = 0;  ///< greatest distance of the tip from the point, from the first station to the last, inside the
                        ///< blocks too; where it lifts, at the stations
  std::vector<Vec3>
      readings_mm;        ///< at every station: of dials along X, Y and Z of the table, on the machine of the file
  std::size_t moves = 0;  ///< executed between them
  double minutes = 0;     ///< of the whole program, stops left out
};

/// Executes the text with a standing spindle. Errors (verification): what the reader refuses; a station that is not met
/// in its order; a joint outside its travel; a tip that leaves the point by more than the plan's bound and 3 um of
/// rounding.
[[nodiscard]] Result<SelfTestProof> prove_self_test(std::string_view text, const std::string& file,
                                                    const SelfTest& test, const machines::Machine& machine);

}  // namespace toothpath::self_test
