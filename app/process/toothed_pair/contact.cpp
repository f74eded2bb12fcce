#include "app/process/toothed_pair/contact.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/process/rolled/figures.h"
#include "app/process/under_load/settings.h"
#include "geometry/base/work_share.h"

namespace toothpath::toothed_pair {
namespace {

/// By what runs along the teeth.
const ease_off::PairWords& words_of(const tooth_space::Outline& ring) {
  const auto words = [](const char* part, const ease_off::CoordinateWords& x, const ease_off::CoordinateWords& y) {
    return ease_off::flank_words(part, x, y, "mate's flank ends", "radius of the flank's middle");
  };
  static const ease_off::PairWords kAcross = words("ring", {"r", "r", "radius from the gear's axis [mm]"},
                                                   {"z", "z", "height z [mm]"}),
                                   kUp = words("zone", {"z", "z", "z [mm]"}, {"r", "r", "radius [mm]"}),
                                   kCone = words("zone", {"cone_distance", "cone distance", "cone distance [mm]"},
                                                 {"height", "height", "height above the pitch cone [mm]"}),
                                   kAlong = words("zone", {"along", "along the teeth", "along the teeth [mm]"},
                                                  {"height", "height", "height [mm]"});
  const std::string_view along = ring.along;
  return along == "radius" ? kAcross : along == "z" ? kUp : along == "cone distance" ? kCone : kAlong;
}

/// Both gears in their roles.
struct Roles {
  const JobGear &gear, &pinion;
};
Roles roles_of(const JobGear& job, const JobGear& mate, const Shafts& shafts) {
  return shafts.job_is_gear ? Roles{job, mate} : Roles{mate, job};
}

/// What rolls them.
struct Asked {
  contact::ToothedPair pair;
  contact::RollOptions options;
  bool modified = false;
};

Result<rolled::RolledSide> side_of(const Asked& asked, std::vector<contact::ToothedMember> members, bool as_cut) {
  rolled::RolledSide side;
  side.side = members.front().flank.side;
  side.as_cut = as_cut;
  side.modified = asked.modified;
  side.pitch_rad = members.front().pitch();
  for (const auto& member : members) side.flanks.push_back(rolled::rolled_flank(member.flank));
  auto rolled = contact::roll(members, asked.options);
  if (!rolled) return rolled.error();
  side.roll = std::move(*rolled);
  const bool conjugate = side.roll.error_range_rad < rolled::kNoError;
  side.kind = as_cut ? "cut" : asked.modified ? "modified" : conjugate ? "conjugate" : "point";
  if (conjugate)  // along lines: the first place of each that is found is none of a path
    for (auto& pattern : side.roll.patterns) pattern.path.clear();
  if (auto found = contact::ease_off(members)) side.ease_off = std::move(*found);
  for (std::size_t m = 0; side.ease_off && m < members.size(); ++m)
    side.places.push_back(contact::pattern_place(members[m], side.ease_off->maps[m], side.roll.patterns[m],
                                                 asked.options.compound_mm, 0));
  return side;
}

/// The members of one side with the flanks as they were cut.
Result<std::vector<contact::ToothedMember>> as_cut(std::vector<contact::ToothedMember> members,
                                                   const process::CutFlanks& cut) {
  for (auto& member : members) {
    const auto f = std::find_if(cut.flanks.begin(), cut.flanks.end(), [&](const process::CutFlanks::Flank& flank) {
      return flank.zone == member.flank.zone && flank.side == member.flank.side;
    });
    if (f == cut.flanks.end())
      return fail("the cut surface has no flank {:+} in zone {}", member.flank.side, member.flank.zone);
    if (std::find(f->reached.begin(), f->reached.end(), 0) != f->reached.end())
      return fail("the mills do not reach all of flank {:+} in zone {}: what is left there has no measure to be rolled",
                  f->side, f->zone);
    auto flank = contact::measured_flank(member.flank, f->rows, f->columns, f->nominal, f->deviation_mm);
    if (!flank) return flank.error();
    member.flank = std::move(*flank);
  }
  return members;
}

/// The pair off its place, where the job has a box of misalignments.
process::ValueOrErrors<ease_off::Misaligned> misaligned(const JobGear& job, const Roles& roles, const Shafts& shafts,
                                                        const rolled::RolledPair& a, const Asked& as_it_stands) {
  if (!a.settings.box) return ease_off::Misaligned{};
  const double margin = a.settings.box->margin;
  ease_off::MisalignmentTable table{a.words, a.settings.box->most, margin, a.settings.compound_mm, a.pitch_radius_mm,
                                    {}};
  auto rows = ease_off::roll_rows(
      [&](std::size_t s, const contact::Misalignment& moved) -> Result<contact::MisalignedContact> {
        Asked asked = as_it_stands;
        asked.pair.place = shafts.place(shafts, roles.gear, roles.pinion, moved);
        auto members = contact::toothed_members(asked.pair, s == 0 ? 1 : -1);
        if (!members) return members.error();
        const auto rolled = contact::roll(*members, asked.options);
        if (!rolled) return rolled.error();
        const auto map = contact::ease_off(*members);
        if (!map) return map.error();
        auto found = contact::MisalignedContact::at(moved);
        found.error_mean_rad = rolled->error_mean_rad;
        found.error_range_rad = rolled->error_range_rad;
        for (std::size_t m = 0; m < members->size(); ++m) {
          const auto place = [&](double width) {
            return contact::pattern_place((*members)[m], map->maps[m], rolled->patterns[m], asked.options.compound_mm,
                                          width);
          };
          found.add_ring((*members)[m].flank.zone, place(0), place(margin));
        }
        return found;
      },
      ease_off::single_misalignments(a.settings.moved, a.settings.box->most));
  if (!rows) return std::vector{process::located(job.job, "contact.misalignment", rows.error())};
  table.rows = std::move(*rows);
  ease_off::Misaligned out;
  out.table = std::move(table);
  return out;
}

std::string about(const rolled::RolledPair& a) {
  return fmt::format(
      "Both gears are the surfaces of their jobs, modifications included: {} and {} teeth on shafts at {:g} deg, "
      "{:.6g} mm "
      "apart. For every place of the gear's flank the turn at which the mate's flank passes through it is found; the "
      "first of them, edges included, is contact.",
      a.gear_teeth, a.pinion_teeth, degrees(a.shaft_angle_rad), a.distance_mm);
}

}  // namespace

process::ValueOrErrors<Shafts> accepted(const JobGear& job, const JobGear& mate, const process::ContactAsked& asked) {
  const auto refuse = [&](std::string message) {
    return std::vector{
        fail_at(job.job.where("gear.type"), "type = \"{}\" with --mate: {}", job.job.gear_type(), message)};
  };
  if (asked.torque_Nm || !asked.ccx_dir.empty() || (job.job.contact && job.job.contact->load))
    return refuse(fmt::format(
        "no load is rolled, because there is no elastic model of such pairs; face gears with the pinion of their "
        "shaper and equal_base_circle_bevel_gear pairs have one{}",
        job.job.face_gear() && mate.job.cylindrical_gear()
            ? fmt::format(": leave out --mate, --pinion-teeth {} is that pinion", mate.part->teeth())
            : ""));
  if (asked.optimise)
    return refuse("--optimise knows face gears with the pinion of their shaper and equal_base_circle_bevel_gear pairs");
  if (asked.pinion_teeth) return refuse("--pinion-teeth contradicts the mate, which has its own");
  return shafts_of(job, mate, asked);
}

process::ValueOrErrors<process::ContactFound> roll_pair(const JobGear& job, const JobGear& mate, const Shafts& shafts,
                                                        const process::ContactAsked& asked,
                                                        const process::CutFlanks* cut, app::StageClock& clock) {
  const Roles roles = roles_of(job, mate, shafts);
  rolled::RolledPair a;
  a.words = &words_of(roles.gear.part->space(0).outline());
  a.job_name = job.job.name, a.job_file = job.job.file, a.mate = mate.job.file;
  a.settings = under_load::contact_settings(job.job, asked);
  a.settings.pinion_teeth = a.pinion_teeth = roles.pinion.part->teeth();
  a.gear_teeth = roles.gear.part->teeth();
  if (shafts.pinion_carries) std::swap(a.carrier, a.other);
  a.shaft_angle_rad = std::abs(shafts.angle_rad), a.distance_mm = shafts.distance_mm;
  Asked rolls;
  rolls.pair = {roles.gear.part.get(), roles.pinion.part.get(),
                shafts.place(shafts, roles.gear, roles.pinion, a.settings.moved)};
  rolls.options.compound_mm = a.settings.compound_mm;
  rolls.options.steps = 32;
  const auto modified = [](const job::Job& of) {
    return !of.modifications.empty() || (of.face_gear() != nullptr && !of.face_gear()->modifications.empty()) ||
           (of.bevel_gear() != nullptr && !of.bevel_gear()->modifications.empty());
  };
  rolls.modified = modified(job.job) || modified(mate.job);
  auto done = clock.run("contact", [&]() -> Status {
    const WorkShare share(cut ? 4 : 2);
    std::vector<rolled::RolledSide> cut_sides;
    for (const int side : {1, -1}) {
      auto members = contact::toothed_members(rolls.pair, side);
      if (!members) return process::located(job.job, "gear", members.error());
      const auto& flank = members->front().flank;
      a.pitch_radius_mm = radius(flank.points[flank.index(flank.rows / 2, flank.columns / 2)]);
      if (cut) {
        auto made = as_cut(*members, *cut);
        if (!made) return process::located(job.job, "gear", made.error());
        auto found = side_of(rolls, std::move(*made), true);
        if (!found) return process::located(job.job, "gear", found.error());
        cut_sides.push_back(std::move(*found));
      }
      auto found = side_of(rolls, std::move(*members), false);
      if (!found) return process::located(job.job, "gear", found.error());
      a.sides.push_back(std::move(*found));
    }
    for (auto& side : cut_sides) a.sides.push_back(std::move(side));
    return Ok{};
  });
  if (!done) return std::vector{done.error()};
  if (cut) {
    a.route = cut->route;
    a.notes = process::notes_of(*cut);
    if (cut->route == "measured") a.notes.insert(a.notes.end(), cut->warnings.begin(), cut->warnings.end());
  }
  auto off = clock.run("misalignments", [&] { return misaligned(job, roles, shafts, a, rolls); });
  if (auto* errors = off.refused()) return std::move(*errors);
  a.misaligned = std::move(off).value();
  process::ContactFound found;
  found.json = rolled::contact_json(a);
  found.summary = rolled::contact_summary(a);
  found.files = rolled::contact_files(a, about(a));
  return found;
}

}  // namespace toothpath::toothed_pair
