#include "app/studies/trials/dhfg_trial.h"

#include <algorithm>
#include <cmath>

#include "cam/plan/milling.h"
#include "geometry/base/angle.h"
#include "geometry/contact/tooth_contact.h"
#include "geometry/face_gear/part.h"

namespace toothpath::trials {
namespace {

constexpr int kTrialRows = 11, kTrialColumns = 17, kTrialSteps = 24;

/// Limits, the radii chosen between them, and the gear itself.
std::optional<face_gear::FaceGear> make_trial_gear(const DhfgStudy& study, DhfgTrial& trial) {
  face_gear::FaceGearParameters p = study.base;
  p.teeth = trial.teeth;
  p.shaper_teeth = trial.pinion_teeth;
  p.offset_mm = 0;
  if (const auto sound = face_gear::check_shaper(p, trial.helix_angle_rad); !sound) {
    trial.refusal = sound.error().message;
    return std::nullopt;
  }
  const auto surface = face_gear::make_surface<double>(p, trial.helix_angle_rad);
  const face_gear::ZoneLimits limits = face_gear::zone_limits(surface, p.module_mm);
  trial.R1_mm = limits.inner_limit;
  trial.R1_name = limits.inner_limit_name;
  trial.R2_mm = limits.pointing_radius.value_or(0);
  trial.land_mm = limits.land_radius.value_or(0);
  trial.L_p_mm = surface.L_p;
  trial.inner_mm = trial.R1_mm + study.margin_mm;
  trial.outer_mm = trial.land_mm - study.margin_mm;
  trial.groove_mm = (trial.inner_mm + trial.outer_mm) / 2;
  trial.feasible_mm = (trial.outer_mm - trial.inner_mm - study.groove_width_mm) / 2;
  if (!(trial.feasible_mm > 0)) {
    trial.refusal = fmt::format("band {:.3f} to {:.3f} mm leaves no room beside a groove of {:g} mm", trial.inner_mm,
                                trial.outer_mm, study.groove_width_mm);
    return std::nullopt;
  }
  trial.half_face_mm = study.half_face_mm > 0 ? std::min(study.half_face_mm, trial.feasible_mm) : trial.feasible_mm;
  trial.inner_mm = trial.groove_mm - study.groove_width_mm / 2 - trial.half_face_mm;
  trial.outer_mm = trial.groove_mm + study.groove_width_mm / 2 + trial.half_face_mm;
  p.reference_radius_mm = trial.groove_mm;
  const double w = study.groove_width_mm / 2;
  p.zones = {{-trial.helix_angle_rad, trial.inner_mm, trial.groove_mm - w},
             {trial.helix_angle_rad, trial.groove_mm + w, trial.outer_mm}};
  auto made = face_gear::FaceGear::make(p);
  if (auto* refused = made.refused()) {
    trial.refusal = refused->front().diagnostic.message;
    return std::nullopt;
  }
  return std::move(made).value();
}

void roll_trial(const face_gear::FaceGear& gear, DhfgTrial& trial) {
  const auto rolled_on = [&](const std::vector<int>& zones) -> Result<contact::RollResult> {
    std::vector<contact::ContactMember> members;
    for (const int zone : zones) {
      auto flank = contact::exact_flank(gear, zone, 1, kTrialRows, kTrialColumns);
      if (!flank) return flank.error();
      members.push_back({std::move(*flank), contact::make_pinion(gear.rings()[static_cast<std::size_t>(zone)].surface,
                                                                 trial.pinion_teeth)});
    }
    return roll(members, {.steps = kTrialSteps});
  };
  for (const int zone : {0, 1}) {
    const auto half = rolled_on({zone});
    if (half) trial.overlap_halves[zone] = half->contact_ratio;
    else trial.refusal = half.error().message;
  }
  const auto both = rolled_on({0, 1});
  if (!both) {
    trial.refusal = both.error().message;
    return;
  }
  trial.overlap = both->contact_ratio;
  trial.least_pairs = both->least_touching;
  trial.most_pairs = both->most_touching;
  trial.error_range_rad = both->error_range_rad;
  trial.marked_share = 1;
  for (const auto& pattern : both->patterns) trial.marked_share = std::min(trial.marked_share, pattern.marked_share);
}

MillingTime mill(const DhfgStudy& study, const face_gear::FaceGear& gear) {
  MillingTime time;
  if (study.operations.empty()) {
    time.refusal = "no operation";
    return time;
  }
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of(study.tools));
  plan::Options options;
  options.limits.gouge_mm = 1.0;  // paths are timed, not cut: coarse chords are no refusal
  const auto planned = plan::plan_milling(part, study.tools, study.operations, options);
  if (const auto* refusal = planned.refused()) {
    time.refusal = refusal->key + ": " + refusal->diagnostic.message;
    return time;
  }
  for (const path::ClPath& path : planned.value().paths) {
    time.cl_points += path.records.size();
    for (std::size_t k = 1; k < path.records.size(); ++k) {
      const double length = (path.records[k].tip - path.records[k - 1].tip).norm();
      const double feed = path.records[k].feed_mm_min;
      if (feed > 0) time.cutting_minutes += length / feed;
      else time.rapid_minutes += length / study.rapid_mm_min;
    }
  }
  time.cutting_minutes *= gear.parameters().teeth;
  time.rapid_minutes *= gear.parameters().teeth;
  return time;
}

DhfgTrial begin_trial(const DhfgStudy& study, const TrialLevels& levels) {
  DhfgTrial trial;
  trial.levels = levels;
  trial.pinion_teeth = static_cast<int>(std::lround(study.pinion_teeth[static_cast<std::size_t>(levels.teeth)]));
  trial.teeth = static_cast<int>(std::lround(trial.pinion_teeth * study.ratio[static_cast<std::size_t>(levels.ratio)]));
  trial.helix_angle_rad = study.helix_angle_rad[static_cast<std::size_t>(levels.helix)];
  return trial;
}

}  // namespace

