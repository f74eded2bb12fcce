#include "app/process/cylinder/process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/process/cylinder/limits.h"
#include "app/process/milled/toothed_process.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"

namespace toothpath::cylinder {
namespace {

using cylindrical::CylindricalGear;
using cylindrical::CylindricalParameters;

std::string gear_words(const CylindricalGear& gear) {
  const CylindricalParameters& p = gear.parameters();
  std::string text = fmt::format(
      "cylindrical gear, z {}, {} module {:g} mm, pressure angle {:g} deg, "
      "profile shift {:g}, tip diameter {:.3f} mm",
      p.teeth, p.module_plane == ModulePlane::normal ? "normal" : "transverse", p.module_mm,
      degrees(p.pressure_angle_rad), p.profile_shift, gear.tip_diameter());
  for (const auto& zone : p.zones)
    text += fmt::format(
        "; z {:g} to {:g} mm, {}", zone.from_mm, zone.to_mm,
        zone.helix_angle_rad == 0 ? std::string("spur") : fmt::format("helix {:g} deg", degrees(zone.helix_angle_rad)));
  return text;
}

double lower_end(const CylindricalGear& gear) { return gear.parameters().zones.front().from_mm; }
double upper_end(const CylindricalGear& gear) { return gear.parameters().zones.back().to_mm; }

/// Links and rapids keep clear of the blank: a cylinder, its bore closed.
milled::GearBody body_of(const CylindricalGear& gear) {
  const double r = 0.5 * gear.tip_diameter();
  return {{r, lower_end(gear), upper_end(gear)}, {r, 0, upper_end(gear), lower_end(gear)}};
}

const char* kind_of(const CylindricalParameters& p) {
  if (p.zones.size() > 1) return "double helical";
  return p.zones.front().helix_angle_rad == 0 ? "spur" : "helical";
}

milled::ToothedGear toothed(CylindricalGear made) {
  const auto owner = std::make_shared<const CylindricalGear>(std::move(made));
  const CylindricalGear& gear = *owner;
  const CylindricalParameters& p = gear.parameters();
  milled::ToothedGear out;
  out.part = cylindrical::part_of(gear);
  out.solid = drawn_solid(gear);
  out.owner = owner;
  out.facts = {p.teeth, gear.tip_diameter(), gear.tip_diameter(), {}};
  out.least_land_mm = p.least_land * p.module_mm;
  out.body = body_of(gear);
  out.outline = {0.5 * gear.root_diameter(),
                 0.5 * gear.tip_diameter(),
                 upper_end(gear),
                 lower_end(gear),
                 lower_end(gear),
                 gear_words(gear)};
  out.outline.around = true;
  out.subtitle =
      fmt::format("cylindrical gear z {}, module {} mm, {}", p.teeth, svg::short_number(p.module_mm), kind_of(p));
  out.limits_json = [owner] { return limits_json(*owner); };
  out.limit_charts = limit_charts(gear);
  return out;
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_cylindrical_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return milled::toothed_process(job, toothed(std::move(made).value()));
}

}  // namespace toothpath::cylinder
