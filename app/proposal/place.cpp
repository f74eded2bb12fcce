#include "app/proposal/place.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/angle.h"
#include "postproc/bodies/of_machine.h"
#include "postproc/choice/travel_offer.h"

namespace toothpath::proposal {
namespace {

constexpr double kFixture = 20;  // mm between the plate of the table and the blank
constexpr double kApproach = 8;  // mm above the blank
constexpr double kBodiesApart = 5, kRise = 10,
                 kHighestRise = 400;  // mm between bodies of the machine, and how they get it
constexpr double kLeansAside[] = {-25, 0, 25}, kLeansOut[] = {0, 25};  // deg
constexpr int kMostTeeth = 24;                                         // turned copies that are looked at

Mat3 turned(double angle) {
  Mat3 r;
  r << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
  return r;
}

bool turns_the_work(const machines::KinematicChain& chain) {
  return !chain.table.empty() && std::abs(chain.table.front().direction.z()) > 1 - 1e-9;
}

/// Joints of every place of the tool about every tooth that is looked at, with the rotaries inside their limits.
template <typename Note>
void for_each_pose(const machines::Machine& machine, const PartInSpace& part, const Vec3& origin, double tool_length_mm,
                   Note note) {
  const machines::KinematicChain& chain = machine.chain;
  Mat3 turn = Mat3::Identity();
  if (!part.up) turn = Vec3(1, -1, -1).asDiagonal();
  const auto inside = [&](const machines::Joints& joints) {
    for (std::size_t k = 0; k < chain.rotary_count(); ++k)
      if (machines::windings(chain.rotary(k), joints.rotary_rad[k], machine.limit_margin.rotary_rad).empty())
        return false;
    return true;
  };
  const int copies = std::min(part.teeth, kMostTeeth);
  for (int tooth = 0; tooth < copies; ++tooth) {
    const Mat3 at = turn * turned(2 * kPi * tooth / copies);
    for (const ToolPlace& place : part.places) {
      const auto solutions = chain.inverse({origin + at * place.tip_mm, at * place.axis}, tool_length_mm);
      if (!solutions) continue;
      const auto found = std::find_if(solutions->begin(), solutions->end(),
                                      [&](const machines::JointSolution& s) { return inside(s.joints); });
      if (found != solutions->end()) note(found->joints);
    }
  }
}

/// How much higher the gear must stand so that the bodies of the machine keep apart at every place of the tool: with a
/// tool that comes in from the side the spindle would stand in the table. 0 where no height does: the trial says why.
double rise_off_bodies(const machines::Machine& machine, const PartInSpace& part, const Vec3& origin,
                       double tool_length_mm) {
  auto found = bodies::bodies_of(machine, false);
  if (!found) return 0;
  const bodies::Scene scene(machine.chain, std::move(*found));
  for (double rise = 0; rise <= kHighestRise; rise += kRise) {
    bool apart = true;
    for_each_pose(machine, part, origin + Vec3(0, 0, rise), tool_length_mm, [&](const machines::Joints& joints) {
      apart = apart && std::all_of(scene.pairs().begin(), scene.pairs().end(), [&](const bodies::Pair& pair) {
                return scene.gap_of(pair, joints, kBodiesApart).proven >= kBodiesApart;
              });
    });
    if (apart) return rise;
  }
  return 0;
}

void measure_travels(const machines::Machine& machine, const PartInSpace& part, double tool_length_mm, Place& place) {
  Vec3 least = Vec3::Constant(1e9), greatest = Vec3::Constant(-1e9);
  for_each_pose(machine, part, place.origin_mm, tool_length_mm, [&](const machines::Joints& joints) {
    least = least.cwiseMin(joints.linear_mm);
    greatest = greatest.cwiseMax(joints.linear_mm);
  });
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& axis = machine.chain.linear[i];
    place.needs_mm[i] = greatest[static_cast<Eigen::Index>(i)] - least[static_cast<Eigen::Index>(i)];
    place.has_mm[i] = axis.max_mm - axis.min_mm - 2 * machine.limit_margin.linear_mm;
  }
}

}  // namespace

