// A machine file read line by line, and its axes as plain turns one after the other: where tip and tool stand in the
// frame of the table. Shares nothing with the reader of machine files and its chains.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/base/vec.h"
#include "tests/support/nc_walk.h"

namespace toothpath::test {

struct ToolPlace {
  Vec3 tip, axis;  ///< axis from the tip to the holder
};

using PlainJoints = std::array<double, 6>;  ///< X Y Z of the gauge line, machine; A B C as commanded, deg

class PlainMachine {
 public:
  explicit PlainMachine(const std::string& machine_file);

  /// In the frame of the table: that of the machine at all rotaries zero.
  [[nodiscard]] ToolPlace place(const PlainJoints& joints, double length) const;
  /// A place of the machine in the frame of the table at these rotaries, and back.
  [[nodiscard]] Vec3 on_table(const PlainJoints& joints, Vec3 point) const;
  [[nodiscard]] Vec3 off_table(const PlainJoints& joints, Vec3 point) const;
  /// X Y Z that bring the tip there while the rotaries stand.
  void bring_tip(PlainJoints& joints, const Vec3& tip, double length) const;
  /// Rotaries near those given that turn the tool this way. Throws where none do.
  void turn_to(PlainJoints& joints, const Vec3& axis) const;
  [[nodiscard]] const std::string& control() const { return control_; }
  /// Whether its transformation takes the rotary offset of the frame as the table's own.
  [[nodiscard]] bool takes_rotary_offset() const { return takes_rotary_offset_; }
  /// All rotaries at their zeros, the table's turned on by these, A B C deg.
  [[nodiscard]] PlainJoints zeros_and(const std::array<double, 3>& more_deg) const;

 private:
  struct Axis {
    std::size_t index = 3;  // of the joints
    Vec3 direction = Vec3::UnitZ(), point = Vec3::Zero();
    double sign = 1, zero = 0;
  };
  [[nodiscard]] Mat3 turn(const Axis& axis, const PlainJoints& joints) const;

  std::string control_;
  bool takes_rotary_offset_ = false;
  std::vector<Axis> table_, head_;  // from the work outwards, from the ram outwards
};

/// One straight motion: of the joints, or of the tip with the rotaries in step.
struct MachineMove {
  int line = 0, tool = 0;
  bool rapid = false, tip = false;
  PlainJoints from{}, to{};
  Vec3 tip_from, tip_to;  ///< table frame; where the control keeps the tip on its chord
};

struct PlainSetup {
  Vec3 work_offset;             ///< machine coordinates of the origin of the words
  std::vector<double> lengths;  ///< of the tools, by number; [0] is not used
};

/// The walk on a machine. Motions before all axes are known are left out; a cut among them, one without its tool's
/// length or in machine coordinates is a fault.
[[nodiscard]] std::vector<MachineMove> moves_on(const PlainMachine& machine, NcWalk& walk, const PlainSetup& setup);
/// @param t 0 to 1
[[nodiscard]] ToolPlace place_on(const PlainMachine& machine, const MachineMove& move, const PlainSetup& setup,
                                 double t);

}  // namespace toothpath::test
