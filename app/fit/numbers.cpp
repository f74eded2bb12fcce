#include "app/fit/numbers.h"

#include <cmath>
#include <type_traits>

#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "geometry/spiral_bevel/gear.h"
#include "geometry/spiral_bevel/set_up.h"
#include "geometry/straight_bevel/gear.h"
#include "geometry/tooth_space/modified_part.h"

namespace toothpath::fit {
namespace {

using cylindrical::CylindricalParameters;
using spiral_bevel::SpiralBevelParameters;
using straight_bevel::StraightBevelParameters;

constexpr double kAngleReach = 3;     // deg
constexpr double kLengthReach = 0.5;  // modules
constexpr double kRatioReach = 0.03;  // of the ratio of roll
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

Numbers numbers_in(const CylindricalParameters& p, const job::Job&) {
  using P = CylindricalParameters;
  Numbers out;
  out.module_mm = p.module_mm;
  out.teeth = p.teeth;
  out.free.push_back(number<P>("profile_shift", "", 0.5, [](P& g) -> double& { return g.profile_shift; }));
  const bool alike = p.zones.size() == 2 &&
                     std::abs(std::abs(p.zones[0].helix_angle_rad) - std::abs(p.zones[1].helix_angle_rad)) < kAsWide;
  for (std::size_t k = 0; k < p.zones.size(); ++k) {
    Number helix = number<P>(fmt::format("zone[{}].helix_angle", k), "deg", kAngleReach,
                             [k](P& g) -> double& { return g.zones[k].helix_angle_rad; });
    (k > 0 && alike ? out.follow : out.free).push_back(within(std::move(helix), -60, 60));
  }
  if (alike) {
    const double sign = p.zones[0].helix_angle_rad * p.zones[1].helix_angle_rad < 0 ? -1 : 1;
    out.settle = [sign](Gear& gear) {
      auto& zones = std::get<P>(gear).zones;
      zones[1].helix_angle_rad = sign * zones[0].helix_angle_rad;
    };
  }
  out.free.push_back(within(
      number<P>("pressure_angle", "deg", kAngleReach, [](P& g) -> double& { return g.pressure_angle_rad; }), 5, 40));
  out.free.push_back(within(number<P>("thickness_allowance", "mm", kLengthReach * p.module_mm,
                                      [](P& g) -> double& { return g.thickness_allowance_mm; }),
                            -INFINITY, 0));
  out.free.push_back(seldom(number<P>("module", "mm", 0.1 * p.module_mm, [](P& g) -> double& { return g.module_mm; })));
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
  out.free.push_back(within(
      number<P>("pressure_angle", "deg", kAngleReach, [](P& g) -> double& { return g.pressure_angle_rad; }), 5, 40));
  if (job.positions.contains("gear.pitch_angle"))
    out.free.push_back(
        within(seldom(number<P>("pitch_angle", "deg", kAngleReach, [](P& g) -> double& { return g.pitch_angle_rad; })),
               1, 89));
  out.free.push_back(
      within(seldom(number<P>("backlash", "mm", kLengthReach * module, [](P& g) -> double& { return g.backlash_mm; })),
             0, INFINITY));
  out.free.push_back(seldom(number<P>("outer_transverse_module", "mm", 0.1 * module,
                                      [](P& g) -> double& { return g.outer_transverse_module_mm; })));
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

template <typename P>
concept HasNumbers = requires(const P& p, const job::Job& job) {
  numbers_in(p, job);
};

Expected<Spaces, Refusal> plain_spaces(const CylindricalParameters& p) {
  Spaces out;
  for (const auto& zone : p.zones)
    out.push_back(std::make_shared<const cylindrical::InvoluteSpace>(cylindrical::InvoluteKernel<double>(p, zone)));
  return out;
}
Expected<Spaces, Refusal> plain_spaces(const StraightBevelParameters& p) {
  return Spaces{std::make_shared<const straight_bevel::CrownSpace>(straight_bevel::CrownKernel<double>(p))};
}
Expected<Spaces, Refusal> plain_spaces(const SpiralBevelParameters& p) {
  auto made = spiral_bevel::set_up(p);
  if (auto* refusal = made.refused()) return std::move(*refusal);
  return Spaces{std::make_shared<const spiral_bevel::CutterSpace>(std::move(made.value().kernel))};
}

/// With its modifications a gear must be whole.
template <typename Made>
Expected<std::shared_ptr<const tooth_space::ToothedPart>, Refusal> whole(const Made& made) {
  if (const auto* refusals = made.refused()) return refusals->front();
  return part_of(*made);
}
auto whole_gear(const CylindricalParameters& p) { return whole(cylindrical::CylindricalGear::make(p)); }
auto whole_gear(const StraightBevelParameters& p) { return whole(straight_bevel::StraightBevelGear::make(p)); }
auto whole_gear(const SpiralBevelParameters& p) { return whole(spiral_bevel::SpiralBevelGear::make(p)); }

template <typename P>
Expected<Spaces, Refusal> modified_spaces(const P& p, const std::vector<modification::Modification>& modifications) {
  auto plain = whole_gear(p);
  if (auto* refusal = plain.refused()) return std::move(*refusal);
  auto part = tooth_space::modified_part(std::move(plain).value(), modifications);
  if (auto* refusal = part.refused()) return std::move(*refusal);
  Spaces out;
  for (int zone = 0; zone < part.value()->zones(); ++zone) out.emplace_back(part.value(), &part.value()->space(zone));
  return out;
}

}  // namespace

Result<Numbers> numbers_of(const job::Job& job) {
  return std::visit(
      [&](const auto& gear) -> Result<Numbers> {
        if constexpr (HasNumbers<std::remove_cvref_t<decltype(gear)>>) return numbers_in(gear, job);
        else
          return fail_at(job.where("gear.type"),
                         "type = \"{}\" is not fitted: cylindrical_gear, straight_bevel_gear and spiral_bevel_gear "
                         "are; `toothpath new --points` makes a flank_grid of any points",
                         job.gear_type());
      },
      job.gear);
}

Expected<Spaces, Refusal> spaces_of(const Gear& gear, const job::Job& like) {
  return std::visit(
      [&](const auto& p) -> Expected<Spaces, Refusal> {
        if constexpr (HasNumbers<std::remove_cvref_t<decltype(p)>>)
          return like.modifications.empty() ? plain_spaces(p) : modified_spaces(p, like.modifications);
        else return Refusal{"type", fail("is not fitted")};
      },
      gear);
}

}  // namespace toothpath::fit
