// Where the gear stands in the machine.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/base/vec.h"
#include "machines/machine.h"

namespace toothpath::proposal {

/// Places of the tool about the gear, gear frame: tips, and unit axes from tip to holder.
struct ToolPlace {
  Vec3 tip_mm, axis;
};

/// What the machine must reach.
struct PartInSpace {
  double radius_mm = 0, z_min_mm = 0, z_max_mm = 0;  ///< of the blank, gear frame
  bool up = true;                                    ///< z of the gear along that of the machine; else turned about X
  std::vector<ToolPlace> places;                     ///< of one tooth space: the others are turned copies
  int teeth = 1;
  bool has_top = true;                            ///< its highest place is that of the blank, not a bound
  std::optional<double> top_above_table_mm = {};  ///< where the shop clamps it; nothing: where there is most room

  /// Of the blank, from the origin of the gear along the machine's Z, rotaries at zero.
  [[nodiscard]] double top_mm() const { return up ? z_max_mm : -z_min_mm; }
};

/// Z of the face of the table, or of the highest body on it, under the work; machine coordinates. Nothing: the machine
/// file says neither.
[[nodiscard]] std::optional<double> table_top_mm(const machines::Machine& machine);

struct Place {
  Vec3 origin_mm = Vec3::Zero();
  std::array<double, 3> room_mm{};             ///< X Y Z, margins taken off; < 0: beyond a travel
  std::array<double, 3> needs_mm{}, has_mm{};  ///< X Y Z: from the least to the greatest joint; of the machine
};

/// The place with the most room in the travels: on the axis of the table that carries the work, where there is one, and
/// clear of its plate; or as high as its shop clamps it (then table_top_mm() is known). Nothing: the machine reaches no
/// place of the tool.
/// @param tool_length_mm  gauge point to tip
[[nodiscard]] std::optional<Place> place_of(const machines::Machine& machine, const PartInSpace& part,
                                            double tool_length_mm);

/// Places of a tool that mills a face gear: on the teeth and above them, upright and leaning.
[[nodiscard]] std::vector<ToolPlace> face_places(double inner_mm, double outer_mm, double z_low_mm, double z_high_mm);
/// The same of a cylindrical gear: the tool comes in along radii, between two heights.
[[nodiscard]] std::vector<ToolPlace> cylinder_places(double z_low_mm, double z_high_mm, double inner_mm,
                                                     double outer_mm);
/// Normal to teeth that stand between two places (r, z), as deep below them as told and clear above.
[[nodiscard]] std::vector<ToolPlace> meridian_places(const Vec2& from, const Vec2& to, const Vec2& up, double depth_mm);
/// The same of a pitch cone, between two cone distances.
[[nodiscard]] std::vector<ToolPlace> finger_places(double inner_mm, double outer_mm, double pitch_angle_rad,
                                                   double depth_mm);

}  // namespace toothpath::proposal
