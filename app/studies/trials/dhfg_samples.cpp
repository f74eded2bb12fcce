#include "app/studies/trials/dhfg_samples.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/studies/samples/shape.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::contact {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MeshForce, normal_n, pinion_torque_nmm, pinion_axial_n, pinion_radial_n,
                                   gear_axial_n)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DoubleMeshForce, inner, outer, axial_n, single_axial_n)
}  // namespace toothpath::contact

namespace toothpath::trials {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StudyFacts, name, quick, milled, module_mm, normal_module, pinion_teeth, ratio,
                                   helix_angle_rad, torque_nmm, held_share, rapid_mm_min, equal_half_mm, efforts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Range, least, most, mean)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LoadedEffort, across, flank, face, positions)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LoadedTrial, refusal, normal_n, single_axial_n, approach_mm, stiffness, line_mm,
                                   outer_share, remainder, least_pairs, most_pairs, mean_pairs, stiffness_falls,
                                   error_rad, floating_error_rad, floating_axial_n, pressure, end_pressure,
                                   share_per_um, friction_axial_n, friction_torque)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EffortRow, name, effort, segment_mm, rim_mm, row_teeth, found)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrialLevels, number, teeth, ratio, helix, blank)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MillingTime, cutting_minutes, rapid_minutes, cl_points, refusal)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DhfgTrial, levels, pinion_teeth, teeth, helix_angle_rad, R1_mm, R2_mm, land_mm,
                                   L_p_mm, R1_name, inner_mm, groove_mm, outer_mm, feasible_mm, half_face_mm, refusal,
                                   overlap_halves, overlap, least_pairs, most_pairs, error_range_rad, marked_share,
                                   balanced, held, loaded, milling)

namespace {

using Json = nlohmann::json;
constexpr int kPositions = 8, kQuickPositions = 4;

enum class Kind { trial, equal_halves, effort };
struct Place {
  Kind kind;
  std::size_t index;
};

Place place_of(const StudyFacts& facts, int k) {
  const auto trials = l9_trials().size();
  auto index = std::size_t(k);
  if (index < trials) return {Kind::trial, index};
  index -= trials;
  if (!(facts.equal_half_mm > 0)) return {Kind::effort, index};
  return index < trials ? Place{Kind::equal_halves, index} : Place{Kind::effort, index - trials};
}

/// Of sample k: "trial 4", "trial 4 with equal halves", "effort 2 of trial 4".
std::string name_of(const StudyFacts& facts, int k) {
  const auto [kind, index] = place_of(facts, k);
  if (kind == Kind::effort) return fmt::format("effort {} of trial {}", index + 1, kMiddleTrial + 1);
  return fmt::format("trial {}{}", l9_trials()[index].number, kind == Kind::trial ? "" : " with equal halves");
}

}  // namespace

int count_of(const StudyFacts& facts) {
  return int(l9_trials().size()) * (facts.equal_half_mm > 0 ? 2 : 1) + facts.efforts;
}

StudyFound room_for(const StudyFacts& facts) {
  StudyFound found;
  found.trials.resize(l9_trials().size());
  found.equal.half_face_mm = facts.equal_half_mm;
  if (facts.equal_half_mm > 0) found.equal.trials.resize(l9_trials().size());
  found.efforts.resize(std::size_t(facts.efforts));
  return found;
}

DhfgSamples::DhfgSamples(DhfgStudy study, bool quick) : study_(std::move(study)) {
  facts_.name = study_.name;
  facts_.quick = quick;
  facts_.milled = !study_.operations.empty();
  facts_.module_mm = study_.base.module_mm;
  facts_.normal_module = study_.base.module_plane == face_gear::ModulePlane::normal;
  facts_.pinion_teeth = study_.pinion_teeth, facts_.ratio = study_.ratio;
  facts_.helix_angle_rad = study_.helix_angle_rad;
  facts_.torque_nmm = study_.torque_nmm, facts_.held_share = study_.held_share;
  facts_.rapid_mm_min = study_.rapid_mm_min;
  double narrowest = INFINITY;
  for (const auto& levels : l9_trials()) {
    TrialGear made = trial_gear(study_, levels);
    narrowest = std::min(narrowest, made.trial.feasible_mm);
    if (levels.number == l9_trials()[kMiddleTrial].number) middle_ = std::move(made.gear);
  }
  facts_.equal_half_mm = std::max(0.0, narrowest);
  if (middle_) facts_.efforts = int(effort_rows(study_.base.module_mm, quick).size());
}