std::vector<ToolPlace> face_places(double inner_mm, double outer_mm, double z_low_mm, double z_high_mm) {
  std::vector<ToolPlace> places;
  for (const double r : {inner_mm, outer_mm})
    for (const double z : {z_low_mm, z_high_mm + kApproach})
      for (const double aside : kLeansAside)
        for (const double out : kLeansOut) {
          const Vec3 axis(std::tan(radians(out)), std::tan(radians(aside)), 1);
          places.push_back({Vec3(r, 0, z), axis.normalized()});
        }
  return places;
}

std::vector<ToolPlace> cylinder_places(double z_low_mm, double z_high_mm, double inner_mm, double outer_mm) {
  std::vector<ToolPlace> places;
  for (const double z : {z_low_mm, z_high_mm})
    for (const double r : {inner_mm, outer_mm + kApproach})
      for (const double aside : kLeansAside)
        places.push_back({Vec3(r, 0, z), Vec3(1, std::tan(radians(aside)), 0).normalized()});
  return places;
}

std::vector<ToolPlace> finger_places(double inner_mm, double outer_mm, double pitch_angle_rad, double depth_mm) {
  const double s = std::sin(pitch_angle_rad), c = std::cos(pitch_angle_rad);
  return meridian_places(inner_mm * Vec2(s, c), outer_mm * Vec2(s, c), {c, -s}, depth_mm);
}

std::vector<ToolPlace> meridian_places(const Vec2& from, const Vec2& to, const Vec2& up, double depth_mm) {
  std::vector<ToolPlace> places;
  const Vec3 axis(up.x(), 0, up.y());
  for (const Vec2& at : {from, to})
    for (const double lift : {-depth_mm, depth_mm + kApproach})
      places.push_back({Vec3(at.x(), 0, at.y()) + lift * axis, axis});
  return places;
}

std::optional<double> table_top_mm(const machines::Machine& machine) {
  const Vec3 plate = turns_the_work(machine.chain) ? machine.table_middle_mm() : Vec3::Zero();
  auto top = machine.top_under(Vec3(plate.x(), plate.y(), INFINITY));
  if (machine.table_face_mm) top = std::max(top.value_or(*machine.table_face_mm), *machine.table_face_mm);
  return top;
}

std::optional<Place> place_of(const machines::Machine& machine, const PartInSpace& part, double tool_length_mm) {
  const machines::KinematicChain& chain = machine.chain;
  const bool on_axis = turns_the_work(chain);
  const Vec3 plate = on_axis ? machine.table_middle_mm() : Vec3::Zero();
  const double below = part.up ? -part.z_min_mm : part.z_max_mm;  // of the origin, to the underside
  const auto top = table_top_mm(machine);
  const bool clamped = part.top_above_table_mm && top;
  const double on_table = clamped ? *top + *part.top_above_table_mm - part.top_mm()
                                  : top.value_or(plate.z()) + kFixture + below,
               lowest = clamped ? on_table
                                : on_table +
                                      rise_off_bodies(machine, part, {plate.x(), plate.y(), on_table}, tool_length_mm);
  Vec3 origin(plate.x(), plate.y(), clamped ? lowest : std::round(lowest));

  choice::TravelPoses poses(chain, machine.limit_margin,
                            on_axis ? std::optional(chain.table.front().direction) : std::nullopt);
  std::size_t reached = 0;
  for_each_pose(machine, part, origin, tool_length_mm, [&](const machines::Joints& joints) {
    poses.note(joints);
    ++reached;
  });
  if (reached == 0) return std::nullopt;
  Place result;
  result.origin_mm = origin;
  result.room_mm = poses.room(Vec3::Zero());
  if (const auto offer = poses.best()) {
    Vec3 shift = offer->shift_mm;
    for (int i = 0; i < 3; ++i) shift[i] = std::round(shift[i]);
    if (clamped) shift.z() = 0;
    else if (top) shift.z() = std::max(shift.z(), std::ceil(lowest - origin.z()));
    result.origin_mm += shift;
    result.room_mm = poses.room(shift);
  }
  measure_travels(machine, part, tool_length_mm, result);
  return result;
}

}  // namespace toothpath::proposal
