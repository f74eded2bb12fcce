#include "app/fit/numbers.h"

#include <cmath>
#include <type_traits>

#include "app/job/form_mill.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/reference_radius.h"
#include "geometry/spiral_bevel/set_up.h"

namespace toothpath::fit {
namespace {

using bevel_gear::BevelGearParameters;
using cylindrical::CylindricalParameters;
using face_gear::FaceGearParameters;
using spiral_bevel::SpiralBevelParameters;
using straight_bevel::StraightBevelParameters;

constexpr double kAngleReach = 3;     // deg
constexpr double kLengthReach = 0.5;  // modules
constexpr double kRatioReach = 0.03;  // of the ratio of roll
constexpr double kJustBelow = 1e-9;   // of a length that a number must stay below
constexpr double kAsWide = 1e-9;      // rad: two zones with as much helix angle

/// @param of  the number in the parameters, in mm or rad
template <typename P, typename Of>
Number number(std::string key, const char* unit, double reach, Of of) {
  const double scale = std::string_view(unit) == "deg" ? kDegree : 1;
  Number out{std::move(key), unit, reach};
  out.get = [of, scale](const Gear& gear) {
    P p = std::get<P>(gear);
    return of(p) / scale;
  };
  out.set = [of, scale](Gear& gear, double value) { of(std::get<P>(gear)) = value * scale; };
  return out;
}
Number seldom(Number n) {
  n.usual = false;
  return n;
}
Number within(Number n, double least, double most) {
  n.least = least;
  n.most = most;
  return n;
}

// Numbers of several types.

template <typename P>
Number pressure_angle() {
  return within(number<P>("pressure_angle", "deg", kAngleReach, [](P& g) -> double& { return g.pressure_angle_rad; }),
                5, 40);
}
template <typename P>
Number module(double size) {
  return number<P>("module", "mm", 0.1 * size, [](P& g) -> double& { return g.module_mm; });
}
template <typename P>
Number outer_transverse_module(double size) {
  return number<P>("outer_transverse_module", "mm", 0.1 * size,
                   [](P& g) -> double& { return g.outer_transverse_module_mm; });
}
template <typename P>
Number pitch_angle() {
  return number<P>("pitch_angle", "deg", kAngleReach, [](P& g) -> double& { return g.pitch_angle_rad; });
}
/// @param module  below which it must stay
template <typename P>
Number backlash(double module) {
  return within(number<P>("backlash", "mm", kLengthReach * module, [](P& g) -> double& { return g.backlash_mm; }), 0,
                (1 - kJustBelow) * module);
}

/// Of every zone; two zones of as much angle keep that.
template <typename P>
void add_helix_angles(const P& p, Numbers& out) {
  const auto& zones = p.zones;
  const bool alike =
      zones.size() == 2 && std::abs(std::abs(zones[0].helix_angle_rad) - std::abs(zones[1].helix_angle_rad)) < kAsWide;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    Number helix = number<P>(fmt::format("zone[{}].helix_angle", k), "deg", kAngleReach,
                             [k](P& g) -> double& { return g.zones[k].helix_angle_rad; });
    (k > 0 && alike ? out.follow : out.free).push_back(within(std::move(helix), -60, 60));
  }
  if (!alike) return;
  const double sign = zones[0].helix_angle_rad * zones[1].helix_angle_rad < 0 ? -1 : 1;
  out.settle = [sign](Gear& gear) {
    auto& its = std::get<P>(gear).zones;
    its[1].helix_angle_rad = sign * its[0].helix_angle_rad;
  };
}

Numbers numbers_in(const FaceGearParameters& p, const job::Job&) {
  using P = FaceGearParameters;
  Numbers out;
  out.module_mm = p.module_mm;
  out.teeth = p.teeth;
  const double length = kLengthReach * p.module_mm;
  out.free.push_back(backlash<P>(p.module_mm));
  add_helix_angles(p, out);
  out.free.push_back(pressure_angle<P>());
  if (p.zones.size() == 2)  // of one zone it turns the gear and no more
    out.free.push_back(within(number<P>("reference_radius", "mm", length,
                                        [](P& g) -> double& {
                                          g.reference_radius_mm = face_gear::reference_radius_of(g);
                                          return *g.reference_radius_mm;
                                        }),
                              1e-3, INFINITY));
  out.free.push_back(
      within(number<P>("shaft_angle", "deg", kAngleReach, [](P& g) -> double& { return g.shaft_angle_rad; }), 60, 120));
  const double most = (1 - kJustBelow) * p.zones.front().inner_radius_mm;
  out.free.push_back(
      within(number<P>("offset", "mm", length, [](P& g) -> double& { return g.offset_mm; }), -most, most));
  out.free.push_back(seldom(module<P>(p.module_mm)));
  return out;
}

Numbers numbers_in(const BevelGearParameters& p, const job::Job& job) {
  using P = BevelGearParameters;
  const double module = p.outer_transverse_module_mm, length = kLengthReach * module;
  Numbers out;
  out.module_mm = module;
  out.teeth = p.teeth;
  out.free.push_back(backlash<P>(module));
  out.free.push_back(pressure_angle<P>());
  out.free.push_back(within(
      number<P>("outer_spiral_angle", "deg", kAngleReach, [](P& g) -> double& { return g.outer_spiral_angle_rad; }), 0,
      60));
  if (p.form == bevel_gear::BevelForm::herringbone)  // of a single hand it turns the gear and no more
    out.free.push_back(
        within(number<P>("apex_cone_distance", "mm", length, [](P& g) -> double& { return g.apex_cone_distance_mm; }),
               1e-3, INFINITY));
  if (job.positions.contains("gear.pitch_angle")) out.free.push_back(within(seldom(pitch_angle<P>()), 0.01, 90));
  out.free.push_back(seldom(outer_transverse_module<P>(module)));
  if (p.mill)
    out.free.push_back(
        within(seldom(number<P>("mill.module", "mm", 0.1 * module, [](P& g) -> double& { return g.mill->module_mm; })),
               0.01, 100));
  return out;
}

Numbers numbers_in(const CylindricalParameters& p, const job::Job&) {
  using P = CylindricalParameters;
  Numbers out;
  out.module_mm = p.module_mm;
  out.teeth = p.teeth;
  out.free.push_back(number<P>("profile_shift", "", 0.5, [](P& g) -> double& { return g.profile_shift; }));
  add_helix_angles(p, out);
  out.free.push_back(pressure_angle<P>());
  out.free.push_back(within(number<P>("thickness_allowance", "mm", kLengthReach * p.module_mm,
                                      [](P& g) -> double& { return g.thickness_allowance_mm; }),
                            -INFINITY, 0));
  out.free.push_back(seldom(module<P>(p.module_mm)));
  return out;
}

Numbers numbers_in(const StraightBevelParameters& p, const job::Job& job) {
  using P = StraightBevelParameters;
  const double module = p.outer_transverse_module_mm;
  Numbers out;
  out.module_mm = module;
  out.teeth = p.teeth;
  out.free.push_back(
      within(number<P>("thickness_shift", "", 0.25, [](P& g) -> double& { return g.thickness_shift; }), -0.5, 0.5));
  out.free.push_back(pressure_angle<P>());
  if (job.positions.contains("gear.pitch_angle")) out.free.push_back(within(seldom(pitch_angle<P>()), 1, 89));
  out.free.push_back(seldom(backlash<P>(module)));
  out.free.push_back(seldom(outer_transverse_module<P>(module)));
  return out;
}

/// Settings of one set-up of the generator.
void add_cut(const SpiralBevelParameters& p, std::size_t c, double module, Numbers& out) {
  using P = SpiralBevelParameters;
  using spiral_bevel::Cut, spiral_bevel::Cuts;
  const Cut& cut = p.cuts[c];
  const double reach = kLengthReach * module;
  const auto key = [c](const char* name) { return fmt::format("cut[{}].{}", c, name); };
  const auto setting = [&](const char* name, const char* unit, double far, double Cut::*member) {
    return number<P>(key(name), unit, far, [c, member](P& g) -> double& { return g.cuts[c].*member; });
  };
  const auto blades = [&](const char* name, const char* unit, double far, double spiral_bevel::Blade::*member) {
    for (std::size_t k = 0; k < 2; ++k)
      if (cut.makes(k == 0 ? Cuts::concave : Cuts::convex))
        out.free.push_back(
            within(number<P>(cut.flank == Cuts::both ? fmt::format("{}[{}]", key(name), k) : key(name), unit, far,
                             [c, k, member](P& g) -> double& { return g.cuts[c].blades[k].*member; }),
                   std::string_view(unit) == "deg" ? 1 : 0.1, INFINITY));
  };
  blades("blade_pressure_angle", "deg", kAngleReach, &spiral_bevel::Blade::pressure_angle_rad);
  out.free.push_back(within(setting("radial_distance", "mm", reach, &Cut::radial_distance_mm), 0, INFINITY));
  out.free.push_back(setting("center_roll_position", "deg", kAngleReach, &Cut::cradle_angle_rad));
  if (cut.generated)
    out.free.push_back(setting("ratio_of_roll", "", kRatioReach * cut.ratio_of_roll, &Cut::ratio_of_roll));
  out.free.push_back(setting("work_offset", "mm", reach, &Cut::work_offset_mm));
  out.free.push_back(setting("sliding_base", "mm", reach, &Cut::sliding_base_mm));
  blades("blade_point_radius", "mm", reach, &spiral_bevel::Blade::point_radius_mm);
  out.free.push_back(within(seldom(setting("cutter_tilt", "deg", kAngleReach, &Cut::tilt_rad)), -45, 45));
  if (cut.tilt_rad != 0) out.free.push_back(seldom(setting("cutter_swivel", "deg", 10, &Cut::swivel_rad)));
  out.follow.push_back(setting("machine_center_to_crossing_point", "mm", reach, &Cut::machine_center_mm));
}

Numbers numbers_in(const SpiralBevelParameters& p, const job::Job&) {
  using P = SpiralBevelParameters;
  Numbers out;
  out.module_mm = 2 * p.outer_cone_distance_mm * std::sin(p.pitch_angle_rad) / p.teeth;
  out.teeth = p.teeth;
  if (p.cuts.size() == 2 && p.backlash_mm) {
    out.free.push_back(within(
        number<P>("backlash", "mm", kLengthReach * out.module_mm, [](P& g) -> double& { return *g.backlash_mm; }), 0,
        INFINITY));
  } else if (p.cuts.size() == 2) {
    Number width = number<P>("mean_space_width", "mm", kLengthReach * out.module_mm, [](P& g) -> double& {
      if (!g.mean_space_width_mm) g.mean_space_width_mm = spiral_bevel::asked_space_width(g);
      return *g.mean_space_width_mm;
    });
    out.free.push_back(within(std::move(width), 1e-3, INFINITY));
  }
  for (std::size_t c = 0; c < p.cuts.size(); ++c) add_cut(p, c, out.module_mm, out);
  // One root cone for all cuts, its apex where it stands: points of flanks do not say how deep the blades went.
  for (std::size_t c = 0; c < p.cuts.size(); ++c) {
    Number angle = number<P>(fmt::format("cut[{}].machine_root_angle", c), "deg", kAngleReach,
                             [c](P& g) -> double& { return g.cuts[c].root_angle_rad; });
    angle.where_written = p.root_angle_rad.has_value();
    (c > 0 ? out.follow : out.free).push_back(within(std::move(angle), 0.5, 90));
  }
  if (p.root_angle_rad)
    out.follow.push_back(
        number<P>("root_angle", "deg", kAngleReach, [](P& g) -> double& { return *g.root_angle_rad; }));
  out.settle = [start = p](Gear& gear) {
    auto& g = std::get<P>(gear);
    const double turned_by = g.cuts[0].root_angle_rad - start.cuts[0].root_angle_rad;
    if (g.root_angle_rad) g.root_angle_rad = *start.root_angle_rad + turned_by;
    for (std::size_t c = 0; c < g.cuts.size(); ++c) {
      auto& cut = g.cuts[c];
      cut.root_angle_rad = start.cuts[c].root_angle_rad + turned_by;
      cut.machine_center_mm =
          -spiral_bevel::root_apex_z(start.cuts[c]) - cut.sliding_base_mm / std::sin(cut.root_angle_rad);
    }
  };
  return out;
}

}  // namespace

Result<Numbers> numbers_of(const job::Job& job) {
  if (job.flank_grid())
    return fail_at(
        job.where("gear.type"),
        "type = \"{}\" is not fitted, it has no numbers but its points: `toothpath new --points` makes one of "
        "any points",
        job.gear_type());
  if (job.bevel_gear())
    if (const auto mill = job::form_mill(job); !mill) return mill.error();
  return std::visit(
      [&](const auto& gear) -> Numbers {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(gear)>, flank_grid::FlankGridParameters>) return {};
        else return numbers_in(gear, job);
      },
      job.gear);
}

}  // namespace toothpath::fit
