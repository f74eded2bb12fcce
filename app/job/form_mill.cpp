#include "app/job/form_mill.h"

#include "cam/finger/milling.h"
#include "cam/tool/cutters.h"
#include "geometry/bevel_gear/finger_cutter_design.h"

namespace toothpath::job {
namespace {

/// The keys of [gear.mill].
std::string words_of(const bevel_gear::FingerCutterData& mill) {
  return fmt::format("module = {:g}, tip_radius = {:g}, rack_depth = {:g}, profile_height = {:g}", mill.module_mm,
                     mill.tip_radius_mm, mill.rack_depth_mm, mill.profile_height_mm);
}

}  // namespace

Result<FormMill> form_mill(const Job& job) {
  const bevel_gear::BevelGearParameters& gear = *job.bevel_gear();
  std::optional<std::size_t> tool;
  for (std::size_t i = job.tools.size(); i-- > 0;)
    if (tool::serves(job.tools[i], tool::CutterUse::tooth_form)) tool = i;
  for (const auto& operation : job.operations)
    if (operation.type == path::OperationType::finger_finishing) tool = static_cast<std::size_t>(operation.tool);
  if (tool && gear.mill)
    return fail_at(job.where("gear.mill"),
                   "[gear.mill] contradicts tool {}: the flanks are those that this finger mill leaves",
                   job.tools[*tool].number);
  if (tool) return FormMill{tool, finger::finger_cutter_data(job.tools[*tool])};
  if (gear.mill) return FormMill{{}, *gear.mill};
  const bevel_gear::FingerCutterData by_rules = bevel_gear::finger_cutter_for(gear);
  if (job.operations.empty())
    return fail_at(job.where("gear"),
                   "the job lacks a [[tool]] of type \"finger_mill\" or the table [gear.mill]: one of them makes the "
                   "flanks of this gear; a mill by the rules has {}",
                   words_of(by_rules));
  return FormMill{{}, by_rules};
}

}  // namespace toothpath::job