const std::vector<TrialLevels>& l9_trials() {
  static const std::vector<TrialLevels> trials = {{1, 0, 0, 0, 0}, {2, 0, 1, 1, 1}, {3, 0, 2, 2, 2},
                                                  {4, 1, 0, 2, 1}, {5, 1, 1, 0, 2}, {6, 1, 2, 1, 0},
                                                  {7, 2, 0, 1, 2}, {8, 2, 1, 2, 0}, {9, 2, 2, 0, 1}};
  return trials;
}

TrialGear trial_gear(const DhfgStudy& study, const TrialLevels& levels) {
  TrialGear made{begin_trial(study, levels), {}};
  made.gear = make_trial_gear(study, made.trial);
  return made;
}

LoadedTrial load_with_halves(const DhfgStudy& study, const TrialLevels& levels, double half_face_mm,
                             const LoadedEffort& effort) {
  DhfgStudy same = study;
  same.half_face_mm = half_face_mm;
  const auto [trial, gear] = trial_gear(same, levels);
  if (gear) return load_trial(*gear, study.torque_nmm, effort);
  LoadedTrial refused;
  refused.refusal = trial.refusal;
  return refused;
}

DhfgTrial dhfg_trial(const DhfgStudy& study, const TrialLevels& levels) {
  auto [trial, gear] = trial_gear(study, levels);
  if (!gear) return std::move(trial);
  roll_trial(*gear, trial);
  const auto &inner = gear->rings()[0].surface, &outer = gear->rings()[1].surface;
  const auto inner_pinion = contact::make_pinion(inner, trial.pinion_teeth),
             outer_pinion = contact::make_pinion(outer, trial.pinion_teeth);
  trial.balanced = contact::double_mesh_force(inner, outer, inner_pinion, outer_pinion, 1, study.torque_nmm, 0.5);
  trial.held =
      contact::double_mesh_force(inner, outer, inner_pinion, outer_pinion, 1, study.torque_nmm, study.held_share);
  trial.loaded = load_trial(*gear, study.torque_nmm, study.effort);
  trial.milling = mill(study, *gear);
  return std::move(trial);
}

}  // namespace toothpath::trials