std::string DhfgSamples::name(int k) const { return name_of(facts_, k); }

void DhfgSamples::compute(int k, StudyFound& found) const {
  const auto [kind, index] = place_of(facts_, k);
  if (kind == Kind::trial) {
    found.trials[index] = dhfg_trial(study_, l9_trials()[index]);
  } else if (kind == Kind::equal_halves) {
    found.equal.trials[index] = load_with_halves(study_, l9_trials()[index], facts_.equal_half_mm,
                                                 {3, 4, 5, facts_.quick ? kQuickPositions : kPositions});
  } else {
    found.efforts[index] = effort_rows(study_.base.module_mm, facts_.quick)[index];
    load_effort(*middle_, study_.torque_nmm, found.efforts[index]);
  }
}

std::string sample_line(const StudyFacts& facts, int k, const StudyFound& found) {
  const auto [kind, index] = place_of(facts, k);
  Json json = kind == Kind::trial          ? Json(found.trials[index])
              : kind == Kind::equal_halves ? Json(found.equal.trials[index])
                                           : Json(found.efforts[index]);
  return json_text(Json{{"sample", k}, {"name", name_of(facts, k)}, {"found", std::move(json)}});
}

samples::Head head_of(const StudyFacts& facts, const std::string& inputs) {
  const int count = count_of(facts);
  const Json json{{"study", kDhfg}, {"version", kDhfgVersion}, {"key", inputs}, {"samples", count}, {"facts", facts}};
  return {kDhfg, count, json_text(json), kDhfgVersion};
}

Result<MergedStudy> study_of(const samples::Merged& merged) {
  const auto refused = [](const SourcePosition& place, const std::string& fault) {
    return fail_at(place, "{}: study dhfg does not write this; take the file away and run its shard again", fault);
  };
  MergedStudy out;
  const Json head = Json::parse(merged.head.line, nullptr, false);
  const std::vector<double> levels(3);
  StudyFacts facts;
  facts.pinion_teeth = facts.ratio = facts.helix_angle_rad = levels;
  if (const auto fault = samples::shape_fault(Json{{"facts", facts}}, head, ""); !fault.empty())
    return refused(merged.head_place, fault);
  out.facts = head["facts"].get<StudyFacts>();
  if (out.facts.efforts < 0 || out.facts.efforts > merged.head.samples)
    return refused(merged.head_place,
                   fmt::format("\"facts.efforts\" = {} of {} samples", out.facts.efforts, merged.head.samples));
  if (count_of(out.facts) != merged.head.samples)
    return refused(merged.head_place, fmt::format("\"samples\" = {}, and the facts of the study make {}",
                                                  merged.head.samples, count_of(out.facts)));
  out.found = room_for(out.facts);
  for (int k = 0; k < merged.head.samples; ++k) {
    const auto& [text, place] = merged.lines[std::size_t(k)];
    const auto [kind, index] = place_of(out.facts, k);
    const Json model = kind == Kind::trial          ? Json(DhfgTrial())
                       : kind == Kind::equal_halves ? Json(LoadedTrial())
                                                    : Json(EffortRow()),
               json = Json::parse(text, nullptr, false);
    if (const auto fault = samples::shape_fault(Json{{"found", model}}, json, ""); !fault.empty())
      return refused(place, fault);
    const Json& found = json["found"];
    if (kind == Kind::trial) found.get_to(out.found.trials[index]);
    else if (kind == Kind::equal_halves) found.get_to(out.found.equal.trials[index]);
    else found.get_to(out.found.efforts[index]);
    if (kind == Kind::trial && Json(out.found.trials[index].levels) != Json(l9_trials()[index]))
      return refused(place, fmt::format("\"found.levels\" are not those of trial {}", l9_trials()[index].number));
  }
  return out;
}

}  // namespace toothpath::trials
