// `toothpath contact` for equal-base-circle bevel gears: the pair as cut, rolled as rigid bodies.
#pragma once

#include "app/process/gear_process.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel {

/// Rolls the job's gear against its mate: the gear of `asked.other_job`, else the one that its rules give. contact.csv,
/// transmission.csv, contact.json, contact.html. @param cut  walls of the job's gear as they were cut, rolled and
/// loaded beside the drawn ones; may be null. Refused: what makes no pair, each with its place.
[[nodiscard]] process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job,
                                                                      const bevel_gear::BevelGear& gear,
                                                                      const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock);

}  // namespace toothpath::bevel
